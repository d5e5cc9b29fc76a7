// A GPU in software with clocks of its own: draws, answers questions about boxes late, and tells what a frame took.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "sightline/cull/queries/query_device.h"
#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/project/projector.h"

namespace sightline::studies {

/// What things take, about as on a graphics card of the middle class.  [seconds]
struct SimulatedCosts {
    // The CPU's.
    double call = 2e-6;    ///< a draw call
    double ask = 1.5e-6;   ///< a question
    double change = 3e-6;  ///< from drawing to asking, or back
    double poll = 1e-7;    ///< finding out whether an answer is there
    // The GPU's.
    double start = 5e-7;  ///< a draw call or a question
    double box = 5e-8;    ///< a box
    double triangle = 4e-10;
    double test = 5e-12;   ///< a sample tested
    double shade = 1e-10;  ///< a sample that passes
    double back = 5e-6;    ///< from the end of a question until the CPU can read the answer
};

struct SimulatedGpuSettings {
    SimulatedCosts costs;
    uint32_t frames_late = 0;    ///< answers that nobody waits for come so many frames later
    uint32_t frames_ahead = 1;   ///< that the CPU may be ahead of the GPU
    uint32_t position_bits = 0;  ///< of a pixel's side, that corners are rounded to; 0: not rounded
    uint32_t depth_bits = 0;     ///< that depths are rounded to; 0: not rounded
};

/// Draws into one sample a pixel. The CPU and the GPU have a clock each: the CPU's runs with what is called, the GPU's with
/// what is drawn, and a command is worked off when it has been called and those before it are done. So a frame takes as
/// long as the slower of both, and longer where the CPU waits for an answer and the GPU, meanwhile, for work.
class SimulatedGpu : public QueryDevice {
public:
    static constexpr uint32_t kNone = ~0u;

    /// @param items  by the numbers that draw() is given; their ids count for nothing. Good as long as this is used
    explicit SimulatedGpu(std::span<const DrawItem> items, const SimulatedGpuSettings& settings = {});
    virtual ~SimulatedGpu() = default;

    /// Clears the image.
    /// @param view  isUsable(view)
    void beginFrame(const View& view);
    /// The CPU is busy with something else.
    void work(double seconds) { cpu_ += seconds; }
    /// Both clocks run on to where the next frame may begin.
    void endFrame();
    /// Of both, since the beginning, until all is done that was called.  [seconds]
    double seconds() const { return cpu_ > gpu_ ? cpu_ : gpu_; }

    void draw(std::span<const uint32_t> items) override;
    void ask(uint32_t question, std::span<const Box3d> boxes) override;
    bool hasAnswer(uint32_t question) override;
    uint64_t answer(uint32_t question) override;

    /// The item at each sample, or kNone; row 0 is the bottom row.  [size: width * height]
    std::span<const uint32_t> shown() const { return shown_; }
    /// What each sample keeps: the larger, the nearer.  [size: width * height]
    std::span<const double> depths() const { return depths_; }

private:
    struct Answer {
        uint64_t samples = 0;
        uint32_t frame = 0;
        double ready = 0;
    };
    struct Samples {
        uint64_t tested = 0, passed = 0;
    };

    Samples scan(const DrawItem& item, uint32_t shown, bool writes);
    void scan(const ScreenPolygon& polygon, uint32_t shown, bool writes, Samples& samples);
    bool roundedPart(const ScreenPolygon& polygon, int last, ScreenPolygon& part) const;
    void submit(double cpu, double gpu);
    void change(bool asking);

    std::span<const DrawItem> items_;
    SimulatedGpuSettings settings_;
    uint32_t width_ = 0, height_ = 0;
    double depth_scale_ = 0;  ///< steps of the depth per unit of nearness; 0: not rounded
    std::optional<Projector> projector_;
    std::vector<uint32_t> shown_;
    std::vector<double> depths_;
    std::vector<Answer> answers_;     ///< by question
    std::vector<double> frame_ends_;  ///< of the last frames  [size: <= frames_ahead]
    uint32_t frame_ = 0;
    double cpu_ = 0, gpu_ = 0;
    bool asking_ = false;
};

}  // namespace sightline::studies
