// The report: one HTML page that needs no network and shows what was culled, by what, at which cost, and the proof.
// SPDX-License-Identifier: MIT
#include "sightline/report/page.h"

#include <algorithm>
#include <set>

#include <fmt/core.h>
#include <fmt/format.h>

#include "sightline/report/film.h"
#include "sightline/report/page_assets.h"
#include "sightline/report/page_data.h"
#include "sightline/report/page_parts.h"
#include "sightline/report/page_sections.h"

namespace sightline {
namespace {

std::string picturedText(const CullRun& run, const Film& film) {
    if (film.shots.empty()) return "";
    if (film.shots.size() == run.frames.size()) return "every frame";
    std::vector<size_t> frames;
    for (const Shot& shot : film.shots) frames.push_back(shot.frame);
    return fmt::format("{} of {} frames: {}", frames.size(), run.frames.size(), fmt::join(frames, ", "));
}

/// What a section is, for the links at the top: only those that the page has.
std::string contents(const std::string& page) {
    static constexpr const char* kLinks[][2] = {
        {"film", "Film"},        {"depth", "Depth complexity"}, {"time", "Cost"},       {"kept", "Objects kept"},
        {"slowest", "Outliers"}, {"stages", "Stages"},          {"hides", "Occluders"}, {"never", "Never kept"},
        {"merge", "Merging"},    {"objects", "Objects"},        {"how", "Proof"}};
    std::string links;
    for (const auto& [id, name] : kLinks)
        if (page.find(fmt::format("class=\"card\" id=\"{}\"", id)) != std::string::npos)
            links += fmt::format("<a href=\"#{}\">{}</a>", id, name);
    return "<nav aria-label=\"Sections\">" + links + "</nav>";
}

struct PageParts {
    const CullRun& run;
    const Film& film;
    const ObjectTable& table;
    std::string explained, insight;
};

std::string assemble(const PageParts& parts) {
    const CullRun& run = parts.run;
    const RunMeans means = meansOf(run);
    const std::vector<Chart> charts = runCharts(run);
    std::string body = filmSection(run, parts.film) + depthSection(parts.film) + chartSection(run, charts) +
                       parts.explained + stageSection(run, means) + parts.insight + tableSection(parts.table) +
                       howSection(run, picturedText(run, parts.film));
    const std::string name = sceneTitle(run.scene);
    return pageHead(name) +
           fmt::format(
               "<header class=\"page\"><h1>{}</h1><p class=\"soft\">{} objects, {} triangles; {} frame{} of {} × "
               "{}</p>{}{}{}</header>\n<main>",
               name, number(run.objects), number(run.triangles), run.frames.size(), run.frames.size() == 1 ? "" : "s",
               run.width, run.height, verdictBox(run), interruptedBox(run), contents(body)) +
           statTiles(run, means) + body +
           "</main><footer>Made by Sightline.</footer><script type=\"application/json\" id=\"data\">" +
           pageData(run, parts.film, charts, parts.table) + "</script><script>" + kPageScript +
           "</script></body></html>\n";
}

}  // namespace

std::vector<size_t> pictureFrames(const CullRun& run, uint32_t most) {
    const size_t count = std::min<size_t>(most, run.frames.size());
    std::set<size_t> chosen;
    for (size_t i = 0; i < run.frames.size() && chosen.size() < count; ++i)
        if (run.frames[i].verification && run.frames[i].verification->false_culls > 0) chosen.insert(i);
    const size_t free = count - chosen.size();
    for (size_t i = 0; i < free; ++i) chosen.insert(free > 1 ? i * (run.frames.size() - 1) / (free - 1) : 0);
    return {chosen.begin(), chosen.end()};
}

std::string reportPage(const Scene& scene, const CullRun& run, const PageSettings& settings) {
    const auto label = [&](uint32_t object) {
        const std::string path = objectPath(scene, scene.objects[object]);
        return path.empty() ? fmt::format("object {}", scene.objects[object].key) : path;
    };
    const Film film = drawFilm(scene, run, settings);
    const ObjectTable table = objectTable(scene, run);
    return assemble({run, film, table, explainedSection(run, label), insightSection(run, scene)});
}

std::string runPage(const CullRun& run, const std::vector<KeyName>& names, const Film& film) {
    const auto label = [&](uint32_t object) {
        const KeyName& name = names[object];
        return name.path.empty() ? fmt::format("object {}", name.key) : name.path;
    };
    return assemble({run, film, objectTable(names, run), explainedSection(run, label), ""});
}

}  // namespace sightline
