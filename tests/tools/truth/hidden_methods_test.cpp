// On real scenes the list-priority, area and ray methods show what is nearest.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>

#include <gtest/gtest.h>

#include "sightline/studies/hidden/compare.h"
#include "sightline/studies/hidden/rays/raycast.h"
#include "tests/studies/hidden/made_lists.h"
#include "tests/support/shared_scenes.h"
#include "tests/tools/truth/scene_views.h"

namespace sightline::test {
using namespace studies;
using namespace tools;
namespace {

struct NamedSettings {
    const char* name;
    RenderSettings settings;
    AgreementBands bands;
};

std::vector<NamedSettings> allSettings() {
    std::vector<NamedSettings> all;
    const auto add = [&](const char* name, HiddenMethod method) -> NamedSettings& {
        all.push_back({name, {}, {}});
        all.back().settings.method = method;
        return all.back();
    };
    add("newell", HiddenMethod::kNewell);
    add("warnock", HiddenMethod::kWarnock);
    add("rays", HiddenMethod::kRaycast);
    if (hasEmbree()) {
        NamedSettings& embree = add("rays, Embree", HiddenMethod::kRaycast);
        embree.settings.ray_tracer = RayTracer::kEmbree;
        embree.bands.edge = 0.05;
        embree.bands.tie = 1e-4;
    }
    return all;
}

using HiddenMethods = test::SceneTest;

TEST_P(HiddenMethods, ShowWhatIsNearest) {
    const SceneFacts facts(*scene);
    const std::vector<DrawItem> items = itemsOf(facts);
    const DrawList list(items);
    uint64_t shown = 0;
    for (const View& view : viewsOf(worldBounds(*scene), 1)) {
        const HiddenImage truth = nearestSurfaces(list, view);
        for (const uint32_t surface : truth.surface) shown += surface != HiddenImage::kNone;
        for (const NamedSettings& named : allSettings()) {
            const HiddenImage found = render(list, view, named.settings);
            const Agreement agreement = compareImages(list, view, truth, found, named.bands);
            const HiddenCounters& counters = found.counters;
            std::printf(
                "%-24s %-12s %7llu polygons, %6llu samples differ: %5llu at edges, %5llu ties, %3llu wrong; "
                "%9llu comparisons, %6llu swaps, %5llu splits, %7llu windows, %llu ms\n",
                GetParam(), named.name, static_cast<unsigned long long>(counters.geometry.produced),
                static_cast<unsigned long long>(agreement.differing),
                static_cast<unsigned long long>(agreement.at_edges), static_cast<unsigned long long>(agreement.ties),
                static_cast<unsigned long long>(agreement.wrong), static_cast<unsigned long long>(counters.comparisons),
                static_cast<unsigned long long>(counters.swaps), static_cast<unsigned long long>(counters.splits),
                static_cast<unsigned long long>(counters.windows),
                static_cast<unsigned long long>(counters.nanoseconds / 1000000));
            EXPECT_EQ(agreement.wrong, 0u)
                << named.name << ": row " << agreement.row << " sample " << agreement.sample << ": "
                << int32_t(agreement.found) << " for " << int32_t(agreement.expected);
            if (named.settings.method == HiddenMethod::kNewell) {
                EXPECT_EQ(counters.tested, 0u) << "the limit was reached";
            }
        }
    }
    EXPECT_GT(shown, 320u * 180 / 8) << "the views show next to nothing";
}

/// All scenes of up to 150,000 triangles.
INSTANTIATE_TEST_SUITE_P(Scenes, HiddenMethods, kSmallScenes, sceneLabel);

}  // namespace
}  // namespace sightline::test
