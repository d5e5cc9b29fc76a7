// Assimp's materials as Sightline's: what may hide, and from which sides.
// SPDX-License-Identifier: MIT
#include "apps/import/materials.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <utility>
#include <vector>

#include <assimp/material.h>
#include <fmt/core.h>
#include <stb/stb_image.h>

namespace sightline::import {
using namespace tools;
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

/// A number of a material, or what counts if there is none.
float number(const aiMaterial& material, const char* key, unsigned type, unsigned index, float otherwise) {
    ai_real value = otherwise;
    return material.Get(key, type, index, value) == aiReturn_SUCCESS ? value : otherwise;
}

bool flag(const aiMaterial& material, const char* key, unsigned type, unsigned index, bool otherwise) {
    int value = 0;
    return material.Get(key, type, index, value) == aiReturn_SUCCESS ? value != 0 : otherwise;
}

glm::vec4 baseColour(const aiMaterial& material) {
    aiColor4D colour;
    const bool found = material.Get(AI_MATKEY_BASE_COLOR, colour) == aiReturn_SUCCESS ||
                       material.Get(AI_MATKEY_COLOR_DIFFUSE, colour) == aiReturn_SUCCESS;
    glm::vec4 out(1.0f);
    if (!found) return out;
    for (int c = 0; c < 3; ++c) out[c] = std::isfinite(colour[c]) ? std::clamp(float(colour[c]), 0.0f, 1.0f) : 1.0f;
    return out;
}

/// A vertex colour that is not wholly opaque. DXF has none such; the reader of AMF makes up nothing at all as a colour.
bool fades(const aiMesh& mesh, const std::string& suffix) {
    if (!mesh.HasVertexColors(0) || suffix == "dxf") return false;
    const aiColor4D* colours = mesh.mColors[0];
    const bool made_up = suffix == "amf";
    return std::any_of(colours, colours + mesh.mNumVertices,
                       [&](const aiColor4D& c) { return !(c.a >= 1) && !(made_up && c == aiColor4D(0, 0, 0, 0)); });
}

}  // namespace

TextureAlpha::TextureAlpha(const aiScene& scene, std::string folder) : scene_(scene), folder_(std::move(folder)) {}

bool TextureAlpha::mayBeTransparent(const std::string& name) {
    const auto [place, fresh] = known_.try_emplace(name, true);
    if (fresh) place->second = look(name);
    return place->second;
}

bool TextureAlpha::look(const std::string& name) {
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
    if (answer != Answer::kUnknown) return answer == Answer::kTransparent;
    if (hasNoAlphaByName(name)) return false;
    unread_.push_back(name);
    return true;
}

Materials::Materials(const aiScene& scene, std::string suffix, std::string folder, SceneStreamWriter& out)
    : scene_(scene), suffix_(std::move(suffix)), textures_(scene, std::move(folder)), out_(out) {
    if (const SceneFormat* format = sceneFormat(suffix_)) sides_ = format->sides;
}

Material Materials::convert(const aiMaterial& material) {
    Material out;
    aiString text;
    if (material.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS) out.name = text.C_Str();
    const bool made_up = out.name == AI_DEFAULT_MATERIAL_NAME;
    if (!made_up) out.base_color = baseColour(material);
    out.double_sided = flag(material, AI_MATKEY_TWOSIDED, sides_ == SidesRule::kNothing);

    // Whatever may let light through hides nothing.
    const float opacity = number(material, AI_MATKEY_OPACITY, 1);
    out.base_color.a = std::isfinite(opacity) ? std::clamp(opacity, 0.0f, 1.0f) : 1.0f;
    int blending = aiBlendMode_Default;
    const bool additive =
        material.Get(AI_MATKEY_BLEND_FUNC, blending) == aiReturn_SUCCESS && blending == aiBlendMode_Additive;
    if (!(opacity >= 1) || additive || material.GetTextureCount(aiTextureType_OPACITY) > 0) {
        out.alpha_mode = AlphaMode::kBlend;
    } else if (flag(material, AI_MATKEY_ENABLE_WIREFRAME, false)) {
        out.alpha_mode = AlphaMode::kMask;
    } else {
        for (const aiTextureType type : {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR})
            if (material.GetTexture(type, 0, &text) == aiReturn_SUCCESS && text.length > 0 &&
                textures_.mayBeTransparent(text.C_Str()))
                out.alpha_mode = AlphaMode::kMask;
    }
    out.transmissive = number(material, AI_MATKEY_TRANSMISSION_FACTOR, 0) > 0;
    return out;
}

uint32_t Materials::of(const aiMesh& mesh) {
    const bool known = mesh.mMaterialIndex < scene_.mNumMaterials;
    const bool blends = fades(mesh, suffix_);
    const auto [place, fresh] = sent_.try_emplace({known ? mesh.mMaterialIndex : ~0u, blends}, uint32_t(sent_.size()));
    if (!fresh) return place->second;
    Material material;
    material.double_sided = sides_ == SidesRule::kNothing;
    if (known) material = convert(*scene_.mMaterials[mesh.mMaterialIndex]);
    if (blends) material.alpha_mode = AlphaMode::kBlend;
    out_.material(material);
    return place->second;
}

void Materials::tellUnread() const {
    constexpr size_t kMost = 3;
    const std::vector<std::string>& names = textures_.unread();
    if (names.empty()) return;
    std::string list;
    for (size_t i = 0; i < std::min(kMost, names.size()); ++i) list += (i > 0 ? ", " : "") + names[i];
    if (names.size() > kMost) list += ", ...";
    out_.note(fmt::format("{} texture{} could not be read, so that what shows {} hides nothing: {}", names.size(),
                          names.size() == 1 ? "" : "s", names.size() == 1 ? "it" : "them", list));
}

}  // namespace sightline::import
