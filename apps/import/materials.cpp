// Assimp's materials as Sightline's: what may hide, and from which sides.
// SPDX-License-Identifier: MIT
#include "apps/import/materials.h"

#include <algorithm>
#include <cmath>

#include <assimp/material.h>

namespace sightline::import {
using namespace tools;
namespace {

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

Materials::Materials(const aiScene& scene, std::string suffix, std::string folder, SceneStreamWriter& out)
    : scene_(scene), suffix_(std::move(suffix)), textures_(scene, std::move(folder)), out_(out) {
    if (const SceneFormat* format = sceneFormat(suffix_)) sides_ = format->sides;
}

Material Materials::convert(const aiMaterial& material) {
    Material out;
    aiString text;
    if (material.Get(AI_MATKEY_NAME, text) == aiReturn_SUCCESS) out.name = text.C_Str();
    const bool made_up = out.name == AI_DEFAULT_MATERIAL_NAME || out.name == "<IFCDefault>";
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

}  // namespace sightline::import
