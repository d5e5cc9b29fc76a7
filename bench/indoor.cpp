// A furnished building from inside: triangles left and time to draw them, stage by stage.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
// David Luebke, Chris Georges. Portals and Mirrors: Simple, Fast Evaluation of Potentially Visible Sets. 1995.
#include <algorithm>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/eye_worlds.h"
#include "bench/stopwatch.h"
#include "sightline/query/query.h"
#include "sightline/studies/cells/eye_cells.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/visfile/visible_rows.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr uint64_t kBuildingSeed = 6;
constexpr uint32_t kFloors = 2;
constexpr size_t kEyes = 48;

constexpr uint32_t kFrustum = stageBit(Stage::kFrustum), kPvs = stageBit(Stage::kPvs),
                   kPortals = stageBit(Stage::kPortals), kOcclusion = stageBit(Stage::kOcclusion);

/// No stage of a query: eye-to-object culling by sight lines, box by box.
constexpr uint32_t kSightLines = ~0u;

/// What is drawn: all, or what a query with these stages keeps.
struct Way {
    const char* name;
    uint32_t stages;                                         ///< 0: no query at all
    double triangles = 0, objects = 0, query = 0, draw = 0;  ///< means over the eyes  [microseconds]
    uint64_t changed = 0;                                    ///< pixels that differ from drawing all
    std::vector<double> of_eye = {};                         ///< to ask and to draw  [microseconds]
};

/// Rooms proper: not the doorways and window recesses, nor what is out of doors.
std::vector<uint32_t> roomsOf(const Scene& scene) {
    std::vector<uint32_t> rooms;
    for (uint32_t i = 0; i < scene.cells.size(); ++i) {
        const std::string& name = scene.cells[i].name;
        const auto has = [&](const char* word) { return name.find(word) != std::string::npos; };
        if (!has("Outside") && !has("Terrace") && !has(" door ") && !has(" window ") && !has("Lift"))
            rooms.push_back(i);
    }
    return rooms;
}

/// The eyes of one building, each way.
class Indoor {
public:
    explicit Indoor(const EyeWorld& world)
        : world_(world), scene_(*world.scene), loaded_(loadWorld(scene_)), rows_(*tiledRows(world.rows)) {
        const Result<VisibleRows> rows = VisibleRows::open(rows_, "rows");
        if (rows && loaded_.world.attach(world.space, &*rows)) is_attached_ = true;
        now_ = loaded_.world.commit();
        views_ = eyesIn(world, 1, kEyes, roomsOf(scene_));
        for (View& view : views_) view.width = 640, view.height = 360;
        Array<uint32_t> cells;
        for (const SceneObject& object : scene_.objects) {
            boxes_.push_back(transformBox(scene_.meshes[object.mesh].bounds, object.transform));
            cells.clear();
            world.graph->cellsOf(boxes_.back(), cells);
            cells_of_.emplace_back(cells.begin(), cells.end());
        }
    }

    bool isAttached() const { return is_attached_; }
    size_t eyes() const { return views_.size(); }

    void measure(std::span<Way> ways, int repeat) {
        for (const View& eye : views_) {
            const RenderList all(scene_, eye);
            std::vector<HiddenImage> images(ways.size());
            std::vector<std::vector<DrawItem>> items(ways.size());
            std::vector<std::function<void()>> jobs;
            for (size_t w = 0; w < ways.size(); ++w) {
                choose(ways[w], eye, all, items[w], repeat);
                jobs.push_back([&, w] { images[w] = render(DrawList(items[w]), eye, {}); });
            }
            const std::vector<double> times = threadTimes(jobs, repeat);
            for (size_t w = 0; w < ways.size(); ++w) {
                ways[w].of_eye.back() += times[w];
                ways[w].draw += times[w] / static_cast<double>(views_.size());
                ways[w].changed += changedPixels(images[0], DrawList(items[0]), images[w], DrawList(items[w]));
            }
        }
    }

private:
    void choose(Way& way, const View& eye, const RenderList& all, std::vector<DrawItem>& items, int repeat) {
        const double share = 1.0 / static_cast<double>(views_.size());
        std::vector<uint8_t> kept(scene_.objects.size(), way.stages == 0);
        double asked = 0;
        if (way.stages == kSightLines) {
            asked = threadTimes({[&] { askSightLines(eye, kept); }}, repeat)[0];
        } else if (way.stages != 0) {
            VisibleSet set;
            asked = threadTimes({[&] { set = query_.visible(now_, eye, {.stages = way.stages}); }}, repeat)[0];
            for (const Visible& object : set.objects) kept[object.id.index - 1] = 1;  // objects enter in their order
        }
        way.query += asked * share;
        way.of_eye.push_back(asked);
        for (const DrawItem& item : all.casters()) {
            if (!kept[item.id]) continue;
            items.push_back(item);
            way.triangles += static_cast<double>(item.mesh.triangles()) * share;
            way.objects += share;
        }
    }

    void askSightLines(const View& eye, std::vector<uint8_t>& kept) {
        lines_.run(*world_.graph, eye, {}, world_.rowsOf(eye));
        for (size_t i = 0; i < kept.size(); ++i) {
            kept[i] = cells_of_[i].empty();  // in no cell: nothing is known of it
            for (const uint32_t cell : cells_of_[i])
                if (!kept[i]) kept[i] = lines_.sees(cell, boxes_[i]);
        }
    }

    /// Where another object is seen. The same item may be another surface in another list.
    static uint64_t changedPixels(const HiddenImage& a, const DrawList& of_a, const HiddenImage& b,
                                  const DrawList& of_b) {
        const auto objectAt = [](const HiddenImage& image, const DrawList& list, size_t i) {
            return image.surface[i] == HiddenImage::kNone ? HiddenImage::kNone : list.idOf(image.surface[i]);
        };
        uint64_t changed = 0;
        for (size_t i = 0; i < a.surface.size(); ++i) changed += objectAt(a, of_a, i) != objectAt(b, of_b, i);
        return changed;
    }

    const EyeWorld& world_;
    const Scene& scene_;
    LoadedWorld loaded_;
    Array<char> rows_;
    bool is_attached_ = false;
    Snapshot now_;
    Query query_;
    std::vector<View> views_;
    EyeCells lines_;
    std::vector<Box3d> boxes_;  // per object
    std::vector<std::vector<uint32_t>> cells_of_;
};

}  // namespace

Table benchIndoor(const Options& options) {
    Table table{"indoor", {}};
    const EyeWorld world = buildingWorld(kBuildingSeed, kFloors);
    Indoor indoor(world);
    if (!indoor.isAttached()) {
        table.faults.push_back("indoor: the building's cells were not attached");
        return table;
    }
    Way ways[] = {
        {"all", 0},
        {"view volume", kFrustum},
        {"rows alone", kPvs},
        {"view volume, rows", kFrustum | kPvs},
        {"view volume, portals", kFrustum | kPortals},
        {"view volume, rows, portals", kFrustum | kPvs | kPortals},
        {"sight lines to objects", kSightLines},
        {"view volume, occlusion", kFrustum | kOcclusion},
        {"view volume, rows, portals, occlusion", kFrustum | kPvs | kPortals | kOcclusion},
    };
    indoor.measure(ways, options.repeat > 0 ? options.repeat : 3);
    const Way &all = ways[0], &in_view = ways[1];
    const Rows row{table, world.name};
    for (const Way& way : ways) {
        const std::string name = way.name;
        row(name + ": triangles", way.triangles, "triangles", "all", all.triangles,
            fmt::format("{:.1f} % removed, {:.1f}x less; {:.1f} objects; {} eyes",
                        100.0 * (1.0 - way.triangles / all.triangles), all.triangles / way.triangles, way.objects,
                        indoor.eyes()));
        if (way.stages != 0)
            row(name + ": triangles in view", way.triangles, "triangles", "view volume", in_view.triangles,
                fmt::format("{:.1f} % removed", 100.0 * (1.0 - way.triangles / in_view.triangles)));
        row(name + ": draw", way.draw, "us", "all", all.draw, fmt::format("{:.1f}x faster", all.draw / way.draw));
        std::vector<double> faster;
        for (size_t eye = 0; eye < way.of_eye.size(); ++eye) faster.push_back(in_view.of_eye[eye] / way.of_eye[eye]);
        std::sort(faster.begin(), faster.end());
        if (way.stages != 0 && !faster.empty())
            row(name + ": query and draw", way.query + way.draw, "us", "view volume", in_view.query + in_view.draw,
                fmt::format("query {:.1f} us; {:.2f}x faster, by eye {:.2f} to {:.2f}, median {:.2f}", way.query,
                            (in_view.query + in_view.draw) / (way.query + way.draw), faster.front(), faster.back(),
                            faster[faster.size() / 2]));
        if (way.changed > 0)
            table.faults.push_back(fmt::format("indoor: {}: {} pixels are drawn otherwise", way.name, way.changed));
    }
    return table;
}

}  // namespace sightline::bench
