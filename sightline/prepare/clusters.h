// Writes runs of polygons as an occluder's clusters, with the edges of those that hang together.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/occluder.h"
#include "sightline/prepare/runs.h"

namespace sightline {

/// Adds one cluster for each run from `first` to `last`.
void addClusters(Occluder& out, const Patchwork& patchwork, const Runs& runs, size_t first, size_t last);

}  // namespace sightline
