// The law of planes in tiles: a box that lies behind the planes of its pixels is one that no ray meets first.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/ask/occludee_box.h"

#include <gtest/gtest.h>

#include <array>
#include <sstream>
#include <vector>

#include <glm/gtc/matrix_transform.hpp>

#include "sightline/buffer/covers.h"
#include "tests/buffer/tiles_fixture.h"
#include "tests/support/targets.h"

namespace sightline::test {
namespace {

OccludeeBox boxIn(const Drawing& drawing, const Box3d& box) { return OccludeeBox(drawing.screen, box, {}); }

Box3f floats(const Box3d& box) { return {glm::vec3(box.min), glm::vec3(box.max)}; }

/// Whether the tiles hide a box that has a rectangle; by its nearest point alone, or by planes as well.
bool hides(Drawing& drawing, const Box3d& box, bool by_planes, Seams seams = Seams::kResolve) {
    const BoxAnswer image = projectBox(drawing.screen, floats(box));
    if (image.doubt || image.outside) return false;
    const OccludeeBox asked = boxIn(drawing, box);
    return isHidden(drawing.tiles, image.rect, seams, by_planes ? &asked : nullptr);
}

/// Floors, ceilings and walls of one to many quads that are seen flat, steep or at a grazing angle; flat or folded.
Solid someSurface(Random& random) {
    const float noise = random.below(3) == 0 ? static_cast<float>(random.uniform(0, 0.1)) : 0.0f;
    const int columns = 1 + static_cast<int>(random.below(4)), rows = 1 + static_cast<int>(random.below(6));
    const float depth = static_cast<float>(random.uniform(1, 9)), width = static_cast<float>(random.uniform(1, 12));
    Solid sheet = makeSheet(random, columns, rows, {-width, -width, 0}, {width, width, 0}, noise);
    sheet.double_sided.assign(sheet.indices.size() / 3, 1);
    const double turn = random.uniform(-1.56, 1.56);
    const glm::dvec3 axis = random.below(2) ? glm::dvec3(1, 0, 0) : randomUnit(random);
    sheet.transform = glm::translate(glm::dmat4(1.0), {random.uniform(-2, 2), random.uniform(-2, 2), -depth});
    sheet.transform = glm::rotate(sheet.transform, turn, axis);
    return sheet;
}

/// A box that most likely lies close to a surface, on either side of it, or is cut by it.
Box3d someBox(Random& random, const std::vector<Solid>& solids) {
    const Solid& by = solids[random.below(solids.size())];
    const glm::vec3 at = by.positions[random.below(by.positions.size())];
    const double reach = std::pow(10.0, random.uniform(-3, 0.5)), size = std::pow(10.0, random.uniform(-3, 0.3));
    const glm::dvec3 inside(random.uniform(-0.9, 0.9) * at.x, random.uniform(-0.9, 0.9) * at.y, 0);
    const glm::dvec3 middle = glm::dvec3(by.transform * glm::dvec4(inside, 1)) - glm::dvec3(0, 0, reach);
    Box3d box;
    for (int i = 0; i < 2; ++i) box.grow(glm::dvec3(glm::vec3(middle + randomVector(random, size))));
    return box;
}

/// A point of a box that a ray meets first, if one is found among its corners and some others.
std::string findSeen(const Drawing& drawing, const RayCaster& rays, const Box3d& box, Random& random) {
    for (int i = 0; i < 40; ++i) {
        glm::dvec3 p;
        for (int axis = 0; axis < 3; ++axis) {
            const double at = i < 8 ? i >> axis & 1 : random.below(4) ? random.uniform() : double(random.below(2));
            p[axis] = box.min[axis] + at * (box.max[axis] - box.min[axis]);
        }
        const glm::dvec4 h(p, 1.0);
        const double w = glm::dot(drawing.screen.w, h);
        const double x = glm::dot(drawing.screen.x, h) / w, y = glm::dot(drawing.screen.y, h) / w;
        if (!(glm::dot(drawing.screen.near, h) > 0 && x > 0 && y > 0 && x < drawing.screen.width &&
              y < drawing.screen.height))
            continue;
        const double nearness = glm::dot(drawing.screen.d, h) / w, first = rays.cast(x, y);
        if (first >= nearness - 1e-12 * std::abs(nearness)) continue;
        std::ostringstream seen;
        seen << p.x << ", " << p.y << ", " << p.z << " at nearness " << nearness << " before " << first;
        return seen.str();
    }
    return {};
}

struct Tried {
    int hidden = 0, by_planes = 0;
};

/// Draws a few surfaces, asks many boxes, and holds each that is hidden to rays.
void expectRaysAgree(uint64_t seed, OcclusionDetail detail, Tried& tried) {
    Random random(seed);
    View view = smallView(96 + 8 * static_cast<uint32_t>(seed % 3), 64);
    if (seed % 4 == 3) view.projection = orthographic(6, 1.5, 0.1, 100);
    if (seed % 5 == 2) view.jitter = 2;
    Drawing drawing(view);
    drawing.tiles.clear(drawing.screen.width, drawing.screen.height, detail);
    std::vector<Solid> solids(1 + random.below(4));
    for (Solid& solid : solids) solid = someSurface(random);
    drawing.draw(solids);
    const RayCaster rays(drawing);
    for (int i = 0; i < 300; ++i) {
        const Box3d box = someBox(random, drawing.solids);
        const Seams seams = i % 3 ? Seams::kResolve : Seams::kLeave;
        const bool by_depth = hides(drawing, box, false, seams), by_planes = hides(drawing, box, true, seams);
        ASSERT_TRUE(by_planes || !by_depth) << "seed " << seed << ", box " << i;
        tried.hidden += by_planes;
        tried.by_planes += by_planes && !by_depth;
        if (!by_planes) continue;
        ASSERT_EQ(findSeen(drawing, rays, box, random), "") << "seed " << seed << ", box " << i;
    }
}

TEST(OccludeeBoxes, AreHiddenOnlyWhereNoRayMeetsThemFirst) {
    for (const OcclusionDetail detail : {OcclusionDetail::kFull, OcclusionDetail::kMasked}) {
        Tried tried;
        for (uint64_t seed = 1; seed <= 60 && !HasFatalFailure(); ++seed) expectRaysAgree(seed, detail, tried);
        EXPECT_GT(tried.hidden, 2000);
        EXPECT_GT(tried.by_planes, 400);
    }
}

TEST(OccludeeBoxes, HaveOneAnswerOnEveryInstructionSet) {
    std::vector<uint8_t> first;
    forEachTarget([&](const std::string& name) {
        std::vector<uint8_t> answers;
        for (uint64_t seed = 100; seed < 106; ++seed) {
            Random random(seed);
            Drawing drawing(smallView());
            drawing.draw({someSurface(random), someSurface(random)});
            for (int i = 0; i < 100; ++i) answers.push_back(hides(drawing, someBox(random, drawing.solids), true));
        }
        if (first.empty()) first = answers;
        EXPECT_EQ(answers, first) << name;
    });
}

/// By the corners, one after another, in long double.
TEST(OccludeeBoxes, LieBehindAPlaneWithAllTheirCorners) {
    Random random(7);
    int behind = 0, before = 0;
    for (int round = 0; round < 20000; ++round) {
        View view = anyView(random);
        const Screen screen = makeScreen(view, 640);
        DepthTiles tiles;
        BufferPlane& plane = tiles.planes.emplace_back();
        plane.dx = random.uniform(-1e-3, 1e-3);
        plane.dy = random.uniform(-1e-3, 1e-3);
        plane.d0 = random.uniform(-0.2, 0.6);
        plane.error = static_cast<float>(random.uniform(0, 1e-4));
        Box3d box;
        for (int i = 0; i < 2; ++i) box.grow(randomVector(random, 20.0));
        long double least = std::numeric_limits<long double>::infinity(), size = 0;
        for (int i = 0; i < 8; ++i) {
            const auto along = [&](const glm::dvec4& row) {
                long double sum = row.w;
                for (int axis = 0; axis < 3; ++axis)
                    sum += static_cast<long double>(row[axis]) * (i >> axis & 1 ? box.max[axis] : box.min[axis]);
                return sum;
            };
            const long double x = plane.dx * along(screen.x), y = plane.dy * along(screen.y),
                              w = (static_cast<long double>(plane.d0) - plane.error) * along(screen.w),
                              d = along(screen.d);
            least = std::min(least, x + y + w - d);
            size = std::max(size, std::abs(x) + std::abs(y) + std::abs(w) + std::abs(d));
        }
        const bool answer = OccludeeBox(screen, box, {}).isBehind(tiles, 0u);
        const bool again = OccludeeBox(OccludeeBox(screen, box, {}).image()).isBehind(tiles, 0u);
        EXPECT_EQ(answer, again);
        ASSERT_TRUE(!answer || least > 0) << "round " << round;
        ASSERT_TRUE(answer || !(least > 1e-9L * size + 1e-9L)) << "round " << round;
        behind += answer;
        before += !answer;
    }
    EXPECT_GT(behind, 1000);
    EXPECT_GT(before, 1000);
}

/// A floor of one or two quads, a metre below the eye and twenty long.
Solid floorOf(const std::vector<std::array<float, 2>>& across) {
    Solid floor;
    for (const auto& [left, right] : across)
        floor.add({{left, -1, -2}, {right, -1, -2}, {right, -1, -22}, {left, -1, -22}});
    floor.double_sided.assign(floor.indices.size() / 3, 1);
    return floor;
}

/// A hand below the floor, far away: within a pixel there the floor's depth spans metres.
const Box3d kBelow{{-0.3, -1.2, -12.3}, {0.3, -1.1, -12}};

TEST(OccludeeBoxes, AreHiddenBelowAFloorThatDepthsSeeThrough) {
    Drawing drawing(smallView());
    drawing.draw({floorOf({{-4, 4}})});
    EXPECT_FALSE(hides(drawing, kBelow, false));
    EXPECT_TRUE(hides(drawing, kBelow, true));
    Box3d through = kBelow;
    through.max.y = -0.99;
    EXPECT_FALSE(hides(drawing, through, true)) << "it stands out of the floor";
}

TEST(OccludeeBoxes, AreHiddenAlongTheSeamOfTwoQuads) {
    for (const bool one_object : {true, false}) {
        Drawing drawing(smallView());
        std::vector<Solid> floors = {floorOf({{-4, 0.01f}, {0.01f, 4}})};
        if (!one_object) floors = {floorOf({{-4, 0.01f}}), floorOf({{0.01f, 4}})};
        drawing.draw(floors);
        EXPECT_TRUE(hides(drawing, kBelow, true)) << one_object;
    }
    Drawing apart(smallView());
    apart.draw({floorOf({{-4, -0.1f}, {0.1f, 4}})});
    EXPECT_FALSE(hides(apart, kBelow, true)) << "it is seen between them";
}

TEST(OccludeeBoxes, AreNotHiddenByCoversThatHaveNoPlane) {
    Drawing drawing(smallView());
    EXPECT_FALSE(boxIn(drawing, kBelow).isBehind(drawing.tiles, PlaneSet()));
    EXPECT_FALSE(hides(drawing, kBelow, true));
}

/// Of more covers than a tile holds those of the fewest pixels go.
TEST(OccludeeBoxes, AreAskedByTheCoversOfTheMostPixels) {
    DepthTiles tiles;
    tiles.clear(8, 8);
    for (uint32_t i = 0; i < 3 * DepthTiles::kCovers; ++i) noteCover(tiles, 0, (uint64_t{2} << i) - 1, PlaneSet(i));
    EXPECT_EQ(coveredByPlanes(tiles, 0), (uint64_t{1} << 3 * DepthTiles::kCovers) - 1);
    ASSERT_EQ(tiles.cover_count[0], DepthTiles::kCovers);
    for (uint32_t i = 0; i < DepthTiles::kCovers; ++i)
        EXPECT_GE(tiles.covers[i].planes.plane[0], 2 * DepthTiles::kCovers);
    noteCover(tiles, 0, uint64_t{1} << 60, tiles.covers[0].planes);
    EXPECT_EQ(tiles.cover_count[0], DepthTiles::kCovers);
    EXPECT_EQ(coveredByPlanes(tiles, 0) >> 60, 1u);
}

}  // namespace
}  // namespace sightline::test
