// The plan of a procedural building: floors, rooms and the openings between them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/building/plan.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sightline/base/random.h"

namespace sightline::tools::building {
namespace {

constexpr double kCorridor = 2.25;      // width of the corridor                          [metres]
constexpr double kDoorMargin = 0.3125;  // from a room's corner to its door
constexpr double kLeastRoom = 2;        // no room is narrower

double snap(double x) { return std::nearbyint(x * 64) / 64; }

/// What all floors share.
struct FloorFrame {
    uint64_t seed = 0;
    Rect inside;                               ///< of the outer walls
    double north = 0, south = 0;               ///< the corridor's faces, z
    double stair = 0, lift = 0, core_end = 0;  ///< where the shafts begin, x, and where the rooms behind them do
};

/// Makes one floor.
class FloorPlanner {
public:
    FloorPlanner(const FloorFrame& frame, Floor& floor)
        : frame_(frame), floor_(floor), random_(mixSeed(frame.seed, 1000 + static_cast<uint64_t>(floor.number))) {}

    void plan(bool top) {
        addShafts(top);
        wishes_ = {RoomKind::kKitchen, RoomKind::kMeeting, RoomKind::kStore, RoomKind::kOpenOffice};
        const Rect& in = frame_.inside;
        fillBand(in.min.x, frame_.stair - kInnerWall, true, {});
        fillBand(frame_.core_end, in.max.x, true, {RoomKind::kBathroom, RoomKind::kBathroom});
        if (floor_.number == 0) {
            const double half = 4.75;
            fillBand(in.min.x, -half - kInnerWall, false, {});
            addRoom(RoomKind::kLobby, {-half, frame_.south + kCorridorWall}, {half, in.max.y});
            fillBand(half + kInnerWall, in.max.x, false, {});
        } else {
            fillBand(in.min.x, in.max.x, false, {});
        }
        addCorridor();
        addDoors();
        addConnections();
        addWindows();
        nameOpenings();
    }

private:
    double pick(double low, double high) { return snap(random_.uniform(low, high)); }

    uint32_t addRoom(RoomKind kind, const glm::dvec2& min, const glm::dvec2& max, double top = 0) {
        static constexpr const char* kNames[] = {"Office",   "Open office", "Meeting room", "Kitchen",
                                                 "Bathroom", "Store",       "Corridor",     "Lobby",
                                                 "Stairs",   "Lift",        "Roof"};
        Room room;
        room.kind = kind;
        const char* const name = kNames[static_cast<size_t>(kind)];
        const auto same = std::count_if(floor_.rooms.begin(), floor_.rooms.end(),
                                        [&](const Room& other) { return other.kind == kind; });
        switch (kind) {
            case RoomKind::kLobby:
            case RoomKind::kStairs:
            case RoomKind::kLift:
                room.name = fmt::format("{} {}", name, floor_.number);
                break;
            case RoomKind::kCorridor:
                room.name = fmt::format("{} {}.{}", name, floor_.number, same + 1);
                break;
            case RoomKind::kRoof:
                room.name = "Terrace";
                break;
            default:
                room.name = fmt::format("{} {}.{:02}", name, floor_.number, ++numbered_);
        }
        room.box.min = {min.x, floor_.level, min.y};
        room.box.max = {max.x, top > 0 ? top : floor_.ceiling, max.y};
        floor_.rooms.push_back(room);
        return static_cast<uint32_t>(floor_.rooms.size() - 1);
    }

    void addShafts(bool top) {
        const double up = top ? 0 : floor_.level + kStorey;
        const double front = frame_.north - kCorridorWall;
        addRoom(RoomKind::kStairs, {frame_.stair, front - kCoreDepth}, {frame_.stair + kStairWidth, front}, up);
        addRoom(RoomKind::kLift, {frame_.lift, front - kLiftDepth}, {frame_.lift + kLiftWidth, front}, up);
    }

    RoomKind nextKind() {
        if (!wishes_.empty() && random_.below(3) == 0) {
            const size_t which = random_.below(wishes_.size());
            const RoomKind kind = wishes_[which];
            wishes_.erase(wishes_.begin() + static_cast<std::ptrdiff_t>(which));
            return kind;
        }
        const uint64_t roll = random_.below(20);
        return roll < 13 ? RoomKind::kOffice : roll < 17 ? RoomKind::kOpenOffice : RoomKind::kMeeting;
    }

    double widthFor(RoomKind kind) {
        switch (kind) {
            case RoomKind::kOpenOffice:
                return pick(7, 11);
            case RoomKind::kMeeting:
                return pick(4.5, 6.5);
            case RoomKind::kKitchen:
                return pick(4, 5.5);
            case RoomKind::kBathroom:
                return 2.875;
            case RoomKind::kStore:
                return pick(2, 3);
            default:
                return pick(3, 4.75);
        }
    }

    /// Rooms wall to wall from x = low to high, on one side of the corridor.
    void fillBand(double low, double high, bool north, std::vector<RoomKind> first) {
        const double z0 = north ? frame_.inside.min.y : frame_.south + kCorridorWall;
        const double z1 = north ? frame_.north - kCorridorWall : frame_.inside.max.y;
        size_t done = 0;
        for (double x = low; x < high;) {
            const RoomKind kind = done < first.size() ? first[done] : nextKind();
            ++done;
            double end = x + widthFor(kind);
            if (high - end < kLeastRoom + kInnerWall) end = high;
            addRoom(kind, {x, z0}, {end, z1});
            x = end + kInnerWall;
        }
    }

    static bool behindCorridor(const Room& room) {
        return room.kind != RoomKind::kCorridor && room.kind != RoomKind::kRoof;
    }

    /// A box through the wall at z (or x) from `from` to `to`.
    void addOpening(OpeningKind kind, uint32_t room, uint32_t other, int quarter, double along, double width,
                    double from, double to, double foot, double height) {
        Opening opening;
        opening.kind = kind;
        opening.room = room;
        opening.other = other;
        opening.quarter = quarter;
        const bool across_z = quarter % 2 == 0;
        opening.hole.min =
            across_z ? glm::dvec3(along, floor_.level + foot, from) : glm::dvec3(from, floor_.level + foot, along);
        opening.hole.max = across_z ? glm::dvec3(along + width, floor_.level + foot + height, to)
                                    : glm::dvec3(to, floor_.level + foot + height, along + width);
        floor_.openings.push_back(opening);
    }

    void setLeaf(Opening& opening, bool hinge_high) {
        const uint64_t roll = random_.below(10);
        opening.state = roll < 5 ? LeafState::kShut : roll < 7 ? LeafState::kHalfOpen : LeafState::kOpen;
        opening.hinge_high = hinge_high;
    }

    /// Where each room's door starts, then the fire doors between them, then the pieces of the corridor.
    void addCorridor() {
        starts_.assign(floor_.rooms.size(), 0);
        for (size_t i = 0; i < floor_.rooms.size(); ++i) {
            const Room& room = floor_.rooms[i];
            high_.push_back(random_.below(2) == 1);
            const double width = room.kind == RoomKind::kLift ? kLiftDoorWidth : kDoorWidth;
            starts_[i] = high_[i] ? room.box.max.x - kDoorMargin - width : room.box.min.x + kDoorMargin;
            if (room.kind == RoomKind::kLift) starts_[i] = room.box.min.x + 0.5 * (kLiftWidth - width);
            if (room.kind == RoomKind::kStairs) starts_[i] = room.box.min.x + kDoorMargin;
        }
        high_[0] = false;
        const Rect& in = frame_.inside;
        double x = in.min.x;
        const double length = in.max.x - in.min.x;
        for (int cut = 1; cut <= 3; ++cut) {
            double end = in.max.x;
            if (cut < 3) end = clearPlace(in.min.x + cut * length / 3);
            addRoom(RoomKind::kCorridor, {x, frame_.north}, {end, frame_.south});
            if (cut == 3) break;
            const auto piece = static_cast<uint32_t>(floor_.rooms.size() - 1);
            const double along = snap(0.5 * (frame_.north + frame_.south - kFireDoorWidth));
            addOpening(OpeningKind::kFireDoor, piece, piece + 1, 1, along, kFireDoorWidth, end, end + kInnerWall, 0,
                       kDoorHeight);
            setLeaf(floor_.openings.back(), random_.below(2) == 1);
            x = end + kInnerWall;
        }
    }

    /// Near x, clear of all doors: a wall across the corridor goes there.
    double clearPlace(double near) const {
        for (int step = 0;; ++step) {
            const double x = snap(near + (step % 2 ? 0.125 : -0.125) * (step / 2));
            bool clear = true;
            for (size_t i = 0; i < starts_.size(); ++i) {
                const Room& room = floor_.rooms[i];
                const bool lobby = room.kind == RoomKind::kLobby;
                const double from = lobby ? room.box.min.x : starts_[i];
                const double to = lobby ? room.box.max.x : starts_[i] + kLiftDoorWidth;
                clear = clear && (x + kInnerWall < from - 0.25 || x > to + 0.25);
            }
            if (clear) return x;
        }
    }

    uint32_t corridorAt(double x) const {
        for (size_t i = 0; i < floor_.rooms.size(); ++i) {
            const Room& room = floor_.rooms[i];
            if (room.kind == RoomKind::kCorridor && room.box.min.x < x && x < room.box.max.x)
                return static_cast<uint32_t>(i);
        }
        return 0;
    }

    void addDoors() {
        const auto count = static_cast<uint32_t>(starts_.size());
        for (uint32_t i = 0; i < count; ++i) {
            const Room room = floor_.rooms[i];
            const bool north = room.box.max.z < frame_.south;
            const double from = north ? room.box.max.z : frame_.south;
            const double to = from + kCorridorWall;
            const int quarter = north ? 0 : 2;
            const uint32_t corridor = corridorAt(starts_[i] + 0.25);
            if (room.kind == RoomKind::kLobby) {
                for (const double x : {room.box.min.x + 1.5, room.box.max.x - 1.5 - kGlassDoorWidth})
                    addOpening(OpeningKind::kPassage, i, corridorAt(x), quarter, x, kGlassDoorWidth, from, to, 0, 2.5);
                addOpening(OpeningKind::kGlassDoor, i, kOutside, 0, -0.5 * kGlassDoorWidth, kGlassDoorWidth,
                           room.box.max.z, room.box.max.z + kOuterWall, 0, kDoorHeight);
                continue;
            }
            const bool lift = room.kind == RoomKind::kLift;
            addOpening(lift ? OpeningKind::kLiftDoor : OpeningKind::kDoor, i, corridor, quarter, starts_[i],
                       lift ? kLiftDoorWidth : kDoorWidth, from, to, 0, kDoorHeight);
            if (!lift) setLeaf(floor_.openings.back(), high_[i]);
        }
    }

    static bool isWorkplace(RoomKind kind) {
        return kind == RoomKind::kOffice || kind == RoomKind::kOpenOffice || kind == RoomKind::kMeeting;
    }

    /// Doors between neighbours.
    void addConnections() {
        const auto count = static_cast<uint32_t>(starts_.size());
        for (uint32_t i = 0; i + 1 < count; ++i) {
            const Room a = floor_.rooms[i], b = floor_.rooms[i + 1];
            if (!isWorkplace(a.kind) || !isWorkplace(b.kind) || b.box.min.x != a.box.max.x + kInnerWall) continue;
            if (a.box.min.z != b.box.min.z || random_.below(3) != 0) continue;
            const double along = pick(a.box.min.z + 1.75, a.box.max.z - 1.75 - kDoorWidth);
            addOpening(OpeningKind::kDoor, i, i + 1, 1, along, kDoorWidth, a.box.max.x, b.box.min.x, 0, kDoorHeight);
            setLeaf(floor_.openings.back(), random_.below(2) == 1);
        }
    }

    /// As many windows as fit in a room's outer wall.
    void windowsAlong(uint32_t index, int quarter) {
        const Room room = floor_.rooms[index];
        const bool across_z = quarter % 2 == 0;
        OpeningKind kind = OpeningKind::kWindow;
        glm::dvec2 size = kWindowSize;
        double sill = 0.875;
        if (room.kind == RoomKind::kBathroom || room.kind == RoomKind::kStore) {
            kind = OpeningKind::kSmallWindow;
            size = kSmallWindowSize;
            sill = 1.625;
        } else if (room.kind == RoomKind::kStairs) {
            kind = OpeningKind::kStairWindow;
            size = kStairWindowSize;
            sill = 2;
        }
        const int along_axis = across_z ? 0 : 2, axis = 2 - along_axis;
        const double low = room.box.min[along_axis], length = room.box.max[along_axis] - low;
        const int count = std::max(1, static_cast<int>((length - 0.375) / (size.x + 0.375)));
        const double wall = quarter < 2 ? room.box.max[axis] : room.box.min[axis] - kOuterWall;
        for (int i = 0; i < count; ++i) {
            const double along = low + snap((i + 0.5) * length / count - 0.5 * size.x);
            const bool entrance = room.kind == RoomKind::kLobby && quarter == 0 && along < kGlassDoorWidth &&
                                  along + size.x > -kGlassDoorWidth;
            if (!entrance)
                addOpening(kind, index, kOutside, quarter, along, size.x, wall, wall + kOuterWall, sill, size.y);
        }
    }

    void addWindows() {
        for (uint32_t i = 0; i < floor_.rooms.size(); ++i) {
            const Room room = floor_.rooms[i];
            if (room.kind == RoomKind::kLift) continue;
            if (room.box.max.z == frame_.inside.max.y) windowsAlong(i, 0);
            if (room.box.max.x == frame_.inside.max.x) windowsAlong(i, 1);
            if (room.box.min.z == frame_.inside.min.y) windowsAlong(i, 2);
            if (room.box.min.x == frame_.inside.min.x) windowsAlong(i, 3);
        }
    }

    void nameOpenings() {
        std::vector<int> doors(floor_.rooms.size()), windows(floor_.rooms.size());
        for (Opening& opening : floor_.openings) {
            const bool window = opening.kind >= OpeningKind::kWindow;
            int& count = (window ? windows : doors)[opening.room];
            opening.name =
                fmt::format("{} {} {}", floor_.rooms[opening.room].name, window ? "window" : "door", ++count);
        }
    }

    const FloorFrame& frame_;
    Floor& floor_;
    Random random_;
    std::vector<RoomKind> wishes_;  ///< kinds that the floor still lacks
    std::vector<double> starts_;    ///< of each room's door along the corridor
    std::vector<bool> high_;        ///< its door is at its end of larger x
    int numbered_ = 0;
};

}  // namespace

Plan makePlan(uint64_t seed, uint32_t floors) {
    Random random(mixSeed(seed, 0x706c616eull));
    const double width = 36 + 1.5 * static_cast<double>(random.below(9));
    const double south = 5.25 + 0.25 * static_cast<double>(random.below(5));
    const double depth = 2 * kOuterWall + 2 * kCorridorWall + kCoreDepth + kCorridor + south;
    Plan plan;
    plan.footprint = {{-0.5 * width, -0.5 * depth}, {0.5 * width, 0.5 * depth}};
    plan.plot = {plan.footprint.min - kPlotMargin, plan.footprint.max + kPlotMargin};
    FloorFrame frame;
    frame.seed = seed;
    frame.inside = {plan.footprint.min + kOuterWall, plan.footprint.max - kOuterWall};
    frame.north = frame.inside.min.y + kCoreDepth + kCorridorWall;
    frame.south = frame.north + kCorridor;
    frame.stair = snap(random.uniform(-7, -3));
    frame.lift = frame.stair + kStairWidth + 2 * kInnerWall;
    frame.core_end = frame.lift + kLiftWidth + 2 * kInnerWall;
    for (uint32_t i = 0; i < floors; ++i) {
        Floor& floor = plan.floors.emplace_back();
        floor.number = static_cast<int>(i);
        floor.name = fmt::format("Floor {}", i);
        floor.level = kStorey * i;
        floor.ceiling = floor.level + kStorey - kSlab;
        FloorPlanner(frame, floor).plan(i + 1 == floors);
    }
    Floor& roof = plan.floors.emplace_back();
    roof.number = static_cast<int>(floors);
    roof.name = "Roof";
    roof.level = kStorey * floors;
    roof.ceiling = roof.level + kParapet;
    Room terrace;
    terrace.kind = RoomKind::kRoof;
    terrace.name = "Terrace";
    terrace.box.min = {frame.inside.min.x, roof.level, frame.inside.min.y};
    terrace.box.max = {frame.inside.max.x, roof.ceiling, frame.inside.max.y};
    roof.rooms.push_back(terrace);
    plan.air = roof.ceiling + kPlotMargin;
    return plan;
}

glm::dvec2 middleOf(const Opening& opening) {
    const glm::dvec3 middle = opening.hole.center();
    return {middle.x, middle.z};
}

double widthOf(const Opening& opening) { return opening.hole.size()[opening.quarter % 2 == 0 ? 0 : 2]; }

}  // namespace sightline::tools::building
