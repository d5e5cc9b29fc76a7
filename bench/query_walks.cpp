// What occlusion queries are measured on: walls behind walls, walks through scenes; and how that is told.
// SPDX-License-Identifier: MIT
#include "bench/query_walks.h"

#include <cmath>

#include <fmt/core.h>

#include "sightline/tools/load/walk.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr QueryMethod kAsking[] = {QueryMethod::kStopAndWait, QueryMethod::kChc, QueryMethod::kChcPlusPlus};
constexpr int kColumns = 16, kRows = 9, kParts = 12;  // of a wall, and of a pane

}  // namespace

Layers::Layers(int depth) {
    for (int y = 0; y <= kParts; ++y)
        for (int x = 0; x <= kParts; ++x) positions_.emplace_back(float(x) / kParts, float(y) / kParts, 0.0f);
    for (uint32_t y = 0; y < kParts; ++y)
        for (uint32_t x = 0; x < kParts; ++x) {
            const uint32_t a = y * (kParts + 1) + x, b = a + kParts + 1;
            indices_.insert(indices_.end(), {a, a + 1, b + 1, a, b + 1, b});
        }
    std::vector<Box3d> boxes;
    for (int layer = 0; layer < depth; ++layer)
        for (int row = 0; row < kRows; ++row)
            for (int column = 0; column < kColumns; ++column) {
                // Each wall fills the view, and a little more.
                const double scale = 0.16 * (10 + layer), z = -(10.0 + layer);
                DrawItem item;
                item.mesh = {positions_, indices_};
                item.transform[0][0] = item.transform[1][1] = scale;
                item.transform[3] = {scale * (column - 0.5 * kColumns), scale * (row - 0.5 * kRows), z, 1.0};
                items_.push_back(item);
                boxes.push_back(transformBox({glm::dvec3(0.0), glm::dvec3(1, 1, 0)}, item.transform));
            }
    scene_.name = fmt::format("{} layers", depth);
    scene_.items = items_;
    scene_.plant(boxes);
    for (int frame = 0; frame < 300; ++frame) {
        View view;
        view.width = 320;
        view.height = 180;
        view.projection = perspective(glm::radians(60.0), 16.0 / 9.0, 0.1);
        const glm::dvec3 eye(0.3 * std::sin(0.1 * frame), 0.2 * std::sin(0.13 * frame), 0.0);
        view.view = lookAt(eye, eye + glm::dvec3(0, 0, -1), {0, 1, 0});
        scene_.views.push_back(view);
    }
}

Walked::Walked(const Scene& scene, uint32_t frames, uint32_t width, uint32_t height) : list_(scene) {
    std::vector<Box3d> boxes;
    for (const DrawItem& item : list_.list().items())
        boxes.push_back(transformBox(scene.meshes[scene.objects[item.id].mesh].bounds, item.transform));
    scene_.name = scene.name;
    scene_.items = list_.list().items();
    scene_.plant(boxes);
    WalkSettings settings;
    settings.frames = frames;
    settings.seed = 21;
    for (const CameraFrame& frame : walkThrough(scene, settings).frames)
        scene_.views.push_back(makeView(frame, width, height));
}

std::string Asked::note() const {
    return fmt::format("{:.1f} questions of {:.1f} boxes, {:.1f} waits, {:.1f} switches, {:.0f} items drawn", questions,
                       boxes, waits, switches, drawn);
}

OcclusionQuerySettings queriesBy(QueryMethod method, uint32_t leaf_items) {
    OcclusionQuerySettings settings;
    settings.method = method;
    settings.leaf_items = leaf_items;
    return settings;
}

void tellAsked(const QueryScene& scene, const std::string& how, const std::string& unit,
               std::span<const Asked> by_method, Table& table) {
    const Asked& none = by_method[0];
    for (const QueryMethod method : kAsking) {
        const Asked& asked = by_method[static_cast<size_t>(method)];
        table.rows.push_back({scene.name, fmt::format("{}, {}", kQueryMethodNames[static_cast<int>(method)], how),
                              asked.milliseconds, unit, fmt::format("frustum alone, {:.0f} items", none.drawn),
                              none.milliseconds, asked.note()});
    }
    table.rows.push_back({scene.name, fmt::format("questions of chc++, {}", how), by_method[3].questions, "a frame",
                          "of chc", by_method[2].questions});
}

}  // namespace sightline::bench
