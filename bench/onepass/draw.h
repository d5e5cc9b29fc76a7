// Draws clusters of plane groups into blocks, and asks rectangles: one path for all clusters.
// SPDX-License-Identifier: MIT
#pragma once

#include "bench/onepass/blocks.h"
#include "bench/onepass/boxes.h"
#include "bench/onepass/frame.h"
#include "bench/onepass/mesh.h"
#include "bench/onepass/scratch.h"

namespace sightline::bench {

/// Covers pixels that the cluster's groups cover together.
/// @returns whether it could be drawn; false: something is not known well enough, and nothing was drawn
bool drawCluster(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t cluster,
                 DrawScratch& scratch);

/// Whether a cluster may show something beside what is drawn. Its groups hold all that it shows.
/// @param box  around the cluster, by the rows of the frame
bool isClusterOpen(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t cluster,
                   const AskedBox& box, DrawScratch& scratch);

/// Clusters that may be in the image, by their boxes.
/// @param out  room for all of them; @returns how many
uint32_t clustersInView(const DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t* out);

/// @param x,y,w        rows of a screen
/// @param centre,half  of the box, in the space that the rows are over
AskedBox askedBox(const glm::dvec4& x, const glm::dvec4& y, const glm::dvec4& w, const glm::dvec3& centre,
                  const glm::dvec3& half);

/// @returns false if it may reach before the near plane
bool imageOf(const AskedBox& box, double near_w, BoxImage& out);

/// Whether a pixel of a rectangle may show something that is as near.
/// @param x0,y0,x1,y1  inclusive, inside the image
/// @param box          or null
bool isOpen(DepthBlocks& image, int x0, int y0, int x1, int y1, float nearness, const AskedBox* box);

}  // namespace sightline::bench
