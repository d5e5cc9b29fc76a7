// A frame drawn to show why one object is kept or culled: its box, its occluders, and the rest pale.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// What stands out, as indices into Scene::objects.
struct Emphasis {
    uint32_t object = 0;                  ///< in blue where it is seen; its box in outline, through everything;
                                          ///< or an arrow at the border towards a box beyond it
    std::span<const uint32_t> occluders;  ///< in orange
    std::span<const std::vector<glm::dvec3>> outlines;  ///< of parts whose shadows hide the object, through everything
    bool has_pixel = false;  ///< a place to mark with a ring  [viewport pixels from the left and the top]
    double x = 0, y = 0;
};

/// Four samples a pixel, by the reference z-buffer; the top row first.
Image<Rgb> explainPicture(const Scene& scene, const View& view, const Emphasis& emphasis);

}  // namespace sightline::tools
