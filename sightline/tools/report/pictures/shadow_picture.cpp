// Why an object is hidden, from the side: the eye, the parts of others that hide it, and their shadows.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/shadow_picture.h"

#include <algorithm>
#include <cmath>

#include "sightline/tools/report/pictures/world_lines.h"
#include "sightline/tools/scene/framing.h"

namespace sightline::tools {
namespace {

constexpr Rgb kRayInk(176, 74, 0), kCasterInk(196, 18, 110), kOccluderInk(110, 116, 128);
constexpr int kBetween = 12;                  // pieces of the end of a shadow, for each side of its part
constexpr double kAround = 115, kAbove = 35;  // from behind the eye; above the horizon  [degrees]

/// Adds places at a distance from the eye, from where it sees one point up to, but without, where it sees another.
void addArc(std::vector<glm::dvec3>& arc, const glm::dvec3& eye, const glm::dvec3& from, const glm::dvec3& to,
            double reach) {
    const auto towards = [&](const glm::dvec3& point) {
        const double length = glm::length(point - eye);
        return length > 0 ? (point - eye) / length : glm::dvec3(0.0);
    };
    const glm::dvec3 a = towards(from), b = towards(to);
    const double angle = std::acos(std::clamp(glm::dot(a, b), -1.0, 1.0)), sine = std::sin(angle);
    for (int k = 0; k < kBetween; ++k) {
        const double part = double(k) / kBetween;
        const bool turns = sine > 1e-9;
        arc.push_back(eye +
                      reach * (turns ? (std::sin((1 - part) * angle) * a + std::sin(part * angle) * b) / sine : a));
    }
}

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
    for (const std::vector<glm::dvec3>& outline : emphasis.outlines) {
        for (const glm::dvec3& corner : outline) addNear(corner);
        for (const glm::dvec3& end : shadowEnd(eye, outline, shadowReach(eye, box, outline))) addNear(end);
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

void drawShadow(WorldLines& lines, const glm::dvec3& eye, std::span<const glm::dvec3> outline, double reach) {
    const LineStyle ray{kRayInk, 1, 0.5, 0.25}, edge{kRayInk, 1.5, 0.9, 0.45}, part{kRayInk, 3, 1, 0.7};
    const std::vector<glm::dvec3> ends = shadowEnd(eye, outline, reach);
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& corner : outline) middle += corner / static_cast<double>(outline.size());
    for (size_t i = 0; i < ends.size(); ++i) lines.line(ends[i], ends[(i + 1) % ends.size()], edge);
    for (size_t corner = 0; corner < outline.size(); ++corner) {  // how its end bulges
        std::vector<glm::dvec3> arc;
        addArc(arc, eye, middle, outline[corner], reach);
        arc.push_back(ends[kBetween * corner]);
        for (size_t i = 1; i < arc.size(); ++i) lines.line(arc[i - 1], arc[i], ray);
    }
    for (size_t i = 0; i < outline.size(); ++i) {
        lines.line(eye, outline[i], ray);
        lines.line(outline[i], ends[kBetween * i], edge);
        lines.line(outline[i], outline[(i + 1) % outline.size()], part);
    }
}

}  // namespace

double shadowReach(const glm::dvec3& eye, const Box3d& object, std::span<const glm::dvec3> outline) {
    double far = 0;
    for (int i = 0; i < 8; ++i) far = std::max(far, glm::length(object.corner(i) - eye));
    for (const glm::dvec3& corner : outline) far = std::max(far, glm::length(corner - eye));
    return 1.1 * far;
}

std::vector<glm::dvec3> shadowEnd(const glm::dvec3& eye, std::span<const glm::dvec3> outline, double reach) {
    std::vector<glm::dvec3> ends;
    for (size_t i = 0; i < outline.size(); ++i) addArc(ends, eye, outline[i], outline[(i + 1) % outline.size()], reach);
    return ends;
}

Image<Rgb> shadowPicture(const PictureMaker& maker, const View& view, const Emphasis& emphasis) {
    const Scene& scene = maker.scene();
    const SceneObject& object = scene.objects[emphasis.object];
    const Box3d& box = maker.bounds()[emphasis.object];
    const glm::dvec3 eye = eyePosition(view);
    const double far = shadowReach(eye, box, {});
    std::vector<Box3d> occluders;
    for (const uint32_t occluder : emphasis.occluders) occluders.push_back(maker.bounds()[occluder]);
    const View outside = viewFromTheSide(view, box, occluders, emphasis, far);

    std::vector<uint32_t> shown(emphasis.occluders.begin(), emphasis.occluders.end());
    shown.push_back(emphasis.object);
    std::sort(shown.begin(), shown.end());
    shown.erase(std::unique(shown.begin(), shown.end()), shown.end());
    const PictureMaker::Look look = maker.look(outside, shown);
    WorldLines lines(outside, look.width, look.height, look.nearness);
    // Backs of single-sided occluders are not drawn: their boxes stand for them.
    for (const uint32_t occluder : emphasis.occluders)
        drawBox(lines, scene.meshes[scene.objects[occluder].mesh].bounds, scene.objects[occluder].transform,
                {kOccluderInk, 1, 0.6, 0.3});
    for (const std::vector<glm::dvec3>& outline : emphasis.outlines)
        drawShadow(lines, eye, outline, shadowReach(eye, box, outline));
    drawBox(lines, scene.meshes[object.mesh].bounds, object.transform, {kCasterInk, 3, 1, 0.8});
    drawFrustum(lines, view, far);
    return lines.over(look.shaded);
}

}  // namespace sightline::tools
