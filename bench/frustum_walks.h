// The parts of the case "frustum": hierarchies, what two frames have in common, large bounds, and bounds that are no boxes.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "bench/flat_boxes.h"
#include "bench/stopwatch.h"
#include "bench/table.h"
#include "sightline/geom/view.h"

namespace sightline::bench {

/// What is measured: boxes, the same as arrays, and a view from among them.
struct FrustumWorld {
    std::string where;
    const std::vector<Box3d>& boxes;
    FlatBoxes& flat;
    View view;
    int repeat = 15;
};

/// The walk over a hierarchy beside the flat list, where little is in view and where all is; with masks and without.
void addHierarchyRows(const FrustumWorld& world, Table& table);

/// A camera that moves and turns by 2 % a frame: each kind of coherency alone, all of them, and eight children at once.
void addCoherencyRows(const FrustumWorld& world, Table& table);

/// Bounds half as large as the view is deep: what the planes keep although it is outside, and what the refinement costs.
void addRefinementRows(const FrustumWorld& world, Table& table);

/// Spheres, oriented boxes and k-DOPs in flat lists; and many volumes in one pass.
void addBoundRows(const FrustumWorld& world, Table& table);

}  // namespace sightline::bench
