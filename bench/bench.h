// The benchmark cases by name: the tool's verb `bench` and the benchmark binary call the same ones.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <functional>
#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/scene/scene.h"

namespace sightline::bench {

struct Options {
    std::string name;              ///< one of names()
    std::string json;              ///< file for the rows as `sightline.bench/1`; `-`: standard output; empty: none
    const Scene* scene = nullptr;  ///< null: the case's own scenes
    int repeat = 0;                ///< measurements of each value, of which the median counts; 0: the case's own number
    std::function<void(size_t done, size_t total)> progress;  ///< called by cases that take minutes; may be empty
};

/// The cases that run() knows, in alphabetical order.
std::vector<std::string> names();

/// Measures one case and prints its rows for a reader: on standard output, or on standard error if the JSON goes
/// to standard output. Errors: a scene that cannot be read, a file that cannot be written, an unknown name.
Status run(const Options& options);

}  // namespace sightline::bench
