// Explanations are true in procedural cities, walked along their streets and seen from seeded places.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/city/city.h"
#include "tests/support/explain_laws.h"

namespace sightline::test {
using namespace tools;
namespace {

TEST(ExplainCity, IsTrueInStreetsAndAbove) {
    LawCount sum;
    for (uint64_t seed = 1; seed <= 3; ++seed) {
        const Scene scene = makeCity(seed, 1000);
        LoadedWorld loaded = loadWorld(scene);
        const Snapshot now = loaded.world.commit();
        CameraPath path = cityStreetPath(seed, 4);
        for (const CameraFrame& frame : seededCameras(scene, 3, seed).frames) path.frames.push_back(frame);
        Random random(seed);
        for (size_t frame = 0; frame < path.frames.size(); ++frame) {
            CameraFrame camera = path.frames[frame];
            if (frame == 2) camera.orthographic_height = 40;
            const View view = makeView(camera, 640, 360);
            Laws laws(now, view, {}, "city " + std::to_string(seed) + " frame " + std::to_string(frame));
            laws.expectTrueOfSome(random, 5);
            sum.add(laws.count);
            if (HasFailure()) return;
        }
    }
    EXPECT_GT(sum.occluded, 60u);
    EXPECT_GT(sum.open_pixels, 50u);
    sum.record();
}

}  // namespace
}  // namespace sightline::test
