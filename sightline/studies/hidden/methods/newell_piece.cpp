// A piece of a polygon in Newell's list: the samples that it has, and the tests that put two pieces in order.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/newell_piece.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/studies/hidden/project/scan.h"

namespace sightline::studies {
namespace {

/// Half the thickness of a plane, relative to the nearness at a point. Positions in float put faces that are almost in
/// one plane some 1e-8 apart, and faces that are exactly in one plane differ by rounding in double, 1e-15.
constexpr double kThickness = 1e-10;
/// Roundings in the difference of two planes at a point: each term and each sum, with room.
constexpr double kRounding = 8 * 0x1p-53;

int64_t turn(const glm::ivec2& a, const glm::ivec2& b, const glm::ivec2& c) {
    return int64_t{b.x - a.x} * (c.y - a.y) - int64_t{b.y - a.y} * (c.x - a.x);
}

/// Appends to a chain that only turns left; `from` is the chain's first point.
void appendLeftTurning(std::vector<glm::ivec2>& chain, size_t from, const glm::ivec2& point) {
    if (chain.size() > from && chain.back() == point) return;
    while (chain.size() >= from + 2 && turn(chain[chain.size() - 2], chain.back(), point) <= 0) chain.pop_back();
    chain.push_back(point);
}

/// Up along the right ends of the runs, down along the left ones.
void findHull(NewellPiece& piece) {
    std::vector<glm::ivec2>& hull = piece.hull;
    hull.clear();
    const std::vector<SampleRun>& runs = piece.runs;
    for (const SampleRun& run : runs) {
        // Of several runs in a row the last one reaches farthest.
        if (!hull.empty() && hull.back().y == run.row && hull.back().x < run.end - 1) hull.pop_back();
        appendLeftTurning(hull, 0, {run.end - 1, run.row});
    }
    const size_t top = hull.size() - 1;
    for (size_t i = runs.size(); i-- > 0;) {
        if (i > 0 && runs[i - 1].row == runs[i].row) continue;
        appendLeftTurning(hull, top, {runs[i].begin, runs[i].row});
    }
    if (hull.size() > 1 && hull.back() == hull.front()) hull.pop_back();
}

/// Fills in all that follows from polygon and runs.
void measure(NewellPiece& piece) {
    findHull(piece);
    piece.low = piece.high = piece.hull[0];
    piece.farthest = std::numeric_limits<double>::infinity();
    piece.nearest = -piece.farthest;
    for (const glm::ivec2& point : piece.hull) {
        piece.low = glm::min(piece.low, point);
        piece.high = glm::max(piece.high, point);
        const double nearness = piece.polygon->depth.at(point.y, point.x);
        piece.farthest = std::min(piece.farthest, nearness);
        piece.nearest = std::max(piece.nearest, nearness);
    }
}

bool shareSamples(const NewellPiece& a, const NewellPiece& b) {
    size_t i = 0, j = 0;
    while (i < a.runs.size() && j < b.runs.size()) {
        const SampleRun &p = a.runs[i], &q = b.runs[j];
        if (p.row != q.row) {
            ++(p.row < q.row ? i : j);
            continue;
        }
        if (p.begin < q.end && q.begin < p.end) return true;
        ++(p.end <= q.begin ? i : j);
    }
    return false;
}

}  // namespace

NewellPiece wholePiece(const ScreenPolygon& polygon, int32_t width, int32_t height) {
    NewellPiece piece;
    piece.polygon = &polygon;
    scanPolygon(polygon.outline(), 0, height, width, [&](int32_t row, int32_t begin, int32_t end) {
        piece.runs.push_back({row, begin, end});
    });
    if (!piece.runs.empty()) measure(piece);
    return piece;
}

bool cutPiece(const NewellPiece& piece, const ScreenCut& cut, NewellPiece& kept, NewellPiece& rest) {
    std::vector<SampleRun> sides[2];
    for (const SampleRun& run : piece.runs)
        for (int side = 0; side < 2; ++side) {
            SampleRun part = run;
            (side == 0 ? cut : cut.otherSide()).narrow(run.row, part.begin, part.end);
            if (part.begin < part.end) sides[side].push_back(part);
        }
    if (sides[0].empty() || sides[1].empty()) return false;
    NewellPiece parts[2];
    for (int side = 0; side < 2; ++side) {
        parts[side].polygon = piece.polygon;
        parts[side].runs = std::move(sides[side]);
        measure(parts[side]);
    }
    kept = std::move(parts[0]);
    rest = std::move(parts[1]);
    return true;
}

PlaneSides sidesOf(const NewellPiece& piece, const DepthPlane& plane) {
    const DepthPlane& own = piece.polygon->depth;
    const double per_row = own.per_row - plane.per_row, per_sample = own.per_sample - plane.per_sample,
                 origin = own.origin - plane.origin;
    const double row_size = std::abs(own.per_row) + std::abs(plane.per_row),
                 sample_size = std::abs(own.per_sample) + std::abs(plane.per_sample),
                 origin_size = std::abs(own.origin) + std::abs(plane.origin);
    PlaneSides sides;
    for (const glm::ivec2& point : piece.hull) {
        const double above = origin + per_row * point.y + per_sample * point.x;
        const double thickness = kThickness * std::abs(own.at(point.y, point.x)) +
                                 kRounding * (origin_size + row_size * point.y + sample_size * point.x);
        sides.behind |= above < -thickness;
        sides.in_front |= above > thickness;
        if (sides.crosses()) break;
    }
    return sides;
}

NewellTest mayBeDrawnBefore(const NewellPiece& first, const NewellPiece& second) {
    if (first.nearest < second.farthest) return NewellTest::kDepth;
    if (first.high.x < second.low.x || second.high.x < first.low.x) return NewellTest::kColumns;
    if (first.high.y < second.low.y || second.high.y < first.low.y) return NewellTest::kRows;
    if (first.polygon == second.polygon) return NewellTest::kDisjoint;
    const PlaneSides of_first = sidesOf(first, second.polygon->depth);
    const PlaneSides of_second = sidesOf(second, first.polygon->depth);
    const bool first_ties = !of_first.behind && !of_first.in_front;
    const bool second_ties = !of_second.behind && !of_second.in_front;
    if (first_ties || second_ties) {
        if (first.polygon->surface > second.polygon->surface)
            return first_ties ? NewellTest::kBehind : NewellTest::kInFront;
    } else {
        if (!of_first.in_front) return NewellTest::kBehind;
        if (!of_second.behind) return NewellTest::kInFront;
    }
    return shareSamples(first, second) ? NewellTest::kNone : NewellTest::kDisjoint;
}

}  // namespace sightline::studies
