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
          "replay-frames.json", "--size 640x360", "--rays 1234", "--jitter 0.25", "--skip occlusion"})
        EXPECT_NE(said.find(word), std::string::npos) << word << " in\n" << said;

    const Result<CameraPath> camera = readCameraPath(path("replay-frames.json"));
    ASSERT_TRUE(camera.ok()) << camera.error().message;
    ASSERT_EQ(camera->frames.size(), 1u);
    EXPECT_EQ(camera->frames[0].eye, wrong.run.frames[1].camera.eye);
}

// One file for all, however many frames are wrong: with a memory the frames before them, too; with a limit that gives way, the one before.
TEST_F(CullPath, AllWrongFramesAreInOneFile) {
    struct {
        bool stateless;
        double hysteresis;
        std::vector<double> eyes;
    } const cases[] = {{true, 0, {2, 3, 7}}, {true, 0.1, {1, 2, 3, 6, 7}}, {false, 0, {0, 1, 2, 3, 4, 5, 6, 7}}};
    for (const auto& [stateless, hysteresis, eyes] : cases) {
        WrongRun wrong;
        const FrameResult sound = wrong.run.frames[0], bad = wrong.run.frames[1];
        wrong.run.frames.assign(9, sound);
        for (const size_t i : {2, 3, 7}) wrong.run.frames[i] = bad;
        for (size_t i = 0; i < 9; ++i) wrong.run.frames[i].camera.eye = {double(i), 0, 5};
        wrong.run.settings.stateless = stateless;
        wrong.run.settings.hysteresis = hysteresis;
        wrong.options.report = path("");
        testing::internal::CaptureStderr();
        ASSERT_TRUE(explainFalseCulls(wrong.scene, wrong.options, wrong.run).ok());
        const std::string said = testing::internal::GetCapturedStderr();
        EXPECT_EQ(said.find("replay: "), said.rfind("replay: ")) << said;
        const Result<CameraPath> cameras = readCameraPath(path("replay-frames.json"));
        ASSERT_TRUE(cameras.ok()) << cameras.error().message;
        std::vector<double> found;
        for (const CameraFrame& frame : cameras->frames) found.push_back(frame.eye.x);
        EXPECT_EQ(found, eyes);
        const auto files = std::filesystem::directory_iterator(path(""));
        EXPECT_EQ(std::distance(begin(files), end(files)), 1);
    }
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
