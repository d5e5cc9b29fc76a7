// Sources of maps: the dialects, names with signs in them, and what is refused, with its line.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/quake/quake_map.h"

#include <filesystem>
#include <string>

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "map_check.h"
#include "mutated.h"
#include "sightline/base/random.h"
#include "sightline/tools/scene/text_file.h"
#include "tests/support/corpus.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace tools;
namespace {

Result<QuakeMap> parseText(const std::string& text) { return parseQuakeMap(test::bytesOf(text), "test.map"); }

/// The world with one brush of these sides.
std::string world(const std::string& sides) { return "{\n\"classname\" \"worldspawn\"\n{\n" + sides + "}\n}\n"; }

const std::string kPoints = "( 0 0 0 ) ( 0 64 0 ) ( 64 0 0 ) ";

/// The one side of a world's one brush.
QuakeMapSide sideOf(const QuakeMap& map) {
    EXPECT_EQ(map.brushes.size(), 1u);
    EXPECT_EQ(map.sides.size(), 1u);
    return map.sides.at(0);
}

TEST(QuakeMap, ReadsEntitiesAndBrushes) {
    const Result<QuakeMap> map = parseText(
        "// a comment\n" +
        world(kPoints + "brick 1 2 45 1 -1 // behind\n" + "( 1 2 3 ) ( -4.5 5e1 +6 ) ( 7 8 9 ) sky 0 0 0 1 1\n") +
        "{ \"classname\" \"light\" \"origin\" \"1 2 3\" \"light\" \"200\" \"light\" \"300\" }");
    ASSERT_TRUE(map.ok()) << map.error().message;
    ASSERT_EQ(map->entities.size(), 2u);
    EXPECT_EQ(map->valueOf(map->entities[0], "classname"), "worldspawn");
    EXPECT_EQ(map->valueOf(map->entities[1], "light"), "300");
    EXPECT_EQ(map->valueOf(map->entities[1], "wait"), "");
    EXPECT_EQ(map->entities[0].line, 2u);
    EXPECT_EQ(map->entities[1].line, 9u);
    EXPECT_EQ(map->entities[1].brush_count, 0u);
    ASSERT_EQ(map->brushesOf(map->entities[0]).size(), 1u);
    EXPECT_EQ(map->brushes[0].line, 4u);
    const auto sides = map->sidesOf(map->brushes[0]);
    ASSERT_EQ(sides.size(), 2u);
    EXPECT_EQ(sides[1].points[0], glm::dvec3(1, 3, -2));
    EXPECT_EQ(sides[1].points[1], glm::dvec3(-4.5, 6, -50));
    EXPECT_EQ(map->textures, (std::vector<std::string>{"brick", "sky"}));
    EXPECT_EQ(sides[1].texture, 1u);
    EXPECT_EQ(*quakeVector(map->valueOf(map->entities[1], "origin")), glm::dvec3(1, 3, -2));
}

TEST(QuakeMap, ReadsTheDialectsOfASide) {
    const std::string axes = "[ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1";
    for (const std::string& side : std::vector<std::string>{
             kPoints + "name 0 0 0 1 1", kPoints + "name " + axes,
             "(0 0 0)(0 64 0)(64 0 0) name [1 0 0 0][0 -1 0 0]0 1 1", kPoints + "\"name\" 0 0 0 1 1",
             kPoints + "name 0 0 0 1 1 0 0 0", "brushDef { " + kPoints + "( ( 1 0 0 ) ( 0 1 0 ) ) name 0 0 0 }"}) {
        const Result<QuakeMap> map = parseText(world(side + "\n"));
        ASSERT_TRUE(map.ok()) << map.error().message;
        EXPECT_EQ(map->textures.at(sideOf(*map).texture), "name") << side;
        EXPECT_EQ(sideOf(*map).points[1], glm::dvec3(0, 0, -64)) << side;
    }
    Result<QuakeMap> map = parseText(world(kPoints + "e1u1/wall 0 0 0 1 1 134217728 -1 300\n"));
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(sideOf(*map).contents, 134217728u);
    EXPECT_EQ(sideOf(*map).surface, 0xffffffffu);
    map = parseText(world(kPoints + "base/x " + axes + " 1 2 3\n"));
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(sideOf(*map).contents, 1u);
    EXPECT_EQ(sideOf(*map).surface, 2u);
}

TEST(QuakeMap, SaysWhatTellsTheGame) {
    const auto read = [](const std::string& before, const std::string& side) {
        const Result<QuakeMap> map = parseText(before + world(side + "\n"));
        EXPECT_TRUE(map.ok()) << map.error().message;
        return *map;
    };
    EXPECT_EQ(read("", kPoints + "a 0 0 0 1 1").game, "");
    EXPECT_EQ(read("// Game: Quake 2 \r\n// Format: Valve\n// Game: Other\n", kPoints + "a 0 0 0 1 1").game, "Quake 2");
    EXPECT_EQ(read("//Game: Quake\n// x\n", kPoints + "a 0 0 0 1 1 // Game: Quake").game, "");
    EXPECT_FALSE(sideOf(read("", kPoints + "a 0 0 0 1 1")).has_flags);
    EXPECT_FALSE(sideOf(read("", kPoints + "a [ 1 0 0 0 ] [ 0 -1 0 0 ] 0 1 1")).has_flags);
    EXPECT_TRUE(sideOf(read("", kPoints + "a 0 0 0 1 1 0 0 0")).has_flags);
    EXPECT_FALSE(read("", kPoints + "a 0 0 0 1 1 0 0 0").primitives);
    EXPECT_TRUE(read("", "brushDef { " + kPoints + "( ( 1 0 0 ) ( 0 1 0 ) ) a 0 0 0 }").primitives);
}

TEST(QuakeMap, TakesSignsInNames) {
    for (const char* name : {"{grate", "*water[2]", "+0a(b)", "a}b", "#c", "64", "a//b"}) {
        const Result<QuakeMap> map = parseText(world(kPoints + name + std::string(" 0 0 0 1 1\n")));
        ASSERT_TRUE(map.ok()) << map.error().message;
        EXPECT_EQ(map->textures.at(sideOf(*map).texture), name);
    }
}

TEST(QuakeMap, LeavesPatchesOut) {
    const std::string patch = "{\npatchDef2\n{\nbase/curve\n( 3 3 0 0 0 )\n(\n( ( 0 0 0 0 0 ) )\n)\n}\n}\n";
    const Result<QuakeMap> map = parseText("{\n" + patch + patch + "{\n" + kPoints + "a 0 0 0 1 1\n}\n}\n");
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(map->patches, 2u);
    EXPECT_EQ(map->brushes.size(), 1u);
    EXPECT_EQ(map->brushes[0].line, 22u);
}

TEST(QuakeMap, TakesQuotesWithinTexts) {
    const Result<QuakeMap> map =
        parseText("{ \"a\" \"say \\\"go\\\" now\"\n\"path\" \"c:\\maps\\\"\n\"empty\" \"\" \"url\" \"http://x\" }");
    ASSERT_TRUE(map.ok()) << map.error().message;
    EXPECT_EQ(map->valueOf(map->entities[0], "a"), "say \\\"go\\\" now");
    EXPECT_EQ(map->valueOf(map->entities[0], "path"), "c:\\maps\\");
    EXPECT_EQ(map->valueOf(map->entities[0], "empty"), "");
    EXPECT_EQ(map->valueOf(map->entities[0], "url"), "http://x");
}

TEST(QuakeMap, RefusesWithTheLine) {
    const struct {
        std::string text, message;
    } cases[] = {
        {"", "test.map: no entity"},
        {"  // nothing\n", "test.map: no entity"},
        {"x", "test.map: line 1: \"x\" where '{' was expected"},
        {"{\n\"a\" 5\n}", "test.map: line 2: \"5\" where a value in quotes was expected"},
        {"{\n\"a", "test.map: line 2: a quote is not closed on its line"},
        {"{\n\"a\" \"b\n\"", "test.map: line 2: a quote is not closed on its line"},
        {"{\n\"a\" \"b\"", "test.map: line 2: the file ends where a key, a brush or '}' was expected"},
        {"{\n\n5", "test.map: line 3: \"5\" where a key, a brush or '}' was expected"},
        {world("( 0 0 ) x\n"), "test.map: line 4: \")\" where a number was expected"},
        {world("( 0 0 nan )\n"), "test.map: line 4: \"nan\" where a number was expected"},
        {world("( 0 0 2e9 )\n"), "test.map: line 4: \"2e9\" where a number was expected"},
        {world("( 0 0 1x )\n"), "test.map: line 4: \"1x\" where a number was expected"},
        {world(kPoints), "test.map: line 5: \"}\" where a number was expected"},
        {world(kPoints + "a 0 0 0\n"), "test.map: line 5: \"}\" where a number was expected"},
        {world(kPoints + "a [ 1 0 0 ]\n"), "test.map: line 4: \"]\" where a number was expected"},
        {world(kPoints + "a 0 0 0 1 1 1e9 9e8\n"), ""},
        {world("brushDef3\n{\n}\n"), "test.map: line 4: a brush of Doom 3, which is not read"},
        {"{ { patchDef2 { ", "test.map: line 1: the file ends where '}' was expected"},
    };
    for (const auto& [text, message] : cases) {
        const Result<QuakeMap> map = parseText(text);
        if (message.empty()) {
            EXPECT_TRUE(map.ok()) << text << "\n" << map.error().message;
            continue;
        }
        ASSERT_FALSE(map.ok()) << text;
        EXPECT_EQ(map.error().message, message);
        EXPECT_EQ(map.error().kind, Error::Kind::kInput);
    }
    std::string sides;
    for (int i = 0; i <= 4096; ++i) sides += kPoints + "a 0 0 0 1 1\n";
    EXPECT_EQ(parseText(world(sides)).error().message, "test.map: line 4100: a brush of more than 4096 sides");
    EXPECT_FALSE(parseText("{ \"a\" \"" + std::string(70000, 'x') + "\" }").ok());
    EXPECT_FALSE(parseText(world(kPoints + std::string(70000, 'x') + " 0 0 0 1 1")).ok());
    EXPECT_FALSE(parseText(std::string(1000000, '{')).ok());
}

TEST(QuakeMap, ReadsVectors) {
    EXPECT_EQ(*quakeVector(" 1  -2.5\t3e1 "), glm::dvec3(1, 30, 2.5));
    for (const char* text : {"", "1 2", "1 2 3 4", "1 2 x", "1 2 nan", "1 2 1e10"})
        EXPECT_FALSE(quakeVector(text).has_value()) << text;
}

TEST(QuakeMapMutation, CorpusOfTheFuzzerIsSound) {
    size_t good = 0;
    test::forCorpus("map", 4, [&](const std::string& name, const std::string& bytes) {
        EXPECT_EQ(test::sourceFault(bytes), "") << name;
        good += parseText(bytes).ok();
    });
    EXPECT_GE(good, 3u);
}

TEST(QuakeMapMutation, SpoiledMapsAreSoundOrRefused) {
    size_t read = 0, refused = 0;
    test::forCorpus("map", 4, [&](const std::string& name, const std::string& bytes) {
        for (uint64_t seed = 0; seed < 3000; ++seed) {
            Random random(mixSeed(seed, bytes.size()));
            const std::string spoiled = test::mutated(bytes, random);
            ASSERT_EQ(test::sourceFault(spoiled), "") << name << ", seed " << seed;
            (parseText(spoiled).ok() ? read : refused)++;
        }
    });
    EXPECT_GT(read, 500u);
    EXPECT_GT(refused, 1000u);
}

TEST(QuakeMapFiles, AreReadWhole) {
    const std::vector<std::filesystem::path> files = test::sharedFiles("maps", ".map");
    if (files.empty()) GTEST_SKIP() << "no maps beside the repository";
    for (const std::filesystem::path& file : files) {
        const Result<std::string> text = readTextFile(file.string());
        ASSERT_TRUE(text.ok());
        const Result<QuakeMap> map = parseText(*text);
        ASSERT_TRUE(map.ok()) << file << map.error().message;
        // Each side is a line that begins with a parenthesis; each entity has a class.
        size_t lines = 0;
        for (size_t at = text->find("\n( "); at != std::string::npos; at = text->find("\n( ", at + 1)) ++lines;
        EXPECT_EQ(map->sides.size(), lines) << file;
        for (const QuakeMapEntity& entity : map->entities) EXPECT_NE(map->valueOf(entity, "classname"), "");
        EXPECT_EQ(map->valueOf(map->entities[0], "classname"), "worldspawn");
        for (const QuakeMapBrush& brush : map->brushes) EXPECT_GE(brush.side_count, 4u);
    }
    EXPECT_EQ(files.size(), 7u);
}

}  // namespace
}  // namespace sightline
