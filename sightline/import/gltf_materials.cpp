// Reads what of a material decides visibility: sidedness, alpha, transmission, and its base colour.
// SPDX-License-Identifier: MIT
#include "sightline/import/gltf_materials.h"

#include <utility>

namespace sightline::gltf {
namespace {

bool needsDefault(const Json& root) {
    const Json& meshes = table(root, "meshes");
    for (const Json& mesh : meshes) {
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

// Many writers add the extension with a factor of 0, which is an ordinary opaque surface.
bool transmits(const Json& json, const std::string& place) {
    const Json* transmission = extension(json, "KHR_materials_transmission", place);
    if (!transmission) return false;
    return number(*transmission, "transmissionFactor", place).value_or(0) > 0 ||
           find(*transmission, "transmissionTexture");
}

// An animation may reach any factor of any material.
bool animatesFactors(const Json& root) {
    for (const Json& name : table(root, "extensionsUsed"))
        if (name == "KHR_animation_pointer") return true;
    return false;
}

Material readMaterial(const Json& json, bool animated_factors, const std::string& place) {
    Material material;
    material.name = text(json, "name", place);
    material.alpha_mode = readAlphaMode(json, place);
    material.alpha_cutoff = static_cast<float>(number(json, "alphaCutoff", place).value_or(0.5));
    material.double_sided = flag(json, "doubleSided", place);
    material.transmissive =
        animated_factors ? extension(json, "KHR_materials_transmission", place) != nullptr : transmits(json, place);
    // Thin and rare: none of these hides, whatever its factor.
    if (extension(json, "KHR_materials_diffuse_transmission", place)) material.transmissive = true;
    if (const Json* glossiness = extension(json, "KHR_materials_pbrSpecularGlossiness", place))
        readColor(glossiness, "diffuseFactor", material, place);
    readColor(findObject(json, "pbrMetallicRoughness", place), "baseColorFactor", material, place);
    return material;
}

}  // namespace

Materials readMaterials(const Json& root) {
    Materials out;
    const Json& array = table(root, "materials");
    out.count = array.size();
    if (array.empty() || needsDefault(root)) {
        out.list.push_back({});
        out.first = 1;
    }
    const bool animated_factors = animatesFactors(root);
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("materials", i);
        out.list.push_back(readMaterial(objectAt(array, i, place), animated_factors, place));
    }
    return out;
}

}  // namespace sightline::gltf
