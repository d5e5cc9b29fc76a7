// The stages of a query: their names, their order, and sets of them as bits.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sightline {

/// The stages of a query, coarse to fine. PVS and portals need a world with cells: World::attach(). Distance and
/// contribution are not conservative: they do nothing unless the settings say how far and how small. Volumes are
/// occluder volumes. The stage of levels of detail chooses one for each object that has some; it does nothing unless the
/// settings name an error or a budget, and culls only under a hard budget. Clusters are those of objects that have some.
/// Facing counts the objects that lie in the view and of which every face there is a single-sided one that looks away:
/// nothing of them is drawn. The second look finds them. Facing has no bit in QuerySettings::stages.
enum class Stage : uint8_t {
    kPvs,
    kPortals,
    kFrustum,
    kDistance,
    kContribution,
    kVolumes,
    kOcclusion,
    kLod,
    kClusters,
    kFacing
};
inline constexpr int kStageCount = 10;
inline constexpr const char* kStageNames[kStageCount] = {"pvs",     "portals",   "frustum", "distance", "contribution",
                                                         "volumes", "occlusion", "lod",     "clusters", "facing"};
inline constexpr uint32_t stageBit(Stage stage) { return 1u << static_cast<uint32_t>(stage); }
/// The order in which they decide on an object.
inline constexpr Stage kStageOrder[kStageCount] = {
    Stage::kPvs,     Stage::kPortals,   Stage::kFrustum, Stage::kDistance, Stage::kContribution,
    Stage::kVolumes, Stage::kOcclusion, Stage::kFacing,  Stage::kLod,      Stage::kClusters};
/// The stages that a caller may choose.
inline constexpr uint32_t kAllStages = ((1u << kStageCount) - 1) & ~stageBit(Stage::kFacing);
/// The stages that count objects where some are chosen: those, and facing where objects are asked by their triangles.
inline constexpr uint32_t countedStages(uint32_t chosen) {
    constexpr uint32_t kLooks = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
    return chosen | ((chosen & kLooks) == kLooks ? stageBit(Stage::kFacing) : 0);
}
/// The stages that need cells.
inline constexpr uint32_t kCellStages = stageBit(Stage::kPvs) | stageBit(Stage::kPortals);
/// The stages that cull what may be visible.
inline constexpr uint32_t kLossyStages =
    stageBit(Stage::kDistance) | stageBit(Stage::kContribution) | stageBit(Stage::kLod);
/// The stages that pay in most worlds.
inline constexpr uint32_t kDefaultStages = kAllStages & ~stageBit(Stage::kVolumes);

}  // namespace sightline
