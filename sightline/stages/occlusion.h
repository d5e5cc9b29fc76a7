// The occlusion stage: what the depth tiles hide is culled, and what is kept is drawn into them.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
#pragma once

#include <cstdint>

#include "sightline/frame/frame.h"
#include "sightline/frame/traversal_state.h"

namespace sightline::detail {

/// Whether a rectangle is hidden, of what of it lies in the traversal's part of the image.
/// @param box  of what is asked about, if planes are to be asked, too
bool isHiddenHere(TraversalState& state, PixelRect rect, Seams seams, const OccludeeBox* box = nullptr);

/// A node's or an object's box, to be held against planes.
/// @param box  relative to the eye, each number rounded: Pending::box
OccludeeBox boxAt(const Screen& screen, const Box3f& box);

/// Whether drawing something in a rectangle may hide enough for what it costs.
/// @param cost  PlaneMesh::costOf(), or no more
bool mayHideEnough(const Screen& screen, const PixelRect& rect, uint32_t cost);

/// An occluder that an object in the answer brings.
struct OfferedOccluder {
    const Occluder* occluder = nullptr;  ///< null: there is none
    bool cut = false;                    ///< a section cuts it: only whole clusters hide
};
OfferedOccluder occluderOf(const Frame& frame, uint32_t place);

/// Whether a cluster of an offered occluder may be drawn, by what its box says.
bool mayDraw(const Frame& frame, const TraversalState& state, const OfferedOccluder& offered,
             const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box);

/// Draws a cluster into the tiles, unless it is too small or the budget is spent.
/// @param triangles  receives how many were offered to the rasterizer
/// @returns false: it was not drawn
bool drawCluster(const Frame& frame, TraversalState& state, const OccluderInstance& instance, uint32_t cluster,
                 const BoxAnswer& box, uint32_t& triangles);

}  // namespace sightline::detail
