// What limits a frame: one stage is given more to do at a time, and what the frame's time does says how much it matters.
// SPDX-License-Identifier: MIT
#include "sightline/tools/profile/bottleneck.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

#include <fmt/core.h>

#include "sightline/base/random.h"
#include "sightline/tools/profile/middle.h"

namespace sightline::tools {
namespace {

constexpr double kWaits = 0.2;        // of a frame: more than processors are kept from it now and then
constexpr double kWhole = 0.03;       // a quotient of times that is as near to a whole number is one
constexpr double kSure = 0.75;        // verdicts below are undecided
constexpr uint32_t kResamples = 400;  // for the confidence
constexpr int kMeasured = kFrameStages + 2;

using Shares = std::array<double, kFrameStages>;

/// One round: the frame as it is, and under more of each stage.
struct Round {
    FrameTimes plain;
    double loaded[kFrameStages] = {};

    double shareOf(int stage, double factor) const { return (loaded[stage] / plain.wall - 1) / (factor - 1); }
};

FrameTimes sum(const FrameTimes& a, const FrameTimes& b) {
    FrameTimes both{a.wall + b.wall, a.cpu + b.cpu, {}};
    if (a.gpu && b.gpu) both.gpu = *a.gpu + *b.gpu;
    return both;
}

FrameTimes scaled(const FrameTimes& times, double by) {
    FrameTimes out{times.wall * by, times.cpu * by, {}};
    if (times.gpu) out.gpu = *times.gpu * by;
    return out;
}

FrameTimes measure(const DrawFrame& draw, const StageLoads& loads, uint32_t frames) {
    FrameTimes all = draw(loads);
    for (uint32_t i = 1; i < frames; ++i) all = sum(all, draw(loads));
    return scaled(all, 1.0 / frames);
}

/// In an order of its own, so that whatever drifts meets all alike.
Round measureRound(const DrawFrame& draw, const BottleneckSettings& settings, uint32_t frames, Random& random) {
    int order[kMeasured];
    std::iota(order, order + kMeasured, 0);
    for (int i = kMeasured - 1; i > 0; --i) std::swap(order[i], order[random.below(static_cast<uint64_t>(i) + 1)]);
    Round round;
    round.plain.gpu = 0.0;
    for (const int what : order) {
        if (what >= kFrameStages) {
            round.plain = sum(round.plain, scaled(measure(draw, {}, frames), 0.5));
            continue;
        }
        const StageLoads loads = StageLoads::of(static_cast<FrameStage>(what), settings.factor);
        round.loaded[what] = measure(draw, loads, frames).wall;
    }
    return round;
}

std::vector<double> sharesOf(const std::vector<Round>& rounds, int stage, double factor) {
    std::vector<double> shares;
    for (const Round& round : rounds) shares.push_back(round.shareOf(stage, factor));
    return shares;
}

bool isSettled(const std::vector<Round>& rounds, const BottleneckSettings& settings) {
    for (int stage = 0; stage < kFrameStages; ++stage)
        if (middleError(sharesOf(rounds, stage, settings.factor)) > settings.spread) return false;
    return true;
}

bool sameVerdict(const Judgement& a, const Judgement& b) { return a.verdict == b.verdict && a.limits == b.limits; }

/// Efron's bootstrap.
double confidenceOf(const std::vector<Round>& rounds, const Judgement& judgement, const BottleneckSettings& settings) {
    Random random(mixSeed(settings.seed, 1));
    uint32_t same = 0;
    std::vector<Round> drawn(rounds.size());
    for (uint32_t i = 0; i < kResamples; ++i) {
        for (Round& round : drawn) round = rounds[random.below(rounds.size())];
        Shares shares;
        for (int stage = 0; stage < kFrameStages; ++stage)
            shares[static_cast<size_t>(stage)] = middleOf(sharesOf(drawn, stage, settings.factor));
        same += sameVerdict(judgeShares(shares), judgement);
    }
    // No number of rounds makes it certain.
    return (same + 0.5) / (kResamples + 1.0);
}

bool isWhole(double value) { return std::abs(value - std::round(value)) <= kWhole; }

Doubt doubtOf(const Bottleneck& found, double factor) {
    if (found.waiting >= kWaits) {
        const bool whole = std::all_of(found.stages.begin(), found.stages.end(),
                                       [&](const Sensitivity& stage) { return isWhole(stage.share * (factor - 1)); });
        // All of them unmoved are a frame that waits for whatever it is.
        if (whole && found.judgement.sum > 0.5) return Doubt::kQuantised;
    }
    if (found.judgement.verdict == LimitVerdict::kUndecided)
        return found.waiting >= kWaits ? Doubt::kWaits : Doubt::kElsewhere;
    return found.confidence < kSure ? Doubt::kNoise : Doubt::kNone;
}

void summarise(const std::vector<Round>& rounds, const BottleneckSettings& settings, Bottleneck& found) {
    std::vector<double> wall, cpu, gpu, waiting;
    for (const Round& round : rounds) {
        wall.push_back(round.plain.wall);
        cpu.push_back(round.plain.cpu);
        if (!round.plain.gpu) continue;
        gpu.push_back(*round.plain.gpu);
        waiting.push_back(1 - std::max(round.plain.cpu, *round.plain.gpu) / round.plain.wall);
    }
    found.frame = middleOf(wall);
    found.cpu = middleOf(cpu);
    if (gpu.size() == rounds.size()) {
        found.gpu = middleOf(gpu);
        found.waiting = std::max(0.0, middleOf(waiting));
    }
    Shares shares;
    for (int stage = 0; stage < kFrameStages; ++stage) {
        Sensitivity& of = found.stages[static_cast<size_t>(stage)];
        const std::vector<double> all = sharesOf(rounds, stage, settings.factor);
        std::vector<double> loaded;
        for (const Round& round : rounds) loaded.push_back(round.loaded[stage]);
        of.seconds = middleOf(std::move(loaded));
        of.spread = middleError(all);
        of.share = shares[static_cast<size_t>(stage)] = middleOf(all);
        const double quotient = std::max(1 + of.share * (settings.factor - 1), 1e-9);
        of.exponent = std::log(quotient) / std::log(settings.factor);
    }
    found.judgement = judgeShares(shares);
    found.confidence = confidenceOf(rounds, found.judgement, settings);
    found.doubt = doubtOf(found, settings.factor);
}

}  // namespace

Judgement judgeShares(std::span<const double, kFrameStages> shares) {
    Judgement out;
    double positive[kFrameStages];
    for (int i = 0; i < kFrameStages; ++i) {
        positive[i] = std::max(shares[static_cast<size_t>(i)], 0.0);
        out.sum += positive[i];
    }
    const double* const top = std::max_element(positive, positive + kFrameStages);
    out.first = static_cast<FrameStage>(top - positive);
    if (out.sum > 0)
        for (int i = 0; i < kFrameStages; ++i) out.proportions[static_cast<size_t>(i)] = positive[i] / out.sum;
    if (out.sum < 0.5) return out;
    double second = 0;
    for (const double& share : positive)
        if (&share != top) second = std::max(second, share);
    const bool limited = *top >= 0.5 * out.sum && second < 0.5 * *top;
    out.verdict = limited ? LimitVerdict::kLimited : LimitVerdict::kMixed;
    // If the largest is less than half of the sum, one of the other three is more than a third of it.
    for (int i = 0; i < kFrameStages; ++i)
        out.limits[static_cast<size_t>(i)] = limited ? &positive[i] == top : positive[i] >= *top / 3;
    return out;
}

Bottleneck findBottleneck(const DrawFrame& draw, const BottleneckSettings& settings) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now();
    Bottleneck found;
    // The first frames of all fill caches, and grow what is kept from frame to frame.
    draw({});
    for (int stage = 0; stage < kFrameStages; ++stage)
        draw(StageLoads::of(static_cast<FrameStage>(stage), settings.factor));
    const double once = std::max(draw({}).wall, 1e-9);
    found.frames_a_sample = static_cast<uint32_t>(std::clamp(std::ceil(settings.least_sample / once), 1.0, 1000.0));
    Random random(settings.seed);
    std::vector<Round> rounds;
    const uint32_t least = std::max(settings.least_rounds, 1u), most = std::max(settings.most_rounds, least);
    while (rounds.size() < most && !found.settled && !found.out_of_time) {
        rounds.push_back(measureRound(draw, settings, found.frames_a_sample, random));
        if (settings.progress) settings.progress(rounds.size(), most);
        found.settled = rounds.size() >= least && isSettled(rounds, settings);
        found.out_of_time = !found.settled && settings.seconds > 0 &&
                            std::chrono::duration<double>(Clock::now() - begin).count() > settings.seconds;
    }
    found.rounds = static_cast<uint32_t>(rounds.size());
    summarise(rounds, settings, found);
    return found;
}

std::string verdictWords(const Bottleneck& found) {
    const Judgement& judgement = found.judgement;
    const char* first = kFrameStageNames[static_cast<int>(judgement.first)];
    switch (found.doubt) {
        case Doubt::kNoise:
            return fmt::format("undecided: the measurements contradict one another; most of them say {}", first);
        case Doubt::kElsewhere:
            return fmt::format("undecided: all four stages are only {:.0f} % of the frame", 100 * judgement.sum);
        case Doubt::kWaits:
            return fmt::format("undecided: the frame waits for {:.0f} % of its time, for none of the four stages",
                               100 * found.waiting);
        case Doubt::kQuantised:
            return "undecided: the frame waits, and takes a whole number of some period: switch vsync and limiters off";
        case Doubt::kNone:
            break;
    }
    if (judgement.verdict == LimitVerdict::kLimited) return fmt::format("limited by {}", first);
    std::string words;
    for (size_t i = 0; i < kFrameStages; ++i)
        if (judgement.limits[i])
            words += fmt::format("{} {} {:.0f} %", words.empty() ? "mixed:" : ",", kFrameStageNames[i],
                                 100 * judgement.proportions[i]);
    return words;
}

}  // namespace sightline::tools
