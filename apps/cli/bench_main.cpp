// The program `sightline-bench`: the tool with the cases of its verb `bench`.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"
#include "apps/cli/verbs/verbs.h"
#include "bench/bench.h"

int main(int count, char** words) {
    return sightline::cli::toolMain(count, words, {sightline::cli::addBench, sightline::bench::names, nullptr});
}
