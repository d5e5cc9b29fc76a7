// Levels of detail as plain data: how far a simpler mesh errs, and what it takes to draw.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sightline {

/// One level of detail of a mesh.
struct LodLevel {
    /// No point of this level's surface is farther from the finest level's, nor the other way round: an upper bound of
    /// the Hausdorff distance. The finest level has 0. A level whose error is not a number is never chosen.
    double error = 0;                      ///< [object space units]
    uint32_t triangles = 0, vertices = 0;  ///< that drawing it takes
};

/// How many levels a chain may have.
inline constexpr uint32_t kMostLods = 16;

/// What drawing an object costs the renderer. The model of Funkhouser and Séquin: triangles and pixels are worked on at
/// the same time, and the slower of both counts.
struct DrawCost {
    double object = 0;  ///< of a draw call  [ns]
    double triangle = 0, vertex = 0;
    double pixel = 0;  ///< of a pixel that the object may cover  [ns]

    double of(const LodLevel& level, double pixels) const {
        const double shape = triangle * level.triangles + vertex * level.vertices;
        const double fill = pixel * pixels;
        return object + (shape > fill ? shape : fill);
    }
    bool known() const { return object > 0 || triangle > 0 || vertex > 0 || pixel > 0; }
};

/// The level to draw of an object, and how it is blended with the one that it replaces.
struct VisibleLod {
    uint8_t level = 0;  ///< 0: the finest
    uint8_t from = 0;   ///< the level that is faded out; `level`: none is
    float fade = 1;     ///< how much of `level` is in; `from` has the rest. See geom/dither.h
    /// For renderers that morph instead of fading: how far the vertices of `level` are on their way to the next coarser
    /// level. 1 where that level may be drawn as well, and 0 where `level` has just replaced a finer one.
    float morph = 0;
};

}  // namespace sightline
