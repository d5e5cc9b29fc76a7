// What a flat mirror shows, as a view of its own: of the same world, from the eye's place behind the glass.
// SPDX-License-Identifier: MIT
//
// David Luebke, Chris Georges. Portals and Mirrors: Simple, Fast Evaluation of Potentially Visible Sets. 1995.
#pragma once

#include <optional>
#include <span>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"

namespace sightline {

/// The view whose answer is what can be seen in a mirror: asked of the same world, it reports the objects with a point that
/// the eye sees by way of the glass. The eye is reflected; what lies behind the mirror's plane is cut away as by a section;
/// and sight lines begin on the outline (View::through), which is also the view's window.
///
/// Its image is the mirror's turned left to right, so that triangles keep their sense of rotation: draw it as it is, and
/// turn it when it is put on the glass. Windows and section planes of the view itself do not hold for what is reflected,
/// and are dropped. Mirrors in mirrors: ask again with the view that came out.
///
/// @param view     isUsable(view)
/// @param outline  of the glass, convex and flat, counter-clockwise as seen from its front  [world units]
///                 [size: 3 or more; of more than ViewOutline::kMost corners, a rectangle around them stands for them]
/// @returns nothing if the eye is not in front of the glass (in parallel views: if they do not look at its front), or
///          the outline has no area or is not finite: then nothing is seen in it
std::optional<View> mirroredView(const View& view, std::span<const glm::dvec3> outline);

}  // namespace sightline
