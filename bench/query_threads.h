// One query shared by several threads, beside the same on one.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "bench/table.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bench {
using namespace tools;

/// The views of a path in one bin and in two, by one worker and by two; times of the clock on the wall, so that the
/// ratios mean something on idle cores only. Adds its rows to the table.
void measureQueryThreads(const Scene& scene, const CameraPath& path, const std::string& where, int repeat,
                         Table& table);

}  // namespace sightline::bench
