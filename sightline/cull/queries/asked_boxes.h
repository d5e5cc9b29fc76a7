// The boxes that stand for a node in a question: padded for the rounding of the rasterizer, and tight around what is below.
// SPDX-License-Identifier: MIT
//
// Oliver Mattausch, Jiri Bittner, Michael Wimmer. CHC++: Coherent Hierarchical Culling Revisited. 2008 (tight bounds).
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/tree/world_bvh.h"

namespace sightline {

/// How the graphics interface rounds what it draws.
struct RasterRounding {
    /// How far an edge of an object and an edge of its box may come apart in the image: covers rasterizers that have 4 bits
    /// below the pixel.  [pixels]
    double pixels = 0.125;
    /// Of depths, of a range that is 1 long: twice the step of 24 bits. Of reversed floats 0.
    double depth_step = 0x1p-23;
};

/// A box that is drawn in place of what it holds must show a sample wherever one of these shows. It is taken for granted that
/// no depth inside of a triangle is nearer than all of its corners, as where depths are interpolated between the rounded
/// corners. A rasterizer that extrapolates beyond them draws steep triangles nearer than they are, by as much as they are
/// steep; no padding covers that.
/// Both are rounded: corners
/// are moved to a grid, depths to steps. So the box is moved outward by as much as both together may be wrong by at its
/// farthest corner: by a ball that looks as large as the positions' rounding, and reaches a step of the depths nearer.
class BoxPadding {
public:
    /// @param view  isUsable(view)
    BoxPadding(const View& view, const RasterRounding& rounding);

    Box3d padded(const Box3d& box) const;
    /// False if a box may reach the near plane: then nothing can be asked of it.
    bool isBeyondNear(const Box3d& padded) const;

private:
    glm::dvec2 along(const glm::dvec3& direction, const Box3d& box) const;

    glm::dvec3 eye_, forward_;
    glm::dvec4 near_{0.0, 0.0, 0.0, 1.0};  ///< relative to the eye; where there is none, all is beyond
    bool parallel_ = false;
    double per_depth_ = 0;   ///< padding per unit of depth; of a parallel view the padding
    double per_square_ = 0;  ///< the same per square of it: a step of depth grows so
};

/// The boxes that a slot is asked by: its own; or, if their surfaces are together at most 1.4 times as large, those of its
/// children, of which there are eight: three levels of a tree of two.
/// @param slot   node's index * 8 + slot
/// @param boxes  are appended, relative to the tree's origin
void appendBoxes(const PlacedBvh& tree, uint32_t slot, bool tight, Array<Box3f>& boxes);

}  // namespace sightline
