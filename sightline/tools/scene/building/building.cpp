// A procedural building: rooms, corridors, doors, windows, stairs and furniture, with its cells and portals.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/building/building.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "sightline/base/assert.h"
#include "sightline/tools/scene/building/library.h"
#include "sightline/tools/scene/building/plan.h"
#include "sightline/tools/scene/building/rooms.h"
#include "sightline/tools/scene/building/shell.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::building {
namespace {

// The cells and portals of a procedural building, which its plan knows.

constexpr uint32_t kNoDoor = ~0u;

/// Beside the building and above it, in the order of quarter turns from +z.
struct Around {
    uint32_t side[4];
    uint32_t above;
};

class CellMaker {
public:
    explicit CellMaker(Scene& scene) : scene_(scene) {}

    uint32_t cell(std::string name, const Box3d& box) {
        SceneCell& cell = scene_.cells.emplace_back();
        cell.name = std::move(name);
        cell.bounds = box;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec4 low(0), high(0);
            low[axis] = 1;
            low.w = -box.min[axis];
            high[axis] = -1;
            high.w = box.max[axis];
            cell.planes.push_back(low);
            cell.planes.push_back(high);
        }
        return static_cast<uint32_t>(scene_.cells.size() - 1);
    }

    /// The rectangle in which two boxes touch.
    void portal(uint32_t a, uint32_t b, uint32_t door = kNoDoor) {
        const Box3d &p = scene_.cells[a].bounds, &q = scene_.cells[b].bounds;
        for (int axis = 0; axis < 3; ++axis) {
            const bool onward = p.max[axis] == q.min[axis];
            if (!onward && p.min[axis] != q.max[axis]) continue;
            const int u = (axis + 1) % 3, v = (axis + 2) % 3;
            const glm::dvec3 low = glm::max(p.min, q.min), high = glm::min(p.max, q.max);
            if (!(low[u] < high[u] && low[v] < high[v])) continue;
            ScenePortal portal;
            portal.name = scene_.cells[a].name + " - " + scene_.cells[b].name;
            portal.cells[0] = a;
            portal.cells[1] = b;
            portal.door = door;
            const double at = onward ? p.max[axis] : p.min[axis];
            const glm::dvec2 corners[] = {{low[u], low[v]}, {high[u], low[v]}, {high[u], high[v]}, {low[u], high[v]}};
            for (int i = 0; i < 4; ++i) {
                // Seen from a: against the axis if b lies onward, so the other way round.
                const glm::dvec2& corner = corners[onward ? 3 - i : i];
                glm::dvec3 point;
                point[axis] = at;
                point[u] = corner.x;
                point[v] = corner.y;
                portal.polygon.push_back(point);
            }
            scene_.portals.push_back(std::move(portal));
            return;
        }
        SIGHTLINE_ASSERT(!"cells of a portal touch");
    }

private:
    Scene& scene_;
};

Around addAround(const Plan& plan, CellMaker& maker) {
    const Rect &plot = plan.plot, &house = plan.footprint;
    const double top = plan.air, roof = plan.floors.back().ceiling;
    Around around{};
    around.side[0] = maker.cell("Outside south", {{plot.min.x, 0, house.max.y}, {plot.max.x, top, plot.max.y}});
    around.side[1] = maker.cell("Outside east", {{house.max.x, 0, house.min.y}, {plot.max.x, top, house.max.y}});
    around.side[2] = maker.cell("Outside north", {{plot.min.x, 0, plot.min.y}, {plot.max.x, top, house.min.y}});
    around.side[3] = maker.cell("Outside west", {{plot.min.x, 0, house.min.y}, {house.min.x, top, house.max.y}});
    around.above = maker.cell("Outside above", {{house.min.x, roof, house.min.y}, {house.max.x, top, house.max.y}});
    for (int quarter = 0; quarter < 4; ++quarter) {
        maker.portal(around.side[quarter], around.side[(quarter + 1) % 4]);
        maker.portal(around.above, around.side[quarter]);
    }
    return around;
}

/// Fills Scene::cells and Scene::portals.
/// @param leaves  what shuts each opening of each floor: an index into Scene::objects, or ~0  [size: as the plan's]
void addCells(const Plan& plan, const std::vector<std::vector<uint32_t>>& leaves, Scene& scene) {
    CellMaker maker(scene);
    const Around around = addAround(plan, maker);
    std::vector<uint32_t> below;  // cells of the floor below's rooms
    for (size_t f = 0; f < plan.floors.size(); ++f) {
        const Floor& floor = plan.floors[f];
        std::vector<uint32_t> cells;
        for (size_t r = 0; r < floor.rooms.size(); ++r) {
            const Room& room = floor.rooms[r];
            cells.push_back(maker.cell(room.name, room.box));
            const bool shaft = room.kind == RoomKind::kStairs || room.kind == RoomKind::kLift;
            if (shaft && f > 0) maker.portal(below[r], cells.back());  // shafts have the same places on each floor
            if (room.kind == RoomKind::kRoof) maker.portal(cells.back(), around.above);
        }
        for (size_t o = 0; o < floor.openings.size(); ++o) {
            const Opening& opening = floor.openings[o];
            const uint32_t hole = maker.cell(opening.name, opening.hole);
            maker.portal(cells[opening.room], hole, leaves[f][o]);
            maker.portal(hole, opening.other == kOutside ? around.side[opening.quarter & 3] : cells[opening.other]);
        }
        below = std::move(cells);
    }
}

}  // namespace
}  // namespace sightline::tools::building

namespace sightline::tools {
namespace {

using building::Floor;
using building::Opening;
using building::OpeningKind;
using building::Placer;
using building::Plan;
using building::Room;
using building::RoomKind;
using building::ShellPart;

constexpr double kEyeHeight = 1.625;        // [metres]
constexpr double kAngle = 1.1344640137963;  // 65 degrees, for rooms

/// The shell's parts of one room or outside, which are next in order.
void putParts(std::vector<ShellPart>& parts, size_t& next, uint32_t floor, uint32_t room, Placer& placer) {
    for (; next < parts.size() && parts[next].floor == floor && parts[next].room == room; ++next)
        placer.putShell(std::move(parts[next].mesh), parts[next].name);
}

void addRoom(const Plan& plan, uint32_t f, uint32_t r, uint32_t cab_floor, const Random& random, Placer& placer) {
    const Room& room = plan.floors[f].rooms[r];
    switch (room.kind) {
        case RoomKind::kStairs:
            return furnishStairs(plan, f, room, placer);
        case RoomKind::kLift:
            return furnishLift(plan, f, room, cab_floor, placer);
        case RoomKind::kRoof:
            return furnishRoof(room, random, placer);
        default:
            furnish(plan, f, r, random, placer);
    }
}

/// A camera that looks from eye to target.
void addCamera(Scene& scene, std::string name, const glm::dvec3& eye, const glm::dvec3& target) {
    const glm::dvec3 back = glm::normalize(eye - target), right = glm::normalize(glm::cross(glm::dvec3(0, 1, 0), back));
    SceneCamera& camera = scene.cameras.emplace_back();
    camera.name = std::move(name);
    camera.transform = {glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0),
                        glm::dvec4(eye, 1)};
    camera.fov_y = kAngle;
    camera.z_near = 0.05;
}

/// How far it is from an eye to the next piece of furniture at its height, ahead of it [at most `reach`].
double clearanceAhead(const Scene& scene, const glm::dvec3& eye, const glm::dvec3& target, double reach) {
    const glm::dvec3 ahead = glm::normalize(target - eye);
    double clear = reach;
    for (const SceneObject& object : scene.objects) {
        const glm::dvec3 away = glm::dvec3(object.transform[3]) - eye;
        // What is built stands at the origin of the world; nothing in a room reaches two metres from its place.
        if (object.transform == glm::dmat4(1.0) || std::max(std::abs(away.x), std::abs(away.z)) > reach + 2) continue;
        const Box3d box = transformBox(scene.meshes[object.mesh].bounds, object.transform);
        if (box.max.y < eye.y - 0.25 || box.min.y > eye.y + 0.5) continue;
        const glm::dvec3 nearest = glm::clamp(eye, box.min, box.max) - eye;
        const double distance = glm::length(nearest);
        if (glm::dot(nearest, ahead) >= 0.7 * distance) clear = std::min(clear, distance);
    }
    return clear;
}

/// From a corner by the window, over what stands in the middle: from the other one where a cupboard would be all that
/// is seen.
void addRoomCamera(Scene& scene, const Room& room) {
    constexpr double kClear = 1.5;
    const glm::dvec3 &low = room.box.min, &high = room.box.max;
    const double y = low.y + kEyeHeight;
    const bool north = low.z < 0;
    const double z = north ? low.z + 0.375 : high.z - 0.375, far = north ? high.z : low.z;
    const glm::dvec3 west(low.x + 0.375, y, z), from_west(high.x - 0.5, y - 0.375, far);
    const glm::dvec3 east(high.x - 0.375, y, z), from_east(low.x + 0.5, y - 0.375, far);
    const bool turn = clearanceAhead(scene, east, from_east, kClear) > clearanceAhead(scene, west, from_west, kClear);
    addCamera(scene, room.name, turn ? east : west, turn ? from_east : from_west);
}

/// A walk through one floor: the corridor, each kind of room, and a doorway.
void addFloorCameras(Scene& scene, const Floor& floor) {
    const double y = floor.level + kEyeHeight;
    std::vector<RoomKind> seen;
    for (const Room& room : floor.rooms) {
        const glm::dvec3 middle = room.box.center();
        if (std::find(seen.begin(), seen.end(), room.kind) != seen.end()) continue;
        seen.push_back(room.kind);
        if (room.kind == RoomKind::kCorridor) {
            addCamera(scene, room.name, {room.box.min.x + 0.5, y, middle.z},
                      {room.box.max.x, y - 0.125, middle.z + 0.25});
        } else if (room.kind == RoomKind::kStairs) {
            addCamera(scene, room.name, {middle.x, y, room.box.max.z - 0.25},
                      {middle.x - 0.5, y + 0.5, room.box.min.z});
        } else if (room.kind != RoomKind::kLift && room.kind != RoomKind::kRoof) {
            addRoomCamera(scene, room);
        }
    }
    for (const Opening& opening : floor.openings) {
        if (opening.kind != OpeningKind::kDoor || opening.state != building::LeafState::kOpen) continue;
        const glm::dvec2 at = middleOf(opening), in = building::directionOf(opening.quarter + 2);
        addCamera(scene, opening.name, {at.x - in.x, y, at.y - in.y}, {at.x + 4 * in.x, y - 0.25, at.y + 4 * in.y});
        break;
    }
}

void addCameras(const Plan& plan, Scene& scene) {
    const double width = plan.footprint.max.x, front = plan.plot.max.y, tall = plan.floors.back().level;
    addCamera(scene, "Street", {0.75 * width, 1.7, front - 1}, {-0.25 * width, 0.25 * std::min(tall, 60.0), 0});
    addCamera(scene, "Entrance", {1, 1.7, plan.footprint.max.y + 5}, {0, 1.5, 0});
    const size_t storeys = plan.floors.size() - 1;
    addFloorCameras(scene, plan.floors.front());
    if (storeys > 2) addFloorCameras(scene, plan.floors[storeys / 2]);
    if (storeys > 1) addFloorCameras(scene, plan.floors[storeys - 1]);
    addCamera(scene, "Roof", {-width + 1, tall + 1.75, plan.footprint.max.y - 1}, {width, tall, -1});
    // A storey cut at the height of the eyes, seen from above, as in a plan.
    const Floor& floor = plan.floors[storeys / 2];
    SceneCamera& plan_view = scene.cameras.emplace_back();
    plan_view.name = "Plan of " + floor.name;
    plan_view.transform = {{1, 0, 0, 0}, {0, 0, -1, 0}, {0, 1, 0, 0}, {0, floor.level + 2, 0, 1}};
    plan_view.orthographic_height = 1.25 * width;
    plan_view.z_near = 0.01;
    plan_view.z_far = 20;
    // The same from the side, cut along the corridor.
    SceneCamera& section = scene.cameras.emplace_back();
    section.name = "Section";
    section.transform = glm::dmat4(1.0);
    section.transform[3] = {0, 0.5 * tall, plan.footprint.max.y - 3, 1};
    section.orthographic_height = std::max(tall + 4, 1.25 * width);
    section.z_near = 0.01;
}

}  // namespace

Scene makeBuilding(uint64_t seed, uint32_t floors) {
    Scene scene;
    scene.name = "building:" + std::to_string(seed) + ":" + std::to_string(floors);
    const Plan plan = building::makePlan(seed, floors);
    Pieces library = building::makeLibrary();
    scene.materials = std::move(library.materials);
    scene.meshes = std::move(library.meshes);
    std::vector<ShellPart> parts = building::makeShell(plan);
    size_t next = 0;
    Placer placer(scene);
    Random random(mixSeed(seed, 0x6c696674ull));
    const auto cab_floor = static_cast<uint32_t>(random.below(floors));
    std::vector<std::vector<uint32_t>> leaves;
    for (uint32_t f = 0; f < plan.floors.size(); ++f) {
        const Floor& floor = plan.floors[f];
        std::vector<uint32_t>& floor_leaves = leaves.emplace_back();
        floor_leaves.assign(floor.openings.size(), ~0u);
        const uint32_t node = placer.enter(floor.name, SceneNode::kNone);
        placer.enter("Outside", node);
        putParts(parts, next, f, building::kOutside, placer);
        if (f == 0) furnishPlot(plan, Random(mixSeed(seed, 0x706c6f74ull)), placer);
        for (uint32_t r = 0; r < floor.rooms.size(); ++r) {
            placer.enter(floor.rooms[r].name, node);
            putParts(parts, next, f, r, placer);
            for (size_t o = 0; o < floor.openings.size(); ++o) {
                const Opening& opening = floor.openings[o];
                const bool cab = opening.kind == OpeningKind::kLiftDoor && f == cab_floor;
                if (opening.room == r && !cab) floor_leaves[o] = putOpening(floor, opening, placer);
            }
            addRoom(plan, f, r, cab_floor, Random(mixSeed(seed, (1ull << 40) + (uint64_t{f} << 16) + r)), placer);
        }
    }
    building::addCells(plan, leaves, scene);
    addCameras(plan, scene);
    return scene;
}

}  // namespace sightline::tools
