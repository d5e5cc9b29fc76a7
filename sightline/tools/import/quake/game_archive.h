// Archives of the Quake family: .pak, and .pk3, which is zip.
// SPDX-License-Identifier: MIT
//
// PKWARE. .ZIP File Format Specification, 1989 and later.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sightline/base/result.h"

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

}  // namespace sightline::tools
