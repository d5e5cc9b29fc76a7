// Camera paths survive their text bit by bit, and every mistake in a file is named with its place.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/camera_path.h"

#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

/// A file that is gone when the test is.
class TemporaryFile {
public:
    explicit TemporaryFile(const std::string& text) {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        path_ = testing::TempDir() + "sightline_" + info->name() + "_" + std::to_string(getpid()) + ".json";
        std::ofstream(path_, std::ios::binary) << text;
    }
    ~TemporaryFile() { std::remove(path_.c_str()); }
    const std::string& path() const { return path_; }

private:
    std::string path_;
};

Result<CameraPath> readText(const std::string& text) { return readCameraPath(TemporaryFile(text).path()); }

bool sameBits(double a, double b) { return std::memcmp(&a, &b, sizeof a) == 0; }

template <class T>
bool sameBits(const T& a, const T& b) {
    return std::memcmp(&a, &b, sizeof a) == 0;
}

bool sameFrame(const CameraFrame& a, const CameraFrame& b) {
    const auto same = [](const auto& p, const auto& q) {
        return p.has_value() == q.has_value() && (!p || sameBits(*p, *q));
    };
    return sameBits(a.eye, b.eye) && sameBits(a.target, b.target) && sameBits(a.up, b.up) &&
           sameBits(a.fov_y_degrees, b.fov_y_degrees) && sameBits(a.z_near, b.z_near) && same(a.z_far, b.z_far) &&
           same(a.orthographic_height, b.orthographic_height) && same(a.view, b.view) &&
           same(a.projection, b.projection);
}

TEST(CameraPath, TextRoundTripsBitByBit) {
    constexpr uint64_t kSeed = 7;
    Random random(kSeed);
    CameraPath path;
    for (int i = 0; i < 200; ++i) {
        CameraFrame frame;
        for (int axis = 0; axis < 3; ++axis) frame.eye[axis] = random.uniform(-1e6, 1e6);
        for (int axis = 0; axis < 3; ++axis) frame.target[axis] = random.uniform(-1e6, 1e6);
        frame.up = {random.uniform(-1, 1), -0.0, 0.5};
        frame.fov_y_degrees = random.uniform(0.001, 179.999);
        frame.z_near = random.uniform(1e-6, 10);
        if (i % 2) frame.z_far = frame.z_near + random.uniform(1e-3, 1e9);
        if (i % 3 == 0) frame.orthographic_height = random.uniform(1e-3, 1e4);
        if (i % 5 == 0) {
            frame.view = lookAt(frame.eye, frame.target, frame.up);
            frame.projection = perspective(random.uniform(0.1, 3), 1.5, 0.1);
        }
        path.frames.push_back(frame);
    }
    const Result<CameraPath> back = readText(cameraPathJson(path));
    ASSERT_TRUE(back.ok()) << back.error().message;
    ASSERT_EQ(back->frames.size(), path.frames.size());
    for (size_t i = 0; i < path.frames.size(); ++i)
        EXPECT_TRUE(sameFrame(path.frames[i], back->frames[i])) << "seed " << kSeed << ", frame " << i;
}

TEST(CameraPath, FramesOverrideTheHead) {
    const Result<CameraPath> path = readText(R"({"fov_y_degrees": 40, "near": 0.5, "far": 100, "up": [0, 0, 1],
        "frames": [{"eye": [1, 2, 3], "target": [4, 5, 6]},
                   {"eye": [1, 2, 3], "target": [4, 5, 6], "far": null, "near": 2,
                    "fov_y_degrees": 90, "up": [0, 1, 0]},
                   {"eye": [1, 2, 3], "target": [4, 5, 6], "orthographic_height": 12}]})");
    ASSERT_TRUE(path.ok()) << path.error().message;
    ASSERT_EQ(path->frames.size(), 3u);
    EXPECT_EQ(path->frames[0].fov_y_degrees, 40);
    EXPECT_EQ(path->frames[0].z_near, 0.5);
    EXPECT_EQ(path->frames[0].z_far, 100.0);
    EXPECT_EQ(path->frames[0].up, glm::dvec3(0, 0, 1));
    EXPECT_EQ(path->frames[0].eye, glm::dvec3(1, 2, 3));
    EXPECT_EQ(path->frames[1].z_far, std::nullopt);
    EXPECT_EQ(path->frames[1].z_near, 2);
    EXPECT_EQ(path->frames[1].fov_y_degrees, 90);
    EXPECT_EQ(path->frames[2].orthographic_height, 12.0);
}

TEST(CameraPath, HasTheDefaultsOfItsDocument) {
    const Result<CameraPath> path = readText(R"({"frames": [{"eye": [0, 0, 0], "target": [0, 0, -1]}]})");
    ASSERT_TRUE(path.ok()) << path.error().message;
    EXPECT_TRUE(sameFrame(path->frames[0], CameraFrame{}));
}

TEST(CameraPath, MatricesAreColumnMajorAndReplaceTheRest) {
    const Result<CameraPath> path = readText(R"({"frames": [{
        "view": [1,0,0,0, 0,1,0,0, 0,0,1,0, -5,-6,-7,1],
        "projection": [1,0,0,0, 0,2,0,0, 0.25,0,-1,-1, 0,0,-0.2,0]}]})");
    ASSERT_TRUE(path.ok()) << path.error().message;
    const View view = makeView(path->frames[0], 640, 480);
    EXPECT_EQ(eyePosition(view), glm::dvec3(5, 6, 7));
    EXPECT_EQ(view.projection[2][0], 0.25);
    EXPECT_EQ(view.projection[2][3], -1);
    EXPECT_EQ(view.projection[3][2], -0.2);
    EXPECT_EQ(view.width, 640u);
    EXPECT_EQ(view.height, 480u);
}

TEST(CameraPath, OrthographicHeightIsTheFullHeight) {
    CameraFrame frame;
    frame.orthographic_height = 20;
    frame.z_near = -5;
    frame.z_far = 50;
    const View view = makeView(frame, 200, 100);
    EXPECT_TRUE(isOrthographic(view));
    const glm::dvec4 corner = view.projection * view.view * glm::dvec4(20, 10, -50, 1);
    EXPECT_NEAR(corner.x, 1, 1e-12);
    EXPECT_NEAR(corner.y, 1, 1e-12);
    EXPECT_NEAR(corner.z, 1, 1e-12);
}

TEST(CameraPath, AbsentFarIsInfinite) {
    const View view = makeView(CameraFrame{}, 100, 100);
    EXPECT_TRUE(isUsable(view));
    const glm::dvec4 far = view.projection * view.view * glm::dvec4(0, 0, -1e12, 1);
    EXPECT_LT(far.z, far.w);
}

TEST(CameraPath, TakesMatricesOfOtherClipSpaces) {
    // The same camera as OpenGL, Vulkan and reversed Direct3D have it; reversed depth and the left hand tell themselves.
    const std::string view = R"("view": [1,0,0,0, 0,1,0,0, 0,0,1,0, -5,-6,-7,1], )";
    const std::string frames[] = {
        R"("projection": [1,0,0,0, 0,2,0,0, 0,0,-1,-1, 0,0,-0.5,0])",
        R"("clip": "vulkan", "projection": [1,0,0,0, 0,-2,0,0, 0,0,-1,-1, 0,0,-0.25,0])",
        R"("clip": "direct3d-reversed", "projection": [1,0,0,0, 0,2,0,0, 0,0,0,-1, 0,0,0.25,0])",
        R"("projection": [1,0,0,0, 0,2,0,0, 0,0,0,-1, 0,0,0.25,0])",
    };
    for (const std::string& frame : frames) {
        const Result<CameraPath> path = readText("{\"frames\": [{" + view + frame + "}]}");
        ASSERT_TRUE(path.ok()) << frame << path.error().message;
        EXPECT_EQ(*path->frames[0].projection, glm::dmat4(1, 0, 0, 0, 0, 2, 0, 0, 0, 0, -1, -1, 0, 0, -0.5, 0))
            << frame;
        EXPECT_EQ((*path->frames[0].view)[3], glm::dvec4(-5, -6, -7, 1)) << frame;
    }
}

struct Mistake {
    const char* text;
    const char* says;
};

TEST(CameraPath, NamesEveryMistakeWithFileAndFrame) {
    const std::string good = R"({"eye": [0, 0, 0], "target": [0, 0, -1]})";
    const Mistake mistakes[] = {
        {"", "not JSON"},
        {"{\"frames\": [", "not JSON"},
        {"{\"frames\": [{\"eye\": [0, 0, 1e999], \"target\": [0, 0, 0]}]}", "1e999"},
        {"{\"frames\": [{\"eye\": [0, 0, NaN], \"target\": [0, 0, 0]}]}", "not JSON"},
        {"\xff\xfe\x01", "not JSON"},
        {"[]", "not a JSON object"},
        {"3", "not a JSON object"},
        {"{}", "no frames"},
        {R"({"schema": "sightline.cull/1", "frames": [{"visible": []}]})", "frame 0: there is no \"camera\""},
        {"{\"frames\": []}", "no frames"},
        {"{\"frames\": {}}", "no frames"},
        {"{\"fov_y_degrees\": \"wide\", \"frames\": [1]}", "head: \"fov_y_degrees\" is not a number"},
        {"{\"frames\": [GOOD, 4]}", "frame 1: not a JSON object"},
        {"{\"frames\": [GOOD, {\"target\": [0, 0, 0]}]}", "frame 1: \"eye\" is missing"},
        {"{\"frames\": [{\"eye\": [0, 0, 0]}]}", "frame 0: \"target\" is missing"},
        {"{\"frames\": [{\"eye\": [0, 0], \"target\": [0, 0, 1]}]}", "\"eye\" is not an array of 3 numbers"},
        {"{\"frames\": [{\"eye\": [0, 0, \"x\"], \"target\": [0, 0, 1]}]}", "\"eye[2]\" is not a number"},
        {"{\"frames\": [{\"eye\": 7, \"target\": [0, 0, 1]}]}", "\"eye\" is not an array of 3 numbers"},
        {"{\"frames\": [{\"eye\": [1, 2, 3], \"target\": [1, 2, 3]}]}", "\"eye\" equals \"target\""},
        {"{\"frames\": [{\"eye\": [0, 0, 0], \"target\": [0, 0, 1e-320]}]}", "frame 0: "},
        {"{\"frames\": [{\"eye\": [0, 0, 0], \"target\": [0, 0, 1e200]}]}", "frame 0: "},
        {"{\"near\": 0, \"frames\": [GOOD]}", "frame 0: \"near\" is not greater than 0"},
        {"{\"near\": -1, \"frames\": [GOOD]}", "\"near\" is not greater than 0"},
        {"{\"near\": null, \"frames\": [GOOD]}", "head: \"near\" is not a number"},
        {"{\"near\": 5, \"far\": 5, \"frames\": [GOOD]}", "\"far\" is not greater than \"near\""},
        {"{\"far\": \"inf\", \"frames\": [GOOD]}", "\"far\" is not a number"},
        {"{\"fov_y_degrees\": 0, \"frames\": [GOOD]}", "\"fov_y_degrees\" is not between 0 and 180"},
        {"{\"fov_y_degrees\": 180, \"frames\": [GOOD]}", "\"fov_y_degrees\" is not between 0 and 180"},
        {"{\"orthographic_height\": 0, \"frames\": [GOOD]}", "\"orthographic_height\" is not greater than 0"},
        {"{\"frames\": [{\"view\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}", "\"view\" without \"projection\""},
        {"{\"frames\": [{\"projection\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}", "\"projection\" without \"view\""},
        {"{\"frames\": [{\"view\": [1, 2]}]}", "\"view\" is not an array of 16 numbers"},
        {"{\"frames\": [{\"view\": [2,0,0,0, 0,2,0,0, 0,0,2,0, 0,0,0,1],"
         "\"projection\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}",
         "not rigid"},
        {"{\"clip\": \"opengl\", \"frames\": [{\"view\": [-1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],"
         "\"projection\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}",
         "mirrors"},
        {"{\"clip\": \"opengl\", \"frames\": [{\"view\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],"
         "\"projection\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}",
         "depth runs towards the eye"},
        {"{\"clip\": \"vulcan\", \"frames\": [GOOD]}", "did you mean vulkan?"},
        {"{\"clip\": 3, \"frames\": [GOOD]}", "head: \"clip\" is none of opengl, direct3d, vulkan"},
        {"{\"fov_y_degree\": 50, \"frames\": [GOOD]}",
         "head: there is no \"fov_y_degree\"; did you mean fov_y_degrees?"},
        {"{\"fov\": 50, \"frames\": [GOOD]}", "head: there is no \"fov\"; did you mean fov_y_degrees?"},
        {"{\"frames\": [GOOD, {\"eye\": [0, 0, 0], \"target\": [0, 0, 1], \"roll\": 3}]}",
         "frame 1: there is no \"roll\""},
        {"{\"frames\": [{\"frames\": []}]}", "frame 0: there is no \"frames\""},
        {"{\"frames\": [{\"view\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,2],"
         "\"projection\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1]}]}",
         "last row"},
        {"{\"frames\": [{\"view\": [1,0,0,0, 0,1,0,0, 0,0,1,0, 0,0,0,1],"
         "\"projection\": [0,0,0,0, 0,0,0,0, 0,0,0,0, 0,0,0,0]}]}",
         "singular"},
    };
    for (const Mistake& mistake : mistakes) {
        std::string text = mistake.text;
        for (size_t at; (at = text.find("GOOD")) != std::string::npos;) text.replace(at, 4, good);
        const TemporaryFile file(text);
        const Result<CameraPath> path = readCameraPath(file.path());
        ASSERT_FALSE(path.ok()) << text;
        const std::string& message = path.error().message;
        EXPECT_EQ(path.error().kind, Error::Kind::kInput) << text;
        EXPECT_EQ(message.rfind(file.path() + ": ", 0), 0u) << message;
        EXPECT_NE(message.find(mistake.says), std::string::npos) << text << "\n  gives: " << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    }
}

TEST(CameraPath, SurvivesDamagedText) {
    constexpr uint64_t kSeed = 11;
    Random random(kSeed);
    CameraPath path;
    path.frames.resize(2);
    path.frames[1].view = glm::dmat4(1);
    path.frames[1].projection = perspective(1, 1, 0.1);
    const std::string whole = cameraPathJson(path);
    for (int i = 0; i < 2000; ++i) {
        std::string text = whole.substr(0, random.below(whole.size() + 1));
        for (uint64_t k = random.below(4); k > 0 && !text.empty(); --k)
            text[random.below(text.size())] = static_cast<char>(random.below(256));
        const Result<CameraPath> read = readText(text);
        const std::string message = read ? "" : read.error().message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << "seed " << kSeed << ", text " << i;
    }
}

TEST(CameraPath, RefusesAMissingFileAndADirectory) {
    const std::string missing = testing::TempDir() + "sightline_no_such_file.json";
    const Result<CameraPath> none = readCameraPath(missing);
    ASSERT_FALSE(none.ok());
    EXPECT_EQ(none.error().message, missing + ": no such file");

    const Result<CameraPath> directory = readCameraPath(testing::TempDir());
    ASSERT_FALSE(directory.ok());
    EXPECT_NE(directory.error().message.find("is a directory"), std::string::npos) << directory.error().message;
}

TEST(CameraPath, RefusesAFileWithoutPermission) {
    const TemporaryFile closed("{}");
    std::filesystem::permissions(closed.path(), std::filesystem::perms::none);
    if (std::ifstream(closed.path())) GTEST_SKIP() << "this user may read every file";
    const Result<CameraPath> refused = readCameraPath(closed.path());
    ASSERT_FALSE(refused.ok());
    EXPECT_NE(refused.error().message.find("Permission denied"), std::string::npos) << refused.error().message;
}

TEST(CameraPath, TakesTheScenesCameras) {
    Scene scene;
    SceneCamera camera;
    camera.transform = glm::inverse(lookAt({1, 2, 3}, {4, 2, -1}, {0, 1, 0}));
    camera.transform[0] *= 2.0;  // a scaled node still gives a rigid view
    camera.transform[1] *= 2.0;
    camera.transform[2] *= 2.0;
    camera.fov_y = 0.75;
    camera.z_far = 90;
    scene.cameras.push_back(camera);
    camera.fov_y = 0;
    camera.orthographic_height = 8;
    scene.cameras.push_back(camera);
    const CameraPath path = sceneCameras(scene);
    ASSERT_EQ(path.frames.size(), 2u);
    const View view = makeView(path.frames[0], 100, 50);
    EXPECT_NEAR(glm::length(eyePosition(view) - glm::dvec3(1, 2, 3)), 0, 1e-12);
    const glm::dvec4 ahead = view.view * glm::dvec4(4, 2, -1, 1);
    EXPECT_NEAR(ahead.x, 0, 1e-12);
    EXPECT_NEAR(ahead.z, -5, 1e-12);
    EXPECT_NEAR(view.projection[1][1], 1 / std::tan(0.375), 1e-12);
    EXPECT_EQ(path.frames[0].z_far, 90.0);
    EXPECT_EQ(path.frames[1].orthographic_height, 8.0);
    EXPECT_TRUE(isOrthographic(makeView(path.frames[1], 10, 10)));
}

}  // namespace
}  // namespace sightline
