// What a procedural building is furnished with: materials, and the meshes that its objects are instances of.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/tools/scene/pieces.h"

namespace sightline::tools::building {

/// In the order of pieces.txt.
enum MaterialId : uint32_t {
    kGravel,
    kStone,
    kConcrete,
    kRender,
    kWhite,
    kCream,
    kTile,
    kDarkTile,
    kTerrazzo,
    kLinoleum,
    kCarpet,
    kParquet,
    kGlass,
    kFrameGrey,
    kDoorWood,
    kOak,
    kBeech,
    kSteel,
    kChrome,
    kBlackPlastic,
    kGreyPlastic,
    kScreenBlack,
    kFabricBlue,
    kFabricRed,
    kFabricGrey,
    kCeramic,
    kPaper,
    kCardboard,
    kBookRed,
    kBookGreen,
    kBookBlue,
    kBookYellow,
    kLeaf,
    kSoil,
    kTerracotta,
    kLampShade,
    kMirror,
    kSignGreen,
    kSignalRed,
    kPanelBlue,
    kBark,
    kGrass,
    kMaterialCount
};

/// In the order of pieces.txt. All stand on y = 0 with their front to +z and their middle over the origin, unless said otherwise.
enum Item : uint32_t {
    kDesk,
    kOfficeChair,
    kMonitor,
    kKeyboard,
    kDeskLamp,
    kDrawers,
    kPaperBin,
    kPapers,
    kPhone,
    kBookShelf,
    kLowShelf,
    kPottedPlant,
    kTallPlant,
    kWhiteboard,  ///< back at z = 0
    kWallScreen,  ///< back at z = 0
    kPicture,     ///< back at z = 0
    kCoatStand,
    kMeetingTable,
    kVisitorChair,
    kCounter,
    kSinkCounter,
    kStove,
    kWallCupboard,  ///< back at z = 0
    kFridge,
    kRoundTable,
    kCoffeeMachine,
    kMug,
    kToilet,
    kWashbasin,
    kMirrorPane,  ///< back at z = 0
    kCubicle,
    kHandDryer,  ///< back at z = 0
    kMetalShelf,
    kBoxes,
    kLadder,
    kTrolley,
    kReception,
    kSofa,
    kLowTable,
    kCopier,
    kBench,
    kExtinguisher,
    kExitSign,      ///< hangs from y = 0
    kCeilingLight,  ///< hangs from y = 0
    kRadiator,
    kSwitch,    ///< back at z = 0
    kColumn,    ///< as tall as a room
    kDoorLeaf,  ///< x from the hinge, z = 0 the wall's face on the side that it opens to
    kFireLeaf,
    kGlassLeaf,
    kLiftLeaf,
    kDoorFrame,  ///< as the leaf, for a wall along a corridor
    kThinDoorFrame,
    kFireFrame,
    kWindow,  ///< middle of the pane
    kSmallWindow,
    kStairWindow,
    kFlight,       ///< from (0, 0) up towards -z; x from 0 to its width
    kFlightRail,   ///< of a flight
    kLanding,      ///< y = 0 its surface; the room's corner of least x and largest z
    kHalfLanding,  ///< y = 0 its surface; the room's corner of least x and z
    kLandingRail,
    kLiftCab,
    kCounterweight,
    kLiftRail,
    kCooler,
    kVent,
    kSolarPanel,
    kTree,
    kHedge,
    kLampPost,
    kItemCount
};

inline constexpr double kLandingDepth = 1.5;     ///< of the stairs' landings, from the door   [metres]
inline constexpr double kFlightWidth = 1.28125;  ///< two of them, with a gap
inline constexpr double kFlightRun = 2.8125;     ///< length of a flight in the plan
inline constexpr int kFlightSteps = 10;          ///< of half a storey

/// The materials by MaterialId, and the meshes by Item.
Pieces makeLibrary();

/// The parts of makeLibrary that code makes: shapes for pieces that the table has by name alone.
using Shelf = std::vector<Mesh>;
void addFurniture(Shelf& meshes);  ///< shelves with their books, and plants
void addFittings(Shelf& meshes);   ///< what the plan's measures make: leaves, frames, windows, stairs, rails

}  // namespace sightline::tools::building
