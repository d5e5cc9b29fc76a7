// A GPU in software with clocks of its own: draws, answers questions about boxes late, and tells what a frame took.
// SPDX-License-Identifier: MIT
#include "sightline/studies/gpu/simulated_gpu.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/cull/queries/box_mesh.h"
#include "sightline/studies/hidden/project/scan.h"

namespace sightline::studies {
SimulatedGpu::SimulatedGpu(std::span<const DrawItem> items, const SimulatedGpuSettings& settings)
    : items_(items), settings_(settings) {}

void SimulatedGpu::beginFrame(const View& view) {
    width_ = view.width;
    height_ = view.height;
    // Where corners are rounded, a triangle that lies between the samples may be moved over one. So the projector is told of
    // a grid as fine as what they are rounded to: a triangle between its samples has no area when it is rounded.
    const uint32_t parts = 1u << settings_.position_bits;
    projector_.emplace(view, SampleGrid{parts * view.width, parts * view.height, 0, parts, {}});
    const glm::dmat4& p = view.projection;
    const double per_nearness = isOrthographic(view) ? p[2][2] / p[3][3] : p[3][2] / p[2][3];
    depth_scale_ =
        settings_.depth_bits == 0 ? 0 : 0.5 * std::abs(per_nearness) * std::ldexp(1.0, int(settings_.depth_bits));
    shown_.assign(size_t{width_} * height_, kNone);
    depths_.assign(size_t{width_} * height_, -std::numeric_limits<double>::infinity());
    asking_ = false;
}

void SimulatedGpu::endFrame() {
    ++frame_;
    frame_ends_.push_back(std::max(gpu_, cpu_));
    if (frame_ends_.size() <= settings_.frames_ahead) return;
    cpu_ = std::max(cpu_, frame_ends_.front());
    frame_ends_.erase(frame_ends_.begin());
}

/// Draws what is nearer than what is there, or only counts it.
SimulatedGpu::Samples SimulatedGpu::scan(const DrawItem& item, uint32_t shown, bool writes) {
    Samples samples;
    projector_->begin(item);
    ScreenPolygon polygon;
    for (size_t triangle = 0; triangle < item.mesh.triangles(); ++triangle) {
        if (!item.writes_depth.empty() && item.writes_depth[triangle] == 0) continue;
        if (!projector_->project(triangle, polygon)) continue;
        if (settings_.position_bits == 0) {
            scan(polygon, shown, writes, samples);
            continue;
        }
        ScreenPolygon part;
        for (int i = 2; i < polygon.count; ++i)
            if (roundedPart(polygon, i, part)) scan(part, shown, writes, samples);
    }
    return samples;
}

/// A triangle of a polygon's fan with its corners rounded, and with the depths that these then have.
bool SimulatedGpu::roundedPart(const ScreenPolygon& polygon, int last, ScreenPolygon& part) const {
    const double grid = std::ldexp(1.0, int(settings_.position_bits));
    const int corners[3] = {0, last - 1, last};
    double nearness[3];
    part.count = 3;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec2& point = polygon.points[corners[i]];
        nearness[i] = polygon.depth.at(point.y - 0.5, point.x - 0.5);
        part.points[i] = glm::round(point) / grid;
    }
    const glm::dvec2 a = part.points[1] - part.points[0], b = part.points[2] - part.points[0];
    const double area = a.x * b.y - a.y * b.x;
    if (area == 0) return false;
    const double of_a = nearness[1] - nearness[0], of_b = nearness[2] - nearness[0];
    part.depth.per_sample = (of_a * b.y - of_b * a.y) / area;
    part.depth.per_row = (of_b * a.x - of_a * b.x) / area;
    part.depth.origin =
        nearness[0] - part.depth.per_sample * (part.points[0].x - 0.5) - part.depth.per_row * (part.points[0].y - 0.5);
    part.depth.low = std::min({nearness[0], nearness[1], nearness[2]});
    part.depth.high = std::max({nearness[0], nearness[1], nearness[2]});
    return true;
}

void SimulatedGpu::scan(const ScreenPolygon& polygon, uint32_t shown, bool writes, Samples& samples) {
    scanPolygon(polygon.outline(), 0, static_cast<int32_t>(height_), static_cast<int32_t>(width_),
                [&](int32_t row, int32_t begin, int32_t end) {
                    for (int32_t i = begin; i < end; ++i) {
                        const size_t at = static_cast<size_t>(row) * width_ + static_cast<size_t>(i);
                        double depth = polygon.depth.at(row, i);
                        if (depth_scale_ != 0) depth = std::round(depth * depth_scale_);
                        ++samples.tested;
                        if (writes ? depth <= depths_[at] : depth < depths_[at]) continue;
                        ++samples.passed;
                        if (!writes) continue;
                        depths_[at] = depth;
                        shown_[at] = shown;
                    }
                });
}

/// The GPU begins when it is told to, and is done with what came before.
void SimulatedGpu::submit(double cpu, double gpu) {
    cpu_ += cpu;
    gpu_ = std::max(gpu_, cpu_) + settings_.costs.start + gpu;
}

void SimulatedGpu::change(bool asking) {
    if (asking_ != asking) cpu_ += settings_.costs.change;
    asking_ = asking;
}

void SimulatedGpu::draw(std::span<const uint32_t> items) {
    const SimulatedCosts& costs = settings_.costs;
    change(false);
    for (const uint32_t item : items) {
        const Samples samples = scan(items_[item], item, true);
        submit(costs.call, costs.triangle * double(items_[item].mesh.triangles()) +
                               costs.test * double(samples.tested) + costs.shade * double(samples.passed));
    }
}

void SimulatedGpu::ask(uint32_t question, std::span<const Box3d> boxes) {
    const SimulatedCosts& costs = settings_.costs;
    change(true);
    Samples all;
    for (const Box3d& box : boxes) {
        DrawItem cube;
        cube.mesh = {kCubeCorners, kCubeTriangles};
        cube.transform = cubeToBox(box);
        const Samples samples = scan(cube, kNone, false);
        all.tested += samples.tested;
        all.passed += samples.passed;
    }
    submit(costs.ask, costs.box * double(boxes.size()) + costs.test * double(all.tested));
    if (answers_.size() <= question) answers_.resize(question + 1);
    answers_[question] = {all.passed, frame_, gpu_ + costs.back};
}

bool SimulatedGpu::hasAnswer(uint32_t question) {
    cpu_ += settings_.costs.poll;
    const Answer& answer = answers_[question];
    return answer.frame + settings_.frames_late <= frame_ && answer.ready <= cpu_;
}

uint64_t SimulatedGpu::answer(uint32_t question) {
    cpu_ = std::max(cpu_, answers_[question].ready);
    return answers_[question].samples;
}

}  // namespace sightline::studies
