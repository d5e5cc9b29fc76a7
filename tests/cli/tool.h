// Runs the built tool as a user does, in a directory of its own.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/wait.h>
#include <unistd.h>

namespace sightline {
using nlohmann::json;

struct Outcome {
    int exit_code = -1;
    std::string out, err;

    /// Lines of standard error. Progress does not count: it comes on a slow machine alone.
    size_t errorLines() const {
        std::istringstream lines(err);
        size_t count = 0;
        for (std::string line; std::getline(lines, line);)
            count += !line.ends_with(" left") && !line.ends_with("just begun") && !line.ends_with(" so far");
        return count;
    }
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

    /// As run(), and it succeeds.
    Outcome succeed(const std::string& arguments) const {
        Outcome outcome = run(arguments);
        EXPECT_EQ(outcome.exit_code, 0) << arguments << "\n" << outcome.err;
        return outcome;
    }

    /// What it writes to standard output, which is JSON and nothing else.
    json answer(const std::string& arguments) const {
        const json parsed = json::parse(succeed(arguments + " --json -").out, nullptr, false);
        EXPECT_FALSE(parsed.is_discarded()) << arguments;
        return parsed;
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

/// Runs of the verb cull on small images.
class CullTool : public Tool {
protected:
    json cull(const std::string& arguments) const { return answer("cull " + arguments + " --size 320x180 --repeat 1"); }

    static uint64_t culledBy(const json& run, const std::string& stage) {
        uint64_t sum = 0;
        for (const json& frame : run["frames"])
            for (const json& row : frame["stages"])
                if (row["name"] == stage) sum += row["culled"].get<uint64_t>();
        return sum;
    }
};

}  // namespace sightline
