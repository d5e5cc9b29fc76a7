// Recordings of a frame: written by cull, asked again by replay, checked by check; and the pictures of the buffer.
// SPDX-License-Identifier: MIT
#include <cmath>

#include "sightline/query/record/frame_recording.h"
#include "tests/cli/tool.h"

namespace sightline {
namespace {

class Replay : public Tool {
protected:
    /// Records the second frame of a small city.
    std::string record(const std::string& name, const std::string& options = "") const {
        const Outcome made =
            succeed("cull city:1:300 --frames 2 --repeat 1 --size 320x180 --frame 1 --record " + name + " " + options);
        return read(path(name));
    }
    json replay(const std::string& arguments) const {
        const Outcome outcome = run("replay " + arguments + " --repeat 1 --json -");
        EXPECT_LE(outcome.exit_code, 1) << outcome.err;
        return json::parse(outcome.out);
    }
    /// Writes a recording that was changed.
    template <class Change>
    void change(const std::string& bytes, const std::string& name, Change change) const {
        Result<FrameRecording> recording = parseRecording(bytes, name);
        ASSERT_TRUE(recording.ok());
        change(*recording);
        const Array<char> changed = recordingBytes(*recording);
        write(name, std::string(changed.data(), changed.size()));
    }
};

TEST_F(Replay, GivesTheSameAnswerAndItsNumbers) {
    const std::string bytes = record("a.frame", "--json run.json");
    EXPECT_GT(bytes.size(), 2000u);
    EXPECT_EQ(record("b.frame", "--threads 1"), bytes);
    const Outcome replayed = succeed("replay a.frame --repeat 3 --json a.json --image a.png");
    EXPECT_NE(replayed.out.find("a.frame"), std::string::npos);
    const json said = json::parse(read(path("a.json")));
    EXPECT_EQ(said["schema"], "sightline.replay/2");
    EXPECT_EQ(said["bytes"], bytes.size());
    EXPECT_EQ(said["same"], true);
    EXPECT_EQ(said["recorded"]["kept"], json::parse(read(path("run.json")))["frames"][1]["visible"].size());
    EXPECT_LT(said["recorded"]["kept"], said["objects"]);
    EXPECT_LE(said["changed"].size(), 3u) << "another hierarchy decides otherwise here and there";
    EXPECT_GT(said["buffer"]["draws"], 5);
    EXPECT_GT(said["buffer"]["tests"], 20);
    EXPECT_GT(said["microseconds"], 0);
    EXPECT_EQ(read(path("a.png")).substr(1, 3), "PNG");
    for (int i = 0; i < 5; ++i) EXPECT_GE(replay("a.frame")["buffer"]["test_microseconds"], 0);
    EXPECT_EQ(replay("a.frame --target " + said["instruction_set"].get<std::string>())["same"], true);
}

TEST_F(Replay, IsOfAnyStagesAndOfTwoEyes) {
    record("frustum.frame", "--skip occlusion");
    const json said = replay("frustum.frame");
    EXPECT_EQ(said["same"], true);
    EXPECT_EQ(said["recorded"]["kept"], said["objects"]);
    EXPECT_FALSE(said.contains("buffer"));
    expectError("replay frustum.frame --image a.png", 2, "no occlusion stage");
    record("eyes.frame", "--stereo 2");
    record("far.frame", "--distance 30 --contribution 2");
    record("levels.frame", "--lod-error 1");
    for (const char* name : {"eyes.frame", "far.frame", "levels.frame"}) {
        const json answer = replay(std::string(name) + " --verify --rays 20000");
        EXPECT_EQ(answer["same"], true) << name;
        EXPECT_TRUE(answer["verification"]["recorded"].empty()) << answer;
        EXPECT_TRUE(answer["verification"]["again"].empty()) << answer;
    }
}

TEST_F(Replay, SaysWhichAnswerIsNotTheSame) {
    change(record("a.frame"), "a.frame", [](FrameRecording& recording) { recording.again[7] ^= 1; });
    const Outcome replayed = run("replay a.frame --repeat 1 --json a.json");
    EXPECT_EQ(replayed.exit_code, 1);
    EXPECT_EQ(replayed.errorLines(), 1u) << replayed.err;
    EXPECT_NE(replayed.err.find("a.frame: 1 of "), std::string::npos) << replayed.err;
    EXPECT_EQ(json::parse(read(path("a.json")))["differences"], 1);
}

TEST_F(Replay, ProvesThatARecordedCullWasWrong) {
    uint64_t key = 0;
    change(record("a.frame"), "a.frame", [&](FrameRecording& recording) {
        const json sound = replay("a.frame --verify --rays 20000");
        EXPECT_TRUE(sound["verification"]["recorded"].empty()) << sound;
        // The nearest of those that are kept is seen for certain.
        double nearest = HUGE_VAL;
        size_t kept = 0;
        for (size_t i = 0; i < recording.objects.size(); ++i) {
            const double distance =
                glm::length(glm::dvec3(recording.objects[i].transform[3]) - eyePosition(recording.view));
            if (recording.reasons[i] != 0 || recording.again[i] != 0 || distance > nearest) continue;
            nearest = distance;
            kept = i;
        }
        recording.reasons[kept] = 1 + static_cast<uint8_t>(Stage::kOcclusion);
        key = recording.objects[kept].key;
    });
    const Outcome replayed = run("replay a.frame --repeat 1 --verify --rays 20000 --json a.json");
    EXPECT_EQ(replayed.exit_code, 1);
    EXPECT_NE(replayed.err.find("false cull, when it was recorded: the object with key " + std::to_string(key)),
              std::string::npos)
        << replayed.err;
    const json said = json::parse(read(path("a.json")));
    ASSERT_EQ(said["verification"]["recorded"].size(), 1u);
    EXPECT_EQ(said["verification"]["recorded"][0]["key"], key);
    EXPECT_TRUE(said["verification"]["again"].empty());
    EXPECT_EQ(said["changed"].back()["kept"], true);
}

// Certificates of a walk, checked by exact arithmetic on the recorded objects alone.
TEST_F(Replay, CertificatesAreCheckedWithoutTheScene) {
    const std::string walk = " --path walk --seed 1 --remember --frames 40 --frame ";
    size_t certificates = 0;
    for (const std::string scene : {"building:1:1", "city:1:300"}) {
        size_t most = 0;
        for (const int frame : {15, 27, 39}) {
            succeed("cull " + scene + walk + std::to_string(frame) + " --record walk.frame");
            const json said = replay("walk.frame --verify --rays 20000");
            EXPECT_EQ(said["same"], true);
            EXPECT_TRUE(said["verification"]["recorded"].empty()) << said;
            succeed("check walk.frame --json check.json");
            const json checked = json::parse(read(path("check.json")));
            EXPECT_EQ(checked["proved"], said["recorded"]["certificates"]) << scene << ", frame " << frame;
            EXPECT_TRUE(checked["not_shown"].empty()) << checked;
            certificates += checked["proved"].get<size_t>();
            if (checked["proved"] <= most) continue;
            most = checked["proved"];
            change(read(path("walk.frame")), "lies.frame", [](FrameRecording& recording) {
                for (FrameRecording::Certificate& certificate : recording.certificates) certificate.count = 0;
                recording.named.clear();
            });
        }
        if (most == 0) continue;
        EXPECT_EQ(run("check lies.frame --json check.json").exit_code, 1);
        EXPECT_GT(json::parse(read(path("check.json")))["not_shown"].size(), most / 4);
    }
    EXPECT_GT(certificates, 50u);
    expectError("check walk.frame city:1:300", 2, "a recording holds its objects");
    expectError("check lies.json", 3, "lies.json");
}

TEST_F(Replay, ARecordingIsAScene) {
    record("a.frame");
    const json said = replay("a.frame");
    const json info = json::parse(succeed("info a.frame --json -").out);
    EXPECT_EQ(info["objects"], said["objects"]) << info.dump().substr(0, 300);
    EXPECT_NE(info.dump().find("recorded frame"), std::string::npos) << info.dump().substr(0, 300);
    succeed("cull a.frame --size 320x180 --frames 4 --verify --rays 20000 --json run.json");
    EXPECT_EQ(json::parse(read(path("run.json")))["verification"]["false_culls"], 0);
}

TEST_F(Replay, ErrorsAreOneLineAndAnExitCode) {
    const std::string bytes = record("a.frame");
    write("cut.frame", bytes.substr(0, bytes.size() / 2));
    write("other.frame", "something else");
    expectError("replay none.frame", 3, "none.frame");
    expectError("replay cut.frame", 3, "cut.frame: a section that is longer than the file at byte ");
    expectError("replay other.frame", 3, "other.frame: not a recording of a frame at byte 0");
    expectError("info cut.frame", 3, "cut.frame: a section that is longer than the file at byte ");
    expectError("replay a.frame --target PDP11", 2, "PDP11");
    expectError("replay a.frame --image none/a.png", 4, "none/a.png");
    expectError("replay a.frame --image a.frame", 2, "a.frame");
    expectError("replay a.frame --rays 5", 2, "--rays goes with --verify");
    expectError("cull city:1:50 --frame 1", 2, "--record");
    expectError("cull city:1:50 --frames 2 --frame 2 --record b.frame", 2, "--frame 2: the path has 2 frames");
    expectError("cull city:1:50 --frames 1 --record none/b.frame", 4, "none/b.frame");
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
