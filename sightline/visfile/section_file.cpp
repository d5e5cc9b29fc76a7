// Writes and opens containers of sections.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/section_file.h"

#include <algorithm>
#include <string>

#include "sightline/base/bytes.h"

namespace sightline {

using namespace section_file;

namespace {

constexpr uint64_t kAlign = 8;

uint64_t aligned(uint64_t at) { return (at + kAlign - 1) / kAlign * kAlign; }

struct Entry {
    uint32_t tag = 0, zero = 0;
    uint64_t at = 0, size = 0;
};

Entry entryOf(std::span<const char> file, uint32_t index) {
    ByteCursor from(file.subspan(kHashedAt + kEntryBytes * index, kEntryBytes));
    Entry entry;
    entry.tag = from.take<uint32_t>();
    entry.zero = from.take<uint32_t>();
    entry.at = from.take<uint64_t>();
    entry.size = from.take<uint64_t>();
    return entry;
}

uint32_t countOf(std::span<const char> file) { return ByteCursor(file.subspan(20, 4)).take<uint32_t>(); }

}  // namespace

Error faultAt(std::string_view file, std::string_view what, uint64_t at) {
    return {Error::Kind::kInput, std::string(file) + ": " + std::string(what) + " at byte " + std::to_string(at)};
}

Array<char> SectionWriter::file() const {
    Memory* memory = sections_.memory();
    Array<char> hashed(memory), out(memory);
    ByteWriter table(hashed), head(out);
    uint64_t at = kHashedAt + kEntryBytes * sections_.size();
    for (const Section& section : sections_) {
        table.put(section.tag);
        table.put(uint32_t{0});
        table.put(at = aligned(at));
        table.put(uint64_t{section.bytes.size()});
        at += section.bytes.size();
    }
    for (const Section& section : sections_) {
        hashed.resize(aligned(hashed.size()));
        hashed.insert(hashed.end(), section.bytes.begin(), section.bytes.end());
    }
    out.insert(out.end(), std::begin(kMagic), std::end(kMagic));
    head.put(kVersion);
    head.put(static_cast<uint32_t>(sections_.size()));
    head.put(contentHash(hashed));
    out.insert(out.end(), hashed.begin(), hashed.end());
    return out;
}

Result<SectionFile> SectionFile::open(std::span<const char> bytes, std::string_view file) {
    const size_t shown = std::min(bytes.size(), sizeof kMagic);
    if (shown == 0 || !std::equal(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(shown), kMagic))
        return faultAt(file, "not a visibility file", 0);
    if (bytes.size() < kHashedAt) return faultAt(file, "the file ends within its head", bytes.size());
    ByteCursor head(bytes.subspan(sizeof kMagic));
    if (const uint32_t version = head.take<uint32_t>(); version != kVersion)
        return faultAt(file,
                       "a visibility file of version " + std::to_string(version) + ", where version " +
                           std::to_string(kVersion) + " is read",
                       16);
    const uint32_t count = head.take<uint32_t>();
    if (count > kMostSections) return faultAt(file, "more sections than there may be", 20);
    const uint64_t hash = head.take<uint64_t>();
    uint64_t end = kHashedAt + kEntryBytes * count;
    if (bytes.size() < end) return faultAt(file, "the file ends within its head", bytes.size());
    for (uint32_t i = 0; i < count; ++i) {
        const uint64_t where = kHashedAt + kEntryBytes * i;
        const Entry entry = entryOf(bytes, i);
        for (uint32_t k = 0; k < i; ++k)
            if (entryOf(bytes, k).tag == entry.tag) return faultAt(file, "two sections of one kind", where);
        if (entry.zero != 0) return faultAt(file, "a section with a mark that is not known", where + 4);
        if (entry.at != aligned(end)) return faultAt(file, "a section that is not in its place", where + 8);
        if (entry.at > bytes.size() || entry.size > bytes.size() - entry.at)
            return faultAt(file, "a section that is longer than the file", where + 16);
        end = entry.at + entry.size;
    }
    if (end != bytes.size()) return faultAt(file, "bytes after the last section", end);
    if (contentHash(bytes.subspan(kHashedAt)) != hash)
        return faultAt(file, "the content does not have the hash that it says", kHashAt);
    SectionFile opened;
    opened.bytes_ = bytes;
    return opened;
}

std::span<const char> SectionFile::find(uint32_t tag) const {
    for (uint32_t i = 0; i < (bytes_.empty() ? 0 : countOf(bytes_)); ++i)
        if (const Entry entry = entryOf(bytes_, i); entry.tag == tag) return bytes_.subspan(entry.at, entry.size);
    return {};
}

}  // namespace sightline
