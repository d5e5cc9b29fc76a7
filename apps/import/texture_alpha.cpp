// Whether a texture lets light through: what may hide must be certain.
// SPDX-License-Identifier: MIT
#include "apps/import/texture_alpha.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_NO_HDR
#define STBI_NO_LINEAR
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace sightline::import {
namespace {

namespace fs = std::filesystem;

constexpr uintmax_t kLargest = uintmax_t(1) << 30;  // [bytes]

std::vector<unsigned char> readAll(const fs::path& file) {
    std::error_code error;
    if (!fs::is_regular_file(file, error)) return {};
    const uintmax_t size = fs::file_size(file, error);
    if (error || size > kLargest) return {};
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), &std::fclose);
    if (!stream) return {};
    std::vector<unsigned char> bytes(size);
    bytes.resize(std::fread(bytes.data(), 1, bytes.size(), stream.get()));
    return bytes;
}

enum class Answer { kOpaque, kTransparent, kUnknown };

Answer lookAt(const unsigned char* bytes, size_t size) {
    int width = 0, height = 0, channels = 0;
    if (size == 0 || size > kLargest || !stbi_info_from_memory(bytes, int(size), &width, &height, &channels))
        return Answer::kUnknown;
    if (channels == 1 || channels == 3) return Answer::kOpaque;
    const std::unique_ptr<unsigned char, void (*)(void*)> pixels(
        stbi_load_from_memory(bytes, int(size), &width, &height, &channels, 4), &stbi_image_free);
    if (!pixels) return Answer::kUnknown;
    const size_t count = size_t(width) * size_t(height);
    for (size_t i = 0; i < count; ++i)
        if (pixels.get()[4 * i + 3] != 255) return Answer::kTransparent;
    return Answer::kOpaque;
}

/// aiTexture of height 0 is a file in memory, others are texels.
Answer lookAt(const aiTexture& texture) {
    if (texture.mHeight == 0) return lookAt(reinterpret_cast<const unsigned char*>(texture.pcData), texture.mWidth);
    const size_t count = size_t(texture.mWidth) * texture.mHeight;
    const bool opaque =
        std::all_of(texture.pcData, texture.pcData + count, [](const aiTexel& t) { return t.a == 255; });
    return opaque ? Answer::kOpaque : Answer::kTransparent;
}

bool hasNoAlphaByName(const std::string& name) {
    std::string suffix = fs::path(name).extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return suffix == ".jpg" || suffix == ".jpeg" || suffix == ".bmp";
}

}  // namespace

TextureAlpha::TextureAlpha(const aiScene& scene, std::string folder) : scene_(scene), folder_(std::move(folder)) {}

bool TextureAlpha::mayBeTransparent(const std::string& name) {
    const auto [place, fresh] = known_.try_emplace(name, true);
    if (fresh) place->second = look(name);
    return place->second;
}

bool TextureAlpha::look(const std::string& name) const {
    Answer answer = Answer::kUnknown;
    if (const aiTexture* inside = scene_.GetEmbeddedTexture(name.c_str())) {
        answer = lookAt(*inside);
    } else {
        std::string path = name;
        std::replace(path.begin(), path.end(), '\\', '/');
        // As named, and beside the scene, for names that only meant something where the file was made.
        for (const fs::path& place : {fs::path(folder_) / path, fs::path(folder_) / fs::path(path).filename()}) {
            const std::vector<unsigned char> bytes = readAll(place);
            answer = lookAt(bytes.data(), bytes.size());
            if (answer != Answer::kUnknown) break;
        }
    }
    return answer == Answer::kUnknown ? !hasNoAlphaByName(name) : answer == Answer::kTransparent;
}

}  // namespace sightline::import
