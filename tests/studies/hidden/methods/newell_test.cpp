// Newell's algorithm gives the truth's image, each of its tests decides somewhere alone, and cuts lose no sample.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/newell.h"

#include <gtest/gtest.h>

#include "tests/studies/hidden/agreement.h"

namespace sightline::test {
using namespace studies;
namespace {

RenderSettings newell() {
    RenderSettings settings;
    settings.method = HiddenMethod::kNewell;
    return settings;
}

std::vector<ScreenPolygon> project(const MadeList& made, const View& view) {
    Projector projector(view, {view.width, view.height, 0, 1, {}});
    return projectAll(made.list(), projector);
}

/// The test that lets the first of two triangles be drawn before the second.
NewellTest testOf(const MadeList& made) {
    const View view = madeView();
    const std::vector<ScreenPolygon> polygons = project(made, view);
    if (polygons.size() != 2) {
        ADD_FAILURE() << polygons.size() << " polygons";
        return NewellTest::kNone;
    }
    const NewellPiece first = wholePiece(polygons[0], 160, 120), second = wholePiece(polygons[1], 160, 120);
    return mayBeDrawnBefore(first, second);
}

TEST(Newell, ShowsWhatIsNearest) { expectAgreement("newell", newell()); }

TEST(Newell, DrawsNothingWhereThereIsNothing) { expectEmptyImages(newell()); }

TEST(Newell, DepthAloneDecides) {
    MadeList made;
    made.add({-1, -1, -5}, {1, -1, -5}, {0, 1, -5});
    made.add({-1, -1, -3}, {1, -1, -4}, {0, 1, -4});
    EXPECT_EQ(testOf(made), NewellTest::kDepth);
}

/// In all the following cases the first triangle reaches nearer than the second begins.
TEST(Newell, ColumnsAloneDecide) {
    MadeList made;
    made.add({-1, -1, -2}, {-0.1f, -1, -6}, {-0.5f, 1, -4});
    made.add({0.1f, -1, -6}, {1, -1, -2}, {0.5f, 1, -4});
    EXPECT_EQ(testOf(made), NewellTest::kColumns);
}

TEST(Newell, RowsAloneDecide) {
    MadeList made;
    made.add({-1, -1, -2}, {1, -1, -6}, {0, -0.1f, -4});
    made.add({-1, 0.1f, -6}, {1, 0.1f, -2}, {0, 1, -4});
    EXPECT_EQ(testOf(made), NewellTest::kRows);
}

TEST(Newell, BeingWhollyBehindTheOthersPlaneAloneDecides) {
    // A floor that rises towards the eye, and a larger wall across it that passes in front, its plane before all of the
    // floor while the floor's plane cuts it.
    MadeList made;
    made.add({-0.3f, -0.5f, -4}, {0.3f, -0.5f, -4}, {0, 0.2f, -6});
    made.add({-2, -1.5f, -3.5f}, {2, -1.5f, -3.5f}, {0, 2, -5});
    EXPECT_EQ(testOf(made), NewellTest::kBehind);
}

TEST(Newell, BeingWhollyInFrontOfTheFirstsPlaneAloneDecides) {
    // The large one lies behind, its plane behind all of the small one, whose own plane cuts it.
    MadeList made;
    made.add({-2, -1.5f, -3.5f}, {2, -1.5f, -3.5f}, {0, 2, -5});
    made.add({-0.3f, -0.5f, -3.2f}, {0.3f, -0.5f, -3.2f}, {0, 0.2f, -3.9f});
    EXPECT_EQ(testOf(made), NewellTest::kInFront);
}

TEST(Newell, DisjointProjectionsAloneDecide) {
    // Beside one another along a diagonal, each with a plane that cuts the other.
    MadeList made;
    made.add({-1, -1, -3}, {0.9f, -1, -6}, {-1, 0.9f, -4});
    made.add({1, -0.8f, -4}, {1, 1, -3}, {-0.8f, 1, -6});
    EXPECT_EQ(testOf(made), NewellTest::kDisjoint);
}

TEST(Newell, NothingDecidesWherePolygonsPassThroughOneAnother) {
    MadeList made;
    made.add({-1, -1, -3}, {1, -1, -5}, {0, 1, -4});
    made.add({-1, -0.9f, -5}, {1, -0.9f, -3}, {0, 0.9f, -4});
    EXPECT_EQ(testOf(made), NewellTest::kNone);
}

TEST(Newell, DrawsTheLowerSurfaceOfOnePlaneLast) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        const MadeList made = coplanar(seed);
        const DrawList list = made.list();
        View view = madeView();
        EXPECT_EQ(render(list, view, newell()).surface, nearestSurfaces(list, view).surface) << made.name;
    }
}

TEST(Newell, SwapsWhereTheFarthestPointMisleads) {
    // The floor has the farthest point of all and yet is in front of the wall that stands below it.
    MadeList made;
    made.add({-3, -0.2f, -1}, {3, -0.2f, -1}, {0, -0.2f, -20});
    made.add({-1, -3, -12}, {1, -3, -12}, {0, -0.3f, -12});
    const DrawList list = made.list();
    const HiddenImage image = render(list, madeView(), newell());
    EXPECT_EQ(image.counters.swaps, 1u);
    EXPECT_EQ(image.counters.splits, 0u);
    EXPECT_EQ(image.surface, nearestSurfaces(list, madeView()).surface);
}

TEST(Newell, CutsACycleAndNothingWithoutNeed) {
    const MadeList cycle = cyclicOverlap();
    const std::vector<DrawItem> items = cycle.items();
    EXPECT_GE(render(DrawList(items), madeView(), newell()).counters.splits, 1u);
    // Faces of boxes side by side: in order without a cut.
    MadeList boxes;
    for (int i = 0; i < 5; ++i) {
        const float x = -2.0f + static_cast<float>(i), z = -4.0f - static_cast<float>(i % 2);
        boxes.addBar({x, -1, z}, {x, 1, z}, {0.3f, 0, 0});
        boxes.addBar({x + 0.3f, 0, z}, {x + 0.3f, 0, z - 0.6f}, {0, 1, 0});
        boxes.addBar({x - 0.3f, 0, z}, {x - 0.3f, 0, z - 0.6f}, {0, 1, 0});
    }
    const HiddenImage image = render(boxes.list(), madeView(), newell());
    EXPECT_EQ(image.counters.splits, 0u);
}

/// Three triangles in a cycle, each pair in order by the tests: then it is not their planes that say where to cut.
TEST(Newell, CutsACycleOfPairsThatAreInOrder) {
    int cycles = 0;
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        MadeList made;
        for (int i = 0; i < 3; ++i) {
            // Long ones, turned by a third of a circle each, the near end over the next one's far end.
            const double angle = 2.0943951023931953 * i + random.uniform(-0.3, 0.3);
            const glm::dvec3 along(std::cos(angle), std::sin(angle), random.uniform(-0.2, 0.2)),
                aside(-std::sin(angle), std::cos(angle), random.uniform(-0.5, 0.5));
            const glm::dvec3 start = -0.5 * aside - along - glm::dvec3(0, 0, 4);
            const double length = random.uniform(1.5, 2.5), width = random.uniform(0.05, 0.6);
            made.add(glm::vec3(start), glm::vec3(start + length * along),
                     glm::vec3(start + 0.5 * length * along + width * aside));
        }
        const View view = madeView(80, 60);
        const std::vector<ScreenPolygon> polygons = project(made, view);
        if (polygons.size() != 3) continue;
        NewellPiece pieces[3];
        for (int i = 0; i < 3; ++i) pieces[i] = wholePiece(polygons[size_t(i)], 80, 60);
        const auto only = [&](int a, int b) {
            return !pieces[a].runs.empty() && !pieces[b].runs.empty() &&
                   mayBeDrawnBefore(pieces[a], pieces[b]) != NewellTest::kNone &&
                   mayBeDrawnBefore(pieces[b], pieces[a]) == NewellTest::kNone;
        };
        if (!(only(0, 1) && only(1, 2) && only(2, 0)) && !(only(1, 0) && only(2, 1) && only(0, 2))) continue;
        ++cycles;
        const DrawList list = made.list();
        const HiddenImage image = expectNearest(list, view, newell(), "seed " + std::to_string(seed));
        EXPECT_GE(image.counters.splits, 1u) << "seed " << seed;
    }
    EXPECT_GE(cycles, 10);
}

TEST(Newell, PiecesOfATriangleHaveEachOfItsSamplesOnce) {
    for (const MadeList& made : madeLists()) {
        const View view = madeView();
        const std::vector<ScreenPolygon> polygons = project(made, view);
        HiddenCounters counters;
        const NewellOrder order = newellOrder(polygons, view.width, view.height, counters, ~0ull);
        EXPECT_EQ(order.proved, order.order.size());
        std::vector<std::vector<uint8_t>> painted(polygons.size(), std::vector<uint8_t>(160 * 120, 0));
        for (const uint32_t place : order.order) {
            const NewellPiece& piece = order.pieces[place];
            for (const SampleRun& run : piece.runs)
                for (int32_t i = run.begin; i < run.end; ++i)
                    ++painted[size_t(piece.polygon - polygons.data())][size_t(run.row * 160 + i)];
        }
        uint64_t wrong = 0;
        for (size_t i = 0; i < polygons.size(); ++i) {
            scanPolygon(polygons[i].outline(), 0, 120, 160, [&](int32_t row, int32_t begin, int32_t end) {
                for (int32_t j = begin; j < end; ++j) --painted[i][size_t(row * 160 + j)];
            });
            for (const uint8_t left : painted[i]) wrong += left != 0;
        }
        EXPECT_EQ(wrong, 0u) << made.name;
    }
}

TEST(Newell, DrawsTheRestSampleBySampleBeyondItsLimit) {
    const MadeList made = interpenetration(7, 40);
    const View view = madeView();
    const std::vector<ScreenPolygon> polygons = project(made, view);
    for (const uint64_t limit : {uint64_t{0}, uint64_t{50}, uint64_t{500}}) {
        HiddenCounters counters;
        const NewellOrder order = newellOrder(polygons, view.width, view.height, counters, limit);
        EXPECT_LT(order.proved, order.order.size());
        HiddenImage image = emptyImage(view);
        drawInOrder(order, image);
        const DrawList list = made.list();
        EXPECT_EQ(compareImages(list, view, nearestSurfaces(list, view), image).wrong, 0u) << limit;
        EXPECT_GT(image.counters.tested, 0u);
    }
}

TEST(Newell, CountsFragmentsBySampleAndInSum) {
    const MadeList made = clutter(5, 300);
    RenderSettings settings = newell();
    settings.want_counts = true;
    const HiddenImage image = render(made.list(), madeView(), settings);
    uint64_t sum = 0;
    for (const uint16_t count : image.generated) sum += count;
    EXPECT_EQ(sum, image.counters.generated);
    EXPECT_EQ(image.counters.shaded, image.counters.generated);
    EXPECT_GT(image.counters.comparisons, 0u);
}

}  // namespace
}  // namespace sightline::test
