// Each triangle ends with a corner that speaks for it alone, and is still the same triangle.
// SPDX-License-Identifier: MIT
#include "apps/gl/provoking.h"

#include <gtest/gtest.h>

#include <limits>

#include "sightline/base/random.h"
#include "tests/support/meshes.h"

namespace sightline::test {
using namespace studies;
namespace {

struct Mesh : test::TestMesh {
    std::vector<uint8_t> double_sided, writes_depth;

    DrawItem item() const { return {.mesh = view(), .double_sided = double_sided, .writes_depth = writes_depth}; }
};

Mesh randomMesh(uint64_t seed) {
    Random random(seed);
    Mesh mesh;
    const uint32_t vertices = 3 + static_cast<uint32_t>(random.uniform(0, 20));
    const uint32_t triangles = static_cast<uint32_t>(random.uniform(0, 60));
    for (uint32_t i = 0; i < vertices; ++i) mesh.positions.emplace_back(random.uniform(-1, 1), 0, 0);
    if (seed % 3 == 0) mesh.positions[0].y = std::numeric_limits<float>::quiet_NaN();
    for (uint32_t t = 0; t < triangles; ++t) {
        for (int k = 0; k < 3; ++k) mesh.indices.push_back(static_cast<uint32_t>(random.uniform(0, vertices)));
        mesh.double_sided.push_back(random.uniform(0, 1) < 0.5);
        mesh.writes_depth.push_back(random.uniform(0, 1) < 0.8);
    }
    return mesh;
}

TEST(Provoking, GivesEachTriangleACornerOfItsOwn) {
    for (uint64_t seed = 1; seed <= 300; ++seed) {
        const Mesh mesh = randomMesh(seed);
        const DrawItem item = mesh.item();
        const ProvokingMesh made = makeProvoking(item);
        ASSERT_EQ(made.position.size(), made.triangle.size());
        std::vector<int> times(item.mesh.triangles(), 0);
        for (const bool both : {false, true}) {
            const std::vector<uint32_t>& list = both ? made.double_sided : made.single;
            ASSERT_EQ(list.size() % 3, 0u);
            for (size_t i = 0; i < list.size(); i += 3) {
                const uint32_t t = made.triangle[list[i + 2]];
                ASSERT_LT(t, times.size()) << "seed " << seed;
                ++times[t];
                EXPECT_EQ(mesh.double_sided[t] != 0, both) << "seed " << seed;
                // The same corners in the same turn.
                uint32_t corners[3];
                for (size_t k = 0; k < 3; ++k) corners[k] = made.position[list[i + k]];
                bool same = false;
                for (size_t turn = 0; turn < 3; ++turn) {
                    bool fits = true;
                    for (size_t k = 0; k < 3; ++k) fits = fits && corners[k] == mesh.indices[3 * t + (k + turn) % 3];
                    same = same || fits;
                }
                EXPECT_TRUE(same) << "seed " << seed << ", triangle " << t;
            }
        }
        for (size_t t = 0; t < times.size(); ++t) {
            bool finite = true;
            for (size_t k = 0; k < 3; ++k) finite = finite && mesh.positions[mesh.indices[3 * t + k]].y == 0;
            EXPECT_EQ(times[t], mesh.writes_depth[t] != 0 && finite ? 1 : 0) << "seed " << seed << ", triangle " << t;
        }
    }
}

TEST(Provoking, DoublesNoVertexOfALongStrip) {
    Mesh mesh;
    for (int i = 0; i < 102; ++i) mesh.positions.emplace_back(i, i % 2, 0);
    for (uint32_t t = 0; t < 100; ++t) mesh.indices.insert(mesh.indices.end(), {t, t + 1, t + 2});
    EXPECT_EQ(makeProvoking(mesh.item()).position.size(), mesh.positions.size());
}

}  // namespace
}  // namespace sightline::test
