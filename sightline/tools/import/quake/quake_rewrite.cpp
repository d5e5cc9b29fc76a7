// A .bsp with another visibility lump: what lies behind it moves, and all that says where is told.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstring>
#include <limits>

#include "sightline/tools/import/quake/quake_lumps.h"
#include "sightline/tools/import/quake/quake_visibility.h"

namespace sightline::tools {
namespace {

using namespace quake;

uint64_t roundedUp(uint64_t place) { return (place + 3) / 4 * 4; }

uint32_t wordAt(const std::vector<unsigned char>& bytes, uint64_t at) {
    return ByteCursor({reinterpret_cast<const char*>(bytes.data()) + at, 4}).take<uint32_t>();
}

void putNumber(std::vector<unsigned char>& bytes, uint64_t at, uint64_t value) {
    for (size_t i = 0; i < 4; ++i) bytes[at + i] = static_cast<unsigned char>(value >> 8 * i);
}

/// The end of the last lump that holds anything.
uint64_t endOfLumps(const Directory& directory) {
    uint64_t end = directory.table + 8 * directory.lumps.size();
    for (const LumpPlace& lump : directory.lumps)
        if (lump.size > 0) end = std::max(end, lump.offset + lump.size);
    return end;
}

/// Where two lumps share bytes, none can change without the other.
void checkApart(const Directory& directory) {
    for (size_t i = 0; i < directory.lumps.size(); ++i) {
        const LumpPlace& a = directory.lumps[i];
        if (a.size == 0) continue;
        if (a.offset < directory.table + 8 * directory.lumps.size()) fail("", "lump {} overlaps the list of lumps", i);
        for (size_t k = 0; k < i; ++k) {
            const LumpPlace& b = directory.lumps[k];
            if (b.size > 0 && a.offset < b.offset + b.size && b.offset < a.offset + a.size)
                fail("", "lumps {} and {} overlap", k, i);
        }
    }
}

/// What is cut out of the file: the lump and what pads it.
struct Cut {
    uint64_t begin = 0, end = 0;
};

Cut cutOf(Bytes bytes, const Directory& directory, size_t number) {
    const LumpPlace& old = directory.lumps[number];
    if (old.size == 0) {
        const uint64_t place = roundedUp(endOfLumps(directory));
        return {place, place};
    }
    Cut out{old.offset, std::min<uint64_t>(roundedUp(old.offset + old.size), bytes.size())};
    for (const LumpPlace& other : directory.lumps)
        if (other.size > 0 && other.offset >= old.offset + old.size) out.end = std::min(out.end, other.offset);
    return out;
}

/// Compilers put lumps of later days behind the others, with a list of their own.
void moveExtensions(std::vector<unsigned char>& bytes, uint64_t list, uint64_t from, uint64_t by) {
    constexpr size_t kEntry = 32, kPlace = 24;
    if (list + 8 > bytes.size() || std::memcmp(bytes.data() + list, "BSPX", 4) != 0) return;
    const uint64_t count = wordAt(bytes, list + 4);
    if (count > (bytes.size() - list - 8) / kEntry) return;
    for (uint64_t i = 0; i < count; ++i) {
        const uint64_t at = list + 8 + i * kEntry + kPlace, place = wordAt(bytes, at);
        if (place >= from) putNumber(bytes, at, place + by);
    }
}

std::vector<unsigned char> replaced(Bytes bytes, const Directory& directory, size_t number,
                                    const std::vector<unsigned char>& lump) {
    const Cut cut = cutOf(bytes, directory, number);
    const uint64_t room = cut.end - cut.begin;
    const uint64_t length = lump.size() + (room + 4 - lump.size() % 4) % 4;  // so that all moves by a multiple of four
    const uint64_t by = length - room;                                       // modulo 2^64: may be less than nothing
    if (bytes.size() + length > std::numeric_limits<int32_t>::max()) fail("", "would be larger than 2 GiB");

    std::vector<unsigned char> out(
        bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(std::min<uint64_t>(cut.begin, bytes.size())));
    out.resize(cut.begin);
    out.insert(out.end(), lump.begin(), lump.end());
    out.resize(cut.begin + length);
    if (cut.end < bytes.size())
        out.insert(out.end(), bytes.begin() + static_cast<std::ptrdiff_t>(cut.end), bytes.end());

    Directory moved = directory;
    moved.lumps[number] = {cut.begin, lump.size()};
    for (size_t i = 0; i < moved.lumps.size(); ++i)
        if (i != number && moved.lumps[i].offset >= cut.end && moved.lumps[i].size > 0) moved.lumps[i].offset += by;
    for (size_t i = 0; i < moved.lumps.size(); ++i) {
        putNumber(out, directory.table + 8 * i, moved.lumps[i].offset);
        putNumber(out, directory.table + 8 * i + 4, moved.lumps[i].size);
    }
    moveExtensions(out, roundedUp(endOfLumps(moved)), cut.end, by);
    return out;
}

/// Quake's and Half-Life's leaves say where their rows begin, behind their contents.
void putOffsets(std::vector<unsigned char>& bytes, const QuakeVisibilityLump& lump) {
    const Directory directory = readDirectory(bytes);
    const uint64_t first = directory.lumps[static_cast<size_t>(directory.number(Lump::kLeaves))].offset;
    const size_t stride = lumpRecords(bytes, directory, Lump::kLeaves).stride();
    for (size_t cluster = 0; cluster < lump.row_offsets.size(); ++cluster)
        putNumber(bytes, first + (cluster + 1) * stride + 4, static_cast<uint32_t>(lump.row_offsets[cluster]));
}

}  // namespace

Result<std::vector<unsigned char>> replaceQuakeVisibility(std::span<const unsigned char> bytes, const std::string& name,
                                                          const BitMatrix& seen) {
    const auto error = [&](const std::string& what) { return Error{Error::Kind::kInput, name + ": " + what}; };
    const Result<QuakeMapFile> map = parseQuakeBsp(bytes, name);
    if (!map) return map.error();
    if (seen.rows() != map->clusters || seen.columns() != map->clusters)
        return error(fmt::format("has {} clusters, the visibility {}", map->clusters, seen.rows()));
    try {
        const Directory directory = readDirectory(bytes);
        checkApart(directory);
        const QuakeVisibilityLump lump = packQuakeVisibility(map->format, seen);
        std::vector<unsigned char> out =
            replaced(bytes, directory, static_cast<size_t>(directory.number(Lump::kVisibility)), lump.bytes);
        if (map->format != QuakeFormat::kQuake2 && map->format != QuakeFormat::kQuake3) putOffsets(out, lump);
        return out;
    } catch (const Fault& fault) { return error(fault.message); }
}

}  // namespace sightline::tools
