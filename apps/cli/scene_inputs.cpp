// Which files a scene's file leads to, found without reading the scene.
// SPDX-License-Identifier: MIT
#include "apps/cli/scene_inputs.h"

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <optional>
#include <system_error>

#include <nlohmann/json.hpp>

#include "sightline/import/gltf_container.h"
#include "sightline/import/map_source.h"

namespace sightline::cli {
namespace {

namespace fs = std::filesystem;

std::string suffixOf(const fs::path& file) {
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; });
    return suffix;
}

/// Gathers buffers[].uri and skips all else; a document of any size takes no more memory than its longest string.
class BufferUris : public nlohmann::json_sax<nlohmann::json> {
public:
    std::vector<std::string> uris;

    bool key(std::string& name) override {
        if (depth_ == 1) in_buffers_ = name == "buffers";
        is_uri_ = in_buffers_ && depth_ == 3 && name == "uri";
        return true;
    }
    bool string(std::string& text) override {
        if (is_uri_ && text.rfind("data:", 0) != 0) uris.push_back(text);
        is_uri_ = false;
        return true;
    }
    bool start_object(size_t) override { return ++depth_, true; }
    bool end_object() override { return --depth_, true; }
    bool start_array(size_t) override { return ++depth_, true; }
    bool end_array() override { return --depth_, true; }
    bool null() override { return other(); }
    bool boolean(bool) override { return other(); }
    bool number_integer(number_integer_t) override { return other(); }
    bool number_unsigned(number_unsigned_t) override { return other(); }
    bool number_float(number_float_t, const string_t&) override { return other(); }
    bool binary(binary_t&) override { return other(); }
    bool parse_error(size_t, const std::string&, const nlohmann::json::exception&) override { return false; }

private:
    bool other() {
        is_uri_ = false;
        return true;
    }
    int depth_ = 0;
    bool in_buffers_ = false, is_uri_ = false;
};

/// The names in a glTF's buffers, or nothing if it is none that could be understood.
std::optional<std::vector<std::string>> gltfBuffers(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    std::string text;
    if (suffixOf(file) == ".glb") {
        unsigned char head[20];
        if (!in.read(reinterpret_cast<char*>(head), sizeof head)) return std::nullopt;
        const uint32_t length = head[12] | head[13] << 8 | head[14] << 16 | static_cast<uint32_t>(head[15]) << 24;
        std::error_code error;
        if (const uint64_t size = fs::file_size(file, error); error || length > size) return std::nullopt;
        text.resize(length);
        if (!in.read(text.data(), length)) return std::nullopt;
    }
    BufferUris found;
    const bool good = text.empty() ? nlohmann::json::sax_parse(in, &found) : nlohmann::json::sax_parse(text, &found);
    if (!good) return std::nullopt;
    for (std::string& uri : found.uris) uri = gltf::percentDecoded(uri);
    return found.uris;
}

/// The names after `mtllib`, as the rest of its line and as words: both are about.
std::optional<std::vector<std::string>> objLibraries(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in) return std::nullopt;
    std::vector<std::string> names;
    constexpr size_t kMostLines = 1000000;  // libraries stand at the top; the vertices below may be many
    std::string line;
    for (size_t i = 0; i < kMostLines && std::getline(in, line); ++i) {
        if (line.rfind("mtllib", 0) != 0 || line.size() < 8) continue;
        while (!line.empty() && (line.back() == '\r' || line.back() == ' ' || line.back() == '\t')) line.pop_back();
        std::string rest = line.substr(std::min<size_t>(7, line.size()));
        rest.erase(0, std::min(rest.find_first_not_of(" \t"), rest.size()));
        if (rest.empty()) continue;
        names.push_back(rest);
        for (size_t at = 0; at < rest.size();) {
            const size_t end = std::min(rest.find_first_of(" \t", at), rest.size());
            if (end > at && end - at < rest.size()) names.push_back(rest.substr(at, end - at));
            at = end + 1;
        }
    }
    return names;
}

}  // namespace

std::vector<std::string> filesOfScene(const std::string& scene) {
    const std::string name = splitMapName(scene).file;  // of a map in an archive, the archive
    const fs::path file = name;
    const fs::path directory = file.parent_path();
    const std::string suffix = suffixOf(file);
    std::optional<std::vector<std::string>> others;
    std::error_code absent;
    if (fs::exists(file, absent) && !fs::is_regular_file(file, absent))
        others.emplace();  // a pipe would have us wait, a device never end
    else if (suffix == ".gltf" || suffix == ".glb") others = gltfBuffers(file);
    else if (suffix == ".obj") others = objLibraries(file);
    else if (suffix == ".bsp" || suffix == ".pak" || suffix == ".pk3") others.emplace();  // all is in it
    std::vector<std::string> files = {name};
    if (others) {
        for (const std::string& other : *others)
            if (other.find('\0') == std::string::npos) files.push_back((directory / other).string());
    } else {
        std::error_code error;
        const fs::path place = directory.empty() ? fs::path(".") : directory;
        for (fs::directory_iterator at(place, error), end; !error && at != end; at.increment(error))
            if (at->path().stem() == file.stem() && at->path().filename() != file.filename())
                files.push_back((directory / at->path().filename()).string());
    }
    std::sort(files.begin() + 1, files.end());
    files.erase(std::unique(files.begin(), files.end()), files.end());
    return files;
}

}  // namespace sightline::cli
