// What stands on a procedural terrain: materials, and the meshes of trees, rocks, houses and fences.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/tools/scene/pieces.h"

namespace sightline::tools::terrain {

/// In the order of pieces.txt.
enum MaterialId : uint32_t {
    kGrass,
    kEarth,
    kScree,
    kSnow,
    kSand,
    kWater,
    kBark,
    kBirchBark,
    kNeedles,
    kLeaf,
    kPaleLeaf,
    kRock,
    kPlaster,
    kTimber,
    kRoofTiles,
    kBoards,
    kPane,
    kMaterialCount
};

/// In the order of pieces.txt. All stand on y = 0 with their front to +z, and reach below it to where sloping ground may be.
enum Item : uint32_t {
    kSpruce,
    kPine,
    kOak,
    kBirch,
    kBush,
    kBoulder,
    kSlabRock,
    kStones,
    kHouse,
    kBarn,
    kHut,
    kFence,  ///< from (0, 0) to (4, 0) along x
    kWell,
    kItemCount
};

inline constexpr double kFenceLength = 4;  ///< [metres]

/// The materials by MaterialId, and the meshes by Item.
Pieces makeLibrary();

}  // namespace sightline::tools::terrain
