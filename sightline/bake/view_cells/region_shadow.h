// What a flat hider hides from every point of a convex region: a few planes.
// SPDX-License-Identifier: MIT
//
// Daniel Cohen-Or, Gadi Fibich, Dan Halperin, Eyal Zadicario. Conservative Visibility and Strong Occlusion for
// Viewspace Partitioning of Densely Occluded Scenes. 1998.
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/bake/view_cells/flat_hiders.h"
#include "sightline/math/box.h"

namespace sightline::bake {

/// The shadow of a hider from a region: each segment from the region to a point in it passes the hider.
///
/// The argument. Behind the hider's plane, what an eye's rays through one edge and beside the hider reach is bounded by
/// the plane through the eye and the edge. All these planes hold the edge's line, so that they are ordered by their
/// slope, and the one of the region's corner that stands the farthest out over the edge for its height bounds what all
/// of them leave. The surface may lie anywhere within half of the bend of the plane, and a segment must be over the
/// hider as long as it is so near: so the edges are lifted to the side where that asks for more. Planes are moved
/// inward by what rounding may move them.
class RegionShadow {
public:
    /// @param corners  of the region: it is their hull
    /// @param reach    no coordinate is larger, and nothing that is asked lies farther from the hider  [world units]
    /// Without planes, hiding nothing, if the region is not wholly in front of the hider's plane by more than its bend.
    RegionShadow(const FlatHider& hider, std::span<const glm::dvec3> corners, double reach);

    /// Whether it hides anything.
    bool any() const { return count_ > 0; }
    bool hides(const Box3d& box) const { return any() && isBehind(box) && beside(box) == 0; }

    /// Whether a box is wholly behind the hider's plane, farther than the surface may be.
    /// @pre any(), as in what follows
    bool isBehind(const Box3d& box) const { return lowest(planes_[0], box) >= 0; }
    /// Whether it is wholly in front of it, as the region is: no segment from there to the box comes to the hider.
    bool isInFront(const Box3d& box) const { return lowest(front_, box) >= 0; }
    /// A bit for each edge, from corner i to the next, beside which a segment to the box may pass.
    uint32_t beside(const Box3d& box) const {
        uint32_t edges = 0;
        for (uint32_t i = 1; i < count_; ++i) edges |= uint32_t{!(lowest(planes_[i], box) >= 0)} << (i - 1);
        return edges;
    }

private:
    static constexpr size_t kMost = 13;  // the hider's plane and its edges

    static double lowest(const glm::dvec4& plane, const Box3d& box) {
        const glm::dvec3 normal(plane);
        return glm::dot(normal, box.center()) + plane.w - 0.5 * glm::dot(glm::abs(normal), box.size());
    }

    std::array<glm::dvec4, kMost> planes_;  // inward
    glm::dvec4 front_{0.0};
    uint32_t count_ = 0;
};

}  // namespace sightline::bake
