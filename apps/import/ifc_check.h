// What Assimp cannot read of IFC, found before it tries.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

namespace sightline::import {

/// Throws a Fault if a file holds geometry of IFC4 that Assimp, which knows IFC2x3, would crash on or leave out: faces
/// by index, curves by index, advanced boundaries. A file that cannot be opened passes.
void checkIfc(const std::string& file);

}  // namespace sightline::import
