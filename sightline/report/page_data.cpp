// What a report's page holds for its script: numbers of every frame, pictures, and the table of objects.
// SPDX-License-Identifier: MIT
#include "sightline/report/page_data.h"

#include <algorithm>
#include <cmath>

#include <nlohmann/json.hpp>

#include "sightline/report/page_parts.h"
#include "sightline/report/plan.h"
#include "sightline/report/png.h"

namespace sightline {
namespace {

using Json = nlohmann::ordered_json;

double rounded(double value) { return std::round(value * 1000) / 1000; }

Json numbers(const std::vector<double>& values) {
    Json out = Json::array();
    for (const double value : values) out.push_back(std::isfinite(value) ? Json(rounded(value)) : Json(nullptr));
    return out;
}

Json framesJson(const CullRun& run) {
    Json out;
    out["kept"] = out["triangles"] = out["query"] = out["exact"] = Json::array();
    for (const FrameResult& frame : run.frames) {
        out["kept"].push_back(frame.visible.size());
        out["triangles"].push_back(frame.triangles);
        out["query"].push_back(rounded(frame.query_microseconds));
        out["exact"].push_back(frame.verification ? Json(frame.verification->exactly_visible) : Json(nullptr));
    }
    out["stages"] = Json::array();
    for (int stage = 0; stage < kStageCount; ++stage) {
        if (!(run.stages >> stage & 1)) continue;
        Json columns;
        columns["tested"] = columns["culled"] = columns["doubt"] = columns["time"] = Json::array();
        for (const FrameResult& frame : run.frames) {
            const StageRow& row = frame.stages[stage];
            columns["tested"].push_back(row.tested);
            columns["culled"].push_back(row.culled);
            columns["doubt"].push_back(row.doubt);
            columns["time"].push_back(rounded(row.microseconds));
        }
        out["stages"].push_back(std::move(columns));
    }
    return out;
}

Json picturesJson(const Film& film) {
    Json out = Json::array();
    for (const Shot& shot : film.shots) {
        Json images;
        for (const FilmImage& image : shot.images) images[image.id] = dataUri(image.bytes);
        Json entry = {{"frame", shot.frame},
                      {"images", std::move(images)},
                      {"plan", shot.plan_text},
                      {"section", shot.section_text}};
        if (!shot.windows_text.empty()) entry["windows"] = shot.windows_text;
        if (film.heat_scale > 0) {
            entry["depth_all"] = rounded(shot.depth_all);
            entry["depth_kept"] = rounded(shot.depth_kept);
            entry["same"] = shot.same;
        }
        out.push_back(std::move(entry));
    }
    return out;
}

}  // namespace

std::string pageData(const CullRun& run, const Film& film, const std::vector<Chart>& charts, const ObjectTable& table) {
    Json data;
    data["frames"] = run.frames.size();
    data["objects"] = run.objects;
    data["triangles"] = run.triangles;
    data["frame"] = framesJson(run);
    data["charts"] = Json::object();
    for (const Chart& chart : charts)
        for (const ChartSeries& series : chart.series)
            data["charts"][chart.id].push_back(
                {{"name", series.name}, {"unit", chart.unit}, {"values", numbers(series.values)}});
    data["stage_names"] = Json(kPlanNames);
    data["rows"] = Json::array();
    for (const ObjectTable::Row& row : table.rows)
        data["rows"].push_back(Json::array({row.key, row.name, row.path, row.triangles, row.kept}));
    data["row_stages"] = table.stages;
    data["pictures"] = picturesJson(film);
    return embedded(data.dump(-1, ' ', true, Json::error_handler_t::replace));
}

}  // namespace sightline
