// What is said about a false cull replays it.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/cull_path.h"

#include <atomic>

#include "tests/cli/tool.h"

namespace sightline::cli {
using namespace tools;
namespace {

/// An object that was wrongly culled in the second of two frames.
struct WrongRun {
    Scene scene;
    CullRun run;
    RunOptions options;

    WrongRun() {
        scene.objects.resize(1);
        scene.objects[0].key = 7;
        scene.objects[0].name = "a lamp";
        options.scene.names = {"my scene.glb"};
        options.rays = 1234;
        run.width = 640;
        run.height = 360;
        run.jitter = 0.25;
        run.settings.stages = stageBit(Stage::kFrustum);
        run.frames.resize(2);
        run.frames[1].camera.eye = {0.1, 1.0 / 3, 1e6};
        run.frames[1].verification.emplace();
        run.frames[1].verification->false_culls = 1;
        run.frames[1].verification->rows.push_back({0, 7, 12.5, 99.25, "rays"});
    }
};

using CullPath = Tool;

TEST_F(CullPath, FalseCullIsNamedWithItsPlaceAndItsReplay) {
    WrongRun wrong;
    wrong.options.json = path("result.json");
    testing::internal::CaptureStderr();
    ASSERT_TRUE(explainFalseCulls(wrong.scene, wrong.options, wrong.run).ok());
    const std::string said = testing::internal::GetCapturedStderr();
    for (const char* word :
         {"frame 1", "object 7", "\"a lamp\"", "(12.500, 99.250)", "rays", "sightline verify 'my scene.glb' --cameras ",
          "replay-frame-1.json", "--size 640x360", "--rays 1234", "--jitter 0.25", "--skip occlusion"})
        EXPECT_NE(said.find(word), std::string::npos) << word << " in\n" << said;

    const Result<CameraPath> camera = readCameraPath(path("replay-frame-1.json"));
    ASSERT_TRUE(camera.ok()) << camera.error().message;
    ASSERT_EQ(camera->frames.size(), 1u);
    EXPECT_EQ(camera->frames[0].eye, wrong.run.frames[1].camera.eye);
    EXPECT_FALSE(std::filesystem::exists(path("replay-frame-0.json")));
}

TEST_F(CullPath, SoundRunsSayNothing) {
    WrongRun wrong;
    wrong.run.frames.pop_back();
    testing::internal::CaptureStderr();
    ASSERT_TRUE(explainFalseCulls(wrong.scene, wrong.options, wrong.run).ok());
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST_F(CullPath, ReplayThatCannotBeWrittenIsAnOutputError) {
    WrongRun wrong;
    wrong.options.json = path("no/such/result.json");
    testing::internal::CaptureStderr();
    const Status explained = explainFalseCulls(wrong.scene, wrong.options, wrong.run);
    testing::internal::GetCapturedStderr();
    ASSERT_FALSE(explained.ok());
    EXPECT_EQ(explained.error().kind, Error::Kind::kOutput);
}

TEST_F(CullPath, EveryPieceOfWorkIsDoneOnce) {
    for (const uint32_t threads : {1u, 3u, 50u}) {
        std::vector<std::atomic<int>> done(17);
        forEach(done.size(), threads, [&](size_t i) { ++done[i]; });
        for (size_t i = 0; i < done.size(); ++i) EXPECT_EQ(done[i], 1) << i << " with " << threads << " threads";
    }
    forEach(0, 4, [](size_t) { FAIL(); });
}

}  // namespace
}  // namespace sightline::cli
