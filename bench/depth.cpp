// The z-buffer beside the plain one: threads, hierarchy, formats, compression and clearing.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <functional>
#include <vector>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/zbuffer/depth_buffer.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

constexpr uint32_t kWidth = 1920, kHeight = 1080;

/// Values of one view or their means over several; order as in kWays.
struct Way {
    const char* what;
    const char* baseline;  ///< null: the first way
    void (*change)(RenderSettings&);
};

constexpr Way kWays[] = {
    {"z-buffer, 1 thread", "plain z-buffer in double", [](RenderSettings&) {}},
    {"z-buffer, 2 threads", nullptr, [](RenderSettings& s) { s.threads = 2; }},
    {"without hierarchy", nullptr, [](RenderSettings& s) { s.depth.hierarchy = false; }},
    {"items near to far", nullptr, [](RenderSettings& s) { s.depth.near_to_far = true; }},
    {"with a full clear", nullptr, [](RenderSettings& s) { s.depth.fast_clear = false; }},
    {"compressing tiles", nullptr, [](RenderSettings& s) { s.depth.compression = true; }},
    {"24 bits of fixed point", nullptr, [](RenderSettings& s) { s.depth.format = DepthFormat::kUnorm24; }},
    {"float, not reversed", nullptr, [](RenderSettings& s) { s.depth.format = DepthFormat::kFloat; }},
    {"distance in float (w)", nullptr, [](RenderSettings& s) { s.depth.format = DepthFormat::kW; }},
};
constexpr size_t kWayCount = std::size(kWays);

void addScene(const Scene& scene, const CameraPath& path, int repeat, Table& table) {
    const double part = 1.0 / static_cast<double>(path.frames.size());
    double times[kWayCount + 1] = {};
    HiddenCounters with, without, packed, sorted;
    double triangles = 0;
    for (const CameraFrame& frame : path.frames) {
        const View view = makeView(frame, kWidth, kHeight);
        const RenderList in_view(scene, view);
        const DrawList& list = in_view.list();
        RenderSettings settings[kWayCount];
        ZBufferMemory memory[kWayCount];
        std::vector<std::function<void()>> jobs;
        for (size_t i = 0; i < kWayCount; ++i) {
            settings[i].zbuffer_memory = &memory[i];
            kWays[i].change(settings[i]);
            jobs.push_back([&, i] { render(list, view, settings[i]); });
        }
        jobs.push_back([&] { renderZBuffer(list.items(), view, {.want_generated = false}); });
        const std::vector<double> taken = timeInterleaved(jobs, repeat);
        for (size_t i = 0; i < taken.size(); ++i) times[i] += part * 1e-3 * taken[i];
        const auto add = [&](size_t way, HiddenCounters& sum) {
            const HiddenCounters more = render(list, view, settings[way]).counters;
            sum.tested += more.tested;
            sum.shaded += more.shaded;
            sum.depth_bytes += more.depth_bytes;
            sum.depth_bytes_compressed += more.depth_bytes_compressed;
        };
        add(0, with);
        add(2, without);
        add(5, packed);
        add(3, sorted);
        triangles += part * static_cast<double>(list.surfaces());
    }
    for (size_t i = 0; i < kWayCount; ++i)
        table.rows.push_back({scene.name, kWays[i].what, times[i], "ms",
                              kWays[i].baseline != nullptr ? kWays[i].baseline : kWays[0].what,
                              kWays[i].baseline != nullptr ? times[kWayCount] : times[0]});
    const auto number = [](uint64_t value) { return static_cast<double>(value); };
    table.rows.push_back({scene.name, "fragments tested", number(with.tested), "fragments", "without hierarchy",
                          number(without.tested)});
    table.rows.push_back({scene.name, "fragments shaded, items near to far", number(sorted.shaded), "fragments",
                          "in the list's order", number(with.shaded)});
    table.rows.push_back({scene.name, "bytes of depth, compressed", number(packed.depth_bytes_compressed), "bytes",
                          "not compressed", number(packed.depth_bytes)});
    table.rows.push_back({scene.name, "triangles in view", triangles, "triangles", "", 0});
}

/// Walls across the image, one behind the other, each of `parts` by `parts` squares.
struct Walls {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    View view;

    Walls(int layers, int parts) {
        view.width = kWidth;
        view.height = kHeight;
        view.view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
        view.projection = perspective(1.0, double{kWidth} / kHeight, 0.1);
        for (int layer = 0; layer < layers; ++layer) {
            const float z = -2.0f - static_cast<float>(layer);
            const uint32_t first = static_cast<uint32_t>(positions.size()), across = static_cast<uint32_t>(parts) + 1;
            for (uint32_t j = 0; j < across; ++j)
                for (uint32_t i = 0; i < across; ++i) {
                    const float u = 2 * static_cast<float>(i) / static_cast<float>(parts) - 1;
                    const float v = 2 * static_cast<float>(j) / static_cast<float>(parts) - 1;
                    positions.emplace_back(-1.1f * z * u, -0.6f * z * v, z * (1 + 0.05f * u));
                }
            for (uint32_t j = 0; j + 1 < across; ++j)
                for (uint32_t i = 0; i + 1 < across; ++i) {
                    const uint32_t at = first + j * across + i;
                    indices.insert(indices.end(), {at, at + 1, at + across + 1, at, at + across + 1, at + across});
                }
        }
    }
};

void addWalls(int repeat, Table& table) {
    const Walls walls(8, 32);
    DrawItem item;
    item.mesh = {walls.positions, walls.indices};
    const std::vector<DrawItem> items{item};
    const DrawList list(items);
    RenderSettings with, without;
    without.depth.hierarchy = false;
    ZBufferMemory kept;
    with.zbuffer_memory = without.zbuffer_memory = &kept;
    const HiddenCounters a = render(list, walls.view, with).counters, b = render(list, walls.view, without).counters;
    const char* where = "8 walls, near to far";
    const Rows row{table, where};
    row("fragments tested", a.tested, "fragments", "without hierarchy", b.tested);
    const std::vector<double> times =
        timeInterleaved({[&] { render(list, walls.view, with); }, [&] { render(list, walls.view, without); },
                         [&] { renderZBuffer(items, walls.view, {.want_generated = false}); }},
                        repeat);
    row("z-buffer, 1 thread", 1e-3 * times[0], "ms", "without hierarchy", 1e-3 * times[1]);
    row("without hierarchy", 1e-3 * times[1], "ms", "plain z-buffer in double", 1e-3 * times[2]);
    const Walls reversed(1, 32);
    DrawItem one;
    one.mesh = {reversed.positions, reversed.indices};
    const std::vector<DrawItem> single{one};
    const DrawList wall(single);
    std::vector<std::function<void()>> jobs;
    RenderSettings settings[kDepthFormats];
    ZBufferMemory memory;
    for (int i = 0; i < kDepthFormats; ++i) {
        settings[i].zbuffer_memory = &memory;
        settings[i].depth.format = static_cast<DepthFormat>(i);
        jobs.push_back([&, i] { render(wall, reversed.view, settings[i]); });
    }
    const std::vector<double> costs = timeInterleaved(jobs, repeat);
    for (int i = 0; i < kDepthFormats; ++i)
        table.rows.push_back({"a wall", std::string(kDepthFormatNames[i]), 1e-3 * costs[static_cast<size_t>(i)], "ms",
                              "reversed-float", 1e-3 * costs[static_cast<size_t>(DepthFormat::kReversedFloat)]});
}

void addClearing(int repeat, Table& table) {
    DepthBuffer buffer(kWidth, kHeight, 0);
    std::vector<DepthKey> plain(size_t{kWidth} * kHeight);
    const std::vector<double> times = timeInterleaved(
        {[&] { buffer.clear(1); }, [&] { buffer.clear(1, false); }, [&] { std::fill(plain.begin(), plain.end(), 1); }},
        repeat);
    table.rows.push_back({"1920x1080", "clear by the tiles' states", times[0], "us", "filling all depths", times[2]});
}

}  // namespace

Table benchDepth(const Options& options) {
    Table table{"depth", {}};
    const int repeat = options.repeat ? options.repeat : 15;
    if (options.scene) {
        addScene(*options.scene, seededCameras(*options.scene, 4, 1), repeat, table);
        return table;
    }
    addScene(makeCity(1, 10000), cityStreetPath(1, 4), repeat, table);
    addWalls(repeat, table);
    addClearing(repeat, table);
    return table;
}

}  // namespace sightline::bench
