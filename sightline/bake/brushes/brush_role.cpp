// Reads what a brush is from the names and flags of its sides.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/brush_role.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>

#include "sightline/bake/brushes/map_game.h"

namespace sightline::bake {
using namespace tools;
namespace {

// Flags of a side. What opens it, in any game that has flags; then what Quake 2 knows of a solid one besides.
constexpr uint32_t kWindow = 2, kAux = 4, kAnyLiquid = 8 | 16 | 32, kMist = 64, kAreaPortal = 0x8000, kClips = 0x30000;
constexpr uint32_t kOrigin = 0x1000000, kDetail = 0x8000000, kTranslucent = 0x10000000, kTranslucent3 = 0x20000000;
constexpr uint32_t kSolidContents = 1, kCurrents = 0xfc0000, kMonsters = 0x6000000;
constexpr uint32_t kSurfaceLight = 1, kSurfaceSky = 4, kSurfaceWarp = 8, kSurfaceFlowing = 64, kSurfaceNoDraw = 128;
constexpr uint32_t kSurfaceClear33 = 16, kSurfaceClear66 = 32, kSurfaceHint = 256, kSurfaceSkip = 512;
constexpr uint32_t kSurfaceAlphaTest = 0x2000000;

BrushRole roleOfFlags(const MapFlags& flags) {
    if ((flags.contents &
         (kDetail | kTranslucent | kTranslucent3 | kWindow | kAux | kMist | kAreaPortal | kClips | kOrigin)) != 0 ||
        (flags.surface & (kSurfaceClear33 | kSurfaceClear66 | kSurfaceHint | kSurfaceSkip | kSurfaceAlphaTest)) != 0)
        return BrushRole::kNothing;
    if ((flags.contents & kAnyLiquid) != 0) return BrushRole::kLiquid;
    return (flags.surface & kSurfaceSky) != 0 ? BrushRole::kSky : BrushRole::kSolid;
}

/// The rule of Quake 2: a face without contents is solid. Bits that it has not are its kin's, and may mean anything; so may
/// slick, for in its kin the bit means holes.
BrushRole roleInQuake2(const MapFlags& flags) {
    const BrushRole role = roleOfFlags(flags);
    const bool known =
        (flags.contents & ~(kSolidContents | kCurrents | kMonsters)) == 0 &&
        (flags.surface & ~(kSurfaceLight | kSurfaceSky | kSurfaceWarp | kSurfaceFlowing | kSurfaceNoDraw)) == 0;
    return role > BrushRole::kSky || known ? role : BrushRole::kUnknown;
}

/// What names mean to whose compilers.
struct NameRule {
    uint8_t games;
    BrushRole role;
    std::string_view
        patterns;  ///< matches(): those with a slash of the whole name, others of what is behind its last slash
};

/// The first rule that holds decides. "/" before a pattern: of names with a folder alone.
constexpr NameRule kRules[] = {
    // Quake 3's tools, and Jedi Knight's: of what is not drawn caulk alone is meant to hide.
    {kAllGames, BrushRole::kSolid, "common/caulk system/caulk"},
    {kAllGames, BrushRole::kNothing, "common/* system/*"},
    {kAllGames, BrushRole::kLiquid, "/*liquid* /*water* /*slime* /*lava*"},
    {kAllGames, BrushRole::kNothing, "/*fog* /*glass* /*window*"},
    // Tools of qbsp (Quake, Quake 2, ericw-tools), and of ZHLT with its kin, which look at the beginning of a name.
    {kAllGames, BrushRole::kNothing,
     "aaatrigger areaportal bevelhint boundingbox clip clipbevel clipbevelbrush cliphull1 cliphull2 cliphull3 "
     "contentempty "
     "fullclip hint hintskip monsterclip noclip nullnoclip origin playerclip solidhint splitface translucent trigger "
     "weaponclip"},
    {kHalfLife, BrushRole::kNothing,
     "aaatrigger* bevelhint* boundingbox* clip* contentempty* hint* noclip* nullnoclip* origin* skip* solidhint* "
     "splitface* "
     "translucent*"},
    {kDeepGames, BrushRole::kNothing, "skip nodraw"},
    {kAllGames, BrushRole::kLiquid, "contentlava contentslime contentwater"},
    {kHalfLife, BrushRole::kLiquid, "contentwater* ?!lava* ?!slime*"},
    {kAllGames, BrushRole::kLiquid, "\\** !*"},
    // One sees through the holes of the first, and through all of the second.
    {kAllGames, BrushRole::kNothing, "{* @*"},
    {kFlatGames, BrushRole::kSky, "sky* contentsky*"},
    {kHalfLife, BrushRole::kSky, "env_sky*"},
    // The rest is solid in the games whose compilers know nothing but names.
    {kFlatGames, BrushRole::kSolid, "*"},
};

BrushRole roleOfName(MapGames game, std::string_view name) {
    const size_t slash = name.rfind('/');
    const bool has_folder = slash != std::string_view::npos;
    const std::string_view last = has_folder ? name.substr(slash + 1) : name;
    for (const NameRule& rule : kRules) {
        if ((rule.games & game) == 0) continue;
        for (size_t at = 0; at < rule.patterns.size();) {
            const size_t end = std::min(rule.patterns.find(' ', at), rule.patterns.size());
            std::string_view pattern = rule.patterns.substr(at, end - at);
            at = end + 1;
            const bool of_folder = pattern.starts_with('/');
            if (of_folder) pattern.remove_prefix(1);
            if (of_folder && !has_folder) continue;
            if (matches(of_folder || pattern.find('/') != std::string_view::npos ? name : last, pattern))
                return rule.role;
        }
    }
    return BrushRole::kUnknown;
}

/// What a texture is by one game's rule, where its sides have no flags.
BrushRole roleOfTexture(MapGames game, const std::string& name, const MapMaterials* materials) {
    if (materials && game == kQuake3)
        if (const auto at = materials->shaders.find(name); at != materials->shaders.end()) return at->second;
    if (materials && game == kQuake2)
        if (const auto at = materials->wals.find(name); at != materials->wals.end()) return roleInQuake2(at->second);
    const BrushRole role = roleOfName(game, name);
    const bool drawn_plain =
        materials && game == kQuake3 && materials->faults.empty() && materials->pictures.contains(name);
    return role == BrushRole::kUnknown && drawn_plain ? BrushRole::kSolid : role;
}

/// Of several games: if one says that it hides and another that it does not, it is not known.
BrushRole both(BrushRole a, BrushRole b) {
    const BrushRole less = std::min(a, b), more = std::max(a, b);
    return more == BrushRole::kNothing && less <= BrushRole::kSky ? BrushRole::kUnknown : more;
}

/// Textures by all that is known of them.
class TextureRoles {
public:
    TextureRoles(const QuakeMap& map, const BrushRules& rules, MapGames games) : games_(games) {
        for (const std::string& full : map.textures) {
            const std::string name = nameOfTexture(full);
            const bool solid = std::any_of(rules.solid.begin(), rules.solid.end(), [&](const std::string& pattern) {
                return matches(name, patternOfTextures(pattern));
            });
            Texture texture{.solid = solid};
            for (size_t i = 0; i < std::size(kGames); ++i)
                texture.roles[i] =
                    (games & kGames[i]) == 0 ? BrushRole::kUnknown : roleOfTexture(kGames[i], name, rules.materials);
            textures_.push_back(texture);
        }
    }

    BrushRole roleOf(const QuakeMapSide& side) const {
        const Texture& texture = textures_[side.texture];
        const MapFlags flags{side.contents, side.surface};
        const BrushRole by_flags = roleOfFlags(flags);
        std::optional<BrushRole> role;
        for (size_t i = 0; i < std::size(kGames); ++i) {
            if ((games_ & kGames[i]) == 0) continue;
            const BrushRole one = kGames[i] == kQuake2 && side.has_flags ? roleInQuake2(flags) : texture.roles[i];
            role = role ? both(*role, one) : one;
        }
        BrushRole out = std::max(by_flags, *role);
        if (out == BrushRole::kUnknown && texture.solid) out = by_flags;
        return out;
    }

private:
    static constexpr MapGames kGames[] = {kQuake, kHalfLife, kQuake2, kQuake3};
    struct Texture {
        bool solid = false;
        BrushRole roles[std::size(kGames)] = {};
    };

    MapGames games_;
    std::vector<Texture> textures_;
};

bool isDetailClass(std::string_view name) { return name.substr(0, 11) == "func_detail"; }

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

/// By its class, or by the key with which ZHLT's kin make a detail of anything.
bool isDetail(const QuakeMap& map, const QuakeMapEntity& entity) {
    return isDetailClass(map.valueOf(entity, "classname")) || isTrue(map.valueOf(entity, "zhlt_detaillevel"));
}

}  // namespace

bool isWorldEntity(const QuakeMap& map, const QuakeMapEntity& entity) {
    if (isOmitted(map, entity)) return false;
    const std::string_view name = map.valueOf(entity, "classname");
    return name == "worldspawn" || name == "func_group" || isDetailClass(name);
}

BrushRoles brushRoles(const QuakeMap& map, const BrushRules& rules) {
    BrushRoles out;
    out.games = rules.games != kNoGame ? rules.games : gamesOf(map, rules.materials);
    out.roles.assign(map.brushes.size(), BrushRole::kNothing);
    const TextureRoles textures(map, rules, out.games);
    std::map<uint32_t, uint64_t> unknown;  // by texture
    for (const QuakeMapEntity& entity : map.entities) {
        if (!isWorldEntity(map, entity)) continue;
        const bool detail = isDetail(map, entity);
        for (uint32_t i = entity.first_brush; i < entity.first_brush + entity.brush_count; ++i) {
            BrushRole role = BrushRole::kSolid;
            for (const QuakeMapSide& side : map.sidesOf(map.brushes[i])) role = std::max(role, textures.roleOf(side));
            // The sky is the sky, and seals, even where it is listed with details.
            if (detail && role != BrushRole::kSky) role = BrushRole::kNothing;
            out.roles[i] = role;
            if (role != BrushRole::kUnknown) continue;
            ++out.unknown;
            std::set<uint32_t> once;
            for (const QuakeMapSide& side : map.sidesOf(map.brushes[i]))
                if (textures.roleOf(side) == role && once.insert(side.texture).second) ++unknown[side.texture];
        }
    }
    std::vector<std::pair<uint64_t, uint32_t>> order;
    for (const auto& [texture, brushes] : unknown) order.emplace_back(brushes, texture);
    std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    for (const auto& [brushes, texture] : order) out.unknown_textures.push_back(map.textures[texture]);
    return out;
}

}  // namespace sightline::bake
