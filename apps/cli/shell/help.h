// How help looks, and what it says beside the options: scenes, cameras, exit codes, examples.
// SPDX-License-Identifier: MIT
#pragma once

namespace CLI {
class App;
}

namespace sightline::cli {

/// Puts the options of the tool and of its verbs under headings, and gives them the look of their help and its last
/// words. After all options were added.
void dressHelp(CLI::App& tool);

}  // namespace sightline::cli
