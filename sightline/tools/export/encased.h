// Triangles that lie within closed surfaces, where no eye outside of these can see them.
// SPDX-License-Identifier: MIT
//
// Why it holds. A shell is a part of a mesh that hides, in which each edge is run through as often one way as the other. How
// often it winds around a point is then a whole number, which changes only where the point passes through the shell: by one more
// where it enters through a front. Around a triangle that the shell does not touch, the number is the same for all its points. If
// it is more than 0, and 0 around the eye, each line of sight to the triangle enters through a front of the shell,
// which hides what is behind it. The near plane must not cut the shell open.
//
// Shells that encase one another's triangles lose nothing by that. Follow a line of sight to the first point where it
// is within any shell. The triangle that it passes there is within none, for then the line would have been so before.
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

struct Encased {
    std::vector<std::vector<uint32_t>> triangles;  ///< by object: their numbers in its mesh, ascending  [size: objects]
    uint64_t shells = 0;                           ///< closed surfaces that were found, by object
};

/// All triangles that keep a distance from some shell around them: a millionth of the shell's largest coordinate, so that
/// positions in float change nothing. Nothing of what deforms, and nothing within what several surfaces shut together.
/// Doors, and what the file may draw otherwise (SceneObject::changes), are no shells and are encased by none. What else
/// moves is taken where it stands.
/// @param progress  called now and then with (done, total) shells; false: stop, with what was found
Encased encasedTriangles(const Scene& scene, const std::function<bool(size_t, size_t)>& progress = {});

}  // namespace sightline::tools
