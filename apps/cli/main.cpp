// The command line tool `sightline`. Its verbs `bench` and `view` are programs beside it.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"

int main(int count, char** words) {
    using namespace sightline::cli;
    return toolMain(count, words, {kBenchVerb, kViewVerb});
}
