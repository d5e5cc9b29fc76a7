// Runs the built tool as a user does, in a directory of its own.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

namespace sightline {

struct Outcome {
    int exit_code = -1;
    std::string out, err;

    size_t errorLines() const { return static_cast<size_t>(std::count(err.begin(), err.end(), '\n')); }
};

class Tool : public testing::Test {
protected:
    void SetUp() override {
        const auto* test = testing::UnitTest::GetInstance()->current_test_info();
        directory_ = std::filesystem::temp_directory_path() /
                     ("sightline-cli-" + std::to_string(::getpid()) + "-" + test->name());
        std::filesystem::create_directories(directory_);
    }
    void TearDown() override { std::filesystem::remove_all(directory_); }

    std::string path(const std::string& name) const { return (directory_ / name).string(); }

    static std::string read(const std::string& file) {
        std::stringstream text;
        text << std::ifstream(file, std::ios::binary).rdbuf();
        return text.str();
    }

    void write(const std::string& name, const std::string& text) const {
        std::ofstream(path(name), std::ios::binary) << text;
    }

    /// Runs `sightline ARGUMENTS` in the test's directory; the arguments are words of a shell.
    Outcome run(const std::string& arguments) const {
        const std::string out = path(".out"), err = path(".err");
        const std::string command = "cd '" + directory_.string() + "' && '" SIGHTLINE_TOOL "' " + arguments + " >'" +
                                    out + "' 2>'" + err + "' </dev/null";
        const int status = std::system(command.c_str());
        Outcome outcome{WIFEXITED(status) ? WEXITSTATUS(status) : -1, read(out), read(err)};
        std::filesystem::remove(out);
        std::filesystem::remove(err);
        return outcome;
    }

    /// The exit code is as given, nothing is on standard output, and one line of standard error holds the word.
    void expectError(const std::string& arguments, int exit_code, const std::string& word) const {
        const Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, exit_code) << arguments << "\n" << outcome.err;
        EXPECT_EQ(outcome.out, "") << arguments;
        EXPECT_EQ(outcome.errorLines(), 1u) << arguments << "\n" << outcome.err;
        EXPECT_NE(outcome.err.find(word), std::string::npos) << arguments << "\n" << outcome.err;
    }

    std::filesystem::path directory_;
};

}  // namespace sightline
