// The slow truth about rooms with doors along the axes: every chain of doors is tried, by lines through two of their corners.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <algorithm>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/cells/cells.h"

namespace sightline::test {

/// Doors are rectangles along the axes. A door's upright edges hold a line's plan to their left and to their right; the
/// same along each axis. Of doors as high as all rooms the plan alone says all there is: then this is the truth. Else it is a bound of it from above.
class PlanOracle {
public:
    /// @param wider  how much wider doors are taken to be on each side; negative: narrower  [world units]
    PlanOracle(const CellGraph& graph, double wider) : graph_(graph), exits_(graph.cells), on_way_(graph.cells, false) {
        for (const CellPortal& portal : graph.portals) {
            Exit exit;
            exit.low = exit.high = graph.outline(portal)[0];
            for (const glm::dvec3& point : graph.outline(portal)) {
                exit.low = glm::min(exit.low, point);
                exit.high = glm::max(exit.high, point);
            }
            for (int i = 0; i < 3; ++i)
                if (std::abs(portal.plane[i]) > 0.5) exit.axis = i;
            for (int i = 0; i < 3; ++i)
                if (i != exit.axis) exit.low[i] -= wider, exit.high[i] += wider;
            exit.sign = portal.plane[exit.axis] > 0 ? 1 : -1;
            exit.to = portal.cells[0];
            exits_[portal.cells[1]].push_back(exit);
            exit.sign = -exit.sign;
            exit.to = portal.cells[1];
            exits_[portal.cells[0]].push_back(exit);
        }
    }

    BitMatrix all() {
        BitMatrix seen(graph_.cells, graph_.cells);
        for (uint32_t cell = 0; cell < graph_.cells; ++cell) visit(cell, seen.row(cell));
        return seen;
    }

private:
    struct Exit {
        glm::dvec3 low, high;
        int axis = 0;
        double sign = 1;
        uint32_t to = 0;
    };
    /// What lies to the left and to the right of a line in a plan.
    struct Sides {
        std::vector<glm::dvec2> left, right;
    };

    void visit(uint32_t cell, std::span<uint64_t> row) {
        row[cell / 64] |= uint64_t(1) << (cell % 64);
        on_way_[cell] = true;
        for (const Exit& exit : exits_[cell]) {
            if (on_way_[exit.to]) continue;  // a line is in a convex cell once
            bool passes = true;
            for (int plan = 0; plan < 3; ++plan) {
                if (plan == exit.axis) continue;
                push(exit, plan);
            }
            for (int plan = 0; plan < 3 && passes; ++plan) passes = plan == exit.axis || canPass(sides_[plan]);
            if (passes) visit(exit.to, row);
            for (int plan = 0; plan < 3; ++plan) {
                if (plan == exit.axis) continue;
                sides_[plan].left.pop_back();
                sides_[plan].right.pop_back();
            }
        }
        on_way_[cell] = false;
    }

    /// The door as a segment in the plan along axis `plan`.
    void push(const Exit& exit, int plan) {
        const int u = (plan + 1) % 3, v = (plan + 2) % 3;
        const glm::dvec2 a(exit.low[u], exit.low[v]), b(exit.high[u], exit.high[v]);
        const glm::dvec2 way = exit.sign * (exit.axis == u ? glm::dvec2(1, 0) : glm::dvec2(0, 1));
        const bool b_is_left = way.x * (b.y - a.y) - way.y * (b.x - a.x) > 0;
        sides_[plan].left.push_back(b_is_left ? b : a);
        sides_[plan].right.push_back(b_is_left ? a : b);
    }

    /// If some line has all of the left ones on its left and all of the right ones on its right, one does that
    /// goes through one of each.
    static bool canPass(const Sides& sides) {
        const size_t n = sides.left.size();
        for (size_t i = 0; i < n; ++i)
            for (size_t k = 0; k < n; ++k)
                for (const double sign : {1.0, -1.0}) {
                    const glm::dvec2 from = sides.left[i], way = sign * (sides.right[k] - from);
                    const auto side = [&](const glm::dvec2& p) {
                        return way.x * (p.y - from.y) - way.y * (p.x - from.x);
                    };
                    const double room =
                        1e-14 * (std::abs(way.x) + std::abs(way.y)) * (1 + std::abs(from.x) + std::abs(from.y));
                    bool all = true;
                    for (size_t m = 0; m < n && all; ++m)
                        all = (m == i || side(sides.left[m]) >= -room) && (m == k || side(sides.right[m]) <= room);
                    if (all) return true;
                }
        return false;
    }

    const CellGraph& graph_;
    std::vector<std::vector<Exit>> exits_;
    std::vector<bool> on_way_;
    Sides sides_[3];
};

}  // namespace sightline::test
