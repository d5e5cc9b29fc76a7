// The benchmark cases by name: the tool's verb `bench` and the benchmark binary call the same ones.
// SPDX-License-Identifier: MIT
#include "bench/bench.h"

namespace sightline::bench {

std::vector<std::string> names() { return {}; }

Status run(const Options& options) {
    return Error{Error::Kind::kUsage, "bench: there is no case \"" + options.name + "\""};
}

}  // namespace sightline::bench
