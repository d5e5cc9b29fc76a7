// Which doorways the study of portal images looks at.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "bench/image_study.h"
#include "sightline/tools/load/walk.h"
#include "sightline/tools/report/pictures/scene_look.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::bench {
using namespace images;

std::vector<StudiedDoorway> doorwaysOf(const Scene& scene, uint64_t seed, size_t count) {
    constexpr double kLeastWidth = 0.5, kLeastHeight = 1.5, kMostSize = 6, kRoom = 0.25, kStep = 0.3;
    Random random(seed);
    std::vector<StudiedDoorway> doorways;
    for (size_t tries = 0; tries < 50 * scene.portals.size() && doorways.size() < count; ++tries) {
        const ScenePortal& portal = scene.portals[random.below(scene.portals.size())];
        const size_t side = random.below(2);
        if (portal.cells[0] == ScenePortal::kNone || portal.cells[1] == ScenePortal::kNone) continue;
        if (portal.door != ScenePortal::kNone && scene.objects[portal.door].name.find("shut") != std::string::npos)
            continue;
        const SceneCell& cell = scene.cells[portal.cells[side]];
        if (!cell.bounds.finite()) continue;
        const Result<PortalFrame> frame = portalFrame(portal.polygon, cell.bounds.center());
        if (!frame || std::abs(frame->up.y) < 0.99 || frame->width < kLeastWidth || frame->height < kLeastHeight ||
            std::max(frame->width, frame->height) > kMostSize)
            continue;
        StudiedDoorway doorway;
        doorway.name = portal.name;
        doorway.frame = *frame;
        doorway.place = cell.bounds;
        doorway.height = std::min(1.6, 0.8 * frame->height);
        if (glm::dot(frame->corner - cell.bounds.min, frame->up) > kStep) continue;  // a window
        double depth = 0;
        for (int k = 0; k < 8; ++k) {
            const Box3d& box = cell.bounds;
            const glm::dvec3 corner((k & 1) != 0 ? box.max.x : box.min.x, (k & 2) != 0 ? box.max.y : box.min.y,
                                    (k & 4) != 0 ? box.max.z : box.min.z);
            depth = std::max(depth, frame->toFrame(corner).z);
        }
        doorway.farthest = std::min(depth - kRoom, 5.0);
        if (doorway.farthest < 1.5 * doorway.nearest) continue;
        const auto is_same = [&](const StudiedDoorway& other) { return other.name == doorway.name; };
        if (std::none_of(doorways.begin(), doorways.end(), is_same)) doorways.push_back(doorway);
    }
    return doorways;
}

StudiedDoorway cutThrough(const Scene& scene) {
    const Box3d box = coreOf(scene).bounds;
    const glm::dvec3 middle = box.center();
    const int axis = box.size().x >= box.size().z ? 0 : 2;
    const glm::dvec3 along = axis == 0 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
    const glm::dvec3 across = axis == 0 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const double high = box.size().y, wide = glm::dot(across, box.size());
    const glm::dvec3 foot(middle.x, box.min.y, middle.z);
    const std::vector<glm::dvec3> corners = {foot - 0.5 * wide * across, foot + 0.5 * wide * across,
                                             foot + 0.5 * wide * across + glm::dvec3(0, high, 0),
                                             foot - 0.5 * wide * across + glm::dvec3(0, high, 0)};
    StudiedDoorway doorway;
    doorway.name = "cut";
    doorway.in_cell = false;
    doorway.place = box;
    doorway.height = std::min(0.5 * high, 6.0);
    doorway.nearest = 0.15 * glm::dot(along, box.size());
    doorway.farthest = 0.3 * glm::dot(along, box.size());
    const Result<PortalFrame> frame = portalFrame(corners, middle - doorway.farthest * along);
    if (frame) doorway.frame = *frame;
    return doorway;
}

std::vector<StudiedDoorway> aheadIn(const DrawnScene& scene, uint64_t seed, size_t count) {
    constexpr double kAhead = 2.5, kWidth = 5, kBelow = 1.5, kHeight = 2.6, kReach = 0.6;
    WalkSettings walk;
    walk.frames = 32;
    walk.seed = seed;
    walk.fps = 0.4;
    std::vector<std::pair<double, StudiedDoorway>> found;
    for (const CameraFrame& camera : walkThrough(scene.scene(), walk).frames) {
        glm::dvec3 along = camera.target - camera.eye;
        along.y = 0;
        if (!(glm::length(along) > 1e-6)) continue;
        along = glm::normalize(along);
        const glm::dvec3 across(-along.z, 0, along.x), foot = camera.eye + kAhead * along - glm::dvec3(0, kBelow, 0);
        const std::vector<glm::dvec3> corners = {foot - 0.5 * kWidth * across, foot + 0.5 * kWidth * across,
                                                 foot + 0.5 * kWidth * across + glm::dvec3(0, kHeight, 0),
                                                 foot - 0.5 * kWidth * across + glm::dvec3(0, kHeight, 0)};
        const Result<PortalFrame> frame = portalFrame(corners, camera.eye);
        if (!frame) continue;
        StudiedDoorway doorway;
        doorway.name = "ahead";
        doorway.frame = *frame;
        doorway.in_cell = false;
        doorway.place = {camera.eye - kReach, camera.eye + kReach};
        doorway.height = kBelow;
        doorway.nearest = kAhead - kReach;
        doorway.farthest = kAhead + kReach;
        // How much of the view looks farther than the doorway.
        View view;
        view.width = 64, view.height = 36;
        view.view = lookAt(camera.eye, camera.eye + along, {0, 1, 0});
        view.projection = perspective(glm::radians(58.7), 16.0 / 9.0, 0.05);
        double farther = 0;
        for (const DepthSample& sample : scene.draw(scene.inView(view), view).samples)
            farther += sample.nearness < 1 / (2 * kAhead);
        found.emplace_back(-farther, doorway);
    }
    std::stable_sort(found.begin(), found.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
    std::vector<StudiedDoorway> doorways;
    for (size_t i = 0; i < std::min(count, found.size()); ++i) doorways.push_back(found[i].second);
    return doorways;
}

}  // namespace sightline::bench
