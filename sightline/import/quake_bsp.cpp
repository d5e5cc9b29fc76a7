// Compiled maps of the Quake family: the order in which their lumps are read.
// SPDX-License-Identifier: MIT
#include "sightline/import/quake_bsp.h"

#include "sightline/import/quake_faces.h"
#include "sightline/import/quake_lumps.h"
#include "sightline/import/quake_tree.h"

namespace sightline {
namespace {

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
    return map;
}

}  // namespace

Result<QuakeMapFile> parseQuakeBsp(std::span<const unsigned char> bytes, const std::string& name) {
    try {
        return readMap(bytes);
    } catch (const quake::Fault& fault) { return Error{Error::Kind::kInput, name + ": " + fault.message}; }
}

}  // namespace sightline
