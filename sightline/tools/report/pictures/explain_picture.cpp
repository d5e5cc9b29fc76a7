// A frame drawn to show why one object is kept or culled: its box, its occluders, and the rest pale.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/explain_picture.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/report/pictures/world_lines.h"

namespace sightline::tools {
namespace {

constexpr glm::dvec3 kObject(30, 100, 220), kOccluder(232, 119, 20), kOutline(196, 18, 110), kShadow(176, 74, 0);
constexpr double kPale = 0.72;  // of white, in what is not meant
constexpr double kTint = 0.55;  // of the colour, in what is

Rgb mix(const Rgb& from, const glm::dvec3& to, double part) {
    return Rgb(glm::clamp(glm::dvec3(from) * (1 - part) + to * part + 0.5, 0.0, 255.0));
}

/// Draws over the picture what lies on a line between two places, three pixels wide.
void drawLine(Image<Rgb>& image, const glm::dvec2& from, const glm::dvec2& to, const glm::dvec3& ink = kOutline) {
    const glm::dvec2 step = to - from;
    const double length = std::max(std::abs(step.x), std::abs(step.y));
    const auto steps = static_cast<int64_t>(std::ceil(length)) + 1;
    for (int64_t i = 0; i <= steps; ++i) {
        const glm::dvec2 at = from + step * (static_cast<double>(i) / static_cast<double>(steps));
        for (int dy = -1; dy <= 1; ++dy)
            for (int dx = -1; dx <= 1; ++dx) {
                const double x = std::floor(at.x) + dx, y = std::floor(at.y) + dy;
                if (x < 0 || y < 0 || x >= image.width || y >= image.height) continue;
                image.at(static_cast<uint32_t>(x), static_cast<uint32_t>(y)) = Rgb(ink);
            }
    }
}

/// A line in clip space, cut at the near plane and at the picture's borders; false if nothing of it is in the picture.
bool drawEdge(Image<Rgb>& image, const glm::dvec4& a, const glm::dvec4& b, const glm::dvec3& ink = kOutline) {
    const std::optional<glm::dvec2> part = partInView(a, b);
    if (!part) return false;
    const auto place = [&](double t) {
        const glm::dvec4 p = a + (b - a) * t;
        return glm::dvec2(0.5 * (p.x / p.w + 1) * image.width, 0.5 * (1 - p.y / p.w) * image.height);
    };
    const glm::dvec2 from = place(part->x), to = place(part->y);
    if (!(std::isfinite(from.x) && std::isfinite(from.y) && std::isfinite(to.x) && std::isfinite(to.y))) return false;
    drawLine(image, from, to, ink);
    return true;
}

/// At the picture's border, towards what lies beyond it.
/// @param towards  x to the right, y up; any length
void drawArrow(Image<Rgb>& image, glm::dvec2 towards) {
    const glm::dvec2 size(image.width, image.height), middle = 0.5 * size;
    const double length = glm::length(towards);
    glm::dvec2 along =
        length > 0 && std::isfinite(length) ? glm::dvec2(towards.x, -towards.y) / length : glm::dvec2(0, 1);
    const double unit = 0.04 * std::min(size.x, size.y);
    const glm::dvec2 room = middle - glm::dvec2(0.5 * unit);
    const double reach = std::min(along.x != 0 ? room.x / std::abs(along.x) : room.x + room.y,
                                  along.y != 0 ? room.y / std::abs(along.y) : room.x + room.y);
    const glm::dvec2 tip = middle + reach * along, across(-along.y, along.x);
    drawLine(image, tip - 3 * unit * along, tip);
    for (const double side : {-0.6, 0.6}) drawLine(image, tip - unit * (along + side * across), tip);
}

/// The twelve edges of an object's box, or, where none is in the picture, an arrow towards it; nothing around the eye.
void drawBox(Image<Rgb>& image, const View& view, const Box3d& box, const glm::dmat4& transform) {
    if (!box.finite() || box.empty()) return;
    const glm::dmat4 to_eye = view.view * transform;
    glm::dvec4 corners[8];
    for (int which = 0; which < 8; ++which) {
        const glm::dvec4 corner(which & 1 ? box.max.x : box.min.x, which & 2 ? box.max.y : box.min.y,
                                which & 4 ? box.max.z : box.min.z, 1.0);
        corners[which] = view.projection * (to_eye * corner);
    }
    bool drawn = false;
    for (int which = 0; which < 8; ++which)
        for (const int axis : {1, 2, 4})
            if (!(which & axis)) drawn |= drawEdge(image, corners[which], corners[which | axis]);
    if (drawn) return;
    const glm::dvec3 eye = glm::dvec3(glm::inverse(to_eye)[3]);
    if (glm::all(glm::greaterThan(eye, box.min)) && glm::all(glm::lessThan(eye, box.max))) return;
    drawArrow(image, glm::dvec2(to_eye * glm::dvec4(box.center(), 1)));
}

void drawOutline(Image<Rgb>& image, const View& view, std::span<const glm::dvec3> corners) {
    const auto place = [&](size_t i) {
        return view.projection * (view.view * glm::dvec4(corners[i % corners.size()], 1));
    };
    for (size_t i = 0; i < corners.size(); ++i) drawEdge(image, place(i), place(i + 1), kShadow);
}

void drawRing(Image<Rgb>& image, const glm::dvec2& centre) {
    constexpr int kSides = 24;
    const double radius = std::max(6.0, image.height / 60.0);
    const auto place = [&](int side) {
        const double angle = 2 * std::acos(-1.0) * side / kSides;
        return centre + radius * glm::dvec2(std::cos(angle), std::sin(angle));
    };
    for (int side = 0; side < kSides; ++side) drawLine(image, place(side), place(side + 1));
}

}  // namespace

Image<Rgb> explainPicture(const Scene& scene, const View& view, const Emphasis& emphasis) {
    std::vector<uint32_t> all(scene.objects.size());
    std::iota(all.begin(), all.end(), 0u);
    PictureMaker::Look look = PictureMaker(scene).look(view, all);
    Image<Rgb> image = std::move(look.shaded);
    std::unordered_map<uint32_t, glm::dvec3> tints;
    for (const uint32_t occluder : emphasis.occluders) tints[occluder] = kOccluder;
    tints[emphasis.object] = kObject;
    const uint32_t samples = look.width / image.width;
    for (uint32_t y = 0; y < image.height; ++y)
        for (uint32_t x = 0; x < image.width; ++x) {
            glm::dvec3 ink(0.0);
            double part = 0;
            for (uint32_t k = 0; k < samples * samples; ++k) {
                const uint32_t row = look.height - 1 - (y * samples + k / samples);
                const auto tint = tints.find(look.object[size_t{row} * look.width + x * samples + k % samples]);
                const double share = tint == tints.end() ? kPale : kTint;
                ink += share * (tint == tints.end() ? glm::dvec3(255) : tint->second);
                part += share;
            }
            Rgb& pixel = image.at(x, y);
            pixel = mix(pixel, ink / part, part / (samples * samples));
        }
    for (const std::vector<glm::dvec3>& outline : emphasis.outlines) drawOutline(image, view, outline);
    const SceneObject& object = scene.objects[emphasis.object];
    drawBox(image, view, scene.meshes[object.mesh].bounds, object.transform);
    if (emphasis.has_pixel) drawRing(image, {emphasis.x, emphasis.y});
    return image;
}

}  // namespace sightline::tools
