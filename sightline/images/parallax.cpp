// How far off an image of a doorway is for another eye: bounds that no point beyond it exceeds.
// SPDX-License-Identifier: MIT
#include "sightline/images/parallax.h"

#include <algorithm>
#include <cmath>

namespace sightline::images {
namespace {

/// Share of the plane's displacement that a depth beyond it has.
double shareOf(double depth, double distance) { return std::isinf(depth) ? 1.0 : depth / (distance + depth); }

constexpr double kRounding = 1 + 1e-12;

}  // namespace

double parallaxPixels(double focal, double offset, double z_portal, double z_far) {
    return focal * offset * (1 / z_portal - 1 / z_far);
}

double focalLength(const View& view) { return 0.5 * view.height * std::abs(view.projection[1][1]); }

Displacement displacementBound(const PortalFrame& frame, const glm::dvec3& from, const glm::dvec3& to,
                               const BeyondRange& beyond, double focal) {
    if (eyePlace(frame, from) != EyePlace::kBefore || eyePlace(frame, to) != EyePlace::kBefore) {
        constexpr double kInfinite = std::numeric_limits<double>::infinity();
        return {kInfinite, kInfinite, kInfinite};
    }
    const glm::dvec3 old_eye = frame.toFrame(from), new_eye = frame.toFrame(to);
    double most = 0;
    for (int i = 0; i < 4; ++i) {
        const glm::dvec2 corner((i & 1) != 0 ? frame.width : 0.0, (i & 2) != 0 ? frame.height : 0.0);
        const glm::dvec2 moved =
            (glm::dvec2(new_eye) - corner) + (corner - glm::dvec2(old_eye)) * (new_eye.z / old_eye.z);
        most = std::max(most, glm::length(moved));
    }
    const double far_share = shareOf(beyond.farthest, new_eye.z), near_share = shareOf(beyond.nearest, new_eye.z);
    const double scale = focal / new_eye.z * kRounding;
    Displacement out;
    out.on_plane = most * far_share * kRounding;
    out.pixels = most * far_share * scale;
    out.exposed = most * (far_share - near_share) * scale;
    return out;
}

}  // namespace sightline::images
