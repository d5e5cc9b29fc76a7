// What a query says of one object, in one word.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sightline {

/// What a query says of one object.
enum class Verdict : uint8_t {
    kNoSuchObject,    ///< the id is null or stale, or the snapshot is empty
    kOutsideLayers,   ///< View::layers leaves it out
    kVisible,         ///< it is in the answer
    kOutsideFrustum,  ///< culled by the frustum stage
    kOccluded,        ///< culled by the occlusion stage, or by the stage of volumes
    kTooFar,          ///< culled by the stage of distance, although it may be visible
    kTooSmall,        ///< culled by the stage of contribution, although it may be visible
    kNoCluster,       ///< culled by the stage of clusters: none of its clusters is left
    kNoTime,          ///< left out by the stage of levels of detail under a hard budget, although it may be visible
    kNotInPvs,  ///< culled by the stage of the PVS: not seen from the eye's view cells, or no cell that it stands in from its cells
    kNoWindow,   ///< culled by the stage of portals: it lies in no window into a cell that it stands in
    kFacesAway,  ///< Stage::kFacing: each of its faces that lies in the view is single-sided, and looks away
};

}  // namespace sightline
