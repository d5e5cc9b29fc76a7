// A scene's own hierarchy beside a world's, over the same objects.
// SPDX-License-Identifier: MIT
#include "bench/cases.h"

#include "bench/flat_boxes.h"
#include "bench/stopwatch.h"
#include "sightline/cull/hierarchy.h"
#include "sightline/studies/frustum/node_tree.h"
#include "bench/scene_tree.h"
#include "sightline/tools/load/seeded_cameras.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr uint32_t kViews = 16;
constexpr int kSceneFrames = 21;

Box3d boxOf(const Scene& scene, const SceneObject& object, const glm::dvec3& by) {
    const Box3d box = transformBox(scene.meshes[object.mesh].bounds, object.transform);
    return {box.min + by, box.max + by};
}

/// The name with the most objects that has no more than a share of all below it; and these objects.
struct Part {
    uint32_t name = SceneNode::kNone;
    std::vector<uint32_t> objects;
};

Part partOf(const Scene& scene, size_t most) {
    std::vector<size_t> below(scene.nodes.size(), 0);
    const auto forAbove = [&](const SceneObject& object, auto use) {
        for (uint32_t name = object.node; name < scene.nodes.size(); name = scene.nodes[name].parent)
            if (use(name)) return true;
        return false;
    };
    for (const SceneObject& object : scene.objects)
        forAbove(object, [&](uint32_t name) { return ++below[name], false; });
    Part part;
    for (uint32_t name = 0; name < scene.nodes.size(); ++name)
        if (below[name] <= most && (part.name == SceneNode::kNone || below[name] > below[part.name])) part.name = name;
    for (uint32_t i = 0; i < scene.objects.size(); ++i)
        if (forAbove(scene.objects[i], [&](uint32_t name) { return name == part.name; })) part.objects.push_back(i);
    return part;
}

}  // namespace

void addSceneTree(Table& table, const std::string& where, const Scene& scene, int repeat) {
    const SceneTree from = sceneTree(scene);
    NodeTree own;
    WorldBvh world;
    std::vector<Box3d> boxes;
    std::vector<uint32_t> items;
    for (const SceneObject& object : scene.objects) {
        boxes.push_back(boxOf(scene, object, glm::dvec3(0.0)));
        items.push_back(static_cast<uint32_t>(items.size()));
    }
    const double build_own = millisecondsOf([&] { own.build(from.nodes, from.items); });
    const double build_world = millisecondsOf([&] { world.build(boxes, items); });
    const Rows row{table, where};
    row("build its own hierarchy", build_own, "ms", "a world's tree", build_world);
    std::vector<Frustum> frusta;
    for (const CameraFrame& camera : seededCameras(scene, kViews, 1).frames)
        frusta.push_back(makeFrustum(makeView(camera, 1280, 720)));
    HierarchyScratch scratch;
    FlatBoxes flat(boxes);
    std::vector<uint32_t> kept(boxes.size() + 16);
    size_t by_own = 0, by_world = 0;
    HierarchyStats stats;
    uint64_t own_nodes = 0, world_nodes = 0;
    const auto queries = [&](const std::string& when) {
        const std::vector<double> times =
            threadTimes({[&] {
                             by_own = own_nodes = 0;
                             for (const Frustum& frustum : frusta) {
                                 by_own += cullNodeTree(frustum, own.now(), scratch, kept, &stats);
                                 own_nodes += stats.nodes;
                             }
                         },
                         [&] {
                             by_world = world_nodes = 0;
                             for (const Frustum& frustum : frusta) {
                                 by_world += cullHierarchy(frustum, world.now(), scratch, kept, &stats);
                                 world_nodes += stats.nodes;
                             }
                         },
                         [&] {
                             for (const Frustum& frustum : frusta) cullFrustum(frustum, flat.arrays, flat.kept);
                         }},
                        repeat ? repeat : 15);
        const double each = 1.0 / kViews;
        const std::string what = "query of its own hierarchy" + when;
        row(what, times[0] * each, "us", "a world's tree", times[1] * each);
        if (when.empty()) row(what, times[0] * each, "us", "flat, SIMD", times[2] * each);
        row("nodes visited" + when, static_cast<double>(own_nodes) * each, "nodes", "a world's tree",
            static_cast<double>(world_nodes) * each);
        row("kept" + when, static_cast<double>(by_own) * each, "objects", "a world's tree",
            static_cast<double>(by_world) * each);
    };
    queries("");
    const Part part = partOf(scene, std::max<size_t>(scene.objects.size() / 10, 1));
    if (part.name == SceneNode::kNone) return;
    std::vector<double> by_node, one_by_one;
    for (int frame = 0; frame < kSceneFrames; ++frame) {
        const glm::dvec3 by(0.1 * frame, 0.0, 0.05 * frame);
        by_node.push_back(millisecondsOf([&] {
            glm::dmat4 local(1.0);
            local[3] = glm::dvec4(by, 1.0);
            own.setTransform(from.node_of_name[part.name], local);
            own.update();
        }));
        one_by_one.push_back(millisecondsOf([&] {
            for (const uint32_t object : part.objects) {
                const Box3d box = boxOf(scene, scene.objects[object], by);
                if (world.move(object, box)) continue;
                world.remove(object);
                if (world.insert(object, box) == WorldBvh::kNone) world.append({&box, 1}, {&object, 1});
            }
            world.mend(2 * static_cast<uint32_t>(part.objects.size()));
        }));
    }
    table.rows.push_back({where + ", " + std::to_string(part.objects.size()) + " objects move as one",
                          "place a node and update", medianOf(by_node), "ms/frame", "the same moves of a world's tree",
                          medianOf(one_by_one)});
    queries(", then");
}

}  // namespace sightline::bench
