// The last word on an alarm: is a point of an object really unhidden, in double and with every doubt for the defence.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/tools/truth/scene_facts.h"
#include "sightline/tools/truth/sight.h"

namespace sightline::tools {

/// Confirms sightings against all triangles of the scene.
///
/// A sighting is confirmed only if it holds beyond rounding. The object's triangle must face the eye and be met
/// by more than the rounding of its vertices; an occluder's triangle hides if the line of sight passes within that
/// rounding of it. In depth an occluder must be nearer by more than 1e-9 of the distance: equality is visible.
/// Two surfaces closer than that count as equal.
class ExactSight {
public:
    ExactSight(const SceneFacts& facts, const SightLines& sight) : facts_(facts), sight_(sight) {}

    /// True if the line of sight through a place of the image (clip x, y over w) meets the object, and nothing
    /// hides the first place where it does.
    bool seesObject(const glm::dvec2& place, uint32_t object) const;

    /// True if a point of a triangle of the object is in the frustum, faces the eye, and nothing hides it. A triangle that
    /// the eye sees without area, from its edge or because it has none, is not drawn, and not seen.
    /// @param point  relative to the eye
    /// @param place  receives where it appears
    bool seesPoint(uint32_t object, uint32_t triangle, const glm::dvec3& point, glm::dvec2& place) const;
    /// The same of a point on a given line of sight, in the frustum or not.
    bool seesPointOn(const SightRay& ray, uint32_t object, uint32_t triangle, const glm::dvec3& point) const;

    /// The corners of a triangle, relative to the eye.
    void corners(uint32_t object, uint32_t triangle, glm::dvec3 (&points)[3]) const;

    struct Met {
        uint32_t object = 0, triangle = 0;
    };
    /// The triangles that hide and that a ray may meet, with every doubt for them: none that it meets is missing. Of objects
    /// that are equal (SceneFacts::firstEqual) it names the first.
    void hidersOn(const SightRay& ray, std::vector<Met>& met) const;

    /// How far the positions of an object may be off, relative to the eye  [world units].
    double roundingOf(uint32_t object) const;

private:
    template <class Found>
    void forEachHider(const SightRay& ray, double from, double to, uint32_t by_others_than, Found&& found) const;
    bool hidden(const SightRay& ray, double t, uint32_t by_others_than) const;

    const SceneFacts& facts_;
    const SightLines& sight_;
};

}  // namespace sightline::tools
