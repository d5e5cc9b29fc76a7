// The section of objects: which cells each of them lay in, and where it stood, when the file was baked.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/math/box.h"
#include "sightline/visfile/placed_parts.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

namespace visibility_file {

/// objects, numbers of cells in all: 8 bytes each; per object its key (8), bounds (48), where its cells end (8), marks
/// (a byte; 1: seen from everywhere, 2: a wall); with zero up to a multiple of 4; the cells of all, 4 bytes each.
inline constexpr uint32_t kObjects = section_file::tagOf("objs");

}  // namespace visibility_file

/// Objects and the cells that they lie in, in the order of their keys. Several may have the same.
struct ObjectPlaces {
    std::vector<uint64_t> keys;           ///< rising
    std::vector<Box3d> bounds;            ///< in the world; finite
    std::vector<uint64_t> first_cell{0};  ///< per object where its cells begin, and the end
    std::vector<uint32_t> cells;          ///< rising for each object
    std::vector<bool> everywhere;         ///< seen from everywhere: whatever its cells are
    std::vector<bool> wall;               ///< what cells and portals are rests on it: while it stands, they hold

    size_t size() const { return keys.size(); }
    std::span<const uint32_t> cellsOf(size_t i) const {
        return {cells.data() + first_cell[i], cells.data() + first_cell[i + 1]};
    }
    void add(uint64_t key, const Box3d& box, std::span<const uint32_t> in, bool seen_from_everywhere,
             bool is_wall = false) {
        keys.push_back(key);
        bounds.push_back(box);
        cells.insert(cells.end(), in.begin(), in.end());
        first_cell.push_back(cells.size());
        everywhere.push_back(seen_from_everywhere);
        wall.push_back(is_wall);
    }
};

/// @param cells  that there are
/// Errors (kUsage): what a reader would refuse.
Result<Array<char>> objectSection(const ObjectPlaces& objects, uint32_t cells, Memory* memory = defaultMemory());

/// Objects where they lie.
class PlacedObjects {
public:
    PlacedObjects() = default;
    /// @param cells  that there are
    /// @param file   what errors call the bytes
    /// @param at     their place in it
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<PlacedObjects> open(std::span<const char> bytes, uint32_t cells, std::string_view file,
                                      uint64_t at = 0);

    size_t size() const { return keys_.size(); }
    /// Rising; several objects may have the same.
    /// @pre i < size(), as in all that follow
    uint64_t key(size_t i) const { return keys_[i]; }
    /// In the world, when the file was baked: what stands elsewhere now is not in these cells.
    Box3d bounds(size_t i) const;
    /// The cells that it lies in or comes as close to as the space's tolerance, rising. None only if it is seen from
    /// everywhere.
    PlacedNumbers<uint32_t> cells(size_t i) const;
    /// It is in no cell, or reaches out of all: nothing that cells say may hide it.
    bool seenFromEverywhere(size_t i) const { return (marks_[i] & 1) != 0; }
    /// The file holds only while this object is drawn, opaque, where it was: it is a wall of cells.
    bool isWall(size_t i) const { return (marks_[i] & 2) != 0; }
    /// The first object of a key and the end of its objects; empty if there is none. O(log size()).
    std::pair<size_t, size_t> find(uint64_t key) const;

private:
    PlacedNumbers<uint64_t> keys_, ends_;
    PlacedNumbers<double> bounds_;
    PlacedNumbers<uint8_t> marks_;
    std::span<const char> cells_;
};

}  // namespace sightline
