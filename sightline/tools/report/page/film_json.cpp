// A film as its page reads it: the pictures lie in the JSON.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/film_json.h"

#include <cmath>

#include <nlohmann/json.hpp>

#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

nlohmann::ordered_json filmJson(const Film& film) {
    using Json = nlohmann::ordered_json;
    Json shots = Json::array();
    for (const Shot& shot : film.shots) {
        Json images;
        for (const FilmImage& image : shot.images) images[image.id] = dataUri(image.bytes);
        Json entry = {{"frame", shot.frame},
                      {"images", std::move(images)},
                      {"plan", shot.plan_text},
                      {"section", shot.section_text},
                      {"windows", shot.windows_text}};
        if (film.heat_scale > 0) {
            entry["depth_all"] = shot.depth_all;
            entry["depth_kept"] = shot.depth_kept;
            entry["same"] = shot.same;
            entry["variety"] = shot.variety;
        }
        shots.push_back(std::move(entry));
    }
    Json out = {
        {"width", film.width}, {"height", film.height}, {"heat_scale", film.heat_scale}, {"shots", std::move(shots)}};
    if (film.overview.empty()) return out;
    Json eyes = Json::array();
    for (const std::optional<glm::dvec2>& eye : film.eyes)
        eyes.push_back(eye ? Json::array({std::round(1e4 * eye->x) / 1e4, std::round(1e4 * eye->y) / 1e4})
                           : Json(nullptr));
    out["overview"] = {{"image", dataUri(film.overview)}, {"eyes", std::move(eyes)}};
    return out;
}

}  // namespace sightline::tools
