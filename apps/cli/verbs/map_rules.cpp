// Options of a map's source, and the line that tells what they could say.
// SPDX-License-Identifier: MIT
#include "apps/cli/verbs/map_rules.h"

#include <algorithm>

#include <fmt/core.h>

#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "sightline/bake/brushes/map_game.h"
#include "sightline/tools/import/quake/map_materials_files.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {

void addMapRules(Command& verb, MapRules& rules) {
    verb.add_option("--game", rules.game,
                    "whose rules tell what the brushes of a .map are (default: what the map looks like)")
        ->check(OneOf{"quake", "halflife", "quake2", "quake3"})
        ->type_name("NAME");
    verb.add_option("--shaders", rules.shaders,
                    "read what textures of a .map are from the game's files: a .shader, .wal, .pk3 or .pak, or a "
                    "folder with them; "
                    "may be repeated")
        ->take_all()
        ->type_name("PATH");
    verb.add_option(
            "--solid", rules.solid,
            "textures of a .map that are solid where nothing says what they are, as base_wall/*; may be repeated")
        ->take_all()
        ->type_name("PATTERN");
}

Result<BrushRules> brushRulesOf(const MapRules& rules, MapMaterials& materials) {
    BrushRules out;
    out.games = gameOfName(rules.game);
    out.solid = rules.solid;
    if (rules.shaders.empty()) return out;
    for (const std::string& path : rules.shaders)
        if (Status read = readMapMaterials(path, materials); !read) return read.error();
    if (!materials.faults.empty())
        note(fmt::format(
            "{}{}: textures that it may have told of hide nothing", materials.faults[0],
            materials.faults.size() > 1 ? fmt::format(" (and {} files more)", materials.faults.size() - 1) : ""));
    out.materials = &materials;
    return out;
}

void noteUnknown(const std::string& map, const BrushRoles& roles) {
    if (roles.unknown == 0) return;
    constexpr size_t kNamed = 3;
    const std::vector<std::string>& all = roles.unknown_textures;
    std::vector<std::string> names;
    for (size_t i = 0; i < std::min(all.size(), kNamed); ++i) names.push_back(oneLine(all[i], 60));
    const std::string more = all.size() > kNamed ? fmt::format(" and {} more", grouped(all.size() - kNamed)) : "";
    note(fmt::format(
        "{}: {} nothing, because {} not known ({}{}); {} is assumed. --game NAME, --shaders PATH (with the game's "
        ".shader or .wal files) or --solid PATTERN tells what they are",
        map, roles.unknown == 1 ? "1 brush hides" : grouped(roles.unknown) + " brushes hide",
        all.size() == 1 ? "1 texture is" : grouped(all.size()) + " textures are", joined(names, ", "), more,
        namesOfGames(roles.games)));
}

}  // namespace sightline::cli
