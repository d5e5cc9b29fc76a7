// The verb `info`: what a scene holds.
// SPDX-License-Identifier: MIT
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/common.h"
#include "apps/cli/verbs.h"
#include "sightline/report/cull_run.h"

namespace sightline::cli {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
    SceneChoice scene;
    std::string json;
};

/// Counts of a scene. Triangles are drawn ones: a mesh counts once for each object that shows it.
struct SceneFacts {
    uint64_t objects = 0, keys = 0, deforming_objects = 0, mirrored_objects = 0;
    uint64_t drawn = 0, stored = 0, hiding = 0, masked = 0, blended = 0, transmissive = 0, double_sided = 0;
};

SceneFacts countFacts(const Scene& scene) {
    std::vector<SceneFacts> by_mesh(scene.meshes.size());
    SceneFacts sum;
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
        const SceneFacts& mesh = by_mesh[object.mesh];
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

Json infoJson(const Scene& scene, const std::string& file, const SceneFacts& facts, const Box3d& bounds) {
    Json out;
    out["schema"] = "sightline.info/1";
    out["file"] = file;
    out["objects"] = facts.keys;
    out["instances"] = facts.objects;
    out["deforming"] = facts.deforming_objects;
    out["mirrored"] = facts.mirrored_objects;
    out["meshes"] = scene.meshes.size();
    out["materials"] = scene.materials.size();
    out["cameras"] = scene.cameras.size();
    out["triangles"] = {{"drawn", facts.drawn},
                        {"stored", facts.stored},
                        {"occluding", facts.hiding},
                        {"masked", facts.masked},
                        {"blended", facts.blended},
                        {"transmissive", facts.transmissive},
                        {"double_sided", facts.double_sided}};
    if (bounds.empty()) return out;
    out["bounds"] = {{"min", {bounds.min.x, bounds.min.y, bounds.min.z}},
                     {"max", {bounds.max.x, bounds.max.y, bounds.max.z}}};
    return out;
}

void printInfo(std::FILE* out, const Scene& scene, const std::string& file, const SceneFacts& facts,
               const Box3d& bounds) {
    const auto row = [&](const char* name, uint64_t count, const std::string& more = "") {
        fmt::print(out, "  {:<20}{:>14}{}{}\n", name, grouped(count), more.empty() ? "" : "  ", more);
    };
    fmt::print(out, "{}\n", file);
    row("objects", facts.keys, facts.keys == facts.objects ? "" : grouped(facts.objects) + " instances");
    row("  deforming", facts.deforming_objects);
    row("  mirrored", facts.mirrored_objects);
    row("meshes", scene.meshes.size());
    row("materials", scene.materials.size());
    row("cameras", scene.cameras.size());
    row("triangles drawn", facts.drawn, grouped(facts.stored) + " stored");
    row("  occluding", facts.hiding);
    row("  double-sided", facts.double_sided);
    row("  masked", facts.masked);
    row("  blended", facts.blended);
    row("  transmissive", facts.transmissive);
    if (bounds.empty()) return;
    fmt::print(out, "  bounds              ({:.6g}, {:.6g}, {:.6g}) to ({:.6g}, {:.6g}, {:.6g})\n", bounds.min.x,
               bounds.min.y, bounds.min.z, bounds.max.x, bounds.max.y, bounds.max.z);
}

Status runInfo(const CLI::App& verb, const InfoOptions& options) {
    if (options.json.empty() && verb.count("--json") > 0)
        return Error{Error::Kind::kUsage, "--json: the name is empty"};
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    const SceneFacts facts = countFacts(*scene);
    const Box3d bounds = worldBounds(*scene);
    if (options.json != "-") printInfo(stdout, *scene, options.scene.title(), facts, bounds);
    if (options.json.empty()) return success();
    const Json json = infoJson(*scene, options.scene.title(), facts, bounds);
    return writeText(options.json, json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n");
}

}  // namespace

void addInfo(CLI::App& tool, int& exit_code) {
    CLI::App* verb = tool.add_subcommand("info", "what a scene holds");
    const auto options = std::make_shared<InfoOptions>();
    addSceneChoice(*verb, options->scene);
    verb->add_option("--json", options->json, "write it as JSON (-: standard output)")->type_name("FILE");
    verb->callback([verb, options, &exit_code] {
        const Status done = runInfo(*verb, *options);
        exit_code = done ? kDone : report(done.error());
    });
}

}  // namespace sightline::cli
