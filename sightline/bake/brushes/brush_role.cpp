// Reads what a brush is from the names and flags of its sides.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/brush_role.h"

#include <algorithm>
#include <string>
#include <string_view>

namespace sightline::bake {
using namespace tools;
namespace {

// Quake 2 and 3.
constexpr uint32_t kWindow = 2, kAnyLiquid = 8 | 16 | 32, kMist = 64, kAreaPortal = 0x8000, kClips = 0x30000;
constexpr uint32_t kDetail = 0x8000000, kTranslucent = 0x20000000;
constexpr uint32_t kSurfaceSky = 4, kSurfaceClear33 = 16, kSurfaceClear66 = 32, kSurfaceHint = 256, kSurfaceSkip = 512;

std::string lowered(std::string_view name) {
    std::string lower(name);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

bool isDetailClass(std::string_view name) { return name.substr(0, 11) == "func_detail"; }

/// Textures of tools, which compilers know by name: of Quake's, Half-Life's (VHLT's, too) and their kin.
BrushRole roleOfTool(std::string_view name) {
    for (const char* nothing :
         {"aaatrigger",     "areaportal", "bevelhint",   "boundingbox", "clip",         "clipbevel",
          "clipbevelbrush", "cliphull1",  "cliphull2",   "cliphull3",   "contentempty", "fullclip",
          "hint",           "hintskip",   "monsterclip", "noclip",      "origin",       "playerclip",
          "solidhint",      "splitface",  "trigger",     "weaponclip"})
        if (name == nothing) return BrushRole::kNothing;
    for (const char* liquid : {"contentlava", "contentslime", "contentwater"})
        if (name == liquid) return BrushRole::kLiquid;
    return name == "contentsky" ? BrushRole::kSky : BrushRole::kSolid;
}

BrushRole roleOfName(std::string_view full) {
    std::string name = lowered(full);
    if (name.starts_with("textures/")) name.erase(0, 9);
    const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
    const size_t folder = name.rfind('/');
    if (folder != std::string::npos) {
        // Quake 3's, and Jedi Knight's: of what is not drawn caulk alone is meant to hide.
        if (name.starts_with("common/") || name.starts_with("system/"))
            return name.ends_with("/caulk") ? BrushRole::kSolid : BrushRole::kNothing;
        for (const char* liquid : {"liquid", "water", "slime", "lava"})
            if (has(liquid)) return BrushRole::kLiquid;
        for (const char* clear : {"fog", "glass", "window"})
            if (has(clear)) return BrushRole::kNothing;
        name.erase(0, folder + 1);
    }
    if (const BrushRole tool = roleOfTool(name); tool != BrushRole::kSolid) return tool;
    if (name.starts_with('*') || name.starts_with('!')) return BrushRole::kLiquid;
    // One sees through the holes of the first, and through all of the second.
    if (name.starts_with('{') || name.starts_with('@')) return BrushRole::kNothing;
    return name.starts_with("sky") ? BrushRole::kSky : BrushRole::kSolid;
}

BrushRole roleOfSide(const QuakeMap& map, const QuakeMapSide& side) {
    if ((side.contents & (kDetail | kTranslucent | kWindow | kMist | kAreaPortal | kClips)) != 0 ||
        (side.surface & (kSurfaceClear33 | kSurfaceClear66 | kSurfaceHint | kSurfaceSkip)) != 0)
        return BrushRole::kNothing;
    const BrushRole by_name = roleOfName(map.textures[side.texture]);
    if (by_name != BrushRole::kSolid) return by_name;
    if ((side.contents & kAnyLiquid) != 0) return BrushRole::kLiquid;
    return (side.surface & kSurfaceSky) != 0 ? BrushRole::kSky : BrushRole::kSolid;
}

bool isTrue(std::string_view value) { return !value.empty() && value != "0"; }

/// The layer or group of TrenchBroom with a number; null: there is none.
const QuakeMapEntity* groupOf(const QuakeMap& map, std::string_view type, std::string_view number) {
    if (number.empty()) return nullptr;
    for (const QuakeMapEntity& entity : map.entities)
        if (map.valueOf(entity, "_tb_type") == type && map.valueOf(entity, "_tb_id") == number) return &entity;
    return nullptr;
}

/// Whether the editor or the compiler leaves an entity's brushes out: TrenchBroom's layers, and what is in them or in groups of
/// them; ericw-tools' _omitbrushes.
bool isOmitted(const QuakeMap& map, const QuakeMapEntity& entity, int depth = 0) {
    constexpr int kDeepest = 32;  // groups in groups
    if (isTrue(map.valueOf(entity, "_tb_layer_omit_from_export")) || isTrue(map.valueOf(entity, "_omitbrushes")))
        return true;
    if (depth == kDeepest) return false;
    const QuakeMapEntity* const layer = groupOf(map, "_tb_layer", map.valueOf(entity, "_tb_layer"));
    const QuakeMapEntity* const group = groupOf(map, "_tb_group", map.valueOf(entity, "_tb_group"));
    return (layer && isOmitted(map, *layer, depth + 1)) || (group && isOmitted(map, *group, depth + 1));
}

}  // namespace

bool isWorldEntity(const QuakeMap& map, const QuakeMapEntity& entity) {
    if (isOmitted(map, entity)) return false;
    const std::string_view name = map.valueOf(entity, "classname");
    return name == "worldspawn" || name == "func_group" || isDetailClass(name);
}

BrushRole roleOf(const QuakeMap& map, const QuakeMapEntity& entity, const QuakeMapBrush& brush) {
    if (!isWorldEntity(map, entity)) return BrushRole::kNothing;
    BrushRole role = BrushRole::kSolid;
    for (const QuakeMapSide& side : map.sidesOf(brush)) role = std::max(role, roleOfSide(map, side));
    // The sky is the sky, and seals, even where it is listed with details.
    const bool detail = isDetailClass(map.valueOf(entity, "classname"));
    return detail && role != BrushRole::kSky ? BrushRole::kNothing : role;
}

}  // namespace sightline::bake
