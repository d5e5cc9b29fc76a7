// Dense real scenes by their clusters: what is left of every object draws the image that everything draws.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/truth/scene_facts.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

std::vector<MeshPart> partsOf(const Scene& scene, const Mesh& mesh) {
    std::vector<MeshPart> parts;
    for (const Primitive& primitive : mesh.primitives)
        parts.push_back({primitive.first_triangle, primitive.triangle_count,
                         scene.materials[primitive.material].double_sided,
                         scene.materials[primitive.material].hides()});
    return parts;
}

/// Draws a scene, or what a query left of it.
class Painter {
public:
    explicit Painter(const Scene& scene) : scene_(scene), facts_(scene) {
        for (const Mesh& mesh : scene.meshes)
            clusters_.push_back(prepareDrawClusters({mesh.positions, mesh.indices}, partsOf(scene, mesh)));
    }

    ZBufferImage whole(const View& view) {
        begin();
        for (uint32_t object = 0; object < scene_.objects.size(); ++object) add(object, {});
        return draw(view);
    }
    ZBufferImage left(const View& view, const LoadedWorld& loaded, const VisibleSet& set) {
        begin();
        std::vector<std::vector<DrawRange>> ranges(scene_.objects.size());
        std::vector<uint8_t> kept(scene_.objects.size(), 0);
        for (const Visible& v : set.objects) kept[v.id.index - 1] = 1;
        for (const DrawRange& range : set.ranges) ranges[set.objects[range.object].id.index - 1].push_back(range);
        for (uint32_t object = 0; object < scene_.objects.size(); ++object) {
            EXPECT_EQ(loaded.ids[object].index, object + 1);
            if (kept[object]) add(object, ranges[object]);
        }
        return draw(view);
    }

private:
    struct Part {
        std::vector<uint32_t> indices;
        std::vector<uint8_t> sides, writes;
        uint32_t object;
    };
    void begin() { drawn_.clear(); }
    void add(uint32_t object, const std::vector<DrawRange>& ranges) {
        const uint32_t which = scene_.objects[object].mesh;
        const Mesh& mesh = scene_.meshes[which];
        Part& part = drawn_.emplace_back();
        part.object = object;
        if (ranges.empty()) {
            part.indices = mesh.indices;
            part.sides = facts_.meshFacts(which).double_sided;
            part.writes = facts_.meshFacts(which).hides;
        }
        for (const DrawRange& range : ranges)
            for (uint32_t t = range.first; t < range.first + range.count; ++t) {
                const uint32_t triangle = clusters_[which].triangles[t];
                part.indices.insert(part.indices.end(), mesh.indices.begin() + 3 * triangle,
                                    mesh.indices.begin() + 3 * triangle + 3);
                part.sides.push_back(facts_.meshFacts(which).double_sided[triangle]);
                part.writes.push_back(facts_.meshFacts(which).hides[triangle]);
            }
    }
    ZBufferImage draw(const View& view) const {
        std::vector<DrawItem> items;
        for (const Part& part : drawn_) {
            const SceneObject& object = scene_.objects[part.object];
            DrawItem item{.mesh = {scene_.meshes[object.mesh].positions, part.indices},
                          .double_sided = part.sides,
                          .writes_depth = part.writes,
                          .transform = object.transform,
                          .id = part.object};
            items.push_back(item);
        }
        return renderZBuffer(items, view, {.want_generated = false});
    }

    const Scene& scene_;
    std::vector<DrawClusters> clusters_;
    SceneFacts facts_;
    std::vector<Part> drawn_;
};

void expectSameImages(const Scene& scene, uint32_t frames, double most_drawn) {
    LoadSettings settings = loadSettings(false, 1, true);
    LoadedWorld loaded = loadWorld(scene, {}, settings);
    const Snapshot now = loaded.world.commit();
    Painter painter(scene);
    Query query;
    uint64_t whole = 0, drawn = 0;
    const CameraPath path = seededCameras(scene, frames, 11);
    for (const CameraFrame& camera : path.frames) {
        const View view = makeView(camera, 480, 270);
        const VisibleSet set = query.visible(now, view);
        whole += set.stats.cluster_triangles;
        drawn += set.stats.drawn_triangles;
        const ZBufferImage all = painter.whole(view), left = painter.left(view, loaded, set);
        std::vector<uint8_t> seen = left.seen;
        seen.resize(all.seen.size(), 0);
        EXPECT_TRUE(all.id == left.id) << scene.name;
        EXPECT_TRUE(all.depth == left.depth) << scene.name;
        EXPECT_TRUE(all.seen == seen) << scene.name;
    }
    EXPECT_GT(drawn, 0u);
    EXPECT_LT(static_cast<double>(drawn), most_drawn * static_cast<double>(whole)) << scene.name;
}

TEST(ClustersOfABuilding, LookTheSame) { expectSameImages(makeBuilding(1, 2), 6, 0.9); }

using ClusterScenes = test::SceneTest;

TEST_P(ClusterScenes, LookTheSame) { expectSameImages(*scene, 4, 0.7); }

INSTANTIATE_TEST_SUITE_P(Scenes, ClusterScenes,
                         testing::Values("dense-spot", "playcanvas-cave", "polyhaven-dutch-ship", "2CylinderEngine"));

}  // namespace
}  // namespace sightline
