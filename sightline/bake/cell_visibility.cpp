// SPDX-License-Identifier: MIT
#include "sightline/bake/cell_visibility.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <cstdio>
#include <numeric>

#include "sightline/bake/base_visibility.h"
#include "sightline/bake/portal_flow.h"
#include "sightline/bake/witness_rays.h"
#include "sightline/base/random.h"

namespace sightline {
namespace {

void markRun(BitMatrix& witnessed, std::span<const uint32_t> run) {
    for (const uint32_t a : run)
        for (const uint32_t b : run) witnessed.set(a, b);
}

/// Uniform in a convex polygon: in a triangle of its fan, chosen by area.
glm::dvec3 randomPoint(std::span<const glm::dvec3> outline, Random& random) {
    double total = 0;
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        total += glm::length(glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]));
    double chosen = random.uniform() * total;
    size_t i = 1;
    for (; i + 2 < outline.size(); ++i) {
        chosen -= glm::length(glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]));
        if (chosen < 0) break;
    }
    double u = random.uniform(), v = random.uniform();
    if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
    }
    return outline[0] + u * (outline[i] - outline[0]) + v * (outline[i + 1] - outline[0]);
}

struct Timer {
    std::chrono::steady_clock::time_point t = std::chrono::steady_clock::now();
    void lap(const char* what) {
        auto n = std::chrono::steady_clock::now();
        std::fprintf(stderr, "%-10s %.3f s\n", what, std::chrono::duration<double>(n - t).count());
        t = n;
    }
};

}  // namespace

CellVisibility bakeCellVisibility(const CellGraph& graph, const CellVisibilitySettings& settings) {
    Timer timer;
    const DirectedPortals directed = directPortals(graph);
    const uint32_t cells = graph.cells, portals = directed.size();
    timer.lap("direct");
    BitMatrix may = baseVisibility(directed, settings.jobs);
    timer.lap("base");
    tightenBase(directed, may, settings.jobs);
    timer.lap("tighten");

    CellVisibility answer;
    answer.witnessed = BitMatrix(cells, cells);
    for (uint32_t c = 0; c < cells; ++c) answer.witnessed.set(c, c);
    // Rays from portals to portals that may follow.
    WitnessRays rays(directed);
    std::vector<uint32_t> list;
    for (uint32_t p = 0; p < portals; ++p) {
        list.clear();
        const auto row = may.row(p);
        for (size_t w = 0; w < row.size(); ++w)
            for (uint64_t left = row[w]; left; left &= left - 1)
                list.push_back(static_cast<uint32_t>(w * 64 + static_cast<size_t>(std::countr_zero(left))));
        Random random(mixSeed(1, p));
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 a = randomPoint(directed.outline(p), random);
            const glm::dvec3 b = list.empty() ? a + directed.portals[p].normal
                                              : randomPoint(directed.outline(list[random.below(list.size())]), random);
            markRun(answer.witnessed, rays.through(p, a, b - a));
        }
    }
    timer.lap("rays");
    std::fprintf(stderr, "witnessed %llu\n", (unsigned long long)answer.witnessed.count());

    // Rounds: one ray for each pair of cells that is not settled.
    const int rounds = getenv("ROUNDS") ? atoi(getenv("ROUNDS")) : 0;
    for (int round = 0; round < rounds; ++round) {
        uint64_t before = answer.witnessed.count(), shot = 0;
        std::vector<uint32_t> into(cells), by(cells);
        for (uint32_t cell = 0; cell < cells; ++cell) {
            // Candidates per cell: a portal of this cell and a portal into that one, chosen at random among those seen.
            Random random(mixSeed(77 + round, cell));
            std::fill(into.begin(), into.end(), ~0u);
            std::vector<uint32_t> chances(cells, 0), order;
            for (uint32_t p = directed.first_of_cell[cell]; p < directed.first_of_cell[cell + 1]; ++p) {
                const auto row = may.row(p);
                for (size_t w = 0; w < row.size(); ++w)
                    for (uint64_t left = row[w]; left; left &= left - 1) {
                        const auto q = static_cast<uint32_t>(w * 64 + static_cast<size_t>(std::countr_zero(left)));
                        const uint32_t to = directed.portals[q].to;
                        if (answer.witnessed.at(cell, to)) continue;
                        if (!chances[to]) order.push_back(to);
                        if (random.below(++chances[to]) == 0) { into[to] = q; by[to] = p; }
                    }
            }
            for (uint32_t to : order) {
                if (answer.witnessed.at(cell, to)) continue;
                const glm::dvec3 a = randomPoint(directed.outline(by[to]), random);
                const glm::dvec3 b = randomPoint(directed.outline(into[to]), random);
                markRun(answer.witnessed, rays.through(by[to], a, b - a));
                ++shot;
            }
        }
        uint64_t after = answer.witnessed.count();
        std::fprintf(stderr, "round %d shot %llu found %llu\n", round, (unsigned long long)shot, (unsigned long long)(after - before));
        timer.lap("round");
    }

    // Flow, from portals that may see little to those that may see much.
    std::vector<uint32_t> order(portals), sizes(portals);
    std::iota(order.begin(), order.end(), 0);
    for (uint32_t p = 0; p < portals; ++p) {
        uint32_t size = 0;
        for (uint64_t w : may.row(p)) size += static_cast<uint32_t>(std::popcount(w));
        sizes[p] = size;
    }
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return sizes[a] < sizes[b]; });
    const FlowPlaces places(directed);
    PortalFlow flow(places, may);
    BitMatrix through(cells, cells);  // reached from cell through any of its portals
    FlowAnswer found;
    const size_t words = answer.witnessed.wordsPerRow();
    std::vector<uint64_t> asked(words);
    uint64_t steps = 0;
    for (uint32_t p : order) {
        const uint32_t from = directed.portals[p].from;
        for (size_t w = 0; w < words; ++w) asked[w] = ~answer.witnessed.row(from)[w];
        flow.from(p, asked, settings.budget, found);
        steps += found.steps;
        answer.over_budget += found.spent;
        for (size_t w = 0; w < words; ++w) through.row(from)[w] |= found.reached[w];
        // first step
        if (bool(asked[directed.portals[p].to / 64] >> (directed.portals[p].to % 64) & 1))
            through.set(from, directed.portals[p].to);
        for (size_t i = 0; i + 1 < found.seen_first.size(); ++i)
            markRun(answer.witnessed, std::span(found.seen).subspan(found.seen_first[i], found.seen_first[i + 1] - found.seen_first[i]));
        const auto row = may.row(p);
        for (size_t w = 0; w < row.size(); ++w)
            for (uint64_t left = row[w]; left; left &= left - 1) {
                const auto q = static_cast<uint32_t>(w * 64 + static_cast<size_t>(std::countr_zero(left)));
                const uint32_t to = directed.portals[q].to;
                if (!(asked[to / 64] >> (to % 64) & 1) || (found.reached[to / 64] >> (to % 64) & 1)) continue;
                row[w] &= ~(left & -left);
                may.clear(directed.portals[q].reverse, directed.portals[p].reverse);
            }
    }
    timer.lap("flow");
    answer.visible = BitMatrix(cells, cells);
    for (uint32_t a = 0; a < cells; ++a)
        for (uint32_t b = 0; b < cells; ++b)
            if (answer.witnessed.at(a, b) || (through.at(a, b) && through.at(b, a))) answer.visible.set(a, b);
    timer.lap("join");
    uint64_t v = answer.visible.count(), wi = answer.witnessed.count();
    std::fprintf(stderr, "visible %llu witnessed %llu unresolved %.2f%% steps %llu\n", (unsigned long long)v,
                 (unsigned long long)wi, 100.0 * double(v - wi) / double(v), (unsigned long long)steps);
    return answer;
}

}  // namespace sightline
