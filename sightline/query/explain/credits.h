// What each occluder of a frame was worth: how many objects it hid, beside how many triangles it cost.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/geom/view.h"
#include "sightline/world/world.h"

namespace sightline {

/// What an occluder did for one answer.
struct Credit {
    ObjectId id;
    uint32_t item = 0;         ///< the object's place in the order of World::add, removed objects left out
    uint64_t triangles = 0;    ///< of the occluder, that were rasterized
    double hidden = 0;         ///< objects that it hid; one that several hide is shared among them
    double hidden_weight = 0;  ///< the same, each object by its weight
};

/// Finds the credits of queries on one snapshot. Each occluder of a frame is drawn once more, alone. A pixel belongs to
/// the nearest occluder that covers it. The owners of the pixels in a culled rectangle share its credit, by the number
/// of their pixels; what a volume culled is credited to the volume's object. Costs some tens of queries a frame, and
/// O(objects) once.
///
/// Objects that were culled together, as a node of the hierarchy, have one rectangle. The credits of a frame add up to
/// the objects that its occlusion stage and its volumes culled.
class CreditBook {
public:
    /// @param weights  of the objects, for Credit::hidden_weight [size: Snapshot::objectCount(), or none: all 1]
    explicit CreditBook(const Snapshot& now, std::span<const double> weights = {}, Memory* memory = defaultMemory());
    ~CreditBook();
    CreditBook(CreditBook&&) noexcept;
    CreditBook& operator=(CreditBook&&) noexcept;

    /// The credits of all occluders that a query for this view rasterizes, or whose volumes cull something, by item.
    /// Valid until the next call.
    std::span<const Credit> credits(const View& view, const QuerySettings& settings = {});

    /// Objects that the last view's occlusion stage culled and whose pixels no occluder owns: 0, apart from rounding.
    double unshared() const;

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
