// Clusters, levels of detail, the buffer alone and matrices, through C.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <set>

#include <glm/gtc/constants.hpp>

#include "tests/c/c_twin.h"

namespace sightline::test {
namespace {

/// A ball in the unit box.
TestMesh ballMesh(uint32_t rings) {
    TestMesh mesh;
    for (uint32_t ring = 0; ring <= rings; ++ring)
        for (uint32_t k = 0; k < 2 * rings; ++k) {
            const double theta = glm::pi<double>() * ring / rings, phi = glm::pi<double>() * k / rings;
            mesh.positions.emplace_back(0.5 + 0.5 * std::sin(theta) * std::cos(phi), 0.5 + 0.5 * std::cos(theta),
                                        0.5 - 0.5 * std::sin(theta) * std::sin(phi));
        }
    mesh.addGrid(2 * rings, rings + 1, true);
    return mesh;
}

TEST(CClusters, DrawWhatIsTurnedToTheEye) {
    const TestMesh mesh = ballMesh(40);
    const size_t triangles = mesh.indices.size() / 3;
    slClustersDef def = slDefaultClustersDef();
    def.mesh = meshOf(mesh);
    slClusters* clusters = nullptr;
    ASSERT_EQ(slPrepareClusters(&def, &clusters), SL_OK);
    size_t count = 0;
    const uint32_t* const order = slClusterTriangles(clusters, &count);
    ASSERT_EQ(count, triangles);
    EXPECT_EQ(std::set<uint32_t>(order, order + count).size(), triangles);
    CWorld world;
    slClustersId id{};
    ASSERT_EQ(slAddClusters(world.world, clusters, &id), SL_OK);
    slDestroyClusters(clusters);
    slObjectDef object = slDefaultObjectDef();
    object.bounds = {{0, 0, 0}, {1, 1, 1}};
    object.clusters = id;
    ASSERT_EQ(slAddObject(world.world, &object, nullptr), SL_OK);
    const CQuery query(world);
    const slVisibleSet set = query.ask(viewOf(viewAt({0.5, 0.5, 5}, {0.5, 0.5, 0.5})));
    ASSERT_EQ(set.count, 1u);
    uint32_t drawn = 0;
    for (uint32_t i = 0; i < set.range_count; ++i) drawn += set.ranges[i].count;
    EXPECT_GT(drawn, triangles / 4);
    EXPECT_LT(drawn, triangles * 9 / 10);
    const auto most = static_cast<uint32_t>(triangles);
    const slMeshPart twice[] = {{0, 8, false, true}, {7, 4, false, true}};
    def.parts = twice;
    def.part_count = 2;
    def.log = slSilence();
    EXPECT_EQ(slPrepareClusters(&def, &clusters), SL_BAD_ARGUMENT);
    const slMeshPart beyond = {most - 4, 5, false, true};
    def.parts = &beyond;
    def.part_count = 1;
    def.log = slSilence();
    EXPECT_EQ(slPrepareClusters(&def, &clusters), SL_BAD_ARGUMENT);
}

TEST(CLods, AreChosenByTheirError) {
    CWorld world;
    const slLod levels[] = {{0, 1000, 600}, {0.01, 100, 60}};
    slLodsId id{};
    ASSERT_EQ(slAddLods(world.world, levels, 2, &id), SL_OK);
    slObjectDef object = slDefaultObjectDef();
    object.bounds = {{0, 0, 0}, {1, 1, 1}};
    object.lods = id;
    ASSERT_EQ(slAddObject(world.world, &object, nullptr), SL_OK);
    const CQuery query(world);
    slQuerySettings settings = slDefaultQuerySettings();
    settings.lod_error = 1;
    const slVisibleSet far = query.ask(viewOf(viewAt({0.5, 0.5, 200}, {0.5, 0.5, 0.5})), &settings);
    ASSERT_EQ(far.count, 1u);
    ASSERT_NE(far.lods, nullptr);
    EXPECT_EQ(far.lods[0].level, 1);
}

TEST(CBuffer, AnswersAsItsImageShows) {
    slBuffer* buffer = nullptr;
    ASSERT_EQ(slCreateBuffer(320, nullptr, &buffer), SL_OK);
    slOccluder* const cube = prepared(boxMesh());
    const slView view = viewOf(viewAt({0.5, 0.5, 6}, {0.5, 0.5, 0.5}));
    ASSERT_EQ(slBufferBegin(buffer, &view), SL_OK);
    uint32_t triangles = 0;
    ASSERT_EQ(slBufferDraw(buffer, cube, nullptr, &triangles), SL_OK);
    EXPECT_GT(triangles, 0u);
    std::vector<slBox> boxes;
    std::vector<uint8_t> seen(200, 9);
    for (size_t i = 0; i < seen.size(); ++i)
        boxes.push_back({{0.4, 0.4, -3.0 - double(i)}, {0.6, 0.6, -2.0 - double(i)}});
    boxes.back() = {{4, 4, 4}, {4.1, 4.1, 4.1}};
    ASSERT_EQ(slBufferAsk(buffer, boxes.data(), boxes.size(), seen.data()), SL_OK);
    for (size_t i = 0; i + 1 < seen.size(); ++i) EXPECT_EQ(seen[i], SL_HIDDEN) << i;
    EXPECT_EQ(seen.back(), SL_OUTSIDE);
    slSeen one = SL_OUTSIDE;
    ASSERT_EQ(slBufferAskOriented(buffer, boxes.data(), nullptr, &one), SL_OK);
    EXPECT_EQ(one, SL_HIDDEN);
    const slBox huge = {{-1e300, -1e300, -1e300}, {1e300, 1e300, 1e300}};
    ASSERT_EQ(slBufferAskOriented(buffer, &huge, nullptr, &one), SL_OK);
    EXPECT_EQ(one, SL_SEEN);
    slDepthImage image;
    ASSERT_EQ(slBufferImage(buffer, &image), SL_OK);
    const size_t middle = size_t{image.height / 2} * image.width + image.width / 2;
    EXPECT_EQ(image.covered[middle], 1);
    EXPECT_EQ(image.covered[0], 0);
    EXPECT_TRUE(image.perspective);
    EXPECT_NEAR(1.0 / image.nearness[middle], 5.0, 0.1);
    const double transposed[16] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, -10, 0, 0, 0, 1};
    EXPECT_EQ(slBufferDraw(buffer, cube, transposed, nullptr), SL_BAD_ARGUMENT);
    EXPECT_EQ(slBufferAskOriented(buffer, boxes.data(), transposed, &one), SL_BAD_ARGUMENT);
    // After a view that cannot be used the buffer is empty: what was drawn may be gone.
    slView broken = view;
    broken.width = 0;
    EXPECT_EQ(slBufferBegin(buffer, &broken), SL_BAD_ARGUMENT);
    slDestroyOccluder(cube);
    ASSERT_EQ(slBufferImage(buffer, &image), SL_OK);
    EXPECT_EQ(image.width, 0u);
    ASSERT_EQ(slBufferAsk(buffer, boxes.data(), 1, seen.data()), SL_OK);
    EXPECT_EQ(seen[0], SL_SEEN);
    slDestroyBuffer(buffer);
}

TEST(CView, MatricesAreTheLibrarys) {
    const double eye[] = {1, 2, 3}, target[] = {4, 5, 7}, up[] = {0, 1, 0};
    double m[16];
    slLookAt(m, eye, target, up);
    const glm::dmat4 view = lookAt({1, 2, 3}, {4, 5, 7}, {0, 1, 0});
    EXPECT_EQ(std::memcmp(m, &view, sizeof m), 0);
    slPerspective(m, 1.1, 1.5, 0.2, 80);
    const glm::dmat4 projection = perspective(1.1, 1.5, 0.2, 80);
    EXPECT_EQ(std::memcmp(m, &projection, sizeof m), 0);
    slOrthographic(m, 4, 1.5, 0.2, 80);
    const glm::dmat4 parallel = orthographic(4, 1.5, 0.2, 80);
    EXPECT_EQ(std::memcmp(m, &parallel, sizeof m), 0);
    EXPECT_EQ(slViewProblem(nullptr) != nullptr, true);
}

}  // namespace
}  // namespace sightline::test
