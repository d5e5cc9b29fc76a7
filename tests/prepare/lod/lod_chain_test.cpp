// The laws of chains of levels of detail: what falls, what rises, what an error promises, and what stays whole.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/lod/lod_chain.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <map>
#include <set>
#include <tuple>

#include "tests/prepare/lod/sampled_distance.h"
#include "tests/prepare/occluder/patch_laws.h"
#include "tests/support/memory.h"
#include "tests/support/random.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
namespace {

using test::TestMesh;

std::vector<uint32_t> allOf(const LodChain& chain, uint32_t level) {
    std::vector<uint32_t> out;
    for (uint32_t part = 0; part < chain.parts; ++part) {
        const auto own = chain.indicesOf(level, part);
        out.insert(out.end(), own.begin(), own.end());
    }
    return out;
}

using Place = std::tuple<float, float, float>;

Place placeOf(const MeshView& mesh, uint32_t vertex) {
    const glm::vec3 p = mesh.positions[vertex] + glm::vec3(0.0f);
    return {p.x, p.y, p.z};
}

/// Sides that are not met by one that runs the other way.
size_t openSides(const MeshView& mesh, std::span<const uint32_t> indices) {
    std::map<std::pair<Place, Place>, int> balance;
    for (size_t t = 0; t < indices.size(); t += 3)
        for (size_t k = 0; k < 3; ++k) {
            const Place a = placeOf(mesh, indices[t + k]), b = placeOf(mesh, indices[t + (k + 1) % 3]);
            if (a < b) ++balance[{a, b}];
            else --balance[{b, a}];
        }
    size_t open = 0;
    for (const auto& [side, count] : balance) open += static_cast<size_t>(std::abs(count));
    return open;
}

/// What holds for every chain.
void expectChainLaws(const MeshView& mesh, std::span<const MeshPart> parts, const LodChain& chain) {
    ASSERT_GE(chain.levels.size(), 1u);
    EXPECT_LE(chain.levels.size(), kMostLods);
    EXPECT_EQ(chain.levels[0].error, 0);
    ASSERT_EQ(chain.parts, std::max<size_t>(parts.size(), 1));
    ASSERT_EQ(chain.ranges.size(), (chain.levels.size() - 1) * chain.parts);
    size_t next = 0;
    for (uint32_t level = 1; level < chain.levels.size(); ++level) {
        const LodLevel &finer = chain.levels[level - 1], &record = chain.levels[level];
        EXPECT_GT(record.error, finer.error) << "level " << level;
        EXPECT_LE(record.triangles, 0.8 * finer.triangles) << "level " << level;
        size_t triangles = 0;
        std::set<uint32_t> vertices;
        for (uint32_t part = 0; part < chain.parts; ++part) {
            const LodPart range = chain.range(level, part);
            EXPECT_EQ(range.first, next);
            next += range.count;
            triangles += range.count;
            std::set<uint32_t> own;
            const auto used = parts.empty()
                                  ? mesh.indices
                                  : mesh.indices.subspan(3 * size_t{parts[part].first}, 3 * size_t{parts[part].count});
            own.insert(used.begin(), used.end());
            for (const uint32_t vertex : chain.indicesOf(level, part)) {
                vertices.insert(vertex);
                EXPECT_TRUE(own.count(vertex)) << "vertex " << vertex << " is not of part " << part;
            }
        }
        EXPECT_EQ(record.triangles, triangles);
        EXPECT_EQ(record.vertices, vertices.size());
    }
    EXPECT_EQ(chain.indices.size(), 3 * next);
}

/// Samples of both surfaces: none is farther from the other one than the error says.
void expectErrorsHold(const MeshView& mesh, const LodChain& chain, int samples) {
    for (uint32_t level = 1; level < chain.levels.size(); ++level) {
        const std::vector<uint32_t> indices = allOf(chain, level);
        const auto truth = test::sampleDistance({mesh.positions, indices}, mesh, samples);
        EXPECT_LE(truth.least, chain.levels[level].error) << "level " << level;
        EXPECT_GE(truth.most * 1.06 + 1e-5, chain.levels[level].error) << "level " << level;
    }
}

/// The same surface on common vertices.
TestMesh welded(const TestMesh& mesh) {
    TestMesh out;
    std::map<Place, uint32_t> number;
    for (const uint32_t vertex : mesh.indices) {
        const auto [at, added] = number.try_emplace(placeOf(mesh.view(), vertex), uint32_t(out.positions.size()));
        if (added) out.positions.push_back(mesh.positions[vertex]);
        out.indices.push_back(at->second);
    }
    return out;
}

TEST(LodChain, OfAClosedSurfaceStaysClosedAndKeepsItsErrors) {
    for (const bool split : {false, true}) {  // whether each triangle has vertices of its own
        const Soup ball = makeBall(1, 9);
        const TestMesh mesh = split ? static_cast<const TestMesh&>(ball) : welded(ball);
        const LodChain chain = makeLods(mesh.view());
        expectChainLaws(mesh.view(), {}, chain);
        ASSERT_GE(chain.levels.size(), 4u);
        EXPECT_EQ(chain.levels[0].triangles, 648u);
        EXPECT_EQ(chain.levels[0].vertices, split ? 1944u : 326u);
        EXPECT_LE(chain.levels.back().triangles, 40u);
        for (uint32_t level = 1; level < chain.levels.size(); ++level)
            EXPECT_EQ(openSides(mesh.view(), allOf(chain, level)), 0u) << "level " << level;
        expectErrorsHold(mesh.view(), chain, 4);
    }
}

/// The ball's triangles sorted by height into bands, one part each.
TestMesh banded(const Soup& ball, std::vector<MeshPart>& parts, int bands) {
    TestMesh mesh;
    mesh.positions = ball.positions;
    for (int band = 0; band < bands; ++band) {
        const auto first = uint32_t(mesh.indices.size() / 3);
        for (size_t t = 0; t < ball.indices.size(); t += 3) {
            double height = 0;
            for (size_t k = 0; k < 3; ++k) height += ball.positions[ball.indices[t + k]].y / 3;
            if (std::clamp(int((height + 1) / 2 * bands), 0, bands - 1) == band)
                mesh.indices.insert(mesh.indices.end(), ball.indices.begin() + std::ptrdiff_t(t),
                                    ball.indices.begin() + std::ptrdiff_t(t + 3));
        }
        parts.push_back({first, uint32_t(mesh.indices.size() / 3) - first});
    }
    return mesh;
}

TEST(LodChain, OpensNoGapBetweenParts) {
    std::vector<MeshPart> parts;
    const TestMesh mesh = banded(makeBall(2, 16), parts, 3);
    const LodChain chain = makeLods(mesh.view(), parts);
    expectChainLaws(mesh.view(), parts, chain);
    ASSERT_GE(chain.levels.size(), 2u);
    for (uint32_t level = 1; level < chain.levels.size(); ++level) {
        EXPECT_EQ(openSides(mesh.view(), allOf(chain, level)), 0u) << "level " << level;
        for (uint32_t part = 0; part < 3; ++part) EXPECT_GT(chain.range(level, part).count, 0u);
    }
}

TEST(LodChain, OfPartsThatDoNotTouchSpendsTrianglesWhereTheErrorIs) {
    TestMesh mesh = makeBall(3, 12);
    const auto curved = uint32_t(mesh.view().triangles());
    constexpr uint32_t kColumns = 24;
    for (uint32_t y = 0; y < kColumns; ++y)
        for (uint32_t x = 0; x < kColumns; ++x) {
            const glm::vec3 p(5 + 0.1f * float(x), 0.1f * float(y), 0);
            mesh.add({p, p + glm::vec3(0.1f, 0, 0), p + glm::vec3(0.1f, 0.1f, 0), p + glm::vec3(0, 0.1f, 0)});
        }
    // Columns meet where rounding says so, or their borders stay.
    mesh = welded(mesh);
    const MeshPart parts[2] = {{0, curved}, {curved, uint32_t(mesh.view().triangles()) - curved}};
    const LodChain chain = makeLods(mesh.view(), parts);
    expectChainLaws(mesh.view(), parts, chain);
    ASSERT_GE(chain.levels.size(), 3u);
    EXPECT_GT(chain.range(1, 0).count, 2 * chain.range(1, 1).count);
}

TEST(LodChain, OfAPlaneHasHardlyAnError) {
    TestMesh mesh;
    for (uint32_t y = 0; y <= 32; ++y)
        for (uint32_t x = 0; x <= 32; ++x) mesh.positions.push_back({float(x), 0, float(y)});
    mesh.addGrid(33, 33);
    const LodChain chain = makeLods(mesh.view());
    expectChainLaws(mesh.view(), {}, chain);
    // Levels that err by nothing but what the limits leave: one remains, and perhaps one that cuts a corner.
    ASSERT_GE(chain.levels.size(), 2u);
    EXPECT_LE(chain.levels.size(), 3u);
    EXPECT_LE(chain.levels[1].error, 1.01e-6 * 32 * std::sqrt(2));
    EXPECT_LE(chain.levels[1].triangles, 24u);
}

TEST(LodChain, GivesCornersTheVerticesOfTheirOwnFace) {
    // A box of grids, whose faces have vertices of their own along the edges of the box: a renderer has normals there.
    TestMesh mesh;
    std::vector<int> face_of;
    constexpr uint32_t kSteps = 8;
    for (int face = 0; face < 6; ++face) {
        const auto& f = test::kBoxFaces[face];
        const std::vector<glm::vec3> corner = test::boxMesh().positions;
        const auto first = uint32_t(mesh.positions.size());
        for (uint32_t y = 0; y <= kSteps; ++y)
            for (uint32_t x = 0; x <= kSteps; ++x) {
                const float u = float(x) / kSteps, v = float(y) / kSteps;
                mesh.positions.push_back(corner[f[0]] + u * (corner[f[1]] - corner[f[0]]) +
                                         v * (corner[f[3]] - corner[f[0]]));
                face_of.push_back(face);
            }
        for (uint32_t y = 0; y < kSteps; ++y)
            for (uint32_t x = 0; x < kSteps; ++x) {
                const uint32_t a = first + y * (kSteps + 1) + x;
                mesh.fan({a, a + 1, a + kSteps + 2, a + kSteps + 1});
            }
    }
    ASSERT_EQ(openSides(mesh.view(), mesh.indices), 0u);
    const LodChain chain = makeLods(mesh.view());
    ASSERT_GE(chain.levels.size(), 2u);
    const std::vector<uint32_t> level = allOf(chain, 1);
    for (size_t t = 0; t < level.size(); t += 3) {
        EXPECT_EQ(face_of[level[t]], face_of[level[t + 1]]) << "triangle " << t / 3;
        EXPECT_EQ(face_of[level[t]], face_of[level[t + 2]]) << "triangle " << t / 3;
    }
}

TEST(LodChain, GivesCornersTheVerticesOfTheirSideOfASeam) {
    // A bumpy field whose halves have vertices of their own along a line, as texture coordinates need them.
    constexpr uint32_t kSteps = 24;
    Random random(3);
    TestMesh mesh;
    std::vector<int> half_of;
    std::vector<float> height;
    for (uint32_t i = 0; i <= kSteps; ++i) height.push_back(0.5f * float(random.uniform()));
    for (int half = 0; half < 2; ++half) {
        const auto first = uint32_t(mesh.positions.size());
        for (uint32_t y = 0; y <= kSteps; ++y)
            for (uint32_t x = 0; x <= kSteps; ++x) {
                const bool seam = x == (half == 0 ? kSteps : 0);
                const float h = seam ? height[y] : 0.5f * float(random.uniform());
                mesh.positions.push_back({float(x) + float(half) * kSteps, float(y), h});
                half_of.push_back(half);
            }
        for (uint32_t y = 0; y < kSteps; ++y)
            for (uint32_t x = 0; x < kSteps; ++x) {
                const uint32_t a = first + y * (kSteps + 1) + x;
                mesh.fan({a, a + 1, a + kSteps + 2, a + kSteps + 1});
            }
    }
    const LodChain chain = makeLods(mesh.view());
    ASSERT_GE(chain.levels.size(), 2u);
    const std::vector<uint32_t> level = allOf(chain, 1);
    size_t right = 0, wrong = 0;
    for (size_t t = 0; t < level.size(); t += 3) {
        float low = kSteps, high = kSteps;
        for (size_t k = 0; k < 3; ++k) {
            low = std::min(low, mesh.positions[level[t + k]].x);
            high = std::max(high, mesh.positions[level[t + k]].x);
        }
        if (low < kSteps && high > kSteps) continue;  // it crosses the seam
        for (size_t k = 0; k < 3; ++k)
            if (mesh.positions[level[t + k]].x == kSteps) ++(half_of[level[t + k]] == (high > kSteps) ? right : wrong);
    }
    EXPECT_GT(right, 40u);
    EXPECT_LE(20 * wrong, right);
}

TEST(LodChain, GivesCornersTheVerticesOfTheirSideOfARim) {
    // A thin lens: its two sheets have vertices of their own along the rim, and leave it in nearly the same direction.
    constexpr uint32_t kSteps = 24;
    Random random(4);
    TestMesh mesh;
    std::vector<int> sheet_of;
    for (int sheet = 0; sheet < 2; ++sheet) {
        const auto first = uint32_t(mesh.positions.size());
        for (uint32_t y = 0; y <= kSteps; ++y)
            for (uint32_t x = 0; x <= kSteps; ++x) {
                const bool rim = x == 0 || y == 0 || x == kSteps || y == kSteps;
                glm::vec3 p(x, y, 0);
                if (!rim)
                    p += glm::vec3(random.uniform(-0.4, 0.4), random.uniform(-0.4, 0.4), random.uniform(0.1, 0.3));
                mesh.positions.push_back(sheet == 0 ? p : glm::vec3(p.x, p.y, -p.z));
                sheet_of.push_back(sheet);
            }
        for (uint32_t y = 0; y < kSteps; ++y)
            for (uint32_t x = 0; x < kSteps; ++x) {
                const uint32_t a = first + y * (kSteps + 1) + x, b = a + kSteps + 1;
                if (sheet == 0) mesh.fan({a, a + 1, b + 1, b});
                else mesh.fan({a, b, b + 1, a + 1});
            }
    }
    ASSERT_EQ(openSides(mesh.view(), mesh.indices), 0u);
    const LodChain chain = makeLods(mesh.view());
    ASSERT_GE(chain.levels.size(), 2u);
    const std::vector<uint32_t> level = allOf(chain, 1);
    size_t right = 0, wrong = 0;
    for (size_t t = 0; t < level.size(); t += 3) {
        const auto at = [&](size_t k) { return glm::dvec3(mesh.positions[level[t + k]]); };
        const glm::dvec3 normal = glm::cross(at(1) - at(0), at(2) - at(0));
        if (std::abs(normal.z) < 0.5 * glm::length(normal)) continue;
        for (size_t k = 0; k < 3; ++k)
            if (at(k).z == 0) ++(sheet_of[level[t + k]] == (normal.z < 0) ? right : wrong);
    }
    EXPECT_GT(right, 40u);
    EXPECT_EQ(wrong, 0u);
}

TEST(LodChain, KeepsTheLawsForAnyTriangles) {
    const size_t cases = test::casesToMake(40, 2000);
    for (size_t i = 0; i < cases; ++i) {
        SCOPED_TRACE(::testing::Message() << "case " << i);
        Random random(100 + i);
        TestMesh mesh;
        // Corners from few places, so that all sorts of sides are shared; triangles that are points, too.
        const uint64_t places = 4 + random.below(60);
        for (uint64_t p = 0; p < places; ++p) mesh.positions.push_back(glm::vec3(test::randomVector(random, 1.0)));
        if (random.below(2)) mesh.positions.push_back(mesh.positions[0]);
        const uint64_t triangles = random.below(200);
        for (uint64_t t = 0; t < 3 * triangles; ++t)
            mesh.indices.push_back(uint32_t(random.below(mesh.positions.size())));
        std::vector<MeshPart> parts;
        for (uint32_t at = 0; at < triangles && random.below(4);) {
            parts.push_back({at, uint32_t(random.below(triangles - at + 1))});
            at += parts.back().count;
        }
        LodChainSettings settings;
        settings.sloppy = random.below(2);
        settings.most_error = 1;
        TestMesh drawn = mesh;
        if (!parts.empty()) {
            drawn.indices.resize(3 * size_t{parts.back().first + parts.back().count});
            if (drawn.indices.empty()) continue;
        }
        const LodChain chain = makeLods(mesh.view(), parts, settings);
        expectChainLaws(mesh.view(), parts, chain);
        for (uint32_t level = 1; level < chain.levels.size(); ++level) {
            const std::vector<uint32_t> indices = allOf(chain, level);
            EXPECT_LE(test::sampleDistance({mesh.positions, indices}, drawn.view(), 4).least,
                      chain.levels[level].error);
        }
    }
}

TEST(LodChain, GoesOnSloppilyOnlyWhereThatIsAllowed) {
    // A field of bumps whose triangles belong to two parts in turn: all borders are shared, and no edge can collapse.
    Random random(5);
    TestMesh field, mesh;
    for (uint32_t y = 0; y <= 16; ++y)
        for (uint32_t x = 0; x <= 16; ++x) field.positions.push_back({x, random.uniform(), y});
    field.addGrid(17, 17);
    mesh.positions = field.positions;
    for (size_t odd = 0; odd < 2; ++odd)
        for (size_t t = 3 * odd; t < field.indices.size(); t += 6)
            for (size_t k = 0; k < 3; ++k) mesh.indices.push_back(field.indices[t + k]);
    const MeshPart parts[2] = {{0, 256}, {256, 256}};
    LodChainSettings settings;
    settings.most_error = 1;
    const LodChain strict = makeLods(mesh.view(), parts, settings);
    settings.sloppy = true;
    const LodChain sloppy = makeLods(mesh.view(), parts, settings);
    EXPECT_EQ(strict.levels.size(), 1u);
    expectChainLaws(mesh.view(), parts, sloppy);
    EXPECT_GT(sloppy.levels.size(), 2u);
    expectErrorsHold(mesh.view(), sloppy, 3);
}

TEST(LodChain, IsTheSameEachTimeAndInTheMemoryGiven) {
    std::vector<MeshPart> parts;
    const TestMesh mesh = banded(makeBall(4, 10), parts, 2);
    test::CountingMemory memory;
    const LodChain a = makeLods(mesh.view(), parts), b = makeLods(mesh.view(), parts, {}, &memory);
    EXPECT_GT(memory.bytes, 0u);
    EXPECT_TRUE(std::equal(a.indices.begin(), a.indices.end(), b.indices.begin(), b.indices.end()));
    ASSERT_EQ(a.levels.size(), b.levels.size());
    for (size_t i = 0; i < a.levels.size(); ++i) {
        EXPECT_EQ(a.levels[i].error, b.levels[i].error);
        EXPECT_EQ(a.levels[i].triangles, b.levels[i].triangles);
    }
}

TEST(LodChain, StopsWhereTheSettingsSay) {
    const TestMesh mesh = welded(makeBall(5, 10));
    LodChainSettings settings;
    settings.levels = 3;
    EXPECT_LE(makeLods(mesh.view(), {}, settings).levels.size(), 3u);
    settings = {};
    settings.levels = 1;
    EXPECT_EQ(makeLods(mesh.view(), {}, settings).levels.size(), 1u);
    settings = {};
    settings.fewest_triangles = 100;
    for (const LodLevel& level : makeLods(mesh.view(), {}, settings).levels) EXPECT_GE(level.triangles, 45u);
    settings = {};
    settings.most_error = 0.02;
    const LodChain chain = makeLods(mesh.view(), {}, settings);
    EXPECT_LE(chain.levels.back().error, 0.02 * 4);
    EXPECT_LT(chain.levels.size(), makeLods(mesh.view()).levels.size());
}

TEST(LodChain, OfNothingOrLittleOrWhatIsNotFiniteIsTheMeshItself) {
    EXPECT_EQ(makeLods(TestMesh().view()).levels.size(), 1u);
    TestMesh one;
    one.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    const LodChain chain = makeLods(one.view());
    ASSERT_EQ(chain.levels.size(), 1u);
    EXPECT_EQ(chain.levels[0].triangles, 1u);
    EXPECT_EQ(chain.levels[0].vertices, 3u);
    TestMesh broken = makeBall(6, 8);
    broken.positions[17].y = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(makeLods(broken.view()).levels.size(), 1u);
    TestMesh points;
    for (int i = 0; i < 50; ++i) points.add(glm::vec3(i), glm::vec3(i), glm::vec3(i));
    EXPECT_EQ(makeLods(points.view()).levels.size(), 1u);
    const MeshPart none{0, 0};
    EXPECT_EQ(makeLods(makeBall(6, 3).view(), {&none, 1}).levels.size(), 1u);
}

TEST(LodChain, IsMadeOfTheLargestAndTheSmallestNumbers) {
    const TestMesh ball = welded(makeBall(7, 8));
    const LodChain plain = makeLods(ball.view());
    for (const float size : {0x1p126f, 0x1p-100f}) {
        TestMesh mesh = ball;
        for (glm::vec3& p : mesh.positions) p *= size;
        const LodChain chain = makeLods(mesh.view());
        expectChainLaws(mesh.view(), {}, chain);
        ASSERT_EQ(chain.levels.size(), plain.levels.size());
        for (size_t i = 1; i < chain.levels.size(); ++i)
            EXPECT_NEAR(chain.levels[i].error / double(size), plain.levels[i].error, 1e-6);
    }
}

class LodScenes : public test::SceneTest {};

TEST_P(LodScenes, KeepTheLaws) {
    size_t levels = 0, fine = 0, coarse = 0;
    for (const tools::Mesh& mesh : scene->meshes) {
        if (mesh.triangles() < 64 || mesh.triangles() > 6000) continue;
        SCOPED_TRACE(mesh.name);
        std::vector<MeshPart> parts;
        for (const tools::Primitive& primitive : mesh.primitives)
            parts.push_back({primitive.first_triangle, primitive.triangle_count});
        const MeshView view{mesh.positions, mesh.indices};
        const LodChain chain = makeLods(view, parts);
        expectChainLaws(view, parts, chain);
        levels += chain.levels.size() - 1;
        fine += mesh.triangles();
        coarse += chain.levels.back().triangles;
        // A few samples of the finest surface, each against all of a level.
        Random random(mesh.triangles());
        const uint32_t level = uint32_t(random.below(chain.levels.size()));
        if (level == 0) continue;
        const std::vector<uint32_t> indices = allOf(chain, level);
        for (int i = 0; i < 200; ++i) {
            const size_t t = 3 * random.below(mesh.triangles());
            const double u = random.uniform(), v = random.uniform(0, 1 - u);
            const auto at = [&](size_t k) { return glm::dvec3(mesh.positions[mesh.indices[t + k]]); };
            const glm::dvec3 p = u * at(0) + v * at(1) + (1 - u - v) * at(2);
            EXPECT_LE(test::distanceToMesh(p, {mesh.positions, indices}), chain.levels[level].error);
        }
    }
    if (fine == 0) return;
    EXPECT_LT(coarse, fine);
    EXPECT_GT(levels, 0u);
}

INSTANTIATE_TEST_SUITE_P(All, LodScenes, test::kSmallScenes, test::sceneLabel);

}  // namespace
}  // namespace sightline
