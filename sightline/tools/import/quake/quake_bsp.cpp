// Compiled maps of the Quake family: the order in which their lumps are read.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_bsp.h"

#include "sightline/tools/import/quake/quake_faces.h"
#include "sightline/tools/import/quake/quake_lumps.h"
#include "sightline/tools/import/quake/quake_tree.h"

namespace sightline::tools {
namespace {

/// Quake 2 and 3: the lump begins with the number of clusters, and has room for what each must have there.
void countClusters(quake::Bytes lump, QuakeMapFile& map) {
    if (lump.empty()) return;
    const bool second = map.format == QuakeFormat::kQuake2;
    ByteCursor cursor({reinterpret_cast<const char*>(lump.data()), lump.size()});
    const auto count = cursor.take<uint32_t>();
    if (count < map.clusters) quake::fail("", "its visibility lump is of {} clusters, not {}", count, map.clusters);
    const uint64_t each = second ? 8 : cursor.take<uint32_t>();
    const bool whole = second ? cursor.left() / 8 >= count
                              : each * 8 >= count && (count == 0 || cursor.left() / count >= each) && lump.size() >= 8;
    if (!whole) quake::fail("", "its visibility lump has {} bytes, too few for {} clusters", lump.size(), count);
    map.clusters = count;
}

QuakeMapFile readMap(quake::Bytes bytes) {
    using namespace quake;
    const Directory directory = readDirectory(bytes);
    QuakeMapFile map;
    map.format = directory.format;
    readFaces(bytes, directory, map);
    readLeaves(bytes, directory, map);
    readTree(bytes, directory, map);
    const Bytes text = lumpBytes(bytes, directory, Lump::kEntities);
    map.entities.assign(text.begin(), text.end());
    if (const size_t end = map.entities.find('\0'); end != std::string::npos) map.entities.resize(end);
    const Bytes visibility = lumpBytes(bytes, directory, Lump::kVisibility);
    map.visibility.assign(visibility.begin(), visibility.end());
    if (map.format == QuakeFormat::kQuake2 || map.format == QuakeFormat::kQuake3) countClusters(visibility, map);
    return map;
}

}  // namespace

Result<QuakeMapFile> parseQuakeBsp(std::span<const unsigned char> bytes, const std::string& name) {
    try {
        return readMap(bytes);
    } catch (const quake::Fault& fault) { return Error{Error::Kind::kInput, name + ": " + fault.message}; }
}

}  // namespace sightline::tools
