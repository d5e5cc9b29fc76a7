// Portal flow as compilers of the Quake family do it.
// SPDX-License-Identifier: MIT
#include "bench/classic_flow.h"

#include <algorithm>
#include <memory>
#include <numeric>
#include <span>
#include <vector>

#include "bench/stopwatch.h"

namespace sightline::bench {
namespace {

constexpr double kTouching = 1e-4;  // [world units]
constexpr size_t kMostCorners = 64;

using Polygon = std::vector<glm::dvec3>;

struct Way {
    Polygon outline;
    glm::dvec4 plane{0.0};  // the normal points along the way
    uint32_t from = 0, to = 0;
    bool done = false;
};

double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

/// Sutherland and Hodgman's; false: nothing is left above.
bool cut(Polygon& polygon, const glm::dvec4& plane, Polygon& scratch) {
    double high = -1e300, low = 1e300;
    for (const glm::dvec3& point : polygon) {
        const double height = heightOf(plane, point);
        high = std::max(high, height);
        low = std::min(low, height);
    }
    if (high < -kTouching) return false;
    if (low >= -kTouching || polygon.size() >= kMostCorners) return true;
    scratch.clear();
    for (size_t i = 0; i < polygon.size(); ++i) {
        const glm::dvec3 &a = polygon[i], &b = polygon[i + 1 == polygon.size() ? 0 : i + 1];
        const double at_a = heightOf(plane, a), at_b = heightOf(plane, b);
        if (at_a >= 0) scratch.push_back(a);
        if ((at_a >= 0) != (at_b >= 0)) scratch.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    if (scratch.size() < 3) return true;  // it touches
    std::swap(polygon, scratch);
    return true;
}

/// Cuts a target by all planes through an edge of one polygon and a corner of another that lie between the two.
/// @param over  the target is on the first one's side
bool cutBySeparators(const Polygon& first, const Polygon& second, bool over, Polygon& target, Polygon& scratch) {
    for (size_t i = 0; i < first.size(); ++i) {
        const glm::dvec3 &a = first[i], &b = first[i + 1 == first.size() ? 0 : i + 1];
        for (const glm::dvec3& corner : second) {
            glm::dvec3 normal = glm::cross(b - a, corner - a);
            const double length = glm::length(normal);
            if (length < kTouching) continue;
            normal /= length;
            glm::dvec4 plane(normal, -glm::dot(normal, a));
            double low = 0, high = 0;
            for (const glm::dvec3& point : first) {
                low = std::min(low, heightOf(plane, point));
                high = std::max(high, heightOf(plane, point));
            }
            if (low < -kTouching && high > kTouching) continue;
            if (low >= -kTouching && high <= kTouching) continue;
            if (high > kTouching) plane = -plane;
            const bool separates = std::all_of(second.begin(), second.end(), [&](const glm::dvec3& point) {
                return heightOf(plane, point) >= -kTouching;
            });
            if (!separates) continue;
            if (!cut(target, over ? -plane : plane, scratch)) return false;
            break;  // the other planes through this edge lie behind it
        }
    }
    return true;
}

class Flow {
public:
    Flow(const CellGraph& graph, double limit) : leaving_(graph.cells), start_(threadTime()), limit_(limit * 1e3) {
        for (const CellPortal& portal : graph.portals) {
            const std::span<const glm::dvec3> outline = graph.outline(portal);
            Way way;
            way.outline.assign(outline.begin(), outline.end());
            way.plane = portal.plane;
            way.from = portal.cells[1];
            way.to = portal.cells[0];
            leaving_[way.from].push_back(static_cast<uint32_t>(ways_.size()));
            ways_.push_back(way);
            std::reverse(way.outline.begin(), way.outline.end());
            way.plane = -way.plane;
            std::swap(way.from, way.to);
            leaving_[way.from].push_back(static_cast<uint32_t>(ways_.size()));
            ways_.push_back(way);
        }
        may_ = BitMatrix(ways_.size(), graph.cells);
        seen_ = BitMatrix(ways_.size(), graph.cells);
        cells_ = graph.cells;
    }

    ClassicFlow run() {
        for (uint32_t p = 0; p < ways_.size(); ++p) flood(p);
        std::vector<uint32_t> order(ways_.size()), sizes(ways_.size(), 0);
        for (uint32_t p = 0; p < ways_.size(); ++p)
            for (const uint64_t word : may_.row(p)) sizes[p] += static_cast<uint32_t>(std::popcount(word));
        std::iota(order.begin(), order.end(), 0);
        std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return sizes[a] < sizes[b]; });
        ClassicFlow answer;
        for (const uint32_t p : order) {
            first_ = p;
            State& state = at(0);
            state.source = ways_[p].outline;
            state.may.assign(may_.row(p).begin(), may_.row(p).end());
            enter(0, p);
            if (late_) break;
            ways_[p].done = true;
            ++answer.flowed;
        }
        answer.visible = BitMatrix(cells_, cells_);
        for (uint32_t p = 0; p < ways_.size(); ++p) {
            const std::span<const uint64_t> row = ways_[p].done ? seen_.row(p) : may_.row(p);
            const std::span<uint64_t> out = answer.visible.row(ways_[p].from);
            for (size_t w = 0; w < row.size(); ++w) out[w] |= row[w];
        }
        for (uint32_t cell = 0; cell < cells_; ++cell) answer.visible.set(cell, cell);
        answer.steps = steps_;
        answer.finished = !late_;
        answer.milliseconds = (threadTime() - start_) * 1e-3;
        return answer;
    }

private:
    struct State {
        Polygon source, window;
        std::vector<uint64_t> may;
    };

    State& at(size_t depth) {
        while (states_.size() <= depth) states_.push_back(std::make_unique<State>());
        return *states_[depth];
    }

    /// What half-spaces leave.
    void flood(uint32_t p) {
        const auto reaches = [](const glm::dvec4& plane, const Polygon& outline) {
            return std::any_of(outline.begin(), outline.end(),
                               [&](const glm::dvec3& point) { return heightOf(plane, point) > kTouching; });
        };
        std::vector<uint32_t> stack{ways_[p].to};
        may_.set(p, ways_[p].to);
        while (!stack.empty()) {
            const uint32_t cell = stack.back();
            stack.pop_back();
            for (const uint32_t q : leaving_[cell]) {
                if (may_.at(p, ways_[q].to) || !reaches(ways_[p].plane, ways_[q].outline) ||
                    !reaches(-ways_[q].plane, ways_[p].outline))
                    continue;
                may_.set(p, ways_[q].to);
                stack.push_back(ways_[q].to);
            }
        }
    }

    /// The cell behind `last`, the window of the state at this depth.
    void enter(size_t depth, uint32_t last) {
        seen_.set(first_, ways_[last].to);
        for (const uint32_t q : leaving_[ways_[last].to]) {
            const Way& way = ways_[q];
            State& then = at(depth + 1);
            const State& now = at(depth);
            if (late_) return;
            if (!(now.may[way.to / 64] >> (way.to % 64) & 1)) continue;
            const std::span<const uint64_t> row = way.done ? seen_.row(q) : may_.row(q);
            const std::span<const uint64_t> seen = seen_.row(first_);
            then.may.resize(now.may.size());
            uint64_t more = 0;
            for (size_t w = 0; w < row.size(); ++w) more |= (then.may[w] = now.may[w] & row[w]) & ~seen[w];
            if (!more && seen_.at(first_, way.to)) continue;
            if (++steps_ % 256 == 0 && threadTime() - start_ > limit_) late_ = true;
            then.window = way.outline;
            then.source = now.source;
            if (!pass(depth, now, then, way)) continue;
            enter(depth + 1, q);
        }
    }

    bool pass(size_t depth, const State& now, State& then, const Way& way) {
        const auto above = [](const glm::dvec4& plane, const Polygon& outline) {
            return std::any_of(outline.begin(), outline.end(),
                               [&](const glm::dvec3& point) { return heightOf(plane, point) > kTouching; });
        };
        if (!above(ways_[first_].plane, then.window) || !above(-way.plane, then.source)) return false;
        if (!cut(then.window, ways_[first_].plane, scratch_) || !cut(then.source, -way.plane, scratch_)) return false;
        if (depth == 0) return true;
        return cutBySeparators(then.source, now.window, false, then.window, scratch_) &&
               cutBySeparators(now.window, then.source, true, then.window, scratch_) &&
               cutBySeparators(then.window, now.window, false, then.source, scratch_) &&
               cutBySeparators(now.window, then.window, true, then.source, scratch_);
    }

    std::vector<Way> ways_;
    std::vector<std::vector<uint32_t>> leaving_;
    BitMatrix may_, seen_;
    std::vector<std::unique_ptr<State>> states_;
    Polygon scratch_;
    uint32_t cells_ = 0, first_ = 0;
    uint64_t steps_ = 0;
    double start_, limit_;
    bool late_ = false;
};

}  // namespace

ClassicFlow classicFlow(const CellGraph& graph, double limit) { return Flow(graph, limit).run(); }

}  // namespace sightline::bench
