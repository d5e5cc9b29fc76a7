// What a whole path tells of a scene: who hides most, who pays, what is never kept, what comes and goes together.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "apps/cli/verbs/explain_object.h"
#include "sightline/tools/report/readable.h"
#include "sightline/tools/report/run/insight.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::cli {
using namespace tools;
namespace {

using Json = nlohmann::ordered_json;

/// The object's key, and its path, of a long one both ends.
std::string fitted(const Scene& scene, uint32_t object, size_t width) {
    const std::string key = fmt::format("{:>6}", scene.objects[object].key);
    const std::string path = objectPath(scene, scene.objects[object]);
    if (path.empty()) return key;
    return fmt::format("{} '{}'", key, withoutMiddle(path, width - std::min(key.size() + 3, width - 3)));
}

uint64_t trianglesOf(const Scene& scene, uint32_t object) {
    return scene.meshes[scene.objects[object].mesh].triangles();
}

std::string occluderTable(const Scene& scene, const std::vector<OccluderRow>& rows, size_t top) {
    std::string text = fmt::format("{:>9} {:>9} {:>12} {:>14} {:>8}  {}\n", "hidden", "frames", "rasterized", "hidden",
                                   "hidden", "the occluder's");
    text += fmt::format("{:>9} {:>9} {:>12} {:>14} {:>8}  {}\n", "objects", "", "triangles", "triangles", "for one",
                        "   key  name");
    for (size_t i = 0; i < std::min(rows.size(), top); ++i) {
        const OccluderRow& row = rows[i];
        text += fmt::format("{:>9.1f} {:>9} {:>12} {:>14} {:>8.1f}  {}\n", row.hidden, row.frames,
                            grouped(row.triangles), grouped(static_cast<uint64_t>(row.hidden_triangles + 0.5)),
                            worthOf(row), fitted(scene, row.object, 42));
    }
    return text;
}

std::string idleText(const Scene& scene, const std::vector<OccluderRow>& rows, size_t top) {
    const std::vector<OccluderRow> idle = idleRows(rows);
    uint64_t spent = 0, all = 0;
    for (const OccluderRow& row : rows) all += row.triangles;
    for (const OccluderRow& row : idle) spent += row.triangles;
    std::string text = fmt::format("Occluders that hid nothing: {} of {}; they were {} of {} rasterized triangles.\n",
                                   grouped(idle.size()), grouped(rows.size()), grouped(spent), grouped(all));
    for (size_t i = 0; i < std::min(idle.size(), top); ++i)
        text += fmt::format("{:>12} triangles in {:>4} {}  {}\n", grouped(idle[i].triangles), idle[i].frames,
                            idle[i].frames == 1 ? "frame " : "frames", fitted(scene, idle[i].object, 62));
    return text;
}

std::string neverText(const Scene& scene, const std::vector<uint32_t>& never, size_t top) {
    uint64_t triangles = 0;
    for (const uint32_t object : never) triangles += trianglesOf(scene, object);
    std::string text = fmt::format(
        "Never kept on this path: {} of {} objects, {} of {} triangles (candidates for removal).\n",
        grouped(never.size()), grouped(scene.objects.size()), grouped(triangles), grouped(drawnTriangles(scene)));
    for (size_t i = 0; i < std::min(never.size(), top); ++i)
        text +=
            fmt::format("{:>12} triangles  {}\n", grouped(trianglesOf(scene, never[i])), fitted(scene, never[i], 76));
    return text;
}

std::string togetherText(const Scene& scene, const std::vector<TogetherGroup>& groups, size_t top) {
    uint64_t objects = 0;
    for (const TogetherGroup& group : groups) objects += group.objects.size();
    std::string text =
        fmt::format("Small, near one another, and kept or culled together: {} objects in {} groups (to be merged).\n",
                    grouped(objects), grouped(groups.size()));
    for (size_t i = 0; i < std::min(groups.size(), top); ++i) {
        const TogetherGroup& group = groups[i];
        text += fmt::format("{:>6} objects, {:>8} triangles, {:>4} {}  {} ...\n", group.objects.size(),
                            grouped(group.triangles), group.frames, group.frames == 1 ? "frame " : "frames",
                            fitted(scene, group.objects.front(), 50));
    }
    return text;
}

Json rowJson(const Scene& scene, const OccluderRow& row) {
    const SceneObject& object = scene.objects[row.object];
    return {{"key", object.key},
            {"name", object.name},
            {"path", objectPath(scene, object)},
            {"frames", row.frames},
            {"triangles", row.triangles},
            {"hidden", row.hidden},
            {"hidden_triangles", row.hidden_triangles}};
}

}  // namespace

std::string pathText(const Scene& scene, const CullRun& run, uint32_t top) {
    const std::vector<OccluderRow> rows = occluderRows(run);
    double hidden = 0;
    for (const OccluderRow& row : rows) hidden += row.hidden;
    std::string text = fmt::format(
        "{}: {}, {} triangles; {}\nOcclusion hid {} objects, {:.1f} a frame.\n\nWho hides most\n", oneLine(run.scene),
        counted(run.instances, "object"), grouped(run.triangles), counted(run.frames.size(), "frame"),
        grouped(static_cast<uint64_t>(hidden + 0.5)), hidden / static_cast<double>(run.frames.size()));
    text += occluderTable(scene, rows, top);
    text +=
        "\nWhich pay best: triangles hidden for each one rasterized\n" + occluderTable(scene, payingRows(rows), top);
    text += "\n" + idleText(scene, rows, top);
    text += "\n" + neverText(scene, neverKept(run, scene), top);
    return text + "\n" + togetherText(scene, keptTogether(run, scene), top);
}

Json pathJson(const Scene& scene, const CullRun& run) {
    Json out;
    out["occluders"] = Json::array();
    for (const OccluderRow& row : occluderRows(run)) out["occluders"].push_back(rowJson(scene, row));
    out["never_kept"] = Json::array();
    for (const uint32_t object : neverKept(run, scene))
        out["never_kept"].push_back({{"key", scene.objects[object].key},
                                     {"name", scene.objects[object].name},
                                     {"path", objectPath(scene, scene.objects[object])},
                                     {"triangles", trianglesOf(scene, object)}});
    out["together"] = Json::array();
    for (const TogetherGroup& group : keptTogether(run, scene)) {
        Json keys = Json::array();
        for (const uint32_t object : group.objects) keys.push_back(scene.objects[object].key);
        out["together"].push_back({{"keys", keys}, {"triangles", group.triangles}, {"frames", group.frames}});
    }
    return out;
}

}  // namespace sightline::cli
