// What a whole path tells of a scene, as tables of a report's page.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sightline/report/insight.h"
#include "sightline/report/page_parts.h"
#include "sightline/report/page_sections.h"

namespace sightline {
namespace {

constexpr size_t kMostRows = 12;

std::string labelOf(const Scene& scene, uint32_t object) {
    const SceneObject& it = scene.objects[object];
    const std::string path = objectPath(scene, it);
    if (!path.empty()) return escapeHtml(path);
    return fmt::format("object {}", it.key);
}

/// A count that several may share.
std::string shared(double value) { return value < 1000 ? fmt::format("{:.1f}", value) : readable(std::round(value)); }

std::string table(const std::string& head, const std::string& rows, const char* label) {
    return fmt::format(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{}\"><table class=\"counts "
        "wide\"><thead><tr>{}</tr></thead><tbody>{}</tbody></table></div>",
        label, head, rows);
}

std::string columns(std::initializer_list<const char*> names) {
    std::string out;
    for (const char* name : names) out += fmt::format("<th scope=\"col\">{}</th>", name);
    return out;
}

std::string more(size_t all, const char* what) {
    return all > kMostRows ? fmt::format("<p class=\"soft\">and {} more {}</p>", number(all - kMostRows), what) : "";
}

std::string hidesMost(const Scene& scene, const std::vector<OccluderRow>& rows) {
    if (rows.empty()) return "";
    std::string lines;
    const double most = std::max(rows.front().hidden, 1e-9);
    for (size_t i = 0; i < std::min(rows.size(), kMostRows); ++i) {
        const OccluderRow& row = rows[i];
        lines += fmt::format(
            "<tr><th scope=\"row\">{}</th><td><span class=\"mini\"><i style=\"width:{:.1f}%\"></i></span>{}</td>"
            "<td>{}</td><td>{}</td><td>{}</td></tr>",
            labelOf(scene, row.object), 100 * row.hidden / most, shared(row.hidden),
            readable(std::round(row.hidden_triangles)), readable(static_cast<double>(row.triangles)), row.frames);
    }
    return card("hides", "Who hides most",
                table(columns({"occluder", "objects hidden", "their triangles", "own triangles", "frames"}), lines,
                      "Who hides most") +
                    more(rows.size(), "occluders") +
                    "<p class=\"soft\">Sums over the frames. An object that several occluders hide is shared among "
                    "them.</p>");
}

std::string payRows(const Scene& scene, const std::vector<OccluderRow>& rows, size_t most) {
    std::string lines;
    for (size_t i = 0; i < std::min(rows.size(), most); ++i)
        lines += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td><td>{}</td><td>{}</td></tr>",
                             labelOf(scene, rows[i].object), readable(static_cast<double>(rows[i].triangles)),
                             readable(std::round(rows[i].hidden_triangles)), shared(worthOf(rows[i])));
    return lines;
}

/// An occluder pays when what it hides would cost more than rasterizing it.
std::string whichPay(const Scene& scene, const std::vector<OccluderRow>& rows) {
    if (rows.empty()) return "";
    const std::vector<OccluderRow> paying = payingRows(rows), idle = idleRows(rows);
    uint64_t all = 0, idle_triangles = 0;
    for (const OccluderRow& row : rows) all += row.triangles;
    for (const OccluderRow& row : idle) idle_triangles += row.triangles;
    const auto head = columns({"occluder", "triangles rasterized", "triangles hidden", "hidden for one"});
    std::string body;
    if (!paying.empty())
        body += "<p>They hide the most triangles for each one that is rasterized:</p>" +
                table(head, payRows(scene, paying, kMostRows / 2), "Which occluders pay best");
    body += fmt::format(
        "<p>{} of {} rasterized occluders hid nothing on this path, with {} of the {} triangles "
        "rasterized.{}</p>",
        number(idle.size()), number(rows.size()), number(idle_triangles), number(all),
        idle.empty() ? "" : " The largest:");
    if (!idle.empty()) body += table(head, payRows(scene, idle, kMostRows / 2), "Which occluders hid nothing");
    return card("pays", "Which occluders pay", body);
}

std::string never(const Scene& scene, const std::vector<uint32_t>& objects, size_t frames) {
    if (objects.empty()) return "";
    uint64_t triangles = 0;
    for (const uint32_t object : objects) triangles += scene.meshes[scene.objects[object].mesh].triangles();
    std::string lines;
    for (size_t i = 0; i < std::min(objects.size(), kMostRows); ++i)
        lines += fmt::format("<tr><th scope=\"row\">{}</th><td>{}</td></tr>", labelOf(scene, objects[i]),
                             number(scene.meshes[scene.objects[objects[i]].mesh].triangles()));
    return card(
        "never", "Never kept on this path",
        fmt::format("<p>{} of {} objects with {} triangles are in none of the {} frames: candidates for removal, "
                    "as far as the path goes. The largest:</p>",
                    number(objects.size()), number(scene.objects.size()), number(triangles), frames) +
            table(columns({"object", "triangles"}), lines, "Never kept on this path"));
}

std::string together(const Scene& scene, const std::vector<TogetherGroup>& groups) {
    if (groups.empty()) return "";
    std::string lines;
    for (size_t i = 0; i < std::min(groups.size(), kMostRows); ++i) {
        const TogetherGroup& group = groups[i];
        lines += fmt::format("<tr><th scope=\"row\">{} and {} more</th><td>{}</td><td>{}</td><td>{}</td></tr>",
                             labelOf(scene, group.objects.front()), number(group.objects.size() - 1),
                             number(group.objects.size()), number(group.triangles), number(group.frames));
    }
    return card("merge", "Kept together: candidates for one draw",
                table(columns({"group", "objects", "triangles", "frames"}), lines, "Kept together") +
                    more(groups.size(), "groups") +
                    "<p class=\"soft\">Small objects beside one another that appear and disappear in the same "
                    "frames.</p>");
}

}  // namespace

std::string insightSection(const CullRun& run, const Scene& scene) {
    if (run.frames.empty()) return "";
    const std::vector<OccluderRow> rows = occluderRows(run);
    const auto pair = [](const std::string& a, const std::string& b) {
        return a.empty() || b.empty() ? a + b : "<div class=\"pair cards\">" + a + b + "</div>";
    };
    return pair(hidesMost(scene, rows), whichPay(scene, rows)) +
           pair(never(scene, neverKept(run, scene), run.frames.size()), together(scene, keptTogether(run, scene)));
}

}  // namespace sightline
