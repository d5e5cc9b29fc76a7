// A plan: the world from above, each object in the colour of what culled it, and the camera's frustum.
// SPDX-License-Identifier: MIT
#include "sightline/report/plan.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace sightline {

const glm::u8vec4 kPlanPalette[kPlanColours] = {{22, 163, 120, 255}, {148, 163, 184, 130}, {234, 120, 40, 210}};

namespace {

struct Rect {
    int x0, y0, x1, y1;  // inclusive
};

Rect footprint(const Box3d& box, const PlanArea& area, uint32_t side) {
    const double scale = side / area.side, limit = side + 1.0;
    const auto pixel = [&](double v) { return static_cast<int>(std::floor(std::clamp(v * scale, -2.0, limit))); };
    return {pixel(box.min.x - area.x), pixel(box.min.z - area.z), pixel(box.max.x - area.x), pixel(box.max.z - area.z)};
}

glm::u8vec4 darker(const glm::u8vec4& colour) {
    return {static_cast<uint8_t>(colour.x * 0.7), static_cast<uint8_t>(colour.y * 0.7),
            static_cast<uint8_t>(colour.z * 0.7), colour.w};
}

/// Fills a box and draws its edge if it is large enough to have one.
void fill(Image<glm::u8vec4>& image, const Rect& rect, const glm::u8vec4& colour) {
    const int last = static_cast<int>(image.width) - 1;
    const bool edged = rect.x1 - rect.x0 > 3 && rect.y1 - rect.y0 > 3;
    const glm::u8vec4 edge = darker(colour);
    for (int y = std::max(rect.y0, 0); y <= std::min(rect.y1, last); ++y)
        for (int x = std::max(rect.x0, 0); x <= std::min(rect.x1, last); ++x) {
            const bool on_edge = edged && (x == rect.x0 || x == rect.x1 || y == rect.y0 || y == rect.y1);
            image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = on_edge ? edge : colour;
        }
}

/// A line of three pixels' width with a light rim.
void drawLine(Image<glm::u8vec4>& image, glm::dvec2 from, glm::dvec2 to, const glm::u8vec4& colour) {
    const double length = glm::length(to - from);
    const int steps = static_cast<int>(std::min(length * 2, 1e5)) + 1;
    for (int i = 0; i <= steps; ++i) {
        const glm::dvec2 p = from + (to - from) * (double(i) / steps);
        for (int dy = 0; dy <= 1; ++dy)
            for (int dx = 0; dx <= 1; ++dx) {
                const double x = p.x + dx, y = p.y + dy;
                if (x >= 0 && y >= 0 && x < image.width && y < image.height)
                    image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = colour;
            }
    }
}

/// The world point on the near plane (depth -1) at the left or right edge, and one straight behind it.
void drawFrustum(Image<glm::u8vec4>& image, const View& view, const PlanArea& area) {
    const glm::u8vec4 ink(220, 38, 38, 255);
    const glm::dmat4 back = glm::inverse(view.projection * view.view);
    const double scale = image.width / area.side;
    const auto onPlan = [&](const glm::dvec3& p) { return glm::dvec2(p.x - area.x, p.z - area.z) * scale; };
    for (const double side : {-1.0, 1.0}) {
        const glm::dvec4 a = back * glm::dvec4(side, 0, -1, 1), b = back * glm::dvec4(side, 0, 0.5, 1);
        const glm::dvec3 near_point = glm::dvec3(a) / a.w, far_point = glm::dvec3(b) / b.w;
        const glm::dvec2 direction = onPlan(far_point) - onPlan(near_point);
        const double length = glm::length(direction);
        if (!(length > 0) || !std::isfinite(length)) continue;
        const glm::dvec2 from = onPlan(isOrthographic(view) ? near_point : eyePosition(view));
        drawLine(image, from, from + direction / length * (1.5 * image.width), ink);
    }
    const glm::dvec2 eye = onPlan(eyePosition(view));
    const auto round = [](double v) { return static_cast<int>(std::clamp(v, -100.0, 1e5)); };
    fill(image, {round(eye.x) - 3, round(eye.y) - 3, round(eye.x) + 3, round(eye.y) + 3}, ink);
}

}  // namespace

PlanArea planArea(std::span<const Box3d> bounds, std::span<const std::span<const uint8_t>> reasons,
                  std::span<const View> views) {
    Box3d world;
    for (const Box3d& box : bounds)
        if (box.finite()) world.grow(box);
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
    const auto range = [](std::vector<double>& values) {
        std::sort(values.begin(), values.end());
        const size_t cut = values.size() / 100;  // stray far objects do not shrink the rest to a dot
        return glm::dvec2(values[cut], values[values.size() - 1 - cut]);
    };
    PlanArea area;
    if (xs.empty() || world.empty()) return area;
    const glm::dvec2 x = range(xs), z = range(zs);
    const double whole = std::max(world.size().x, world.size().z);
    area.side = std::clamp(1.5 * std::max(x.y - x.x, z.y - z.x), 0.05 * whole, 1.1 * whole);
    if (!(area.side > 0)) area.side = 1;
    area.x = 0.5 * (x.x + x.y) - 0.5 * area.side;
    area.z = 0.5 * (z.x + z.y) - 0.5 * area.side;
    return area;
}

Image<glm::u8vec4> drawPlan(std::span<const Box3d> bounds, std::span<const uint8_t> reasons, const View& view,
                            const PlanArea& area, uint32_t side_pixels) {
    Image<glm::u8vec4> image(side_pixels, side_pixels);
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < bounds.size(); ++i) {
        const Box3d& box = bounds[i];
        if (!box.finite() || box.max.x < area.x || box.max.z < area.z || box.min.x > area.x + area.side ||
            box.min.z > area.z + area.side)
            continue;
        // What spans the whole plan, as a ground does, would say nothing and cover all.
        if (box.size().x > 0.6 * area.side && box.size().z > 0.6 * area.side) continue;
        order.push_back(i);
    }
    // Larger ones first, so that nothing small is covered; of about one size, visible ones last.
    const auto rank = [&](uint32_t i) {
        const double extent = bounds[i].size().x * bounds[i].size().z;
        return std::pair(extent > 0 ? -std::ilogb(extent) : 9999, reasons[i] == 0);
    };
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return rank(a) < rank(b); });
    for (const uint32_t i : order) {
        const glm::dvec3 size = bounds[i].size();
        glm::u8vec4 colour = kPlanPalette[std::min<int>(reasons[i], kPlanColours - 1)];
        if (size.y < 0.05 * std::min(size.x, size.z)) colour.w = colour.w / 3;  // ground and slabs stay in the back
        fill(image, footprint(bounds[i], area, side_pixels), colour);
    }
    drawFrustum(image, view, area);
    return image;
}

}  // namespace sightline
