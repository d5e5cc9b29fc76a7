// The cells that a world is divided by: their graph, what is seen from where, and where objects stand.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "sightline/base/array.h"
#include "sightline/base/assert.h"
#include "sightline/base/result.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/cells/pvs.h"
#include "sightline/visfile/visibility_file.h"

namespace sightline::detail {

/// Rows of a visibility file.
struct FileRows final : RowSource {
    VisibleRows from;

    uint32_t columns() const override { return from.cells(); }
    void row(uint32_t row, std::span<uint64_t> out) const override { from.row(row, out); }
};

/// View cells of a visibility file, and the file's objects that are seen from each.
struct AttachedViews final : RowSource {
    PortalGraph graph;  ///< without portals
    PlacedObjectRows from;
    uint32_t objects = 0;

    AttachedViews(const VisibilityFile& file, Memory* memory);
    uint32_t columns() const override { return objects; }
    void row(uint32_t row, std::span<uint64_t> out) const override { from.row(row, out); }
};

/// Made once; immutable, shared by a world and its snapshots.
struct AttachedCells {
    PortalGraph graph;
    FileRows rows;             ///< empty: the stage of the PVS does nothing
    glm::dvec3 origin{0.0};    ///< what the boxes of CellLists are relative to
    Array<Array<char>> doors;  ///< names
    Array<uint32_t> first_of_row,
        cell_of_row;                     ///< cells by row: those of row r from first_of_row[r] to before the next
    Array<uint32_t> without_row;         ///< cells that may be seen from everywhere
    PlacedObjects objects;               ///< objects whose cells a file knows; may be none
    std::optional<AttachedViews> views;  ///< with rows of `objects`

    AttachedCells(const CellSpace& space, const VisibleRows* visible, Memory* memory);

    static constexpr uint32_t kNone = ~0u;
    /// The file's object of a key that stands in a box, or kNone: there is none, or several have that key.
    uint32_t objectOf(uint64_t key, const Box3d& box) const;

    bool hasRows() const { return rows.columns() > 0; }
    /// Calls visit(cell) for each cell that a set of rows, given as bits, shows.
    template <class Visit>
    void forEachCell(std::span<const uint64_t> seen, Visit&& visit) const {
        SIGHTLINE_DEBUG_ASSERT(first_of_row.size() == size_t{rows.columns()} + 1);
        for (const uint32_t cell : without_row) visit(cell);
        for (size_t word = 0; word < seen.size(); ++word)
            for (uint64_t bits = seen[word]; bits; bits &= bits - 1) {
                const size_t row = 64 * word + static_cast<size_t>(std::countr_zero(bits));
                if (row >= rows.columns()) return;
                for (uint32_t i = first_of_row[row]; i < first_of_row[row + 1]; ++i) visit(cell_of_row[i]);
            }
    }
};

/// Whether a space can be attached: all that it says is finite, and names what there is.
/// Errors (kUsage): one line.
Status checkSpace(const CellSpace& space, const VisibleRows* visible);

}  // namespace sightline::detail
