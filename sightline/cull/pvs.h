// What may be seen from where the eye is: the rows of visibility of the cells that it may be in, together.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/geom/view.h"
#include "sightline/space/portal_graph.h"

namespace sightline {

/// Rows of visibility, wherever they lie. Any number of threads may ask at once.
class RowSource {
public:
    virtual ~RowSource() = default;
    virtual uint32_t rows() const = 0;
    /// Writes a row: bit i % 64 of word i / 64 is whether it sees row i.
    /// @param out  [size: (rows() + 63) / 64]
    virtual void row(uint32_t row, std::span<uint64_t> out) const = 0;
};

/// The cells that what a view shows may be seen from first: those that the pyramid from the eye to its near rectangle
/// meets, in a parallel view the near rectangle; with View::eye_radius those around the eye that are as close to it, with
/// room to look around.
/// @param view   isUsable(view)
/// @param cells  receives them, rising
/// @returns false if a part of that may be in no cell
bool startCells(const PortalGraph& graph, const View& view, Array<uint32_t>& cells);

/// The union of rows of visibility. It is kept as long as the cells stay the same.
class PotentiallyVisible {
public:
    explicit PotentiallyVisible(Memory* memory = defaultMemory()) : start_(memory), union_(memory), row_(memory) {}

    /// @param start  startCells()
    /// @returns whether they are others than those before
    bool update(const PortalGraph& graph, const RowSource& source, std::span<const uint32_t> start);
    /// Forgets what it knows, as when the source is another one.
    void clear();

    /// False if nothing is known: there is no cell, or one that has no row.
    bool known() const { return known_; }
    /// A bit for each row that is seen.
    std::span<const uint64_t> rows() const { return union_; }

private:
    Array<uint32_t> start_;
    Array<uint64_t> union_, row_;
    bool known_ = false;
};

}  // namespace sightline
