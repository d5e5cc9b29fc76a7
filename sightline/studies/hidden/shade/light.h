// The light that pictures are lit with: one sun, a sky, haze, and colours for things that have none.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace sightline::studies {

/// Where the sun stands unless somebody else says: unit length, towards it.
glm::dvec3 defaultSun();

/// A pleasant linear colour for a number.
glm::dvec3 hashedColour(uint64_t key);

/// The sky's linear colour.
/// @param above_horizon  y of a unit direction
glm::dvec3 skyColour(double above_horizon);

/// What a surface's colour is multiplied by: the sun where it reaches, the sky from above, and a weak light from the
/// other side that keeps faces in shadow apart.
/// @param normal  unit length
/// @param sun     towards it, unit length
/// @param reach   part of the sun that reaches the surface  [0 to 1]
double lightOn(const glm::dvec3& normal, const glm::dvec3& sun, double reach = 1);

/// A far surface fades into the sky, to a half at most.
/// @param distance  in units of the world's diagonal
glm::dvec3 throughHaze(const glm::dvec3& colour, const glm::dvec3& sky, double distance);

/// Linear light to the bytes of an image (sRGB).
glm::u8vec3 toBytes(const glm::dvec3& linear);

}  // namespace sightline::studies
