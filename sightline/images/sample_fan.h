// Where the images of a doorway are taken from: arcs before it, and the nearest samples of an eye with their weights.
// SPDX-License-Identifier: MIT
//
// Daniel Aliaga, Anselmo Lastra. Architectural Walkthroughs Using Portal Textures. 1997.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/images/portal_frame.h"

namespace sightline::images {

struct FanSettings {
    double eye_height = 1.6;           ///< of all samples above the frame's lower edge  [world units]
    double nearest = 2, farthest = 2;  ///< radii of the first and the last arc  [world units, 0 < nearest <= farthest]
    uint32_t arcs = 1;                 ///< their radii grow by one factor  [>= 1]
    uint32_t angles = 120;             ///< samples of an arc  [>= 1]
    double half_angle = 1.0471975511965976;  ///< an arc reaches so far to both sides  [radians, in [0, pi / 2)]
};

/// Samples on arcs around the foot of the eye's height on the doorway's middle line, arc by arc, left to right.
struct SampleFan {
    FanSettings settings;
    glm::dvec3 centre{0.0}, right{1, 0, 0}, front{0, 0, 1};  ///< of the arcs
    std::vector<glm::dvec3> eyes;                            ///< [size: arcs * angles]
};

/// Errors (kUsage): settings outside of their limits.
Result<SampleFan> sampleFan(const PortalFrame& frame, const FanSettings& settings);

/// The nearest samples by arc and angle, heaviest first.
struct SampleWeights {
    uint32_t count = 0;  ///< 1 to 3; 2 of a single arc at most
    uint32_t sample[3] = {};
    double weight[3] = {};  ///< > 0; they sum to 1
};

/// The fan's samples are joined to triangles over (logarithm of radius, angle); an eye has the weights of its place in the
/// triangle, so that they change without a jump as it moves, and are 1 at a sample. Beyond the last arcs and angles the
/// nearest place of the fan counts, and so does the one above or below: how far off that is, parallax says.
SampleWeights nearestSamples(const SampleFan& fan, const glm::dvec3& eye);

}  // namespace sightline::images
