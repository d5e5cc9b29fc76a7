// A run seen from outside: the whole scene with the camera's path in it, and what a frame drew and what it culled.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/outside_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "sightline/tools/report/pictures/plan.h"
#include "sightline/tools/report/pictures/scene_look.h"
#include "sightline/tools/report/pictures/world_lines.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/framing.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
namespace {

constexpr Rgb kPathColour(196, 18, 110), kHaloColour(255, 255, 255);
constexpr double kOutsideAngle = 45;  // of the picture's narrower side  [degrees]
constexpr double kElevation = 40;     // of the eye behind the eye, above what it looks at  [degrees]
constexpr size_t kMostWires = 400;    // triangles: an object of more is drawn as its box

/// Per eye whether it is joined to the one before it.
std::vector<bool> joinedEyes(std::span<const glm::dvec3> eyes, double diagonal) {
    std::vector<double> steps;
    for (size_t i = 1; i < eyes.size(); ++i) steps.push_back(glm::length(eyes[i] - eyes[i - 1]));
    const double most = std::max(4 * medianOf(steps), 0.05 * diagonal);
    std::vector<bool> joined(eyes.size());
    for (size_t i = 1; i < eyes.size(); ++i) joined[i] = steps[i - 1] <= most;
    return joined;
}

void drawPath(WorldLines& lines, std::span<const glm::dvec3> eyes, const std::vector<bool>& joined) {
    const LineStyle halo{kHaloColour, 5, 0.9, 0.25}, ink{kPathColour, 2.5, 1, 0.6};
    for (const LineStyle& style : {halo, ink})
        for (size_t i = 1; i < eyes.size(); ++i)
            if (joined[i]) lines.line(eyes[i - 1], eyes[i], style);
    if (eyes.empty()) return;
    // A tour first shows the whole from afar: its path begins behind that jump.
    const size_t start = eyes.size() > 2 && !joined[1] && joined[2] ? 1 : 0;
    lines.dot(eyes[start], {kHaloColour, 15, 1, 1});
    lines.dot(eyes[start], {kPathColour, 11, 1, 1});
}

/// How far above the eye the lowest visible roof hangs, as far as it is wider than `least`; infinite if there is none.
double roofOver(const PictureMaker& maker, std::span<const uint8_t> reasons, const glm::dvec3& eye, double least) {
    double lowest = std::numeric_limits<double>::infinity();
    for (uint32_t i = 0; i < reasons.size(); ++i) {
        const Box3d& box = maker.bounds()[i];
        if (reasons[i] != 0 || !box.finite() || box.max.y <= eye.y || std::min(box.size().x, box.size().z) < least ||
            eye.x < box.min.x || eye.x > box.max.x || eye.z < box.min.z || eye.z > box.max.z)
            continue;
        const SceneObject& object = maker.scene().objects[i];
        const Mesh& mesh = maker.scene().meshes[object.mesh];
        for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
            glm::dvec3 p[3];
            for (size_t k = 0; k < 3; ++k)
                p[k] = glm::dvec3(object.transform * glm::dvec4(mesh.positions[mesh.indices[t + k]], 1)) - eye;
            double turn[3];  // of the edges around the vertical line through the eye
            for (size_t k = 0; k < 3; ++k) turn[k] = p[k].x * p[(k + 1) % 3].z - p[k].z * p[(k + 1) % 3].x;
            const double area = turn[0] + turn[1] + turn[2];
            if (area == 0 || turn[0] * area < 0 || turn[1] * area < 0 || turn[2] * area < 0) continue;
            const double height = (turn[1] * p[0].y + turn[2] * p[1].y + turn[0] * p[2].y) / area;
            if (height > 0) lowest = std::min(lowest, height);
        }
    }
    return lowest;
}

/// A camera behind an eye, and what it leaves out.
struct Standpoint {
    View view;
    double reach = 1;  ///< how far the picture shows what the eye sees  [world units]
    double top = std::numeric_limits<double>::infinity();  ///< above it all is cut away
};

Standpoint standpointBehind(const PictureMaker& maker, const View& view, std::span<const uint8_t> reasons) {
    Standpoint out;
    const glm::dvec3 eye = eyePosition(view);
    const glm::dmat3 axes = glm::transpose(glm::dmat3(view.view));
    const glm::dvec3 forward = -axes[2];
    // The half of what is visible that is nearer is the picture's subject; the rest lies towards the horizon.
    std::vector<double> distances;
    for (size_t i = 0; i < reasons.size(); ++i)
        if (reasons[i] == 0 && maker.bounds()[i].finite())
            distances.push_back(glm::length(maker.bounds()[i].center() - eye));
    const double diagonal = diagonalOf(coreOf(maker.scene()).bounds);
    out.reach = std::max(distances.empty() ? 0.25 * diagonal : medianOf(distances), 0.02 * diagonal);
    const double roof = roofOver(maker, reasons, eye, 0.25 * out.reach);
    out.top = eye.y + 0.98 * roof;

    glm::dvec3 level(forward.x, 0, forward.z);
    if (glm::length(level) < 0.1) level = glm::dvec3(axes[1].x, 0, axes[1].z);
    level = glm::length(level) > 0 ? glm::normalize(level) : glm::dvec3(0, 0, -1);
    const double up = glm::radians(kElevation), half = glm::radians(0.5 * kOutsideAngle);
    const double aspect = double(view.width) / view.height;
    CameraFrame camera;
    camera.target = eye + 0.6 * out.reach * forward;
    camera.eye =
        camera.target + 0.9 * out.reach / std::sin(half) * (-std::cos(up) * level + std::sin(up) * glm::dvec3(0, 1, 0));
    camera.fov_y_degrees = glm::degrees(2 * std::atan(std::tan(half) / std::min(aspect, 1.0)));
    camera.z_near = 0.001 * out.reach;
    out.view = makeView(camera, view.width, view.height);
    if (std::isfinite(out.top)) out.view.sections.add({0, -1, 0, out.top});
    return out;
}

/// The edges of an object's triangles; of a small or an intricate one those of its box.
void drawWires(WorldLines& lines, const Mesh& mesh, const glm::dmat4& transform, bool small, const LineStyle& style) {
    if (small || mesh.deforms || mesh.triangles() > kMostWires) return drawBox(lines, mesh.bounds, transform, style);
    std::vector<glm::dvec3> points;
    for (const glm::vec3& p : mesh.positions) points.emplace_back(transform * glm::dvec4(p, 1));
    for (size_t i = 0; i < mesh.indices.size(); ++i)
        lines.line(points[mesh.indices[i]], points[mesh.indices[i % 3 == 2 ? i - 2 : i + 1]], style);
}

void drawCulled(WorldLines& lines, const PictureMaker& maker, const Standpoint& from,
                std::span<const uint8_t> reasons) {
    constexpr double kSmall = 16;  // [pixels]
    const glm::dmat4 clip = from.view.projection * from.view.view;
    const glm::dvec3 eye = eyePosition(from.view);
    const double pixels = 0.5 * from.view.projection[1][1] * from.view.height;  // of what is as wide as it is far
    for (uint32_t i = 0; i < reasons.size(); ++i) {
        const Box3d& box = maker.bounds()[i];
        if (reasons[i] == 0 || !box.finite() || box.min.y >= from.top || !mayBeInView(clip, box)) continue;
        const glm::dvec3 nearest = glm::clamp(eye, box.min, box.max);
        const double distance = glm::length(nearest - eye), size = glm::length(box.size());
        if (size * pixels < distance) continue;  // no pixel wide
        const SceneObject& object = maker.scene().objects[i];
        const Rgb colour(kPlanPalette[std::min<int>(reasons[i], kPlanColours - 1)]);
        drawWires(lines, maker.scene().meshes[object.mesh], object.transform, size * pixels < kSmall * distance,
                  {colour, 0.5, 0.8, 0});
    }
}

}  // namespace

Overview overviewPicture(const PictureMaker& maker, std::span<const glm::dvec3> eyes, uint32_t width) {
    constexpr double kAzimuth = 35, kAbove = 35;  // [degrees]
    Box3d bounds = coreOf(maker.scene()).bounds;
    if (bounds.empty()) return {{}, std::vector<std::optional<glm::dvec2>>(eyes.size())};
    const std::vector<bool> joined = joinedEyes(eyes, diagonalOf(bounds));
    Framing framing(bounds.center());
    for (const Box3d& box : maker.bounds())
        if (box.finite()) framing.add(box);
    for (size_t i = 1; i < eyes.size(); ++i)
        if (joined[i]) {
            framing.add(eyes[i - 1]);
            framing.add(eyes[i]);
        }
    if (!(glm::length(bounds.size()) > 1e-9 * (1 + glm::length(bounds.center())))) {  // a single point
        bounds.grow(bounds.center() + 0.5);
        framing.add(bounds);
    }
    const CameraFrame camera = framing.nearest(sideAt(glm::radians(kAzimuth), glm::radians(kAbove)));
    const View view = makeView(camera, width, std::max(width * 9 / 16, 1u));
    std::vector<uint32_t> all(maker.bounds().size());
    std::iota(all.begin(), all.end(), 0u);
    const PictureMaker::Look look = maker.look(view, all);
    WorldLines lines(view, look.width, look.height, look.nearness);
    drawPath(lines, eyes, joined);
    Overview out{lines.over(look.shaded), {}};
    for (const glm::dvec3& eye : eyes) out.eyes.push_back(lines.placeOf(eye));
    return out;
}

Image<Rgb> outsidePicture(const PictureMaker& maker, const View& view, std::span<const uint8_t> reasons) {
    const Standpoint from = standpointBehind(maker, view, reasons);
    std::vector<uint32_t> kept;
    for (uint32_t i = 0; i < reasons.size(); ++i)
        if (reasons[i] == 0) kept.push_back(i);
    const PictureMaker::Look look = maker.look(from.view, kept);
    WorldLines lines(from.view, look.width, look.height, look.nearness);
    drawCulled(lines, maker, from, reasons);
    drawFrustum(lines, view, from.reach);
    return lines.over(look.shaded);
}

}  // namespace sightline::tools
