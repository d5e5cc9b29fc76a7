// Recordings of a frame's occlusion calls: written by cull, replayed by replay; and the pictures of the buffer.
// SPDX-License-Identifier: MIT
#include "sightline/query/record/occlusion_recording.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class Replay : public Tool {
protected:
    /// Records the second frame of a small city.
    std::string record(const std::string& name, const std::string& options = "") const {
        const Outcome made =
            succeed("cull city:1:300 --frames 2 --repeat 1 --size 320x180 --frame 1 --record-occlusion " + name + " " +
                    options);
        return read(path(name));
    }
};

TEST_F(Replay, GivesTheSameAnswersAndTheirNumbers) {
    const std::string bytes = record("a.rec");
    EXPECT_GT(bytes.size(), 2000u);
    EXPECT_EQ(record("b.rec", "--threads 1"), bytes);
    const Outcome replayed = succeed("replay a.rec --repeat 3 --json a.json --image a.png");
    EXPECT_NE(replayed.out.find("a.rec"), std::string::npos);
    const auto json = nlohmann::json::parse(read(path("a.json")));
    EXPECT_EQ(json["schema"], "sightline.replay/1");
    EXPECT_EQ(json["bytes"], bytes.size());
    EXPECT_EQ(json["same"], true);
    EXPECT_GT(json["draws"], 5);
    EXPECT_GT(json["rectangle_tests"], 20);
    EXPECT_EQ(read(path("a.png")).substr(1, 3), "PNG");
    for (int i = 0; i < 5; ++i) {
        const auto once = nlohmann::json::parse(run("replay a.rec --repeat 1 --json -").out);
        EXPECT_GE(once["test_microseconds"], 0);
    }
    const Outcome scalar = succeed("replay a.rec --repeat 1 --target " + json["instruction_set"].get<std::string>());
}

TEST_F(Replay, SaysWhichAnswerIsNotTheSame) {
    const std::string bytes = record("a.rec");
    Result<OcclusionRecording> recording = parseRecording(bytes, "a.rec");
    ASSERT_TRUE(recording.ok());
    recording->asked.rects[7].hidden = !recording->asked.rects[7].hidden;
    const Array<char> changed = recordingBytes(*recording);
    write("a.rec", std::string(changed.data(), changed.size()));
    const Outcome replayed = run("replay a.rec --repeat 1 --json a.json");
    EXPECT_EQ(replayed.exit_code, 1);
    EXPECT_EQ(replayed.errorLines(), 1u) << replayed.err;
    EXPECT_NE(replayed.err.find("a.rec: 1 of "), std::string::npos) << replayed.err;
    EXPECT_NE(replayed.err.find("the rectangle ("), std::string::npos) << replayed.err;
    EXPECT_EQ(nlohmann::json::parse(read(path("a.json")))["differences"], 1);
}

TEST_F(Replay, ErrorsAreOneLineAndAnExitCode) {
    const std::string bytes = record("a.rec");
    write("cut.rec", bytes.substr(0, bytes.size() / 2));
    write("other.rec", "something else");
    expectError("replay none.rec", 3, "none.rec");
    expectError("replay cut.rec", 3, "cut.rec: a section that is longer than the file at byte ");
    expectError("replay other.rec", 3, "other.rec: not a recording of occlusion calls at byte 0");
    expectError("replay a.rec --target PDP11", 2, "PDP11");
    expectError("replay a.rec --image none/a.png", 4, "none/a.png");
    expectError("replay a.rec --image a.rec", 2, "a.rec");
    expectError("cull city:1:50 --frame 1", 2, "--record-occlusion");
    expectError("cull city:1:50 --frames 2 --frame 2 --record-occlusion b.rec", 2, "--frame 2: the path has 2 frames");
    expectError("cull city:1:50 --skip occlusion --record-occlusion b.rec", 2, "needs the occlusion stage");
    expectError("cull city:1:50 --frames 1 --record-occlusion none/b.rec", 4, "none/b.rec");
}

TEST_F(Replay, CullDrawsTheBufferOfEachFrame) {
    const Outcome drawn =
        succeed("cull city:1:300 --frames 3 --repeat 1 --size 320x180 --depth-images buffers --report out");
    for (const char* name : {"buffers/occlusion-0000.png", "buffers/occlusion-0002.png", "out/frames/buffer-0001.png"})
        EXPECT_EQ(read(path(name)).substr(1, 3), "PNG") << name;
    // The buffer's own pixels there; here what of it is the viewport, as large as the page's other pictures.
    EXPECT_NE(read(path("buffers/occlusion-0001.png")), read(path("out/frames/buffer-0001.png")));
    EXPECT_EQ(read(path("out/frames/frame-0001.png")).substr(16, 8),
              read(path("out/frames/buffer-0001.png")).substr(16, 8));
    EXPECT_NE(read(path("out/index.html")).find("\"buffer\":\"data:image/"), std::string::npos);
}

TEST_F(Replay, TwoEyesSeeWhatEachSeesAlone) {
    // A camera path of matrices for each eye, beside the pair.
    const double ipd = 2;
    const char* const head = R"({"fov_y_degrees": 60, "near": 0.1, "frames": [{"eye": [)";
    const char* const tail = R"(, 1.7, 3], "target": [)";
    const auto at = [&](double x) {
        return head + std::to_string(x) + tail + std::to_string(x) + ", 1.7, -40], \"up\": [0, 1, 0]}]}";
    };
    write("pair.json", at(0));
    write("left.json", at(-ipd / 2));
    write("right.json", at(ipd / 2));
    const auto visible = [&](const std::string& camera, const std::string& options) {
        const Outcome culled =
            succeed("cull city:1:400 --repeat 1 --size 320x180 --json out.json --cameras " + camera + options);
        return nlohmann::json::parse(read(path("out.json")));
    };
    const auto pair = visible("pair.json", " --stereo 2 --verify --rays 20000");
    const auto left = visible("left.json", "")["frames"][0]["visible"];
    const auto right = visible("right.json", "")["frames"][0]["visible"];
    EXPECT_EQ(pair["stereo"], 2);
    EXPECT_EQ(pair["verification"]["false_culls"], 0);
    const auto& frame = pair["frames"][0];
    ASSERT_EQ(frame["eyes"].size(), frame["visible"].size());
    nlohmann::json by_left = nlohmann::json::array(), by_right = nlohmann::json::array();
    for (size_t i = 0; i < frame["visible"].size(); ++i) {
        const int eyes = frame["eyes"][i];
        if (eyes & 1) by_left.push_back(frame["visible"][i]);
        if (eyes & 2) by_right.push_back(frame["visible"][i]);
    }
    EXPECT_EQ(by_left, left);
    EXPECT_EQ(by_right, right);
    EXPECT_GT(frame["visible"].size(), 5u);
    expectError("cull city:1:50 --stereo -1", 2, "--stereo");
}

}  // namespace
}  // namespace sightline
