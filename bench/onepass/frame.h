// What a view makes of an object that is drawn: the rows of its screen, and the eye among its vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/buffer/screen.h"

namespace sightline::bench {

struct ObjectFrame {
    glm::dvec4 x{0.0}, y{0.0}, w{0.0};  ///< Screen's, over positions in object space
    glm::dvec3 eye{0.0};                ///< [object space]
    glm::dmat3 to_image{0.0};  ///< inverse of the rows: column i times a normal is what the plane's a, b, c need
    double near_w = 0;         ///< what is nearer is not drawn
    float length_x = 0, length_y = 0, length_w = 0;  ///< of the rows
    int sign = 1;                                    ///< a front turns counter-clockwise in the image: 1; else -1
    bool usable = false;
};

/// @param object  objectScreen(); perspective, and of one near w; else it is not usable
/// @param flips   the object's transform mirrors
ObjectFrame objectFrame(const Screen& object, bool flips);

}  // namespace sightline::bench
