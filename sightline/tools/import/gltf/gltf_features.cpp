// What glTF extensions do to what a file draws: whether it may hide, and whether it stays where it stands.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF Extension Registry. 2026.
#include "sightline/tools/import/gltf/gltf_features.h"

#include <algorithm>
#include <array>

namespace sightline::tools::gltf {
namespace {

struct Row {
    std::string_view name;  // one that ends in `_` stands for all that begin so
    Feature feature;
};

constexpr Feature kRead{Effect::kNone, true};     // the reader takes it as it is meant
constexpr Feature kLooks{Effect::kNone, true};    // colours and lights
constexpr Feature kBeside{Effect::kNone, false};  // data, sound, what a pointer may choose: nothing is drawn by it
constexpr Feature kClear{Effect::kClears, true};
constexpr Feature kShades{Effect::kUnknown, true};
constexpr Feature kMoving{Effect::kMoves, false};

constexpr std::array kRows = {
    Row{"KHR_mesh_quantization", kRead},
    Row{"EXT_meshopt_compression", kRead},
    Row{"KHR_meshopt_compression", kRead},
    Row{"KHR_draco_mesh_compression", kRead},
    Row{"EXT_mesh_gpu_instancing", kRead},
    Row{"KHR_node_visibility", kRead},
    Row{"KHR_animation_pointer", kRead},
    Row{"KHR_materials_variants", kRead},
    Row{"MSFT_lod", kRead},
    Row{"EXT_mesh_features", kRead},
    Row{"EXT_instance_features", kRead},
    Row{"EXT_structural_metadata", kRead},

    Row{"KHR_texture_", kLooks},
    Row{"EXT_texture_", kLooks},
    Row{"MSFT_texture_dds", kLooks},
    Row{"KHR_lights_", kLooks},
    Row{"EXT_lights_", kLooks},
    Row{"KHR_xmp", kLooks},
    Row{"KHR_xmp_json_ld", kLooks},
    Row{"KHR_materials_anisotropy", kLooks},
    Row{"KHR_materials_clearcoat", kLooks},
    Row{"KHR_materials_dispersion", kLooks},
    Row{"KHR_materials_emissive_strength", kLooks},
    Row{"KHR_materials_ior", kLooks},
    Row{"KHR_materials_iridescence", kLooks},
    Row{"KHR_materials_pbrSpecularGlossiness", kLooks},
    Row{"KHR_materials_sheen", kLooks},
    Row{"KHR_materials_specular", kLooks},
    Row{"KHR_materials_unlit", kLooks},
    Row{"KHR_materials_volume", kLooks},  // without transmission it does nothing
    Row{"EXT_materials_bump", kLooks},
    Row{"EXT_materials_specular_edge_color", kLooks},
    Row{"ADOBE_materials_clearcoat_specular", kLooks},
    Row{"ADOBE_materials_clearcoat_tint", kLooks},

    Row{"KHR_materials_transmission", kClear},
    Row{"KHR_materials_diffuse_transmission", kClear},
    Row{"KHR_materials_volume_scatter", kClear},
    Row{"KHR_materials_subsurface", kClear},
    Row{"KHR_materials_sss", kClear},
    Row{"ADOBE_materials_thin_transparency", kClear},

    // Others of materials name textures alone, which stay as they are; what they do to light is not known.
    Row{"KHR_materials_", kShades},
    Row{"EXT_materials_", kShades},
    Row{"ADOBE_materials_", kShades},

    Row{"KHR_audio_emitter", kBeside},
    Row{"MSFT_audio_emitter", kBeside},
    Row{"KHR_implicit_shapes", kBeside},
    Row{"KHR_interactivity", kBeside},  // of the file as a whole: the nodes that its graphs point at are read
    Row{"KHR_node_selectability", kBeside},
    Row{"KHR_node_hoverability", kBeside},
    Row{"EXT_mesh_manifold", kBeside},
    Row{"EXT_mesh_primitive_edge_visibility", kBeside},  // draws lines in addition
    Row{"CESIUM_primitive_outline", kBeside},            // the same
    Row{"EXT_feature_metadata", kBeside},
    Row{"AGI_stk_metadata", kBeside},
    Row{"FB_geometry_metadata", kBeside},
    Row{"GODOT_single_root", kBeside},
    Row{"MOZ_lightmap", kBeside},
    Row{"MSFT_packing_normalRoughnessMetallic", kBeside},
    Row{"MSFT_packing_occlusionRoughnessMetallic", kBeside},

    Row{"KHR_physics_rigid_bodies", kMoving},
    Row{"OMI_physics_body", kMoving},
    Row{"AGI_articulations", kMoving},
    Row{"VRMC_node_constraint", kMoving},
};

}  // namespace

Feature featureOf(std::string_view extension) {
    const auto means = [&](const Row& row) {
        return row.name.ends_with('_') ? extension.starts_with(row.name) : extension == row.name;
    };
    const auto row = std::find_if(kRows.begin(), kRows.end(), means);
    return row == kRows.end() ? Feature() : row->feature;
}

Effect effectOfExtensions(const Json& object, std::map<std::string, size_t>& unknown) {
    const auto extensions = object.find("extensions");
    Effect strongest = Effect::kNone;
    if (extensions == object.end() || !extensions->is_object()) return strongest;
    for (const auto& [name, value] : extensions->items()) {
        const Effect effect = featureOf(name).effect;
        if (effect == Effect::kUnknown) ++unknown[name];
        strongest = std::max(strongest, effect);
    }
    return strongest;
}

}  // namespace sightline::tools::gltf
