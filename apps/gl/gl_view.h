// A view as the GL is to draw it: relative to the eye, reversed depth from 1 at the near plane to 0.
// SPDX-License-Identifier: MIT
#pragma once

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline {
using namespace studies;

/// For a clip space of [0, w] in depth (glClipControl), greater is nearer.
struct GlView {
    glm::dvec3 eye{0.0};       ///< or, of a parallel view, the origin of its eye space
    glm::dmat3 rotation{1.0};  ///< world to eye
    glm::dmat4 to_clip{1.0};   ///< eye to clip
    bool mirrored = false;     ///< front faces of unmirrored items come out clockwise

    /// All products are in double, and the large translations are subtracted first.
    glm::dmat4 objectToClip(const glm::dmat4& transform) const;
    /// The winding of an item's front faces in the image: true is clockwise.
    bool frontIsClockwise(const glm::dmat4& transform) const;
};

/// The far plane of a parallel view is brought in to the farthest vertex of the items, since depth is affine there and a
/// float could not resolve a range that has no end.
GlView makeGlView(const View& view, std::span<const DrawItem> items);

}  // namespace sightline
