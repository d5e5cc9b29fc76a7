// What pictures of a scene need to know of it: what may be in view, and the colours of things.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// False only if no point of a box can be in the view volume (but for the far plane).
/// @param clip  world to clip space
bool mayBeInView(const glm::dmat4& clip, const Box3d& box);

/// True if a material's surfaces are drawn as if they were opaque. Masked ones are, whole: a picture without foliage
/// would be bare. Blended and transmissive ones are not.
bool isSolid(const Material& material);

/// The linear colour of an object's primitive: its material's, or one hashed from the object's key where that is white.
glm::dvec3 colourOf(const Scene& scene, const SceneObject& object, const Primitive& primitive);

/// A box's diagonal, at least a billionth; 1 if it is empty [world units].
double diagonalOf(const Box3d& box);

}  // namespace sightline::tools
