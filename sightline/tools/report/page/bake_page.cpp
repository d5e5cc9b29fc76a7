// The page of a bake of any scene: its JSON, two plans, and a plan whose view cells can be asked.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/page/bake_page.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

#include "sightline/tools/report/page/page_pictures.h"
#include "sightline/tools/report/readable.h"

namespace sightline::tools {
namespace {

constexpr size_t kMostRowBytes = 3u << 20;  // of the rows that are in the page

/// The view cells of the plan with their rows, and where the objects are.
nlohmann::ordered_json askedViews(const BakePlan& plan, const DrawnBake& bake) {
    const std::vector<LeafAt>& views = plan.views();
    BitMatrix rows(views.size(), bake.rows->columns()), seen(bake.seen ? views.size() : 0, bake.rows->columns());
    nlohmann::ordered_json cells = nlohmann::ordered_json::array();
    for (size_t i = 0; i < views.size(); ++i) {
        const auto row = bake.rows->row(views[i].leaf);
        std::copy(row.begin(), row.end(), rows.row(i).begin());
        if (bake.seen) {
            const auto of_rays = bake.seen->row(views[i].leaf);
            std::copy(of_rays.begin(), of_rays.end(), seen.row(i).begin());
        }
        const Rgb colour = plan.colourOf(views[i].leaf);
        cells.push_back({{"points", svgPoints(views[i].outline)},
                         {"held", plan.heldBy(views[i].leaf)},
                         {"witnessed", plan.witnessedBy(views[i].leaf)},
                         {"colour", fmt::format("#{:02x}{:02x}{:02x}", colour.x, colour.y, colour.z)}});
    }
    // Tenths of pixels: left, top, width and height; null off the storey.
    nlohmann::ordered_json objects = nlohmann::ordered_json::array();
    for (const uint32_t object : bake.object_of) {
        const Box3d& box = plan.bounds()[object];
        if (!box.finite() || box.max.y < plan.band().low || box.min.y > plan.band().high) {
            objects.push_back(nullptr);
            continue;
        }
        const glm::dvec2 low = plan.at(box.min), high = plan.at(box.max);
        nlohmann::ordered_json rect = nlohmann::ordered_json::array();
        for (const double side : {low.x, low.y, high.x - low.x, high.y - low.y})
            rect.push_back(static_cast<int64_t>(std::lround(std::clamp(10 * side, -1e8, 1e8))));
        objects.push_back(std::move(rect));
    }
    std::vector<uint32_t> order(views.size());
    for (uint32_t i = 0; i < order.size(); ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(),
                     [&](uint32_t a, uint32_t b) { return plan.heldBy(views[a].leaf) < plan.heldBy(views[b].leaf); });
    return {{"width", plan.width()},
            {"height", plan.height()},
            {"first", order[order.size() / 2]},
            {"walls", dataUri(encodePalettePng(plan.walls()))},
            {"cells", std::move(cells)},
            {"objects", std::move(objects)},
            {"rows", base64Rows(rows)},
            {"seen", bake.seen ? nlohmann::ordered_json(base64Rows(seen)) : nlohmann::ordered_json(nullptr)},
            {"row_bytes", rows.wordsPerRow() * 8}};
}

}  // namespace

Status writeBakePage(const DrawnBake& bake, const std::string& json, const std::string& directory) {
    PagePictures page(directory);
    const BakePlan plan(bake);
    const std::string height = fmt::format("{}", readable(bake.eye.y));
    page.add("cells", plan.cells(),
             "From above, cut at the height " + height +
                 ": walls are black, borders of cells grey, portals blue; gaps between walls are red, whatever their "
                 "height.");
    if (!plan.views().empty()) {
        page.add("rows", plan.rows(),
                 "View cells at the height " + height +
                     ": the brighter one is, the more objects may be seen from it; white is all of them. Walls are "
                     "white lines.");
        if (bake.seen)
            page.add("open", plan.open(),
                     "View cells at the height " + height +
                         ": which share of its row no ray from a cell has seen. Black: "
                         "rays have seen all of it; white: none. Walls are white lines.");
        if (plan.views().size() * bake.rows->wordsPerRow() * (bake.seen ? 16 : 8) <= kMostRowBytes)
            page.ask(askedViews(plan, bake));
    }
    return page.finish("bake", json);
}

}  // namespace sightline::tools
