// Warnock's algorithm: the truth's image for any polygons, by as few windows as the image needs.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/warnock.h"

#include <gtest/gtest.h>

#include "tests/studies/hidden/agreement.h"

namespace sightline::test {
using namespace studies;
namespace {

RenderSettings warnock() {
    RenderSettings settings;
    settings.method = HiddenMethod::kWarnock;
    return settings;
}

HiddenImage draw(const MadeList& made, const View& view = madeView()) { return render(made.list(), view, warnock()); }

TEST(Warnock, ShowsWhatIsNearest) { expectAgreement("warnock", warnock()); }

TEST(Warnock, DrawsNothingWhereThereIsNothing) { expectEmptyImages(warnock()); }

TEST(Warnock, NeedsOneWindowForOnePolygon) {
    MadeList made;
    EXPECT_EQ(draw(made).counters.windows, 1u);
    made.add({-1, -1, -4}, {1, -1, -4}, {0, 1, -4});
    const HiddenImage image = draw(made);
    EXPECT_EQ(image.counters.windows, 1u);
    EXPECT_GT(image.counters.passed, 0u);
}

TEST(Warnock, NeedsOneWindowWhereASurroundingPolygonIsInFrontOfAll) {
    MadeList made = clutter(1, 200);
    for (glm::vec3& p : made.positions) p.z = -3.0f + 0.1f * p.z;
    made.add({-9, -9, -0.5f}, {9, -9, -1.5f}, {0, 15, -1});
    const HiddenImage image = draw(made);
    EXPECT_EQ(image.counters.windows, 1u);
    for (const uint32_t surface : image.surface) EXPECT_EQ(surface, 200u);
}

TEST(Warnock, DividesWhereAPolygonsPlaneButNotThePolygonIsInFrontAtACorner) {
    // Beyond its own extents the small one's plane passes through the large one.
    MadeList made;
    made.add({-9, -9, -3}, {9, -9, -3}, {0, 15, -3});
    made.add({-0.5f, -0.5f, -3.1f}, {0.5f, -0.5f, -3.1f}, {0, 0.5f, -5});
    EXPECT_EQ(draw(made).counters.windows, 1u) << "its nearest point is behind";
    made.add({-0.5f, -0.5f, -2.9f}, {0.5f, -0.5f, -2.9f}, {0, 0.5f, -5});
    EXPECT_GT(draw(made).counters.windows, 1u);
}

TEST(Warnock, SharesEdgesWithoutCracksOrDoubles) {
    // Strips of triangles that tile the screen: as many fragments as samples.
    Random random(11);
    MadeList made;
    glm::vec3 points[9][9];
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j)
            points[i][j] = {-4.0f + static_cast<float>(i) + (i % 8 ? float(random.uniform(-0.4, 0.4)) : 0.0f),
                            -4.0f + static_cast<float>(j) + (j % 8 ? float(random.uniform(-0.4, 0.4)) : 0.0f), -3.0f};
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            made.add(points[i][j], points[i + 1][j], points[i + 1][j + 1]);
            made.add(points[i][j], points[i + 1][j + 1], points[i][j + 1]);
        }
    const HiddenImage image = draw(made);
    EXPECT_EQ(image.counters.passed, image.surface.size());
    EXPECT_EQ(image.surface, nearestSurfaces(made.list(), madeView()).surface);
    EXPECT_EQ(image.counters.splits, 0u);
}

TEST(Warnock, PaintsEachSampleOnce) {
    for (const MadeList& made : madeLists()) {
        const HiddenImage image = draw(made);
        EXPECT_EQ(image.counters.passed, covered(image)) << made.name;
    }
}

}  // namespace
}  // namespace sightline::test
