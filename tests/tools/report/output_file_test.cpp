// Files are written whole or not at all.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/output_file.h"

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gtest/gtest.h>
#include <unistd.h>

namespace sightline {
using namespace tools;
namespace {

namespace fs = std::filesystem;

class OutputFile : public testing::Test {
protected:
    void SetUp() override {
        directory_ = fs::temp_directory_path() / ("sightline-" + std::to_string(::getpid()) + "-" +
                                                  testing::UnitTest::GetInstance()->current_test_info()->name());
        fs::create_directories(directory_);
    }
    void TearDown() override { fs::remove_all(directory_); }

    std::string path(const char* name) const { return (directory_ / name).string(); }
    static std::string read(const std::string& file) {
        std::stringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        return text.str();
    }
    size_t filesThere() const {
        return static_cast<size_t>(std::distance(fs::directory_iterator(directory_), fs::directory_iterator()));
    }

    fs::path directory_;
};

TEST_F(OutputFile, ReplacesWhatWasThere) {
    ASSERT_TRUE(writeFileAside(path("a.json"), "one").ok());
    ASSERT_TRUE(writeFileAside(path("a.json"), std::string("t\0wo", 4)).ok());
    EXPECT_EQ(read(path("a.json")), std::string("t\0wo", 4));
    EXPECT_EQ(filesThere(), 1u);
}

TEST_F(OutputFile, NamesTheFileThatCannotBeWritten) {
    fs::create_directories(path("folder"));
    for (const std::string& file : {path("no/such/place.json"), path("folder")}) {
        const Status written = writeFileAside(file, "text");
        ASSERT_FALSE(written.ok()) << file;
        EXPECT_EQ(written.error().kind, Error::Kind::kOutput);
        EXPECT_NE(written.error().message.find(file), std::string::npos) << written.error().message;
        EXPECT_FALSE(canWriteFile(file).ok()) << file;
    }
    EXPECT_FALSE(canWriteFile("").ok());
    EXPECT_EQ(filesThere(), 1u);
}

TEST_F(OutputFile, AskingLeavesNothingBehind) {
    EXPECT_TRUE(canWriteFile(path("later.json")).ok());
    EXPECT_EQ(filesThere(), 0u);
}

TEST_F(OutputFile, WritesIntoDevicesWithoutReplacingThem) {
    ASSERT_TRUE(writeFileAside("/dev/null", "text").ok());
    EXPECT_TRUE(fs::is_character_file("/dev/null"));
}

TEST_F(OutputFile, MakesDirectoriesButNotOverFiles) {
    EXPECT_TRUE(makeDirectory(path("a/b/c")).ok());
    EXPECT_TRUE(makeDirectory(path("a/b/c")).ok());
    ASSERT_TRUE(writeFileAside(path("file"), "text").ok());
    EXPECT_FALSE(makeDirectory(path("file")).ok());
    EXPECT_FALSE(makeDirectory(path("file/below")).ok());
}

}  // namespace
}  // namespace sightline
