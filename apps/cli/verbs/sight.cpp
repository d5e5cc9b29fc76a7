// The verb `sight`: whether one point sees another, the way between them, and what may be seen from a place.
// SPDX-License-Identifier: MIT
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/shell/other_verbs.h"
#include "apps/cli/shell/apart.h"
#include "apps/cli/shell/session.h"
#include "apps/cli/verbs/common.h"
#include "apps/cli/verbs/explain_object.h"
#include "apps/cli/verbs/regions.h"
#include "apps/cli/verbs/verbs.h"
#include "apps/cli/verbs/visibility_choice.h"
#include "sightline/query/connectivity.h"
#include "sightline/query/sight_query.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

using Json = nlohmann::ordered_json;

struct SightOptions : RunOptions {
    std::string from, to;
    double within = 0, narrowest = 0;
    RegionChoice regions;
    bool unseen = false;  ///< name what no region sees
};

Json pointJson(const glm::dvec3& point) { return {point.x, point.y, point.z}; }

Json objectJson(const Scene& scene, const Visible& visible) {
    return {{"key", visible.key}, {"name", scene.objects[AskedScene::objectOf(visible.id)].name}};
}

void answerLine(const AskedScene& asked, const glm::dvec3& from, const glm::dvec3& to, std::FILE* out, Json& body) {
    SightQuery query;
    const SightLine line = query.look(asked.now, from, to);
    body["to"] = pointJson(to);
    body["blocked"] = line.blocked;
    if (line.blocked) body["by"] = objectJson(asked.scene, line.by);
    fmt::print(out, "{}\n",
               line.blocked ? fmt::format("blocked: {} stands between them", asked.nameOf(line.by.id))
                            : "open: no front of an occluder stands between them");
}

/// How far two points are apart for whoever goes through open portals of the file's cells.
/// @param blocked  the straight line between them is
void answerWay(const AskedScene& asked, const glm::dvec3& from, const glm::dvec3& to, double narrowest, bool blocked,
               std::FILE* out, Json& body) {
    constexpr size_t kMost = 4;
    ConnectivityQuery query;
    query.begin(asked.now, from, {.narrowest = narrowest});
    const Way way = query.to(to);
    Json& told = body["way"] = {{"known", way.known}, {"connected", way.connected}};
    if (!way.known)
        return fmt::print(out, "way: not known, for a place is in no cell of the file, or a wall has moved\n");
    if (!way.connected)
        return fmt::print(out, "no way: walls{} part them\n", narrowest > 0 ? " and narrower holes" : "");
    told["distance"] = way.distance;
    if (std::isfinite(way.narrowest)) told["narrowest"] = way.narrowest;
    for (const glm::dvec3& point : way.points) told["points"].push_back(pointJson(point));
    for (const uint32_t cell : way.cells) told["cells"].push_back(cell);
    const size_t bends = way.points.size() - 2;
    std::string text =
        fmt::format("a way: {} long, {}", readable(way.distance, 6),
                    bends > 0 ? fmt::format("with {} bend{}", bends, bends == 1 ? "" : "s")
                    : blocked ? "straight through open cells and portals, for what stands in cells is no wall to it"
                              : "straight");
    if (std::isfinite(way.narrowest))
        text += fmt::format("; the narrowest hole on it is {} wide", readable(way.narrowest, 3));
    fmt::print(out, "{}\n", text);
    for (size_t i = 1; i <= std::min(bends, kMost); ++i)
        fmt::print(out, "  bends at {}, {}, {}\n", readable(way.points[i].x, 6), readable(way.points[i].y, 6),
                   readable(way.points[i].z, 6));
    if (bends > kMost) fmt::print(out, "  and at {} more (--json lists them)\n", bends - kMost);
    fmt::print(out, "  through {}\n", cellNames(asked, way.cells, ", "));
}

void answerRegion(const AskedScene& asked, const glm::dvec3& from, double within, std::FILE* out, Json& body) {
    constexpr size_t kMost = 8;
    SightQuery query;
    const RegionSet set = query.seenFrom(asked.now, {from - within, from + within});
    body["within"] = within;
    body["known"] = set.known;
    body["objects"] = Json::array();
    for (const Visible& visible : set.objects) body["objects"].push_back(objectJson(asked.scene, visible));
    const std::string all = grouped(asked.scene.objects.size());
    if (!set.known)
        return fmt::print(out, "not known: all {} objects may be seen (sightline bake tells more: --visibility FILE)\n",
                          all);
    fmt::print(out, "{} of {} objects may be seen from there\n", grouped(set.objects.size()), all);
    for (size_t i = 0; i < std::min(set.objects.size(), kMost); ++i)
        fmt::print(out, "  {}\n", titleOf(asked.scene, AskedScene::objectOf(set.objects[i].id)));
    if (set.objects.size() > kMost) fmt::print(out, "  and {} more (--json lists them)\n", set.objects.size() - kMost);
}

/// What may be seen from several regions together, and what never is.
Status answerRegions(const AskedScene& asked, const SightOptions& options, std::FILE* out, Json& body) {
    constexpr size_t kMost = 8;
    const Result<std::vector<NamedRegion>> regions = regionsOf(asked.scene, options.regions);
    if (!regions) return regions.error();
    const SeenFromRegions from = seenFrom(asked, *regions);
    body["known"] = from.unknown.empty();
    for (const NamedRegion& region : *regions)
        body["regions"].push_back(
            {{"name", region.name}, {"min", pointJson(region.box.min)}, {"max", pointJson(region.box.max)}});
    body["unknown"] = from.unknown;
    body["objects"] = body["unseen"] = Json::array();
    std::vector<uint32_t> unseen;
    for (uint32_t i = 0; i < from.seen.size(); ++i) {
        const SceneObject& object = asked.scene.objects[i];
        body[from.seen[i] ? "objects" : "unseen"].push_back(
            {{"key", object.key}, {"name", object.name}, {"path", objectPath(asked.scene, object)}});
        if (!from.seen[i]) unseen.push_back(i);
    }
    if (!from.unknown.empty())
        fmt::print(out, "not known of {} of {}, as '{}': all may be seen ({})\n", from.unknown.size(),
                   counted(regions->size(), "region"), oneLine(from.unknown.front()),
                   options.opened ? "it reaches out of the cells of the file: --inset keeps eyes off its sides"
                                  : "sightline bake tells more: --visibility FILE");
    fmt::print(out, "{} of {} objects may be seen from {}; {} from none\n", grouped(from.seen.size() - unseen.size()),
               grouped(from.seen.size()), counted(regions->size(), "region"), grouped(unseen.size()));
    const size_t most = options.unseen ? unseen.size() : std::min(unseen.size(), kMost);
    if (most > 0) fmt::print(out, "never seen:\n");
    for (size_t i = 0; i < most; ++i) fmt::print(out, "  {}\n", titleOf(asked.scene, unseen[i]));
    if (most < unseen.size()) fmt::print(out, "  and {} more (--unseen and --json list them)\n", unseen.size() - most);
    return success();
}

Status checkOutput(const SightOptions& options) {
    ApartFiles files = filesRead(options);
    files.write("--json", options.json);
    if (!files.status()) return files.status();
    return canWriteFiles({options.json});
}

Status runSight(SightOptions& options) {
    if (options.from.empty() != options.regions.any())
        return usageError(options.from.empty() ? "--from is required: a point; or --from-box, or --from-node"
                                               : "--from excludes --from-box and --from-node");
    if (options.from.empty()) options.from = "0,0,0";
    const Result<glm::dvec3> from = readPoint("--from", options.from);
    if (!from) return from.error();
    const Result<glm::dvec3> to = options.to.empty() ? from : readPoint("--to", options.to);
    if (!to) return to.error();
    if (Status writable = checkOutput(options); !writable) return writable;
    const Result<Scene> scene = loadScene(options.scene);
    if (!scene) return scene.error();
    if (Status opened = openVisibility(*scene, options); !opened) return opened;
    const AskedScene asked(*scene, options);
    std::FILE* const out = options.json == "-" ? stderr : stdout;
    Json body = {{"schema", "sightline.sight/1"}, {"scene", options.scene.title()}, {"from", pointJson(*from)}};
    if (options.regions.any()) {
        body.erase("from");
        if (Status told = answerRegions(asked, options, out, body); !told) return told;
    } else if (options.to.empty()) answerRegion(asked, *from, options.within, out, body);
    else answerLine(asked, *from, *to, out, body);
    if (!options.to.empty() && options.opened)
        answerWay(asked, *from, *to, options.narrowest, body["blocked"].get<bool>(), out, body);
    if (options.json.empty()) return success();
    return writeText(options.json, jsonText(body, 1) + "\n");
}

}  // namespace

void addSight(Command& tool, int& exit_code) {
    Command verb = addOtherVerb(tool, "sight");
    const auto options = std::make_shared<SightOptions>();
    addSceneChoice(*verb, options->scene);
    verb->add_option("--from", options->from, "where one stands [world units]")->type_name("X,Y,Z");
    Option to =
        verb->add_option("--to", options->to, "a point: does an occluder stand in between?")->type_name("X,Y,Z");
    verb->add_option(
            "--within", options->within,
            "or so far around: which objects may be seen from somewhere in that box? [world units] (default: 0)")
        ->check(Range{0.0, 1e9})
        ->excludes(to)
        ->type_name("R");
    addRegionOptions(*verb, options->regions);
    verb->add_flag("--unseen", options->unseen, "with these, name all that is never seen from any of them");
    for (const char* option : {"--from-box", "--from-node"}) verb->get_option(option)->excludes(to);
    Option visibility =
        verb->add_option(
                "--visibility", options->visibility.file,
                "cells and rows that `bake` made of this scene: what a region sees is answered by them, and by "
                "which way one comes to the other point")
            ->type_name("FILE");
    verb->add_option("--narrowest", options->narrowest, "holes that are narrower are no way [world units] (default: 0)")
        ->check(Range{0.0, 1e9})
        ->needs(to)
        ->needs(visibility)
        ->type_name("W");
    verb->add_option("--json", options->json, "write the answer as JSON (-: standard output)")->type_name("FILE");
    verb->callback([options, &exit_code] {
        exit_code = kDone;
        if (const Status done = runSight(*options); !done) exit_code = report(done.error());
    });
}

}  // namespace sightline::cli
