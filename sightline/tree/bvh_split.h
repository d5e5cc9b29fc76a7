// How items are shared out among the eight children of a node, for all that build such nodes.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
// Ibrahim Kamel, Christos Faloutsos. On Packing R-trees. 1993.
#pragma once

#include <cstdint>

#include "sightline/base/array.h"
#include "sightline/math/box.h"

namespace sightline {

/// Items that stand side by side in BvhSplitter::order.
struct BvhRange {
    uint32_t first = 0, last = 0;
    Box3f bounds;
    uint32_t count() const { return last - first; }
};

/// Splits ranges of items by binned surface area, small ones at the median; equal centers by their item's number. Items
/// that fit into one node are not split among several. For trees that do not last there is a quicker way: the items are
/// sorted along a curve once, and then cut in that order.
struct BvhSplitter {
    static constexpr int kWidth = 8;

    Array<Box3f> boxes;        ///< per item
    Array<glm::vec3> centers;  ///< per item: splitCenter()
    Array<uint32_t>& order;    ///< the items; splitting puts them in order

    BvhSplitter(Array<uint32_t>& items, Memory* memory) : boxes(memory), centers(memory), order(items) {}

    Box3f boundsOf(uint32_t first, uint32_t last) const;

    /// Splits a range into at most eight, the one of largest surface times count first. One item is not split.
    /// @returns how many
    int splitToEight(const BvhRange& range, BvhRange (&parts)[kWidth]);

    /// Sorts all items along the curve of Hilbert by their centers.
    void sortAlongCurve();
    /// Cuts a range into at most eight, in the order of its items. Of the nodes below, most have six children: two more may
    /// come.
    /// @returns how many
    int cutToEight(const BvhRange& range, BvhRange (&parts)[kWidth]) const;

private:
    uint32_t middleOf(const BvhRange& range) const;
    void split(const BvhRange& range, BvhRange& left, BvhRange& right);
    uint32_t splitAtMedian(const BvhRange& range, const Box3f& extent);
    bool splitByBins(const BvhRange& range, const Box3f& extent, BvhRange& left, BvhRange& right);
};

/// A box's center, kept where differences are finite and an order holds: boxes may reach beyond float.
glm::vec3 splitCenter(const Box3f& box);

}  // namespace sightline
