// A folder that a test writes a page into, and that goes with the test.
// SPDX-License-Identifier: MIT
#pragma once

#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <unistd.h>

#include "tests/tools/report/page/page_data.h"

namespace sightline {

class PageFiles : public testing::Test {
protected:
    void SetUp() override {
        directory_ = std::filesystem::temp_directory_path() / ("sightline-page-" + std::to_string(::getpid()));
        std::filesystem::create_directories(directory_);
    }
    void TearDown() override { std::filesystem::remove_all(directory_); }

    std::string read(const std::string& name) const {
        std::stringstream text;
        text << std::ifstream(directory_ / name, std::ios::binary).rdbuf();
        return text.str();
    }

    /// Every picture that the page holds lies beside it, and how many there are.
    size_t pictures() const {
        const nlohmann::json data = dataOf(read("index.html"));
        for (const auto& picture : data["pictures"])
            EXPECT_EQ(read(picture["name"].get<std::string>() + ".png").substr(1, 3), "PNG") << picture["name"];
        return data["pictures"].size();
    }

    std::filesystem::path directory_;
};

}  // namespace sightline
