// Files for the readers of scenes, in a folder of the test's own.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include "gltf_check.h"
#include "sightline/tools/import/scene_file.h"

namespace sightline::test {
using namespace tools;

class SceneFiles : public testing::Test {
protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  ("sightline-import-" + std::to_string(::getpid()) + "-" + test->name());
        std::filesystem::create_directories(folder_);
#ifdef SIGHTLINE_IMPORT_PROGRAM
        settings_.worker = SIGHTLINE_IMPORT_PROGRAM;
#endif
        settings_.memory_limit = uint64_t(2) << 30;
        settings_.time_limit = 60;
    }
    void TearDown() override { std::filesystem::remove_all(folder_); }

    std::string path(const std::string& name) const { return (folder_ / name).string(); }

    std::string write(const std::string& name, const std::string& bytes) const {
        std::ofstream(path(name), std::ios::binary) << bytes;
        return path(name);
    }

    /// A program of the shell that stands in for sightline-import.
    std::string script(const std::string& name, const std::string& lines) const {
        const std::string file = write(name, "#!/bin/sh\n" + lines + "\n");
        ::chmod(file.c_str(), 0700);
        return file;
    }

    Result<Scene> load(const std::string& file) const { return loadSceneFile(file, settings_); }

    /// The file is refused by one line that begins with its name and holds the words.
    void expectRefused(const std::string& file, const std::string& words) const {
        const Result<Scene> scene = load(file);
        ASSERT_FALSE(scene.ok()) << file;
        EXPECT_EQ(messageFault(scene.error(), file), "") << scene.error().message;
        EXPECT_NE(scene.error().message.find(words), std::string::npos) << scene.error().message;
    }

    std::filesystem::path folder_;
    ImportSettings settings_;
};

}  // namespace sightline::test
