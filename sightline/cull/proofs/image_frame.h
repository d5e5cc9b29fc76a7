// The image of a view as a plane to do geometry in: directions from the eye as pairs of numbers.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/buffer/screen.h"

namespace sightline {

/// A point q, relative to the eye, appears at (dot(x, q), dot(y, q)) / dot(w, q). The occlusion buffer is the square from
/// -1 to 1, with the jitter that the caller declares.
struct ImageFrame {
    bool usable = false;  ///< false: the rays of the view do not meet in the eye, or it is badly conditioned
    glm::dvec3 x{0.0}, y{0.0}, w{0.0};
    glm::dmat3 back{0.0};  ///< (u, v, 1) to the point that appears there with dot(w, q) = 1
    double longest = 0;    ///< no such point of the buffer has a greater sum of sizes of its coordinates

    /// What the plane of a normal through the eye is in the image: dot of (u, v, 1) with it.
    glm::dvec3 lineOf(const glm::dvec3& normal) const {
        return {glm::dot(back[0], normal), glm::dot(back[1], normal), glm::dot(back[2], normal)};
    }
};

ImageFrame makeImageFrame(const Screen& screen);

}  // namespace sightline
