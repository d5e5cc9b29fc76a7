// The container of baked files: sections found by their tags, opened in place.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/array.h"
#include "sightline/base/result.h"

namespace sightline {

namespace section_file {

/// The file: magic, version, number of sections, contentHash() of all that follows; per section its tag, four bytes of
/// zero, where it begins and how long it is; the sections in that order, each at a multiple of 8 bytes from the file's
/// beginning, with zero between them. Numbers are little-endian; offsets and sizes have 64 bits.
inline constexpr char kMagic[16] = {'s', 'i', 'g', 'h', 't', 'l', 'i', 'n', 'e', ' ', 'c', 'e', 'l', 'l', 's', '\n'};
inline constexpr uint32_t kVersion = 1;
inline constexpr size_t kHashAt = 24;      ///< [bytes]
inline constexpr size_t kHashedAt = 32;    ///< what the hash is over begins here  [bytes]
inline constexpr size_t kEntryBytes = 24;  ///< of a section in the table
inline constexpr uint32_t kMostSections = 64;

/// Four letters as a number.
constexpr uint32_t tagOf(const char (&letters)[5]) {
    uint32_t tag = 0;
    for (int i = 0; i < 4; ++i) tag |= static_cast<uint32_t>(static_cast<unsigned char>(letters[i])) << 8 * i;
    return tag;
}

}  // namespace section_file

/// `FILE: what is wrong at byte N`.
Error faultAt(std::string_view file, std::string_view what, uint64_t at);

/// Gathers sections and writes them as one file: the same bytes for the same sections, on every machine.
class SectionWriter {
public:
    explicit SectionWriter(Memory* memory = defaultMemory()) : sections_(memory) {}

    /// @pre  no section has this tag yet, and there are fewer than kMostSections
    void add(uint32_t tag, Array<char> bytes) { sections_.push_back({tag, std::move(bytes)}); }
    Array<char> file() const;

private:
    struct Section {
        uint32_t tag = 0;
        Array<char> bytes;
    };
    Array<Section> sections_;
};

/// The sections of a file that lies in memory. It holds no copy: the bytes must outlive it.
class SectionFile {
public:
    /// Looks at the whole head, at each section's place, and at the hash. O(bytes), with no memory of its own. What is
    /// inside of the sections is for their readers to look at.
    /// @param file  what errors call the bytes
    /// Errors (kInput): one line with the file, what is wrong, and at which byte.
    static Result<SectionFile> open(std::span<const char> bytes, std::string_view file);

    /// Empty if there is no such section.
    std::span<const char> find(uint32_t tag) const;
    /// Where bytes of a section lie in the file.
    uint64_t placeOf(std::span<const char> section) const {
        return section.empty() ? bytes_.size() : static_cast<uint64_t>(section.data() - bytes_.data());
    }

private:
    std::span<const char> bytes_;
};

}  // namespace sightline
