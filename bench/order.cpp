// Sorting by depth, and the list-priority, area and ray methods beside one another and the plain z-buffer.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "bench/cases.h"
#include "bench/stopwatch.h"
#include "sightline/base/random.h"
#include "sightline/studies/hidden/methods/presort.h"
#include "sightline/studies/hidden/rays/raycast.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"

namespace sightline::bench {
using namespace studies;
namespace {

void addSorting(size_t count, int repeat, Table& table) {
    Random random(3);
    std::vector<SortEntry> keys(count), by_radix, by_comparison, scratch;
    for (uint32_t i = 0; i < count; ++i) keys[i] = {sortKey(random.uniform(-1000, 1000)), i};
    const std::vector<double> times =
        timeInterleaved({[&] {
                             by_radix = keys;
                             radixSort(by_radix, scratch);
                         },
                         [&] {
                             by_comparison = keys;
                             std::sort(by_comparison.begin(), by_comparison.end(),
                                       [](const SortEntry& a, const SortEntry& b) { return a.key < b.key; });
                         }},
                        repeat);
    table.rows.push_back({std::to_string(count) + " keys", "64-bit radix sort", times[0], "us", "std::sort", times[1]});
}

/// Triangles of one item before an eye at the origin, with their own memory.
struct Triangles {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    std::vector<uint8_t> double_sided;

    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
        for (const glm::vec3& p : {a, b, c}) {
            indices.push_back(static_cast<uint32_t>(positions.size()));
            positions.push_back(p);
        }
        double_sided.push_back(1);
    }
    std::vector<DrawItem> items() const {
        DrawItem item;
        item.mesh = {positions, indices};
        item.double_sided = double_sided;
        return {item};
    }
};

/// @param size   of a triangle, in a space 8 wide and 6 high
/// @param depth  how far its corners may be from one another in depth: small ones need few cuts
Triangles randomTriangles(size_t count, double size, double depth) {
    Random random(1);
    Triangles made;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 center(random.uniform(-4, 4), random.uniform(-3, 3), random.uniform(-9, -2));
        glm::vec3 p[3];
        for (glm::vec3& v : p)
            v = glm::vec3(center + glm::dvec3(random.uniform(-size, size), random.uniform(-size, size),
                                              random.uniform(-depth, depth)));
        made.add(p[0], p[1], p[2]);
    }
    return made;
}

View viewOf(uint32_t width, uint32_t height) {
    View view;
    view.width = width;
    view.height = height;
    view.view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
    view.projection = perspective(1.0, double(width) / height, 0.1);
    return view;
}

HiddenImage draw(const DrawList& list, const View& view, HiddenMethod method, RayTracer tracer = RayTracer::kBvh) {
    RenderSettings settings;
    settings.method = method;
    settings.ray_tracer = tracer;
    return render(list, view, settings);
}

void addMethods(const std::string& where, const std::vector<DrawItem>& items, const View& view, int repeat,
                Table& table) {
    const DrawList list(items);
    HiddenImage newell, warnock, rays;
    ZBufferSettings plain{.want_generated = false};
    // Without what can be kept from frame to frame: trees and hierarchies.
    uint64_t tree_time = ~0ull, ray_time = ~0ull, embree_time = ~0ull;
    const auto keepLeast = [](uint64_t& least, const HiddenImage& image) {
        least = std::min(least, image.counters.nanoseconds);
    };
    const std::vector<double> times = timeInterleaved(
        {[&] { newell = draw(list, view, HiddenMethod::kNewell); }, [&] { draw(list, view, HiddenMethod::kPainter); },
         [&] { warnock = draw(list, view, HiddenMethod::kWarnock); }, [&] { renderZBuffer(items, view, plain); },
         [&] { keepLeast(tree_time, draw(list, view, HiddenMethod::kBspBackToFront)); },
         [&] {
             rays = draw(list, view, HiddenMethod::kRaycast);
             keepLeast(ray_time, rays);
         },
         [&] { keepLeast(embree_time, draw(list, view, HiddenMethod::kRaycast, RayTracer::kEmbree)); }},
        repeat);
    const Rows row{table, where};
    row("newell", times[0] * 1e-3, "ms", "painter", times[1] * 1e-3);
    row("newell", times[0] * 1e-3, "ms", "plain z-buffer", times[3] * 1e-3);
    row("newell", times[0] * 1e-3, "ms", "BSP tree, back to front", double(tree_time) * 1e-6);
    row("newell: comparisons", double(newell.counters.comparisons), "pairs", "polygons",
        double(newell.counters.geometry.produced));
    row("newell: splits", double(newell.counters.splits), "cuts", "polygons",
        double(newell.counters.geometry.produced));
    row("warnock", times[2] * 1e-3, "ms", "plain z-buffer", times[3] * 1e-3);
    row("warnock: windows", double(warnock.counters.windows), "windows", "samples", double(warnock.surface.size()));
    const double per_ray = 1.0 / double(std::max<uint64_t>(rays.counters.rays, 1));
    if (hasEmbree())
        row("rays, own hierarchy", double(ray_time) * per_ray, "ns/ray", "Embree", double(embree_time) * per_ray);
}

}  // namespace

Table benchOrder(const Options& options) {
    Table table{"order", {}};
    const int repeat = options.repeat ? options.repeat : 9;
    for (const size_t count : {size_t{1000}, size_t{100000}, size_t{1000000}}) addSorting(count, repeat, table);
    const View view = viewOf(1280, 720);
    const Triangles large = randomTriangles(1000, 1.0, 0.02), crossing = randomTriangles(1000, 1.0, 1.0),
                    many = randomTriangles(50000, 0.1, 0.1);
    addMethods("1,000 large, hardly crossing", large.items(), view, repeat, table);
    addMethods("1,000 large, crossing", crossing.items(), view, repeat, table);
    addMethods("50,000 small", many.items(), view, repeat, table);
    return table;
}

}  // namespace sightline::bench
