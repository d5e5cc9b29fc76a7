// Reads what of a material decides visibility: sidedness, alpha, transmission, and its base colour.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_materials.h"

#include <utility>

namespace sightline::tools::gltf {
namespace {

bool needsDefault(const JsonText& json) {
    const JsonTable meshes = json.table("meshes");
    for (size_t i = 0; i < meshes.size(); ++i) {
        const Json mesh = meshes[i];
        const Json* primitives = find(mesh, "primitives");
        if (!primitives || !primitives->is_array()) continue;
        for (const Json& primitive : *primitives)
            if (!find(primitive, "material")) return true;
    }
    return false;
}

AlphaMode readAlphaMode(const Json& json, const std::string& place) {
    const std::string mode = text(json, "alphaMode", place);
    if (mode.empty() || mode == "OPAQUE") return AlphaMode::kOpaque;
    if (mode == "MASK") return AlphaMode::kMask;
    if (mode == "BLEND") return AlphaMode::kBlend;
    fail(place, "alphaMode '{}' is not known", printable(mode));
}

void readColor(const Json* owner, const char* key, Material& material, const std::string& place) {
    double color[4];
    if (owner && numbers(*owner, key, color, place))
        material.base_color = {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]),
                               static_cast<float>(color[3])};
}

Material readMaterial(const Json& json, const std::string& place) {
    Material material;
    material.name = text(json, "name", place);
    material.alpha_mode = readAlphaMode(json, place);
    material.alpha_cutoff = static_cast<float>(number(json, "alphaCutoff", place).value_or(0.5));
    material.double_sided = flag(json, "doubleSided", place);
    // Whatever its factor, which a texture, an animation or the application may change: none of these hides.
    for (const char* name : {"KHR_materials_transmission", "KHR_materials_diffuse_transmission"})
        if (extension(json, name, place)) material.transmissive = true;
    if (const Json* glossiness = extension(json, "KHR_materials_pbrSpecularGlossiness", place))
        readColor(glossiness, "diffuseFactor", material, place);
    readColor(findObject(json, "pbrMetallicRoughness", place), "baseColorFactor", material, place);
    return material;
}

}  // namespace

Materials readMaterials(const JsonText& json) {
    Materials out;
    const JsonTable array = json.table("materials");
    out.count = array.size();
    if (array.empty() || needsDefault(json)) {
        out.list.push_back({});
        out.first = 1;
    }
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("materials", i);
        out.list.push_back(readMaterial(array.object(i, place), place));
    }
    return out;
}

}  // namespace sightline::tools::gltf
