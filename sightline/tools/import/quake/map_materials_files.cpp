// Walks folders and archives; the end of a name says what a file is.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/map_materials_files.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <system_error>
#include <vector>

#include <fmt/core.h>

#include "sightline/base/bytes.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/shader_script.h"
#include "sightline/tools/scene/one_line.h"
#include "sightline/tools/scene/text_file.h"

namespace sightline::tools {
namespace {

namespace fs = std::filesystem;
using Bytes = std::span<const unsigned char>;

Bytes bytesOf(const std::string& text) { return {reinterpret_cast<const unsigned char*>(text.data()), text.size()}; }

enum class GameFile { kOther, kScript, kWal, kPicture, kArchive };

GameFile kindOf(const std::string& name) {
    const std::string low = nameOfTexture(name);
    const auto ends = [&](std::initializer_list<const char*> with) {
        return std::any_of(with.begin(), with.end(), [&](const char* end) { return low.ends_with(end); });
    };
    if (ends({".shader"})) return GameFile::kScript;
    if (ends({".wal"})) return GameFile::kWal;
    if (ends({".tga", ".jpg", ".jpeg", ".png", ".dds"})) return GameFile::kPicture;
    return ends({".pk3", ".pak"}) ? GameFile::kArchive : GameFile::kOther;
}

/// What a map calls a picture: no end, nothing before `textures/`.
std::string textureOf(const std::string& path) {
    std::string name = nameOfTexture(path);
    if (const size_t folder = name.rfind("/textures/"); folder != std::string::npos) name.erase(0, folder + 10);
    return name.substr(0, name.rfind('.'));
}

/// The same of a file: within the folder, where no folder above is `textures`.
std::string textureOf(const fs::path& file, const fs::path& folder) {
    std::error_code error;
    const std::string whole = "/" + fs::absolute(file, error).generic_string();
    const bool has_folder = nameOfTexture(whole).find("/textures/") != std::string::npos;
    return textureOf(has_folder ? whole : file.lexically_relative(folder).generic_string());
}

/// @param texture  the file's name as a texture
/// @param bytes    of a script or a .wal
Status addFile(GameFile kind, const std::string& texture, const std::string& name, Bytes bytes, MapMaterials& out) {
    if (kind == GameFile::kScript) return parseShaderScript(bytes, name, out);
    const Result<MapFlags> flags = parseWal(bytes, name);
    if (!flags) return flags.error();
    out.addWal(texture, *flags);
    return success();
}

Status addArchive(const std::string& file, MapMaterials& out) {
    const Result<std::string> text = readTextFile(file);
    if (!text) return text.error();
    const Result<std::vector<ArchiveEntry>> entries = listArchive(bytesOf(*text), file);
    if (!entries) return entries.error();
    for (const ArchiveEntry& entry : *entries) {
        const GameFile kind = kindOf(entry.name);
        if (kind == GameFile::kPicture) out.pictures.insert(textureOf(entry.name));
        if (kind != GameFile::kScript && kind != GameFile::kWal) continue;
        const Result<std::vector<unsigned char>> bytes = unpackEntry(bytesOf(*text), file, entry);
        const std::string name = fmt::format("{}:{}", file, oneLine(entry.name, 120));
        const Status added = bytes ? addFile(kind, textureOf(entry.name), name, *bytes, out) : bytes.error();
        if (!added) out.faults.push_back(added.error().message);
    }
    return success();
}

Status addFile(const std::string& file, const std::string& texture, MapMaterials& out) {
    const GameFile kind = kindOf(file);
    if (kind == GameFile::kArchive) return addArchive(file, out);
    const Result<std::string> text = readTextFile(file);
    return text ? addFile(kind, texture, file, bytesOf(*text), out) : text.error();
}

Status addFolder(const fs::path& folder, MapMaterials& out) {
    std::vector<fs::path> files;
    std::error_code error;
    fs::recursive_directory_iterator at(folder, fs::directory_options::skip_permission_denied, error), end;
    for (; !error && at != end; at.increment(error)) {
        std::error_code ignored;
        if (at->is_regular_file(ignored)) files.push_back(at->path());
    }
    if (error)
        return Error{Error::Kind::kInput, fmt::format("{}: cannot be listed: {}", folder.string(), error.message())};
    std::sort(files.begin(), files.end());
    for (const fs::path& file : files) {
        const GameFile kind = kindOf(file.generic_string());
        if (kind == GameFile::kOther) continue;
        const std::string texture = textureOf(file, folder);
        if (kind == GameFile::kPicture) out.pictures.insert(texture);
        else if (const Status added = addFile(file.string(), texture, out); !added)
            out.faults.push_back(added.error().message);
    }
    return success();
}

}  // namespace

Result<MapFlags> parseWal(Bytes bytes, const std::string& name) {
    constexpr size_t kHeader = 100, kSizes = 32, kFlags = 88, kLevels = 4;
    const auto refuse = [&](const char* what) { return Error{Error::Kind::kInput, fmt::format("{}: {}", name, what)}; };
    if (bytes.size() < kHeader) return refuse("is no .wal: it is shorter than a header of 100 bytes");
    ByteCursor cursor({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
    for (size_t i = 0; i < kSizes; ++i) cursor.take<uint8_t>();
    const uint64_t width = cursor.take<uint32_t>(), height = cursor.take<uint32_t>();
    for (size_t level = 0; level < kLevels; ++level) {
        const uint64_t from = cursor.take<uint32_t>(), size = (width >> level) * (height >> level);
        if (width == 0 || height == 0 || width > 65536 || height > 65536 || from < kHeader ||
            from + size > bytes.size())
            return refuse("is no .wal of Quake 2: its picture is not where its header says");
    }
    while (cursor.at() < kFlags) cursor.take<uint8_t>();
    MapFlags flags;
    flags.surface = cursor.take<uint32_t>();
    flags.contents = cursor.take<uint32_t>();
    return flags;
}

Status readMapMaterials(const std::string& path, MapMaterials& out) {
    const auto refuse = [&](const char* what) { return Error{Error::Kind::kInput, fmt::format("{}: {}", path, what)}; };
    std::error_code error;
    MapMaterials own;
    if (fs::is_directory(path, error)) {
        if (Status added = addFolder(path, own); !added) return added;
    } else if (const GameFile kind = kindOf(path);
               kind == GameFile::kScript || kind == GameFile::kWal || kind == GameFile::kArchive) {
        if (Status added = addFile(path, textureOf(path, fs::path(path).parent_path()), own); !added) return added;
    } else {
        return refuse(fs::exists(path, error) ? "is no folder, .shader, .wal, .pk3 or .pak" : "does not exist");
    }
    if (own.shaders.empty() && own.wals.empty() && own.pictures.empty() && own.faults.empty())
        return refuse("holds no shader script, .wal or picture");
    out.add(own);
    return success();
}

}  // namespace sightline::tools
