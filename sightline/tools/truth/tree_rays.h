// Segments through a tree of planes: what a map's own leaves say of who sees whom.
//
// A witness: it shares no code with what finds portals or rows.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/truth/aimed_holes.h"
#include "sightline/tools/truth/row_check.h"

namespace sightline::tools {

/// What ends a segment besides solid leaves.
struct TreeRaySettings {
    bool sky_is_open = false;    ///< else it ends where it enters the sky
    bool contents_stop = false;  ///< it ends where the contents are others than where it began
};

/// A stretch of a segment within a leaf, as parameters of the segment.
struct TreeStretch {
    uint32_t leaf = 0;
    uint32_t place = 0;  ///< the node above the leaf, times 2, plus 1 in front: leaves may be named by several nodes
    double from = 0, to = 1;
};

/// A segment on its way; its memory is used again by the next.
struct TreeWalk {
    std::vector<TreeStretch> stretches;  ///< in order, as far as the segment came
    bool arrived = false;                ///< at its end

    struct Part {
        uint32_t child, place;
        double from, to;
    };
    std::vector<Part> stack;
};

/// How far the place of a parameter of a segment may be off by rounding: 2^-46 (|a| + t (|a| + |b|)). Where the segment begins
/// nearby that follows the coordinates of the place, however far the other end is.  [world units]
///
/// Let u = 2^-53, and h(t) the exact height over a plane (n, w) of a point of the segment. The heights of the ends are computed
/// with errors below 4 u (|a| + |w|) and 4 u (|b| + |w|). Where the computed ones cross, h is the mean of these errors, weighed
/// by 1 - t and t. The quotient, and comparisons at the ends of a part, add 6 u t |b - a|. So |h| < 10 u (|a| + t (|a| + |b|) +
/// |w|). The point itself is rounded by 3 u (|a| + t (|a| + |b|)), and its height over another plane by 4 u (|p| + |w|). 2^-46
/// is 128 u, seven times as much as these together.
class SegmentRounding {
public:
    static constexpr double kPart = 0x1p-46;

    SegmentRounding(const glm::dvec3& a, const glm::dvec3& b)
        : at_start_(kPart * glm::length(a)), per_t_(at_start_ + kPart * glm::length(b)) {}

    double at(double t) const { return at_start_ + t * per_t_; }

private:
    double at_start_, per_t_;
};

class TreeRays {
public:
    /// @param tree  outlives this  [finite]
    explicit TreeRays(const LeafTree& tree, const TreeRaySettings& settings = {});

    const LeafTree& tree() const { return tree_; }
    /// Whether segments may be in it.
    bool passes(uint32_t leaf) const { return passes_[leaf]; }
    /// Of a point in a plane the leaf in front.
    uint32_t leafAt(const glm::dvec3& point) const;

    /// Follows a segment from `a` towards `b`. In double, so that it may be wrong about what it passes within rounding:
    /// stands() tells. Nothing is passed if `a` is in what ends segments.
    void follow(const glm::dvec3& a, const glm::dvec3& b, TreeWalk& walk) const;

    /// Whether the steps of a walk from stretch `i` to stretch `j` are beyond rounding (SegmentRounding): each crosses a plane
    /// at a place that is inside all other planes of the two leaves by more than that, and both stretches at the ends are
    /// longer.
    bool stands(const glm::dvec3& a, const glm::dvec3& b, const TreeWalk& walk, size_t i, size_t j) const;

private:
    struct Node {
        double plane[4];
        uint32_t child[2];
    };
    struct Step {
        glm::dvec3 a, b;
        double at;  // where the segment crosses the plane of a node
        uint32_t node;
    };
    bool isInside(uint32_t place, const Step& step) const;

    const LeafTree& tree_;
    bool contents_stop_;
    std::vector<Node> nodes_;
    std::vector<uint8_t> passes_;
    std::vector<uint32_t> above_;  // per node: the parent times 2 plus the side
};

/// Holds rows of leaves, or of what leaves belong to, against segments: between points of the bounds, the first of
/// which is in a leaf that can be passed; and, aimed, through points of holes, to both sides, half of them on to
/// another hole nearby. All leaves of a segment see one another, but for those that it passes for less than rounding
/// (SegmentRounding). Seeded: a report is the same on every machine and with any number of threads.
/// @param rows         symmetric or not: both directions must be there
/// @param row_of_leaf  or RowJudge::kNoRow; empty: each leaf is its own row  [size: leaves]
/// @param holes        without any, no segment is aimed
/// @param seen         receives a bit for each pair that was seen, if there is one: the truth from below, but for
///                     rounding where a segment passes a corner  [as large as rows]
RowReport checkLeafRows(const TreeRays& rays, const BitMatrix& rows, std::span<const uint32_t> row_of_leaf,
                        const AimedHoles& holes, const RowCheckSettings& settings = {}, BitMatrix* seen = nullptr);

}  // namespace sightline::tools
