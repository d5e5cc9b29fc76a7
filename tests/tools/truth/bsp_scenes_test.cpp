// On real scenes and a city a BSP tree stays small, and drawing by it both ways shows what is nearest.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>

#include <gtest/gtest.h>

#include "sightline/studies/hidden/bsp/bsp_render.h"
#include "sightline/studies/hidden/compare.h"
#include "sightline/tools/scene/city/city.h"
#include "tests/studies/hidden/made_lists.h"
#include "tests/support/shared_scenes.h"
#include "tests/tools/truth/scene_views.h"

namespace sightline::test {
using namespace studies;
using namespace tools;
namespace {

/// One tree, three views, drawn in all four ways.
void expectRight(const char* name, const Scene& scene, double pieces_per_polygon) {
    const SceneFacts facts(scene);
    const std::vector<DrawItem> items = itemsOf(facts);
    const DrawList list(items);
    const auto start = std::chrono::steady_clock::now();
    const BspScene bsp = buildBspScene(list);
    const std::chrono::duration<double, std::milli> took = std::chrono::steady_clock::now() - start;
    const BspStatistics statistics = statisticsOf(bsp.tree);
    std::printf("%-24s %7zu polygons (%zu degenerate), %7zu pieces (%.2f), depth %u (mean %.1f), built in %.0f ms\n",
                name, size_t(statistics.polygons), size_t(statistics.degenerate), size_t(statistics.pieces),
                statistics.pieces_per_polygon, statistics.depth, statistics.mean_depth, took.count());
    EXPECT_LE(statistics.pieces_per_polygon, pieces_per_polygon) << name;
    for (const View& view : viewsOf(worldBounds(scene), 7)) {
        const HiddenImage truth = nearestSurfaces(list, view);
        RenderSettings settings;
        const HiddenInput input{list, view, settings};
        HiddenImage painted = emptyImage(view);
        drawBspBackToFront(bsp, input, painted);
        const Agreement agreement = compareImages(list, view, truth, painted);
        std::printf("%-24s %7zu drawn, %zu samples differ: at edges %zu, ties %zu, wrong %zu;", name,
                    size_t(painted.counters.geometry.produced), size_t(agreement.differing), size_t(agreement.at_edges),
                    size_t(agreement.ties), size_t(agreement.wrong));
        EXPECT_EQ(agreement.wrong, 0u) << name << ": row " << agreement.row << ", sample " << agreement.sample
                                       << " shows " << agreement.found << ", expected " << agreement.expected;
        for (const FreeSamples kind : {FreeSamples::kCheck, FreeSamples::kSegments, FreeSamples::kBits}) {
            settings.free_samples = kind;
            HiddenImage image = emptyImage(view);
            drawBspFrontToBack(bsp, input, image);
            EXPECT_TRUE(image.surface == painted.surface) << name << ", kind " << int(kind);
            std::printf(" generated %zu,", size_t(image.counters.generated));
        }
        std::printf(" painted %zu\n", size_t(painted.counters.generated));
    }
}

using BspScenes = test::SceneTest;

TEST_P(BspScenes, ShowWhatIsNearest) { expectRight(GetParam(), *scene, 3.0); }

INSTANTIATE_TEST_SUITE_P(Scenes, BspScenes, kSmallScenes, sceneLabel);

TEST(BspCity, ShowsWhatIsNearest) { expectRight("city", makeCity(1, 300), 3.0); }

}  // namespace
}  // namespace sightline::test
