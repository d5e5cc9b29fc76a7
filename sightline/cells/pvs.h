// What may be seen from where the eye is: the rows of visibility of the cells that it may be in, together.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/geom/view.h"

namespace sightline {

/// Rows of visibility, wherever they lie. Any number of threads may ask at once.
class RowSource {
public:
    virtual ~RowSource() = default;
    /// Bits of a row: what may be seen, other rows or objects.
    virtual uint32_t columns() const = 0;
    /// Writes a row: bit i % 64 of word i / 64 is whether it sees i.
    /// @param out  [size: (columns() + 63) / 64]
    virtual void row(uint32_t row, std::span<uint64_t> out) const = 0;
};

/// The cells in which a view's sight lines may begin: those that meet the pyramid from the eye to the near rectangle,
/// or in a parallel view the near rectangle. With View::eye_radius: those that meet the near pyramids of all eyes in
/// that radius, whichever way they look.
/// @param view   isUsable(view)
/// @param cells  receives them, rising
/// @returns false if a part of that region may be in no cell
bool startCells(const PortalGraph& graph, const View& view, Array<uint32_t>& cells);

/// The union of the rows of the eye's cells. It is kept as long as these cells stay the same.
class PotentiallyVisible {
public:
    explicit PotentiallyVisible(Memory* memory = defaultMemory()) : start_(memory), union_(memory), row_(memory) {}

    /// @param start  startCells()
    /// @returns whether the cells are others than before
    bool update(const PortalGraph& graph, const RowSource& source, std::span<const uint32_t> start);
    /// Forgets what it knows. Needed when the source of rows changes.
    void clear();

    /// False if nothing is known: the eye is in no cell, or in a cell without a row.
    bool known() const { return known_; }
    /// A bit for each of RowSource::columns() that is seen.
    std::span<const uint64_t> rows() const { return union_; }

private:
    Array<uint32_t> start_;
    Array<uint64_t> union_, row_;
    bool known_ = false;
};

}  // namespace sightline
