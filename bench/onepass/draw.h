// Draws clusters of plane groups into blocks, and asks rectangles: one path for all clusters.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "bench/onepass/blocks.h"
#include "bench/onepass/mesh.h"
#include "sightline/buffer/screen.h"

namespace sightline::bench {

/// What a view makes of an object: the rows of its screen, and the eye among its vertices.
struct ObjectFrame {
    glm::dvec4 x{0.0}, y{0.0}, w{0.0};  ///< Screen's, over positions in object space
    glm::dvec3 eye{0.0};                ///< [object space]
    glm::dmat3 to_image{0.0};              ///< inverse of the rows: column i times a normal is what the plane's a, b, c need
    double near_w = 0;                ///< what is nearer is not drawn
    float length_x = 0, length_y = 0, length_w = 0;  ///< of the rows
    int sign = 1;                     ///< a front turns counter-clockwise in the image: 1; else -1
    bool usable = false;
};

/// @param object  objectScreen(); perspective, and of one near w; else it is not usable
/// @param flips   the object's transform mirrors
ObjectFrame objectFrame(const Screen& object, bool flips);

/// Covers pixels that the cluster's groups cover together.
/// @returns whether it could be drawn; false: something is not known well enough, and nothing was drawn
bool drawCluster(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t cluster);

/// A box as an image plane sees it: the largest a x + b y + c w of its corners is one of each summand.
struct AskedBox {
    float x[4], y[4], w[4];  ///< rows over its three half axes and its centre
    float half[3];
};

/// Whether a pixel of a rectangle may show something that is as near.
/// @param x0,y0,x1,y1  inclusive, inside the image
/// @param box          or null
bool isOpen(DepthBlocks& image, int x0, int y0, int x1, int y1, float nearness, const AskedBox* box);

}  // namespace sightline::bench
