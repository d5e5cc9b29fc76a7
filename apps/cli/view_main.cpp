// The program `sightline-view`: the tool with its verb `view`.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"
#include "apps/cli/verbs/verbs.h"

int main(int count, char** words) {
    using namespace sightline::cli;
    return toolMain(count, words, {{"view", addView}});
}
