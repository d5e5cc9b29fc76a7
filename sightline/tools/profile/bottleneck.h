// What limits a frame: one stage is given more to do at a time, and what the frame's time does says how much it matters.
// SPDX-License-Identifier: MIT
//
// Cem Cebenoyan. Graphics Pipeline Performance. In GPU Gems, 2004.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>

#include "sightline/tools/profile/frame_load.h"

namespace sightline::tools {

// The model. With loads L_i a stage by itself takes T_i. A frame whose stages work one after the other takes T = sum T_i,
// an ideal pipeline T = max T_i, and real ones lie between. Of either, draw the frame with k L_i and all else as it was:
//
//     sensitivity  s_i = ln(T(k L_i) / T(L_i)) / ln k       share  g_i = (T(k L_i) / T(L_i) - 1) / (k - 1)
//
// One after the other, g_i is exactly T_i / T, and all g_i add up to what of the frame these stages are; in a pipeline
// the one that limits has s = g = 1, and one that would take r of the frame by itself has g = max(0, k r - 1) / (k - 1):
// with k = 2 nothing below a half. So a sum above 1 says that stages overlap, and one below 1 that something else takes
// time, too. What a stage could save is its g at most.
//
// The traps. A busy processor proves nothing: drivers spin while they wait, and one core of several may be all that counts.
// A frame that waits for a display takes whole refreshes, and its shares are 0 and 1 whatever limits it. A processor that
// clocks itself up and down between two measurements makes one of them slower: they are taken in turns, in an order that
// changes. A renderer that runs ahead makes a frame wait for the one before: subjects wait until a frame is done.

struct BottleneckSettings {
    double factor = 2;           ///< k  [limit: > 1]
    uint32_t least_rounds = 7;   ///< a round measures the frame twice, and once with more of each stage
    uint32_t most_rounds = 40;   ///< the work limit
    double spread = 0.02;        ///< rounds end when all shares are known so well (standard error)
    double seconds = 0;          ///< rounds end after so long besides; 0: never  [s]
    double least_sample = 2e-3;  ///< frames that are shorter are drawn several times a measurement  [s]
    uint64_t seed = 1;           ///< of the order of measurements, and of the resampling that confidence comes from
    std::function<void(size_t, size_t)> progress;  ///< called with (done, at most) rounds; may be empty
};

/// How much one stage matters. Medians over the rounds.
struct Sensitivity {
    double exponent = 0;  ///< s: the frame's time grows as load^s
    double share = 0;     ///< g: of the frame's time; below 0 is noise
    double spread = 0;    ///< standard error of the share
    double seconds = 0;   ///< a frame under the larger load
};

/// What may be said of a frame.
enum class LimitVerdict : uint8_t {
    kUndecided,
    kLimited,  ///< one stage is at least half of what matters, and no other half as much as it
    kMixed,    ///< several stages matter
};

/// Why nothing may be said.
enum class Doubt : uint8_t {
    kNone,
    kNoise,      ///< the measurements contradict one another
    kElsewhere,  ///< less than half of the frame is in these stages
    kWaits,      ///< the same, and for much of it neither the process nor the GPU is at work
    kQuantised,  ///< it waits, and takes a whole number of some period: a display's refresh, or a limiter
};

/// What shares say by themselves.
struct Judgement {
    LimitVerdict verdict = LimitVerdict::kUndecided;
    FrameStage first = FrameStage::kFill;            ///< the largest
    std::array<bool, kFrameStages> limits{};         ///< the stages of the verdict; none if undecided
    std::array<double, kFrameStages> proportions{};  ///< of the positive shares' sum
    double sum = 0;                                  ///< of the positive shares
};
Judgement judgeShares(std::span<const double, kFrameStages> shares);

struct Bottleneck {
    Judgement judgement;
    Doubt doubt = Doubt::kNone;
    double confidence = 0;  ///< how often rounds drawn anew from those measured say the same
    std::array<Sensitivity, kFrameStages> stages;
    double frame = 0;           ///< the frame as it is, by the wall's clock  [s]
    double cpu = 0;             ///< computed meanwhile, by all threads together  [s]
    std::optional<double> gpu;  ///< busy meanwhile  [s]
    double waiting = 0;         ///< of the frame: neither at work; 0 if that is not known
    uint32_t rounds = 0, frames_a_sample = 1;
    bool settled = false;      ///< all shares are known as well as was asked
    bool out_of_time = false;  ///< BottleneckSettings::seconds ended it

    LimitVerdict verdict() const { return doubt == Doubt::kNone ? judgement.verdict : LimitVerdict::kUndecided; }
    const Sensitivity& of(FrameStage stage) const { return stages[static_cast<size_t>(stage)]; }
};

/// Measures a subject. All of its work happens in `draw`, which is called some hundred times; nothing is left behind in what
/// it calls.
Bottleneck findBottleneck(const DrawFrame& draw, const BottleneckSettings& settings = {});

/// "limited by fill", "mixed: fill 52 %, cpu 48 %", or why nothing is said.
std::string verdictWords(const Bottleneck& bottleneck);

}  // namespace sightline::tools
