// Which part of the world a plan or a section shows.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "sightline/tools/report/pictures/plan.h"

namespace sightline::tools {
namespace {

constexpr double kSectionShape = 2.4;  // width over height

Box3d worldOf(std::span<const Box3d> bounds) {
    Box3d world;
    for (const Box3d& box : bounds)
        if (box.finite()) world.grow(box);
    return world;
}

/// The range of values but for one in a hundred at either end: stray far objects do not shrink the rest to a dot.
glm::dvec2 rangeOf(std::vector<double>& values) {
    std::sort(values.begin(), values.end());
    const size_t cut = values.size() / 100;
    return {values[cut], values[values.size() - 1 - cut]};
}

/// Where a stretch of `side` around `middle` begins: moved so that it shows no more emptiness beyond [low, high] than
/// a rim, while it leaves out what lies at the other end.
double placed(double middle, double side, double low, double high) {
    const double rim = 0.04 * side;
    if (side >= high - low + 2 * rim) return 0.5 * (low + high - side);
    return std::clamp(middle - 0.5 * side, low - rim, high + rim - side);
}

/// The next whole number of the kind 1, 2, 3, 4, 5, 8, 10 that is not above.
double roundFactor(double value) {
    double best = 1;
    for (const double step : {2.0, 3.0, 4.0, 5.0, 8.0, 10.0})
        if (step <= value) best = step;
    return best;
}

}  // namespace

PlanArea planArea(std::span<const Box3d> bounds, std::span<const std::span<const uint8_t>> reasons,
                  std::span<const View> views) {
    const Box3d world = worldOf(bounds);
    // The middle of each visible object counts, not its extent: a ground that reaches to the horizon is always seen.
    std::vector<double> xs, zs;
    for (const auto& frame : reasons)
        for (size_t i = 0; i < frame.size(); ++i)
            if (frame[i] == 0 && bounds[i].finite()) {
                xs.push_back(bounds[i].center().x);
                zs.push_back(bounds[i].center().z);
            }
    for (const View& view : views) {
        xs.push_back(eyePosition(view).x);
        zs.push_back(eyePosition(view).z);
    }
    PlanArea area;
    if (xs.empty() || world.empty()) return area;
    const glm::dvec2 x = rangeOf(xs), z = rangeOf(zs);
    const double whole = std::max(world.size().x, world.size().z);
    double side = std::clamp(1.5 * std::max(x.y - x.x, z.y - z.x), 0.05 * whole, 1.1 * whole);
    if (!(side > 0)) side = 1;
    area.width = area.height = side;
    area.left = placed(0.5 * (x.x + x.y), side, std::min(world.min.x, x.x), std::max(world.max.x, x.y));
    area.top = placed(0.5 * (z.x + z.y), side, std::min(world.min.z, z.x), std::max(world.max.z, z.y));
    return area;
}

PlanArea planAreaAround(const Box3d& box) {
    PlanArea area;
    if (box.empty() || !box.finite()) return area;
    const glm::dvec3 size = box.size(), center = box.center();
    const double most = std::max({size.x, size.z, 1e-9}), air = 0.04 * most;
    area.width = std::max(size.x, most / 4) + 2 * air;
    area.height = std::max(size.z, most / 4) + 2 * air;
    area.left = center.x - area.width / 2;
    area.top = center.z - area.height / 2;
    return area;
}

PlanArea sectionArea(std::span<const Box3d> bounds, std::span<const uint8_t> reasons, const View& view,
                     const PlanArea& plan) {
    const glm::dvec3 forward = -glm::transpose(glm::dmat3(view.view))[2], eye = eyePosition(view);
    PlanArea area;
    area.across = std::abs(forward.x) > std::abs(forward.z) ? 0 : 2;
    area.down = 1;
    area.upward = true;
    area.width = plan.width;
    std::vector<double> ys = {eye.y};
    for (size_t i = 0; i < reasons.size(); ++i) {
        const Box3d& box = bounds[i];
        if (reasons[i] != 0 || !box.finite()) continue;
        const double c = box.center()[area.across], begin = area.across == 0 ? plan.left : plan.top;
        if (c < begin || c > begin + plan.width) continue;
        ys.push_back(box.min.y);
        ys.push_back(box.max.y);
    }
    const glm::dvec2 y = rangeOf(ys);
    const double low = std::min(y.x, eye.y), high = std::max(y.y, eye.y);
    const double wanted = std::max(1.25 * (high - low), 1e-3 * plan.width), natural = plan.width / kSectionShape;
    area.height = natural / roundFactor(natural / wanted);
    if (wanted > natural) {
        area.height = wanted;
        area.width = wanted * kSectionShape;
    }
    const double middle = (area.across == 0 ? plan.left : plan.top) + 0.5 * plan.width;
    area.left = middle - 0.5 * area.width;
    area.top = 0.5 * (low + high) + 0.5 * area.height;
    return area;
}

double sectionStretch(const PlanArea& area) { return area.width / area.height / kSectionShape; }

PlanBand storeyOf(std::span<const Box3d> bounds, const glm::dvec3& eye) {
    const glm::dvec3 world = worldOf(bounds).size();
    const double side = 0.05 * std::max(world.x, world.z), floor_area = 0.01 * world.x * world.z;
    PlanBand band;
    for (const Box3d& box : bounds) {
        if (!box.finite() || eye.x < box.min.x || eye.x > box.max.x || eye.z < box.min.z || eye.z > box.max.z) continue;
        const glm::dvec3 size = box.size();
        if (size.x < side || size.z < side || size.x * size.z < floor_area) continue;
        if (size.y > 0.12 * std::min(size.x, size.z)) continue;
        if (box.max.y <= eye.y) band.low = std::max(band.low, box.max.y);
        else if (box.min.y >= eye.y) band.high = std::min(band.high, box.min.y);
    }
    return band;
}

PlanBand sliceOf(const PlanArea& section, const glm::dvec3& eye) {
    const double middle = eye[section.through()], half = 0.025 * section.width;
    return {middle - half, middle + half};
}

}  // namespace sightline::tools
