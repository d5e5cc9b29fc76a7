// The command line tool `sightline`. The cases of its verb `bench` are in a program beside it, `sightline-bench`.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <filesystem>
#include <string>
#include <vector>

#include <unistd.h>

#include <CLI/CLI.hpp>

#include "apps/cli/shell/session.h"
#include "apps/cli/shell/tool.h"

namespace sightline::cli {
namespace {

/// For the list of verbs alone: what is said of it comes from the other program.
void addBenchName(CLI::App& tool, int&) {
    tool.add_subcommand("bench", "measures this machine: each technique beside its plain baseline");
}

/// Becomes the other program.
int runBeside(const std::vector<std::string>& words) {
    std::error_code failed;
    const std::filesystem::path here = std::filesystem::read_symlink("/proc/self/exe", failed).parent_path();
    const std::string program = (here / "sightline-bench").string();
    std::vector<std::string> all = words;
    all.insert(all.begin(), program);
    std::vector<char*> pointers;
    for (std::string& word : all) pointers.push_back(word.data());
    pointers.push_back(nullptr);
    std::fflush(nullptr);
    execv(program.c_str(), pointers.data());
    return report({Error::Kind::kUsage,
                   "bench: the program sightline-bench is not beside this one; `./run.sh bench` "
                   "builds it"});
}

}  // namespace
}  // namespace sightline::cli

int main(int count, char** words) {
    using namespace sightline::cli;
    return toolMain(count, words, {addBenchName, nullptr, runBeside});
}
