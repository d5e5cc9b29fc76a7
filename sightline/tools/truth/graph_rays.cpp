// Lines through a graph of cells: in each, which of its portals are crossed, and where.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/graph_rays.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline::tools {

GraphRays::GraphRays(const CellGraph& graph, const PortalMargin& margin) : graph_(graph), margin_(margin) {
    first_exit_.assign(graph.cells + 1, 0);
    for (const CellPortal& portal : graph.portals)
        for (const uint32_t cell : portal.cells) ++first_exit_[cell + 1];
    for (uint32_t cell = 0; cell < graph.cells; ++cell) first_exit_[cell + 1] += first_exit_[cell];
    exits_.resize(2 * graph.portals.size());
    std::vector<uint32_t> next(first_exit_.begin(), first_exit_.end() - 1);
    inward_.assign(graph.points.size(), glm::dvec3(0.0));
    for (uint32_t i = 0; i < graph.portals.size(); ++i) {
        const CellPortal& portal = graph.portals[i];
        for (uint32_t side = 0; side < 2; ++side)
            exits_[next[portal.cells[side]]++] = {i, portal.cells[1 - side], side == 0 ? 1.0 : -1.0};
        const auto outline = graph.outline(portal);
        double largest = 0;
        for (size_t k = 0; k < outline.size(); ++k) {
            largest = std::max(largest, largestCoordinate(outline[k]));
            const glm::dvec3 edge = outline[(k + 1) % outline.size()] - outline[k];
            const glm::dvec3 inward = glm::cross(glm::dvec3(portal.plane), edge);
            const double length = glm::length(inward);
            if (length > 0) inward_[portal.first + k] = inward / length;
        }
        margins_.push_back(margin.at(largest));
    }
}

bool GraphRays::isThrough(uint32_t number, const glm::dvec3& point) const {
    const CellPortal& portal = graph_.portals[number];
    for (uint32_t k = portal.first; k < portal.first + portal.count; ++k) {
        const glm::dvec3& inward = inward_[k];
        if (inward == glm::dvec3(0.0)) continue;  // two corners are one
        if (!(glm::dot(inward, point - graph_.points[k]) > margins_[number])) return false;
    }
    return true;
}

void GraphRays::follow(uint32_t cell, const glm::dvec3& point, const glm::dvec3& direction,
                       std::vector<GraphStep>& steps) const {
    steps.clear();
    steps.push_back({cell, GraphStep::kStart, 0});
    const double speed = glm::length(direction);
    for (uint32_t s = 0; s < steps.size(); ++s) {
        const GraphStep step = steps[s];
        for (uint32_t e = first_exit_[step.cell]; e < first_exit_[step.cell + 1]; ++e) {
            const Exit& exit = exits_[e];
            const CellPortal& portal = graph_.portals[exit.portal];
            const double toward = glm::dot(glm::dvec3(portal.plane), direction) * exit.side;
            if (!(toward < -1e-9 * speed)) continue;
            const double height = glm::dot(glm::dvec3(portal.plane), point) + portal.plane.w;
            const double at = -height * exit.side / toward;
            if (!(at > step.at) || !isThrough(exit.portal, point + at * direction)) continue;
            steps.push_back({exit.to, s, at});
            // Unions of cells can be entered again and again, but not without end.
            if (steps.size() > 4096) return;
        }
    }
}

namespace {

class Checker {
public:
    Checker(const GraphRays& rays, const BitMatrix& rows, double farthest, bool gather)
        : rays_(rays), farthest_(farthest), judge_(rows, gather) {
        const CellGraph& graph = rays.graph();
        first_portal_.assign(graph.cells + 1, 0);
        for (const CellPortal& portal : graph.portals)
            for (const uint32_t cell : portal.cells) ++first_portal_[cell + 1];
        for (uint32_t cell = 0; cell < graph.cells; ++cell) first_portal_[cell + 1] += first_portal_[cell];
        portals_.resize(2 * graph.portals.size());
        std::vector<uint32_t> next(first_portal_.begin(), first_portal_.end() - 1);
        for (uint32_t i = 0; i < graph.portals.size(); ++i)
            for (const uint32_t cell : graph.portals[i].cells) portals_[next[cell]++] = i;
    }

    void line(Random& random) {
        const CellGraph& graph = rays_.graph();
        const auto number = static_cast<uint32_t>(random.below(graph.portals.size()));
        const CellPortal& portal = graph.portals[number];
        const glm::dvec3 through = pointInHole(random, graph.outline(portal));
        glm::dvec3 direction = randomDirection(random);
        if (random.below(2) == 0) {
            const uint32_t cell = portal.cells[random.below(2)];
            const uint64_t count = first_portal_[cell + 1] - first_portal_[cell];
            const CellPortal& other = graph.portals[portals_[first_portal_[cell] + random.below(count)]];
            const glm::dvec3 toward = pointInHole(random, graph.outline(other)) - through;
            if (glm::length(toward) > 0) direction = glm::normalize(toward);
        }
        const double along = glm::dot(glm::dvec3(portal.plane), direction);
        if (!(std::abs(along) > 1e-9) || !isInside(number, through)) return;
        // Forward and backward are two walks; each chain of the one and each of the other make one line.
        const uint32_t ahead = along > 0 ? 0 : 1;
        rays_.follow(portal.cells[ahead], through, direction, forward_);
        rays_.follow(portal.cells[1 - ahead], through, -direction, backward_);
        chainsOf(backward_, back_chains_);
        chainsOf(forward_, front_chains_);
        for (const std::vector<uint32_t>& back : back_chains_)
            for (const std::vector<uint32_t>& front : front_chains_) {
                places_.clear();
                entered_.clear();
                for (size_t i = back.size(); i-- > 0;) {
                    places_.push_back(backward_[back[i]].cell);
                    // A walk backward enters a cell where one forward leaves it.
                    entered_.push_back(i + 1 < back.size() ? -backward_[back[i + 1]].at : 0);
                }
                for (const uint32_t step : front) {
                    places_.push_back(forward_[step].cell);
                    entered_.push_back(forward_[step].at);
                }
                const auto is_near = [&](size_t i, size_t j) {
                    if (!(farthest_ > 0) || i == j) return true;
                    const double left = entered_[i + 1], entered = entered_[j];
                    const double margin =
                        rays_.marginAt(through + left * direction) + rays_.marginAt(through + entered * direction);
                    return entered - left + 2 * margin <= farthest_;
                };
                judge_.judge(
                    places_, through - direction, through + direction, [](size_t, size_t) { return true; }, is_near);
            }
    }

    const RowJudge& judge() const { return judge_; }

private:
    bool isInside(uint32_t number, const glm::dvec3& point) const {
        const CellPortal& portal = rays_.graph().portals[number];
        const auto outline = rays_.graph().outline(portal);
        for (size_t k = 0; k < outline.size(); ++k) {
            const glm::dvec3 edge = outline[(k + 1) % outline.size()] - outline[k];
            const glm::dvec3 inward = glm::cross(glm::dvec3(portal.plane), edge);
            if (edge != glm::dvec3(0.0) &&
                !(glm::dot(inward, point - outline[k]) > rays_.marginOf(number) * glm::length(inward)))
                return false;
        }
        return true;
    }

    /// The ways from the start to each last step, as steps.
    static void chainsOf(const std::vector<GraphStep>& steps, std::vector<std::vector<uint32_t>>& chains) {
        std::vector<bool> inner(steps.size(), false);
        for (const GraphStep& step : steps)
            if (step.before != GraphStep::kStart) inner[step.before] = true;
        chains.clear();
        for (uint32_t s = 0; s < steps.size() && chains.size() < 64; ++s) {
            if (inner[s]) continue;
            chains.emplace_back();
            for (uint32_t k = s; k != GraphStep::kStart; k = steps[k].before) chains.back().push_back(k);
            std::reverse(chains.back().begin(), chains.back().end());
        }
    }

    const GraphRays& rays_;
    double farthest_;
    RowJudge judge_;
    std::vector<uint32_t> first_portal_, portals_;
    std::vector<GraphStep> forward_, backward_;
    std::vector<std::vector<uint32_t>> front_chains_, back_chains_;
    std::vector<uint32_t> places_;
    std::vector<double> entered_;  // per place where along the line; the first one is not read
};

}  // namespace

RowReport checkCellRows(const GraphRays& rays, const BitMatrix& rows, const RowCheckSettings& settings,
                        BitMatrix* seen) {
    SIGHTLINE_ASSERT(rows.rows() >= rays.graph().cells && rows.columns() >= rays.graph().cells);
    RowReport report;
    if (rays.graph().portals.empty()) return report;
    constexpr uint32_t kParts = 16;
    std::vector<Checker> parts(kParts, Checker(rays, rows, settings.farthest, seen != nullptr));
    runJobs(settings.jobs, kParts, [&](uint32_t part) {
        Random random(mixSeed(settings.seed, part));
        for (uint64_t i = 0; i < (settings.segments + kParts - 1) / kParts; ++i) parts[part].line(random);
    });
    BitMatrix missed(rows.rows(), rows.columns());
    for (const Checker& part : parts) part.judge().addTo(report, missed, settings.most_examples, seen);
    return report;
}

}  // namespace sightline::tools
