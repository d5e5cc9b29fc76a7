// Newell's algorithm: a painter's whose order is proved pair by pair, and who cuts polygons where there is none.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/newell.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "sightline/studies/hidden/methods/fill.h"
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

constexpr int kTileBits = 5;  ///< tiles of 32 by 32 samples

/// Farthest first; of equally far ones the higher surface number.
struct Waiting {
    double farthest = 0;
    uint32_t surface = 0, piece = 0;

    bool operator<(const Waiting& other) const {
        return farthest != other.farthest ? farthest > other.farthest : surface < other.surface;
    }
};

class Sorter {
public:
    Sorter(uint32_t width, uint32_t height, HiddenCounters& counters, NewellOrder& result)
        : columns_(((width - 1) >> kTileBits) + 1),
          tiles_(size_t{columns_} * (((height - 1) >> kTileBits) + 1)),
          counters_(counters),
          result_(result) {}

    void add(NewellPiece piece) {
        const uint32_t place = static_cast<uint32_t>(result_.pieces.size());
        waiting_.push({piece.farthest, piece.polygon->surface, place});
        for (int32_t row = piece.low.y >> kTileBits; row <= piece.high.y >> kTileBits; ++row)
            for (int32_t column = piece.low.x >> kTileBits; column <= piece.high.x >> kTileBits; ++column)
                tiles_[size_t(row) * columns_ + size_t(column)].push_back(place);
        result_.pieces.push_back(std::move(piece));
        facts_.push_back({});
    }

    void run(uint64_t limit) {
        while (!waiting_.empty() && counters_.comparisons < limit) {
            const uint32_t piece = waiting_.top().piece;
            waiting_.pop();
            if (facts_[piece].state != State::kWaiting) continue;
            enter(piece);
            while (!stack_.empty() && counters_.comparisons < limit) step();
        }
        result_.proved = result_.order.size();
        for (uint32_t i = 0; i < facts_.size(); ++i)
            if (facts_[i].state == State::kWaiting || facts_[i].state == State::kMarked) result_.order.push_back(i);
    }

private:
    enum class State : uint8_t { kWaiting, kMarked, kDrawn, kCut };
    struct Facts {
        State state = State::kWaiting;
        uint32_t parts = 0;        ///< of a piece that was cut: the first of two
        uint32_t gathered_by = 0;  ///< the last gathering that met it
    };
    /// A piece whose turn it is, or that waits for the one after it: the one that was moved before it.
    struct Turn {
        uint32_t piece = 0;
        size_t next = 0;               ///< of `others`: it may be drawn before all up to here
        std::vector<uint32_t> others;  ///< what overlaps it on the screen and in depth
    };

    void enter(uint32_t piece) {
        facts_[piece].state = State::kMarked;
        stack_.push_back({piece, 0, {}});
        gather(stack_.back());
    }

    /// Collects what overlaps a piece in its extents: the depth test and the first two of the five.
    void gather(Turn& turn) {
        const NewellPiece& piece = result_.pieces[turn.piece];
        ++gatherings_;
        for (int32_t row = piece.low.y >> kTileBits; row <= piece.high.y >> kTileBits; ++row)
            for (int32_t column = piece.low.x >> kTileBits; column <= piece.high.x >> kTileBits; ++column) {
                std::vector<uint32_t>& tile = tiles_[size_t(row) * columns_ + size_t(column)];
                size_t kept = 0;
                for (const uint32_t other : tile) {
                    Facts& facts = facts_[other];
                    if (facts.state == State::kDrawn || facts.state == State::kCut) continue;
                    tile[kept++] = other;
                    if (facts.gathered_by == gatherings_ || other == turn.piece) continue;
                    facts.gathered_by = gatherings_;
                    ++counters_.comparisons;
                    if (overlapInExtents(piece, result_.pieces[other])) turn.others.push_back(other);
                }
                tile.resize(kept);
            }
    }

    static bool overlapInExtents(const NewellPiece& first, const NewellPiece& second) {
        return first.nearest >= second.farthest && first.low.x <= second.high.x && second.low.x <= first.high.x &&
               first.low.y <= second.high.y && second.low.y <= first.high.y;
    }

    void step() {
        Turn& turn = stack_.back();
        Facts& own = facts_[turn.piece];
        if (own.state == State::kCut) {
            stack_.pop_back();
            return;
        }
        if (turn.next == turn.others.size()) {
            own.state = State::kDrawn;
            result_.order.push_back(turn.piece);
            stack_.pop_back();
            return;
        }
        const uint32_t other = turn.others[turn.next];
        const Facts facts = facts_[other];
        if (facts.state == State::kCut) {
            turn.others[turn.next] = facts.parts;
            turn.others.push_back(facts.parts + 1);
            return;
        }
        if (facts.state == State::kDrawn) {
            ++turn.next;
            return;
        }
        compare(turn, other);
    }

    void compare(Turn& turn, uint32_t other) {
        ++counters_.comparisons;
        const uint32_t piece = turn.piece;
        if (mayBeDrawnBefore(result_.pieces[piece], result_.pieces[other]) != NewellTest::kNone) {
            ++turn.next;
            return;
        }
        if (facts_[other].state == State::kWaiting) {
            ++counters_.comparisons;
            if (mayBeDrawnBefore(result_.pieces[other], result_.pieces[piece]) != NewellTest::kNone) {
                ++counters_.swaps;
                enter(other);
                return;
            }
        }
        // Two samples at the same place in a cycle: they differ by less than the planes' thickness.
        if (!cutByPlane(piece, other) && !cutByPlane(other, piece) && !cutAlong(piece, other) &&
            !cutAlong(other, piece) && !halve(piece) && !halve(other))
            ++turn.next;
    }

    bool cut(uint32_t place, const ScreenCut& line) {
        NewellPiece kept, rest;
        if (!cutPiece(result_.pieces[place], line, kept, rest)) return false;
        ++counters_.splits;
        facts_[place].state = State::kCut;
        facts_[place].parts = static_cast<uint32_t>(result_.pieces.size());
        add(std::move(kept));
        add(std::move(rest));
        NewellPiece& old = result_.pieces[place];
        old.runs = {};
        old.hull = {};
        return true;
    }

    bool cutByPlane(uint32_t place, uint32_t by) {
        const NewellPiece &piece = result_.pieces[place], &other = result_.pieces[by];
        if (!sidesOf(piece, other.polygon->depth).crosses()) return false;
        return cut(place, nearerThan(piece.polygon->depth, other.polygon->depth));
    }

    /// Cuts off what lies beyond an edge of the other's hull, or of its extents.
    bool cutAlong(uint32_t place, uint32_t by) {
        const std::vector<glm::ivec2>& hull = result_.pieces[by].hull;
        for (size_t i = 0; i < hull.size() && hull.size() > 1; ++i) {
            const glm::dvec2 a(hull[i]), b(hull[i + 1 < hull.size() ? i + 1 : 0]);
            const glm::dvec2 along = b - a;
            if (cut(place, {-along.y, along.x, along.y * a.x - along.x * a.y, false})) return true;
        }
        const glm::dvec2 low(result_.pieces[by].low), high(result_.pieces[by].high);
        return cut(place, {1, 0, -low.x, false}) || cut(place, {-1, 0, high.x, false}) ||
               cut(place, {0, 1, -low.y, false}) || cut(place, {0, -1, high.y, false});
    }

    bool halve(uint32_t place) {
        const glm::ivec2 low = result_.pieces[place].low, high = result_.pieces[place].high;
        if (low == high) return false;
        const glm::dvec2 middle = 0.5 * (glm::dvec2(low) + glm::dvec2(high));
        if (high.x - low.x >= high.y - low.y) return cut(place, {1, 0, -middle.x, false});
        return cut(place, {0, 1, -middle.y, false});
    }

    uint32_t columns_ = 0, gatherings_ = 0;
    std::vector<std::vector<uint32_t>> tiles_;  ///< what has a part of its extents there
    std::vector<Facts> facts_;
    std::vector<Turn> stack_;
    std::priority_queue<Waiting> waiting_;
    HiddenCounters& counters_;
    NewellOrder& result_;
};

/// Nearer than all that is drawn, but in no order among themselves: decided sample by sample, the first of equals kept.
void drawUnordered(const NewellOrder& order, HiddenImage& image) {
    std::vector<double> nearest(image.surface.size(), -std::numeric_limits<double>::infinity());
    std::vector<uint32_t> rest(order.order.begin() + static_cast<std::ptrdiff_t>(order.proved), order.order.end());
    std::sort(rest.begin(), rest.end(), [&](uint32_t a, uint32_t b) {
        return order.pieces[a].polygon->surface < order.pieces[b].polygon->surface;
    });
    for (const uint32_t place : rest) {
        const NewellPiece& piece = order.pieces[place];
        for (const SampleRun& run : piece.runs)
            for (int32_t i = run.begin; i < run.end; ++i) {
                double& here = nearest[size_t(run.row) * image.width + size_t(i)];
                const double nearness = piece.polygon->depth.at(run.row, i);
                ++image.counters.tested;
                countSpan(image, image.tested, run.row, i, i + 1);
                if (nearness <= here) {
                    ++image.counters.generated;
                    countSpan(image, image.generated, run.row, i, i + 1);
                    continue;
                }
                here = nearness;
                fillSpan(image, run.row, i, i + 1, piece.polygon->surface);
            }
    }
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

NewellOrder newellOrder(std::span<const ScreenPolygon> polygons, uint32_t width, uint32_t height,
                        HiddenCounters& counters, uint64_t limit) {
    NewellOrder result;
    Sorter sorter(width, height, counters, result);
    for (const ScreenPolygon& polygon : polygons) {
        NewellPiece piece = wholePiece(polygon, static_cast<int32_t>(width), static_cast<int32_t>(height));
        if (!piece.runs.empty()) sorter.add(std::move(piece));
    }
    sorter.run(limit);
    return result;
}

void drawInOrder(const NewellOrder& order, HiddenImage& image) {
    for (size_t i = 0; i < order.proved; ++i) {
        const NewellPiece& piece = order.pieces[order.order[i]];
        for (const SampleRun& run : piece.runs) fillSpan(image, run.row, run.begin, run.end, piece.polygon->surface);
    }
    if (order.proved < order.order.size()) drawUnordered(order, image);
}

void drawNewell(const HiddenInput& input, HiddenImage& image) {
    Projector projector = input.projector();
    const std::vector<ScreenPolygon> polygons = projectAll(input.list, projector);
    image.counters.geometry = projector.counters();
    const uint64_t limit = (1u << 25) + 4096 * uint64_t{polygons.size()};
    const NewellOrder order = newellOrder(polygons, image.width, image.height, image.counters, limit);
    drawInOrder(order, image);
}

}  // namespace sightline::studies
