// Holds rows of visibility against what segments have been seen to pass.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"

namespace sightline::tools {

/// No coordinate of a point is larger, whichever its sign.
inline double largestCoordinate(const glm::dvec3& p) { return std::max({std::abs(p.x), std::abs(p.y), std::abs(p.z)}); }

/// A pair that the rows lack, and the segment that passes from one to the other with nothing between.
struct RowMiss {
    uint32_t row = 0, column = 0;
    glm::dvec3 from{0.0}, to{0.0};
};

/// What segments had to say about rows.
struct RowReport {
    uint64_t segments = 0;          ///< that were followed
    uint64_t stretches = 0;         ///< places that they passed, in all
    uint64_t pairs = 0;             ///< ordered pairs that were looked up, the same ones many times
    uint64_t misses = 0;            ///< ordered pairs that the rows lack, each counted once: false negatives
    uint64_t doubtful = 0;          ///< alarms that are not beyond rounding: a segment passed a corner too closely
    uint64_t unmapped = 0;          ///< places passed, again and again, that have no row
    std::vector<RowMiss> examples;  ///< of the misses, the first ones

    bool clean() const { return misses == 0; }
};

struct RowCheckSettings {
    uint64_t seed = 1;
    uint64_t segments = 1u << 20;  ///< rounded up to whole batches
    double aimed = 0.5;            ///< share of the segments that are aimed  [0, 1]
    size_t most_examples = 64;     ///< of misses
    double farthest = 0;           ///< rows tell of nothing farther away than this; 0: no limit  [world units]
    Jobs* jobs = nullptr;          ///< threads; the report is the same with any
};

/// One thread's part of a check. What it finds is put together in the order of the parts.
class RowJudge {
public:
    static constexpr uint32_t kNoRow = ~0u;

    RowJudge(const BitMatrix& rows, bool gather_seen) : rows_(rows) {
        if (gather_seen) seen_ = BitMatrix(rows.rows(), rows.columns());
    }

    /// All of these are seen from one another, along a segment. `confirm(i, j)` says of an alarm whether it is beyond
    /// rounding: asked at most once for each pair of places.
    /// @param places   rows in the order of the segment; kNoRow among them counts as unmapped
    /// @param is_near  of two places, the first one before the other: whether the rows tell of pairs so far apart
    template <class Confirm, class IsNear>
    void judge(std::span<const uint32_t> places, const glm::dvec3& from, const glm::dvec3& to, Confirm&& confirm,
               IsNear&& is_near) {
        ++report_.segments;
        report_.stretches += places.size();
        for (size_t i = 0; i < places.size(); ++i) {
            if (places[i] == kNoRow) {
                ++report_.unmapped;
                continue;
            }
            for (size_t j = 0; j <= i; ++j) {
                if (places[j] == kNoRow || !is_near(j, i)) continue;
                report_.pairs += 2;
                if (rows_.at(places[i], places[j]) && rows_.at(places[j], places[i])) {
                    if (seen_.rows() != 0) markSeen(places[i], places[j]);
                    continue;
                }
                if (isKnown(places[i], places[j])) continue;
                if (!confirm(j, i)) {
                    ++report_.doubtful;
                    continue;
                }
                if (seen_.rows() != 0) markSeen(places[i], places[j]);
                addMiss({places[j], places[i], from, to});
                if (i != j) addMiss({places[i], places[j], to, from});
            }
        }
    }

    /// Adds what a later part has found. `missed` has a bit for each miss so far.
    void addTo(RowReport& report, BitMatrix& missed, size_t most_examples, BitMatrix* seen) const;

private:
    void markSeen(uint32_t a, uint32_t b) {
        seen_.set(a, b);
        seen_.set(b, a);
    }
    /// That the rows lack it, whichever way they do.
    bool isKnown(uint32_t a, uint32_t b) const { return missed_.rows() != 0 && (missed_.at(a, b) || missed_.at(b, a)); }
    void addMiss(const RowMiss& miss);

    const BitMatrix& rows_;
    BitMatrix seen_, missed_;
    RowReport report_;
};

}  // namespace sightline::tools
