// The stream of a scene: what is written is read again, and nothing else is believed.
// SPDX-License-Identifier: MIT
#include <cstring>
#include <iterator>
#include <limits>
#include <string>

#include <gtest/gtest.h>

#include "gltf_check.h"
#include "scene_stream_samples.h"
#include "sightline/base/random.h"
#include "sightline/tools/import/foreign/scene_stream.h"
#include "tests/support/corpus.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

SceneStream parse(const std::string& bytes) {
    return parseSceneStream({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
}

TEST(SceneStream, GivesBackWhatWasWritten) {
    const Scene scene = sampleScene();
    const SceneStream read = parse(streamOf(scene));
    ASSERT_EQ(read.end, SceneStream::End::kWhole) << read.what;
    EXPECT_EQ(sceneFault(read.scene), "");
    ASSERT_EQ(read.scene.meshes.size(), scene.meshes.size());
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        EXPECT_EQ(read.scene.meshes[i].name, scene.meshes[i].name);
        EXPECT_EQ(read.scene.meshes[i].positions, scene.meshes[i].positions);
        EXPECT_EQ(read.scene.meshes[i].indices, scene.meshes[i].indices);
        EXPECT_EQ(read.scene.meshes[i].deforms, scene.meshes[i].deforms);
        EXPECT_EQ(read.scene.meshes[i].primitives.size(), scene.meshes[i].primitives.size());
    }
    EXPECT_EQ(read.scene.meshes[1].bounds.max, glm::dvec3(9));
    ASSERT_EQ(read.scene.objects.size(), scene.objects.size());
    for (size_t i = 0; i < scene.objects.size(); ++i) {
        EXPECT_EQ(read.scene.objects[i].key, i);
        EXPECT_EQ(read.scene.objects[i].transform, scene.objects[i].transform);
        EXPECT_EQ(objectPath(read.scene, read.scene.objects[i]), objectPath(scene, scene.objects[i]));
    }
    ASSERT_EQ(read.scene.materials.size(), 2u);
    EXPECT_EQ(read.scene.materials[1].alpha_mode, AlphaMode::kBlend);
    EXPECT_TRUE(read.scene.materials[1].double_sided);
    EXPECT_EQ(read.scene.materials[0].base_color, scene.materials[0].base_color);
    ASSERT_EQ(read.scene.cameras.size(), 2u);
    EXPECT_EQ(read.scene.cameras[0].fov_y, 1);
    EXPECT_EQ(read.scene.cameras[0].z_far, 100);
    EXPECT_FALSE(read.scene.cameras[1].z_far);
    ASSERT_EQ(read.scene.rooms.size(), 2u);
    EXPECT_EQ(roomPath(read.scene, read.scene.rooms[0]), "House/Room");
    EXPECT_EQ(read.scene.rooms[0].bounds.max, glm::dvec3(2));
    EXPECT_TRUE(read.scene.rooms[1].bounds.empty());
    EXPECT_EQ(read.part, "the last part");
    EXPECT_EQ(read.notes, std::vector<std::string>{"something"});
}

TEST(SceneStream, EachCutOfItIsNoScene) {
    const std::string whole = streamOf(sampleScene());
    for (size_t size = 0; size < whole.size(); ++size)
        EXPECT_EQ(parse(whole.substr(0, size)).end, SceneStream::End::kCut) << size;
}

TEST(SceneStream, AFaultTakesTheScenesPlace) {
    std::string bytes;
    SceneStreamWriter writer(
        [&](const void* data, size_t size) { bytes.append(static_cast<const char*>(data), size); });
    writer.material({});
    writer.fault("line 7: no such thing");
    const SceneStream read = parse(bytes);
    EXPECT_EQ(read.end, SceneStream::End::kFault);
    EXPECT_EQ(read.what, "line 7: no such thing");
}

TEST(SceneStream, RefusesScenesThatDoNotHold) {
    const auto expectBroken = [](const char* what, auto&& spoil) {
        Scene scene = sampleScene();
        spoil(scene);
        const SceneStream read = parse(streamOf(scene));
        EXPECT_EQ(read.end, SceneStream::End::kBroken) << what;
        EXPECT_NE(read.what.find(what), std::string::npos) << read.what;
        EXPECT_TRUE(read.scene.objects.empty());
    };
    const float nan = std::numeric_limits<float>::quiet_NaN();
    expectBroken("index", [](Scene& s) { s.meshes[0].indices[2] = 99; });
    expectBroken("position", [&](Scene& s) { s.meshes[0].positions[1].y = nan; });
    expectBroken("triangles", [](Scene& s) { s.meshes[0].indices.clear(); });
    expectBroken("gap", [](Scene& s) { s.meshes[0].primitives[0].first_triangle = 1; });
    expectBroken("cover", [](Scene& s) { s.meshes[0].primitives[0].triangle_count = 2; });
    expectBroken("material", [](Scene& s) { s.meshes[0].primitives[0].material = 5; });
    expectBroken("bounds", [&](Scene& s) { s.meshes[1].bounds.max.x = nan; });
    expectBroken("mesh", [](Scene& s) { s.objects[0].mesh = 7; });
    expectBroken("node", [](Scene& s) { s.objects[0].node = 7; });
    expectBroken("parent", [](Scene& s) { s.nodes[1].parent = 1; });
    expectBroken("affine", [](Scene& s) { s.objects[0].transform[0][3] = 1; });
    expectBroken("affine", [&](Scene& s) { s.objects[0].transform[3][0] = nan; });
    expectBroken("large", [](Scene& s) { s.objects[0].transform[0][0] = 1e200; });
    expectBroken("neither", [](Scene& s) { s.cameras[0].orthographic_height = 1; });
    expectBroken("nowhere", [](Scene& s) { s.cameras[0].transform[1] = s.cameras[0].transform[2]; });
    expectBroken("near", [](Scene& s) { s.cameras[0].z_near = -1; });
    expectBroken("colour", [&](Scene& s) { s.materials[0].base_color.r = nan; });
    expectBroken("node", [](Scene& s) { s.rooms[0].node = 7; });
    expectBroken("bounds", [](Scene& s) { s.rooms[0].bounds.max.x = 1e200; });
    expectBroken("object", [](Scene& s) { s.objects.clear(); });
}

TEST(SceneStream, BelievesNoLengthBeforeTheBytesAreThere) {
    std::string bytes = streamOf(sampleScene());
    const size_t name = bytes.find("first mesh");
    ASSERT_NE(name, std::string::npos);
    // Before the name: its length, the bounds, a flag, three counts; and the record's size before these.
    for (const size_t back : {4 + 48 + 1 + 8, 4 + 48 + 1 + 16, 4 + 48 + 1 + 24, 4 + 48 + 1 + 32})
        for (const uint64_t lie : {~uint64_t(0), uint64_t(1) << 62, uint64_t(1) << 40, uint64_t(1) << 31}) {
            std::string changed = bytes;
            std::memcpy(changed.data() + name - back, &lie, sizeof lie);
            EXPECT_NE(parse(changed).end, SceneStream::End::kWhole);
        }
}

TEST(SceneStream, EndsWhereItIsTooLong) {
    const std::string whole = streamOf(sampleScene());
    std::string_view rest = whole;
    const ByteSource source = [&](unsigned char* to, size_t size) {
        const size_t part = std::min({size, rest.size(), size_t(7)});
        std::memcpy(to, rest.data(), part);
        rest.remove_prefix(part);
        return part;
    };
    EXPECT_EQ(readSceneStream(source, whole.size() - 1, {}).end, SceneStream::End::kLarge);
    rest = whole;
    EXPECT_EQ(readSceneStream(source, whole.size(), {}).end, SceneStream::End::kWhole);
}

TEST(SceneStream, WhateverItsBytesTheSceneHolds) {
    const std::string whole = streamOf(sampleScene());
    size_t scenes = 0;
    for (uint64_t seed = 0; seed < 20000; ++seed) {
        Random random(seed);
        std::string bytes = whole;
        for (uint64_t n = 1 + random.below(3); n-- > 0;)
            bytes[random.below(bytes.size())] =
                static_cast<char>(random.below(4) ? random.below(256) : random.below(2) * 255);
        const SceneStream read = parse(bytes);
        if (read.end != SceneStream::End::kWhole) continue;
        ++scenes;
        ASSERT_EQ(sceneFault(read.scene), "") << "seed " << seed;
    }
    EXPECT_GT(scenes, 1000u);
}

TEST(SceneStream, TheFuzzersCorpusHolds) {
    test::forCorpus("scene_stream", 4, [](const std::string& name, const std::string& bytes) {
        const SceneStream read = parse(bytes);
        if (read.end == SceneStream::End::kWhole) EXPECT_EQ(sceneFault(read.scene), "") << name;
        else EXPECT_TRUE(read.scene.objects.empty()) << name << ": a scene is left";
    });
}

}  // namespace
}  // namespace sightline
