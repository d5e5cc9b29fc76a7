// Maps in files and archives.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/map_source.h"

#include <algorithm>
#include <filesystem>
#include <span>
#include <string_view>

#include <fmt/format.h>

#include "sightline/tools/import/gltf/gltf_fault.h"
#include "sightline/tools/import/quake/game_archive.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::tools {
namespace {

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
