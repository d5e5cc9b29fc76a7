// The colours of what the viewer draws, and what they mean.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <iterator>

#include <glm/glm.hpp>

#include "sightline/geom/stage.h"

namespace sightline::viewer {

inline constexpr glm::vec3 kBackground(0.10f, 0.115f, 0.14f);
/// The chosen object, and who hides it.
inline constexpr glm::vec3 kChosen(0.15f, 0.55f, 1.0f), kHider(1.0f, 0.55f, 0.1f);
/// What may darken what is visible, and is not visible itself.
inline constexpr glm::vec3 kCaster(0.75f, 0.45f, 1.0f);
/// What is visible, where the answer gives the colour; and its bounds.
inline constexpr glm::vec3 kVisible(0.35f, 0.65f, 0.4f), kBounds(0.45f, 0.8f, 0.5f);
/// The frozen camera's, and the boxes of a level of the hierarchy.
inline constexpr glm::vec3 kFrustum(1.0f, 0.95f, 0.6f), kTreeBox(0.7f, 0.7f, 1.0f);
/// Portals: those looked through, those of doors, and all others; the face of a shut one, and the one pointed at.
inline constexpr glm::vec3 kSeenThrough(1.0f, 1.0f, 0.5f), kDoor(1.0f, 0.6f, 0.9f), kPortal(0.3f, 0.9f, 0.9f);
inline constexpr glm::vec3 kShut(0.38f, 0.30f, 0.24f), kAtDoor(1.0f, 0.2f, 1.0f);
/// The cell of the camera, and those seen from there.
inline constexpr glm::vec3 kEyeCell(1.0f, 1.0f, 1.0f), kSeenCell(0.25f, 0.6f, 0.5f);

/// What a stage culled.
inline glm::vec3 stageColour(int stage) {
    constexpr glm::vec3 kColours[kStageCount] = {{0.34f, 0.70f, 0.91f}, {0.00f, 0.62f, 0.45f}, {0.55f, 0.57f, 0.60f},
                                                 {0.94f, 0.89f, 0.26f}, {0.80f, 0.47f, 0.65f}, {0.84f, 0.37f, 0.00f},
                                                 {0.90f, 0.20f, 0.20f}, {0.60f, 0.40f, 0.80f}, {0.70f, 0.70f, 0.30f},
                                                 {0.75f, 0.65f, 0.55f}};
    return kColours[stage];
}

/// The levels of detail that have colours of their own; the coarser ones have the last one's.
inline constexpr glm::vec3 kLevelColours[] = {
    {0.35f, 0.55f, 0.85f}, {0.30f, 0.75f, 0.45f}, {0.90f, 0.80f, 0.25f}, {0.95f, 0.55f, 0.20f}, {0.85f, 0.25f, 0.20f}};
inline glm::vec3 levelColour(uint8_t level) {
    return kLevelColours[level < std::size(kLevelColours) ? level : std::size(kLevelColours) - 1];
}

}  // namespace sightline::viewer
