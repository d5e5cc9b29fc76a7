// Roles of brushes: what each game's compilers know, what nobody knows, and what the user says of it.
// SPDX-License-Identifier: MIT
#include "sightline/bake/brushes/brush_role.h"

#include <filesystem>
#include <optional>

#include <gtest/gtest.h>

#include "sightline/bake/brushes/brush_tree.h"
#include "sightline/bake/brushes/map_game.h"
#include "sightline/bake/brushes/outside.h"
#include "sightline/tools/import/quake/quake_map.h"
#include "tests/bake/brushes/made_brushes.h"
#include "tests/support/files.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace bake;
using namespace tools;
namespace {

struct Flags {
    uint32_t contents = 0, surface = 0;
};

/// The role of one brush with a texture, by a game's rules.
BrushRole roleIn(MapGames games, const std::string& texture, std::optional<Flags> flags = {}, BrushRules rules = {}) {
    BrushMaker maker;
    maker.box({0, 0, 0}, {1, 1, 1}, texture);
    for (QuakeMapSide& side : maker.map.sides) {
        side.has_flags = flags.has_value();
        if (flags) side.contents = flags->contents, side.surface = flags->surface;
    }
    rules.games = games;
    return brushRoles(maker.map, rules).roles.at(0);
}

constexpr BrushRole kSolid = BrushRole::kSolid, kSky = BrushRole::kSky, kLiquid = BrushRole::kLiquid,
                    kUnknown = BrushRole::kUnknown, kNothing = BrushRole::kNothing;

void expectRoles(MapGames games, BrushRole role, std::initializer_list<const char*> names) {
    for (const char* name : names) EXPECT_EQ(roleIn(games, name), role) << name << ", " << namesOfGames(games);
}

TEST(BrushRoles, NamesAreTheWholeRuleOfQuake) {
    // qbsp, ericw-tools, Hexen 2.
    expectRoles(
        kQuake, kSolid,
        {"brick", "wall", "skip", "SKIP", "null", "bevel", "+0button", "window01", "waterfall", "clipped", "rtex078"});
    expectRoles(kQuake, kSky, {"sky1", "SKY_void"});
    expectRoles(kQuake, kLiquid, {"*water1", "*lava", "*slime0", "*teleport", "*waterskip", "*rtex078"});
    expectRoles(kQuake, kNothing, {"clip", "CLIP", "hint", "hintskip", "origin", "trigger", "areaportal", "{fence"});
}

TEST(BrushRoles, NamesAreTheWholeRuleOfHalfLife) {
    // qcsg, ZHLT, VHLT, SDHLT: they look at the beginning of a name.
    expectRoles(kHalfLife, kSolid,
                {"wall", "NULL", "BEVEL", "BEVELBRUSH", "contentsolid", "+0~light", "out_wall", "c1a0_labw4"});
    expectRoles(kHalfLife, kSky, {"sky", "SKY", "sky_day", "contentsky", "env_sky"});
    expectRoles(kHalfLife, kLiquid,
                {"!water", "!lava1", "!cur_90", "CONTENTWATER", "contentwater2", "contentslime", "+!lava"});
    expectRoles(kHalfLife, kNothing,
                {"SKIP",           "skip",      "skip_red",   "CLIP",        "clip_player",  "CLIPBEVEL",
                 "CLIPBEVELBRUSH", "CLIPHULL1", "cliphull2",  "CLIPHULL3",   "CONTENTEMPTY", "BOUNDINGBOX",
                 "SPLITFACE",      "SOLIDHINT", "BEVELHINT",  "HINT",        "hint2",        "ORIGIN",
                 "AAATRIGGER",     "NOCLIP",    "NULLNOCLIP", "TRANSLUCENT", "@glow",        "{grate"});
}

TEST(BrushRoles, AMapOfOneOfTwoGamesHidesOnlyWhatHidesInBoth) {
    expectRoles(kFlatGames, kSolid, {"brick", "null"});
    expectRoles(kFlatGames, kUnknown, {"skip", "SKIP", "clip_red"});
    expectRoles(kFlatGames, kNothing, {"clip", "hint"});
    expectRoles(kFlatGames, kSky, {"sky1"});
    EXPECT_EQ(roleIn(kDeepGames, "e1u1/wall", Flags{1, 0}), kUnknown);
    EXPECT_EQ(roleIn(kDeepGames, "liquids/clear", Flags{0, 0}), kLiquid);
    EXPECT_EQ(roleIn(kDeepGames, "common/caulk", Flags{0, 0}), kSolid);
}

TEST(BrushRoles, FlagsAreTheRuleOfQuake2) {
    const struct {
        Flags flags;
        BrushRole role;
    } rows[] = {
        {{0, 0}, kSolid},  // qbsp3 makes what has no contents solid
        {{1, 0}, kSolid},
        {{1, 1}, kSolid},    // a light
        {{1, 128}, kSolid},  // nodraw, as caulk
        {{0, 4}, kSky},
        {{2, 0}, kNothing},  // window
        {{4, 0}, kNothing},  // aux
        {{8, 0}, kLiquid},
        {{16, 0}, kLiquid},
        {{32 | 0x40000, 8}, kLiquid},
        {{64, 0}, kNothing},      // mist
        {{0x8000, 0}, kNothing},  // area portal
        {{0x10000, 0}, kNothing},
        {{0x20000, 128}, kNothing},  // clips
        {{0x1000000, 0}, kNothing},  // origin
        {{0x8000001, 0}, kNothing},  // detail
        {{0x10000001, 0}, kNothing},
        {{1, 16}, kNothing},
        {{1, 32}, kNothing},  // translucent
        {{1, 256}, kNothing},
        {{0, 512}, kNothing},
        {{1, 768}, kNothing},        // hint, skip
        {{1, 0x2000000}, kNothing},  // alpha test of later engines
        {{1, 2}, kUnknown},          // slick; holes in SiN
        {{1, 0x40000}, kUnknown},    // materials of Kingpin
        {{0x4000, 0}, kUnknown},     // projectile clip of the remaster
        {{1, 0x80000000}, kUnknown},
    };
    for (const auto& [flags, role] : rows)
        EXPECT_EQ(roleIn(kQuake2, "e1u1/floor3_3", flags), role) << flags.contents << " " << flags.surface;
    expectRoles(kQuake2, kUnknown, {"e1u1/floor3_3", "wall", "env/sky"});
    expectRoles(kQuake2, kNothing,
                {"e1u1/clip", "e1u1/hint", "e1u1/skip", "e1u1/trigger", "e1u1/origin", "e1u1/window1"});
    expectRoles(kQuake2, kLiquid, {"e1u1/watrt_water", "gothic/lavahell"});
}

TEST(BrushRoles, WalsOfQuake2StandInForFlags) {
    MapMaterials materials;
    materials.wals["e1u1/wall"] = {0, 0};
    materials.wals["e1u1/waterwall"] = {1, 0};
    materials.wals["e1u1/glass"] = {2, 16};
    materials.wals["e1u1/odd"] = {1, 0x80000};
    const BrushRules rules{.materials = &materials};
    EXPECT_EQ(roleIn(kQuake2, "E1U1/wall", {}, rules), kSolid);
    EXPECT_EQ(roleIn(kQuake2, "e1u1/waterwall", {}, rules), kSolid);
    EXPECT_EQ(roleIn(kQuake2, "e1u1/glass", {}, rules), kNothing);
    EXPECT_EQ(roleIn(kQuake2, "e1u1/odd", {}, rules), kUnknown);
    EXPECT_EQ(roleIn(kQuake2, "e1u1/other", {}, rules), kUnknown);
    // The side's own flags come first, as in qbsp3.
    EXPECT_EQ(roleIn(kQuake2, "e1u1/glass", Flags{1, 0}, rules), kSolid);
    EXPECT_EQ(roleIn(kQuake2, "e1u1/wall", Flags{0, 256}, rules), kNothing);
}

TEST(BrushRoles, ShadersAreTheRuleOfQuake3) {
    expectRoles(kQuake3, kSolid, {"common/caulk", "textures/common/caulk", "COMMON\\CAULK", "system/caulk"});
    expectRoles(kQuake3, kNothing,
                {"common/clip", "textures/common/hint", "common/areaportal", "common/nodraw", "common/trigger",
                 "system/physics_clip", "textures/system/nodraw", "sfx/fog_red", "base/glass01", "gothic_glass/x"});
    expectRoles(kQuake3, kLiquid, {"liquids/clear_ripple1", "textures/liquids/slime1", "gothic/lavahell"});
    expectRoles(kQuake3, kUnknown, {"base_wall/concrete", "textures/base/skyline_wall2/x", "skies/toxicsky", "NULL"});
    EXPECT_EQ(roleIn(kQuake3, "base_wall/x", Flags{1, 0}), kUnknown) << "q3map2 does not heed flags";
    EXPECT_EQ(roleIn(kQuake3, "common/caulk", Flags{0x8000000, 0}), kNothing) << "but detail";

    MapMaterials materials;
    materials.addShader("base_wall/concrete", kSolid);
    materials.addShader("liquids/ice", kSolid);
    materials.addShader("common/caulk", kUnknown);
    materials.addShader("base_wall/grate", kNothing);
    materials.addShader("base_wall/grate", kSolid);
    materials.pictures = {"base_wall/plain", "base_wall/grate", "liquids/pool"};
    BrushRules rules{.materials = &materials};
    EXPECT_EQ(roleIn(kQuake3, "textures/Base_Wall/concrete", {}, rules), kSolid);
    EXPECT_EQ(roleIn(kQuake3, "liquids/ice", {}, rules), kSolid);
    EXPECT_EQ(roleIn(kQuake3, "common/caulk", {}, rules), kUnknown);
    EXPECT_EQ(roleIn(kQuake3, "base_wall/grate", {}, rules), kNothing) << "what hides the least of two shaders";
    EXPECT_EQ(roleIn(kQuake3, "base_wall/plain", {}, rules), kSolid) << "a picture without a shader";
    EXPECT_EQ(roleIn(kQuake3, "liquids/pool", {}, rules), kLiquid);
    EXPECT_EQ(roleIn(kQuake3, "base_wall/other", {}, rules), kUnknown);
    materials.faults = {"a script is spoiled"};
    EXPECT_EQ(roleIn(kQuake3, "base_wall/plain", {}, rules), kUnknown) << "its shader may be in what was not read";
}

TEST(BrushRoles, PatternsMakeSolidOnlyWhatIsNotKnown) {
    const auto role = [](MapGames game, const char* name, const char* pattern, std::optional<Flags> flags = {}) {
        return roleIn(game, name, flags, {.solid = {pattern}});
    };
    EXPECT_EQ(role(kQuake3, "base_wall/x", "base_wall/*"), kSolid);
    EXPECT_EQ(role(kQuake3, "textures/base_wall/x", "Textures/Base_Wall/?"), kSolid);
    EXPECT_EQ(role(kQuake3, "base_wall/xy", "base_wall/?"), kUnknown);
    EXPECT_EQ(role(kQuake3, "base_floor/x", "base_wall/*"), kUnknown);
    EXPECT_EQ(role(kQuake2, "e1u1/x", "*"), kSolid);
    EXPECT_EQ(role(kQuake2, "e1u1/x", "*", Flags{1, 256}), kNothing);
    EXPECT_EQ(role(kQuake2, "e1u1/x", "*", Flags{1, 2}), kSolid);
    EXPECT_EQ(role(kQuake2, "e1u1/x", "*", Flags{0x8000000, 0}), kNothing);
    EXPECT_EQ(role(kQuake3, "liquids/x", "*"), kLiquid);
    EXPECT_EQ(role(kQuake3, "common/hint", "*"), kNothing);
    EXPECT_EQ(role(kHalfLife, "skip", "*"), kNothing);
    EXPECT_EQ(role(kFlatGames, "skip", "skip"), kSolid);
}

TEST(BrushRoles, PatternsMatchWholeNames) {
    for (const auto& [name, pattern] : std::initializer_list<std::pair<const char*, const char*>>{{"", ""},
                                                                                                  {"", "*"},
                                                                                                  {"a", "?"},
                                                                                                  {"abc", "a*c"},
                                                                                                  {"abcbc", "a*bc"},
                                                                                                  {"abc", "***"},
                                                                                                  {"*x", "\\**"},
                                                                                                  {"a?", "a\\?"}})
        EXPECT_TRUE(matches(name, pattern)) << name << " " << pattern;
    for (const auto& [name, pattern] : std::initializer_list<std::pair<const char*, const char*>>{
             {"", "?"}, {"a", ""}, {"abc", "a*b"}, {"abc", "ab"}, {"x", "\\**"}, {"ab", "a\\?"}, {"a", "\\"}})
        EXPECT_FALSE(matches(name, pattern)) << name << " " << pattern;
}

TEST(BrushRoles, UnknownOnesAreCountedAndNamed) {
    BrushMaker maker;
    for (int i = 0; i < 3; ++i) maker.box({0, 0, 0}, {1, 1, 1}, "base_wall/often");
    maker.map.textures.back() = maker.map.textures.front();
    maker.box({0, 0, 0}, {1, 1, 1}, "base_wall/once");
    maker.box({0, 0, 0}, {1, 1, 1}, "common/caulk");
    maker.box({0, 0, 0}, {1, 1, 1}, "common/hint");
    maker.map.sides.back().texture = 0;  // with an unknown side, but a hint all the same
    maker.entity({{"classname", "func_door"}});
    maker.box({0, 0, 0}, {1, 1, 1}, "base_wall/door");
    for (QuakeMapSide& side : maker.map.sides)
        if (side.texture < 3) side.texture = 0;  // names are listed once, as a reader does
    const BrushRoles roles = brushRoles(maker.map);
    EXPECT_EQ(roles.games, kQuake3);
    EXPECT_EQ(roles.unknown, 4u);
    EXPECT_EQ(roles.unknown_textures, (std::vector<std::string>{"base_wall/often", "base_wall/once"}));
    EXPECT_EQ(treeOfBrushes(maker.map).counts.nothing, 5u);
}

TEST(BrushRoles, DetailIsDetailByClassOrKey) {
    BrushMaker maker;
    const auto role = [&](const char* name) {
        maker.box({0, 0, 0}, {1, 1, 1}, name);
        return brushRoles(maker.map, {.games = kQuake}).roles.back();
    };
    maker.entity({{"classname", "func_detail_wall"}});
    EXPECT_EQ(role("brick"), kNothing);
    EXPECT_EQ(role("sky1"), kSky);
    maker.entity({{"classname", "func_group"}, {"zhlt_detaillevel", "1"}});
    EXPECT_EQ(role("brick"), kNothing);
    maker.entity({{"classname", "func_group"}, {"zhlt_detaillevel", "0"}});
    EXPECT_EQ(role("brick"), kSolid);
    maker.entity({{"classname", "func_door"}});
    EXPECT_EQ(role("sky1"), kNothing);
}

TEST(MapGame, IsWhatTheEditorSays) {
    const auto named = [](const char* game) {
        QuakeMap map;
        map.game = game;
        return gamesOf(map);
    };
    EXPECT_EQ(named("Quake"), kQuake);
    EXPECT_EQ(named("Hexen 2"), kQuake);
    EXPECT_EQ(named("Half-Life"), kHalfLife);
    EXPECT_EQ(named("Quake 2"), kQuake2);
    EXPECT_EQ(named("Quake 2 (Remastered)"), kQuake2);
    EXPECT_EQ(named("Daikatana"), kQuake2);
    EXPECT_EQ(named("Quake 3"), kQuake3);
    EXPECT_EQ(named("Jedi Knight Academy"), kQuake3);
    EXPECT_EQ(named("Generic"), kFlatGames);
    EXPECT_EQ(named(""), kFlatGames);
}

TEST(MapGame, IsWhatTheMapHas) {
    using Pairs = std::vector<std::pair<std::string, std::string>>;
    const auto games = [](const Pairs& world, const std::vector<std::string>& textures, const char* thing = "",
                          std::optional<Flags> flags = {}, uint64_t patches = 0) {
        BrushMaker maker;
        maker.map.entities.clear();
        Pairs pairs = world;
        pairs.emplace_back("classname", "worldspawn");
        maker.entity(pairs);
        for (const std::string& texture : textures) maker.box({0, 0, 0}, {1, 1, 1}, texture);
        for (QuakeMapSide& side : maker.map.sides) side.has_flags = flags.has_value();
        maker.map.patches = patches;
        maker.entity({{"classname", thing}});
        return gamesOf(maker.map);
    };
    EXPECT_EQ(games({}, {"wall"}), kFlatGames);
    EXPECT_EQ(games({{"wad", "a.wad"}}, {"wall"}), kFlatGames);
    EXPECT_EQ(games({{"wad", "a.wad"}}, {"odd/name"}), kFlatGames);
    EXPECT_EQ(games({{"worldtype", "1"}}, {"wall"}), kQuake);
    EXPECT_EQ(games({}, {"wall", "*water"}), kQuake);
    EXPECT_EQ(games({}, {"wall"}, "monster_ogre"), kQuake);
    EXPECT_EQ(games({}, {"wall"}, "light_environment"), kHalfLife);
    EXPECT_EQ(games({{"MaxRange", "4096"}}, {"wall"}), kHalfLife);
    EXPECT_EQ(games({}, {"wall", "AAATRIGGER"}), kHalfLife);
    EXPECT_EQ(games({}, {"wall", "*water"}, "light_environment"), kFlatGames) << "signs of both decide nothing";
    EXPECT_EQ(games({}, {"some/wall"}), kDeepGames);
    EXPECT_EQ(games({}, {"wall"}, "", Flags{}), kDeepGames);
    EXPECT_EQ(games({}, {"e1u1/wall"}), kQuake2);
    EXPECT_EQ(games({}, {"some/wall"}, "misc_explobox"), kQuake2);
    EXPECT_EQ(games({}, {"some/wall", "common/caulk"}), kQuake3);
    EXPECT_EQ(games({}, {"wall"}, "", {}, 1), kQuake3);

    BrushMaker maker;
    maker.box({0, 0, 0}, {1, 1, 1}, "some/wall");
    MapMaterials scripts, wals;
    scripts.addShader("some/wall", kSolid);
    wals.wals["some/wall"] = {};
    EXPECT_EQ(gamesOf(maker.map, &scripts), kQuake3);
    EXPECT_EQ(gamesOf(maker.map, &wals), kQuake2);
}

TEST(MapGameMaps, IsTheSameWithoutTheEditorsWord) {
    const auto files = sharedFiles("maps", ".map");
    if (files.empty()) GTEST_SKIP() << "no maps beside the repository";
    for (const std::filesystem::path& file : files) {
        const std::string text = readBytes(file);
        Result<QuakeMap> map =
            parseQuakeMap({reinterpret_cast<const unsigned char*>(text.data()), text.size()}, file.string());
        ASSERT_TRUE(map.ok()) << map.error().message;
        EXPECT_EQ(map->game, "Quake") << file;
        EXPECT_EQ(gamesOf(*map), kQuake) << file;
        EXPECT_EQ(brushRoles(*map).unknown, 0u) << file;
        map->game.clear();
        EXPECT_EQ(gamesOf(*map), kQuake) << file;
    }
}

/// The cases beside the repository: a wall between two rooms that is none.
class MapCases : public ::testing::TestWithParam<const char*> {};

TEST_P(MapCases, RoomsSeeOneAnother) {
    const std::filesystem::path file = std::string(SIGHTLINE_SHARED_DIR "/cases/") + GetParam() + ".map";
    if (!std::filesystem::exists(file)) GTEST_SKIP() << "there is no such case: " << file;
    const std::string text = readBytes(file);
    const Result<QuakeMap> map =
        parseQuakeMap({reinterpret_cast<const unsigned char*>(text.data()), text.size()}, file.string());
    ASSERT_TRUE(map.ok()) << map.error().message;
    // The rooms' own walls are solid, whatever the game: only the wall between them is asked about.
    const BrushTree brushes = treeOfBrushes(*map, {.rules = {.solid = {"wall"}}});
    EXPECT_EQ(brushes.roles.unknown, 0u);
    const MapCells cells = cellsInside(*map, brushes);
    EXPECT_TRUE(cells.leaks.empty());
    const bool hidden = std::string(GetParam()).ends_with("solid");
    // One cell, or cells of a liquid between the two; of the solid wall two cells without a portal.
    EXPECT_EQ(cells.graph.portals.empty() && cells.graph.cells == 2, hidden);
    if (!hidden) { EXPECT_EQ(cells.graph.portals.size(), cells.graph.cells - 1); }
}

INSTANTIATE_TEST_SUITE_P(Shared, MapCases,
                         ::testing::Values("hl-tool-textures/solid", "hl-tool-textures/none", "hl-tool-textures/clip",
                                           "hl-tool-textures/clipbevel", "hl-tool-textures/cliphull1",
                                           "hl-tool-textures/hl_boundingbox", "hl-tool-textures/hl_clipbevelbrush",
                                           "hl-tool-textures/hl_contentwater", "q2-hint-skip-flags/q2flags_hint",
                                           "q3-water-fog/q3_water", "q3-water-fog/water_q1", "omitted-layers/tb_omit"));

}  // namespace
}  // namespace sightline::test
