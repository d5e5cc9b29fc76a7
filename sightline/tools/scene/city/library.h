// The city's stock: materials, and the meshes that its objects are instances of. It depends on the seed alone.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/scene/pieces.h"

namespace sightline::tools::city {

/// In the order of pieces.txt.
enum MaterialId : uint32_t {
    kAsphalt,
    kPaving,
    kLawnGreen,
    kSand,
    kRose,
    kBrick,
    kStone,
    kOchre,
    kGrey,
    kWhite,
    kShade,
    kTiles,
    kSlate,
    kGravel,
    kTrim,
    kGlass,
    kMetal,
    kWood,
    kBark,
    kLeaf,
    kDarkLeaf,
    kRed,
    kBlue,
    kSilver,
    kBlack,
    kRubber,
    kMesh,
    kBoard,
    kCloth,
    kCopper,
    kLight,
    kPaint,
    kMaterialCount
};

/// Furniture and ground, in the order of pieces.txt. The number is the mesh's index.
enum Item : uint32_t {
    kGroundLarge,
    kGroundSplit,
    kGroundSmall,
    kLawn,
    kCrossing,
    kPlaneTree,
    kLimeTree,
    kPoplar,
    kHedge,
    kLamp,
    kBench,
    kBin,
    kHydrant,
    kBollard,
    kFence,
    kSign,
    kKiosk,
    kShelter,
    kRedCar,
    kBlueCar,
    kSilverCar,
    kBlackCar,
    kPlanter,
    kAwning,
    kBicycleStand,
    kChimney,
    kTank,
    kCooler,
    kShed,
    kMonument,
    kItemCount
};

enum class Kind : uint8_t {
    kRow,     ///< stands between party walls; origin: foot of its front's middle; front to +z
    kTower,   ///< the same, tall
    kCorner,  ///< legs along -x and -z, fronts to +z and +x; origin: the street corner
    kIsland,  ///< fills a small block; origin: its middle
};

struct Building {
    uint32_t mesh = 0;
    Kind kind = Kind::kRow;
    int storeys = 0;
    double width = 0;  ///< of the front                              [metres]
    double roof = 0;   ///< height on which chimneys and tanks stand  [metres]
    bool pitched = false;
};

inline constexpr double kRowDepth = 13;    ///< of row and corner buildings  [metres]
inline constexpr double kCornerLeg = 18;   ///< of corner buildings          [metres]
inline constexpr double kIslandSize = 26;  ///< of island buildings          [metres]

/// Plan of the streets, in metres: blocks are squares from the middle of one street to the middle of the next.
inline constexpr int kLargeBlock = 104, kSmallBlock = 40;
inline constexpr double kKerb = 4;          ///< from the middle of the street to the pavement
inline constexpr double kFrontage = 7;      ///< from the middle of the street to the fronts
inline constexpr double kAlley = 8;         ///< from front to front of the lane through a split block
inline constexpr double kPavement = 0.125;  ///< height of the pavement

/// The materials by MaterialId, the meshes by Item and then the buildings.
struct Library : Pieces {
    std::vector<Building> buildings;
};

Library makeLibrary(uint64_t seed);

/// Adds the buildings' meshes in order.
void addBuildings(Library& library, Random random);

}  // namespace sightline::tools::city
