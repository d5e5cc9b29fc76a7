// How large boxes look in an image: the measure behind contribution culling, eight children of a tree node at once.
// SPDX-License-Identifier: MIT
//
// Hansong Zhang, Dinesh Manocha, Tom Hudson, Kenneth Hoff. Visibility Culling using Hierarchical Occlusion Maps. 1997
// (approximate culling of what contributes little).
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/cull/frustum.h"
#include "sightline/geom/view.h"

namespace sightline {

/// How a view's image measures what it shows.
///
/// A box stands for the sphere around it, so that its size does not hang on how the camera is turned. In perspective the
/// image of a sphere of radius r, whose centre is d away from the eye and z deep, is an ellipse with semi-axes
/// a = r sqrt(d^2 - r^2) / (z^2 - r^2) and b = r / sqrt(z^2 - r^2) in the plane at depth one: it is longer towards the
/// image's edges, wherever the projection's centre is. In a parallel view it is a circle of radius r. The projection
/// scales areas by the same number everywhere. The sphere's projected radius is that of the disk with the same area.
struct ContributionMeasure {
    bool perspective = true;
    glm::vec3 toward{0.0f};  ///< unit direction that the view looks in
    float scale = 0;         ///< [square pixels of the viewport for a unit of area at depth one; of a parallel view
                             ///< for a unit of area across it]
};

/// @param view  isUsable(view)
ContributionMeasure makeContributionMeasure(const View& view);

/// The squares of the projected radii of eight boxes, rounded by 2^-16 of themselves at most. Infinity if the sphere
/// comes near the plane of the eye (its centre is nearer than 1.41 radii), or if float cannot tell: such a box is not
/// small.
///
/// A box that is no leaf gets a bound: no box inside of it has more. So if a node is too small, all boxes below it are.
/// @param leaves   bit per box: it is measured itself; the others are bounded for all that they may hold
/// @param squares  [size: 8] [square pixels]
void squaredRadii(const ContributionMeasure& measure, const EyeBoxes& boxes, uint32_t leaves, float* squares);

}  // namespace sightline
