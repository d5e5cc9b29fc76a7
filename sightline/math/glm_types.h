// GLM's vectors as Sightline was built with them: a program whose macros change their layout or names is told so.
// SPDX-License-Identifier: MIT
#pragma once

#include <type_traits>

#include <glm/glm.hpp>

// Other macros of GLM (GLM_FORCE_DEPTH_ZERO_TO_ONE, GLM_FORCE_LEFT_HANDED, GLM_FORCE_SWIZZLE, GLM_FORCE_EXPLICIT_CTOR, GLM_FORCE_XYZW_ONLY,
// GLM_FORCE_INTRINSICS) may be defined: see docs/integration.md.
static_assert(std::is_same_v<glm::dvec3, glm::vec<3, double, glm::packed_highp>> &&
                  std::is_same_v<glm::vec3, glm::vec<3, float, glm::packed_highp>>,
              "Sightline takes GLM's packed vectors: include its headers in files that are compiled without "
              "GLM_FORCE_DEFAULT_ALIGNED_GENTYPES");
static_assert(
    std::is_same_v<glm::length_t, int>,
    "Sightline takes GLM's vectors with lengths of type int: include its headers in files that are compiled without "
    "GLM_FORCE_SIZE_T_LENGTH");
