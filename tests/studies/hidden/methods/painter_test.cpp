// The painter's algorithm: right where one depth a polygon is enough, and known to be wrong where it is not.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/painter.h"

#include <gtest/gtest.h>

#include "sightline/studies/hidden/compare.h"
#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
namespace {

Agreement paint(const MadeList& made, PainterKey key) {
    const DrawList list = made.list();
    RenderSettings settings;
    settings.method = HiddenMethod::kPainter;
    settings.painter_key = key;
    const View view = madeView();
    return compareImages(list, view, nearestSurfaces(list, view), render(list, view, settings));
}

TEST(Painter, IsRightForPolygonsWithoutCommonDepths) {
    MadeList made;
    Random random(3);
    for (int i = 0; i < 50; ++i) {
        glm::vec3 p[3];
        for (glm::vec3& v : p)
            v = glm::vec3(random.uniform(-2, 2), random.uniform(-2, 2),
                          -2.0 - 0.1 * ((i * 17) % 50) - random.uniform(0, 0.09));
        made.add(p[0], p[1], p[2]);
    }
    for (const PainterKey key : {PainterKey::kCentre, PainterKey::kFarthest}) EXPECT_EQ(paint(made, key).wrong, 0u);
}

TEST(Painter, IsWrongForCyclesAndInterpenetration) {
    for (const PainterKey key : {PainterKey::kCentre, PainterKey::kFarthest}) {
        EXPECT_GT(paint(cyclicOverlap(), key).wrong, 0u);
        EXPECT_GT(paint(interpenetration(1), key).wrong, 0u);
    }
}

TEST(Painter, SortingByCentreIsWrongWhereTheFarthestPointIsRight) {
    // A long floor under a small square: the floor's centre is nearer than the square, which stands on its far part.
    MadeList made;
    made.add({-3, -1, -1}, {3, -1, -1}, {0, -1, -20});
    made.add({-0.5f, -0.99f, -12}, {0.5f, -0.99f, -12}, {0, 0, -12});
    EXPECT_EQ(paint(made, PainterKey::kFarthest).wrong, 0u);
    EXPECT_GT(paint(made, PainterKey::kCentre).wrong, 0u);
}

TEST(Painter, ShadesEveryFragment) {
    const MadeList made = clutter(5, 300);
    const DrawList list = made.list();
    RenderSettings settings;
    settings.method = HiddenMethod::kPainter;
    settings.want_counts = true;
    const HiddenImage image = render(list, madeView(), settings);
    uint64_t sum = 0;
    for (uint16_t count : image.shaded) sum += count;
    EXPECT_GT(sum, 0u);
    EXPECT_EQ(sum, image.counters.shaded);
    EXPECT_EQ(image.counters.generated, image.counters.shaded);
    EXPECT_EQ(image.counters.tested, 0u);
}

}  // namespace
}  // namespace sightline::test
