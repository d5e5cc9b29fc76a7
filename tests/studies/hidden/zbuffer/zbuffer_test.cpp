// The z-buffer renderer against a ray caster that asks each sample by itself.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/zbuffer.h"

#include <algorithm>
#include <cmath>
#include <string>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline {
using namespace studies;
namespace {

using test::TestMesh;

/// A square at z, facing +z, or -z if turned.
TestMesh square(float half, float z, bool turned = false) {
    TestMesh mesh{
        .positions = {{-half, -half, z}, {half, -half, z}, {half, half, z}, {-half, half, z}},
        .indices = turned ? std::vector<uint32_t>{0, 2, 1, 0, 3, 2} : std::vector<uint32_t>{0, 1, 2, 0, 2, 3}};
    return mesh;
}

TestMesh randomTriangles(Random& random, int count, double size) {
    TestMesh mesh;
    for (int i = 0; i < count; ++i) {
        const glm::vec3 center(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-8, 3));
        glm::vec3 p[3];
        for (glm::vec3& v : p) v = center + glm::vec3(test::randomVector(random, size));
        mesh.add(p[0], p[1], p[2]);
    }
    return mesh;
}

uint32_t centerId(const ZBufferImage& image) {
    return image.id[size_t(image.height / 2) * image.width + image.width / 2];
}

struct Cast {
    double nearest = -INFINITY;
    bool close_call = false;  ///< an edge, an end of the ray, or a second surface is too near to tell
    uint32_t id = ZBufferImage::kNone;
    int fragments = 0;
};

/// Looks along one sample's line through all items, in world space.
Cast castSample(std::span<const DrawItem> items, const View& view, double x, double y) {
    const glm::dmat4 inverse = glm::inverse(view.projection * view.view);
    const glm::dvec4 from = inverse * glm::dvec4(x, y, -1, 1), to = inverse * glm::dvec4(x, y, 0.5, 1);
    const glm::dvec3 origin = glm::dvec3(from) / from.w;
    const glm::dvec3 direction = glm::dvec3(to) / to.w - origin;
    Cast cast;
    for (const DrawItem& item : items)
        for (size_t t = 0; t < item.mesh.triangles(); ++t) {
            glm::dvec3 p[3];
            for (int k = 0; k < 3; ++k)
                p[k] = item.transform * glm::dvec4(glm::dvec3(item.mesh.positions[item.mesh.indices[3 * t + k]]), 1);
            const glm::dvec3 ab = p[1] - p[0], ac = p[2] - p[0], normal = glm::cross(ab, ac);
            const double facing = glm::dot(normal, direction);
            const double distance = glm::dot(normal, p[0] - origin) / facing;
            const glm::dvec3 hit = origin + distance * direction - p[0];
            const double square = glm::dot(normal, normal);
            const double u = glm::dot(glm::cross(hit, ac), normal) / square;
            const double v = glm::dot(glm::cross(ab, hit), normal) / square;
            const double margin = std::min({u, v, 1 - u - v});
            if (!(margin > -1e-7)) continue;
            const bool flipped = glm::determinant(glm::dmat3(item.transform)) < 0;
            const bool front = (facing < 0) != flipped;
            if (!front && (item.double_sided.empty() || !item.double_sided[t])) continue;
            const glm::dvec4 clip = view.projection * view.view * glm::dvec4(origin + distance * direction, 1);
            const double behind = (clip.z + clip.w) / std::abs(clip.w), beyond = (clip.w - clip.z) / std::abs(clip.w);
            if (behind < -1e-7 || beyond < 0 || distance < -1e-7) continue;
            const glm::dvec4 eye_space = view.view * glm::dvec4(origin + distance * direction, 1);
            const double nearness = isOrthographic(view) ? eye_space.z : 1 / clip.w;
            if (margin < 1e-7 || std::abs(behind) < 1e-7 || std::abs(beyond) < 1e-9) cast.close_call = true;
            if (std::abs(nearness - cast.nearest) < 1e-9 * std::abs(nearness)) cast.close_call = true;
            ++cast.fragments;
            if (nearness > cast.nearest) cast.nearest = nearness, cast.id = item.id;
        }
    return cast;
}

void expectSameAsRays(std::span<const DrawItem> items, const View& view, const ZBufferSettings& settings,
                      const std::string& name) {
    const ZBufferImage image = renderZBuffer(items, view, settings);
    int checked = 0, close_calls = 0, drawn = 0;
    for (uint32_t j = 0; j < image.height; ++j)
        for (uint32_t i = 0; i < image.width; ++i) {
            const double x = ((i + 0.5) / settings.samples + settings.offset.x) / view.width * 2 - 1;
            const double y = ((j + 0.5) / settings.samples + settings.offset.y) / view.height * 2 - 1;
            const Cast cast = castSample(items, view, x, y);
            if (cast.close_call) {
                ++close_calls;
                continue;
            }
            const size_t at = size_t(j) * image.width + i;
            ++checked;
            drawn += cast.fragments > 0;
            ASSERT_EQ(image.generated[at], cast.fragments) << name << " sample " << i << "," << j;
            ASSERT_EQ(image.id[at], cast.id) << name << " sample " << i << "," << j;
            if (cast.id == ZBufferImage::kNone) continue;
            ASSERT_NEAR(image.depth[at], cast.nearest, 1e-9 * std::abs(cast.nearest)) << name;
        }
    EXPECT_GT(drawn, checked / 40) << name;
    EXPECT_LT(close_calls, checked / 100 + 2) << name;
}

/// Random triangles around the eye: many cross the near plane, many lie behind.
void castScenes(const glm::dmat4& projection, const std::string& name) {
    for (uint64_t seed = 0; seed < 12; ++seed) {
        Random random(seed);
        const TestMesh small = randomTriangles(random, 60, 1.0), large = randomTriangles(random, 6, 6.0);
        const std::vector<uint8_t> both(60, 1);
        glm::dmat4 mirror(1.0);
        mirror[0] = glm::dvec4(-1, 0.2, 0, 0);
        mirror[3] = glm::dvec4(0.3, -0.2, 0.1, 1);
        const DrawItem items[3] = {{small.view(), both, {}, glm::dmat4(1.0), 7},
                                   {large.view(), {}, {}, mirror, 8},
                                   {large.view(), {}, {}, glm::dmat4(1.0), 9}};
        View view = test::viewBy(projection, 40, 30);
        view.view = lookAt({0.1, 0.2, 0.3}, {0.5, 0.1, -3}, {0.1, 1, 0});
        const ZBufferSettings settings{seed % 2 ? 2u : 1u, {seed % 3 * 0.2, seed % 5 * -0.1}};
        expectSameAsRays(items, view, settings, name + " seed " + std::to_string(seed));
    }
}

TEST(ZBuffer, AgreesWithRaysInPerspective) { castScenes(perspective(1.2, 4.0 / 3, 0.5, 7.0), "finite far"); }
TEST(ZBuffer, AgreesWithRaysAtInfiniteFar) { castScenes(perspective(2.4, 4.0 / 3, 0.01), "infinite far"); }
TEST(ZBuffer, AgreesWithRaysInParallelProjection) { castScenes(orthographic(5, 4.0 / 3, 0.5, 6), "orthographic"); }
TEST(ZBuffer, AgreesWithRaysOffCentre) {
    glm::dmat4 projection = perspective(1.0, 4.0 / 3, 0.1, 20);
    projection[2][0] = 0.6;
    projection[2][1] = -0.3;
    castScenes(projection, "off-centre");
    projection = orthographic(4, 4.0 / 3, 0.1, 20);
    projection[3][0] = 0.4;
    castScenes(projection, "off-centre orthographic");
}

TEST(ZBuffer, CoversClosedSurfaceTwiceAndFrontOnce) {
    // A shaken sphere: each sample inside its outline meets one front and one back surface.
    for (uint64_t seed = 0; seed < 6; ++seed) {
        Random random(seed);
        TestMesh ball;
        constexpr uint32_t kRings = 24, kSegments = 32;
        for (uint32_t r = 0; r <= kRings; ++r)
            for (uint32_t s = 0; s < kSegments; ++s) {
                const double a = r * 3.141592653589793 / kRings, b = s * 6.283185307179586 / kSegments;
                ball.positions.emplace_back(std::sin(a) * std::cos(b), std::cos(a), -std::sin(a) * std::sin(b));
            }
        for (uint32_t r = 0; r < kRings; ++r)
            for (uint32_t s = 0; s < kSegments; ++s) {
                const uint32_t a = r * kSegments + s, b = r * kSegments + (s + 1) % kSegments;
                for (uint32_t index : {a, a + kSegments, b, b, a + kSegments, b + kSegments})
                    ball.indices.push_back(index);
            }
        const std::vector<uint8_t> both(ball.indices.size() / 3, 1);
        View view = test::viewBy(perspective(0.8, 1.0, 0.1), 128, 128);
        view.view = lookAt({random.uniform(-2, 2), random.uniform(-2, 2), 3}, {0, 0, 0}, {0, 1, 0});
        const DrawItem one{ball.view(), {}, {}, glm::dmat4(1.0), 0}, two{ball.view(), both, {}, glm::dmat4(1.0), 0};
        const ZBufferImage single = renderZBuffer({&one, 1}, view), all = renderZBuffer({&two, 1}, view);
        size_t covered = 0;
        for (size_t i = 0; i < single.id.size(); ++i) {
            ASSERT_LE(single.generated[i], 1) << "seed " << seed << " sample " << i;
            ASSERT_EQ(all.generated[i], 2 * single.generated[i]) << "seed " << seed << " sample " << i;
            covered += single.generated[i];
        }
        EXPECT_GT(covered, 1000u);
    }
}

TEST(ZBuffer, ParallelProjectionToInfinityBeginsAtTheEye) {
    const TestMesh behind = square(1, 2), ahead = square(1, -2);
    const uint8_t both[2] = {1, 1};
    const DrawItem items[2] = {{behind.view(), both, {}, glm::dmat4(1.0), 1},
                               {ahead.view(), both, {}, glm::dmat4(1.0), 2}};
    const View view = test::viewBy(orthographic(1, 4.0 / 3, 0.1, std::numeric_limits<double>::infinity()), 64, 48);
    EXPECT_EQ(centerId(renderZBuffer(items, view)), 2u);
}

TEST(ZBuffer, PassesBackFacesOnly) {
    const TestMesh front = square(1, -2), back = square(1, -2, true), behind = square(1, -3);
    const View view = test::viewBy(perspective(1.0, 4.0 / 3, 0.1), 64, 48);
    const uint8_t both[2] = {1, 1};
    glm::dmat4 mirror(1.0);
    mirror[0][0] = -1;
    const auto shown = [&](const TestMesh& mesh, std::span<const uint8_t> sides, const glm::dmat4& transform) {
        const DrawItem items[2] = {{mesh.view(), sides, {}, transform, 1}, {behind.view(), {}, {}, glm::dmat4(1.0), 2}};
        return centerId(renderZBuffer(items, view));
    };
    EXPECT_EQ(shown(front, {}, glm::dmat4(1.0)), 1u);
    EXPECT_EQ(shown(back, {}, glm::dmat4(1.0)), 2u);
    EXPECT_EQ(shown(back, both, glm::dmat4(1.0)), 1u);
    // A mirrored square keeps its front in front.
    EXPECT_EQ(shown(front, {}, mirror), 1u);
    EXPECT_EQ(shown(back, {}, mirror), 2u);
}

TEST(ZBuffer, MirroredProjectionKeepsFacing) {
    const TestMesh front = square(1, -2);
    for (glm::dmat4 projection : {perspective(1.0, 4.0 / 3, 0.1), orthographic(2, 4.0 / 3, 0.1, 9)}) {
        for (int column = 0; column < 4; ++column) projection[column][1] = -projection[column][1];
        const DrawItem item{front.view(), {}, {}, glm::dmat4(1.0), 3};
        EXPECT_EQ(centerId(renderZBuffer({&item, 1}, test::viewBy(projection, 64, 48))), 3u);
    }
}

TEST(ZBuffer, UnwrittenSurfacesAreSeenAndHideNothing) {
    const TestMesh glass = square(1, -2), wall = square(1, -3), hidden = square(0.5f, -4), flush = square(0.5f, -3);
    const uint8_t no[2] = {0, 0};
    // Drawn first, last or between: the answer is the same.
    std::vector<DrawItem> items = {{glass.view(), {}, no, glm::dmat4(1.0), 0},
                                   {wall.view(), {}, {}, glm::dmat4(1.0), 1},
                                   {hidden.view(), {}, no, glm::dmat4(1.0), 2},
                                   {flush.view(), {}, no, glm::dmat4(1.0), 3}};
    for (int i = 0; i < 4; ++i) {
        std::rotate(items.begin(), items.begin() + 1, items.end());
        const ZBufferImage image = renderZBuffer(items, test::viewBy(perspective(1.0, 4.0 / 3, 0.1), 64, 48));
        EXPECT_EQ(centerId(image), 1u);
        EXPECT_EQ(image.seen, (std::vector<uint8_t>{1, 1, 0, 1}));
        EXPECT_EQ(image.seen_at[2], ZBufferImage::kNowhere);
        EXPECT_EQ(image.id[image.seen_at[1]], 1u);
        EXPECT_NEAR(image.depth[image.seen_at[3]], 1.0 / 3, 1e-15);
    }
}

TEST(ZBuffer, SeesAtTheMiddleOfTheLongestRun) {
    const TestMesh wall = square(1, -2);
    const DrawItem item{wall.view(), {}, {}, glm::dmat4(1.0), 0};
    const ZBufferImage image = renderZBuffer({&item, 1}, test::viewBy(perspective(1.5, 4.0 / 3, 0.1), 64, 48));
    const uint64_t at = image.seen_at[0];
    EXPECT_NEAR(at % image.width, image.width / 2, 1);
}

TEST(ZBuffer, BandsAreRowsOfTheWhole) {
    Random random(5);
    const TestMesh mesh = randomTriangles(random, 200, 2);
    const DrawItem item{mesh.view(), {}, {}, glm::dmat4(1.0), 4};
    const View view = test::viewBy(perspective(1.2, 4.0 / 3, 0.2), 33, 21);
    ZBufferSettings settings{3, {0.1, -0.2}};
    const ZBufferImage whole = renderZBuffer({&item, 1}, view, settings);
    settings.row_count = 13;
    for (settings.first_row = 0; settings.first_row < whole.height; settings.first_row += 13) {
        const ZBufferImage band = renderZBuffer({&item, 1}, view, settings);
        ASSERT_EQ(band.first_row, settings.first_row);
        const size_t skip = size_t(band.first_row) * whole.width;
        for (size_t i = 0; i < band.id.size(); ++i) {
            ASSERT_EQ(band.id[i], whole.id[skip + i]) << "band " << settings.first_row;
            ASSERT_EQ(band.depth[i], whole.depth[skip + i]) << "band " << settings.first_row;
            ASSERT_EQ(band.generated[i], whole.generated[skip + i]) << "band " << settings.first_row;
        }
    }
}

/// A world moved by a distance that double holds exactly gives the same image: all work is relative to the eye.
TEST(ZBuffer, FarWorldEqualsNearWorld) {
    Random random(6);
    const TestMesh mesh = randomTriangles(random, 300, 1.5);
    for (const double far_away : {0x1p20, 0x1p30}) {
        const glm::dvec3 shift(far_away, -far_away, 0.5 * far_away);
        View view = test::viewBy(perspective(1.2, 4.0 / 3, 0.1), 200, 150);
        DrawItem item{mesh.view(), {}, {}, glm::dmat4(1.0), 1};
        item.transform[3] = glm::dvec4(0.25, 0.5, -1.0, 1);
        const ZBufferImage here = renderZBuffer({&item, 1}, view);
        view.view[3] = glm::dvec4(-shift, 1);
        item.transform[3] += glm::dvec4(shift, 0);
        const ZBufferImage there = renderZBuffer({&item, 1}, view);
        EXPECT_EQ(here.id, there.id);
        EXPECT_EQ(here.depth, there.depth);
    }
}

TEST(ZBuffer, DrawsNothingFromBrokenInput) {
    TestMesh mesh = square(1, -2);
    mesh.positions[0].x = NAN;
    DrawItem item{mesh.view(), {}, {}, glm::dmat4(1.0), 2};
    const View view = test::viewBy(perspective(1.0, 1.0, 0.1), 1, 1);
    EXPECT_EQ(renderZBuffer({&item, 1}, view).id[0], ZBufferImage::kNone);
    mesh.positions[0].x = -1;
    item.transform[3][0] = INFINITY;
    EXPECT_EQ(renderZBuffer({&item, 1}, view).id[0], ZBufferImage::kNone);
    EXPECT_EQ(renderZBuffer({}, view).id[0], ZBufferImage::kNone);
    item.transform[3][0] = 0;
    EXPECT_EQ(renderZBuffer({&item, 1}, view).id[0], 2u);
}

}  // namespace
}  // namespace sightline
