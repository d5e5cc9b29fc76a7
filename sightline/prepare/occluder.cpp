// Makes an occluder from a mesh: its hiding triangles, bit for bit, in pairs and clusters.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder.h"

#include <algorithm>
#include <cmath>

#include "sightline/prepare/quads.h"

namespace sightline {
namespace {

bool less(const glm::vec3& a, const glm::vec3& b) {
    return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
}

/// The position as it is kept: a negative zero becomes zero, so that equal positions have equal bits.
glm::vec3 position(const MeshView& mesh, uint32_t vertex) { return mesh.positions[vertex] + glm::vec3(0.0f); }

bool isUsable(const MeshView& mesh, uint32_t triangle) {
    glm::vec3 v[3];
    for (int k = 0; k < 3; ++k) {
        const uint32_t index = mesh.indices[3 * size_t{triangle} + static_cast<size_t>(k)];
        if (index >= mesh.positions.size()) return false;
        v[k] = position(mesh, index);
        if (!std::isfinite(v[k].x) || !std::isfinite(v[k].y) || !std::isfinite(v[k].z)) return false;
    }
    return v[0] != v[1] && v[1] != v[2] && v[2] != v[0];
}

/// Splits the polygons at the median of the longest axis until the runs are small enough, so that each run is
/// compact; writes the ends of the runs. Iterative: meshes of millions of triangles must not exhaust the stack.
std::vector<uint32_t> sortIntoRuns(const MeshView& mesh, std::vector<MeshPolygon>& polygons) {
    struct Sorted {
        glm::vec3 center;
        MeshPolygon polygon;
    };
    std::vector<Sorted> sorted;
    sorted.reserve(polygons.size());
    for (const MeshPolygon& polygon : polygons) {
        glm::vec3 sum(0.0f);
        for (int k = 0; k < polygon.corners; ++k) sum += position(mesh, polygon.vertex[k]);
        sorted.push_back({sum / static_cast<float>(polygon.corners), polygon});
    }
    struct Range {
        uint32_t first, last;
    };
    std::vector<Range> stack{{0, static_cast<uint32_t>(sorted.size())}};
    std::vector<uint32_t> ends;
    while (!stack.empty()) {
        const Range range = stack.back();
        stack.pop_back();
        const uint32_t count = range.last - range.first;
        if (count <= OccluderCluster::kMaxPolygons) {
            if (count) ends.push_back(range.last);
            continue;
        }
        Box3f box;
        for (uint32_t i = range.first; i < range.last; ++i) box.grow(sorted[i].center);
        const glm::vec3 size = box.size();
        const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        const uint32_t middle = range.first + count / 2;
        std::nth_element(sorted.begin() + range.first, sorted.begin() + middle, sorted.begin() + range.last,
                         [axis](const Sorted& a, const Sorted& b) {
                             return a.center[axis] != b.center[axis] ? a.center[axis] < b.center[axis]
                                                                     : a.polygon.triangle < b.polygon.triangle;
                         });
        stack.push_back({middle, range.last});
        stack.push_back({range.first, middle});
    }
    for (size_t i = 0; i < sorted.size(); ++i) polygons[i] = sorted[i].polygon;
    return ends;
}

/// Adds one cluster; its vertices are those of the run, each position once.
void addCluster(Occluder& out, const MeshView& mesh, std::span<const MeshPolygon> run,
                std::span<const uint8_t> double_sided) {
    OccluderCluster cluster;
    cluster.first_vertex = static_cast<uint32_t>(out.x.size());
    cluster.first_polygon = static_cast<uint32_t>(out.polygons.size());
    cluster.polygon_count = static_cast<uint32_t>(run.size());
    std::vector<glm::vec3> vertices;
    for (const MeshPolygon& polygon : run)
        for (int k = 0; k < polygon.corners; ++k) vertices.push_back(position(mesh, polygon.vertex[k]));
    std::sort(vertices.begin(), vertices.end(), less);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (const MeshPolygon& polygon : run) {
        OccluderPolygon& kept = out.polygons.emplace_back();
        for (int k = 0; k < polygon.corners; ++k) {
            const auto at = std::lower_bound(vertices.begin(), vertices.end(), position(mesh, polygon.vertex[k]), less);
            kept.vertex[k] = static_cast<uint8_t>(at - vertices.begin());
        }
        kept.double_sided = !double_sided.empty() && double_sided[polygon.triangle];
        cluster.triangle_count += static_cast<uint32_t>(polygon.corners - 2);
    }
    cluster.vertex_count = static_cast<uint32_t>(vertices.size());
    while (vertices.size() % 8) vertices.push_back(vertices.back());
    for (const glm::vec3& p : vertices) {
        cluster.bounds.grow(p);
        out.x.push_back(p.x);
        out.y.push_back(p.y);
        out.z.push_back(p.z);
    }
    out.bounds.grow(cluster.bounds);
    out.clusters.push_back(cluster);
}

}  // namespace

Occluder prepareOccluder(const MeshView& mesh, std::span<const uint8_t> hides, std::span<const uint8_t> double_sided) {
    std::vector<uint32_t> triangles;
    for (uint32_t triangle = 0; triangle < mesh.triangles(); ++triangle)
        if ((hides.empty() || hides[triangle]) && isUsable(mesh, triangle)) triangles.push_back(triangle);
    std::vector<MeshPolygon> polygons = pairTriangles(mesh, triangles, double_sided);
    Occluder out;
    uint32_t first = 0;
    for (uint32_t last : sortIntoRuns(mesh, polygons)) {
        addCluster(out, mesh, std::span(polygons).subspan(first, last - first), double_sided);
        first = last;
    }
    return out;
}

}  // namespace sightline
