// The page of two runs beside one another: their comparison, both runs, and the pictures that lie beside their files.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include <nlohmann/json.hpp>

#include "sightline/tools/report/page/film_json.h"
#include "sightline/tools/report/page/page.h"
#include "sightline/tools/report/pictures/film_files.h"
#include "sightline/tools/report/run/compare_runs.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/json_text.h"

namespace sightline::tools {
namespace {

constexpr size_t kBudget = size_t{8} << 20;  // of the pictures of each run [bytes]
constexpr size_t kMostDifferences = 300;     // of objects that differ

std::string filmOf(const RunFile& file, std::vector<size_t> frames) {
    std::sort(frames.begin(), frames.end());
    return jsonText(filmJson(filmBeside(file, {"shaded", "plan", "heat-kept"}, frames, kBudget)));
}

}  // namespace

std::string comparePage(const RunComparison& c, const RunFile& a, const RunFile& b) {
    std::vector<size_t> frames_a, frames_b;
    for (const FramePair& pair : c.pairs) {
        frames_a.push_back(pair.a);
        frames_b.push_back(pair.b);
    }
    return pageWith("{\"page\":\"compare\",\"compare\":" + compareJson(c, a, b, kMostDifferences) +
                    ",\"different\":" + std::to_string(c.differences.size()) + ",\"runs\":[" +
                    cullJsonWithoutSets(a.run) + "," + cullJsonWithoutSets(b.run) + "],\"films\":[" +
                    filmOf(a, frames_a) + "," + filmOf(b, frames_b) + "]}");
}

}  // namespace sightline::tools
