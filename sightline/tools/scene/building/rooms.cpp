// Furnishes the rooms of a procedural building.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/building/rooms.h"

#include <algorithm>
#include <cmath>

namespace sightline::tools::building {
namespace {

constexpr double kDeskTop = 0.734375, kWorktop = 0.90625;  // heights  [metres]

bool overlap(const Rect& a, const Rect& b) {
    return a.min.x < b.max.x && b.min.x < a.max.x && a.min.y < b.max.y && b.min.y < a.max.y;
}

/// A place in front of a wall: things there look away from it.
struct Spot {
    glm::dvec2 at{0};
    int quarter = 0;  ///< away from the wall

    glm::dvec2 point(double x, double z) const { return at + directionOf(quarter + 1) * x + directionOf(quarter) * z; }
};

class RoomFurnisher {
public:
    RoomFurnisher(const Floor& floor, uint32_t index, Random random, Placer& placer)
        : room_(floor.rooms[index]), random_(random), placer_(placer), level_(floor.level), ceiling_(floor.ceiling) {
        area_ = {{room_.box.min.x, room_.box.min.z}, {room_.box.max.x, room_.box.max.z}};
        for (const Opening& opening : floor.openings)
            if (opening.room == index || opening.other == index) keepClear(opening, opening.room == index);
    }

    void furnish() {
        switch (room_.kind) {
            case RoomKind::kOffice:
                furnishOffice();
                break;
            case RoomKind::kOpenOffice:
                furnishOpenOffice();
                break;
            case RoomKind::kMeeting:
                furnishMeeting();
                break;
            case RoomKind::kKitchen:
                furnishKitchen();
                break;
            case RoomKind::kBathroom:
                furnishBathroom();
                break;
            case RoomKind::kStore:
                furnishStore();
                break;
            case RoomKind::kCorridor:
                furnishCorridor();
                break;
            case RoomKind::kLobby:
                furnishLobby();
                break;
            default:
                return;
        }
        hangLights();
    }

private:
    double lengthOf(int wall) const {
        const glm::dvec2 size = area_.max - area_.min;
        return wall % 2 == 0 ? size.x : size.y;
    }

    /// At s along a wall from its middle.
    /// @param wall  its direction as seen from the room
    Spot spot(int wall, double s, double away = 0) const {
        const glm::dvec2 middle = 0.5 * (area_.min + area_.max), half = 0.5 * (area_.max - area_.min);
        const glm::dvec2 out = directionOf(wall);
        return {middle + out * (half - away) - directionOf(wall + 1) * s, wall + 2};
    }

    Rect rectAt(const Spot& spot, double half, double depth) const {
        const glm::dvec2 a = spot.point(-half, 0), b = spot.point(half, depth);
        return {glm::min(a, b), glm::max(a, b)};
    }

    bool inside(const Rect& rect) const {
        return rect.min.x >= area_.min.x && rect.min.y >= area_.min.y && rect.max.x <= area_.max.x &&
               rect.max.y <= area_.max.y;
    }

    bool free(const Rect& rect, bool tall) const {
        const auto hits = [&](const Rect& other) { return overlap(rect, other); };
        return inside(rect) && std::none_of(taken_.begin(), taken_.end(), hits) &&
               !(tall && std::any_of(glazed_.begin(), glazed_.end(), hits));
    }

    /// @param tall  must not stand before a window
    bool take(const Rect& rect, bool tall = false) {
        if (!free(rect, tall)) return false;
        taken_.push_back(rect);
        return true;
    }

    /// The first place along the walls, from a wall of choice on, that is free for something.
    bool takeAlongWalls(double half, double depth, bool tall, Spot& found) {
        const int first = static_cast<int>(random_.below(4));
        for (int i = 0; i < 4; ++i) {
            const int wall = (first + i) & 3;
            if (takeAlong(wall, half, depth, tall, found)) return true;
        }
        return false;
    }

    bool takeAlong(int wall, double half, double depth, bool tall, Spot& found) {
        const double reach = 0.5 * lengthOf(wall) - half;
        for (double s = -reach; s <= reach; s += 0.21875) {
            for (const double away : {0.015625, 0.1875}) {
                found = spot(wall, s, away);
                if (take(rectAt(found, half, depth), tall)) return true;
            }
        }
        return false;
    }

    /// @param own  the leaf swings into this room
    void keepClear(const Opening& opening, bool own) {
        const int wall = own ? opening.quarter : opening.quarter + 2;
        const glm::dvec2 out = directionOf(wall);
        const Rect hole{{opening.hole.min.x, opening.hole.min.z}, {opening.hole.max.x, opening.hole.max.z}};
        const double width = widthOf(opening);
        if (opening.kind >= OpeningKind::kWindow) {
            Rect zone = hole;
            for (const glm::dvec2& corner : {hole.min - out * 0.5, hole.max - out * 0.5}) {
                zone.min = glm::min(zone.min, corner);
                zone.max = glm::max(zone.max, corner);
            }
            glazed_.push_back(zone);
            if (opening.kind == OpeningKind::kWindow && room_.kind != RoomKind::kCorridor) {
                const Spot below = wallSpot(hole, wall);
                if (take(rectAt(below, 0.65, 0.17))) placer_.put(kRadiator, below.at, level_, below.quarter);
            }
            return;
        }
        const bool wide = opening.kind == OpeningKind::kPassage || opening.kind == OpeningKind::kGlassDoor;
        const double deep = wide ? 1.25 : own ? width + 0.25 : room_.kind == RoomKind::kCorridor ? 0.625 : 0.875;
        const Spot door = wallSpot(hole, wall);
        taken_.push_back(rectAt(door, 0.5 * width + 0.125, deep));
        const Spot beside{door.point((own ? 1 : -1) * (0.5 * width + 0.1875), 0), door.quarter};
        if (inside(rectAt(beside, 0.05, 0.02)) && own) placer_.put(kSwitch, beside.at, level_ + 1.0625, beside.quarter);
    }

    /// On this room's face of a wall, before the middle of a hole.
    Spot wallSpot(const Rect& hole, int wall) const {
        glm::dvec2 at = 0.5 * (hole.min + hole.max);
        if (wall % 2 == 0) at.y = (wall & 3) == 0 ? area_.max.y : area_.min.y;
        else at.x = (wall & 3) == 1 ? area_.max.x : area_.min.x;
        return {at, wall + 2};
    }

    void putAt(const Spot& spot, Item item, double x, double z, double height = 0, int turn = 0) {
        placer_.put(item, spot.point(x, z), level_ + height, spot.quarter + turn);
    }

    /// Someone has pushed the chair back.
    void putChair(const Spot& spot, Item item, double x, double z, int turn) {
        const glm::dvec2 ahead = directionOf(spot.quarter + turn), aside = directionOf(spot.quarter + turn + 1);
        placer_.putFacing(item, spot.point(x, z), level_, ahead + aside * random_.uniform(-0.4, 0.4));
    }

    /// A desk with what belongs to it; 1.7 by 1.75 m.
    void putWorkplace(const Spot& spot) {
        const double side = random_.below(2) ? 1 : -1;
        putAt(spot, kDesk, 0, 0.4375);
        putChair(spot, kOfficeChair, random_.uniform(-0.15, 0.15), 1.1875, 2);
        putAt(spot, kMonitor, 0, 0.25, kDeskTop);
        if (random_.below(4) == 0) putAt(spot, kMonitor, -side * 0.609375 * 0.8, 0.1875, kDeskTop);
        putAt(spot, kKeyboard, 0, 0.5625, kDeskTop);
        if (random_.below(3) != 0) putAt(spot, kDeskLamp, side * 0.5625, 0.1875, kDeskTop);
        if (random_.below(2)) putAt(spot, kPapers, -side * 0.546875, 0.5, kDeskTop, static_cast<int>(random_.below(2)));
        if (random_.below(2)) putAt(spot, kPhone, side * 0.5625, 0.5625, kDeskTop);
        if (random_.below(4) == 0)
            putAt(spot, kMug, -side * 0.3125, 0.4375, kDeskTop, static_cast<int>(random_.below(4)));
        if (random_.below(5) == 0) putAt(spot, kPottedPlant, -side * 0.65625, 0.1875, kDeskTop);
        putAt(spot, kDrawers, side * 0.46875, 0.390625);
        if (random_.below(2)) putAt(spot, kPaperBin, -side * 0.46875, 0.25);
    }

    bool putAlongWalls(Item item, bool tall) {
        const Box3d& bounds = placer_.meshOf(item).bounds;
        const double half = std::max(-bounds.min.x, bounds.max.x) + 0.015625, depth = bounds.size().z + 0.03125;
        Spot found;
        if (!takeAlongWalls(half, depth, tall, found)) return false;
        putAt(found, item, 0, 0.015625 - bounds.min.z);
        return true;
    }

    /// On a wall, where nothing tall stands or is seen through.
    void hang(Item item, double height) {
        const Box3d& bounds = placer_.meshOf(item).bounds;
        const double half = std::max(-bounds.min.x, bounds.max.x);
        const int first = static_cast<int>(random_.below(4));
        for (int i = 0; i < 4; ++i) {
            const int wall = (first + i) & 3;
            const double reach = 0.5 * lengthOf(wall) - half - 0.1875;
            for (int tries = 0; tries < 6 && reach > 0; ++tries) {
                const Spot on_wall = spot(wall, random_.uniform(-reach, reach));
                if (!take(rectAt(on_wall, half + 0.0625, bounds.max.z + 0.03125), true)) continue;
                putAt(on_wall, item, 0, 0, height);
                return;
            }
        }
    }

    void putInCorner() {
        for (int tries = 0; tries < 4; ++tries) {
            const int wall = static_cast<int>(random_.below(4));
            const double end = 0.5 * lengthOf(wall) - 0.515625;
            const Spot corner = spot(wall, random_.below(2) ? end : -end, 0.015625);
            if (!take(rectAt(corner, 0.5, 1))) continue;
            putAt(corner, kTallPlant, 0, 0.5);
            return;
        }
    }

    void putWorkplaces(int count) {
        for (int i = 0; i < count; ++i) {
            Spot found;
            if (!takeAlongWalls(0.875, 1.75, false, found)) return;
            putWorkplace(found);
        }
    }

    void furnishOffice() {
        const double floor = (area_.max.x - area_.min.x) * (area_.max.y - area_.min.y);
        putWorkplaces(1 + static_cast<int>(floor / 14));
        for (uint64_t shelves = 1 + random_.below(2); shelves > 0; --shelves) putAlongWalls(kBookShelf, true);
        if (random_.below(2)) putAlongWalls(kLowShelf, false);
        if (random_.below(2)) putAlongWalls(kCoatStand, true);
        putInCorner();
        if (random_.below(2)) hang(kWhiteboard, 0.9375);
        hang(kPicture, 1.375);
    }

    /// Desks in pairs, face to face.
    void furnishOpenOffice() {
        const glm::dvec2 size = area_.max - area_.min;
        for (double x = 1.25; x + 1.25 < size.x; x += 2) {
            const Spot middle{area_.min + glm::dvec2(x, 0.5 * size.y), 0};
            const Rect island{middle.at - glm::dvec2(0.875, 1.75), middle.at + glm::dvec2(0.875, 1.75)};
            if (random_.below(8) == 0 || !take(island)) continue;
            putWorkplace({middle.at, 0});
            putWorkplace({middle.at, 2});
        }
        putWorkplaces(1 + static_cast<int>(random_.below(2)));
        for (int shelves = 0; shelves < 3; ++shelves) putAlongWalls(random_.below(3) ? kBookShelf : kLowShelf, true);
        putAlongWalls(kCopier, true);
        for (int plants = 0; plants < 2; ++plants) putInCorner();
        hang(kWhiteboard, 0.9375);
        for (int pictures = 0; pictures < 3; ++pictures) hang(kPicture, 1.375);
    }

    void furnishMeeting() {
        const glm::dvec2 size = area_.max - area_.min, middle = 0.5 * (area_.min + area_.max);
        const int quarter = size.x > size.y ? 0 : 1;
        const glm::dvec2 half = quarter == 0 ? glm::dvec2(1.75, 1.1875) : glm::dvec2(1.1875, 1.75);
        for (const double shift : {0.0, 0.5, -0.5}) {
            const Spot table{middle + directionOf(0) * shift, quarter};
            if (!take({table.at - half, table.at + half})) continue;
            putAt(table, kMeetingTable, 0, 0);
            for (const double x : {-0.75, 0.0, 0.75}) {
                putChair(table, kVisitorChair, x, -0.84375, 0);
                putChair(table, kVisitorChair, x, 0.84375, 2);
                if (random_.below(3) == 0) putAt(table, kPapers, x, random_.below(2) ? 0.375 : -0.375, 0.75);
            }
            putChair(table, kVisitorChair, -1.4375, 0, 1);
            putChair(table, kVisitorChair, 1.4375, 0, 3);
            break;
        }
        hang(kWallScreen, 1.0625);
        hang(kWhiteboard, 0.9375);
        putAlongWalls(kLowShelf, true);
        putInCorner();
        hang(kPicture, 1.375);
    }

    void furnishKitchen() {
        constexpr Item kRow[] = {kFridge, kCounter, kSinkCounter, kStove, kCounter};
        constexpr double kWide[] = {0.609375, 0.9375, 0.9375, 0.59375, 0.9375};
        Spot row;
        for (int wall = 1; wall < 5; ++wall) {
            if (!takeAlong(wall & 3, 2.0078125, 1, true, row)) continue;
            double x = -2.0078125;
            for (int i = 0; i < 5; ++i) {
                const double at = x + 0.5 * kWide[i];
                x += kWide[i];
                putAt(row, kRow[i], at, 0.328125);
                if (kRow[i] == kCounter || kRow[i] == kSinkCounter) putAt(row, kWallCupboard, at, 0, 1.4375);
                if (i == 1) putAt(row, kCoffeeMachine, at + 0.1875, 0.25, kWorktop);
                if (i == 4)
                    for (int mug = 0; mug < 4; ++mug)
                        putAt(row, kMug, at - 0.25 + 0.14 * mug, 0.21875, kWorktop, static_cast<int>(random_.below(4)));
            }
            break;
        }
        const glm::dvec2 low = area_.min + 1.125, high = area_.max - 1.125;
        for (int tries = 0, tables = 0; tries < 24 && tables < 2; ++tries) {
            const Spot table{{random_.uniform(low.x, high.x), random_.uniform(low.y, high.y)},
                             static_cast<int>(random_.below(4))};
            if (!take({table.at - 1.0625, table.at + 1.0625})) continue;
            ++tables;
            putAt(table, kRoundTable, 0, 0);
            for (int side = 0; side < 4; ++side) {
                const glm::dvec2 out = directionOf(side) * 0.75;
                if (random_.below(5) != 0) putChair(table, kVisitorChair, out.x, out.y, side + 2);
            }
            putAt(table, kMug, 0.1875, 0.25, 0.7421875);
        }
        putAlongWalls(kPaperBin, false);
        putInCorner();
        hang(kPicture, 1.375);
    }

    void furnishBathroom() {
        Spot found;
        for (int wall : {1, 3}) {
            int cubicles = 0;
            while (cubicles < 3 && takeAlong(wall, 0.5, 1.421875, false, found)) {
                putAt(found, kCubicle, 0, 0);
                putAt(found, kToilet, 0, 0);
                ++cubicles;
            }
            if (cubicles == 0) continue;
            int basins = 0;
            while (basins < 3 && takeAlong(wall + 2, 0.40625, 0.625, false, found)) {
                putAt(found, kWashbasin, 0, 0);
                putAt(found, kMirrorPane, 0, 0, 1.125);
                ++basins;
            }
            break;
        }
        hang(kHandDryer, 1.1875);
        putAlongWalls(kPaperBin, false);
    }

    void furnishStore() {
        for (int i = 0; i < 4; ++i) putAlongWalls(kMetalShelf, true);
        for (int i = 0; i < 3; ++i) putAlongWalls(kBoxes, false);
        putAlongWalls(kLadder, false);
        putAlongWalls(kTrolley, false);
    }

    void furnishCorridor() {
        hang(kExtinguisher, 0.9375);
        for (int i = 0; i < 2; ++i)
            if (random_.below(2)) putAlongWalls(kBench, true);
        if (random_.below(3) == 0) putAlongWalls(kCopier, true);
        for (int i = 0; i < 3; ++i) hang(kPicture, 1.375);
        const double x = 0.5 * (area_.min.x + area_.max.x), z = 0.5 * (area_.min.y + area_.max.y);
        placer_.put(kExitSign, {x, z}, ceiling_, 1);
    }

    void furnishLobby() {
        const glm::dvec2 middle = 0.5 * (area_.min + area_.max);
        const Spot desk{{middle.x, area_.min.y + 2}, 0};
        take({desk.at - glm::dvec2(1.5625, 1.0), desk.at + glm::dvec2(1.5625, 0.75)});
        putAt(desk, kReception, 0, 0);
        putChair(desk, kOfficeChair, 0.25, -0.4375, 0);
        putAt(desk, kMonitor, 0.5, 0.1875, kDeskTop, 2);
        putAt(desk, kPhone, -0.5, 0.125, kDeskTop, 2);
        for (const double x : {-3.3125, 3.3125}) {
            const Spot foot{{x, middle.y + 0.75}, 0};
            if (take({foot.at - 0.3125, foot.at + 0.3125})) putAt(foot, kColumn, 0, 0);
        }
        for (const int wall : {1, 3}) {
            Spot found;
            if (!takeAlong(wall, 0.9375, 1.75, false, found)) continue;
            putAt(found, kSofa, 0, 0.4375);
            putAt(found, kLowTable, 0, 1.25);
        }
        for (int i = 0; i < 4; ++i) putInCorner();
        for (int i = 0; i < 2; ++i) hang(kPicture, 1.375);
    }

    void hangLights() {
        const glm::dvec2 size = area_.max - area_.min;
        const int columns = std::max(1, static_cast<int>(size.x / 2.5)),
                  rows = std::max(1, static_cast<int>(size.y / 2.5));
        for (int i = 0; i < columns; ++i)
            for (int j = 0; j < rows; ++j) {
                const glm::dvec2 at = area_.min + size * (glm::dvec2(i, j) + 0.5) / glm::dvec2(columns, rows);
                const bool sign = room_.kind == RoomKind::kCorridor && columns % 2 == 1 && i == columns / 2;
                placer_.put(kCeilingLight, at + glm::dvec2(sign ? 1.25 : 0, 0), ceiling_, 0);
            }
    }

    const Room& room_;
    Random random_;
    Placer& placer_;
    double level_, ceiling_;
    Rect area_;
    std::vector<Rect> taken_;
    std::vector<Rect> glazed_;  ///< before windows
};

}  // namespace

void furnish(const Plan& plan, uint32_t floor, uint32_t room, Random random, Placer& placer) {
    RoomFurnisher(plan.floors[floor], room, random, placer).furnish();
}

}  // namespace sightline::tools::building
