// The visibility file: which cells of a map or scene see one another, where they are, and what lies in them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/cells/cell_space.h"
#include "sightline/visfile/cell_sections.h"
#include "sightline/visfile/object_rows.h"
#include "sightline/visfile/object_section.h"
#include "sightline/visfile/portal_sections.h"
#include "sightline/visfile/prepared_section.h"
#include "sightline/visfile/section_file.h"
#include "sightline/visfile/tree_section.h"
#include "sightline/visfile/visible_rows.h"

namespace sightline {

namespace visibility_file {

/// Sections. A reader passes over those that it does not know.
inline constexpr uint32_t kMap = section_file::tagOf("map ");         ///< leaves (4 bytes), 4 of zero, hash (8), name
inline constexpr uint32_t kRows = section_file::tagOf("rows");        ///< as tiledRows() writes them
inline constexpr uint32_t kPackedRows = section_file::tagOf("prow");  ///< as packedRows() does; instead of kRows
inline constexpr uint32_t kLeaves = section_file::tagOf("leaf");      ///< as leafCells() does
inline constexpr uint32_t kPackedLeaves =
    section_file::tagOf("plef");                                    ///< as packedLeafCells() does; instead of kLeaves
inline constexpr uint32_t kViewTree = section_file::tagOf("vtre");  ///< as treeSection() does: leaves are view cells
inline constexpr uint32_t kViewRows =
    section_file::tagOf("vrow");  ///< as objectRowsSection() does: a row for each of its leaves

}  // namespace visibility_file

/// What a visibility file is written from.
struct VisibilityContent {
    const BitMatrix& visible;                ///< [cells x cells], symmetric, its diagonal set
    std::span<const uint32_t> cell_of_leaf;  ///< of the map; CellGraph::kNoCell: none; may be empty
    std::string_view map_name;               ///< for people
    uint64_t map_hash = 0;                   ///< contentHash() of the file that the cells are of; 0: not known
    /// The cells as places, for run time: finer than those that have rows, which CellSpace::row_of_cell tells. Or null.
    const CellSpace* space = nullptr;
    const ObjectPlaces* objects = nullptr;   ///< in cells of the space; or null
    const BitMatrix* object_rows = nullptr;  ///< [rows of `visible` x objects]; or null
    /// View cells, and the objects that may be seen from each, whatever the other cells are. Both or neither.
    const LeafTree* view_tree = nullptr;
    const BitMatrix* view_rows = nullptr;               ///< [leaves of `view_tree` x objects]
    std::span<const PreparedMesh> prepared = {};        ///< what a world needs of the objects' meshes; may be empty
    std::span<const uint32_t> prepared_of_object = {};  ///< per object which of these; PreparedMeshes::kNone: none
};

enum class VisibilityForm {
    kInPlace,  ///< answers as it lies in memory or in a mapped file
    kPacked,   ///< a third of the bytes or less; unpacked when it is opened
};

/// The bytes of the file: the same for the same content, on every machine.
/// Errors (kUsage): as tiledRows(), a leaf of a cell that there is not, parts that do not belong together, or what a reader would
/// refuse.
Result<Array<char>> visibilityFile(const VisibilityContent& content, VisibilityForm form,
                                   Memory* memory = defaultMemory());

/// A visibility file that was opened. Any number of threads may ask at once.
class VisibilityFile {
public:
    /// Of a file in place nothing is copied; of a packed one its sections are unpacked. The bytes must outlive it.
    /// Nothing in them is believed: whatever they are, they are opened so that every question has an answer, or
    /// refused. O(bytes) in place; packed, also O(cells^2 / 128).
    /// @param file  what errors call the bytes
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<VisibilityFile> open(std::span<const char> bytes, std::string_view file,
                                       Memory* memory = defaultMemory());

    const VisibleRows& rows() const { return rows_; }
    uint32_t leaves() const { return static_cast<uint32_t>(cell_of_leaf_.size()); }
    /// CellGraph::kNoCell if it is in none.
    /// @pre leaf < leaves()
    uint32_t cellOfLeaf(uint32_t leaf) const {
        const uint16_t cell = cell_of_leaf_[leaf];
        return cell < rows_.cells() ? cell : CellGraph::kNoCell;
    }
    std::string_view mapName() const { return map_name_; }
    uint64_t mapHash() const { return map_hash_; }
    /// What answers are read from: rows and leaves, and of places all sections.
    size_t residentBytes() const;

    /// Whether it holds the cells as places, too.
    bool hasCells() const { return has_cells_; }
    /// A copy of them, for PortalGraph. O(cells + portals).
    /// @pre hasCells()
    CellSpace cellSpace() const;
    /// Where these cells lie, without a copy.
    /// @pre hasCells()
    const PlacedCells& cells() const { return cells_; }
    const PlacedPortals& portals() const { return portals_; }

    bool hasObjects() const { return has_objects_; }
    /// Objects and the cells of cellSpace() that they lay in; none if !hasObjects().
    const PlacedObjects& objects() const { return objects_; }
    bool hasObjectRows() const { return has_object_rows_; }
    /// Which objects are seen from the cells of a row: a bit for each of objects(). Those that are
    /// seenFromEverywhere() are whatever it says.
    /// @pre hasObjectRows(), row < rows().cells()
    /// @param out  [size: (objects().size() + 63) / 64]
    void objectRow(uint32_t row, std::span<uint64_t> out) const { object_rows_.row(row, out); }

    /// Whether it holds view cells; then hasObjects().
    bool hasViewCells() const { return has_view_cells_; }
    /// A copy of their tree: leaf i is row i of viewRows().
    /// @pre hasViewCells()
    LeafTree viewTree() const { return view_tree_.tree(); }
    const PlacedObjectRows& viewRows() const { return view_rows_; }

    /// Whether it holds what a world needs of the objects' meshes; then hasObjects().
    bool hasPrepared() const { return has_prepared_; }
    /// A copy of it: occluders, shapes, clusters to draw, and chains of levels of detail. It is what was prepared of the meshes that
    /// were baked: whoever gives it to a world answers for it that its meshes are the same. O(bytes).
    /// @param file  what errors call the bytes
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    /// @pre hasPrepared()
    Result<PreparedMeshes> prepared(std::string_view file, Memory* memory = defaultMemory()) const;

    VisibilityFile(VisibilityFile&&) = default;
    VisibilityFile& operator=(VisibilityFile&&) = delete;

private:
    explicit VisibilityFile(Memory* memory) : unpacked_rows_(memory), unpacked_leaves_(memory) {}
    Status openPlaces(const SectionFile& sections, std::string_view file);
    friend Array<char> packedFile(const VisibilityFile& file, Memory* memory);

    Array<char> unpacked_rows_, unpacked_leaves_;
    VisibleRows rows_;
    PlacedNumbers<uint16_t> cell_of_leaf_;
    std::string_view map_name_;
    uint64_t map_hash_ = 0;

    SectionFile sections_;
    bool has_cells_ = false, has_objects_ = false, has_object_rows_ = false, has_view_cells_ = false,
         has_prepared_ = false;
    PlacedCells cells_;
    PlacedPortals portals_;
    PlacedTree tree_;
    PlacedObjects objects_;
    PlacedObjectRows object_rows_;
    PlacedTree view_tree_;
    PlacedObjectRows view_rows_;
};

/// The packed form of an opened file: the bytes that visibilityFile() writes of the same content, without putting its
/// rows in order again, which is most of the time.
Array<char> packedFile(const VisibilityFile& file, Memory* memory = defaultMemory());

}  // namespace sightline
