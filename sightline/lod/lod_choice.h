// Which level of detail an object needs: by the size of its error in the image, steady under noise, faded from one to the next.
// SPDX-License-Identifier: MIT
//
// James Clark. Hierarchical Geometric Models for Visible Surface Algorithms. 1976.
// Hugues Hoppe. Progressive Meshes. 1996 (geomorphs).
// David Luebke, Martin Reddy, Jonathan Cohen, Amitabh Varshney, Benjamin Watson, Robert Huebner. Level of Detail for 3D
// Graphics. 2002 (hysteresis, errors in the image).
#pragma once

#include <cstdint>
#include <span>

#include <glm/glm.hpp>

#include "sightline/geom/lod.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"

namespace sightline {

/// How a view's image shows lengths.
struct LodMeasure {
    glm::dvec3 eye{0.0};
    glm::dvec3 toward{0.0};  ///< unit direction that the view looks in
    bool perspective = true;
    double pixels = 0;    ///< of a unit of length across the view at distance one; of a parallel view, anywhere
    double viewport = 0;  ///< square pixels of it all
};

/// @param view  isUsable(view)
LodMeasure makeLodMeasure(const View& view);

/// By how much an error may look larger in the corner of the image than in its middle. Errors are measured by the angle
/// that they fill, so that an object keeps its level when the camera turns; a flat image shows the same angle larger
/// towards its edges.  [ratio, >= 1; 1 in a parallel view]
double cornerStretch(const View& view);

/// How many pixels a step of one world unit may span at the nearest point of a box. Infinite if the box holds the eye.
double pixelsOfUnit(const LodMeasure& measure, const Box3d& box);

/// How many pixels the sphere around a box covers at most, wherever the camera turns; no more than the viewport has.
double pixelsOfBox(const LodMeasure& measure, const Box3d& box);

/// When a level may be drawn, and how it gives way to another one.
struct LodRule {
    double error = 1;         ///< that may be seen  [pixels]
    double hysteresis = 0.1;  ///< a coarser level must stay below the error by this share, to be taken  [0 to 1]
    uint32_t fade = 0;        ///< how many answers a change takes; 0: it is done at once  [limit: <= kLongestFade]
};
inline constexpr uint32_t kLongestFade = 255;

/// What is remembered of an object from answer to answer.
struct LodState {
    uint8_t level = 0;
    uint8_t from = 0;
    uint8_t left = 0;  ///< answers that the fade still takes; 0: there is none
};

/// The levels that the rule leaves to choose from, given the level that the last answer had.
struct LodRange {
    uint8_t finest = 0;    ///< nothing finer is needed
    uint8_t coarsest = 0;  ///< >= finest
};

/// The levels whose error the rule lets pass. Without a memory it is one level: the coarsest whose error passes.
///
/// Steady: an object whose errors change to and fro by less than the rule's hysteresis (half of it, with a fade)
/// changes its level once at most.
/// @param levels          finest first, errors rising
/// @param pixels_of_unit  of the object's own space: largestStretch() * pixelsOfUnit()
/// @param remembers       whether there was a level, `last`, in the last answer
LodRange lodRange(std::span<const LodLevel> levels, double pixels_of_unit, const LodRule& rule, bool remembers);

/// The level nearest to the last one.
inline uint8_t levelIn(const LodRange& range, uint8_t last) {
    return last < range.finest ? range.finest : last > range.coarsest ? range.coarsest : last;
}

/// Lets one more answer pass. A change begins when no other one is under way. It is done at once if the rule has no
/// fade, or where what would be faded out errs by more than the rule's error: so no answer shows more than that.
/// @param target  the level that is wanted
LodState nextState(const LodState& last, uint8_t target, std::span<const LodLevel> levels, double pixels_of_unit,
                   const LodRule& rule);

/// What a renderer is told.
VisibleLod visibleLod(const LodState& state, std::span<const LodLevel> levels, double pixels_of_unit,
                      const LodRule& rule);

}  // namespace sightline
