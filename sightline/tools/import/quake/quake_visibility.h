// The visibility lump of a compiled map: out of the file as bits, and back into it.
// SPDX-License-Identifier: MIT
//
// Michael Abrash. Graphics Programming Black Book, chapter 70: Quake, a post-mortem and a glimpse into the future.
// 1997.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/result.h"
#include "sightline/tools/import/quake/quake_bsp.h"

namespace sightline::tools {

struct QuakeVisibility {
    BitMatrix seen;             ///< [clusters x clusters]: what each cluster sees
    BitMatrix heard;            ///< Quake 2: what it hears; of other formats empty
    uint64_t rows_missing = 0;  ///< clusters without a row: they see everything, as engines have it
};

/// Unpacks the lump. Quake and Half-Life: a row for each leaf, runs of zero bytes by their length. Quake 2: the same by
/// clusters, two rows each. Quake 3: plain bits.
///
/// Errors (kInput) are one line with the name and the cluster: a row that begins or goes on beyond the lump, more
/// clusters than kMostClusters.
Result<QuakeVisibility> readQuakeVisibility(const QuakeMapFile& map, const std::string& name);

/// A matrix of more would take 512 MiB.
constexpr uint32_t kMostClusters = 65536;

/// What clusters see of one another by what the cells of their leaves see: where cells are leaves or sets of them. A
/// cluster with an open leaf that has no cell sees all, and is seen by all; but of the sky nothing is drawn that is
/// in it, and sight lines end there: it sees all, and is not seen.
/// @param cells         [cells x cells]
/// @param cell_of_leaf  per leaf of the map, as CellGraph has it; missing ones have no cell
BitMatrix clusterRows(const QuakeMapFile& map, const BitMatrix& cells, std::span<const uint32_t> cell_of_leaf);

/// A lump, and where in it each cluster's row begins.
struct QuakeVisibilityLump {
    std::vector<unsigned char> bytes;
    std::vector<int32_t> row_offsets;  ///< [size: clusters]
};

/// Packs rows as the format has them; rows that are the same are stored once, but in Quake 3, which has no offsets. In
/// Quake 2 a cluster hears what any cluster that it sees, sees.
/// @param seen  [clusters x clusters]
QuakeVisibilityLump packQuakeVisibility(QuakeFormat format, const BitMatrix& seen);

/// The bytes of the same `.bsp` with these rows. Of all other lumps nothing changes but, in Quake and Half-Life, the
/// offsets of rows that leaves hold; what lies behind the lump moves by a multiple of four bytes, BSPX lumps included.
/// An error (kInput) is one line: what parseQuakeBsp() finds, lumps that overlap, rows of another size.
/// @param seen  [clusters x clusters]
Result<std::vector<unsigned char>> replaceQuakeVisibility(std::span<const unsigned char> bytes, const std::string& name,
                                                          const BitMatrix& seen);

}  // namespace sightline::tools
