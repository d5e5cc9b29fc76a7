// The verb `info`: what a scene or a visibility file holds, and what can be read.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/options.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/info_map.h"
#include "apps/cli/verbs/info_visibility.h"
#include "apps/cli/verbs/verbs.h"
#include "sightline/tools/import/foreign/foreign.h"
#include "sightline/tools/import/foreign/ifc_needs.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/scene_kind.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    SceneChoice scene;
    std::string json;
    bool objects = false, formats = false;
};

/// Counts of a scene. Triangles are drawn ones: a mesh counts once for each object that shows it.
struct SceneCounts {
    uint64_t objects = 0, keys = 0, deforming_objects = 0, mirrored_objects = 0;
    uint64_t drawn = 0, stored = 0, hiding = 0, masked = 0, blended = 0, transmissive = 0, double_sided = 0;
};

SceneCounts countFacts(const Scene& scene) {
    std::vector<SceneCounts> by_mesh(scene.meshes.size());
    SceneCounts sum;
    for (size_t i = 0; i < scene.meshes.size(); ++i) {
        const Mesh& mesh = scene.meshes[i];
        sum.stored += mesh.triangles();
        for (const Primitive& primitive : mesh.primitives) {
            const Material& material = scene.materials[primitive.material];
            const uint64_t count = primitive.triangle_count;
            if (material.hides() && !mesh.deforms) by_mesh[i].hiding += count;
            if (material.alpha_mode == AlphaMode::kMask) by_mesh[i].masked += count;
            if (material.alpha_mode == AlphaMode::kBlend) by_mesh[i].blended += count;
            if (material.transmissive) by_mesh[i].transmissive += count;
            if (material.double_sided) by_mesh[i].double_sided += count;
        }
    }
    for (const SceneObject& object : scene.objects) {
        const SceneCounts& mesh = by_mesh[object.mesh];
        sum.hiding += mesh.hiding;
        sum.masked += mesh.masked;
        sum.blended += mesh.blended;
        sum.transmissive += mesh.transmissive;
        sum.double_sided += mesh.double_sided;
        sum.deforming_objects += scene.meshes[object.mesh].deforms;
        sum.mirrored_objects += glm::determinant(glm::dmat3(object.transform)) < 0;
    }
    sum.objects = scene.objects.size();
    sum.keys = countKeys(scene, orderByKey(scene));
    sum.drawn = drawnTriangles(scene);
    return sum;
}

/// The tree of nodes: how many there are, how many have names, and the longest way from a root.
struct TreeFacts {
    uint64_t nodes = 0, named = 0, depth = 0;
};

TreeFacts countTree(const Scene& scene) {
    TreeFacts out;
    out.nodes = scene.nodes.size();
    std::vector<uint32_t> depth(scene.nodes.size(), 0);  // 0: not yet known
    std::vector<uint32_t> path;
    for (uint32_t i = 0; i < scene.nodes.size(); ++i) {
        out.named += !scene.nodes[i].name.empty();
        for (uint32_t n = i; n != SceneNode::kNone && depth[n] == 0; n = scene.nodes[n].parent) path.push_back(n);
        for (; !path.empty(); path.pop_back()) {
            const uint32_t parent = scene.nodes[path.back()].parent;
            depth[path.back()] = parent == SceneNode::kNone ? 1 : depth[parent] + 1;
        }
        out.depth = std::max<uint64_t>(out.depth, depth[i]);
    }
    return out;
}

/// What a scene was read from, and by whom.
struct FileFacts {
    std::string name, format, reader;
    uint64_t first_key = 0, bytes = 0;
    std::optional<MapReport> map;
};

std::vector<FileFacts> countFiles(const Scene& scene) {
    std::vector<FileFacts> out;
    for (const SceneFile& file : scene.files) {
        FileFacts facts{file.name, "procedural", "sightline", file.first_key, 0, {}};
        if (const Result<SceneKind> kind = fileKind(file.name); kind && kind->format) {
            facts.format = kind->format->name;
            facts.reader = kind->format->reader;
            std::error_code error;
            facts.bytes = std::filesystem::file_size(splitMapName(file.name).file, error);
            facts.map = reportMap(file.name);
        } else if (isRecordedFrame(file.name)) {
            facts.format = "recorded frame";
            std::error_code error;
            facts.bytes = std::filesystem::file_size(file.name, error);
        }
        out.push_back(facts);
    }
    return out;
}

/// A mesh, and its name, or else that of the first object that shows it.
struct LargeMesh {
    const Mesh* mesh;
    std::string name;
};

/// The meshes with the most triangles, the largest first.
std::vector<LargeMesh> largestMeshes(const Scene& scene) {
    constexpr size_t kMost = 5;
    std::vector<LargeMesh> out;
    for (const Mesh& mesh : scene.meshes) out.push_back({&mesh, {}});
    const size_t count = std::min(kMost, out.size());
    std::partial_sort(out.begin(), out.begin() + static_cast<std::ptrdiff_t>(count), out.end(),
                      [](const LargeMesh& a, const LargeMesh& b) {
                          const size_t of_a = a.mesh->triangles(), of_b = b.mesh->triangles();
                          return of_a != of_b ? of_a > of_b : a.mesh < b.mesh;
                      });
    out.resize(count);
    for (LargeMesh& large : out) {
        large.name = large.mesh->name;
        for (size_t i = 0; i < scene.objects.size() && large.name.empty(); ++i)
            if (&scene.meshes[scene.objects[i].mesh] == large.mesh) large.name = objectPath(scene, scene.objects[i]);
    }
    return out;
}

/// All that is told of a scene.
struct SceneReport {
    const Scene& scene;
    std::string title;
    SceneCounts facts;
    TreeFacts tree;
    std::vector<FileFacts> files;
    Box3d bounds;
};

Json boxJson(const Box3d& box) {
    return {{"min", {box.min.x, box.min.y, box.min.z}}, {"max", {box.max.x, box.max.y, box.max.z}}};
}

/// The first rooms by name, and how many there are besides.
std::string roomsInWords(const Scene& scene) {
    constexpr size_t kMost = 3;
    std::string out;
    for (size_t i = 0; i < std::min(kMost, scene.rooms.size()); ++i)
        out += (i > 0 ? ", " : "") + oneLine(roomPath(scene, scene.rooms[i]));
    return out + (scene.rooms.size() > kMost ? ", ..." : "");
}

Json infoJson(const SceneReport& report) {
    const Scene& scene = report.scene;
    const SceneCounts& facts = report.facts;
    Json out;
    out["schema"] = "sightline.info/1";
    out["file"] = report.title;
    out["files"] = Json::array();
    for (const FileFacts& file : report.files) {
        out["files"].push_back({{"name", file.name},
                                {"format", file.format},
                                {"reader", file.reader},
                                {"bytes", file.bytes},
                                {"first_key", file.first_key}});
        if (file.map) out["files"].back()["map"] = file.map->json;
    }
    out["objects"] = facts.keys;
    out["instances"] = facts.objects;
    out["deforming"] = facts.deforming_objects;
    out["mirrored"] = facts.mirrored_objects;
    out["meshes"] = scene.meshes.size();
    out["materials"] = scene.materials.size();
    out["cameras"] = scene.cameras.size();
    out["nodes"] = {{"count", report.tree.nodes}, {"named", report.tree.named}, {"depth", report.tree.depth}};
    out["cells"] = scene.cells.size();
    out["portals"] = scene.portals.size();
    out["rooms"] = Json::array();
    for (const SceneRoom& room : scene.rooms) {
        out["rooms"].push_back({{"name", roomPath(scene, room)}});
        if (!room.bounds.empty()) out["rooms"].back()["bounds"] = boxJson(room.bounds);
    }
    out["triangles"] = {{"drawn", facts.drawn},
                        {"stored", facts.stored},
                        {"occluding", facts.hiding},
                        {"masked", facts.masked},
                        {"blended", facts.blended},
                        {"transmissive", facts.transmissive},
                        {"double_sided", facts.double_sided}};
    out["largest_meshes"] = Json::array();
    for (const LargeMesh& large : largestMeshes(scene))
        out["largest_meshes"].push_back({{"name", large.name}, {"triangles", large.mesh->triangles()}});
    const Box3d& bounds = report.bounds;
    if (bounds.empty()) return out;
    out["bounds"] = boxJson(bounds);
    return out;
}

void printFiles(std::FILE* out, const SceneReport& report) {
    if (report.files.size() == 1) {
        fmt::print(out, "  format              {} (read by {})\n", report.files[0].format, report.files[0].reader);
        if (report.files[0].map) fmt::print(out, "{}", report.files[0].map->text);
    }
    if (report.files.size() < 2) return;
    constexpr size_t kMost = 8;
    const size_t shown = report.files.size() > kMost ? 3 : report.files.size();
    fmt::print(out, "  files               {:>14}\n                          first key\n",
               grouped(report.files.size()));
    for (size_t i = 0; i < shown; ++i) {
        const FileFacts& file = report.files[i];
        fmt::print(out, "  {:>32}  {}: {}, read by {}\n", grouped(file.first_key), oneLine(file.name), file.format,
                   file.reader);
    }
    if (shown < report.files.size())
        fmt::print(out, "  {:>32}  and {} more (--json lists them)\n", "", grouped(report.files.size() - shown));
}

void printInfo(std::FILE* out, const SceneReport& report) {
    const Scene& scene = report.scene;
    const SceneCounts& facts = report.facts;
    const auto row = [&](const char* name, uint64_t count, const std::string& more = "") {
        fmt::print(out, "  {:<20}{:>14}{}{}\n", name, grouped(count), more.empty() ? "" : "  ", more);
    };
    fmt::print(out, "{}\n", oneLine(report.title));
    printFiles(out, report);
    row("objects", facts.keys, facts.keys == facts.objects ? "" : grouped(facts.objects) + " instances");
    row("  deforming", facts.deforming_objects);
    row("  mirrored", facts.mirrored_objects);
    row("nodes", report.tree.nodes,
        fmt::format("{} named, {} deep", grouped(report.tree.named), grouped(report.tree.depth)));
    row("meshes", scene.meshes.size());
    row("materials", scene.materials.size());
    row("cameras", scene.cameras.size());
    row("cells", scene.cells.size());
    row("portals", scene.portals.size());
    if (!scene.rooms.empty()) row("rooms", scene.rooms.size(), roomsInWords(scene));
    row("triangles drawn", facts.drawn, grouped(facts.stored) + " stored");
    row("  occluding", facts.hiding);
    row("  double-sided", facts.double_sided);
    row("  masked", facts.masked);
    row("  blended", facts.blended);
    row("  transmissive", facts.transmissive);
    const Box3d& bounds = report.bounds;
    if (!bounds.empty())
        fmt::print(out, "  bounds              ({}, {}, {}) to ({}, {}, {})\n", readable(bounds.min.x, 6),
                   readable(bounds.min.y, 6), readable(bounds.min.z, 6), readable(bounds.max.x, 6),
                   readable(bounds.max.y, 6), readable(bounds.max.z, 6));
    const std::vector<LargeMesh> largest = largestMeshes(scene);
    const auto named = [](const LargeMesh& large) { return !large.name.empty(); };
    if (largest.size() < 2 || std::none_of(largest.begin(), largest.end(), named)) return;
    fmt::print(out, "  largest meshes\n");
    for (const LargeMesh& large : largest)
        fmt::print(out, "  {:>34}  {}\n", grouped(large.mesh->triangles()),
                   large.name.empty() ? "-" : oneLine(large.name));
}

/// A line each: key, triangles, path; separated by tabs, in the order of keys.
void printObjects(std::FILE* out, const Scene& scene) {
    for (const uint32_t i : orderByKey(scene)) {
        const SceneObject& object = scene.objects[i];
        fmt::print(out, "{}\t{}\t{}\n", object.key, scene.meshes[object.mesh].triangles(),
                   oneLine(objectPath(scene, object)));
    }
}

Status printFormats(const std::string& json) {
    const std::string worker = findImportWorker({});
    const std::string ifc_lacks = worker.empty() ? "" : findIfcNeeds(worker).lacks;
    Json list = Json::array();
    for (const SceneFormat& format : sceneFormats()) {
        const bool by_node = format.reader == "web-ifc";
        const bool can = format.ours() || (!worker.empty() && !(by_node && !ifc_lacks.empty()));
        const std::string why = can ? "" : worker.empty() ? ", not in this build" : "; " + ifc_lacks;
        if (json != "-")
            fmt::print("{:<16}{:<54}{}{}{}\n", format.suffixes, format.name, format.reader,
                       format.tested ? "" : ", untested", why);
        list.push_back({{"suffixes", format.suffixes},
                        {"name", format.name},
                        {"reader", format.reader},
                        {"tested", format.tested},
                        {"available", can}});
    }
    if (json.empty()) return success();
    return writeText(json, jsonText(Json{{"schema", "sightline.formats/1"}, {"formats", list}}, 1) + "\n");
}

/// Of a file of portals, which is no scene.
Status runPortals(const InfoOptions& options) {
    const Result<MapReport> report = reportPortals(options.scene.names[0]);
    if (!report) return report.error();
    if (options.json != "-") fmt::print("{}", report->text);
    if (options.json.empty()) return success();
    return writeText(options.json, jsonText(report->json, 1) + "\n");
}

Status runInfo(const Command& verb, const InfoOptions& options) {
    if (options.json.empty() && verb.count("--json") > 0)
        return Error{Error::Kind::kUsage, "--json: the name is empty"};
    if (options.formats) return printFormats(options.json);
    if (options.scene.names.empty()) return Error{Error::Kind::kUsage, "SCENE is required (see sightline info --help)"};
    ApartFiles files;
    for (const std::string& name : options.scene.names) files.read("SCENE", name);
    files.write("--json", options.json);
    if (!files.status()) return files.status();
    if (options.scene.names.size() == 1 && isPortalFile(options.scene.names[0])) {
        if (options.objects) return Error{Error::Kind::kUsage, "--objects: a file of portals has none"};
        return runPortals(options);
    }
    if (options.scene.names.size() == 1 && isVisibilityFile(options.scene.names[0])) {
        if (options.objects) return Error{Error::Kind::kUsage, "--objects: a visibility file has none"};
        return infoOfVisibility(options.scene.names[0], options.json);
    }
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    const SceneReport report{
        *scene, options.scene.title(), countFacts(*scene), countTree(*scene), countFiles(*scene), worldBounds(*scene)};
    if (options.objects) printObjects(options.json == "-" ? stderr : stdout, *scene);
    else if (options.json != "-") printInfo(stdout, report);
    if (options.json.empty()) return success();
    return writeText(options.json, jsonText(infoJson(report), 1) + "\n");
}

}  // namespace

void addInfo(Command& tool, int& exit_code) {
    Command verb = tool.add_subcommand("info", "what a scene or a visibility file holds, and what can be read");
    const auto options = std::make_shared<InfoOptions>();
    addSceneChoice(*verb, options->scene);
    verb->get_option("SCENE")->required(false);  // --formats needs none
    verb->add_flag("--objects", options->objects, "a line for each object instead: key, triangles, path (with tabs)");
    verb->add_flag("--formats", options->formats, "what can be read, and by whom");
    verb->add_option("--json", options->json, "write it as JSON (-: standard output)")->type_name("FILE");
    verb->callback([verb, options, &exit_code] {
        const Status done = runInfo(*verb, *options);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
