// What stands on a procedural terrain: materials, and the meshes of trees, rocks, houses and fences.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/scene/scene.h"

namespace sightline::terrain {

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

/// All stand on y = 0 with their front to +z, and reach below it to where sloping ground may be.
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

struct Library {
    std::vector<Material> materials;  ///< by MaterialId
    std::vector<Mesh> meshes;         ///< by Item
};

Library makeLibrary();

}  // namespace sightline::terrain
