// The z-fighting map: it marks the samples where the order of drawing decides, and those alone.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/z_fighting.h"

#include <gtest/gtest.h>

#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
namespace {

/// A tilted wall, or the same a little farther away from the eye.
MadeList wall(float scale) {
    MadeList made;
    const glm::vec3 corners[4] = {{-300, -200, -20}, {300, -200, -400}, {300, 200, -900}, {-300, 200, -600}};
    made.add(scale * corners[0], scale * corners[1], scale * corners[2]);
    made.add(scale * corners[0], scale * corners[2], scale * corners[3]);
    return made;
}

View farView(bool parallel) {
    View view = madeView(120, 90);
    view.projection = parallel ? orthographic(300, 4.0 / 3, 0.1, 10000) : perspective(1.0, 4.0 / 3, 0.1, 10000);
    return view;
}

TEST(ZFighting, MarksWhereTheOrderOfDrawingDecides) {
    const MadeList near_wall = wall(1.0f), far_wall = wall(1.0003f);
    DrawItem items[2] = {near_wall.items()[0], far_wall.items()[0]};
    items[0].id = 1;
    items[1].id = 2;
    for (const bool parallel : {false, true})
        for (int format = 0; format < kDepthFormats; ++format) {
            const View view = farView(parallel);
            const DrawItem turned[2] = {items[1], items[0]};
            const DrawList list(items), other(turned);
            RenderSettings settings;
            settings.depth.format = static_cast<DepthFormat>(format);
            const HiddenImage one = render(list, view, settings), two = render(other, view, settings);
            const ZFightingMap map = findZFighting(list, view, settings.depth.format);
            uint64_t differing = 0;
            for (size_t i = 0; i < map.fights.size(); ++i) {
                const bool shown = one.surface[i] != HiddenImage::kNone && two.surface[i] != HiddenImage::kNone;
                const bool differs = shown && list.idOf(one.surface[i]) != other.idOf(two.surface[i]);
                ASSERT_EQ(differs, map.fights[i] == Fight::kFormat)
                    << kDepthFormatNames[format] << (parallel ? " parallel" : "") << " sample " << i;
                differing += differs;
                if (differs) { EXPECT_LE(map.gap_in_steps[i], 1.01f); }
            }
            EXPECT_EQ(differing, map.fighting);
            EXPECT_EQ(map.coplanar, 0u);
            EXPECT_GT(map.overlaid, 1000u);
            if (parallel) continue;
            if (format == static_cast<int>(DepthFormat::kUnorm16)) { EXPECT_GT(2 * map.fighting, map.overlaid); }
            if (format == static_cast<int>(DepthFormat::kReversedFloat)) { EXPECT_EQ(map.fighting, 0u); }
        }
}

TEST(ZFighting, KnowsWhatLiesInOnePlane) {
    const MadeList made = coplanar(3);
    const DrawList list = made.list();
    const ZFightingMap map = findZFighting(list, madeView(), DepthFormat::kReversedFloat);
    EXPECT_GT(map.overlaid, 100u);
    EXPECT_GT(map.coplanar + map.fighting, 0.99 * static_cast<double>(map.overlaid));
    EXPECT_GT(map.coplanar, map.fighting);
}

}  // namespace
}  // namespace sightline::test
