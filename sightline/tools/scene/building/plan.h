// The plan of a procedural building: floors, rooms and the openings between them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline::tools::building {

enum class RoomKind : uint8_t {
    kOffice,
    kOpenOffice,
    kMeeting,
    kKitchen,
    kBathroom,
    kStore,
    kCorridor,
    kLobby,
    kStairs,
    kLift,
    kRoof,  ///< open above
};

enum class OpeningKind : uint8_t {
    kDoor,
    kFireDoor,   ///< across a corridor
    kLiftDoor,   ///< slides
    kGlassDoor,  ///< one sees through it when it is shut
    kPassage,    ///< without a leaf
    kWindow,
    kSmallWindow,
    kStairWindow,
};

enum class LeafState : uint8_t { kShut, kHalfOpen, kOpen };

/// A rectangle in the plan, (x, z).
struct Rect {
    glm::dvec2 min{0}, max{0};
};

struct Room {
    RoomKind kind = RoomKind::kOffice;
    std::string name;  ///< "Office 3.07"
    Box3d box;         ///< the air in it; of a shaft: up to the next floor's level
};

inline constexpr uint32_t kOutside = ~0u;

/// A box of air through a wall.
struct Opening {
    OpeningKind kind = OpeningKind::kDoor;
    LeafState state = LeafState::kShut;
    bool hinge_high = false;  ///< the leaf hangs at the end of larger x or z
    uint32_t room = 0;        ///< on whose face the leaf hangs: index into Floor::rooms
    uint32_t other = 0;       ///< behind the wall; kOutside: none
    int quarter = 0;          ///< from `room` to `other`: quarter turns from +z towards +x
    Box3d hole;
    std::string name;  ///< "Office 3.07 door 1"
};

struct Floor {
    int number = 0;
    std::string name;    ///< "Floor 3"
    double level = 0;    ///< of the floor's surface              [metres]
    double ceiling = 0;  ///< of the ceiling; of the roof: the parapet's top
    std::vector<Room> rooms;
    std::vector<Opening> openings;
};

/// All coordinates are multiples of 1/64 m, so that sums of them are exact.
struct Plan {
    Rect footprint;             ///< to the outer faces of the walls; its middle is the origin
    Rect plot;                  ///< the ground around it
    double air = 0;             ///< height of the air above the plot that cells cover
    std::vector<Floor> floors;  ///< from the ground up; the last is the roof
};

inline constexpr double kStorey = 3.25;                         ///< from level to level                     [metres]
inline constexpr double kSlab = 0.25;                           ///< thickness of floors
inline constexpr double kOuterWall = 0.375;                     ///< thickness of the outer walls
inline constexpr double kCorridorWall = 0.1875;                 ///< thickness of the walls along the corridor
inline constexpr double kInnerWall = 0.125;                     ///< thickness of walls between rooms
inline constexpr double kParapet = 0.9375;                      ///< height over the roof
inline constexpr double kPlotMargin = 12;                       ///< of the plot around the building
inline constexpr double kStairWidth = 2.75, kCoreDepth = 5.75;  ///< the stairs' room, x and z
inline constexpr double kLiftWidth = 2.0, kLiftDepth = 2.25;
inline constexpr double kDoorWidth = 0.9375, kDoorHeight = 2.0625;
inline constexpr double kFireDoorWidth = 1.25, kLiftDoorWidth = 1.0, kGlassDoorWidth = 1.875;
inline constexpr glm::dvec2 kWindowSize{1.375, 1.5}, kSmallWindowSize{0.75, 0.75}, kStairWindowSize{1.375, 0.875};

/// Deterministic in (seed, floors); a floor does not depend on how many lie above it.
/// @param floors  [limit: 1 to 200]
Plan makePlan(uint64_t seed, uint32_t floors);

/// The middle of a hole in the plan, and its width along the wall.
glm::dvec2 middleOf(const Opening& opening);
double widthOf(const Opening& opening);

}  // namespace sightline::tools::building
