// The bake of rows, step by step: bounds by half-spaces, rays, then flows in batches.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/cell_visibility.h"

#include <algorithm>
#include <bit>
#include <numeric>
#include <span>
#include <vector>

#include "sightline/bake/flow/base_visibility.h"
#include "sightline/bake/flow/flow_pool.h"
#include "sightline/bake/flow/random_point.h"
#include "sightline/bake/flow/thin_cells.h"
#include "sightline/bake/flow/witness_rays.h"
#include "sightline/math/box.h"

namespace sightline::bake {
namespace {

constexpr double kBaseShare = 0.6;  // of the base's time, for the first flood
constexpr uint32_t kRaysPerPortal = 8;
constexpr uint32_t kRayTask = 64;  // portals
/// This many flows read the same frozen state. The answer depends on the number, and so the number does not depend on
/// the threads.
constexpr uint32_t kBatch = 64;
/// So many flows that need much share what is to spare. The answer depends on it as well.
constexpr uint32_t kTogether = 4;

template <class Visit>
void forEachBit(std::span<const uint64_t> row, Visit&& visit) {
    for (size_t w = 0; w < row.size(); ++w)
        for (uint64_t left = row[w]; left; left &= left - 1)
            visit(static_cast<uint32_t>(w * 64) + static_cast<uint32_t>(std::countr_zero(left)));
}

uint32_t bitsOf(std::span<const uint64_t> row) {
    uint32_t bits = 0;
    for (const uint64_t word : row) bits += static_cast<uint32_t>(std::popcount(word));
    return bits;
}

bool has(std::span<const uint64_t> row, uint32_t i) { return row[i / 64] >> (i % 64) & 1; }

/// Marks all cells of one ray: they see one another.
void markRun(BitMatrix& witnessed, std::span<const uint32_t> run) {
    for (const uint32_t a : run)
        for (const uint32_t b : run) witnessed.set(a, b);
}

/// Runs of cells, one after the other.
struct Runs {
    std::vector<uint32_t> cells;
    std::vector<uint32_t> first{0};

    void add(std::span<const uint32_t> run) {
        cells.insert(cells.end(), run.begin(), run.end());
        first.push_back(static_cast<uint32_t>(cells.size()));
    }
};

void markRuns(BitMatrix& witnessed, std::span<const uint32_t> cells, std::span<const uint32_t> first) {
    for (size_t i = 0; i + 1 < first.size(); ++i) markRun(witnessed, cells.subspan(first[i], first[i + 1] - first[i]));
}

class Bake {
public:
    Bake(const CellGraph& graph, const CellVisibilitySettings& settings)
        : settings_(settings),
          stop_(settings.stop),
          thin_(mergeThinCells(graph)),
          directed_(flowPortalsOf(thin_.any ? thin_.graph : graph)),
          rays_(directed_),
          places_(directed_) {}

    CellVisibility run() {
        if (settings_.resume) {
            state_ = std::move(*settings_.resume);
        } else {
            tell("base", 0);
            BaseSettings base{settings_.jobs, &stop_};
            base.tell = [&](uint32_t done, uint32_t all) { tell("base", kBaseShare * done / all); };
            state_.may = baseVisibility(directed_, base);
            if (stop_.stopped()) return allVisible();
            dropFarFollowers();
            base.tell = [&](uint32_t done, uint32_t all) { tell("base", kBaseShare + (1 - kBaseShare) * done / all); };
            tightenBase(directed_, state_.may, base);
            state_.witnessed = BitMatrix(directed_.cells(), directed_.cells());
            state_.reached = BitMatrix(directed_.cells(), directed_.cells());
            for (uint32_t cell = 0; cell < directed_.cells(); ++cell) state_.witnessed.set(cell, cell);
            tell("rays", 0);
            castRays();
            orderFlows();
            if (stop_.stopped()) return join();  // not all that a bake that goes on rests on
        }
        flow();
        if (stop_.stopped() && settings_.checkpoint) settings_.checkpoint(state_);
        return join();
    }

private:
    /// Nothing is known of any pair.
    CellVisibility allVisible() const {
        const size_t cells = thin_.any ? thin_.cell_of_cell.size() : directed_.cells();
        CellVisibility answer;
        answer.stopped = true;
        answer.visible = filled(cells);
        answer.witnessed = BitMatrix(cells, cells);
        for (size_t cell = 0; cell < cells; ++cell) answer.witnessed.set(cell, cell);
        if (settings_.keep_follows) answer.follows = filled(directed_.size());
        return answer;
    }

    static BitMatrix filled(size_t size) {
        BitMatrix matrix(size, size);
        for (size_t row = 0; row < size; ++row) {
            const std::span<uint64_t> words = matrix.row(row);
            std::fill(words.begin(), words.end(), ~uint64_t(0));
            if (size % 64 != 0) words.back() = ~(~uint64_t(0) << (size % 64));
        }
        return matrix;
    }

    void tell(const char* step, double done) const {
        if (settings_.progress) settings_.progress({step, done});
    }

    /// No segment passes both of two portals that are farther apart than sight reaches.
    void dropFarFollowers() {
        if (!(settings_.farthest > 0)) return;
        runJobs(settings_.jobs, directed_.size(), [&](uint32_t p) {
            forEachBit(state_.may.row(p), [&](uint32_t q) {
                if (!isNear(p, q)) state_.may.clear(p, q);
            });
        });
    }

    bool isNear(uint32_t p, uint32_t q) const {
        const FlowPortal &a = directed_.portals[p], &b = directed_.portals[q];
        // Welding moved points by up to the precision.
        const double reach = settings_.farthest + 8 * directed_.precision + directed_.rounding;
        if (glm::distance(a.center, b.center) - a.radius - b.radius > reach) return false;
        const Box3d box_p = boxOf(p), box_q = boxOf(q);
        const glm::dvec3 apart = glm::max(glm::max(box_p.min - box_q.max, box_q.min - box_p.max), glm::dvec3(0.0));
        return glm::length(apart) <= reach;
    }

    Box3d boxOf(uint32_t p) const {
        Box3d box;
        for (const glm::dvec3& point : directed_.outline(p)) box.grow(point);
        return box;
    }

    /// Takes back all pairs of cells that no two portals within reach lead from and into.
    void dropFarPairs(BitMatrix& pairs) const {
        if (!(settings_.farthest > 0)) return;
        BitMatrix near(directed_.cells(), directed_.cells());
        for (uint32_t cell = 0; cell < directed_.cells(); ++cell) near.set(cell, cell);
        for (uint32_t p = 0; p < directed_.size(); ++p) near.set(directed_.portals[p].from, directed_.portals[p].to);
        for (uint32_t from = 0; from < directed_.cells(); ++from)
            forEachBit(pairs.row(from), [&](uint32_t to) {
                if (!near.at(from, to) && !leadWithinReach(from, to)) pairs.clear(from, to);
            });
    }

    bool leadWithinReach(uint32_t from, uint32_t to) const {
        for (uint32_t p = directed_.first_of_cell[from]; p < directed_.first_of_cell[from + 1]; ++p)
            for (uint32_t q = directed_.first_of_cell[to]; q < directed_.first_of_cell[to + 1]; ++q)
                if (isNear(p, q)) return true;
        return false;
    }

    /// Casts rays from points of each portal to points of portals that may follow it.
    void castRays() {
        const uint32_t tasks = (directed_.size() + kRayTask - 1) / kRayTask;
        std::vector<Runs> found(tasks);
        runJobs(settings_.jobs, tasks, [&](uint32_t task) {
            if (stop_.asks()) return;
            std::vector<uint32_t> may, run;
            for (uint32_t p = task * kRayTask; p < std::min(directed_.size(), (task + 1) * kRayTask); ++p) {
                may.clear();
                forEachBit(state_.may.row(p), [&](uint32_t q) { may.push_back(q); });
                Random random(mixSeed(1, p));
                for (uint32_t i = 0; i < kRaysPerPortal; ++i) {
                    const glm::dvec3 from = randomPoint(directed_.outline(p), random);
                    const glm::dvec3 to = may.empty()
                                              ? from + directed_.portals[p].normal
                                              : randomPoint(directed_.outline(may[random.below(may.size())]), random);
                    rays_.through(p, from, to - from, run);
                    if (run.size() > 1) found[task].add(run);
                }
            }
        });
        for (const Runs& runs : found) markRuns(state_.witnessed, runs.cells, runs.first);
    }

    /// Puts portals first that few others may follow: what their flows find out serves the later ones.
    void orderFlows() {
        std::vector<uint32_t> sizes(directed_.size());
        for (uint32_t p = 0; p < directed_.size(); ++p) sizes[p] = bitsOf(state_.may.row(p));
        state_.order.resize(directed_.size());
        std::iota(state_.order.begin(), state_.order.end(), 0);
        std::stable_sort(state_.order.begin(), state_.order.end(),
                         [&](uint32_t a, uint32_t b) { return sizes[a] < sizes[b]; });
    }

    void flow() {
        FlowPool pool(places_, rays_, state_.may);
        std::vector<FlowAnswer> answers(kBatch);
        std::vector<std::vector<uint64_t>> asked(kBatch);
        const size_t words = state_.witnessed.wordsPerRow();
        if (!state_.order.empty()) tell("flow", shareOf(state_.flowed));  // where this run begins
        while (state_.flowed < state_.order.size()) {
            if (stop_.asks()) break;
            const auto batch = std::span<const uint32_t>(state_.order)
                                   .subspan(state_.flowed)
                                   .first(std::min<size_t>(kBatch, state_.order.size() - state_.flowed));
            const FlowLimits limits{settings_.budget, shareOfWork(), &stop_};
            runJobs(settings_.jobs, static_cast<uint32_t>(batch.size()), [&](uint32_t i) {
                const uint32_t from = directed_.portals[batch[i]].from;
                asked[i].resize(words);
                for (size_t w = 0; w < words; ++w) asked[i][w] = ~state_.witnessed.row(from)[w];
                if (directed_.cells() % 64 != 0) asked[i].back() &= ~(~uint64_t(0) << (directed_.cells() % 64));
                pool.from(batch[i], asked[i], limits, answers[i]);
            });
            if (!stop_.stopped()) flowAgain(batch, asked, limits, pool, answers);
            if (stop_.stopped()) break;  // some of the batch have not ended by themselves
            for (uint32_t i = 0; i < batch.size(); ++i) apply(batch[i], asked[i], answers[i]);
            state_.flowed += batch.size();
            tell("flow", shareOf(state_.flowed));
            if (settings_.checkpoint) settings_.checkpoint(state_);
        }
    }

    /// Flows that their share did not suffice for have more, a few together, as long as something is to spare.
    void flowAgain(std::span<const uint32_t> batch, const std::vector<std::vector<uint64_t>>& asked, FlowLimits limits,
                   FlowPool& pool, std::vector<FlowAnswer>& answers) {
        const uint64_t at_first = limits.work;
        std::vector<uint32_t> spent;
        for (uint32_t i = 0; i < batch.size(); ++i)
            if (limits.work > 0 && answers[i].spent && answers[i].work >= limits.work) spent.push_back(i);
        uint64_t done = 0;
        for (uint32_t i = 0; i < batch.size(); ++i) done += answers[i].work;
        for (size_t begin = 0; begin < spent.size() && !stop_.stopped(); begin += kTogether) {
            const auto group = std::span<const uint32_t>(spent).subspan(begin).first(
                std::min<size_t>(kTogether, spent.size() - begin));
            const uint64_t share = spareWork(state_.work + done) / kTogether;
            if (share <= at_first) return;
            limits.work = share;
            for (const uint32_t i : group) state_.work += answers[i].work;  // in vain
            runJobs(settings_.jobs, static_cast<uint32_t>(group.size()),
                    [&](uint32_t i) { pool.from(batch[group[i]], asked[group[i]], limits, answers[group[i]]); });
            done = 0;
            for (uint32_t i = 0; i < batch.size(); ++i) done += answers[i].work;
        }
    }

    /// What is left for flows that need more than others.
    uint64_t spareWork(uint64_t done) const {
        const uint64_t left = settings_.work - std::min(settings_.work, done);
        return left - std::min(left, settings_.work / 2);
    }

    /// What one of the next flows may cost at first; 0: no limit.
    uint64_t shareOfWork() const {
        if (settings_.work == 0) return 0;
        const uint64_t left = settings_.work - std::min(settings_.work, state_.work), spare = spareWork(state_.work);
        const uint64_t alike = (left - spare) / (state_.order.size() - state_.flowed);
        return std::max<uint64_t>(1, alike + spare / kBatch);
    }

    /// The share of the work that is done. Late flows have more to do than early ones.
    double shareOf(uint64_t flowed) const {
        const double share = static_cast<double>(flowed) / static_cast<double>(state_.order.size());
        const double of_work =
            settings_.work == 0 ? 0 : static_cast<double>(state_.work) / static_cast<double>(settings_.work);
        return std::max(share * share, std::min(0.99 * of_work, 0.99));
    }

    void apply(uint32_t p, std::span<const uint64_t> asked, const FlowAnswer& answer) {
        state_.steps += answer.steps;
        state_.work += answer.work;
        state_.over_budget += answer.spent;
        state_.empty_chains += answer.empty_chains;
        const FlowPortal& portal = directed_.portals[p];
        const std::span<uint64_t> reached = state_.reached.row(portal.from);
        for (size_t w = 0; w < reached.size(); ++w) reached[w] |= answer.reached[w];
        state_.reached.set(portal.from, portal.to);
        markRuns(state_.witnessed, answer.seen, answer.seen_first);
        if (answer.spent) return;
        // The flow asked for these cells and did not reach them: portals into them cannot follow.
        forEachBit(state_.may.row(p), [&](uint32_t q) {
            const uint32_t to = directed_.portals[q].to;
            if (!has(asked, to) || has(answer.reached, to)) return;
            state_.may.clear(p, q);
            state_.may.clear(directed_.portals[q].reverse, portal.reverse);
        });
    }

    CellVisibility join() {
        seeAllThatMayFollow();
        CellVisibility answer;
        answer.over_budget = state_.over_budget;
        answer.steps = state_.steps;
        answer.empty_chains = state_.empty_chains;
        answer.stopped = stop_.stopped();
        answer.visible = state_.witnessed;
        for (uint32_t a = 0; a < directed_.cells(); ++a)
            forEachBit(state_.reached.row(a), [&](uint32_t b) {
                if (state_.reached.at(b, a)) answer.visible.set(a, b);
            });
        dropFarPairs(answer.visible);
        answer.witnessed = std::move(state_.witnessed);
        dropFarPairs(answer.witnessed);
        if (thin_.any) {
            // A ray that witnesses a merged cell need not pass each of its parts.
            answer.visible = apart(answer.visible);
            answer.witnessed = apart(answer.witnessed);
            keepWitnesses(answer);
        }
        if (settings_.keep_follows) answer.follows = std::move(state_.may);
        return answer;
    }

    /// Portals whose flow was not run see all that may follow them.
    void seeAllThatMayFollow() {
        std::vector<uint8_t> flowed(directed_.size(), 0);
        for (size_t i = 0; i < state_.flowed; ++i) flowed[state_.order[i]] = 1;
        std::vector<uint64_t> any(state_.may.wordsPerRow());
        for (uint32_t cell = 0; cell < directed_.cells(); ++cell) {
            std::fill(any.begin(), any.end(), 0);
            for (uint32_t p = directed_.first_of_cell[cell]; p < directed_.first_of_cell[cell + 1]; ++p) {
                if (flowed[p]) continue;
                state_.reached.set(cell, directed_.portals[p].to);
                const std::span<const uint64_t> row = state_.may.row(p);
                for (size_t w = 0; w < any.size(); ++w) any[w] |= row[w];
            }
            forEachBit(any, [&](uint32_t q) { state_.reached.set(cell, directed_.portals[q].to); });
        }
    }

    /// Takes back the witness of every pair with a part of a merged cell, unless both are the same cell.
    void keepWitnesses(CellVisibility& answer) const {
        const size_t cells = thin_.cell_of_cell.size();
        std::vector<uint32_t> parts(directed_.cells(), 0);
        for (const uint32_t cell : thin_.cell_of_cell) ++parts[cell];
        for (size_t a = 0; a < cells; ++a)
            for (size_t b = 0; b < cells; ++b)
                if (a != b && (parts[thin_.cell_of_cell[a]] > 1 || parts[thin_.cell_of_cell[b]] > 1))
                    answer.witnessed.clear(a, b);
    }

    /// Turns a matrix of merged cells into one of the cells of the graph.
    BitMatrix apart(const BitMatrix& merged) const {
        const size_t cells = thin_.cell_of_cell.size();
        BitMatrix out(cells, cells);
        for (size_t a = 0; a < cells; ++a)
            for (size_t b = 0; b < cells; ++b)
                if (merged.at(thin_.cell_of_cell[a], thin_.cell_of_cell[b])) out.set(a, b);
        return out;
    }

    const CellVisibilitySettings& settings_;
    StopAsker stop_;
    const ThinMerged thin_;
    const FlowPortals directed_;
    const WitnessRays rays_;
    const FlowPlaces places_;
    CellVisibilityState state_;
};

}  // namespace

CellVisibility bakeCellVisibility(const CellGraph& graph, const CellVisibilitySettings& settings) {
    return Bake(graph, settings).run();
}

}  // namespace sightline::bake
