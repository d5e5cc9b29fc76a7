// What the tool does with its words: the verbs, what comes before them, and the exit code.
// SPDX-License-Identifier: MIT
#pragma once

#include <initializer_list>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace sightline::cli {

/// A verb that is a program of its own, so that the tool can be built without it.
struct OtherVerb {
    const char* name = nullptr;
    const char* about = nullptr;                            ///< for the list of verbs
    const char* program = nullptr;                          ///< beside this one, which the words are handed to
    void (*add)(CLI::App& tool, int& exit_code) = nullptr;  ///< not null: this program has it
    std::vector<std::string> (*names)() = nullptr;          ///< what its NAME may be, where that is known here
};

inline constexpr OtherVerb kBenchVerb{"bench", "measures this machine: each technique beside its plain baseline",
                                      "sightline-bench", nullptr, nullptr};
inline constexpr OtherVerb kViewVerb{"view", "fly through a scene, leave the culling camera and look at what it left",
                                     "sightline-view", nullptr, nullptr};

/// All of main().
int toolMain(int count, char** words, std::initializer_list<OtherVerb> others);

}  // namespace sightline::cli
