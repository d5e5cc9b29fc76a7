// What Draco's own encoder packs arrives as the same triangles, and no damaged stream does harm.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <functional>
#include <map>

#include "gltf_draco_packer.h"
#include "gltf_reading.h"
#include "sightline/base/random.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace tools;
namespace {

// Draco's decoder refuses meshes of more vertices than corners, which its encoder writes.
PackedSource withoutUnused(const PackedSource& source) {
    PackedSource out;
    std::map<uint32_t, uint32_t> places;
    for (const uint32_t index : source.indices) {
        const auto [place, fresh] = places.try_emplace(index, uint32_t(places.size()));
        if (fresh)
            out.positions.insert(out.positions.end(), source.positions.begin() + 3 * ptrdiff_t(index),
                                 source.positions.begin() + 3 * ptrdiff_t(index) + 3);
        out.indices.push_back(place->second);
    }
    return out;
}

/// A sheet of quads whose vertices keep a distance of at least half a unit, some triangles cut out; or triangles that
/// share no vertices.
PackedSource randomSource(Random& random) {
    PackedSource source;
    const uint32_t width = 2 + uint32_t(random.below(12)), height = 2 + uint32_t(random.below(12));
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            for (const uint32_t base : {x, y, 0u})
                source.positions.push_back(float(base) + float(random.below(1000)) / 4000);
    const bool soup = random.below(4) == 0;
    const uint64_t kept = 5 + random.below(6);
    for (uint32_t y = 0; y + 1 < height; ++y)
        for (uint32_t x = 0; x + 1 < width; ++x) {
            const uint32_t a = y * width + x, b = a + 1, c = a + width, d = c + 1;
            if (random.below(10) < kept) source.indices.insert(source.indices.end(), {a, b, d});
            if (random.below(10) < kept && !soup) source.indices.insert(source.indices.end(), {a, d, c});
        }
    if (source.indices.empty()) source.indices = {0, 1, width};
    return withoutUnused(source);
}

using Triangle = std::array<uint32_t, 3>;

// Each triangle begins with its smallest corner, so that its winding is kept.
std::vector<Triangle> sortedTriangles(const std::vector<uint32_t>& indices) {
    std::vector<Triangle> out;
    for (size_t i = 0; i < indices.size(); i += 3) {
        Triangle triangle = {indices[i], indices[i + 1], indices[i + 2]};
        std::rotate(triangle.begin(), std::min_element(triangle.begin(), triangle.end()), triangle.end());
        out.push_back(triangle);
    }
    std::sort(out.begin(), out.end());
    return out;
}

/// The triangles of a mesh in terms of the source's vertices, each of which must be within `most`.
std::vector<Triangle> trianglesInTermsOf(const PackedSource& source, const Mesh& mesh, double most) {
    std::vector<uint32_t> original(mesh.positions.size());
    for (size_t i = 0; i < mesh.positions.size(); ++i) {
        double nearest = 1e30;
        for (uint32_t v = 0; v < source.vertices(); ++v) {
            const float* p = &source.positions[3 * v];
            const double distance = glm::length(glm::dvec3(mesh.positions[i]) - glm::dvec3(p[0], p[1], p[2]));
            if (distance < nearest) nearest = distance, original[i] = v;
        }
        EXPECT_LE(nearest, most) << "vertex " << i;
    }
    std::vector<uint32_t> indices;
    for (const uint32_t index : mesh.indices) indices.push_back(original[index]);
    return sortedTriangles(indices);
}

// Quantised on the largest side of the box into 2^bits - 1 steps, each axis by half a step at most.
double quantizationError(const PackedSource& source, int bits) {
    if (bits == 0) return 0;
    Box3d box;
    for (size_t i = 0; i < source.vertices(); ++i)
        box.grow(glm::dvec3(source.positions[3 * i], source.positions[3 * i + 1], source.positions[3 * i + 2]));
    const glm::dvec3 size = box.max - box.min;
    return std::max({size.x, size.y, size.z}) / ((1 << bits) - 1) * 0.5 * std::sqrt(3.0) * 1.01 + 1e-6;
}

TEST(GltfDraco, KeepsEveryTriangleInEveryEncoding) {
    constexpr int kBits[] = {0, 8, 11, 14, 20};
    for (uint64_t seed = 1; seed <= 400; ++seed) {
        Random random(seed);
        const PackedSource source = randomSource(random);
        PackedSettings settings{.edgebreaker = random.below(3) != 0, .valence = random.below(2) != 0};
        settings.quantization = kBits[random.below(5)];
        settings.speed = int(random.below(11));
        GltfBuilder b;
        b.node({{"mesh", addDracoMesh(b, source, settings)}, {"translation", {100, 0, 0}}});
        SCOPED_TRACE("seed " + std::to_string(seed));
        const Scene scene = load(b.glb());
        ASSERT_EQ(scene.meshes.size(), 1u);
        const double error = quantizationError(source, settings.quantization);
        ASSERT_EQ(trianglesInTermsOf(source, scene.meshes[0], error), sortedTriangles(source.indices));
        ASSERT_FALSE(HasFailure());
    }
}

TEST(GltfDraco, DrawsWhatTheUncompressedFileDraws) {
    Random random(7);
    const PackedSource source = randomSource(random);
    GltfBuilder plain;
    const uint32_t positions = plain.accessor<float>("VEC3", source.positions);
    plain.node({{"mesh", plain.mesh(positions, int(plain.accessor<uint32_t>("SCALAR", source.indices)))}});
    const Corners expected = cornersOf(load(plain.glb()), 0);
    GltfBuilder packed;
    packed.node({{"mesh", addDracoMesh(packed, source, {.edgebreaker = false})}});
    EXPECT_EQ(cornersOf(load(packed.glb()), 0), expected) << "sequential, unquantised: not a bit is lost";
}

TEST(GltfDraco, SamplesHoldThePatch) {
    for (const char* name : {"draco_sequential.glb", "draco_sequential_quantized.glb", "draco_edgebreaker.glb",
                             "draco_edgebreaker_quantized.glb", "draco_valence.glb", "draco_normals.glb"}) {
        SCOPED_TRACE(name);
        const Scene scene = loadSample(name);
        ASSERT_EQ(scene.objects.size(), 1u);
        EXPECT_EQ(scene.meshes[0].triangles(), 7u);
        EXPECT_LE(glm::length(scene.meshes[0].bounds.max - glm::dvec3(2, 2, 1)), 0.02);
    }
}

TEST(GltfDraco, SkinsByJointsAndWeightsOfTheStream) {
    const Scene scene = loadSample("draco_skin.glb");
    ASSERT_EQ(scene.objects.size(), 1u);
    EXPECT_TRUE(scene.meshes[0].deforms);
    // The right edge, x = 2, follows the second joint by 5 along z.
    double highest = 0;
    for (const glm::dvec3& corner : cornersOf(scene, 0)) {
        highest = std::max(highest, corner.z);
        EXPECT_NEAR(corner.z - 5 * corner.x / 2, corner.x * corner.y * 0.25, 1e-5);
    }
    EXPECT_NEAR(highest, 6, 1e-5);
}

TEST(GltfDraco, SharesAStreamAmongPrimitives) {
    Random random(3);
    const PackedSource source = randomSource(random);
    GltfBuilder b;
    const uint32_t first = addDracoMesh(b, source);
    Json& mesh = b.json["meshes"][first];
    mesh["primitives"].push_back(mesh["primitives"][0]);
    b.add("meshes", mesh);
    b.node({{"mesh", first}});
    b.node({{"mesh", first + 1}});
    const Scene scene = load(b.glb());
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].triangles(), 2 * source.indices.size() / 3);
    EXPECT_EQ(scene.meshes[1].triangles(), 2 * source.indices.size() / 3);
    EXPECT_EQ(scene.meshes[1].positions.size(), scene.meshes[0].positions.size());
}

// Morph targets are not compressed; they follow the order of the stream's vertices.
TEST(GltfDraco, MorphsWhatItDecoded) {
    const PackedSource source{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, {}, {}, {}};
    GltfBuilder b;
    const uint32_t mesh = addDracoMesh(b, source, {.edgebreaker = false});
    const uint32_t lift = b.accessor<float>("VEC3", {0, 0, 3, 0, 0, 3, 0, 0, 3});
    b.json["meshes"][mesh]["primitives"][0]["targets"] = {{{"POSITION", lift}}};
    b.node({{"mesh", mesh}});
    EXPECT_NEAR(load(b.glb()).meshes.at(0).bounds.max.z, 3, 1e-3);
}

TEST(GltfDraco, TakesUncompressedDataWhereTheFileHasBoth) {
    GltfBuilder b;
    const PackedSource source{{5, 5, 5, 6, 5, 5, 5, 6, 5}, {0, 1, 2}, {}, {}, {}};
    const uint32_t mesh = addDracoMesh(b, source);
    b.json.erase("extensionsRequired");
    const uint32_t plain = b.triangleMesh();
    Json& primitive = b.json["meshes"][mesh]["primitives"][0];
    const Json& other = b.json["meshes"][plain]["primitives"][0];
    primitive["attributes"] = other["attributes"];
    primitive["indices"] = other["indices"];
    b.node({{"mesh", mesh}});
    expectCorners(cornersOf(load(b.glb()), 0), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}});
}

TEST(GltfDraco, ReadsStripsAndPrimitivesWithoutIndices) {
    Random random(5);
    const PackedSource source = randomSource(random);
    GltfBuilder b;
    const uint32_t mesh = addDracoMesh(b, source);
    b.node({{"mesh", mesh}});
    Json& primitive = b.json["meshes"][mesh]["primitives"][0];
    b.json["accessors"][primitive["indices"].get<size_t>()]["count"] = source.indices.size() / 3 + 2;
    primitive["mode"] = 5;
    EXPECT_EQ(load(b.glb()).meshes.at(0).triangles(), source.indices.size() / 3);
    primitive.erase("indices");
    primitive["mode"] = 4;
    EXPECT_EQ(load(b.glb()).meshes.at(0).triangles(), source.indices.size() / 3);
}

// What is wrong with a file of one compressed triangle, once it is spoilt.
std::string faultOfSpoilt(const std::function<void(Json& json, PackedStream& stream)>& spoil) {
    const PackedSource source{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, {}, {}, {}};
    PackedStream stream = packDraco(source, {.edgebreaker = false});
    Json unused;
    spoil(unused, stream);
    GltfBuilder b;
    b.node({{"mesh", addDracoMesh(b, source, stream)}});
    spoil(b.json, stream);
    const Result<Scene> scene = parse(b.glb());
    if (scene.ok()) return "";
    EXPECT_EQ(messageFault(scene.error(), "test.glb"), "");
    return scene.error().message.substr(std::strlen("test.glb: "));
}

TEST(GltfDraco, RefusesInWords) {
    const auto bytes = [](const std::function<void(std::string&)>& spoil) {
        return faultOfSpoilt([&](Json&, PackedStream& stream) { spoil(stream.bytes); });
    };
    const auto json = [](const char* pointer, Json value) {
        return faultOfSpoilt([&](Json& json, PackedStream&) {
            if (!json.is_null()) json[Json::json_pointer(pointer)] = value;
        });
    };
    const std::string place = "meshes[0].primitives[0]: ";
    const char* extension = "/meshes/0/primitives/0/extensions/KHR_draco_mesh_compression";
    const auto in = [&](const char* member) { return std::string(extension) + member; };
    EXPECT_EQ(bytes([](std::string& b) { b = "no stream"; }), place + "its data is not Draco's");
    EXPECT_EQ(bytes([](std::string& b) { b[5] = 1; }), place + "its Draco data is of version 1.2, not 2.2");
    EXPECT_EQ(bytes([](std::string& b) { b[7] = 9; }), place + "its Draco data is of unknown kind 9");
    EXPECT_EQ(bytes([](std::string& b) { b[8] = 7; }), place + "its Draco data is encoded by unknown method 7");
    EXPECT_EQ(bytes([](std::string& b) { b.resize(11); }), place + "its Draco data is truncated");
    EXPECT_EQ(bytes([](std::string& b) { b.resize(b.size() - 1); }), place + "its Draco data is damaged");
    EXPECT_EQ(json("/accessors/1/count", 6), place + "its Draco data has 1 triangles, its indices 2");
    EXPECT_EQ(json("/accessors/0/count", 4), place + "its Draco data has 3 vertices, its accessors 4");
    EXPECT_EQ(json("/accessors/0/type", "VEC2"), place + "its Draco data has 3 components a POSITION, its accessor 2");
    EXPECT_EQ(json("/accessors/1/type", "VEC2"), place + "its indices have 2 components");
    EXPECT_EQ(json("/meshes/0/primitives/0/mode", 6), place + "is a fan, which Draco data cannot be");
    EXPECT_EQ(json(in("/bufferView").c_str(), 7), place + "bufferView 7 is out of range of 1");
    EXPECT_EQ(json(in("/attributes").c_str(), 7), place + "attributes is not an object");
    EXPECT_EQ(json(in("/attributes/POSITION").c_str(), 5), place + "its Draco data has no attribute 5 for POSITION");
    EXPECT_EQ(json(in("/attributes/POSITION").c_str(), 5e9),
              place + "POSITION 5000000000 is no id of a Draco attribute");
    const PackedSource points{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {}, {}, {}, {}};
    EXPECT_EQ(bytes([&](std::string& b) { b = packDracoPoints(points); }),
              place + "its Draco data is a point cloud, not triangles");
}

TEST(GltfDraco, SurvivesTruncationAtEveryLength) {
    for (const Sample& sample : gltfSamples()) {
        if (!sample.name.starts_with("draco_")) continue;
        for (size_t length = 0; length < sample.bytes.size(); ++length) {
            const Result<Scene> result = parse(sample.bytes.substr(0, length));
            ASSERT_FALSE(result.ok()) << sample.name << " cut to " << length << " bytes";
            ASSERT_EQ(messageFault(result.error(), "test.glb"), "") << result.error().message;
        }
    }
}

// Bytes of the stream alone, so that every case reaches the decoder.
TEST(GltfDraco, SurvivesDamagedStreams) {
    size_t read = 0;
    for (uint64_t seed = 1; seed <= 5000; ++seed) {
        Random random(seed);
        const PackedSource source = randomSource(random);
        PackedStream stream = packDraco(source, {.edgebreaker = random.below(3) != 0,
                                                 .quantization = random.below(2) ? 10 : 0,
                                                 .speed = int(random.below(11)),
                                                 .valence = random.below(2) != 0});
        for (uint64_t left = 1 + random.below(4); left-- > 0;)
            stream.bytes[11 + random.below(stream.bytes.size() - 11)] = char(random.next());
        GltfBuilder b;
        b.node({{"mesh", addDracoMesh(b, source, stream)}});
        const Result<Scene> scene = parse(b.glb());
        read += scene.ok();
        ASSERT_EQ(scene.ok() ? sceneFault(*scene) : messageFault(scene.error(), "test.glb"), "") << "seed " << seed;
    }
    EXPECT_GT(read, 0u) << "damage to values alone goes unnoticed, as in uncompressed data";
}

// A smooth height field takes a sixth of a byte a triangle: honest data is not taken for a bomb.
TEST(GltfDraco, UnpacksWhatIsPackedTight) {
    constexpr uint32_t kSide = 500;
    PackedSource source;
    for (uint32_t y = 0; y < kSide; ++y)
        for (uint32_t x = 0; x < kSide; ++x)
            source.positions.insert(source.positions.end(), {float(x), float(y), float(std::sin(x * 0.01) * 20)});
    for (uint32_t y = 0; y + 1 < kSide; ++y)
        for (uint32_t x = 0; x + 1 < kSide; ++x) {
            const uint32_t a = y * kSide + x, b = a + kSide;
            source.indices.insert(source.indices.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    GltfBuilder b;
    b.node({{"mesh", addDracoMesh(b, source, {.quantization = 14, .speed = 3})}});
    const std::string bytes = b.glb();
    EXPECT_LT(bytes.size(), 100'000u);
    EXPECT_EQ(load(bytes).meshes.at(0).triangles(), source.indices.size() / 3);
}

double surfaceOf(const Mesh& mesh) {
    double area = 0;
    for (size_t i = 0; i < mesh.indices.size(); i += 3) {
        const glm::dvec3 a = mesh.positions[mesh.indices[i]], b = mesh.positions[mesh.indices[i + 1]],
                         c = mesh.positions[mesh.indices[i + 2]];
        area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return area;
}

// Draco leaves out triangles without an area, so surfaces are compared.
TEST(GltfDraco, KeepsTheSurfacesOfARealScene) {
    const auto plain = sharedScene("sauer-pandora");
    if (!plain) GTEST_SKIP() << "no scenes beside the repository";
    GltfBuilder b;
    for (const Mesh& mesh : plain->meshes) {
        PackedSource source;
        for (const glm::vec3& p : mesh.positions) source.positions.insert(source.positions.end(), {p.x, p.y, p.z});
        source.indices = mesh.indices;
        b.node({{"mesh", addDracoMesh(b, source, {.quantization = 20})}});
    }
    const Scene packed = load(b.glb());
    ASSERT_EQ(packed.meshes.size(), plain->meshes.size());
    for (size_t i = 0; i < packed.meshes.size(); ++i) {
        const Box3d &was = plain->meshes[i].bounds, &is = packed.meshes[i].bounds;
        const double size = glm::length(was.max - was.min);
        EXPECT_LE(glm::length(is.min - was.min) + glm::length(is.max - was.max), 1e-5 * size) << "mesh " << i;
        const double area = surfaceOf(plain->meshes[i]);
        EXPECT_NEAR(surfaceOf(packed.meshes[i]), area, 1e-3 * area + 1e-5 * size * size) << "mesh " << i;
    }
}

// Some dozen bytes that claim a billion triangles, and indices that agree: refused before the library allocates.
TEST(GltfDraco, RefusesClaimsOutOfProportion) {
    const PackedSource source{{0, 0, 0, 1, 0, 0, 0, 1, 0}, {0, 1, 2}, {}, {}, {}};
    const std::string varint = "\xff\xff\xff\xff\x03";  // 2^30 - 1
    PackedStream stream;
    stream.triangles = (1 << 30) - 1;
    stream.vertices = 3;
    stream.bytes = std::string("DRACO\x02\x02\x01\x01\x00\x00", 11) + std::string(1, '\0') + "\x03" + varint +
                   std::string(1, '\0') + varint + std::string(1, '\0') + std::string(100, '\x55');
    GltfBuilder b;
    b.node({{"mesh", addDracoMesh(b, source, stream)}});
    const Result<Scene> scene = parse(b.glb());
    ASSERT_FALSE(scene.ok());
    EXPECT_NE(scene.error().message.find("times the memory"), std::string::npos) << scene.error().message;
}

}  // namespace
}  // namespace sightline::test
