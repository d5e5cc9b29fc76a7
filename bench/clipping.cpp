// Clipping beside plainer ways to do the same: at a guard band, at six planes, and not at all.
// SPDX-License-Identifier: MIT
#include <algorithm>

#include "bench/cases.h"
#include "bench/flat_boxes.h"
#include "bench/stopwatch.h"
#include "sightline/base/random.h"
#include "sightline/studies/hidden/project/clip.h"
#include "sightline/studies/hidden/project/clip_mesh.h"
#include "sightline/studies/hidden/project/projector.h"
#include "sightline/studies/hidden/project/scan.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
using namespace studies;
using namespace tools;
namespace {

/// What a renderer has to clip: the triangles of objects in the frustum, in clip space.
struct ClipSpaceMesh {
    std::vector<glm::dvec4> vertices;
    std::vector<uint32_t> indices;
};

struct Walk {
    std::vector<View> views;
    std::vector<ClipSpaceMesh> frames;
    std::vector<std::vector<DrawItem>> items;
    size_t triangles = 0;
};

Walk makeWalk(const Scene& scene, const CameraPath& path) {
    Walk walk;
    FlatBoxes flat(objectBoxes(scene));
    for (const CameraFrame& frame : path.frames) {
        const View view = makeView(frame, 1280, 720);
        const glm::dmat4 to_clip = view.projection * view.view;
        ClipSpaceMesh mesh;
        std::vector<DrawItem> items;
        const size_t kept = cullFrustum(makeFrustum(view), flat.arrays, flat.kept);
        for (size_t i = 0; i < kept; ++i) {
            const SceneObject& object = scene.objects[flat.kept[i]];
            const Mesh& source = scene.meshes[object.mesh];
            DrawItem item;
            item.mesh = {source.positions, source.indices};
            item.transform = object.transform;
            items.push_back(item);
            const uint32_t first = static_cast<uint32_t>(mesh.vertices.size());
            for (const glm::vec3& p : source.positions)
                mesh.vertices.push_back(to_clip * object.transform * glm::dvec4(glm::dvec3(p), 1.0));
            for (const uint32_t index : source.indices) mesh.indices.push_back(first + index);
        }
        walk.triangles += mesh.indices.size() / 3;
        walk.views.push_back(view);
        walk.frames.push_back(std::move(mesh));
        walk.items.push_back(std::move(items));
    }
    return walk;
}

/// Every triangle through all planes in turn, without outcodes.
size_t clipNaively(const ClipSpaceMesh& mesh, const ClipVolume& volume) {
    size_t produced = 0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        ClipPolygon polygon;
        polygon.count = 3;
        for (size_t k = 0; k < 3; ++k) polygon.vertices[k] = mesh.vertices[mesh.indices[i + k]];
        for (int plane = 0; plane < volume.count; ++plane) {
            ClipPolygon rest;
            clipToPlane(polygon, volume.planes[plane], rest);
            polygon = rest;
        }
        produced += static_cast<size_t>(std::max(polygon.count - 2, 0));
    }
    return produced;
}

/// Triangles that a plane cuts, as many as are needed to leave the caches' first level.
std::vector<ClipPolygon> cutTriangles(const glm::dvec4& plane) {
    Random random(1);
    std::vector<ClipPolygon> triangles;
    while (triangles.size() < 1000) {
        ClipPolygon triangle;
        triangle.count = 3;
        int inside = 0;
        for (int k = 0; k < 3; ++k) {
            glm::dvec4& v = triangle.vertices[k];
            v = {random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(-5, 5), random.uniform(1, 5)};
            inside += glm::dot(plane, v) >= 0;
        }
        if (inside == 1 || inside == 2) triangles.push_back(triangle);
    }
    return triangles;
}

void addPlaneRow(Table& table, int repeat) {
    const glm::dvec4 plane(0.5, -0.25, 1, 1);
    const std::vector<ClipPolygon> cut = cutTriangles(plane);
    int kept = 0;
    const int rounds = 100;
    const auto clipAll = [&](const glm::dvec4& by) {
        ClipPolygon out;
        for (int round = 0; round < rounds; ++round)
            for (const ClipPolygon& triangle : cut) {
                clipToPlane(triangle, by, out);
                kept += out.count;
            }
    };
    const std::vector<double> times = timeInterleaved({[&] { clipAll(plane); },
                                                       [&] {
                                                           clipAll({0, 0, 0, 1});
                                                       }},
                                                      repeat);
    const double per_triangle = 1e3 / (rounds * static_cast<double>(cut.size()));
    table.rows.push_back({"1000 triangles", "cut at one plane", times[0] * per_triangle, "ns/triangle",
                          "found inside of one plane", times[1] * per_triangle});
}

struct Drawn {
    ProjectorCounters counters;
    uint64_t samples = 0;
};

/// Projects and scans a frame's items, without writing anywhere.
void drawFrame(const View& view, const std::vector<DrawItem>& items, Clipping clipping, bool scans, Drawn& drawn) {
    Projector projector(view, {view.width, view.height, 0, 1, {}}, {.clipping = clipping});
    const int32_t width = static_cast<int32_t>(view.width), height = static_cast<int32_t>(view.height);
    const auto count = [&](int32_t, int32_t begin, int32_t end) { drawn.samples += uint64_t(end - begin); };
    for (const DrawItem& item : items) {
        projector.begin(item);
        ScreenPolygon polygon;
        HomogeneousTriangle triangle;
        for (size_t t = 0; t < item.mesh.triangles(); ++t) {
            if (clipping == Clipping::kClipless) {
                if (projector.projectHomogeneous(t, triangle) && scans)
                    scanHomogeneous(triangle, 0, height, width, count);
            } else if (projector.project(t, polygon) && scans) {
                scanPolygon(polygon.outline(), 0, height, width, count);
            }
        }
    }
    const ProjectorCounters& counters = projector.counters();
    drawn.counters.spared += counters.spared;
    drawn.counters.clipped += counters.clipped;
}

}  // namespace

Table benchClipping(const Options& options) {
    const int repeat = options.repeat ? options.repeat : 15;
    const Scene city = options.scene ? Scene{} : makeCity(1, 10000);
    const Scene& scene = options.scene ? *options.scene : city;
    const CameraPath path = options.scene ? seededCameras(scene, 16, 1) : cityStreetPath(1, 24);
    const Walk walk = makeWalk(scene, path);
    const ClipVolume frustum = frustumVolume(), band = guardBandVolume(ProjectorSettings{}.guard_band);
    ClippedMesh out;
    ClipCounters sum;
    Drawn drawn[3];
    const Clipping ways[3] = {Clipping::kGuardBand, Clipping::kFrustum, Clipping::kClipless};
    const auto clipAll = [&](const ClipVolume& volume) {
        sum = {};
        for (const ClipSpaceMesh& mesh : walk.frames) {
            clipMesh(mesh.vertices, mesh.indices, frustum, volume, out);
            sum.spared += out.counters.spared;
            sum.clipped += out.counters.clipped;
        }
    };
    const auto drawAll = [&](int way, bool scans) {
        drawn[way] = {};
        for (size_t i = 0; i < walk.views.size(); ++i)
            drawFrame(walk.views[i], walk.items[i], ways[way], scans, drawn[way]);
    };
    size_t produced = 0;
    const std::vector<double> times =
        timeInterleaved({[&] {
                             for (const ClipSpaceMesh& mesh : walk.frames) produced += clipNaively(mesh, frustum);
                         },
                         [&] { clipAll(frustum); }, [&] { clipAll(band); }, [&] { drawAll(1, false); },
                         [&] { drawAll(0, false); }, [&] { drawAll(0, true); }, [&] { drawAll(2, true); }},
                        repeat);
    Table table{"clipping", {}};
    const std::string where = options.scene ? scene.name : "city:1:10000, a walk";
    const double each = 1e3 / static_cast<double>(std::max<size_t>(walk.triangles, 1));
    const Rows row{table, where, "ns/triangle", each};
    row("outcodes and six planes", times[1], "six planes for every triangle", times[0]);
    row("outcodes and guard band", times[2], "six planes for every triangle", times[0]);
    row("projector with guard band", times[4], "projector with six planes", times[3]);
    row("drawn without clipping", times[6], "drawn with guard band", times[5]);
    row("outside in part, not clipped", sum.spared, "triangles", "outside in part", sum.spared + sum.clipped);
    row("covered without clipping", drawn[2].samples, "samples", "covered with guard band", drawn[0].samples);
    addPlaneRow(table, repeat);
    return table;
}

}  // namespace sightline::bench
