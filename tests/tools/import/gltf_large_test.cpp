// Large files load whole, tell their progress and take little memory beside the scene.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <functional>

#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fmt/format.h>

#include "gltf_reading.h"
#include "sightline/base/sanitized.h"

namespace sightline::test {
using namespace tools;
namespace {

constexpr uint32_t kParts = 99;    // of a level
constexpr uint32_t kLevels = 100;  // of a building
constexpr uint32_t kNodes = kSanitized ? 100'010 : 1'000'100;
constexpr uint32_t kBuilding = 1 + kLevels * (1 + kParts);  // nodes

/// A file of a test, gone afterwards.
struct File {
    std::filesystem::path path;

    explicit File(const std::string& name)
        : path(std::filesystem::temp_directory_path() / fmt::format("sightline_{}_{}", ::getpid(), name)) {}
    ~File() {
        std::error_code ignored;
        std::filesystem::remove(path, ignored);
    }
    uint64_t size() const { return std::filesystem::file_size(path); }
};

std::string children(uint32_t first, uint32_t count, uint32_t step) {
    std::string out = fmt::format("[{}", first);
    for (uint32_t i = 1; i < count; ++i) out += fmt::format(",{}", first + i * step);
    return out + "]";
}

// Buildings of levels of parts: as deep as such models are, and each node has a name.
std::string node(uint32_t index) {
    const uint32_t building = index / kBuilding, in_building = index % kBuilding;
    if (in_building == 0)
        return fmt::format(R"({{"name":"Building {}","translation":[{},0,0],"children":{}}})", building, building * 50,
                           children(index + 1, kLevels, 1 + kParts));
    const uint32_t level = (in_building - 1) / (1 + kParts), part = (in_building - 1) % (1 + kParts);
    if (part == 0)
        return fmt::format(R"({{"name":"Level {}","translation":[0,{},0],"children":{}}})", level, level * 3,
                           children(index + 1, kParts, 1));
    return fmt::format(R"({{"mesh":{},"name":"Assembly {} / part {:06}","translation":[{:.3f},0.125,{:.3f}]}})",
                       part % 3, level, part, (part - 1) * 0.25, (part - 1) * 0.5);
}

void writeMillion(const std::filesystem::path& path) {
    GltfBuilder b;
    for (const char* name : {"box", "panel", "beam"}) b.json["meshes"][b.triangleMesh()]["name"] = name;
    b.json["scenes"] = {{{"nodes", Json::array()}}};
    for (uint32_t i = 0; i < kNodes; i += kBuilding) b.json["scenes"][0]["nodes"].push_back(i);
    std::string text = b.gltf();
    text.pop_back();
    std::ofstream out(path, std::ios::binary);
    out << text << R"(,"nodes":[)";
    for (uint32_t i = 0; i < kNodes; ++i) out << (i ? "," : "") << node(i);
    out << "]}";
}

/// The most memory that a process of its own held while it did this; below 0: it did not end well. [bytes]
int64_t peakMemory(const std::function<bool()>& work) {
    const pid_t child = ::fork();
    if (child == 0) ::_exit(work() ? 0 : 1);
    int status = 0;
    rusage used{};
    if (child < 0 || ::wait4(child, &status, 0, &used) != child || status != 0) return -1;
    return int64_t(used.ru_maxrss) * 1024;
}

TEST(GltfLarge, MillionNodesTakeSixTimesTheFileBesideTheScene) {
    const File file("million.gltf");
    writeMillion(file.path);
    const int64_t before = peakMemory([] { return true; });
    const int64_t peak = peakMemory([&] { return loadGltf(file.path.string()).ok(); });
    ASSERT_GT(before, 0);
    ASSERT_GT(peak, 0) << "does not load";
    if (kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
    constexpr int64_t kName = 48;  // that is too long for a string's own place, as malloc counts
    const int64_t scene = int64_t(kNodes) * int64_t(sizeof(SceneNode) + sizeof(SceneObject) + 2 * kName);
    EXPECT_LE(peak - before - scene, 6 * int64_t(file.size()));
    RecordProperty("peak_bytes", std::to_string(peak));
}

TEST(GltfLarge, MillionNodesArriveWithTheirPaths) {
    const File file("million.gltf");
    writeMillion(file.path);
    size_t calls = 0, last = 0;
    const Result<Scene> scene = loadGltf(file.path.string(), [&](size_t done, size_t total) {
        EXPECT_LT(last, done);
        EXPECT_LE(done, total);
        last = done;
        ++calls;
    });
    ASSERT_TRUE(scene.ok()) << scene.error().message;
    EXPECT_GT(calls, 50u);
    EXPECT_LE(calls, 1000u);
    ASSERT_EQ(scene->nodes.size(), kNodes);
    EXPECT_EQ(scene->meshes.size(), 3u);
    EXPECT_EQ(scene->objects.size(), uint64_t(kNodes / kBuilding) * kLevels * kParts);
    const SceneObject& object =
        scene->objects[kParts * kLevels + 3 * kParts + 7];  // the second building's fourth level
    EXPECT_EQ(objectPath(*scene, object), "Building 1/Level 3/Assembly 3 / part 000008");
    EXPECT_EQ(object.key, kBuilding + 1 + 3 * (1 + kParts) + 1 + 7u);
    EXPECT_EQ(glm::dvec3(object.transform[3]), glm::dvec3(50 + 7 * 0.25, 9.125, 3.5));
}

// Most of a GLB is pictures: what no triangle needs is not read.
TEST(GltfLarge, ReadsOnlyTheBytesThatTrianglesNeed) {
    const File file("pictures.glb");
    constexpr uint64_t kPictures = uint64_t(1) << 30;
    GltfBuilder b = GltfBuilder::triangle();
    b.json["buffers"] = {{{"byteLength", b.bytes.size() + kPictures}}};
    std::string glb = b.glb();
    const auto lengthen = [&](size_t at) {
        uint32_t length = 0;
        std::memcpy(&length, &glb[at], sizeof length);
        length += uint32_t(kPictures);
        std::memcpy(&glb[at], &length, sizeof length);
    };
    lengthen(8);
    lengthen(20 + *reinterpret_cast<const uint32_t*>(&glb[12]));
    std::ofstream(file.path, std::ios::binary) << glb;
    std::filesystem::resize_file(file.path, glb.size() + kPictures);  // a hole, which takes no disk
    const int64_t before = peakMemory([] { return true; });
    const int64_t peak = peakMemory([&] { return loadGltf(file.path.string()).ok(); });
    ASSERT_GT(peak, 0) << "does not load";
    if (kSanitized) GTEST_SKIP() << "sanitizers hold memory of their own";
    EXPECT_LE(peak - before, 64 << 20);
}

}  // namespace
}  // namespace sightline::test
