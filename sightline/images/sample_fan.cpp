// Where the images of a doorway are taken from: arcs before it, and the nearest samples of an eye with their weights.
// SPDX-License-Identifier: MIT
#include "sightline/images/sample_fan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightline::images {
namespace {

constexpr double kAtMark = 1e-9;

/// Where a number lies on a scale of so many marks: between which two, and how far.
struct Mark {
    uint32_t low = 0;
    double part = 0;
};
Mark markOf(double at, uint32_t marks) {
    const double last = marks - 1.0;
    const double clamped = at > 0 ? std::min(at, last) : 0.0;  // NaN gives 0
    const auto low = static_cast<uint32_t>(std::min(std::floor(clamped), std::max(0.0, last - 1)));
    // At a mark to rounding is at the mark: an image is shown as it is where it was taken.
    const double part = clamped - low;
    return {low, part < kAtMark ? 0.0 : part > 1 - kAtMark ? 1.0 : part};
}

}  // namespace

Result<SampleFan> sampleFan(const PortalFrame& frame, const FanSettings& settings) {
    const auto within = [](double value, double low, double high) { return value >= low && value <= high; };
    if (settings.arcs == 0 || settings.angles == 0 || settings.arcs > 1000 || settings.angles > 100000)
        return Error{Error::Kind::kUsage, "a fan of samples has 1 to 1000 arcs of 1 to 100000 samples"};
    if (!within(settings.nearest, 1e-9, 1e9) || !within(settings.farthest, settings.nearest, 1e9) ||
        !std::isfinite(settings.eye_height))
        return Error{Error::Kind::kUsage, "the arcs of a fan need radii that are above 0 and do not fall"};
    if (!within(settings.half_angle, 0, 1.57))
        return Error{Error::Kind::kUsage, "a fan reaches less than 90 degrees to a side"};
    SampleFan fan;
    fan.settings = settings;
    fan.centre = frame.toWorld({0.5 * frame.width, settings.eye_height, 0});
    fan.right = frame.right;
    fan.front = frame.front;
    for (uint32_t arc = 0; arc < settings.arcs; ++arc) {
        const double along = settings.arcs > 1 ? arc / (settings.arcs - 1.0) : 0.0;
        const double radius = settings.nearest * std::pow(settings.farthest / settings.nearest, along);
        for (uint32_t i = 0; i < settings.angles; ++i) {
            const double share = settings.angles > 1 ? 2.0 * i / (settings.angles - 1.0) - 1 : 0.0;
            const double angle = share * settings.half_angle;
            fan.eyes.push_back(fan.centre + radius * (std::sin(angle) * fan.right + std::cos(angle) * fan.front));
        }
    }
    return fan;
}

SampleWeights nearestSamples(const SampleFan& fan, const glm::dvec3& eye) {
    const FanSettings& s = fan.settings;
    const double x = glm::dot(eye - fan.centre, fan.right), z = glm::dot(eye - fan.centre, fan.front);
    const double radius = std::hypot(x, z), angle = std::atan2(x, z);
    double by_angle = 0, by_arc = 0;
    if (s.angles > 1 && s.half_angle > 0) by_angle = 0.5 * (angle / s.half_angle + 1) * (s.angles - 1);
    if (s.arcs > 1 && s.farthest > s.nearest)
        by_arc = std::log(std::max(radius, 1e-300) / s.nearest) / std::log(s.farthest / s.nearest) * (s.arcs - 1);
    const Mark u = markOf(by_angle, s.angles), v = markOf(by_arc, s.arcs);
    const auto sampleAt = [&](uint32_t du, uint32_t dv) { return (v.low + dv) * s.angles + u.low + du; };
    // Each cell of the fan is cut in two triangles by its diagonal; the weights are barycentric.
    const bool lower = u.part >= v.part;
    const std::pair<uint32_t, double> corners[3] = {
        {sampleAt(0, 0), 1 - std::max(u.part, v.part)},
        {lower ? sampleAt(1, 0) : sampleAt(0, 1), std::abs(u.part - v.part)},
        {sampleAt(1, 1), std::min(u.part, v.part)},
    };
    SampleWeights out;
    for (const auto& [sample, weight] : corners) {
        if (!(weight > 0)) continue;
        uint32_t at = out.count++;
        for (; at > 0 && out.weight[at - 1] < weight; --at) {
            out.weight[at] = out.weight[at - 1];
            out.sample[at] = out.sample[at - 1];
        }
        out.weight[at] = weight;
        out.sample[at] = sample;
    }
    return out;
}

}  // namespace sightline::images
