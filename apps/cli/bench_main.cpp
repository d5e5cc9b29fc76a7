// The program `sightline-bench`: the tool with the cases of its verb `bench`.
// SPDX-License-Identifier: MIT
#include "apps/cli/shell/tool.h"
#include "apps/cli/verbs/verbs.h"
#include "bench/bench.h"

int main(int count, char** words) {
    using namespace sightline::cli;
    OtherVerb bench = kBenchVerb;
    bench.add = addBench;
    bench.names = sightline::bench::names;
    return toolMain(count, words, {bench, kViewVerb});
}
