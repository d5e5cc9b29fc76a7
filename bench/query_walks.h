// What occlusion queries are measured on: walls behind walls, walks through scenes; and how that is told.
// SPDX-License-Identifier: MIT
#pragma once

#include <span>
#include <string>
#include <vector>

#include "bench/table.h"
#include "sightline/cull/queries/occlusion_queries.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tree/world_bvh.h"

namespace sightline::bench {

/// What is drawn, and from where.
struct QueryScene {
    std::string name;
    std::span<const studies::DrawItem> items;
    WorldBvh tree;
    std::vector<View> views;

    void plant(const std::vector<Box3d>& boxes) {
        std::vector<uint32_t> numbers(boxes.size());
        for (uint32_t i = 0; i < numbers.size(); ++i) numbers[i] = i;
        tree.build(boxes, numbers);
    }
};

/// Walls of panes behind each other, each of a few hundred triangles, and an eye that sways before them.
class Layers {
public:
    explicit Layers(int depth);
    Layers(const Layers&) = delete;
    Layers& operator=(const Layers&) = delete;

    const QueryScene& scene() const { return scene_; }

private:
    std::vector<glm::vec3> positions_;
    std::vector<uint32_t> indices_;
    std::vector<studies::DrawItem> items_;
    QueryScene scene_;
};

/// A walk through a scene, which must outlive it.
class Walked {
public:
    Walked(const tools::Scene& scene, uint32_t frames, uint32_t width, uint32_t height);

    const QueryScene& scene() const { return scene_; }

private:
    tools::RenderList list_;
    QueryScene scene_;
};

/// Means per frame.
struct Asked {
    double milliseconds = 0, questions = 0, boxes = 0, waits = 0, switches = 0, drawn = 0;

    void add(const OcclusionQueryStats& stats, double frames) {
        questions += stats.questions / frames;
        boxes += stats.boxes / frames;
        waits += stats.waits / frames;
        switches += stats.switches / frames;
        drawn += stats.drawn / frames;
    }
    std::string note() const;
};

OcclusionQuerySettings queriesBy(QueryMethod method, uint32_t leaf_items = 1);

/// A row for each method that asks, beside the frustum alone.
/// @param by_method  [size: kQueryMethods]
void tellAsked(const QueryScene& scene, const std::string& how, const std::string& unit,
               std::span<const Asked> by_method, Table& table);

#ifdef SIGHTLINE_GL
/// The walk drawn by Mesa in software, by queries and in two passes, by the wall's clock.
void measureQueriesOnGl(const QueryScene& scene, int repeat, Table& table);

/// The same frames by the query, by CHC++ and by two passes: what each keeps, beside what sixteen samples a pixel show. An
/// image's own samples do not see all of that, and so culling by them cannot keep it.
void measureSideBySide(const tools::Scene& scene, const QueryScene& walked, Table& table);
#endif

}  // namespace sightline::bench
