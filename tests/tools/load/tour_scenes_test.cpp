// Tours of real scenes: connected, over a floor, with something to see in nearly all frames.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include <gtest/gtest.h>

#include "sightline/tools/load/floor.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/load/tour.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
namespace {
using namespace tools;

/// How much of an image one flat surface fills, by rays; all of it where nothing is seen.
double ofOneSurface(const Scene& scene, const RayProbe& probe, const CameraFrame& frame) {
    constexpr int kWide = 16, kHigh = 9;
    const View view = makeView(frame, 160, 90);
    const glm::dmat4 from_clip = glm::inverse(view.projection * view.view);
    const double unit = 1e-3 * glm::length(worldBounds(scene).size());
    std::map<std::tuple<long, long, long, long>, int> surfaces;
    int most = 0;
    for (int i = 0; i < kWide * kHigh; ++i) {
        const double x = (i % kWide + 0.5) / kWide * 2 - 1, y = (static_cast<double>(i / kWide) + 0.5) / kHigh * 2 - 1;
        const glm::dvec4 p = from_clip * glm::dvec4(x, y, 0.5, 1);
        const glm::dvec3 direction = glm::normalize(glm::dvec3(p) / p.w - frame.eye);
        const auto hit = probe.nearest({frame.eye, direction});
        if (hit) {
            const glm::dvec3 n = probe.normal(*hit), a = frame.eye + hit->t * direction;
            const auto rounded = [](double value) { return std::lround(value); };
            most = std::max(
                most,
                ++surfaces[{rounded(20 * n.x), rounded(20 * n.y), rounded(20 * n.z), rounded(glm::dot(n, a) / unit)}]);
        }
    }
    if (surfaces.empty()) return 1;
    return most / static_cast<double>(kWide * kHigh);
}

class TourOfScene : public test::SceneTest {};

TEST_P(TourOfScene, IsConnectedAndShowsSomething) {
    const RayProbe probe(*scene);
    for (uint64_t seed = 11; seed <= 14; ++seed) {
        const CameraPath path = tourOf(*scene, 16, seed);
        ASSERT_EQ(path.frames.size(), 16u);
        int single = 0;
        for (const CameraFrame& frame : path.frames) single += ofOneSurface(*scene, probe, frame) > 0.9 ? 1 : 0;
        EXPECT_LE(single, 1) << "seed " << seed;
        for (size_t i = 2; i < 16; ++i) {
            const glm::dvec3 from = path.frames[i - 1].eye, along = path.frames[i].eye - from;
            if (!(glm::length(along) > 0)) continue;
            const auto hit = probe.nearest({from, along});
            EXPECT_FALSE(hit && hit->t < 1) << "seed " << seed << ", frame " << i << " is behind a surface";
        }
    }
}

TEST_P(TourOfScene, WalksWhereThereAreRoomsOrStreets) {
    const std::string name = GetParam();
    const bool thing =
        name == "2CylinderEngine" || name == "dense-spot" || name == "gazebo-pr2" || name == "polyhaven-dutch-ship";
    const RayProbe probe(*scene);
    for (uint64_t seed = 11; seed <= 16; ++seed)
        EXPECT_EQ(findFloor(*scene, probe, seed).places.empty(), thing) << "seed " << seed;
}

INSTANTIATE_TEST_SUITE_P(Shared, TourOfScene, test::kSmallScenes, test::sceneLabel);

}  // namespace
}  // namespace sightline
