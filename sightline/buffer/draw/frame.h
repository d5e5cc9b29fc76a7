// What a view makes of an object that is drawn: the rows of its screen, and the eye among its vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/buffer/screen.h"

namespace sightline {

struct ObjectFrame {
    glm::dvec4 x{0.0}, y{0.0}, w{0.0}, d{0.0}, near{0.0};  ///< Screen's, over positions in object space
    bool perspective = true;
    glm::dvec3 eye{0.0};       ///< [object space]; in parallel projection the way to it, of length 1
    glm::dmat3 to_image{0.0};  ///< inverse of the rows of x, y and w, or d in parallel projection: transposed
    float nearest = 0;         ///< nothing that is drawn is nearer; infinity: not known  [nearness]
    double near_guard = 0;     ///< what has less of near.h is not drawn
    float length_x = 0, length_y = 0, length_w = 0, length_d = 0, length_near = 0;  ///< of the rows
    float place_error = 0;  ///< no point of the object is known better  [object space]
    bool clips = false;     ///< that is little against the near guard
    int sign = 1;           ///< a front turns counter-clockwise in the image: 1; else -1
    bool usable = false;    ///< else nothing is known well enough: the object is flat, or far too large
};

/// @param object       objectScreen()
/// @param flips        the object's transform mirrors
/// @param place_error  ObjectFrame's
/// @param clips        ObjectFrame's
ObjectFrame objectFrame(const Screen& object, bool flips, double place_error, bool clips);

}  // namespace sightline
