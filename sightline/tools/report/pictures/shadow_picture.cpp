// Why an object is hidden, from the side: the eye, the parts of others that hide it, and their shadows.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/shadow_picture.h"

#include <algorithm>
#include <cmath>

#include "sightline/tools/report/pictures/world_lines.h"
#include "sightline/tools/scene/framing.h"

namespace sightline::tools {
namespace {

constexpr Rgb kShadow(176, 74, 0), kObject(196, 18, 110);
constexpr double kAround = 115, kAbove = 35;  // from behind the eye; above the horizon  [degrees]

/// How many boxes a line of sight passes through.
size_t boxesBetween(const glm::dvec3& from, const glm::dvec3& to, std::span<const Box3d> boxes) {
    size_t count = 0;
    for (const Box3d& box : boxes) {
        double enters = 0, leaves = 1;
        for (int axis = 0; axis < 3; ++axis) {
            const double way = to[axis] - from[axis];
            const double a = (box.min[axis] - from[axis]) / way, b = (box.max[axis] - from[axis]) / way;
            enters = std::max(enters, std::min(a, b));
            leaves = std::min(leaves, std::max(a, b));
        }
        count += enters <= leaves;
    }
    return count;
}

/// From that side from which fewer occluders are before the object. Of what is very large only what is near counts.
/// @param far  from the eye to where shadows end
View viewFromTheSide(const View& view, const Box3d& box, std::span<const Box3d> occluders, const Emphasis& emphasis,
                     double far) {
    const glm::dvec3 eye = eyePosition(view), way = box.center() - eye, middle = eye + 0.5 * way;
    Framing framing(middle);
    framing.add(eye);
    framing.add(box);
    const auto addNear = [&](const glm::dvec3& point) {
        const double distance = glm::length(point - middle), most = 0.75 * far;
        framing.add(distance > most ? middle + (most / distance) * (point - middle) : point);
    };
    for (const std::vector<glm::dvec3>& outline : emphasis.outlines)
        for (const glm::dvec3& corner : outline) {
            addNear(corner);
            addNear(shadowEnd(eye, corner, far));
        }
    const double behind = glm::length(glm::dvec2(way.x, way.z)) > 0 ? std::atan2(-way.x, -way.z) : 0;
    CameraFrame best;
    size_t fewest = occluders.size() + 1;
    for (const double side : {kAround, -kAround}) {
        const CameraFrame camera = framing.nearest(sideAt(behind + glm::radians(side), glm::radians(kAbove)));
        const size_t between = boxesBetween(camera.eye, box.center(), occluders);
        if (between < fewest) fewest = between, best = camera;
    }
    return makeView(best, view.width, view.height);
}

void drawShadow(WorldLines& lines, const glm::dvec3& eye, const std::vector<glm::dvec3>& outline, double far) {
    const LineStyle ray{kShadow, 1, 0.5, 0.25}, edge{kShadow, 1.5, 0.9, 0.45}, part{kShadow, 3, 1, 0.7};
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 &a = outline[i], &b = outline[(i + 1) % outline.size()];
        lines.line(eye, a, ray);
        lines.line(a, shadowEnd(eye, a, far), edge);
        lines.line(shadowEnd(eye, a, far), shadowEnd(eye, b, far), edge);
        lines.line(a, b, part);
    }
}

}  // namespace

glm::dvec3 shadowEnd(const glm::dvec3& eye, const glm::dvec3& corner, double far) {
    const double distance = glm::length(corner - eye);
    return distance > 0 ? eye + (std::max(far, distance) / distance) * (corner - eye) : corner;
}

Image<Rgb> shadowPicture(const PictureMaker& maker, const View& view, const Emphasis& emphasis) {
    const Scene& scene = maker.scene();
    const SceneObject& object = scene.objects[emphasis.object];
    const Box3d& box = maker.bounds()[emphasis.object];
    const glm::dvec3 eye = eyePosition(view);
    double far = 0;
    for (int i = 0; i < 8; ++i) far = std::max(far, glm::length(box.corner(i) - eye));
    far *= 1.1;
    std::vector<Box3d> occluders;
    for (const uint32_t occluder : emphasis.occluders) occluders.push_back(maker.bounds()[occluder]);
    const View outside = viewFromTheSide(view, box, occluders, emphasis, far);

    std::vector<uint32_t> shown(emphasis.occluders.begin(), emphasis.occluders.end());
    shown.push_back(emphasis.object);
    std::sort(shown.begin(), shown.end());
    shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
    const PictureMaker::Look look = maker.look(outside, shown);
    WorldLines lines(outside, look.width, look.height, look.nearness);
    for (const std::vector<glm::dvec3>& outline : emphasis.outlines) drawShadow(lines, eye, outline, far);
    drawBox(lines, scene.meshes[object.mesh].bounds, object.transform, {kObject, 3, 1, 0.8});
    drawFrustum(lines, view, far);
    return lines.over(look.shaded);
}

}  // namespace sightline::tools
