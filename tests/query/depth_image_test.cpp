// What the occlusion buffer claims to be covered is covered, sample by sample; seams resolved.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/occluder.h"
#include "sightline/query/query.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/views.h"

namespace sightline::test {
using namespace studies;
namespace {

/// A rough sheet of so many vertices a side.
TestMesh roughSheet(Random& random, uint32_t side) {
    TestMesh mesh;
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x)
            mesh.positions.push_back(
                {float(x) / float(side - 1), 0.2f * float(random.uniform(0, 1)), 1 - float(y) / float(side - 1)});
    mesh.addGrid(side, side);
    return mesh;
}

/// Turned, stretched, and mirrored or not.
glm::dmat4 anyhow(Random& random) {
    glm::dmat4 t(1.0);
    const glm::dvec3 x = randomUnit(random), z = glm::normalize(glm::cross(x, randomUnit(random)));
    t[0] = glm::dvec4(random.uniform(1, 6) * x, 0);
    t[1] = glm::dvec4(random.uniform(1, 6) * glm::cross(z, x), 0);
    t[2] = glm::dvec4((random.below(2) ? -1.0 : 1.0) * random.uniform(1, 6) * z, 0);
    t[3] = glm::dvec4(randomVector(random, 2.0), 1);
    return t;
}

/// Of two triangles that share an edge, one that is seen from behind may be drawn and the other not: then the edge is a
/// border, and there is no seam to close.
TEST(DepthImages, ClaimNoPixelThatSamplesSeeThrough) {
    constexpr uint32_t kSamples = 6;
    size_t covered = 0, through = 0;
    for (const double share : {0.0, 0.5, 0.8, 1.0})  // of triangles that have two sides
        for (uint64_t seed = 1; seed <= rounds(30, 6); ++seed) {
            Random random(seed);
            const TestMesh mesh = roughSheet(random, seed % 3 == 0 ? 3 : seed % 3 == 1 ? 8 : 15);
            std::vector<uint8_t> double_sided(mesh.indices.size() / 3);
            for (uint8_t& both : double_sided) both = random.uniform() < share;
            const glm::dmat4 transform = anyhow(random);
            World world;
            ObjectDef sheet, behind;
            sheet.bounds = {glm::dvec3(0.0), glm::dvec3(1.0)};
            sheet.transform = transform;
            sheet.occluder = world.addOccluder(prepareOccluder(mesh.view(), {}, double_sided));
            world.add(sheet);
            behind.bounds = {{-150, -150, -200}, {150, 150, -199}};  // for which it is drawn
            world.add(behind);
            View view = viewFrom({0, 0, 9}, {0, 0, -1}, {60, 384, 216, 0.05});
            view.jitter = 0;
            Query query;
            query.visible(world.commit(), view, {.stateless = true});
            const Query::DepthImage image = query.depthImage(true);
            ASSERT_EQ(image.width, 384u);
            DrawItem item;
            item.mesh = mesh.view();
            item.double_sided = double_sided;
            item.transform = transform;
            item.id = 0;
            const ZBufferImage truth =
                renderZBuffer(std::vector<DrawItem>{item}, view, {.samples = kSamples, .want_generated = false});
            for (uint32_t y = 0; y < kSamples * image.height; ++y)
                for (uint32_t x = 0; x < kSamples * image.width; ++x) {
                    if (!image.covered[size_t{y / kSamples} * image.width + x / kSamples]) continue;
                    ++covered;
                    through += truth.id[size_t{y} * truth.width + x] != 0;
                }
        }
    EXPECT_EQ(through, 0u);
    EXPECT_GT(covered, 1'000'000u);
}

}  // namespace
}  // namespace sightline::test
