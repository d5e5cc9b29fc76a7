// The same box test on an exact z-buffer: what an occlusion buffer without rounding or gaps would keep.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bench {
using namespace tools;

/// Draws all of a scene's triangles and tests its objects' boxes, as rectangles with their nearest depth.
class ExactBoxes {
public:
    explicit ExactBoxes(const Scene& scene);

    struct Answer {
        std::vector<uint8_t> kept;  ///< per object: not hidden by the z-buffer, whether inside the frustum or not
        std::vector<uint8_t> seen;  ///< per object: has a sample at `supersampling` per pixel and axis
    };
    /// The z-buffer has the size of the query's occlusion buffer for the view.
    Answer test(const View& view, uint32_t occlusion_size, uint32_t supersampling) const;

private:
    const Scene& scene_;
    std::vector<std::vector<uint8_t>> double_sided_, writes_depth_;  ///< per mesh and triangle
    std::vector<Box3d> boxes_;
};

}  // namespace sightline::bench
