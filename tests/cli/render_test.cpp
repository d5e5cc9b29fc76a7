// The verb `render` is a contract: methods, files, schema, exit codes.
// SPDX-License-Identifier: MIT
#include <set>

#include "sightline/studies/hidden/render.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/report/run/render_run.h"
#include "tests/cli/tool.h"
#include "tests/support/png.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

class Render : public Tool {
protected:
    struct Pixels {
        int width = 0, height = 0;
        std::vector<uint32_t> colours;  // 24 bits, the top row first
    };
    Pixels decode(const std::string& name) const {
        const test::Decoded decoded = test::decodePng(read(path(name)), 3);
        EXPECT_GT(decoded.width, 0) << name;
        Pixels out{decoded.width, decoded.height, {}};
        for (size_t i = 0; i < decoded.bytes.size(); i += 3)
            out.colours.push_back(uint32_t{decoded.bytes[i]} << 16 | uint32_t{decoded.bytes[i + 1]} << 8 |
                                  decoded.bytes[i + 2]);
        return out;
    }
    json render(const std::string& arguments) const { return answer("render " + arguments); }
};

const std::string kCity = "city:1:300 --frames 6 --frame 4 --size 160x90 ";

TEST_F(Render, WritesPicturesOfTheSizeAskedFor) {
    ASSERT_EQ(run("render " + kCity + "-o a.png --ids b.png --heat-map c.png").exit_code, 0);
    for (const char* name : {"a.png", "b.png", "c.png"}) {
        const Pixels pixels = decode(name);
        EXPECT_EQ(pixels.width, 160) << name;
        EXPECT_EQ(pixels.height, 90) << name;
        EXPECT_GT(std::set<uint32_t>(pixels.colours.begin(), pixels.colours.end()).size(), 5u) << name;
    }
}

TEST_F(Render, IdsAreKeysThatCullingKeeps) {
    ASSERT_EQ(run("render " + kCity + "--ids ids.png").exit_code, 0);
    const auto visible =
        answer("cull city:1:300 --frames 6 --size 160x90")["frames"][4]["visible"].get<std::set<uint64_t>>();
    std::set<uint64_t> shown;
    for (const uint32_t colour : decode("ids.png").colours)
        if (colour != 0) shown.insert(colour - 1);
    EXPECT_GT(shown.size(), 10u);
    EXPECT_TRUE(std::includes(visible.begin(), visible.end(), shown.begin(), shown.end()));
}

TEST_F(Render, ShowsNodesOfGltfInTheirColours) {
    const float positions[9] = {-1, -1, 0, 1, -1, 0, 0, 1, 0};
    const std::string data = base64({reinterpret_cast<const char*>(positions), sizeof positions});
    const json pbr = {{"baseColorFactor", {0.8, 0.1, 0.05, 1}}};
    const json gltf = {{"asset", {{"version", "2.0"}}},
                       {"buffers", {{{"byteLength", 36}, {"uri", "data:application/octet-stream;base64," + data}}}},
                       {"bufferViews", {{{"buffer", 0}, {"byteLength", 36}}}},
                       {"accessors",
                        {{{"bufferView", 0},
                          {"componentType", 5126},
                          {"count", 3},
                          {"type", "VEC3"},
                          {"min", {-1, -1, 0}},
                          {"max", {1, 1, 0}}}}},
                       {"materials", {{{"pbrMetallicRoughness", pbr}}}},
                       {"meshes", {{{"primitives", {{{"attributes", {{"POSITION", 0}}}, {"material", 0}}}}}}},
                       {"nodes", {{{"name", "empty"}}, {{"name", "also empty"}}, {{"mesh", 0}}}},
                       {"scenes", {{{"nodes", {0, 1, 2}}}}},
                       {"scene", 0}};
    write("red.gltf", gltf.dump());
    write("path.json", R"({"frames": [{"eye": [0, 0, 3], "target": [0, 0, 0]}]})");
    ASSERT_EQ(run("render red.gltf --cameras path.json --size 32x32 -o a.png --ids b.png").exit_code, 0);
    const uint32_t colour = decode("a.png").colours[16 * 32 + 16], id = decode("b.png").colours[16 * 32 + 16];
    EXPECT_EQ(id, 3u);  // node 2
    EXPECT_EQ(decode("b.png").colours[0], 0u);
    EXPECT_GT(colour >> 16, 2 * (colour >> 8 & 255));
    // Seen from behind it is not there: the material is single-sided.
    write("behind.json", R"({"frames": [{"eye": [0, 0, -3], "target": [0, 0, 0]}]})");
    ASSERT_EQ(run("render red.gltf --cameras behind.json --size 32x32 --ids c.png").exit_code, 0);
    EXPECT_EQ(decode("c.png").colours[16 * 32 + 16], 0u);
}

TEST_F(Render, EveryMethodDrawsTheSameExceptThePainter) {
    std::set<std::vector<uint32_t>> pictures;
    for (const std::string_view method : kHiddenMethodNames) {
        const std::string name(method);
        const json out = render(kCity + "-o " + name + ".png --method " + name);
        ASSERT_EQ(out["methods"].size(), 1u);
        EXPECT_EQ(out["methods"][0]["name"], name);
        EXPECT_GT(out["methods"][0]["milliseconds"], 0);
        const json& agreement = out["methods"][0]["agreement"];
        EXPECT_EQ(agreement["samples"], 160 * 90);
        EXPECT_EQ(agreement["differing"],
                  agreement["at_edges"].get<int>() + agreement["ties"].get<int>() + agreement["wrong"].get<int>());
        if (method != "painter") { EXPECT_EQ(agreement["wrong"], 0) << name; }
        EXPECT_EQ(decode(name + ".png").colours.size(), 160u * 90);
    }
}

TEST_F(Render, CompressedDepthTilesDoNotChangeThePicture) {
    const std::string common = "render " + kCity + "--method zbuffer --depth-compression ";
    succeed(common + "on -o on.png");
    succeed(common + "off -o off.png");
    EXPECT_EQ(read(path("on.png")), read(path("off.png")));
    expectError(common + "half -o half.png", 2, "--depth-compression");
}

TEST_F(Render, ThreadsDoNotChangeThePicture) {
    const std::string common = "render city:1:2000 --frames 2 --size 200x120 --shading smooth --method ";
    for (const char* method : {"zbuffer", "raycast", "painter"}) {
        ASSERT_EQ(run(common + method + " -o one.png --ids i1.png --heat-map h1.png --threads 1").exit_code, 0);
        ASSERT_EQ(run(common + method + " -o many.png --ids i5.png --heat-map h5.png --threads 5").exit_code, 0);
        EXPECT_EQ(read(path("one.png")), read(path("many.png"))) << method;
        EXPECT_EQ(read(path("i1.png")), read(path("i5.png"))) << method;
        EXPECT_EQ(read(path("h1.png")), read(path("h5.png"))) << method;
    }
}

TEST_F(Render, SplitScenesLookTheSame) {
    // Cameras of a path that is found in a scene change with its objects.
    write("path.json", R"({"frames": [{"eye": [30, 12, 40], "target": [0, 2, 0]}]})");
    const std::string common = "render building:1:1 --cameras path.json --size 200x120 --shading flat --method zbuffer";
    ASSERT_EQ(run(common + " -o whole.png").exit_code, 0);
    for (const std::string how : {"parts", "materials", "grid:5"}) {
        ASSERT_EQ(run(common + " --split " + how + " -o split.png").exit_code, 0);
        EXPECT_TRUE(decode("whole.png").colours == decode("split.png").colours) << how;
    }
    expectError("render building:1:1 --split grid:0", 2, "--split: \"grid:0\" is not parts, materials or grid:N");
    const json run = json::parse(
        succeed("cull building:1:1 --split grid:3 --frames 3 --size 160x90 --verify --rays 20000 --json -").out);
    EXPECT_EQ(run["verification"]["false_culls"], 0);
    EXPECT_GT(run["scene"]["objects"], 1000);
}

TEST_F(Render, AllMethodsFillTheReport) {
    const Outcome outcome = succeed("render " + kCity + "--method all --report deep/out -o all.png");
    const std::string page = read(path("deep/out/index.html"));
    const json out = json::parse(read(path("deep/out/render.json")));
    EXPECT_EQ(out["schema"], "sightline.render/1");
    EXPECT_EQ(out["methods"].size() + out["left_out"].size(), size_t{kHiddenMethods});
    for (const std::string_view name : kHiddenMethodNames) {
        EXPECT_NE(page.find("\"name\": \"" + std::string(name) + "\""), std::string::npos) << name;
        EXPECT_NE(outcome.out.find(name), std::string::npos) << name;
    }
    // The picture is the z-buffer's.
    ASSERT_EQ(run("render " + kCity + "--method zbuffer -o z.png").exit_code, 0);
    EXPECT_EQ(read(path("all.png")), read(path("z.png")));
    for (const std::string_view name : kHiddenMethodNames)
        EXPECT_EQ(decode("deep/out/" + std::string(name) + ".png").width, 160) << name;
    EXPECT_EQ(read(path("deep/out/zbuffer.png")), read(path("z.png")));
}

TEST_F(Render, JsonTellsWhatWasDrawn) {
    const json out = render(kCity + "--method painter --painter-key centre --shading none --shadows off");
    EXPECT_EQ(out["schema"], "sightline.render/1");
    EXPECT_EQ(out["scene"]["file"], "city:1:300");
    EXPECT_EQ(out["scene"]["objects"], 300);
    EXPECT_LE(out["scene"]["objects_in_view"], 300);
    EXPECT_LE(out["scene"]["polygons_in_view"], out["scene"]["triangles_in_view"]);
    EXPECT_EQ(out["frame"], 4);
    EXPECT_EQ(out["settings"]["painter_key"], "centre");
    EXPECT_EQ(out["settings"]["shading"], "none");
    EXPECT_EQ(out["settings"]["shadows"], false);
    const json& painter = out["methods"][0];
    EXPECT_EQ(painter["counters"]["generated"], painter["counters"]["shaded"]);
    const double mean = painter["per_sample"]["generated"]["mean"];
    EXPECT_NEAR(mean * 160 * 90, painter["counters"]["generated"].get<double>(), 0.5);
    // Counts of samples add up to those of the run that they are from.
    const json zbuffer = render(kCity)["methods"][0];
    for (const std::string_view heat : kHeatNames) {
        const double counted = zbuffer["counting_run"][std::string(heat)];
        EXPECT_NEAR(zbuffer["per_sample"][std::string(heat)]["mean"].get<double>() * 160 * 90, counted, 0.5) << heat;
    }
    EXPECT_EQ(zbuffer["counting_run"]["generated"], painter["counters"]["generated"]);
    EXPECT_LT(zbuffer["counters"]["generated"], painter["counters"]["generated"]);
    // The camera can be used again.
    write("path.json", json{{"frames", {out["camera"]}}}.dump());
    ASSERT_EQ(run("render " + kCity + "--ids a.png").exit_code, 0);
    ASSERT_EQ(run("render city:1:300 --size 160x90 --cameras path.json --ids b.png").exit_code, 0);
    EXPECT_EQ(read(path("a.png")), read(path("b.png")));
}

TEST_F(Render, OptionsChangeThePicture) {
    std::set<std::string> pictures;
    for (const char* options : {"", "--shadows off", "--shading smooth", "--shading none"}) {
        ASSERT_EQ(run("render " + kCity + "-o p.png " + options).exit_code, 0);
        EXPECT_TRUE(pictures.insert(read(path("p.png"))).second) << options;
    }
}

TEST_F(Render, ZBufferOptionsReachTheZBuffer) {
    const auto zbuffer = [&](const std::string& options) { return render(kCity + options)["methods"][0]; };
    const json plain = zbuffer("");
    EXPECT_EQ(plain["agreement"]["wrong"], 0);
    EXPECT_GT(plain["counters"]["depth_bytes"], plain["counters"]["depth_bytes_compressed"]);
    for (const std::string_view format : kDepthFormatNames) {
        const json out = render(kCity + "--depth-format " + std::string(format));
        EXPECT_EQ(out["settings"]["depth_format"], format);
    }
    EXPECT_EQ(zbuffer("--depth-comparison never")["counters"]["passed"], 0);
    const json whole = zbuffer("--hierarchical-z off");
    EXPECT_EQ(whole["counters"]["hierarchy_rejected_tiles"], 0);
    EXPECT_GT(whole["counters"]["tested"], plain["counters"]["tested"]);
    EXPECT_GT(zbuffer("--early-z off")["counters"]["shaded"], plain["counters"]["shaded"]);
    EXPECT_EQ(zbuffer("--fast-clear off --polygon-offset 0 0")["agreement"], plain["agreement"]);
    EXPECT_EQ(zbuffer("--back-faces draw")["counters"]["back_facing"], 0);
    EXPECT_GT(zbuffer("--clipping frustum")["counters"]["clipped"], plain["counters"]["clipped"]);
    // Fronts that are clockwise: what was seen from outside is seen from inside.
    ASSERT_EQ(run("render " + kCity + "--ids out.png").exit_code, 0);
    ASSERT_EQ(run("render " + kCity + "--front cw --ids in.png").exit_code, 0);
    EXPECT_NE(read(path("out.png")), read(path("in.png")));
    EXPECT_EQ(zbuffer("--front cw")["agreement"]["wrong"], 0);
}

TEST_F(Render, JsonRepeatsTheSettings) {
    json settings = render(kCity)["settings"];
    EXPECT_EQ(settings["clipping"], "guard-band");
    EXPECT_EQ(settings["depth_comparison"], "nearer");
    EXPECT_EQ(settings["heat"], "generated");
    settings = render(kCity +
                      "--clipping frustum --front cw --back-faces draw --depth-comparison greater-equal "
                      "--depth-write off --polygon-offset 1.5 -2 --heat passed")["settings"];
    EXPECT_EQ(settings["clipping"], "frustum");
    EXPECT_EQ(settings["front"], "cw");
    EXPECT_EQ(settings["back_faces"], "draw");
    EXPECT_EQ(settings["depth_comparison"], "greater-equal");
    EXPECT_EQ(settings["depth_write"], false);
    EXPECT_EQ(settings["polygon_offset"], (json{1.5, -2.0}));
    EXPECT_EQ(settings["heat"], "passed");
}

TEST_F(Render, NotesWhatMakesAPictureEmpty) {
    const auto notes = [&](const std::string& options) {
        const Outcome outcome = run("render " + kCity + options);
        EXPECT_EQ(outcome.exit_code, 0) << options;
        const size_t at = outcome.err.find("note: ");
        return at == std::string::npos ? std::string() : outcome.err.substr(at);
    };
    EXPECT_EQ(notes("--depth-comparison greater"), "");
    EXPECT_EQ(notes("--depth-comparison always"), "");
    EXPECT_EQ(notes("--depth-comparison less --depth-format unorm24"), "");
    EXPECT_EQ(notes("--depth-comparison less --method painter"), "");
    for (const char* options : {"--depth-comparison less", "--depth-comparison less-equal --method all",
                                "--depth-comparison greater --depth-format unorm24"}) {
        const std::string note = notes(options);
        EXPECT_EQ(note.rfind("note: --depth-comparison", 0), 0u) << options;
        EXPECT_NE(note.find("empty"), std::string::npos) << options;
    }
    EXPECT_EQ(notes("--heat tested --heat-map a.png"), "");
    EXPECT_EQ(notes("--heat tested --method painter -o a.png"), "");
    EXPECT_EQ(notes("--heat tested --heat-map a.png --method all"), "");
    EXPECT_EQ(notes("--heat tested --heat-map a.png --method painter").rfind("note: --heat tested", 0), 0u);
}

TEST_F(Render, CliplessDrawsTheSameWithAnyDepthOptions) {
    for (const char* options : {"", "--depth-format float", "--hierarchical-z off --early-z off", "--fast-clear off"})
        EXPECT_EQ(render(kCity + "--clipping clipless " + options)["methods"][0]["agreement"]["wrong"], 0) << options;
    // Options are taken, not passed over: a comparison the other way round shows other surfaces.
    EXPECT_GT(render(kCity + "--clipping clipless --depth-comparison always")["methods"][0]["agreement"]["wrong"], 0);
}

TEST_F(Render, SaysThatAFormatIsTooCoarse) {
    const Outcome outcome = succeed(
        "render city:1:2000 --frames 6 --frame 4 --size 320x180 --method all --depth-format unorm16 --report out");
    EXPECT_NE(outcome.out.find("wrong: unorm16 is too coarse for them"), std::string::npos) << outcome.out;
    EXPECT_NE(outcome.out.find("ms to prepare"), std::string::npos) << outcome.out;
    const std::string page = read(path("out/index.html"));
    EXPECT_NE(page.find("\"exact\":false,\"why\":\"unorm16 is too coarse for them\""), std::string::npos);
}

TEST_F(Render, WrongArgumentsExitWithTwo) {
    expectError("render", 2, "SCENE");
    expectError("render city:1:10 --method magic", 2, "magic");
    expectError("render city:1:10 --shading gouraud", 2, "gouraud");
    expectError("render city:1:10 --shadows maybe", 2, "maybe");
    expectError("render city:1:10 --painter-key nearest", 2, "nearest");
    expectError("render city:1:10 --free-samples list", 2, "list");
    expectError("render city:1:10 --rays magic", 2, "magic");
    expectError("render city:1:10 --heat warm", 2, "warm");
    expectError("render city:1:10 --depth-format unorm8", 2, "unorm8");
    expectError("render city:1:10 --depth-comparison nearest", 2, "nearest");
    expectError("render city:1:10 --polygon-offset 1", 2, "--polygon-offset");
    expectError("render city:1:10 --polygon-offset 1 nan", 2, "--polygon-offset");
    expectError("render city:1:10 --frames 3 --frame 3", 2, "--frame 3");
    expectError("render city:1:10 --frame -1", 2, "--frame");
    expectError("render city:1:10 --size 0x5", 2, "--size");
    expectError("render city:1:10 -o ''", 2, "-o");
    expectError("render city:1:10 --ids -", 2, "--ids");
    expectError("render city:1:10 --stages frustum", 2, "--stages");
}

TEST_F(Render, RefusesToWriteTwoThingsIntoOneFile) {
    const std::string city = "render city:1:10 --size 16x16 ";
    expectError(city + "-o a.png --ids ./a.png", 2, "-o");
    expectError(city + "--ids a.png --heat-map none/../a.png", 2, "--ids");
    expectError(city + "-o a --json a", 2, "-o");
    expectError(city + "-o out/index.html --report out", 2, "out/index.html");
    expectError(city + "--ids out/render.json --report out", 2, "out/render.json");
    expectError(city + "-o out/zbuffer.png --report out", 2, "out/zbuffer.png");
    EXPECT_FALSE(std::filesystem::exists(path("out")));
    write("cameras.json", R"({"near": 0.1, "frames": [{"eye": [0, 2, 9], "target": [0, 0, 0]}]})");
    const std::string cameras = read(path("cameras.json"));
    expectError(city + "--cameras cameras.json --json cameras.json", 2, "--cameras");
    expectError("render cameras.json -o cameras.json", 2, "SCENE");
    EXPECT_EQ(read(path("cameras.json")), cameras);
    EXPECT_EQ(run(city + "-o /dev/null --ids /dev/null").exit_code, 0);
    EXPECT_EQ(run(city + "--json out/render.json --report out").exit_code, 4);  // there is no such folder yet
    EXPECT_EQ(run(city + "--report out").exit_code, 0);
    EXPECT_EQ(run(city + "--json out/render.json --report out").exit_code, 0);
}

TEST_F(Render, UnreadableInputsExitWithThree) {
    write("text.glb", "this is no glb");
    write("broken.json", "{\"frames\": [");
    write("flat.json", R"({"frames": [{"view": [1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],
                                       "projection": [0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,1]}]})");
    expectError("render missing.glb -o a.png", 3, "missing.glb");
    expectError("render text.glb -o a.png", 3, "text.glb");
    expectError("render city:1:10 --cameras broken.json", 3, "broken.json");
    expectError("render city:1:10 --cameras flat.json", 3, "flat.json");
    EXPECT_FALSE(std::filesystem::exists(path("a.png")));
}

TEST_F(Render, UnwritableOutputsExitWithFour) {
    write("file", "");
    std::filesystem::create_directories(path("folder"));
    for (const char* option : {"-o", "--ids", "--heat-map", "--json"}) {
        expectError("render city:1:10 --size 16x16 " + std::string(option) + " no/such/place", 4, "no/such/place");
        expectError("render city:1:10 --size 16x16 " + std::string(option) + " folder", 4, "folder");
    }
    expectError("render city:1:10 --size 16x16 --report file", 4, "file");
}

}  // namespace
}  // namespace sightline
