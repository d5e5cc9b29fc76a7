// Two runs of one path beside one another: what B keeps, costs and gets wrong against A.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "sightline/tools/report/run/run_reader.h"

namespace sightline::tools {

/// A frame of A and the frame of B with the same camera, bit by bit.
struct FramePair {
    size_t a = 0, b = 0;                   ///< indices of frames
    double ratio = 1;                      ///< time of B over time of A
    std::vector<uint64_t> only_a, only_b;  ///< ids (RunComparison::Difference) that only one of them kept, ascending
};

struct RunComparison {
    std::vector<FramePair> pairs;             ///< by A's frames; a camera that occurs twice is paired in order
    uint64_t unpaired_a = 0, unpaired_b = 0;  ///< frames whose camera the other has not
    bool by_path = false;                     ///< keys name other objects in B: objects are told by their paths
    bool same_scene = true;                   ///< as many objects and triangles
    bool same_size = true;                    ///< of the viewport

    /// Times over the pairs.
    double median_a = 0, median_b = 0;                ///< [microseconds]
    double ratio = 1, ratio_low = 1, ratio_high = 1;  ///< median, and the tenths at both ends

    /// Sums over the pairs.
    uint64_t kept_a = 0, kept_b = 0, only_a = 0, only_b = 0, triangles_a = 0, triangles_b = 0;
    std::optional<double> over_estimate_a, over_estimate_b;  ///< where all pairs were verified
    uint64_t false_a = 0, false_b = 0;                       ///< false culls, of all frames
    uint64_t new_false = 0;                                  ///< of B, in pairs: that A has not; in other frames: all

    /// An object that one of them kept where the other did not.
    struct Difference {
        uint64_t id = 0;
        std::string name, path;
        uint64_t only_a = 0, only_b = 0;  ///< pairs
    };
    std::vector<Difference> differences;  ///< those that differ in most pairs first

    std::vector<std::string> verdict;  ///< sentences
    bool ok = true;                    ///< B has no false culls that A has not, and is not too slow
};

/// @param most_ratio  of times, above which B is too slow; none: any is good
RunComparison compareRuns(const RunFile& a, const RunFile& b, std::optional<double> most_ratio = std::nullopt);

/// The schema `sightline.compare/1`.
/// @param most  objects that are listed of those that differ
std::string compareJson(const RunComparison& comparison, const RunFile& a, const RunFile& b, size_t most = ~size_t{0});

/// One page that needs no network: both runs side by side, with the pictures that lie beside their files.
std::string comparePage(const RunComparison& comparison, const RunFile& a, const RunFile& b);

}  // namespace sightline::tools
