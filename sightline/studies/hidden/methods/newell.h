// Newell's algorithm: a painter's whose order is proved pair by pair, and who cuts polygons where there is none.
// SPDX-License-Identifier: MIT
//
// Martin Newell, Richard Newell, Tom Sancha. A Solution to the Hidden Surface Problem. 1972.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/studies/hidden/method_input.h"
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

/// Polygons in order, and what they were cut into on the way.
struct NewellOrder {
    std::vector<NewellPiece> pieces;  ///< those that were cut stay, without samples
    std::vector<uint32_t> order;      ///< places in `pieces`, far to near
    size_t proved = 0;                ///< so many of `order` are drawn over one another; the rest, nearer than all of
                                      ///< them, is in no order, because the limit was reached
};

/// Takes the farthest piece P and asks of every Q that overlaps it in depth whether P may be drawn before it. If not, Q
/// is marked and moved before P, and asked in turn. Where that would come back to a marked piece, or where the planes
/// of P and Q cross, one of the two is cut in two: by the other's plane, or, where each lies on one side of the
/// other's plane, along the other's outline. A piece keeps the answers that it has got, so that it need not begin
/// anew when it is its turn again; marks end when a piece is drawn. Only pieces in the same tiles of the screen are
/// compared.
///
/// Ends for any input, since a cut leaves samples on both sides. Counts comparisons, swaps and splits.
/// @param polygons  not to be moved while the order is in use
/// @param limit     comparisons after which to stop
NewellOrder newellOrder(std::span<const ScreenPolygon> polygons, uint32_t width, uint32_t height,
                        HiddenCounters& counters, uint64_t limit);

/// Draws pieces in their order, and what is in none by a depth at each sample.
void drawInOrder(const NewellOrder& order, HiddenImage& image);

/// Finds that order and draws in it. After 4096 comparisons a polygon, and 2^25, the rest is drawn with a depth at each
/// sample, and counted as tested: the image is as exact, though not by Newell's means.
///
/// Practical up to a quarter of a million polygons in view: comparisons grow with the square of the polygons that overlap
/// on the screen and in depth. Where hundreds of large polygons all pass through one another, pieces do as well.
/// Memory: some 200 bytes a piece, and 12 a row of it.
void drawNewell(const HiddenInput& input, HiddenImage& image);

}  // namespace sightline::studies
