// Furnishes a procedural building: puts its objects down, under a tree of nodes.
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/scene/building/library.h"
#include "sightline/tools/scene/building/plan.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::building {

/// The direction of a quarter turn in the plan, (x, z): 0 is +z, 1 is +x.
glm::dvec2 directionOf(int quarter);

/// Puts instances of the library into the scene, whose meshes begin with it, and names them by their room.
class Placer {
public:
    explicit Placer(Scene& scene) : scene_(&scene) {}

    /// A node; objects that follow hang in it and are counted anew.
    uint32_t enter(const std::string& name, uint32_t parent);

    /// @param at       (x, z)
    /// @param quarter  quarter turns from +z towards +x
    /// @return the object's index
    uint32_t put(Item item, const glm::dvec2& at, double height, int quarter, const glm::dvec3& scale = glm::dvec3(1));
    uint32_t put(Item item, const glm::dmat4& transform, const std::string& note = {});
    /// Its front looks along a direction in the plan.
    uint32_t putFacing(Item item, const glm::dvec2& at, double height, const glm::dvec2& direction);

    /// An object with a mesh of its own.
    void putShell(Mesh mesh, const std::string& name);

    const Mesh& meshOf(Item item) const { return scene_->meshes[item]; }

private:
    Scene* scene_;
    uint32_t node_ = SceneNode::kNone;
    std::map<std::string, int> counts_;  ///< in this node, by name
};

/// The furniture of one room. What stands on the floor keeps clear of the rest and of the doors' swing, and lies
/// within the room's box.
void furnish(const Plan& plan, uint32_t floor, uint32_t room, Random random, Placer& placer);

/// Stairs and shaft; roof and plot.
void furnishStairs(const Plan& plan, uint32_t floor, const Room& room, Placer& placer);
void furnishLift(const Plan& plan, uint32_t floor, const Room& room, uint32_t cab_floor, Placer& placer);
void furnishRoof(const Room& room, Random random, Placer& placer);
void furnishPlot(const Plan& plan, Random random, Placer& placer);

/// The leaf and lining of a door, the pane of a window. Returns the object that shuts it, or ~0.
uint32_t putOpening(const Floor& floor, const Opening& opening, Placer& placer);

}  // namespace sightline::tools::building
