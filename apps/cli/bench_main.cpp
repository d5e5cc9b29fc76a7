// The program `sightline-bench`: the tool with the cases of its verb `bench`.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"
#include "apps/cli/verbs/verbs.h"
#include "bench/bench.h"

int main(int count, char** words) {
    using namespace sightline::cli;
    return toolMain(count, words, {{"bench", addBench, sightline::bench::names}});
}
