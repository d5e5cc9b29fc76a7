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
constexpr uint32_t kSurfaceSky = 4, kSurfaceClear33 = 16, kSurfaceClear66 = 32;

std::string lowered(std::string_view name) {
    std::string lower(name);
    for (char& c : lower)
        if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
    return lower;
}

bool isDetailClass(std::string_view name) { return name.substr(0, 11) == "func_detail"; }

BrushRole roleOfName(std::string_view full) {
    std::string name = lowered(full);
    if (name.starts_with("textures/")) name.erase(0, 9);
    if (const size_t folder = name.rfind('/'); folder != std::string::npos) {
        const bool common = name.starts_with("common/");
        name.erase(0, folder + 1);
        if (common) return name == "caulk" ? BrushRole::kSolid : BrushRole::kNothing;
    }
    for (const char* nothing : {"clip", "hint", "hintskip", "origin", "trigger", "areaportal"})
        if (name == nothing) return BrushRole::kNothing;
    if (name.starts_with('*') || name.starts_with('!')) return BrushRole::kLiquid;
    if (name.starts_with('{')) return BrushRole::kNothing;  // one sees through its holes
    return name.starts_with("sky") ? BrushRole::kSky : BrushRole::kSolid;
}

BrushRole roleOfSide(const QuakeMap& map, const QuakeMapSide& side) {
    if ((side.contents & (kDetail | kTranslucent | kWindow | kMist | kAreaPortal | kClips)) != 0 ||
        (side.surface & (kSurfaceClear33 | kSurfaceClear66)) != 0)
        return BrushRole::kNothing;
    const BrushRole by_name = roleOfName(map.textures[side.texture]);
    if (by_name != BrushRole::kSolid) return by_name;
    if ((side.contents & kAnyLiquid) != 0) return BrushRole::kLiquid;
    return (side.surface & kSurfaceSky) != 0 ? BrushRole::kSky : BrushRole::kSolid;
}

}  // namespace

bool isWorldEntity(const QuakeMap& map, const QuakeMapEntity& entity) {
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
