// A plan: the world from above, each object in the colour of what culled it, and the camera's frustum.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/report/png.h"

namespace sightline {

/// Where a plan lies in the world. x runs to the right, z downward.
struct PlanArea {
    double x = 0, z = 0;  ///< the upper left corner
    double side = 1;      ///< of the square [world units]
};

/// A square around everything that was visible in any of the frames, and the eyes, with some air.
PlanArea planArea(std::span<const Box3d> bounds, std::span<const std::span<const uint8_t>> reasons,
                  std::span<const View> views);

/// Colours of the plan: visible, then one per stage.
inline constexpr int kPlanColours = 1 + kStageCount;
extern const glm::u8vec4 kPlanPalette[kPlanColours];
inline constexpr const char* kPlanNames[kPlanColours] = {"visible", "culled by frustum", "culled by occlusion"};

/// Draws the boxes of the objects, larger ones below smaller ones, flat ones pale; transparent where
/// there is nothing.
/// @param reasons  per object: 0 visible, else 1 + Stage  [size: bounds]
Image<glm::u8vec4> drawPlan(std::span<const Box3d> bounds, std::span<const uint8_t> reasons, const View& view,
                            const PlanArea& area, uint32_t side_pixels);

}  // namespace sightline
