// Assimp's view of the disk: regular files alone, read-only, the scene's file under the suffix of its format.
// SPDX-License-Identifier: MIT
#include "apps/import/file_access.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <system_error>
#include <utility>

#include <assimp/MemoryIOWrapper.h>

#include "apps/import/fault.h"

namespace sightline::import {

namespace fs = std::filesystem;

FileAccess::FileAccess(std::string file, const std::string& suffix) : file_(std::move(file)) {
    fs::path alias = file_;
    if (!alias.has_parent_path()) alias = fs::path(".") / alias;
    std::string own = alias.extension().string();
    std::transform(own.begin(), own.end(), own.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (own != "." + suffix) alias.replace_extension(suffix);
    alias_ = alias.string();
}

std::string FileAccess::text() const {
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file_.c_str(), "rb"), &std::fclose);
    if (!stream) throw Fault{"cannot be opened"};
    std::error_code ignored;
    std::string out(fs::file_size(file_, ignored), '\0');
    if (ignored) throw Fault{"cannot be read"};
    out.resize(std::fread(out.data(), 1, out.size(), stream.get()));
    return out;
}

std::string FileAccess::realName(const char* name) const { return name == alias_ ? file_ : name; }

bool FileAccess::Exists(const char* name) const {
    std::error_code ignored;
    return fs::is_regular_file(realName(name), ignored);
}

Assimp::IOStream* FileAccess::Open(const char* name, const char* mode) {
    if (std::strpbrk(mode, "wa+") || !Exists(name)) return nullptr;
    if (!text_.empty() && name == alias_)
        return new Assimp::MemoryIOStream(reinterpret_cast<const uint8_t*>(text_.data()), text_.size());
    return DefaultIOSystem::Open(realName(name).c_str(), mode);
}

}  // namespace sightline::import
