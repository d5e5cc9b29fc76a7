// A frame whose stages can be loaded one at a time: the factors, the times, and the renderer behind them.
// SPDX-License-Identifier: MIT
#pragma once

#include <chrono>
#include <cstdint>
#include <ctime>
#include <functional>
#include <optional>
#include <span>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline::tools {

/// What a frame's time goes into.
enum class FrameStage : uint8_t {
    kFill,       ///< pixels: scan conversion, depth tests, shading
    kTransform,  ///< vertices and triangles, up to the rasterizer
    kBus,        ///< bytes that are carried to the renderer each frame
    kCpu,        ///< finding out what to draw, and saying so
};
inline constexpr int kFrameStages = 4;
inline constexpr const char* kFrameStageNames[kFrameStages] = {"fill", "transform", "bus", "cpu"};

/// How much each stage has to do, as a multiple of what the frame gives it by itself. A subject rounds a factor that it
/// cannot follow: who draws vertices twice cannot draw them one and a half times.
struct StageLoads {
    double fill = 1, transform = 1, bus = 1, cpu = 1;

    static StageLoads of(FrameStage stage, double factor) {
        StageLoads loads;
        double* const all[kFrameStages] = {&loads.fill, &loads.transform, &loads.bus, &loads.cpu};
        *all[static_cast<int>(stage)] = factor;
        return loads;
    }
};

/// What a frame took  [seconds].
struct FrameTimes {
    double wall = 0;
    double cpu = 0;             ///< that the process computed, all its threads together
    std::optional<double> gpu;  ///< that the GPU was busy; 0: there is none; nothing: nobody knows
};

/// Draws a frame under some loads and waits until it is done.
using DrawFrame = std::function<FrameTimes(const StageLoads&)>;

/// Reads both clocks when it is made, and again when it is asked.
class FrameClock {
public:
    FrameClock() : wall_(std::chrono::steady_clock::now()), cpu_(cpuSeconds()) {}

    /// Since it was made; of the GPU nothing.
    FrameTimes times() const {
        const double cpu = cpuSeconds();
        return {std::chrono::duration<double>(std::chrono::steady_clock::now() - wall_).count(), cpu - cpu_, {}};
    }

private:
    static double cpuSeconds() {
        timespec now;
        clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
        return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
    }

    std::chrono::steady_clock::time_point wall_;
    double cpu_;
};

/// Finds out what is to be drawn and makes the list of it: the CPU's part of a frame. What it returns is valid until it
/// is called again.
using SubmitFrame = std::function<std::span<const studies::DrawItem>()>;

/// A renderer that can be given more of one stage's work and no more of the others'.
class LoadedRenderer {
public:
    virtual ~LoadedRenderer() = default;
    /// Draws a frame and waits until it is done.
    virtual FrameTimes draw(const View& view, const SubmitFrame& submit, const StageLoads& loads) = 0;
    /// Whether it draws any items, or only those that it was made with, whole.
    virtual bool drawsAnything() const = 0;
};

}  // namespace sightline::tools
