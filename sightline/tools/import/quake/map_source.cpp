// Where a compiled map's bytes come from: a file, or a file in an archive, a PAK or a ZIP.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/map_source.h"

#include <algorithm>
#include <cstring>
#include <filesystem>
#include <optional>
#include <span>
#include <string_view>

#include <fmt/core.h>
#include <zlib.h>

#include "sightline/base/bytes.h"
#include "sightline/tools/import/gltf/gltf_fault.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::tools {
namespace {

using gltf::fail;
using gltf::Fault;
using gltf::printable;
using Bytes = std::span<const unsigned char>;

constexpr size_t kEnd = 22, kListed = 46, kLocal = 30, kPakEntry = 64;  // sizes of records [bytes]
constexpr uint64_t kMostUnfolded = 1032;                                // deflate makes no byte into more

ByteCursor cursorAt(Bytes bytes, uint64_t at) {
    const Bytes rest = bytes.subspan(std::min<uint64_t>(at, bytes.size()));
    return ByteCursor({reinterpret_cast<const char*>(rest.data()), rest.size()});
}

bool hasWord(Bytes bytes, uint64_t at, const char* word) {
    return at + 4 <= bytes.size() && std::memcmp(bytes.data() + at, word, 4) == 0;
}

std::vector<ArchiveEntry> listPak(Bytes bytes) {
    constexpr size_t kName = 56;
    ByteCursor head = cursorAt(bytes, 4);
    const uint64_t first = head.take<uint32_t>(), size = head.take<uint32_t>();
    if (bytes.size() < 12 || first + size > bytes.size()) fail("", "truncated: its list ends beyond the file");
    if (size % kPakEntry != 0) fail("", "its list takes {} bytes, which is no multiple of {}", size, kPakEntry);
    std::vector<ArchiveEntry> out;
    for (uint64_t at = first; at < first + size; at += kPakEntry) {
        const Bytes name = bytes.subspan(at, kName);
        ArchiveEntry& entry = out.emplace_back();
        entry.name.assign(name.begin(), std::find(name.begin(), name.end(), 0));
        ByteCursor place = cursorAt(bytes, at + kName);
        entry.offset = place.take<uint32_t>();
        entry.size = entry.packed = place.take<uint32_t>();
        if (entry.offset + entry.size > bytes.size())
            fail("", "truncated: {} ends beyond the file", printable(entry.name));
    }
    return out;
}

/// Where the record stands that ends a zip; a comment of up to 65535 bytes may follow it.
std::optional<uint64_t> endOfZip(Bytes bytes) {
    if (bytes.size() < kEnd) return std::nullopt;
    const uint64_t last = bytes.size() - kEnd, first = last - std::min<uint64_t>(last, 65535);
    for (uint64_t at = last + 1; at-- > first;)
        if (hasWord(bytes, at, "PK\5\6")) return at;
    return std::nullopt;
}

ArchiveEntry takeListed(Bytes bytes, uint64_t& at, uint64_t end) {
    if (at + kListed > end || !hasWord(bytes, at, "PK\1\2")) fail("", "its list of files is spoiled at byte {}", at);
    ByteCursor cursor = cursorAt(bytes, at + 8);
    ArchiveEntry out;
    out.zipped = true;
    out.encrypted = cursor.take<uint16_t>() & 1;
    out.method = cursor.take<uint16_t>();
    cursor.take<uint32_t>();  // when it was written
    out.check = cursor.take<uint32_t>();
    out.packed = cursor.take<uint32_t>();
    out.size = cursor.take<uint32_t>();
    const uint64_t name = cursor.take<uint16_t>(), extra = cursor.take<uint16_t>(), comment = cursor.take<uint16_t>();
    cursor.take<uint64_t>();  // volume and attributes
    out.offset = cursor.take<uint32_t>();
    if (at + kListed + name + extra + comment > end) fail("", "its list of files is spoiled at byte {}", at);
    const Bytes letters = bytes.subspan(at + kListed, name);
    out.name.assign(letters.begin(), letters.end());
    at += kListed + name + extra + comment;
    return out;
}

std::vector<ArchiveEntry> listZip(Bytes bytes) {
    const std::optional<uint64_t> last = endOfZip(bytes);
    if (!last) fail("", "truncated: it lacks the end of a zip archive");
    ByteCursor cursor = cursorAt(bytes, *last + 4);
    const auto volume = cursor.take<uint16_t>(), first_volume = cursor.take<uint16_t>();
    const auto here = cursor.take<uint16_t>(), count = cursor.take<uint16_t>();
    const uint64_t size = cursor.take<uint32_t>(), offset = cursor.take<uint32_t>();
    if (volume != 0 || first_volume != 0 || here != count) fail("", "is one of several volumes, which are not read");
    if (count == 0xffff || size == 0xffffffff || offset == 0xffffffff) fail("", "is zip64, which is not read");
    if (offset + size > *last) fail("", "its list of files is spoiled: it ends at byte {} of {}", offset + size, *last);
    const uint64_t before = *last - size - offset;  // what was put before the archive, as a program that unpacks it
    std::vector<ArchiveEntry> out;
    uint64_t at = *last - size;
    for (uint16_t i = 0; i < count; ++i) {
        ArchiveEntry entry = takeListed(bytes, at, *last);
        entry.offset += before;
        if (!entry.name.ends_with('/')) out.push_back(std::move(entry));
    }
    return out;
}

/// The packed bytes: behind a header that repeats the name, with an extra field of its own length.
Bytes packedBytes(Bytes bytes, const ArchiveEntry& entry) {
    uint64_t first = entry.offset;
    if (entry.zipped) {
        if (first + kLocal > bytes.size() || !hasWord(bytes, first, "PK\3\4")) fail("", "is not where the list says");
        ByteCursor cursor = cursorAt(bytes, first + 26);
        const uint64_t name = cursor.take<uint16_t>(), extra = cursor.take<uint16_t>();
        first += kLocal + name + extra;
    }
    if (first + entry.packed > bytes.size()) fail("", "is truncated");
    return bytes.subspan(first, entry.packed);
}

std::vector<unsigned char> inflated(Bytes packed, uint64_t size) {
    constexpr int kRaw = -15;  // without a header of zlib's
    std::vector<unsigned char> out(size);
    z_stream stream = {};
    if (inflateInit2(&stream, kRaw) != Z_OK) fail("", "cannot be unpacked: too little memory");
    stream.next_in = const_cast<unsigned char*>(packed.data());
    stream.avail_in = static_cast<uInt>(packed.size());
    stream.next_out = out.data();
    stream.avail_out = static_cast<uInt>(size);
    const int end = inflate(&stream, Z_FINISH);
    const uint64_t made = stream.total_out;
    inflateEnd(&stream);
    if (end != Z_STREAM_END || made != size) fail("", "is spoiled: {} of {} bytes could be unpacked", made, size);
    return out;
}

std::vector<unsigned char> unpacked(Bytes bytes, const ArchiveEntry& entry) {
    if (entry.encrypted) fail("", "is encrypted");
    if (entry.size > kMostUnpacked) fail("", "is larger than {} MiB", kMostUnpacked >> 20);
    const Bytes packed = packedBytes(bytes, entry);
    std::vector<unsigned char> out;
    if (!entry.zipped || entry.method == 0) {
        if (packed.size() != entry.size) fail("", "is spoiled: {} bytes are stored as {}", entry.size, packed.size());
        out.assign(packed.begin(), packed.end());
    } else if (entry.method == Z_DEFLATED) {
        if (entry.size > packed.size() * kMostUnfolded)
            fail("", "is spoiled: it is too large for what it is packed to");
        out = inflated(packed, entry.size);
    } else {
        fail("", "is packed by method {}, which is not read", entry.method);
    }
    if (entry.zipped && crc32(0, out.data(), static_cast<uInt>(out.size())) != entry.check)
        fail("", "is spoiled: its check sum is another one");
    return out;
}

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c + 32);
    return out;
}

bool isArchiveName(const std::string& name) {
    const std::string low = lower(name);
    return low.ends_with(".pak") || low.ends_with(".pk3");
}

/// Quake's boxes of ammunition are `.bsp` files, too: maps/b_*.bsp.
bool isMap(const std::string& entry) {
    const std::string low = lower(entry);
    const size_t slash = low.rfind('/');
    return low.ends_with(".bsp") && low.compare(slash == std::string::npos ? 0 : slash + 1, 2, "b_") != 0;
}

std::string listed(const std::vector<const ArchiveEntry*>& maps) {
    constexpr size_t kMost = 10;
    std::string out;
    for (size_t i = 0; i < std::min(maps.size(), kMost); ++i)
        out += fmt::format("{}{}", i == 0 ? "" : ", ", gltf::printable(maps[i]->name));
    if (maps.size() > kMost) out += fmt::format(" and {} more", maps.size() - kMost);
    return out;
}

Result<const ArchiveEntry*> choose(const std::vector<ArchiveEntry>& entries, const MapName& name) {
    const auto error = [&](const std::string& what) {
        return Error{Error::Kind::kInput, fmt::format("{}: {}", name.file, what)};
    };
    for (const ArchiveEntry& entry : entries)
        if (!name.entry.empty() && entry.name == name.entry) return &entry;
    std::vector<const ArchiveEntry*> maps;
    for (const ArchiveEntry& entry : entries) {
        if (!name.entry.empty() && lower(entry.name) == lower(name.entry)) return &entry;
        if (isMap(entry.name)) maps.push_back(&entry);
    }
    const std::string choice = maps.empty() ? "it has no map" : "it has " + listed(maps);
    if (!name.entry.empty()) return error(fmt::format("has no {}: {}", gltf::printable(name.entry), choice));
    if (maps.empty()) return error("has no map");
    if (maps.size() > 1)
        return error(fmt::format("name one of its maps, as in {}:{}: {}", name.file, maps[0]->name, choice));
    return maps[0];
}

Result<MapBytes> fromArchive(const MapName& name, std::span<const unsigned char> bytes) {
    const Result<std::vector<ArchiveEntry>> entries = listArchive(bytes, name.file);
    if (!entries) return entries.error();
    const Result<const ArchiveEntry*> entry = choose(*entries, name);
    if (!entry) return entry.error();
    Result<std::vector<unsigned char>> unpacked = unpackEntry(bytes, name.file, **entry);
    if (!unpacked) return unpacked.error();
    return MapBytes{name.file + ":" + gltf::printable((*entry)->name), std::move(*unpacked)};
}

}  // namespace

Result<std::vector<ArchiveEntry>> listArchive(std::span<const unsigned char> bytes, const std::string& name) {
    try {
        if (hasWord(bytes, 0, "PACK")) return listPak(bytes);
        if (hasWord(bytes, 0, "PK\3\4") || hasWord(bytes, 0, "PK\5\6") || endOfZip(bytes)) return listZip(bytes);
        fail("", "is neither a .pak nor a .pk3");
    } catch (const Fault& fault) { return Error{Error::Kind::kInput, name + ": " + fault.message}; }
}

Result<std::vector<unsigned char>> unpackEntry(std::span<const unsigned char> bytes, const std::string& name,
                                               const ArchiveEntry& entry) {
    try {
        return unpacked(bytes, entry);
    } catch (const Fault& fault) {
        return Error{
            Error::Kind::kInput,
            fmt::format("{}: {} {}", name, entry.name.empty() ? "\"\"" : printable(entry.name), fault.message)};
    }
}

MapName splitMapName(const std::string& name) {
    std::error_code ignored;
    if (std::filesystem::exists(name, ignored)) return {name, {}};
    const std::string low = lower(name);
    for (size_t at = low.find(':'); at != std::string::npos; at = low.find(':', at + 1))
        if (isArchiveName(name.substr(0, at)) && at + 1 < name.size()) return {name.substr(0, at), name.substr(at + 1)};
    return {name, {}};
}

Result<MapBytes> readMapBytes(const std::string& name) {
    const MapName parts = splitMapName(name);
    const Result<std::string> text = readTextFile(parts.file);
    if (!text) return text.error();
    const std::span<const unsigned char> bytes(reinterpret_cast<const unsigned char*>(text->data()), text->size());
    const bool archive = text->starts_with("PACK") || text->starts_with("PK\3\4") || text->starts_with("PK\5\6");
    if (!parts.entry.empty() || archive) return fromArchive(parts, bytes);
    return MapBytes{name, {bytes.begin(), bytes.end()}};
}

Result<QuakeMapFile> readQuakeMap(const std::string& name) {
    const Result<MapBytes> map = readMapBytes(name);
    if (!map) return map.error();
    return parseQuakeBsp(map->bytes, map->name);
}

}  // namespace sightline::tools
