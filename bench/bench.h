// The benchmark cases by name: the tool's verb `bench` and the benchmark binary call the same ones.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "bench/options.h"
#include "sightline/base/result.h"

namespace sightline::bench {

/// The cases that run() knows, in alphabetical order.
std::vector<std::string> names();

/// The scenes that the case "occlusion" has of its own.
std::vector<std::string> sceneNames();

/// Measures one case and prints its rows for a reader: on standard output, or on standard error if the JSON goes
/// to standard output.
/// @returns false if a proof that was asked for does not hold; its faults are then lines on standard error
/// Errors: a scene that cannot be read, a file that cannot be written, an unknown name.
Result<bool> run(const Options& options);

}  // namespace sightline::bench
