// Recordings of a frame's occlusion calls: written by cull, replayed by replay; and the pictures of the buffer.
// SPDX-License-Identifier: MIT
#include <nlohmann/json.hpp>

#include "sightline/run/occlusion_recording.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class Replay : public Tool {
protected:
    /// Records the second frame of a small city.
    std::string record(const std::string& name, const std::string& options = "") const {
        const Outcome made = run("cull city:1:300 --frames 2 --repeat 1 --size 320x180 --frame 1 --record-occlusion " +
                                 name + " " + options);
        EXPECT_EQ(made.exit_code, 0) << made.err;
        return read(path(name));
    }
};

TEST_F(Replay, GivesTheSameAnswersAndTheirNumbers) {
    const std::string bytes = record("a.rec");
    EXPECT_GT(bytes.size(), 2000u);
    EXPECT_EQ(record("b.rec", "--threads 1"), bytes);
    const Outcome replayed = run("replay a.rec --repeat 3 --json a.json --image a.png");
    EXPECT_EQ(replayed.exit_code, 0) << replayed.err;
    EXPECT_NE(replayed.out.find("a.rec"), std::string::npos);
    const auto json = nlohmann::json::parse(read(path("a.json")));
    EXPECT_EQ(json["schema"], "sightline.replay/1");
    EXPECT_EQ(json["bytes"], bytes.size());
    EXPECT_EQ(json["same"], true);
    EXPECT_GT(json["draws"], 5);
    EXPECT_GT(json["rectangle_tests"], 20);
    EXPECT_EQ(read(path("a.png")).substr(1, 3), "PNG");
    const Outcome scalar = run("replay a.rec --repeat 1 --target " + json["instruction_set"].get<std::string>());
    EXPECT_EQ(scalar.exit_code, 0) << scalar.err;
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
        run("cull city:1:300 --frames 3 --repeat 1 --size 320x180 --depth-images buffers --report out");
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    for (const char* name : {"buffers/occlusion-0000.png", "buffers/occlusion-0002.png", "out/frames/buffer-0001.png"})
        EXPECT_EQ(read(path(name)).substr(1, 3), "PNG") << name;
    EXPECT_EQ(read(path("buffers/occlusion-0001.png")), read(path("out/frames/buffer-0001.png")));
    EXPECT_NE(read(path("out/index.html")).find("Occlusion buffer"), std::string::npos);
}

}  // namespace
}  // namespace sightline
