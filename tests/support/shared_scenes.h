// Real scenes and maps from beside the repository, for tests that are skipped where there are none.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/import/quake/map_source.h"

namespace sightline::test {
using namespace tools;

/// The names of all scenes of up to 150,000 triangles.
inline const auto kSmallScenes = testing::Values(
    "2CylinderEngine", "aws-small-house", "bimwhale-tall-building", "bsi-duplex", "cityjson-vienna", "dense-spot",
    "gazebo-pr2", "gazebo-willowgarage", "polyhaven-dutch-ship", "redeclipse-auster", "sauer-pandora");

/// As the name of a case.
inline std::string sceneLabel(const testing::TestParamInfo<const char*>& info) {
    std::string name = info.param;
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

/// In order; none where the folder is not there.
inline std::vector<std::filesystem::path> sharedFiles(const std::string& folder, const std::string& ending) {
    std::vector<std::filesystem::path> files;
    std::error_code none;
    for (const auto& entry : std::filesystem::directory_iterator(SIGHTLINE_SHARED_DIR "/" + folder, none))
        if (entry.path().extension() == ending) files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

/// No value where the file is not there. One that is there and cannot be read is a failure.
inline std::optional<Scene> sharedScene(const std::string& name) {
    const std::string file = SIGHTLINE_SHARED_DIR "/scenes/" + name + ".glb";
    if (!std::filesystem::exists(file)) return std::nullopt;
    Result<Scene> scene = loadGltf(file);
    EXPECT_TRUE(scene.ok()) << scene.error().message;
    return scene ? std::optional(std::move(*scene)) : std::nullopt;
}

/// A test of each of some real scenes; skipped where they are not there.
class SceneTest : public testing::TestWithParam<const char*> {
protected:
    void SetUp() override {
        scene = sharedScene(GetParam());
        if (!scene) GTEST_SKIP() << "no scenes beside the repository";
    }
    std::optional<Scene> scene;
};

/// As sharedScene(), of a compiled map.
inline std::optional<QuakeMapFile> sharedMap(const std::string& name) {
    const std::string file = SIGHTLINE_SHARED_DIR "/maps/" + name + ".vis.bsp";
    if (!std::filesystem::exists(file)) return std::nullopt;
    Result<QuakeMapFile> map = readQuakeMap(file);
    EXPECT_TRUE(map.ok()) << map.error().message;
    return map ? std::optional(std::move(*map)) : std::nullopt;
}

}  // namespace sightline::test
