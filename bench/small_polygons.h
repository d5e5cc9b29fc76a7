// Classifying many small polygons at once, by itself, on the clusters of a soup of triangles.
// SPDX-License-Identifier: MIT
#pragma once

#include "bench/bench.h"
#include "bench/table.h"

namespace sightline::bench {

/// Adds rows: nanoseconds per polygon of projected clusters, of the thread's own time, the median of Options::repeat
/// (24 if it is 0), for each size of triangles at 1280x720.
void measureSmallPolygons(const Options& options, Table& table);

}  // namespace sightline::bench
