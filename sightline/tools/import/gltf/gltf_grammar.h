// Tells plain JSON at a glance, so that a large text is not taken apart twice.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>

namespace sightline::tools::gltf {

/// True only if the text is JSON for sure: one value, at most 256 deep, well-formed UTF-8, every number finite in double.
/// False says nothing: the caller asks a full parser, which also knows the place of a mistake. Surrogate escapes and
/// very long numbers are among what is left to it.
bool plainJson(std::span<const unsigned char> text);

}  // namespace sightline::tools::gltf
