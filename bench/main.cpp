// The benchmark binary: every case, one after the other.
// SPDX-License-Identifier: MIT
#include <cstdio>

#include "bench/bench.h"

int main() {
    for (const std::string& name : sightline::bench::names()) {
        sightline::bench::Options options;
        options.name = name;
        if (const sightline::Result<bool> done = sightline::bench::run(options); !done) {
            std::fprintf(stderr, "%s\n", done.error().message.c_str());
            return 1;
        }
    }
    return 0;
}
