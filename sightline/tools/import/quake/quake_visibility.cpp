// The visibility lump as bits: its three ways of storage, unpacked and packed.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_visibility.h"

#include <algorithm>
#include <unordered_map>

#include "sightline/tools/import/quake/quake_lumps.h"

namespace sightline::tools {
namespace {

using namespace quake;

void setAll(BitMatrix& matrix, size_t row) {
    for (size_t column = 0; column < matrix.columns(); ++column) matrix.set(row, column);
}

/// Bits behind the last column are dropped: files may have them set.
void putByte(BitMatrix& matrix, size_t row, size_t byte, uint64_t bits) {
    const size_t columns = matrix.columns();
    if (byte * 8 >= columns) return;
    if (columns - byte * 8 < 8) bits &= (1u << (columns - byte * 8)) - 1;
    matrix.row(row)[byte / 8] |= bits << (byte % 8 * 8);
}

/// A byte, or a zero and how many of them.
void unpackRow(Bytes lump, int64_t offset, BitMatrix& matrix, size_t row) {
    const size_t length = (matrix.columns() + 7) / 8;
    const auto size = static_cast<int64_t>(lump.size());
    int64_t place = offset;
    for (size_t byte = 0; byte < length;) {
        if (place >= size || (lump[static_cast<size_t>(place)] == 0 && place + 1 >= size))
            fail(at("visibility", row), "the row that begins at byte {} goes on beyond the lump's {}", offset, size);
        const unsigned char bits = lump[static_cast<size_t>(place++)];
        if (bits != 0) {
            putByte(matrix, row, byte++, bits);
            continue;
        }
        const size_t zeros = lump[static_cast<size_t>(place++)];
        if (zeros == 0) fail(at("visibility", row), "a run of no zeros at byte {}", place - 2);
        byte += zeros;
    }
}

int32_t numberAt(Bytes lump, size_t at) {
    const Bytes four = lump.subspan(at, 4);
    return ByteCursor({reinterpret_cast<const char*>(four.data()), four.size()}).take<int32_t>();
}

void readFirst(const QuakeMapFile& map, QuakeVisibility& out) {
    for (uint32_t cluster = 0; cluster < map.clusters; ++cluster) {
        const int32_t offset = map.row_offsets[cluster];
        if (offset >= 0 && !map.visibility.empty()) {
            unpackRow(map.visibility, offset, out.seen, cluster);
            continue;
        }
        setAll(out.seen, cluster);
        ++out.rows_missing;
    }
}

void readSecond(const QuakeMapFile& map, QuakeVisibility& out) {
    out.heard = BitMatrix(map.clusters, map.clusters);
    for (uint32_t cluster = 0; cluster < map.clusters; ++cluster)
        for (const size_t which : {0, 1}) {
            const int32_t offset = numberAt(map.visibility, 4 + 8 * size_t(cluster) + 4 * which);
            if (offset < 0) fail(at("visibility", cluster), "a row begins at byte {}", offset);
            unpackRow(map.visibility, offset, which == 0 ? out.seen : out.heard, cluster);
        }
}

void readThird(const QuakeMapFile& map, QuakeVisibility& out) {
    const auto length = static_cast<size_t>(numberAt(map.visibility, 4));
    for (size_t cluster = 0; cluster < map.clusters; ++cluster)
        for (size_t byte = 0; byte < length && byte * 8 < map.clusters; ++byte)
            putByte(out.seen, cluster, byte, map.visibility[8 + cluster * length + byte]);
}

void packRow(const BitMatrix& matrix, size_t row, std::vector<unsigned char>& out) {
    const size_t length = (matrix.columns() + 7) / 8;
    const auto words = matrix.row(row);
    const auto byteAt = [&](size_t byte) { return static_cast<unsigned char>(words[byte / 8] >> (byte % 8 * 8)); };
    for (size_t byte = 0; byte < length;) {
        const unsigned char bits = byteAt(byte++);
        out.push_back(bits);
        if (bits != 0) continue;
        unsigned char zeros = 1;
        for (; zeros < 255 && byte < length && byteAt(byte) == 0; ++byte) ++zeros;
        out.push_back(zeros);
    }
}

/// Packs rows behind one another; one that was there before is not packed again.
class RowPacker {
public:
    explicit RowPacker(const BitMatrix& matrix) : matrix_(matrix) {}

    int32_t place(size_t row, std::vector<unsigned char>& out) {
        const auto words = matrix_.row(row);
        const uint64_t hash = contentHash({reinterpret_cast<const char*>(words.data()), words.size_bytes()});
        std::vector<Known>& same = known_[hash];
        for (const Known& known : same)
            if (std::ranges::equal(matrix_.row(known.row), words)) return known.offset;
        same.push_back({row, static_cast<int32_t>(out.size())});
        packRow(matrix_, row, out);
        return same.back().offset;
    }

private:
    struct Known {
        size_t row;
        int32_t offset;
    };
    const BitMatrix& matrix_;
    std::unordered_map<uint64_t, std::vector<Known>> known_;
};

/// For each cluster the union of the rows of what it sees.
BitMatrix hearing(const BitMatrix& seen) {
    BitMatrix out(seen.rows(), seen.columns());
    for (size_t row = 0; row < seen.rows(); ++row)
        for (size_t other = 0; other < seen.columns(); ++other) {
            if (!seen.at(row, other)) continue;
            const auto to = out.row(row);
            const auto from = seen.row(other);
            for (size_t word = 0; word < to.size(); ++word) to[word] |= from[word];
        }
    return out;
}

void putNumber(std::vector<unsigned char>& out, size_t at, uint32_t value) {
    for (size_t i = 0; i < 4; ++i) out[at + i] = static_cast<unsigned char>(value >> 8 * i);
}

/// Quake 2: the number of clusters, for each where its two rows begin, the rows.
void packSecond(const BitMatrix& seen, QuakeVisibilityLump& out) {
    const BitMatrix heard = hearing(seen);
    out.bytes.resize(4 + 8 * seen.rows());
    putNumber(out.bytes, 0, static_cast<uint32_t>(seen.rows()));
    RowPacker eyes(seen), ears(heard);
    for (size_t row = 0; row < seen.rows(); ++row) {
        out.row_offsets.push_back(eyes.place(row, out.bytes));
        putNumber(out.bytes, 4 + 8 * row, static_cast<uint32_t>(out.row_offsets.back()));
        const auto hears = static_cast<uint32_t>(ears.place(row, out.bytes));
        putNumber(out.bytes, 8 + 8 * row, hears);
    }
}

/// Quake 3: the number of clusters, the length of a row, the rows.
void packThird(const BitMatrix& seen, QuakeVisibilityLump& out) {
    const size_t length = seen.wordsPerRow() * 8;
    out.bytes.resize(8 + seen.rows() * length);
    putNumber(out.bytes, 0, static_cast<uint32_t>(seen.rows()));
    putNumber(out.bytes, 4, static_cast<uint32_t>(length));
    for (size_t row = 0; row < seen.rows(); ++row) {
        out.row_offsets.push_back(static_cast<int32_t>(8 + row * length));
        for (size_t byte = 0; byte < length; ++byte)
            out.bytes[8 + row * length + byte] = static_cast<unsigned char>(seen.row(row)[byte / 8] >> (byte % 8 * 8));
    }
}

}  // namespace

Result<QuakeVisibility> readQuakeVisibility(const QuakeMapFile& map, const std::string& name) {
    const auto error = [&](const std::string& what) { return Error{Error::Kind::kInput, name + ": " + what}; };
    if (map.clusters > kMostClusters)
        return error(fmt::format("has {} clusters, more than {}", map.clusters, kMostClusters));
    QuakeVisibility out;
    out.seen = BitMatrix(map.clusters, map.clusters);
    const bool by_leaf = map.format != QuakeFormat::kQuake2 && map.format != QuakeFormat::kQuake3;
    try {
        if (by_leaf) {
            readFirst(map, out);
        } else if (map.visibility.empty()) {
            for (uint32_t row = 0; row < map.clusters; ++row) setAll(out.seen, row);
            out.rows_missing = map.clusters;
        } else if (map.format == QuakeFormat::kQuake2) {
            readSecond(map, out);
        } else {
            readThird(map, out);
        }
    } catch (const Fault& fault) { return error(fault.message); }
    return out;
}

BitMatrix clusterRows(const QuakeMapFile& map, const BitMatrix& cells, std::span<const uint32_t> cell_of_leaf) {
    std::vector<std::vector<uint32_t>> clusters_of_cell(cells.rows());
    std::vector<bool> open(map.clusters);  // sees all, and is seen
    std::vector<bool> sky(map.clusters);   // sees all
    for (size_t leaf = 0; leaf < map.cluster_of_leaf.size(); ++leaf) {
        const uint32_t cluster = map.cluster_of_leaf[leaf];
        if (cluster == QuakeMapFile::kNoCluster) continue;
        const uint32_t cell = leaf < cell_of_leaf.size() ? cell_of_leaf[leaf] : ~0u;
        if (cell < cells.rows()) clusters_of_cell[cell].push_back(cluster);
        else if (map.tree.contents[leaf] == LeafContents::kSky) sky[cluster] = true;
        else if (map.tree.contents[leaf] != LeafContents::kSolid) open[cluster] = true;
    }
    for (std::vector<uint32_t>& clusters : clusters_of_cell) {
        std::sort(clusters.begin(), clusters.end());
        clusters.erase(std::unique(clusters.begin(), clusters.end()), clusters.end());
    }

    BitMatrix out(map.clusters, map.clusters), one(1, map.clusters);
    for (size_t cell = 0; cell < cells.rows(); ++cell) {
        if (clusters_of_cell[cell].empty()) continue;
        std::ranges::fill(one.row(0), 0);
        for (size_t other = 0; other < cells.columns(); ++other)
            if (cells.at(cell, other))
                for (const uint32_t cluster : clusters_of_cell[other]) one.set(0, cluster);
        for (const uint32_t cluster : clusters_of_cell[cell])
            for (size_t word = 0; word < one.wordsPerRow(); ++word) out.row(cluster)[word] |= one.row(0)[word];
    }
    for (uint32_t cluster = 0; cluster < map.clusters; ++cluster) {
        if (open[cluster] || sky[cluster]) setAll(out, cluster);
        if (!open[cluster]) continue;
        for (uint32_t other = 0; other < map.clusters; ++other) out.set(other, cluster);
    }
    return out;
}

QuakeVisibilityLump packQuakeVisibility(QuakeFormat format, const BitMatrix& seen) {
    QuakeVisibilityLump out;
    if (format == QuakeFormat::kQuake2) {
        packSecond(seen, out);
    } else if (format == QuakeFormat::kQuake3) {
        packThird(seen, out);
    } else {
        RowPacker rows(seen);
        for (size_t row = 0; row < seen.rows(); ++row) out.row_offsets.push_back(rows.place(row, out.bytes));
    }
    return out;
}

}  // namespace sightline::tools
