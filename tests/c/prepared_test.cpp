// Prepared meshes through C: what a file holds of them enters a world, and hides what it does in C++.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <vector>

#include "sightline/c/prepared.h"
#include "sightline/visfile/visibility_file.h"
#include "tests/c/c_twin.h"
#include "tests/visfile/made_meshes.h"
#include "tests/visfile/made_places.h"
#include "tests/visfile/made_rows.h"

namespace sightline::test {
namespace {

TEST(CVisibility, PreparedMeshesComeFromTheFile) {
    const MadePlaces places = boxesInARow(4, 5, 6, 12);
    const BitMatrix visible = randomRows(6, 0.3, 5);
    const PreparedMeshes made = madeMeshes(5, 12);
    VisibilityContent content{visible, {}, "house", 5, &places.space, &places.objects};
    content.prepared = made.meshes;
    content.prepared_of_object = made.mesh_of_object;
    const Array<char> bytes = *visibilityFile(content, VisibilityForm::kPacked);
    slVisibility* file = nullptr;
    ASSERT_EQ(slOpenVisibility(bytes.data(), bytes.size(), "house", nullptr, &file), SL_OK);
    slPrepared* prepared = nullptr;
    ASSERT_EQ(slOpenPrepared(file, &prepared), SL_OK);
    slCloseVisibility(file);
    ASSERT_EQ(slPreparedMeshes(prepared), 3u);
    for (size_t i = 0; i < 12; ++i) {
        const uint64_t key = places.objects.keys[i];
        const bool alone = std::count(places.objects.keys.begin(), places.objects.keys.end(), key) == 1;
        EXPECT_EQ(slPreparedMeshOf(prepared, key), alone ? made.mesh_of_object[i] : UINT32_MAX);
    }
    EXPECT_EQ(slPreparedMeshOf(prepared, ~uint64_t{0}), UINT32_MAX);
    size_t count = 0;
    const uint32_t* triangles = slPreparedTriangles(prepared, 0, &count);
    ASSERT_EQ(count, made.meshes[0].clusters.triangles.size());
    EXPECT_TRUE(std::equal(triangles, triangles + count, made.meshes[0].clusters.triangles.begin()));
    EXPECT_EQ(slPreparedTriangles(prepared, 1, &count), nullptr);
    EXPECT_EQ(count, 0u);
    const LodChain& chain = made.meshes[0].lods;
    for (uint32_t level = 1; level < chain.levels.size(); ++level)
        for (uint32_t part = 0; part < chain.parts; ++part) {
            const uint32_t* indices = slPreparedLevel(prepared, 0, level, part, &count);
            const auto expected = chain.indicesOf(level, part);
            ASSERT_EQ(count, expected.size());
            EXPECT_TRUE(std::equal(expected.begin(), expected.end(), indices));
        }
    EXPECT_EQ(slPreparedLevel(prepared, 0, 0, 0, &count), nullptr) << "the mesh itself";
    EXPECT_EQ(slPreparedLevel(prepared, 0, 1, 2, &count), nullptr);
    EXPECT_EQ(slPreparedLevel(prepared, 1, 1, 0, nullptr), nullptr);

    // A wall of a prepared mesh hides what one of C++ hides.
    const CWorld world;
    World twin;
    slPreparedIds ids;
    ASSERT_EQ(slAddPrepared(world.world, prepared, 0, &ids), SL_OK);
    EXPECT_NE(ids.occluder.index, 0u);
    EXPECT_EQ(ids.shape.index, ids.occluder.index);
    EXPECT_NE(ids.clusters.index, 0u);
    EXPECT_NE(ids.lods.index, 0u);
    slPreparedIds glass;
    ASSERT_EQ(slAddPrepared(world.world, prepared, 2, &glass), SL_OK);
    EXPECT_EQ(glass.occluder.index, 0u);
    EXPECT_NE(glass.shape.index, 0u);
    EXPECT_EQ(glass.clusters.index, 0u);
    const OccluderId wall = twin.addOccluder(made.meshes[0].occluder, made.meshes[0].inner);
    for (uint64_t key = 0; key < 40; ++key) {
        slObjectDef def = slDefaultObjectDef();
        ObjectDef object;
        object.key = def.key = key;
        const double size = key == 0 ? 1.8 : 0.05;
        object.bounds = {glm::dvec3(-size), glm::dvec3(size)};
        def.bounds = {{-size, -size, -size}, {size, size, size}};
        if (key == 0) {
            def.occluder = def.shape = ids.occluder;
            object.occluder = object.shape = wall;
        } else {
            object.transform[3] = {-2 + 0.1 * static_cast<double>(key), 0, -4, 1};
            std::memcpy(def.transform, &object.transform, sizeof def.transform);
        }
        twin.add(object);
        ASSERT_EQ(slAddObject(world.world, &def, nullptr), SL_OK);
    }
    const CQuery c(world);
    const Snapshot now = twin.commit();
    Query query;
    const View view = viewFrom({0, 0, 6}, {0, 0, -1});
    std::vector<uint64_t> keys = keysOf(c.ask(viewOf(view))), expected = keysOf(query.visible(now, view));
    std::sort(keys.begin(), keys.end());
    std::sort(expected.begin(), expected.end());
    EXPECT_EQ(keys, expected);
    EXPECT_LT(keys.size(), 35u) << "the ring hides some";
    EXPECT_EQ(slAddPrepared(world.world, prepared, 3, &ids), SL_BAD_ARGUMENT);
    EXPECT_EQ(slAddPrepared(nullptr, prepared, 0, &ids), SL_BAD_ARGUMENT);
    EXPECT_EQ(slAddPrepared(world.world, nullptr, 0, &ids), SL_BAD_ARGUMENT);
    EXPECT_EQ(slAddPrepared(world.world, prepared, 0, nullptr), SL_BAD_ARGUMENT);
    slClosePrepared(prepared);
    slClosePrepared(nullptr);
    EXPECT_EQ(slPreparedMeshes(nullptr), 0u);
    EXPECT_EQ(slPreparedMeshOf(nullptr, 0), UINT32_MAX);
    EXPECT_EQ(slPreparedTriangles(nullptr, 0, &count), nullptr);

    const Array<char> plain =
        *visibilityFile({visible, {}, "house", 5, &places.space, &places.objects}, VisibilityForm::kInPlace);
    ASSERT_EQ(slOpenVisibility(plain.data(), plain.size(), "house", nullptr, &file), SL_OK);
    EXPECT_EQ(slOpenPrepared(file, &prepared), SL_BAD_FILE);
    EXPECT_EQ(slOpenPrepared(file, nullptr), SL_BAD_ARGUMENT);
    EXPECT_EQ(slOpenPrepared(nullptr, &prepared), SL_BAD_ARGUMENT);
    slCloseVisibility(file);
}

}  // namespace
}  // namespace sightline::test
