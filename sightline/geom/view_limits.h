// What a view draws and asks about beside its frustum: section planes, and a window.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/geom/view_volume.h"
#include "sightline/math/box.h"

namespace sightline {

/// The planes of View::sections and View::window as the eye sees them: sections first, each in its order.
struct ViewLimits {
    ViewVolume volume;
    uint32_t sections = 0;  ///< how many planes are sections

    bool none() const { return volume.count == 0; }
    bool cut() const { return sections > 0; }
    bool windowed() const { return volume.count > sections; }
    void dropWindow() { volume.count = sections; }
};
static_assert(2 * ViewPlanes::kMost <= ViewVolume::kMostPlanes);

/// @param view  isUsable(view)
/// @param eye   what the planes are relative to
ViewLimits makeViewLimits(const View& view, const glm::dvec3& eye);

/// True if a box lies wholly inside of all sections, by more than single precision could move it: what it holds is drawn
/// whole.
/// @param box        in object space; empty: it is whole
/// @param transform  object to world
bool isWhole(const ViewLimits& limits, const Box3f& box, const glm::dmat4& transform);
/// The same of a point.
bool isWhole(const ViewLimits& limits, const glm::vec3& point, const glm::dmat4& transform);

/// True if it is certain that a box reaches inside of each of the window's planes.
bool reachesWindow(const ViewLimits& limits, const Box3d& box, const glm::dmat4& transform);

/// Narrows a view to a volume: what a portal shows, volumeOfWindow(); a frustum of its own; two views' common part.
/// @returns false if there was no room for all planes: the window then holds more than the volume
bool addWindow(View& view, const ViewVolume& volume);

/// Narrows a view to what any image within its jitter shows in a rectangle, as one that is drawn with a mouse. One that is
/// turned around is put right.
/// @param left, top, right, bottom  [viewport pixels from the left and the top]
/// @returns false if there was no room: the window then holds more than that; or the view is not usable
bool addWindow(View& view, double left, double top, double right, double bottom);

}  // namespace sightline
