// Weighs what only one game's maps have.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/map_game.h"

#include <algorithm>
#include <string>

namespace sightline::bake {
namespace {

/// What maps of one game have, and maps of the other one of its half have not.
struct Signs {
    MapGames game;
    std::string_view textures, classes, keys;
};

constexpr Signs kSigns[] = {
    {kQuake, "\\** trigger",
     "item_artifact_* item_armor1 item_armor2 item_armorinv item_cells item_spikes item_shells item_rockets "
     "light_torch_* light_flame_* light_fluoro* light_globe info_player_start2 weapon_nailgun weapon_supershotgun "
     "weapon_supernailgun weapon_lightning weapon_grenadelauncher monster_ogre monster_knight monster_hell_knight "
     "monster_demon1 monster_shambler monster_army monster_dog monster_wizard monster_shalrath func_episodegate "
     "func_bossgate trigger_onlyregistered",
     "worldtype _sunlight _wateralpha"},
    {kHalfLife, "!* aaatrigger clipbevel* cliphull* content* boundingbox splitface solidhint",
     "env_* infodecal multi_manager light_environment info_node* game_* monster_scientist "
     "monster_barney monster_headcrab scripted_sequence weapon_9mm* weapon_crowbar ammo_* func_tank* "
     "cycler* info_hostage_rescue func_buyzone func_bomb_target",
     "maxrange skyname startdark gametitle chaptertitle newunit waveheight mapteams defaultteam zhlt_*"},
    {kQuake2, "e?u?/*", "func_areaportal misc_explobox turret_* point_combat item_adrenaline",
     "skyaxis skyrotate nextmap"},
    {kQuake3, "common/* system/* textures/*",
     "misc_model team_ctf_* func_static info_player_intermission item_health_mega",
     "_blocksize _farplanedist gridsize _keeplights"},
};

MapGames bySigns(const QuakeMap& map, MapGames half) {
    uint32_t found = 0;
    for (const Signs& signs : kSigns) {
        if ((signs.game & half) == 0) continue;
        bool has = false;
        for (const std::string& texture : map.textures) {
            std::string low(texture);
            for (char& c : low)
                if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
            has |= matchesAny(low, signs.textures);
        }
        for (const QuakeMapEntity& entity : map.entities)
            has |= matchesAny(nameOfTexture(map.valueOf(entity, "classname")), signs.classes);
        if (!map.entities.empty())
            for (uint32_t i = 0; i < map.entities[0].pair_count; ++i)
                has |= matchesAny(nameOfTexture(map.pairs[map.entities[0].first_pair + i].key), signs.keys);
        if (has) found |= signs.game;
    }
    return static_cast<MapGames>(found == 0 ? uint32_t(half) : found);
}

}  // namespace

MapGames gamesOf(const QuakeMap& map, const MapMaterials* materials) {
    if (const MapGames named = gameOfName(map.game); named != kNoGame) return named;
    const bool has_wad = !map.entities.empty() && !map.valueOf(map.entities[0], "wad").empty();
    const bool deep =
        map.patches > 0 || map.primitives ||
        std::any_of(map.textures.begin(), map.textures.end(),
                    [](const std::string& name) { return name.find('/') != std::string::npos; }) ||
        std::any_of(map.sides.begin(), map.sides.end(), [](const QuakeMapSide& side) { return side.has_flags; });
    if (has_wad || !deep) return bySigns(map, kFlatGames);
    if (map.patches > 0) return kQuake3;
    const MapGames games = bySigns(map, kDeepGames);
    if (games != kDeepGames || !materials || materials->shaders.empty() == materials->wals.empty()) return games;
    return materials->shaders.empty() ? kQuake2 : kQuake3;
}

MapGames gameOfName(std::string_view name) {
    std::string low;
    for (const char c : nameOfTexture(name))
        if (c != ' ' && c != '-') low += c;
    if (matchesAny(low, "quake quake1 hexen2 hexenii")) return kQuake;
    if (matchesAny(low, "halflife goldsrc")) return kHalfLife;
    if (matchesAny(low, "quake2 quake2* daikatana kingpin heretic2")) return kQuake2;
    if (matchesAny(low, "quake3* jediknight* jk2 jka openarena wolfenstein* et rtcw enemyterritory xonotic warsow"))
        return kQuake3;
    return kNoGame;
}

std::string namesOfGames(MapGames games) {
    std::string out;
    for (const auto& [game, name] : {std::pair(kQuake, "Quake"), std::pair(kHalfLife, "Half-Life"),
                                     std::pair(kQuake2, "Quake 2"), std::pair(kQuake3, "Quake 3")})
        if ((games & game) != 0) out += (out.empty() ? "" : " or ") + std::string(name);
    return out;
}

}  // namespace sightline::bake
