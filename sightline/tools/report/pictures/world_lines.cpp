// Lines of the world over a drawing of it: what lies behind a surface is faint, or not there.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/world_lines.h"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_access.hpp>

namespace sightline::tools {

std::optional<glm::dvec2> partInView(const glm::dvec4& a, const glm::dvec4& b) {
    double first = 0, last = 1;
    const glm::dvec4 planes[6] = {{1, 0, 0, 1}, {-1, 0, 0, 1}, {0, 1, 0, 1}, {0, -1, 0, 1}, {0, 0, 1, 1}, {0, 0, 0, 1}};
    for (const glm::dvec4& plane : planes) {
        const double da = glm::dot(plane, a), db = glm::dot(plane, b);
        if (da < 0 && db < 0) return std::nullopt;
        if (da < 0) first = std::max(first, da / (da - db));
        if (db < 0) last = std::min(last, da / (da - db));
    }
    if (!(first < last)) return std::nullopt;
    return glm::dvec2(first, last);
}

WorldLines::WorldLines(const View& view, uint32_t width, uint32_t height, std::span<const double> nearness)
    : view_(view), clip_(view.projection * view.view), nearness_(nearness), layer_(width, height, glm::u8vec4(0)) {}

/// Its place on the grid, and how near it is.
glm::dvec3 WorldLines::sampleOf(const glm::dvec3& point, const glm::dvec4& clip) const {
    const double nearness = isOrthographic(view_) ? (view_.view * glm::dvec4(point, 1)).z : 1 / clip.w;
    return {0.5 * (clip.x / clip.w + 1) * layer_.width, 0.5 * (clip.y / clip.w + 1) * layer_.height, nearness};
}

void WorldLines::mark(int64_t x, int64_t y, double nearness, const LineStyle& style) {
    constexpr double kSlack = 0.002;  // of the nearness: what lies on a surface is not behind it
    if (x < 0 || y < 0 || x >= layer_.width || y >= layer_.height) return;
    const size_t at = static_cast<size_t>(y) * layer_.width + static_cast<size_t>(x);
    const double opacity = nearness_[at] > nearness + kSlack * std::abs(nearness) ? style.behind : style.opacity;
    if (opacity > 0) layer_.pixels[at] = glm::u8vec4(style.colour, std::lround(255 * opacity));
}

void WorldLines::line(const glm::dvec3& from, const glm::dvec3& to, const LineStyle& style) {
    const glm::dvec4 a = clip_ * glm::dvec4(from, 1), b = clip_ * glm::dvec4(to, 1);
    const std::optional<glm::dvec2> part = partInView(a, b);
    if (!part) return;
    const auto end = [&](double t) { return sampleOf(from + (to - from) * t, a + (b - a) * t); };
    const glm::dvec3 first = end(part->x), last = end(part->y), way = last - first;
    const double length = std::max(std::abs(way.x), std::abs(way.y));
    if (!std::isfinite(length + first.x + first.y)) return;
    const auto steps = static_cast<int64_t>(std::ceil(length)) + 1;
    const auto wide = std::max<int64_t>(std::lround(samplesIn(style)), 1);
    const double half = 0.5 * static_cast<double>(wide - 1);
    for (int64_t i = 0; i <= steps; ++i) {
        const glm::dvec3 at = first + way * (static_cast<double>(i) / static_cast<double>(steps));
        const auto x = static_cast<int64_t>(std::floor(at.x - half)), y = static_cast<int64_t>(std::floor(at.y - half));
        for (int64_t k = 0; k < wide * wide; ++k) mark(x + k % wide, y + k / wide, at.z, style);
    }
}

void WorldLines::dot(const glm::dvec3& at, const LineStyle& style) {
    const glm::dvec4 clip = clip_ * glm::dvec4(at, 1);
    if (!placeOf(at)) return;
    const glm::dvec3 middle = sampleOf(at, clip);
    const double radius = 0.5 * samplesIn(style);
    const auto reach = static_cast<int64_t>(std::ceil(radius));
    const auto x = static_cast<int64_t>(std::floor(middle.x)), y = static_cast<int64_t>(std::floor(middle.y));
    for (int64_t dy = -reach; dy <= reach; ++dy)
        for (int64_t dx = -reach; dx <= reach; ++dx)
            if (static_cast<double>(dx * dx + dy * dy) <= radius * radius) mark(x + dx, y + dy, middle.z, style);
}

std::optional<glm::dvec2> WorldLines::placeOf(const glm::dvec3& point) const {
    const glm::dvec4 p = clip_ * glm::dvec4(point, 1);
    if (!(p.w > 0 && p.z >= -p.w && std::abs(p.x) <= p.w && std::abs(p.y) <= p.w)) return std::nullopt;
    return glm::dvec2(0.5 * (p.x / p.w + 1), 0.5 * (1 - p.y / p.w));
}

Image<Rgb> WorldLines::over(const Image<Rgb>& picture) const {
    Image<Rgb> out = picture;
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            const glm::dvec3 ground(out.at(x, y));
            glm::dvec3 sum(0.0);
            bool drawn = false;
            for (uint32_t k = 0; k < kPerPixel * kPerPixel; ++k) {
                const glm::u8vec4& sample =
                    layer_.at(kPerPixel * x + k % kPerPixel, layer_.height - 1 - (kPerPixel * y + k / kPerPixel));
                drawn |= sample.w > 0;
                sum += glm::mix(ground, glm::dvec3(sample), sample.w / 255.0);
            }
            if (drawn) out.at(x, y) = Rgb(sum / double(kPerPixel * kPerPixel) + 0.5);
        }
    return out;
}

void drawBox(WorldLines& lines, const Box3d& box, const glm::dmat4& transform, const LineStyle& style) {
    glm::dvec3 corners[8];
    for (int i = 0; i < 8; ++i)
        corners[i] = glm::dvec3(transform * glm::dvec4(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y,
                                                       i & 4 ? box.max.z : box.min.z, 1));
    for (int i = 0; i < 8; ++i)
        for (const int axis : {1, 2, 4})
            if (!(i & axis)) lines.line(corners[i], corners[i | axis], style);
}

void drawFrustum(WorldLines& lines, const View& view, double reach) {
    constexpr Rgb kHalo(255, 255, 255), kInk(20, 24, 31);
    const glm::dvec3 forward = -glm::dvec3(glm::row(view.view, 2));
    const glm::dmat4 back = glm::inverse(view.projection * view.view);
    glm::dvec3 begin[4], end[4];
    for (int i = 0; i < 4; ++i) {
        const glm::dvec2 corner((i == 1 || i == 2) ? 1 : -1, i >= 2 ? 1 : -1);
        const auto at = [&](double z) { return back * glm::dvec4(corner, z, 1); };
        const auto point = [](const glm::dvec4& p) { return glm::dvec3(p) / p.w; };
        begin[i] = point(at(-1));
        const glm::dvec3 way = point(at(0.5)) - begin[i];
        double length = reach / glm::dot(way, forward);  // in lengths of `way`
        if (const glm::dvec4 far = at(1); std::abs(far.w) > 0) {
            const double depth = glm::dot(point(far) - begin[i], forward);
            if (depth > 0 && depth < reach) length *= depth / reach;
        }
        end[i] = begin[i] + length * way;
    }
    const LineStyle halo{kHalo, 3.5, 0.85, 0}, ink{kInk, 1.5, 1, 0.45};
    for (const LineStyle& style : {halo, ink})
        for (int i = 0; i < 4; ++i) {
            lines.line(begin[i], end[i], style);
            lines.line(begin[i], begin[(i + 1) % 4], style);
            lines.line(end[i], end[(i + 1) % 4], style);
        }
    const glm::dvec3 eye =
        isOrthographic(view) ? 0.25 * (begin[0] + begin[1] + begin[2] + begin[3]) : eyePosition(view);
    lines.dot(eye, {kHalo, 12, 1, 1});
    lines.dot(eye, {kInk, 9, 1, 1});
}

}  // namespace sightline::tools
