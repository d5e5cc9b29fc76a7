// The world from above and from the side, each object in the colour of what culled it, with the camera's frustum.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/plan.h"

#include <algorithm>
#include <cmath>
#include <tuple>

namespace sightline::tools {

const glm::u8vec4 kPlanPalette[kPlanColours] = {{0, 114, 178, 255},   {91, 74, 138, 140}, {143, 111, 209, 215},
                                                {138, 148, 163, 140}, {0, 158, 115, 215}, {150, 132, 20, 215},
                                                {204, 121, 167, 215}, {230, 126, 0, 215}, {107, 45, 30, 215},
                                                {140, 109, 31, 215},  {125, 90, 80, 215}};

namespace {

const glm::u8vec4 kInk(20, 24, 31, 255), kHalo(255, 255, 255, 255), kInView(250, 204, 21, 60);

struct Rect {
    int x0, y0, x1, y1;  // inclusive
};

/// From world to pixels.
class Paper {
public:
    Paper(const PlanArea& area, uint32_t width) : area_(area), scale_x_(width / area.width) {
        height = std::max(1u, static_cast<uint32_t>(std::lround(width * heightOverWidth(area))));
        scale_y_ = height / area.height;
        limit_ = std::max(width, height) + 1.0;
    }

    /// A section's height in pixels follows its shape, not its stretch.
    static double heightOverWidth(const PlanArea& area) { return area.upward ? 1 / 2.4 : area.height / area.width; }

    glm::dvec2 at(const glm::dvec3& p) const {
        const double v = area_.upward ? area_.top - p[area_.down] : p[area_.down] - area_.top;
        return {(p[area_.across] - area_.left) * scale_x_, v * scale_y_};
    }

    Rect footprint(const Box3d& box) const {
        const glm::dvec2 a = at(box.min), b = at(box.max);
        const auto pixel = [&](double v) { return static_cast<int>(std::floor(std::clamp(v, -2.0, limit_))); };
        return {pixel(a.x), pixel(std::min(a.y, b.y)), pixel(b.x), pixel(std::max(a.y, b.y))};
    }

    uint32_t height = 1;

private:
    PlanArea area_;
    double scale_x_ = 1, scale_y_ = 1, limit_ = 1;
};

glm::u8vec4 darker(const glm::u8vec4& colour) {
    return {static_cast<uint8_t>(colour.x * 0.7), static_cast<uint8_t>(colour.y * 0.7),
            static_cast<uint8_t>(colour.z * 0.7), colour.w};
}

/// Fills a box and draws its edge if it is large enough to have one.
void fill(Image<glm::u8vec4>& image, const Rect& rect, const glm::u8vec4& colour) {
    const int last_x = static_cast<int>(image.width) - 1, last_y = static_cast<int>(image.height) - 1;
    const bool edged = rect.x1 - rect.x0 > 3 && rect.y1 - rect.y0 > 3;
    const glm::u8vec4 edge = darker(colour);
    for (int y = std::max(rect.y0, 0); y <= std::min(rect.y1, last_y); ++y)
        for (int x = std::max(rect.x0, 0); x <= std::min(rect.x1, last_x); ++x) {
            const bool on_edge = edged && (x == rect.x0 || x == rect.x1 || y == rect.y0 || y == rect.y1);
            image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = on_edge ? edge : colour;
        }
}

void drawDot(Image<glm::u8vec4>& image, glm::dvec2 at, int radius, const glm::u8vec4& colour) {
    if (!(std::abs(at.x) < 1e6 && std::abs(at.y) < 1e6)) return;
    for (int dy = -radius; dy <= radius; ++dy)
        for (int dx = -radius; dx <= radius; ++dx) {
            const double x = std::floor(at.x) + dx, y = std::floor(at.y) + dy;
            if (dx * dx + dy * dy > radius * radius + 1) continue;
            if (x >= 0 && y >= 0 && x < image.width && y < image.height)
                image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = colour;
        }
}

void drawLine(Image<glm::u8vec4>& image, glm::dvec2 from, glm::dvec2 to, int radius, const glm::u8vec4& colour) {
    const double length = glm::length(to - from);
    const int steps = static_cast<int>(std::min(length * 1.5, 1e5)) + 1;
    for (int i = 0; i <= steps; ++i) drawDot(image, from + (to - from) * (double(i) / steps), radius, colour);
}

/// The two edges of the view volume as they lie on the paper.
struct Wedge {
    glm::dvec2 from[2], direction[2];
    bool usable = false;

    bool holds(const glm::dvec2& p) const {
        const auto side = [&](int i) {
            const glm::dvec2 d = p - from[i];
            return direction[i].x * d.y - direction[i].y * d.x;
        };
        const glm::dvec2 middle = direction[0] + direction[1];
        return side(0) * side(1) <= 0 && glm::dot(p - from[0], middle) >= 0;
    }
};

Wedge wedgeOf(const View& view, const PlanArea& area, const Paper& paper) {
    const glm::dmat4 back = glm::inverse(view.projection * view.view);
    Wedge wedge;
    wedge.usable = true;
    for (int i = 0; i < 2; ++i) {
        const double side = i ? 1.0 : -1.0;
        const glm::dvec2 edge = area.upward ? glm::dvec2(0, side) : glm::dvec2(side, 0);
        const glm::dvec4 a = back * glm::dvec4(edge, -1, 1), b = back * glm::dvec4(edge, 0.5, 1);
        const glm::dvec3 near_point = glm::dvec3(a) / a.w, far_point = glm::dvec3(b) / b.w;
        const glm::dvec2 direction = paper.at(far_point) - paper.at(near_point);
        const double length = glm::length(direction);
        wedge.from[i] = paper.at(isOrthographic(view) ? near_point : eyePosition(view));
        wedge.direction[i] = direction / length;
        wedge.usable &= length > 0 && std::isfinite(length) && std::isfinite(wedge.from[i].x + wedge.from[i].y);
    }
    return wedge;
}

void drawFrustum(Image<glm::u8vec4>& image, const View& view, const PlanArea& area, const Paper& paper) {
    const Wedge wedge = wedgeOf(view, area, paper);
    const double far_away = 1.5 * (image.width + image.height);
    if (wedge.usable) {
        for (uint32_t y = 0; y < image.height; ++y)
            for (uint32_t x = 0; x < image.width; ++x)
                if (image.at(x, y).w == 0 && wedge.holds({x + 0.5, y + 0.5})) image.at(x, y) = kInView;
        for (const bool halo : {true, false})
            for (int i = 0; i < 2; ++i)
                drawLine(image, wedge.from[i], wedge.from[i] + wedge.direction[i] * far_away, halo ? 2 : 1,
                         halo ? kHalo : kInk);
    }
    const glm::dvec2 eye = paper.at(eyePosition(view));
    drawDot(image, eye, 7, kHalo);
    drawDot(image, eye, 5, kInk);
}

}  // namespace

Image<glm::u8vec4> drawPlan(std::span<const Box3d> bounds, std::span<const uint8_t> reasons, const View& view,
                            const PlanArea& area, const PlanBand& band, uint32_t width_pixels) {
    const Paper paper(area, width_pixels);
    Image<glm::u8vec4> image(width_pixels, paper.height, glm::u8vec4(0));
    const int a = area.across, d = area.down, through = area.through();
    const double low = area.upward ? area.top - area.height : area.top, high = low + area.height;
    std::vector<std::tuple<bool, int, bool, uint32_t>> order;
    for (uint32_t i = 0; i < bounds.size(); ++i) {
        const Box3d& box = bounds[i];
        if (!box.finite() || box.max[a] < area.left || box.min[a] > area.left + area.width || box.max[d] < low ||
            box.min[d] > high)
            continue;
        // From above, what spans the whole plan, as a ground does, would say nothing and cover all.
        const glm::dvec3 size = box.size();
        if (size[a] > 0.6 * area.width && size[d] > 0.6 * area.height) continue;
        // Pale ones first, then larger ones, so that nothing small is covered; of about one size, visible ones last.
        const bool inside = box.max[through] >= band.low && box.min[through] <= band.high;
        const double extent = size[a] * size[d];
        order.emplace_back(inside, extent > 0 ? -std::ilogb(extent) : 9999, reasons[i] == 0, i);
    }
    std::sort(order.begin(), order.end());
    for (const auto& [inside, rank, visible, i] : order) {
        const glm::dvec3 size = bounds[i].size();
        glm::u8vec4 colour = kPlanPalette[std::min<int>(reasons[i], kPlanColours - 1)];
        if (!inside) colour.w = colour.w / 5;
        else if (size[through] < 0.05 * std::min(size[a], size[d])) colour.w = colour.w / 3;  // ground and slabs
        fill(image, paper.footprint(bounds[i]), colour);
    }
    drawFrustum(image, view, area, paper);
    return image;
}

void drawOnPlan(Image<glm::u8vec4>& image, const PlanArea& area, std::span<const PlanLine> lines,
                const glm::u8vec4& colour, int radius) {
    const Paper paper(area, image.width);
    for (const PlanLine& line : lines) drawLine(image, paper.at(line.from), paper.at(line.to), radius, colour);
}

}  // namespace sightline::tools
