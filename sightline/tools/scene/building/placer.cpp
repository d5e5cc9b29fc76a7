// Puts the objects of a procedural building down: stairs and shaft, doors and windows, roof and plot.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <utility>

#include "sightline/tools/scene/building/rooms.h"

namespace sightline::tools::building {
namespace {

/// Turned about the vertical so that +z points along a direction of the plan.
glm::dmat4 turned(const glm::dvec2& at, double height, const glm::dvec2& direction, const glm::dvec3& scale) {
    const glm::dvec2 along(direction.y, -direction.x);
    glm::dmat4 transform(1.0);
    transform[0] = {along.x * scale.x, 0, along.y * scale.x, 0};
    transform[1] = {0, scale.y, 0, 0};
    transform[2] = {direction.x * scale.z, 0, direction.y * scale.z, 0};
    transform[3] = {at.x, height, at.y, 1};
    return transform;
}

}  // namespace

glm::dvec2 directionOf(int quarter) {
    constexpr int kX[] = {0, 1, 0, -1}, kZ[] = {1, 0, -1, 0};
    return {kX[quarter & 3], kZ[quarter & 3]};
}

uint32_t Placer::enter(const std::string& name, uint32_t parent) {
    scene_->nodes.push_back({name, parent});
    node_ = static_cast<uint32_t>(scene_->nodes.size() - 1);
    counts_.clear();
    return node_;
}

uint32_t Placer::put(Item item, const glm::dmat4& transform, const std::string& note) {
    SceneObject& object = scene_->objects.emplace_back();
    object.key = scene_->objects.size() - 1;
    object.mesh = item;
    object.transform = transform;
    const std::string& name = scene_->meshes[item].name;
    object.name = name + " " + std::to_string(++counts_[name]) + note;
    object.node = node_;
    return static_cast<uint32_t>(object.key);
}

uint32_t Placer::put(Item item, const glm::dvec2& at, double height, int quarter, const glm::dvec3& scale) {
    return put(item, turned(at, height, directionOf(quarter), scale));
}

uint32_t Placer::putFacing(Item item, const glm::dvec2& at, double height, const glm::dvec2& direction) {
    return put(item, turned(at, height, direction / std::sqrt(glm::dot(direction, direction)), glm::dvec3(1)));
}

void Placer::putShell(Mesh mesh, const std::string& name) {
    SceneObject& object = scene_->objects.emplace_back();
    object.key = scene_->objects.size() - 1;
    object.mesh = static_cast<uint32_t>(scene_->meshes.size());
    object.name = name;
    object.node = node_;
    scene_->meshes.push_back(std::move(mesh));
}

uint32_t putOpening(const Floor& floor, const Opening& opening, Placer& placer) {
    constexpr uint32_t kNone = ~0u;
    const glm::dvec2 outward = directionOf(opening.quarter);
    if (opening.kind >= OpeningKind::kWindow) {
        const Item item = opening.kind == OpeningKind::kWindow        ? kWindow
                          : opening.kind == OpeningKind::kSmallWindow ? kSmallWindow
                                                                      : kStairWindow;
        const glm::dvec2 at = middleOf(opening) + outward * 0.0625;
        placer.put(item, at, opening.hole.center().y, opening.quarter + 2);
        return kNone;
    }
    if (opening.kind == OpeningKind::kPassage) return kNone;
    if (opening.kind == OpeningKind::kGlassDoor) {
        const glm::dvec2 start = middleOf(opening) - directionOf(opening.quarter + 1) * (0.5 * widthOf(opening));
        placer.put(kGlassLeaf, start, floor.level, opening.quarter);
        return kNone;
    }
    // The leaf's axes: x from the hinge, z into the room. Seen from the room, +x runs to `right`.
    const double width = widthOf(opening);
    const double thickness = opening.hole.size()[opening.quarter % 2 == 0 ? 2 : 0];
    const glm::dvec2 inward = -outward, right(inward.y, -inward.x);
    const bool right_is_high = right.x + right.y > 0, mirrored = opening.hinge_high == right_is_high;
    const glm::dvec2 face = middleOf(opening) - outward * (0.5 * thickness);
    const glm::dvec2 hinge = face + right * (mirrored ? 0.5 * width : -0.5 * width);
    const glm::dvec3 scale(mirrored ? -1 : 1, 1, 1);
    const glm::dmat4 shut = turned(hinge, floor.level, inward, scale);
    const bool fire = opening.kind == OpeningKind::kFireDoor;
    if (opening.kind == OpeningKind::kLiftDoor) return placer.put(kLiftLeaf, shut, " (shut)");
    placer.put(fire ? kFireFrame : thickness == kInnerWall ? kThinDoorFrame : kDoorFrame, shut);
    const Item leaf = fire ? kFireLeaf : kDoorLeaf;
    if (opening.state == LeafState::kShut) return placer.put(leaf, shut, " (shut)");
    // Turned about the edge of the leaf that is in the room.
    constexpr double kHalfRoot2 = 0.70710678118654752440;
    const bool half = opening.state == LeafState::kHalfOpen;
    const double c = half ? kHalfRoot2 : 0, s = half ? kHalfRoot2 : 1;
    const Box3d& bounds = placer.meshOf(leaf).bounds;
    const glm::dvec3 pin(bounds.min.x, 0, bounds.max.z);
    glm::dmat4 turn(1.0);
    turn[0] = {c, 0, s, 0};
    turn[2] = {-s, 0, c, 0};
    turn[3] = glm::dvec4(pin - glm::dvec3(c * pin.x - s * pin.z, 0, s * pin.x + c * pin.z), 1);
    return placer.put(leaf, shut * turn, half ? " (half open)" : " (open)");
}

void furnishStairs(const Plan& plan, uint32_t index, const Room& room, Placer& placer) {
    const Box3d& box = room.box;
    const double level = plan.floors[index].level, edge = box.max.z - kLandingDepth;
    const bool top = index + 2 == plan.floors.size();
    if (index > 0) placer.put(kLanding, {box.min.x, box.max.z}, level, 0);
    if (top) {
        placer.put(kLandingRail, {box.min.x, edge}, level, 0);
    } else {
        const double half = 0.5 * kStorey, far = edge - kFlightRun;
        placer.put(kFlight, {box.min.x, edge}, level, 0);
        placer.put(kFlightRail, {box.min.x, edge}, level, 0);
        placer.put(kHalfLanding, {box.min.x, box.min.z}, level + half, 0);
        placer.put(kFlight, {box.max.x, far}, level + half, 2);
        placer.put(kFlightRail, {box.max.x, far}, level + half, 2);
    }
    placer.put(kCeilingLight, {box.center().x, box.max.z - 0.75}, plan.floors[index].ceiling, 0);
}

void furnishLift(const Plan& plan, uint32_t index, const Room& room, uint32_t cab_floor, Placer& placer) {
    const Box3d& box = room.box;
    const glm::dvec3 middle = box.center();
    const double tall = box.size().y / kStorey;
    for (const int quarter : {1, 3}) {
        const double x = quarter == 1 ? box.min.x : box.max.x;
        // A rail's back is to the wall: its +x runs into the shaft.
        placer.put(kLiftRail, {x, middle.z}, box.min.y, quarter == 1 ? 0 : 2, {1, tall, 1});
    }
    const double level = plan.floors[index].level;
    if (index == cab_floor) placer.put(kLiftCab, {middle.x, box.max.z - 0.0625}, level, 0);
    // The weight hangs as far from the top as the cab stands from the bottom.
    if (index + cab_floor + 2 == plan.floors.size())
        placer.put(kCounterweight, {middle.x, box.min.z + 0.140625}, level + 0.5, 0);
}

void furnishRoof(const Room& room, Random random, Placer& placer) {
    const Box3d& box = room.box;
    const double length = box.size().x;
    const int coolers = 2 + static_cast<int>(random.below(4));
    for (int i = 0; i < coolers; ++i)
        placer.put(kCooler, {box.min.x + length * (i + 0.5) / coolers, box.min.z + 2}, box.min.y, 0);
    for (double x = box.min.x + 3; x < box.max.x - 3; x += 4.5)
        placer.put(kVent, {x + random.uniform(-1, 1), box.center().z + random.uniform(-1, 0)}, box.min.y, 0);
    for (double z = box.center().z + 1.5; z < box.max.z - 1; z += 1.75)
        for (double x = box.min.x + 1.5; x < box.max.x - 1.25; x += 1.75) placer.put(kSolarPanel, {x, z}, box.min.y, 0);
}

void furnishPlot(const Plan& plan, Random random, Placer& placer) {
    const Rect &plot = plan.plot, &house = plan.footprint;
    const double margin = 0.5 * (plot.max.x - house.max.x);
    // All around, half-way to the plot's edge; the way to the entrance stays free.
    for (int quarter = 0; quarter < 4; ++quarter) {
        const glm::dvec2 out = directionOf(quarter), along = directionOf(quarter + 1);
        const glm::dvec2 reach = 0.5 * (house.max - house.min) + margin;
        const double length = std::abs(glm::dot(along, reach)), away = std::abs(glm::dot(out, reach));
        int step = 0;
        for (double s = -length + 1; s < length - 2; s += 5.5, ++step) {
            const double sway = random.uniform(-0.75, 0.75), tall = random.uniform(0.8, 1.2);
            if (quarter == 0 && std::abs(s) < 4) continue;
            placer.put(kTree, along * (s + sway) + out * away, 0, static_cast<int>(random.below(4)), glm::dvec3(tall));
            const glm::dvec2 between = along * (s + 2.75) + out * (away - 2);
            if (step % 2 == 0) placer.put(kLampPost, between, 0, 0);
            else placer.put(kBench, between, 0, quarter + 2);
        }
        for (double s = -length - margin + 1.5; s < length + margin - 1.25; s += 2.5)
            if (quarter != 0 || std::abs(s) > 3) placer.put(kHedge, along * s + out * (away + margin - 1), 0, quarter);
    }
}

}  // namespace sightline::tools::building
