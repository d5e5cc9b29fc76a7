// Puts the picture of a doorway where the doorway is in a viewer's image, behind what stands before it.
// SPDX-License-Identifier: MIT
#include "sightline/images/portal_screen.h"

#include <algorithm>

#include "sightline/studies/hidden/shade/unprojection.h"

namespace sightline::images {
namespace {

/// Where a sample's line of sight meets the doorway's plane.
struct Meeting {
    glm::dvec2 place{0.0};  ///< in the frame's own coordinates
    double w = 0;           ///< of the view, there
};

/// The picture between the middles of its texels.
glm::u8vec3 texelsAt(const PortalPicture& picture, const glm::dvec2& place) {
    const glm::dvec2 last(picture.width - 1.0, picture.height - 1.0);
    const glm::dvec2 inside = glm::clamp(place, glm::dvec2(0.0), last);
    const glm::dvec2 low = glm::floor(inside), high = glm::min(low + 1.0, last), part = inside - low;
    const auto at = [&](double column, double row) {
        return glm::dvec3(picture.colour[static_cast<size_t>(row) * picture.width + static_cast<size_t>(column)]);
    };
    const glm::dvec3 below = glm::mix(at(low.x, low.y), at(high.x, low.y), part.x);
    const glm::dvec3 above = glm::mix(at(low.x, high.y), at(high.x, high.y), part.x);
    return glm::u8vec3(glm::mix(below, above, part.y) + 0.5);
}

/// @param met  called with the index of each sample that looks through the doorway, and where
template <class Met>
void forEachThrough(const PortalFrame& frame, const View& view, const Met& met) {
    const glm::dvec3 eye = frame.toFrame(eyePosition(view));
    if (!(eye.z > 0)) return;
    const studies::Unprojection unprojection(view, view.width, view.height);
    const glm::dmat3 to_frame =
        glm::transpose(glm::dmat3(frame.right, frame.up, frame.front)) * glm::transpose(glm::dmat3(view.view));
    for (uint32_t row = 0; row < view.height; ++row)
        for (uint32_t i = 0; i < view.width; ++i) {
            const glm::dvec3 direction = to_frame * unprojection.lineOfSight(i, row).direction;
            if (!(direction.z < 0)) continue;
            const double w = -eye.z / direction.z;
            const glm::dvec2 place = glm::dvec2(eye) + w * glm::dvec2(direction);
            if (place.x < 0 || place.y < 0 || place.x > frame.width || place.y > frame.height) continue;
            if (frame.holds(place)) met(row * view.width + i, Meeting{place, w});
        }
}

}  // namespace

std::vector<uint32_t> samplesThrough(const PortalFrame& frame, const View& view) {
    std::vector<uint32_t> samples;
    forEachThrough(frame, view, [&](uint32_t at, const Meeting&) { samples.push_back(at); });
    return samples;
}

uint64_t drawOnScreen(const PortalFrame& frame, const PortalPicture& picture, const View& view,
                      std::span<const float> nearness, std::span<glm::u8vec3> colours) {
    uint64_t drawn = 0;
    if (picture.colour.empty()) return drawn;
    const glm::dvec2 texels(picture.width / frame.width, picture.height / frame.height);
    const double distance = frame.toFrame(eyePosition(view)).z;
    const double nearest = distance / (distance + kPlaneGap * (frame.width + frame.height));
    forEachThrough(frame, view, [&](uint32_t at, const Meeting& meeting) {
        // What lies in the doorway's own plane is before it.
        if (!nearness.empty() && double{nearness[at]} * meeting.w >= nearest) return;
        colours[at] = texelsAt(picture, meeting.place * texels - 0.5);
        ++drawn;
    });
    return drawn;
}

}  // namespace sightline::images
