// Loads of real work with a known limit, and halves of two, told by the classifier; and what it costs to be measured.
// SPDX-License-Identifier: MIT
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/core.h>
#include <glm/glm.hpp>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/profile/bottleneck.h"
#include "sightline/tools/profile/loaded_reference.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr double kMagnitudes[] = {1e-3, 4e-3, 16e-3};  // [s]
constexpr double kPart = 0.7;                          // of the stage that limits; the others share the rest

/// One stage's work, a unit at a time, each some microseconds long.
class Work {
public:
    virtual ~Work() = default;
    virtual void unit() = 0;
};

/// Pixels of an image, each with a blend.
class FillWork : public Work {
public:
    void unit() override {
        for (size_t i = 0; i < kUnit; ++i) {
            uint32_t& pixel = image_[(at_ + i) % image_.size()];
            pixel = ((pixel & 0xfefefeu) >> 1) + colour_;
        }
        at_ += kUnit;
        colour_ = colour_ * 5 + 1;
    }

private:
    static constexpr size_t kUnit = 1 << 14;
    std::vector<uint32_t> image_ = std::vector<uint32_t>(1 << 20);
    size_t at_ = 0;
    uint32_t colour_ = 0x102030;
};

/// Vertices by a matrix.
class TransformWork : public Work {
public:
    void unit() override {
        for (size_t i = 0; i < from_.size(); ++i) to_[i] = turn_ * from_[i];
        turn_[3][0] += 1e-3f * to_[0].x;
    }

private:
    std::vector<glm::vec4> from_ = std::vector<glm::vec4>(1 << 11, glm::vec4(0.1f, 0.2f, 0.3f, 1.0f)), to_ = from_;
    glm::mat4 turn_{0.5f};
};

/// Bytes from one buffer to another, larger than caches are.
class BusWork : public Work {
public:
    void unit() override {
        std::memcpy(to_.data() + at_, from_.data() + at_, kUnit);
        at_ = (at_ + kUnit) % from_.size();
    }

private:
    static constexpr size_t kUnit = 1 << 16;
    std::vector<uint8_t> from_ = std::vector<uint8_t>(1 << 26, 1), to_ = from_;
    size_t at_ = 0;
};

/// Steps of which each needs the one before.
class CpuWork : public Work {
public:
    void unit() override {
        for (int i = 0; i < 4000; ++i) state_ = (state_ ^ (state_ >> 7)) * 0x9e3779b97f4a7c15ull + 1;
        out_ = state_;
    }

private:
    uint64_t state_ = 1;
    volatile uint64_t out_ = 0;
};

/// All four, and how fast they are here.
class Works {
public:
    Works() {
        for (size_t i = 0; i < kFrameStages; ++i) {
            std::vector<double> times;
            for (int round = 0; round < 50; ++round) {
                const FrameClock clock;
                for (int k = 0; k < 20; ++k) works_[i]->unit();
                times.push_back(clock.times().wall / 20);
            }
            unit_[i] = medianOf(std::move(times));
        }
    }

    void work(int stage, double seconds) {
        const auto units = static_cast<int>(std::lround(seconds / unit_[static_cast<size_t>(stage)]));
        for (int i = 0; i < units; ++i) works_[static_cast<size_t>(stage)]->unit();
    }

private:
    FillWork fill_;
    TransformWork transform_;
    BusWork bus_;
    CpuWork cpu_;
    Work* works_[kFrameStages] = {&fill_, &transform_, &bus_, &cpu_};
    double unit_[kFrameStages] = {};  // [s]
};

using Parts = std::array<double, kFrameStages>;

/// What makes two stages take so long each while both work: side by side a unit takes longer than alone.
Parts halvesSideBySide(Works& works, size_t a, size_t b, double seconds) {
    Parts parts{};
    parts[a] = parts[b] = seconds;
    for (int round = 0; round < 12; ++round) {
        std::vector<double> times[2];
        for (int turn = 0; turn < 5; ++turn) {
            const auto timed = [&](size_t stage, double& time) {
                const FrameClock clock;
                works.work(static_cast<int>(stage), parts[stage]);
                time = clock.times().wall;
            };
            double first = 0, second = 0;
            {
                const std::jthread other([&] { timed(b, second); });
                timed(a, first);
            }
            times[0].push_back(first);
            times[1].push_back(second);
        }
        parts[a] *= std::sqrt(seconds / medianOf(times[0]));
        parts[b] *= std::sqrt(seconds / medianOf(times[1]));
    }
    return parts;
}

/// A frame that works its parts off one after the other, or each on a thread of its own.
DrawFrame frameOf(Works& works, const Parts& parts, bool pipelined) {
    return [&works, parts, pipelined](const StageLoads& loads) {
        const double factors[kFrameStages] = {loads.fill, loads.transform, loads.bus, loads.cpu};
        const FrameClock clock;
        std::vector<std::jthread> others;
        int last = -1;
        for (int stage = 0; stage < kFrameStages; ++stage) {
            const double seconds = parts[static_cast<size_t>(stage)] * factors[stage];
            if (seconds == 0) continue;
            if (!pipelined) works.work(stage, seconds);
            else if (last < 0) last = stage;
            else others.emplace_back([&works, stage, seconds] { works.work(stage, seconds); });
        }
        if (last >= 0) works.work(last, parts[static_cast<size_t>(last)] * factors[last]);
        others.clear();
        FrameTimes times = clock.times();
        times.gpu = 0.0;
        return times;
    };
}

std::string noteOf(const Bottleneck& found) {
    return fmt::format("{}; confidence {:.0f} %, {} rounds", verdictWords(found), 100 * found.confidence, found.rounds);
}

void tellLimits(Works& works, Table& table) {
    double right = 0, all = 0;
    for (int stage = 0; stage < kFrameStages; ++stage)
        for (const double seconds : kMagnitudes) {
            Parts parts;
            parts.fill((1 - kPart) / 3 * seconds);
            parts[static_cast<size_t>(stage)] = kPart * seconds;
            const Bottleneck found = findBottleneck(frameOf(works, parts, false));
            const bool good =
                found.verdict() == LimitVerdict::kLimited && static_cast<int>(found.judgement.first) == stage;
            const std::string where = fmt::format("{}, {:.0f} ms", kFrameStageNames[stage], 1e3 * seconds);
            table.rows.push_back({where, "share of the frame", found.stages[static_cast<size_t>(stage)].share, "",
                                  "as made", kPart, noteOf(found)});
            right += good;
            all += 1;
            if (!good) table.faults.push_back(fmt::format("bottleneck: {}: {}", where, noteOf(found)));
        }
    table.rows.push_back({"all", "loads with a known limit, told", right, "loads", "of so many", all});
}

void tellMixtures(Works& works, bool pipelined, Table& table) {
    double right = 0, all = 0;
    const char* kind = pipelined ? "side by side" : "one after the other";
    for (size_t a = 0; a < kFrameStages; ++a)
        for (size_t b = a + 1; b < kFrameStages; ++b) {
            Parts parts{};
            if (pipelined) parts = halvesSideBySide(works, a, b, 4e-3);
            else parts[a] = parts[b] = 4e-3;
            const Bottleneck found = findBottleneck(frameOf(works, parts, pipelined));
            bool good = found.verdict() == LimitVerdict::kMixed;
            for (size_t i = 0; i < kFrameStages; ++i) good = good && found.judgement.limits[i] == (i == a || i == b);
            const std::string where = fmt::format("{} and {}, {}", kFrameStageNames[a], kFrameStageNames[b], kind);
            table.rows.push_back(
                {where, "share of the first", found.judgement.proportions[a], "", "as made", 0.5, noteOf(found)});
            right += good;
            all += 1;
            if (!good) table.faults.push_back(fmt::format("bottleneck: {}: {}", where, noteOf(found)));
        }
    table.rows.push_back({"all", fmt::format("halves {}, called mixed", kind), right, "loads", "of so many", all});
}

/// A frame of the reference renderer as a program draws it, and the same as a subject.
void measureOverhead(const Scene& scene, const CameraPath& path, int repeat, Table& table) {
    const View view = makeView(path.frames.front(), 1280, 720);
    const RenderList list(scene, view);
    LoadedReference subject;
    ZBufferMemory memory;
    RenderSettings settings;
    settings.zbuffer_memory = &memory;
    const auto submit = [&] { return list.list().items(); };
    const std::vector<double> times = timeInterleaved(
        {[&] { render(DrawList(submit()), view, settings); }, [&] { subject.draw(view, submit, {}); }}, repeat);
    table.rows.push_back(
        {scene.name, "a frame that is measured", times[1] * 1e-3, "ms", "one that is not", times[0] * 1e-3});
}

}  // namespace

Table benchBottleneck(const Options& options) {
    Table table{"bottleneck", {}};
    const int repeat = options.repeat ? options.repeat : 101;
    Works works;
    tellLimits(works, table);
    tellMixtures(works, false, table);
    tellMixtures(works, true, table);
    if (options.scene) measureOverhead(*options.scene, seededCameras(*options.scene, 1, 1), repeat, table);
    else measureOverhead(makeCity(1, 2000), cityStreetPath(1, 1), repeat, table);
    return table;
}

}  // namespace sightline::bench
