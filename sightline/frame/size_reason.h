// How an object's size and distance lie to the limits of the stages of distance and contribution.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline {

/// The limits are those of the settings, or the object's own, with hysteresis.
struct SizeReason {
    double distance = 0;        ///< to the nearest point of its box; in a parallel view its depth  [world units]
    double distance_limit = 0;  ///< infinity: there is none  [world units]
    double radius = 0;          ///< projected; infinity of what reaches the eye's plane  [viewport pixels]
    double radius_limit = 0;    ///< 0: there is none  [viewport pixels]
};

}  // namespace sightline
