// A piece of a polygon in Newell's list: the samples that it has, and the tests that put two pieces in order.
// SPDX-License-Identifier: MIT
//
// Martin Newell, Richard Newell, Tom Sancha. A Solution to the Hidden Surface Problem. 1972.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/studies/hidden/project/cut.h"
#include "sightline/studies/hidden/project/screen_polygon.h"

namespace sightline::studies {

/// Samples [begin, end) of a row.
struct SampleRun {
    int32_t row = 0, begin = 0, end = 0;
};

/// A piece is its samples and nothing else. Cutting one parts the samples, so that no crack can appear and no sample
/// is painted twice; extents and plane tests look at samples as well, where nearness is what every other method sees.
struct NewellPiece {
    const ScreenPolygon* polygon = nullptr;
    std::vector<SampleRun> runs;       ///< in rising order, not empty
    std::vector<glm::ivec2> hull;      ///< convex hull of the samples (x: sample, y: row), counter-clockwise
    glm::ivec2 low{0}, high{0};        ///< first and last sample and row
    double farthest = 0, nearest = 0;  ///< nearness over the samples
};

/// The piece that is a whole polygon. Without runs if the polygon has no samples.
NewellPiece wholePiece(const ScreenPolygon& polygon, int32_t width, int32_t height);

/// Parts the samples of a piece. False, and nothing is done, if one side would have none.
bool cutPiece(const NewellPiece& piece, const ScreenCut& cut, NewellPiece& kept, NewellPiece& rest);

/// What shows that one piece may be drawn before another: the tests in their order.
enum class NewellTest : uint8_t {
    kDepth,     ///< the first is farther as a whole
    kColumns,   ///< no common column
    kRows,      ///< no common row
    kBehind,    ///< the first lies wholly behind the other's plane
    kInFront,   ///< the other lies wholly in front of the first's plane
    kDisjoint,  ///< no common sample
    kNone,      ///< nothing does
};

/// The first test that passes. Planes are thick: a point within 1e-10 of the nearness there, or within rounding of the
/// sums it takes, lies in the plane. Of pieces in one plane that of the lower surface number is drawn last.
NewellTest mayBeDrawnBefore(const NewellPiece& first, const NewellPiece& second);

/// Where a piece lies with respect to a plane, over the piece's samples.
struct PlaneSides {
    bool behind = false, in_front = false;  ///< some samples do, by more than the plane's thickness
    bool crosses() const { return behind && in_front; }
};
PlaneSides sidesOf(const NewellPiece& piece, const DepthPlane& plane);

}  // namespace sightline::studies
