// A plain z-buffer renderer: the slow, obvious reference for images, ids and depth complexity.
// SPDX-License-Identifier: MIT
//
// Edwin Catmull. A Subdivision Algorithm for Computer Display of Curved Surfaces. 1974.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/mesh_view.h"
#include "sightline/geom/view.h"

namespace sightline {

/// One mesh to draw. Single-sided back faces are not drawn.
struct DrawItem {
    MeshView mesh;
    std::span<const uint8_t> double_sided;  ///< per triangle [size: triangles, or empty for none]
    std::span<const uint8_t> writes_depth;  ///< per triangle: 0 is seen but hides nothing, as blended ones
                                            ///< [size: triangles, or empty for all]
    glm::dmat4 transform{1.0};              ///< object to world
    uint32_t id = 0;
};

/// What a z-buffer pass leaves at each sample. Row 0 is the bottom row.
struct ZBufferImage {
    static constexpr uint32_t kNone = ~0u;
    uint32_t width = 0, height = 0;      ///< [samples]
    std::vector<uint32_t> id;            ///< nearest opaque surface's DrawItem::id, or kNone
    std::vector<double> depth;           ///< nearness: 1/w (perspective), -eye-space depth (orthographic);
                                         ///< larger is nearer; -infinity where nothing was drawn
    std::vector<uint16_t> generated;     ///< fragments generated per sample (depth complexity), saturating
    std::vector<uint8_t> seen;           ///< per id: 1 if any sample shows it, non-depth-writing ones included
                                         ///< [size: largest id + 1]
};

struct ZBufferSettings {
    uint32_t samples = 1;              ///< per pixel and axis: 4 gives 4x4 ordered supersampling
    glm::dvec2 offset{0.0};            ///< shift of the sample grid [pixels]
};

/// Draws the items in the order given. Samples lie at the centres of a regular grid; a sample exactly on
/// a shared edge belongs to one triangle (top-left rule). Clips in homogeneous space at the near plane
/// and, if finite, the far plane. All arithmetic in double, written apart from everything that culls.
ZBufferImage renderZBuffer(std::span<const DrawItem> items, const View& view,
                           const ZBufferSettings& settings = {});

}  // namespace sightline
