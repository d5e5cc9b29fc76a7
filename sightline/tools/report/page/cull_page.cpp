// The page of a cull along a path: the run's JSON, its film, its objects, and what the path tells of the scene.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/cull_page.h"

#include <algorithm>
#include <cmath>
#include <set>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/page/film_json.h"
#include "sightline/tools/report/page/page.h"
#include "sightline/tools/report/page/page_table.h"
#include "sightline/tools/report/pictures/film.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/report/run/insight.h"
#include "sightline/tools/scene/json_text.h"
#include "sightline/tools/scene/one_line.h"

namespace sightline::tools {
namespace {

using Json = nlohmann::ordered_json;
using Label = std::function<std::string(uint32_t)>;

constexpr size_t kMostRows = 12;  // of a table of what the path tells

Json tableJson(const NamedObjects& table) {
    Json rows = Json::array();
    for (const NamedObjects::Row& row : table.rows)
        rows.push_back(Json::array({row.key, row.name, row.path, row.triangles, row.kept}));
    return {{"rows", std::move(rows)}, {"stages", table.stages}, {"left_out", table.left_out}};
}

double overEstimateOf(const FrameResult& frame) {
    if (!frame.verification || frame.verification->exactly_visible == 0) return 0;
    return double(frame.visible.size()) / double(frame.verification->exactly_visible);
}

/// The frame that keeps most for what is visible in it, and what it keeps that no witness saw; null without witnesses.
Json loosestJson(const CullRun& run, const Label& label) {
    const auto loosest = std::max_element(run.frames.begin(), run.frames.end(), [](const auto& a, const auto& b) {
        return overEstimateOf(a) < overEstimateOf(b);
    });
    if (loosest == run.frames.end() || overEstimateOf(*loosest) == 0) return nullptr;
    const std::vector<uint32_t>& unseen = loosest->verification->kept_unseen;
    Json names = Json::array();
    for (size_t i = 0; i < std::min(unseen.size(), kMostRows); ++i) names.push_back(label(unseen[i]));
    return {{"frame", loosest - run.frames.begin()}, {"unseen", unseen.size()}, {"names", std::move(names)}};
}

Json occluderRowsJson(const std::vector<OccluderRow>& rows, size_t most, const Label& label) {
    Json out = Json::array();
    for (size_t i = 0; i < std::min(rows.size(), most); ++i)
        out.push_back({{"name", label(rows[i].object)},
                       {"hidden", rows[i].hidden},
                       {"hidden_triangles", rows[i].hidden_triangles},
                       {"triangles", rows[i].triangles},
                       {"frames", rows[i].frames},
                       {"worth", worthOf(rows[i])}});
    return out;
}

Json occludersJson(const CullRun& run, const Label& label) {
    const std::vector<OccluderRow> rows = occluderRows(run), idle = idleRows(rows);
    if (rows.empty()) return nullptr;
    const auto triangles = [](const std::vector<OccluderRow>& of) {
        uint64_t sum = 0;
        for (const OccluderRow& row : of) sum += row.triangles;
        return sum;
    };
    return {{"count", rows.size()},
            {"triangles", triangles(rows)},
            {"most", occluderRowsJson(rows, kMostRows, label)},
            {"paying", occluderRowsJson(payingRows(rows), kMostRows / 2, label)},
            {"idle", occluderRowsJson(idle, kMostRows / 2, label)},
            {"idle_count", idle.size()},
            {"idle_triangles", triangles(idle)}};
}

Json neverJson(const CullRun& run, const Scene& scene, const Label& label) {
    const std::vector<uint32_t> objects = neverKept(run, scene);
    const auto triangles = [&](uint32_t object) { return scene.meshes[scene.objects[object].mesh].triangles(); };
    uint64_t sum = 0;
    for (const uint32_t object : objects) sum += triangles(object);
    Json rows = Json::array();
    for (size_t i = 0; i < std::min(objects.size(), kMostRows); ++i)
        rows.push_back({{"name", label(objects[i])}, {"triangles", triangles(objects[i])}});
    return {{"count", objects.size()}, {"of", scene.objects.size()}, {"triangles", sum}, {"rows", std::move(rows)}};
}

Json togetherJson(const CullRun& run, const Scene& scene, const Label& label) {
    const std::vector<TogetherGroup> groups = keptTogether(run, scene);
    Json rows = Json::array();
    for (size_t i = 0; i < std::min(groups.size(), kMostRows); ++i)
        rows.push_back({{"name", label(groups[i].objects.front())},
                        {"objects", groups[i].objects.size()},
                        {"triangles", groups[i].triangles},
                        {"frames", groups[i].frames}});
    return {{"count", groups.size()}, {"rows", std::move(rows)}};
}

/// @param scene  null: what needs one is left out
std::string cullPage(const CullRun& run, const Film& film, const NamedObjects& table, const Label& label,
                     const Scene* scene) {
    Json page;
    page["page"] = "cull";
    page["command"] = run.command;
    page["stage_names"] = kStageNames;
    for (const OffRow& row : kOffRows) page["off_words"][row.name] = row.words;
    page["whole"] = scene != nullptr;
    page["film"] = filmJson(film);
    page["table"] = tableJson(table);
    page["loosest"] = loosestJson(run, label);
    if (scene && !run.frames.empty()) {
        page["occluders"] = occludersJson(run, label);
        page["never"] = neverJson(run, *scene, label);
        page["together"] = togetherJson(run, *scene, label);
    }
    std::string text = jsonText(page);
    text.pop_back();
    return pageWith(text + ",\"run\":" + cullJsonWithoutSets(run) + "}");
}

}  // namespace

std::string reportPage(const Scene& scene, const CullRun& run, const PageSettings& settings) {
    const Label label = [&](uint32_t object) {
        const std::string path = objectPath(scene, scene.objects[object]);
        return path.empty() ? fmt::format("object {}", scene.objects[object].key) : path;
    };
    return cullPage(run, drawFilm(scene, run, settings), objectTable(scene, run), label, &scene);
}

std::string runPage(const CullRun& run, const std::vector<KeyName>& names, const Film& film) {
    const Label label = [&](uint32_t object) {
        const KeyName& name = names[object];
        return name.path.empty() ? fmt::format("object {}", name.key) : oneLine(name.path, kLongestPath);
    };
    return cullPage(run, film, objectTable(names, run), label, nullptr);
}

}  // namespace sightline::tools
