// Where a depth format cannot tell the two nearest surfaces apart, so that the order of drawing decides.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/project/projector.h"
#include "sightline/studies/hidden/zbuffer/depth_format.h"

namespace sightline::studies {

/// What becomes of the two nearest surfaces at a sample.
enum class Fight : uint8_t {
    kNone,      ///< they have different depths, or there are not two
    kFormat,    ///< they have the same depth in the format, though they lie apart
    kCoplanar,  ///< they lie at the same place, up to rounding in double: no format tells them apart
};

/// Row 0 is the bottom row.
struct ZFightingMap {
    /// Relative difference in nearness up to which two surfaces are taken to lie at the same place.
    static constexpr double kCoplanarBand = 1e-13;

    uint32_t width = 0, height = 0;
    std::vector<Fight> fights;  ///< [size: width * height]
    std::vector<float>
        gap_in_steps;       ///< the gap between the two nearest over DepthCodec::stepAt() there: below 1, chance
                            ///< decides; infinity where there are not two  [size: width * height]
    uint64_t overlaid = 0;  ///< samples with two surfaces or more
    uint64_t fighting = 0;  ///< of them, kFormat
    uint64_t coplanar = 0;  ///< of them, kCoplanar
};

/// Tries all polygons at all samples, in double. O(fragments); 40 bytes a sample.
ZFightingMap findZFighting(const DrawList& list, const View& view, DepthFormat format,
                           const ProjectorSettings& projector = {});

}  // namespace sightline::studies
