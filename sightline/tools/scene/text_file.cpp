// A whole file as text, or the one line that says why not.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/text_file.h"

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include <fmt/core.h>

namespace sightline::tools {
namespace {

struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
};

}  // namespace

Result<std::string> readTextFile(const std::string& file, size_t limit) {
    const auto error = [&](const std::string& what) {
        return Error{Error::Kind::kInput, fmt::format("{}: {}", file, what)};
    };
    // fopen succeeds on a directory, and the reason is then lost.
    std::error_code ignored;
    if (std::filesystem::is_directory(file, ignored)) return error("is a directory");
    const std::unique_ptr<std::FILE, CloseFile> stream(std::fopen(file.c_str(), "rb"));
    if (!stream && errno == ENOENT) return error("no such file");
    if (!stream) return error(fmt::format("cannot be opened: {}", std::strerror(errno)));
    std::string text;
    char block[1 << 16];
    for (;;) {
        const size_t got = std::fread(block, 1, sizeof block, stream.get());
        text.append(block, got);
        if (text.size() > limit) return error(fmt::format("is larger than {} bytes", limit));
        if (got < sizeof block) break;
    }
    if (std::ferror(stream.get())) return error(fmt::format("cannot be read: {}", std::strerror(errno)));
    return text;
}

}  // namespace sightline::tools
