// What the tool does with its words: the verbs, what comes before them, and the exit code.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sightline::cli {

/// The verb `bench`. Its cases are a program of their own, so that the tool can be built without them.
struct BenchVerb {
    void (*add)(CLI::App& tool, int& exit_code) = nullptr;
    std::vector<std::string> (*names)() = nullptr;  ///< of its cases; null: they are not here
    /// Hands the words to the program that has the cases; null: this one has.
    /// @returns the exit code
    int (*elsewhere)(const std::vector<std::string>& words) = nullptr;
};

/// All of main().
int toolMain(int count, char** words, const BenchVerb& bench);

}  // namespace sightline::cli
