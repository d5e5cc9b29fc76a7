// The occlusion buffer by itself on scenes made for it: drawing, asking boxes, how tight and sound the answers are.
// SPDX-License-Identifier: MIT
#pragma once

#include "bench/bench.h"
#include "bench/table.h"

namespace sightline::bench {

/// Measures all of occlusionSceneNames() at 1280x720 and 1920x1080 on one thread and adds their rows: the thread's own
/// times, each the median of Options::repeat in a view (24 if it is 0), and counts, both as means over the views.
void measureOcclusionCore(const Options& options, Table& table);

}  // namespace sightline::bench
