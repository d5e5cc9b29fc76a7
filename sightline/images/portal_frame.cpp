// A doorway as a window of images: its rectangle, which side it is seen from, and views whose image plane it is.
// SPDX-License-Identifier: MIT
#include "sightline/images/portal_frame.h"

#include "sightline/math/finite.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::images {
namespace {

constexpr double kFlat = 1e-3, kInPlaneShare = 1e-6;

double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    const glm::dvec2 ab = b - a, ac = c - a;
    return ab.x * ac.y - ab.y * ac.x;
}

/// Newell's normal: its length is twice the area.
glm::dvec3 areaVector(std::span<const glm::dvec3> polygon) {
    glm::dvec3 sum(0.0);
    for (size_t i = 2; i < polygon.size(); ++i) sum += glm::cross(polygon[i - 1] - polygon[0], polygon[i] - polygon[0]);
    return sum;
}

Error wrong(const char* what) { return {Error::Kind::kInput, std::string("doorway: ") + what}; }

}  // namespace

bool PortalFrame::holds(const glm::dvec2& point) const {
    const double slack = 1e-9 * (width + height) * (width + height);
    for (size_t i = 0; i < outline.size(); ++i)
        if (turn(outline[i], outline[i + 1 < outline.size() ? i + 1 : 0], point) < -slack) return false;
    return true;
}

Result<PortalFrame> portalFrame(std::span<const glm::dvec3> polygon, const glm::dvec3& seen_from,
                                const glm::dvec3& up) {
    if (polygon.size() < 3) return wrong("fewer than three corners");
    double size = 0;
    for (const glm::dvec3& p : polygon) {
        if (!isFinite(p)) return wrong("a corner is not finite");
        size = std::max(size, glm::length(p - polygon[0]));
    }
    const glm::dvec3 area = areaVector(polygon);
    if (!(glm::length(area) > 1e-9 * size * size)) return wrong("its corners span no area");
    if (!isFinite(seen_from)) return wrong("the viewer's place is not finite");
    PortalFrame frame;
    frame.front = glm::normalize(area);
    const double side = glm::dot(seen_from - polygon[0], frame.front);
    if (!(std::abs(side) > kInPlaneShare * size)) return wrong("the viewer stands in its plane");
    if (side < 0) frame.front = -frame.front;
    glm::dvec3 right = glm::cross(up, frame.front);
    if (!(glm::length(right) > 1e-6 * glm::length(up)))
        right = glm::cross(std::abs(frame.front.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0), frame.front);
    frame.right = glm::normalize(right);
    frame.up = glm::cross(frame.front, frame.right);

    frame.corner = polygon[0];
    glm::dvec2 low(std::numeric_limits<double>::infinity()), high = -low;
    for (const glm::dvec3& p : polygon) {
        const glm::dvec3 own = frame.toFrame(p);
        if (std::abs(own.z) > kFlat * size) return wrong("it is not flat");
        frame.outline.emplace_back(own);
        low = glm::min(low, glm::dvec2(own));
        high = glm::max(high, glm::dvec2(own));
    }
    frame.corner = frame.toWorld({low, 0});
    frame.width = high.x - low.x;
    frame.height = high.y - low.y;
    for (glm::dvec2& p : frame.outline) p -= low;
    if (side < 0) std::reverse(frame.outline.begin(), frame.outline.end());
    const size_t corners = frame.outline.size();
    for (size_t i = 0; i < corners; ++i)
        if (turn(frame.outline[i], frame.outline[(i + 1) % corners], frame.outline[(i + 2) % corners]) <
            -kFlat * size * size)
            return wrong("it is not convex");
    return frame;
}

PortalFrame widened(const PortalFrame& frame, const glm::dvec2& margin) {
    PortalFrame out = frame;
    out.corner = frame.toWorld({-margin, 0});
    out.width += 2 * margin.x;
    out.height += 2 * margin.y;
    for (glm::dvec2& p : out.outline) p += margin;
    return out;
}

EyePlace eyePlace(const PortalFrame& frame, const glm::dvec3& eye) {
    if (!isFinite(eye)) return EyePlace::kNotFinite;
    const double distance = frame.toFrame(eye).z;
    if (std::abs(distance) <= kInPlaneShare * (frame.width + frame.height)) return EyePlace::kInPlane;
    if (distance < 0) return EyePlace::kBehind;
    if (distance < kLeastSine * glm::length(eye - frame.centre())) return EyePlace::kEdgeOn;
    return EyePlace::kBefore;
}

const char* wordsOf(EyePlace place) {
    switch (place) {
        case EyePlace::kBefore:
            return "the eye stands before the doorway";
        case EyePlace::kEdgeOn:
            return "the eye sees the doorway edge-on";
        case EyePlace::kInPlane:
            return "the eye stands in the doorway's plane";
        case EyePlace::kBehind:
            return "the eye stands behind the doorway";
        case EyePlace::kNotFinite:
            return "the eye's place is not finite";
    }
    return "";
}

Result<View> portalView(const PortalFrame& frame, const glm::dvec3& eye, uint32_t width, uint32_t height) {
    const EyePlace place = eyePlace(frame, eye);
    if (place != EyePlace::kBefore) return Error{Error::Kind::kUsage, wordsOf(place)};
    if (width == 0 || height == 0) return Error{Error::Kind::kUsage, "an image of a doorway needs pixels"};
    const glm::dvec3 own = frame.toFrame(eye);
    View view;
    view.width = width;
    view.height = height;
    const glm::dmat3 to_eye = glm::transpose(glm::dmat3(frame.right, frame.up, frame.front));
    view.view = glm::dmat4(to_eye);
    view.view[3] = glm::dvec4(-(to_eye * eye), 1.0);
    // The frustum from the eye through the rectangle.
    const double distance = own.z, left = -own.x, bottom = -own.y;
    glm::dmat4 p(0.0);
    p[0][0] = 2 * distance / frame.width;
    p[1][1] = 2 * distance / frame.height;
    p[2] = glm::dvec4(2 * left / frame.width + 1, 2 * bottom / frame.height + 1, -1, -1);
    p[3][2] = -2 * (distance + kPlaneGap * (frame.width + frame.height));
    view.projection = p;
    return view;
}

}  // namespace sightline::images
