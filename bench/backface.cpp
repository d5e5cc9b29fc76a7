// Back faces: triangle by triangle, by masks of normals, by clusters; what each finds, and what it costs.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <numeric>

#include <fmt/core.h>

#include "bench/cases.h"
#include "bench/facing_meshes.h"
#include "bench/stopwatch.h"
#include "sightline/base/random.h"
#include "sightline/cull/facing_clusters.h"
#include "sightline/prepare/facing/facing_clusters.h"
#include "sightline/prepare/facing/normal_classes.h"
#include "sightline/studies/facing/back_faces.h"
#include "sightline/studies/facing/normal_masks.h"
#include "sightline/studies/hidden/project/facing.h"

namespace sightline::bench {
using namespace studies;
namespace {

constexpr double kAngle = 60.0;  // [degrees]
constexpr int kCells = 16;

struct PlainPlane {
    float n[3], d;
};

/// One triangle after the other.
size_t findPlain(const std::vector<PlainPlane>& planes, const glm::vec3& eye, std::vector<uint8_t>& back) {
    size_t found = 0;
    for (size_t i = 0; i < planes.size(); i += 8) {
        uint32_t byte = 0;
        for (size_t k = 0; k < 8; ++k) {
            const PlainPlane& p = planes[i + k];
            byte |= uint32_t{p.n[0] * eye.x + p.n[1] * eye.y + p.n[2] * eye.z + p.d <= 0.0f} << k;
        }
        back[i / 8] = static_cast<uint8_t>(byte);
        found += byte != 0;
    }
    return found;
}

/// Triangles that face all ways, as records of every kind.
struct Facets {
    TrianglePlanes planes;
    NormalClasses classes;
    std::vector<PlainPlane> plain;
    std::vector<uint8_t> back;

    explicit Facets(size_t count) : back(count / 8) {
        Random random(5);
        planes.count = classes.count = count;
        planes.reach = 3.0;
        classes.cells = kCells;
        for (size_t i = 0; i < count; ++i) {
            glm::dvec3 n;
            do {
                const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
                n = {x, y, random.uniform(-1, 1)};
            } while (glm::dot(n, n) > 1 || glm::dot(n, n) < 0.01);
            n = glm::normalize(n);
            const float d = static_cast<float>(random.uniform(-1, 1));
            planes.x.push_back(static_cast<float>(n.x)), planes.y.push_back(static_cast<float>(n.y));
            planes.z.push_back(static_cast<float>(n.z)), planes.d.push_back(d);
            plain.push_back({{static_cast<float>(n.x), static_cast<float>(n.y), static_cast<float>(n.z)}, d});
            const int number = normalClass(n, kCells);
            classes.byte.push_back(static_cast<uint8_t>(number >> 3));
            classes.bit.push_back(static_cast<uint8_t>(1u << (number & 7)));
        }
    }
};

View viewAt(double angle, bool parallel) {
    View view;
    view.width = view.height = 1000;
    view.view = lookAt({1, 2, 3}, {3, 1, 0}, {0, 1, 0});
    view.projection = parallel ? orthographic(2.0, 1.0, 0.1, 10.0) : perspective(glm::radians(angle), 1.0, 0.1, 10.0);
    return view;
}

void addTimes(size_t count, int passes, int repeat, Table& table) {
    Facets facets(count);
    const View view = viewAt(kAngle, false);
    const FacingEye eye = facingEye(view, glm::dmat4(1.0));
    const NormalMask mask = makeNormalMask(cornerRays(view, glm::dmat4(1.0)), eye.front, kCells);
    const auto often = [passes](auto job) {
        return [=] {
            for (int i = 0; i < passes; ++i) job();
        };
    };
    const std::vector<double> times =
        threadTimes({often([&] { findPlain(facets.plain, glm::vec3(eye.point), facets.back); }),
                     often([&] { findBackFaces(facets.planes, eye, facets.back); }),
                     often([&] { findBackFaces(facets.classes, mask, facets.back); })},
                    repeat);
    const double each = 1e3 / static_cast<double>(count) / passes;
    const std::string where = fmt::format("{} triangles{}", count, count > 1000000 ? ", out of cache" : ", in cache");
    const auto row = [&](const char* what, size_t i, const char* baseline, size_t base) {
        table.rows.push_back({where, what, times[i] * each, "ns/triangle", baseline, times[base] * each});
    };
    row("planes, SIMD", 1, "planes, one by one", 0);
    row("normal masks", 2, "planes, one by one", 0);
    row("normal masks", 2, "planes, SIMD", 1);
}

/// Of triangles of all directions that are seen in the window from the back: those that are found.
double maskRecall(double angle, bool parallel, int sectors) {
    Random random(6);
    View view = viewAt(angle, parallel);
    const auto direction = [&] {
        for (;;) {
            const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
            const glm::dvec3 v(x, y, random.uniform(-1, 1));
            if (glm::dot(v, v) < 1 && glm::dot(v, v) > 0.01) return glm::normalize(v);
        }
    };
    size_t backs = 0, found = 0;
    for (int v = 0; v < 400; ++v) {
        const glm::dvec3 from(1, 2, 3);
        view.view = lookAt(from, from + direction(), direction());
        const FacingEye eye = facingEye(view, glm::dmat4(1.0));
        const SectorMasks masks(view, glm::dmat4(1.0), eye.front, kCells, sectors);
        const glm::dmat4 inverse = glm::inverse(view.projection * view.view);
        for (int i = 0; i < 500; ++i) {
            const double x = random.uniform(-1, 1), y = random.uniform(-1, 1);
            const glm::dvec4 clip = inverse * glm::dvec4(x, y, random.uniform(-1, 1), 1.0);
            const glm::dvec3 p = glm::dvec3(clip) / clip.w, n = direction();
            if (glm::dot(n, eye.point - eye.w * p) > 0) continue;
            ++backs;
            const int sector = masks.sectorOf(glm::vec3(p));
            const int number = normalClass(n, kCells);
            if (sector >= 0)
                found += masks.mask(sector % sectors, sector / sectors).bytes[static_cast<size_t>(number >> 3)] >>
                             (number & 7) &
                         1;
        }
    }
    return static_cast<double>(found) / static_cast<double>(backs);
}

void addMaskRows(int repeat, Table& table) {
    const std::string where = fmt::format("triangles of all directions, N = {}", kCells);
    for (const int sectors : {1, 2, 4, 8})
        table.rows.push_back({where, fmt::format("{0}x{0} sectors, 60 degrees: found", sectors),
                              maskRecall(kAngle, false, sectors), "of back faces", "all", 1.0});
    table.rows.push_back({where, "parallel: found", maskRecall(kAngle, true, 1), "of back faces", "all", 1.0});
    const View view = viewAt(kAngle, false);
    const std::vector<double> times =
        threadTimes({[&] {
                         for (int i = 0; i < 100; ++i)
                             makeNormalMask(cornerRays(view, glm::dmat4(1.0)), FrontFace::kCounterClockwise, kCells);
                     },
                     [&] {
                         for (int i = 0; i < 10; ++i)
                             SectorMasks(view, glm::dmat4(1.0), FrontFace::kCounterClockwise, kCells, 8);
                     }},
                    repeat);
    table.rows.push_back({"a frustum", "making its mask", times[0] / 100, "us", "", 0});
    table.rows.push_back(
        {"a frustum", "making 8x8 sectors' masks", times[1] / 10, "us", "making its mask", times[0] / 100});
}

/// What the pipeline does to know a triangle's facing: its corners into clip space, and the determinant there.
bool passesPipeline(const MeshView& mesh, size_t triangle, const glm::dmat4& to_clip) {
    glm::dvec4 clip[3];
    for (size_t k = 0; k < 3; ++k)
        clip[k] = to_clip * glm::dvec4(glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]), 1.0);
    glm::dvec3 normal;
    return homogeneousFacing(clip[0], clip[1], clip[2], normal) > 0;
}

/// A frame in which each triangle that is left goes through the pipeline's own test.
void addPipelineRows(const FacingMesh& source, int repeat, Table& table) {
    const ClusteredMesh clustered = meshoptClusters(source, 64, 0.5f);
    const MeshView mesh = clustered.mesh.view();
    const size_t count = mesh.triangles();
    std::vector<uint32_t> order(count);
    std::iota(order.begin(), order.end(), 0u);
    const NormalClasses classes = makeNormalClasses(mesh, kCells);
    const FacingClusters clusters = describeClusters(mesh, order, clustered.sizes);
    std::vector<Box3f> boxes((count + 63) / 64);
    for (size_t i = 0; i < mesh.indices.size(); ++i) boxes[i / 192].grow(mesh.positions[mesh.indices[i]]);
    const Box3d box = source.box();
    const glm::dvec3 from =
        box.center() + 1.1 * glm::length(box.max - box.min) * glm::normalize(glm::dvec3(1, 0.4, 0.7));
    View view = viewAt(kAngle, false);
    view.view = lookAt(from, box.center(), {0, 1, 0});
    const glm::dmat4 to_clip = view.projection * view.view, still(1.0);
    const FacingEye eye = facingEye(view, still);
    std::vector<uint8_t> back((count + 63) / 64 * 8), culled((clusters.count() + 15) / 16 * 2);
    size_t fronts[5] = {};
    const auto drawRest = [&](size_t& drawn) {
        drawn = 0;
        for (size_t i = 0; i < count; ++i)
            if (!bitOf(back, i)) drawn += passesPipeline(mesh, i, to_clip);
    };
    const auto bySectors = [&](int sectors) {
        const SectorMasks masks(view, still, eye.front, kCells, sectors);
        for (size_t i = 0; i < boxes.size(); ++i)
            findBackFaces(classes, 64 * i, std::min<size_t>(64, count - 64 * i), masks.maskOf(boxes[i]),
                          std::span(back).subspan(8 * i));
    };
    const std::vector<double> times =
        threadTimes({[&] {
                         fronts[0] = 0;
                         for (size_t i = 0; i < count; ++i) fronts[0] += passesPipeline(mesh, i, to_clip);
                     },
                     [&] {
                         findBackFaces(classes, makeNormalMask(cornerRays(view, still), eye.front, kCells), back);
                         drawRest(fronts[1]);
                     },
                     [&] {
                         bySectors(4);
                         drawRest(fronts[2]);
                     },
                     [&] {
                         bySectors(8);
                         drawRest(fronts[3]);
                     },
                     [&] {
                         findBackClusters(clusters, eye, kAllFacingTests, culled);
                         fronts[4] = 0;
                         for (size_t c = 0; c < clusters.count(); ++c)
                             for (uint32_t i = clusters.first[c]; i < clusters.first[c + 1] && !bitOf(culled, c); ++i)
                                 fronts[4] += passesPipeline(mesh, i, to_clip);
                     }},
                    repeat);
    const double each = 1e3 / static_cast<double>(count);
    const char* const names[5] = {"", "one normal mask, then the pipeline's test",
                                  "4x4 sectors' masks, then the pipeline's test",
                                  "8x8 sectors' masks, then the pipeline's test", "clusters, then the pipeline's test"};
    for (int i = 1; i < 5; ++i) {
        table.rows.push_back(
            {source.name, names[i], times[i] * each, "ns/triangle", "the pipeline's test alone", times[0] * each});
        if (fronts[i] != fronts[0])
            table.faults.push_back(
                fmt::format("{}: {}: {} front faces of {}", source.name, names[i], fronts[i], fronts[0]));
    }
}

}  // namespace

Table benchBackface(const Options& options) {
    Table table{"backface", {}};
    const int repeat = options.repeat ? options.repeat : 15;
    std::vector<FacingMesh> meshes;
    if (options.scene) {
        meshes.push_back(wholeScene(*options.scene));
    } else {
        addTimes(size_t{1} << 12, 1000, repeat, table);
        addTimes(size_t{1} << 22, 1, repeat, table);
        addMaskRows(repeat, table);
        addPipelineRows(bumpyBall("bumpy ball, 360,000 triangles", 300, 0.1, 0.0), repeat, table);
        meshes.push_back(bumpyBall("smooth ball", 80, 0.0, 0.0));
        meshes.push_back(bumpyBall("bumpy ball", 80, 0.1, 0.0));
        meshes.push_back(bumpyBall("rough ball", 80, 0.1, 0.01));
    }
    for (const FacingMesh& mesh : meshes) {
        if (mesh.indices.empty()) continue;
        if (options.scene) addPipelineRows(mesh, repeat, table);
        addClusterRows(mesh, repeat, table);
    }
    return table;
}

}  // namespace sightline::bench
