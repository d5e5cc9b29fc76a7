// The law of turning: double-sided neighbours hang together however they wind in the file.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/orient.h"

#include <gtest/gtest.h>

#include "tests/prepare/occluder/patch_laws.h"

namespace sightline {
namespace {

/// The same triangles, some wound the other way.
Soup turnSome(Soup soup, uint64_t seed) {
    Random random(seed);
    for (size_t t = 0; t < soup.indices.size(); t += 3)
        if (random.below(2)) std::swap(soup.indices[t], soup.indices[t + 1]);
    return soup;
}

TEST(Orient, DoubleSidedSurfacesHangTogetherHoweverTheyWind) {
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        SCOPED_TRACE(seed);
        const Soup soup = turnSome(makeBall(seed, uint32_t(3 * seed)), seed);
        const std::vector<uint8_t> both(soup.indices.size() / 3, 1);
        const Occluder o = prepareOccluder(soup.view(), {}, both, {.own_polygons = 64, .rings = true});
        expectOccluderLaws(o);
        EXPECT_EQ(ownOpenEdges(o), 0u);
        EXPECT_EQ(o.triangleCount(), both.size());
        // What hides on its front alone is left as it is.
        const Occluder one = prepareOccluder(soup.view(), {}, {}, {.own_polygons = 64, .rings = true});
        EXPECT_GT(ownOpenEdges(one), 0u);
    }
}

TEST(Orient, TurnsNoTriangleThatHidesOnOneSide) {
    const Soup soup = turnSome(makeBall(1, 8), 1);
    std::vector<uint8_t> both(soup.indices.size() / 3);
    for (size_t i = 0; i < both.size(); ++i) both[i] = i % 3 != 0;
    const OccluderSource source{soup.view(), {}, both};
    const Patchwork before = weld({&source, 1});
    Patchwork after = before;
    orientDoubleSided(after);
    size_t turned = 0;
    for (size_t i = 0; i < before.polygons.size(); ++i) {
        const uint32_t *p = before.polygons[i].vertex, *q = after.polygons[i].vertex;
        if (std::equal(p, p + 3, q)) continue;
        ++turned;
        EXPECT_TRUE(before.polygons[i].double_sided);
        EXPECT_TRUE(p[0] == q[0] && p[1] == q[2] && p[2] == q[1]);
    }
    EXPECT_GT(turned, 50u);
}

TEST(Orient, AStripOfOneSideIsTakenAsFarAsItGoes) {
    Soup soup;
    constexpr int kPieces = 21;
    const auto at = [](int i, int side) {
        const double a = 6.283185307179586 * (i % kPieces) / kPieces, t = 3.14159265358979 * i / kPieces;
        const double r = 3 + (side ? 1 : -1) * std::cos(t);
        return glm::vec3(r * std::cos(a), (side ? 1 : -1) * std::sin(t), r * std::sin(a));
    };
    for (int i = 0; i < kPieces; ++i) {
        // The last piece meets the first with its sides exchanged: the same positions.
        const bool last = i + 1 == kPieces;
        const glm::vec3 c = last ? at(0, 0) : at(i + 1, 1), d = last ? at(0, 1) : at(i + 1, 0);
        soup.add({at(i, 0), at(i, 1), c});
        soup.add({at(i, 0), c, d});
    }
    const std::vector<uint8_t> both(soup.indices.size() / 3, 1);
    const Occluder o = prepareOccluder(soup.view(), {}, both);
    expectOccluderLaws(o);
    EXPECT_EQ(o.triangleCount(), both.size());
    EXPECT_EQ(ownOpenEdges(o), size_t(2 * kPieces + 2));  // the rim, and one side that no turning closes: two records
}

}  // namespace
}  // namespace sightline
