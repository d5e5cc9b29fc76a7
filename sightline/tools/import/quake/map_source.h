// Where a compiled map's bytes come from: a file, or a file in an archive, a PAK or a ZIP.
// SPDX-License-Identifier: MIT
//
// PKWARE. .ZIP File Format Specification, 1989 and later.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/tools/import/quake/quake_bsp.h"

namespace sightline::tools {

/// A file in an archive, and where its bytes are.
struct ArchiveEntry {
    std::string name;     ///< as the archive has it; not checked to be a sane path
    uint64_t size = 0;    ///< unpacked, as the archive says  [bytes]
    uint64_t packed = 0;  ///< [bytes]
    uint64_t offset = 0;  ///< .pak: of the bytes; .pk3: of the header before them
    uint32_t check = 0;   ///< .pk3: CRC-32 of what is unpacked
    uint16_t method = 0;  ///< .pk3: 0 as it is, 8 deflated
    bool zipped = false;  ///< in a .pk3
    bool encrypted = false;
};

/// What an archive holds, in its own order; folders left out.
/// Errors (kInput) are one line with the name: neither kind, lists or entries beyond the file's end, zip64, several volumes.
Result<std::vector<ArchiveEntry>> listArchive(std::span<const unsigned char> bytes, const std::string& name);

/// No entry is unpacked to more.  [bytes]
constexpr uint64_t kMostUnpacked = uint64_t(1) << 30;

/// The bytes of one entry. Takes no more memory than the packed bytes can unfold to.
/// Errors (kInput) are one line with the archive's and the entry's names: encrypted, packed otherwise, larger than
/// kMostUnpacked, spoiled.
Result<std::vector<unsigned char>> unpackEntry(std::span<const unsigned char> bytes, const std::string& name,
                                               const ArchiveEntry& entry);

/// "pak0.pk3:maps/x.bsp" by its two parts; without a second part the first is the whole name.
struct MapName {
    std::string file;   ///< on disk
    std::string entry;  ///< in it; empty: none was named
};

/// A name with `.pak:` or `.pk3:` in it names an entry, unless there is such a file.
MapName splitMapName(const std::string& name);

struct MapBytes {
    std::string name;  ///< as errors tell it: the file, and the entry where it lies in an archive
    std::vector<unsigned char> bytes;
};

/// Reads `x.bsp`, `x.pak:maps/y.bsp`, `x.pk3:maps/y.bsp`; of an archive alone its only map. An entry's letters may be of
/// either case.
///
/// Errors (kInput) are one line with the name: what cannot be read or unpacked, an archive without such an entry, or
/// with no map or several, which are then listed.
Result<MapBytes> readMapBytes(const std::string& name);

/// The same, parsed. Errors of either.
Result<QuakeMapFile> readQuakeMap(const std::string& name);

}  // namespace sightline::tools
