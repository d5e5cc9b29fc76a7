// The verb `export`: a scene as glTF, cut into objects and without what is not seen.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/progress.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/cull_path.h"
#include "apps/cli/verbs/regions.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/tools/export/encased.h"
#include "sightline/tools/export/gltf_cut.h"
#include "sightline/tools/export/gltf_scene.h"
#include "sightline/tools/import/scene_kind.h"
#include "sightline/tools/report/output_file.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

struct ExportOptions : RunOptions {
    std::string output;
    bool outside = false;    ///< leave out what closed surfaces encase
    bool from_path = false;  ///< leave out objects that no frame sees
    RegionChoice regions;    ///< leave out objects that none of these sees
    bool list = false;       ///< name what is left out
};

/// What went into a file and what did not.
struct Exported {
    uint64_t objects = 0, triangles = 0;           ///< of the scene, drawn
    uint64_t objects_written = 0, written = 0;     ///< drawn triangles
    uint64_t shells = 0, encased = 0, unseen = 0;  ///< triangles that were left out
    size_t frames = 0, regions = 0;
    uint64_t region_unseen = 0;                              ///< triangles that no region sees
    std::vector<std::string> unknown;                        ///< regions that the answer is not known for
    std::vector<std::pair<uint64_t, std::string>> left_out;  ///< objects of which nothing is left: keys and paths
    bool keeps_textures = false;
};

Status checkExport(const Command& verb, const ExportOptions& options) {
    if (lower(std::filesystem::path(options.output).extension().string()) != ".glb")
        return usageError(fmt::format("-o {}: what is written is a .glb", options.output));
    for (const char* option : {"--cameras", "--path", "--frames", "--seed", "--fps", "--speed", "--size"})
        if (!options.from_path && verb.count(option) > 0)
            return usageError(fmt::format("{} goes with --from-path", option));
    if (options.regions.any() == options.visibility.file.empty())
        return usageError("--visibility goes with --from-box or --from-node, and they with it");
    ApartFiles files = filesRead(options);
    files.write("-o", options.output);
    files.write("--json", options.json);
    if (!files.status()) return files.status();
    return canWriteFile(options.output);
}

/// Whether the scene is one glTF, of which all is kept.
bool isGltf(const SceneChoice& choice) {
    const std::string file = choice.plainFile();
    if (file.empty()) return false;
    const Result<SceneKind> kind = fileKind(file);
    return kind && (kind->suffix == "glb" || kind->suffix == "gltf");
}

/// The triangles that closed surfaces encase, by object. Interrupted, those that were found.
std::vector<std::vector<uint32_t>> findEncased(const Scene& scene, Exported& out) {
    Progress progress("looking into closed surfaces", "surfaces", 0);
    Encased encased = encasedTriangles(scene, [&](size_t done, size_t total) {
        progress.set(done, total);
        return !interrupted();
    });
    out.shells = encased.shells;
    return std::move(encased.triangles);
}

/// All triangles of the objects that are not seen, which are noted.
/// @param is_seen  of an object's place in the scene
template <class IsSeen>
std::vector<std::vector<uint32_t>> unseenObjects(const Scene& scene, const IsSeen& is_seen, Exported& told) {
    std::vector<std::vector<uint32_t>> out(scene.objects.size());
    for (size_t i = 0; i < out.size(); ++i) {
        if (is_seen(i) || scene.objects[i].changes != 0) continue;  // what changes may stand elsewhere
        out[i].resize(scene.meshes[scene.objects[i].mesh].triangles());
        std::iota(out[i].begin(), out[i].end(), 0u);
        told.left_out.emplace_back(scene.objects[i].key, objectPath(scene, scene.objects[i]));
    }
    return out;
}

/// All triangles of the objects that no eye in the regions sees.
Result<std::vector<std::vector<uint32_t>>> unseenOfRegions(const Scene& scene, ExportOptions& options, Exported& told) {
    const Result<std::vector<NamedRegion>> regions = regionsOf(scene, options.regions);
    if (!regions) return regions.error();
    if (Status opened = openVisibility(scene, options); !opened) return opened.error();
    SeenFromRegions from = seenFrom(AskedScene(scene, options), *regions);
    options.opened = nullptr;  // the path is asked of the scene that is left
    options.visibility = {};
    told.regions = regions->size();
    told.unknown = std::move(from.unknown);
    return unseenObjects(
        scene, [&](size_t i) { return from.seen[i] != 0; }, told);
}

double percentOf(uint64_t part, uint64_t whole) {
    return whole == 0 ? 0 : 100.0 * static_cast<double>(part) / static_cast<double>(whole);
}

void printExported(std::FILE* out, const ExportOptions& options, const Exported& e) {
    tell(out, fmt::format("{}: {} objects, where there were {}; {} of {} triangles; {}\n", options.output,
                          grouped(e.objects_written), grouped(e.objects), grouped(e.written), grouped(e.triangles),
                          e.keeps_textures ? "materials and textures as they were" : "materials without textures"));
    if (options.outside && e.shells == 0) tell(out, "left out: nothing; no closed surface was found\n");
    if (options.outside && e.shells > 0)
        tell(out, fmt::format("left out: {} ({:.1f} %) within {}; it is proved that no eye outside of these sees any\n",
                              counted(e.encased, "triangle"), percentOf(e.encased, e.triangles),
                              counted(e.shells, "closed surface")));
    if (options.from_path)
        tell(out,
             fmt::format("left out: {} ({:.1f} %) of objects; it is proved that none of {} sees any, and nothing "
                         "is said of eyes between them\n",
                         counted(e.unseen, "triangle"), percentOf(e.unseen, e.triangles), counted(e.frames, "frame")));
    if (options.regions.any())
        tell(out, fmt::format("left out: {} ({:.1f} %) of objects that no eye in {} sees, by the file's rows\n",
                              counted(e.region_unseen, "triangle"), percentOf(e.region_unseen, e.triangles),
                              counted(e.regions, "region")));
    if (!e.unknown.empty())
        tell(out, fmt::format("nothing is known of {} of these regions, as '{}', for they reach out of the file's "
                              "cells (see --inset): "
                              "all is kept\n",
                              e.unknown.size(), oneLine(e.unknown.front())));
    if (!options.list) return;
    for (const auto& [key, path] : e.left_out) tell(out, fmt::format("  {:>8}  {}\n", key, oneLine(path)));
}

std::string exportJson(const ExportOptions& options, const Exported& e) {
    nlohmann::ordered_json out;
    out["schema"] = "sightline.export/1";
    out["scene"] = {{"file", options.scene.title()}, {"objects", e.objects}, {"triangles", e.triangles}};
    out["written"] = {{"file", options.output},
                      {"objects", e.objects_written},
                      {"triangles", e.written},
                      {"textures", e.keeps_textures}};
    if (options.outside)
        out["outside"] = {{"closed_surfaces", e.shells}, {"triangles_left_out", e.encased}, {"proved", true}};
    if (options.from_path) out["path"] = {{"frames", e.frames}, {"triangles_left_out", e.unseen}, {"proved", true}};
    if (options.regions.any())
        out["regions"] = {{"count", e.regions}, {"unknown", e.unknown}, {"triangles_left_out", e.region_unseen}};
    out["left_out"] = nlohmann::ordered_json::array();
    for (const auto& [key, path] : e.left_out) out["left_out"].push_back({{"key", key}, {"path", path}});
    return jsonText(out, 1) + "\n";
}

Result<int> runExport(const Command& verb, ExportOptions& options) {
    if (Status good = finish(verb, options); !good) return good.error();
    if (Status good = checkExport(verb, options); !good) return good.error();
    Split split;
    Result<Scene> scene = loadWholeScene(options.scene, split);
    if (!scene) return scene.error();
    Exported out;
    out.objects = scene->objects.size();
    out.triangles = drawnTriangles(*scene);
    std::vector<std::vector<uint32_t>> encased(scene->objects.size());
    stopGently();
    if (options.outside) encased = findEncased(*scene, out);
    if (interrupted()) return reportInterruption("the closed surfaces", false);
    std::vector<std::vector<uint32_t>> unseen(scene->objects.size());
    if (options.regions.any()) {  // of the whole scene, which the file was baked of
        Result<std::vector<std::vector<uint32_t>>> found = unseenOfRegions(*scene, options, out);
        if (!found) return found.error();
        unseen = std::move(*found);
    }
    for (size_t i = 0; i < unseen.size(); ++i) {
        (unseen[i].empty() ? out.encased : out.region_unseen) += std::max(unseen[i].size(), encased[i].size());
        if (!unseen[i].empty()) encased[i] = std::move(unseen[i]);
    }
    CutScene cut = cutScene(std::move(*scene), split);
    leaveOut(cut, inPieces(cut, encased));
    if (options.from_path) {
        const Result<CameraPath> path = loadPath(cut.scene, options);
        if (!path) return path.error();
        const CullRun run = cullPath(cut.scene, *path, options);
        if (run.interrupted)
            return reportInterruption(fmt::format("{} of {} frames", run.frames.size(), path->frames.size()), false);
        out.frames = run.frames.size();
        const auto is_seen = [&](size_t i) {
            return std::any_of(run.frames.begin(), run.frames.end(),
                               [&](const FrameResult& frame) { return frame.reasons[i] == 0; });
        };
        out.unseen = leaveOut(cut, unseenObjects(cut.scene, is_seen, out));
    }
    if (cut.scene.objects.empty())
        return Error{Error::Kind::kInput, options.scene.title() + ": nothing is left to write"};
    out.objects_written = cut.scene.objects.size();
    out.written = drawnTriangles(cut.scene);
    out.keeps_textures = isGltf(options.scene);
    const Result<WrittenGltf> written =
        out.keeps_textures ? cutGltf(options.scene.plainFile(), cut) : sceneGltf(cut.scene, options.output);
    if (!written) return written.error();
    for (const std::string& text : written->notes) note(text);
    if (Status done = writeFileAside(options.output, written->bytes); !done) return done.error();
    printExported(options.json == "-" ? stderr : stdout, options, out);
    if (!options.json.empty())
        if (Status done = writeText(options.json, exportJson(options, out)); !done) return done.error();
    return kDone;
}

}  // namespace

void addExport(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "export");
    const auto options = std::make_shared<ExportOptions>();
    options->repeat = 1;
    addCameraOptions(*verb, *options, "the frames");
    verb->add_option("-o,--output", options->output, "write the scene")->required()->type_name("FILE.glb");
    verb->add_flag("--outside", options->outside,
                   "leave out triangles within closed surfaces, which no eye outside of these can see");
    verb->add_flag("--from-path", options->from_path, "leave out objects that no frame of the path can see");
    addRegionOptions(*verb, options->regions);
    verb->add_option(
            "--visibility", options->visibility.file,
            "rows that `bake` made of this scene, for --from-box and --from-node: leave out objects that no eye "
            "there can see")
        ->type_name("FILE");
    verb->add_flag("--list", options->list, "name the objects of which nothing is left: key and path");
    verb->callback([verb, options, &exit_code] {
        const Result<int> done = runExport(*verb, *options);
        exit_code = done ? *done : report(done.error());
    });
}

}  // namespace sightline::cli
