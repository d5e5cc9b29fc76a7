// A number that tells scenes apart: of what stands where, and of its cells.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

/// Of objects, triangles, what hides, and cells and portals, to the last bit; not of names, colours and cameras. The
/// same on every machine.
uint64_t hashOf(const Scene& scene);

}  // namespace sightline::bake
