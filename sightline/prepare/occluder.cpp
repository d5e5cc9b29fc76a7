// Makes an occluder from a mesh: its hiding triangles, bit for bit, in clusters of nearby ones.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace sightline {
namespace {

struct Sorter {
    const MeshView& mesh;
    std::vector<glm::vec3> centers;
    std::vector<uint32_t> order;

    /// Splits [first, last) at the median of the longest axis until the runs are small enough, so that each
    /// run is compact. Iterative: meshes of millions of triangles must not exhaust the stack.
    void run(std::vector<uint32_t>& ends) {
        struct Range { uint32_t first, last; };
        std::vector<Range> stack{{0, static_cast<uint32_t>(order.size())}};
        while (!stack.empty()) {
            const Range range = stack.back();
            stack.pop_back();
            const uint32_t count = range.last - range.first;
            if (count <= OccluderCluster::kMaxTriangles / 2) {
                if (count) ends.push_back(range.last);
                continue;
            }
            Box3f box;
            for (uint32_t i = range.first; i < range.last; ++i) box.grow(centers[order[i]]);
            const glm::vec3 size = box.size();
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const uint32_t middle = range.first + count / 2;
            std::nth_element(order.begin() + range.first, order.begin() + middle, order.begin() + range.last,
                             [&](uint32_t a, uint32_t b) {
                                 const float ca = centers[a][axis], cb = centers[b][axis];
                                 return ca != cb ? ca < cb : a < b;
                             });
            stack.push_back({middle, range.last});
            stack.push_back({range.first, middle});
        }
    }
};

bool keeps(const MeshView& mesh, uint32_t triangle) {
    const uint32_t* index = &mesh.indices[3 * size_t{triangle}];
    for (int k = 0; k < 3; ++k) {
        if (index[k] >= mesh.positions.size()) return false;
        const glm::vec3& p = mesh.positions[index[k]];
        if (!std::isfinite(p.x) || !std::isfinite(p.y) || !std::isfinite(p.z)) return false;
    }
    const glm::vec3 &a = mesh.positions[index[0]], &b = mesh.positions[index[1]], &c = mesh.positions[index[2]];
    return a != b && b != c && c != a;
}

/// Adds one cluster; its vertices are those of the run, each position once.
void addCluster(Occluder& out, const MeshView& mesh, std::span<const uint32_t> run,
                std::span<const uint8_t> double_sided) {
    OccluderCluster cluster;
    cluster.first_vertex = static_cast<uint32_t>(out.x.size());
    cluster.first_triangle = out.triangleCount();
    cluster.triangle_count = static_cast<uint32_t>(run.size());
    std::vector<glm::vec3> vertices;
    vertices.reserve(3 * run.size());
    const auto less = [](const glm::vec3& a, const glm::vec3& b) {
        return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z;
    };
    const auto corner = [&](uint32_t triangle, int k) {
        return mesh.positions[mesh.indices[3 * size_t{triangle} + k]] + glm::vec3(0.0f);  // -0 becomes 0
    };
    for (uint32_t triangle : run)
        for (int k = 0; k < 3; ++k) vertices.push_back(corner(triangle, k));
    std::sort(vertices.begin(), vertices.end(), less);
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    for (uint32_t triangle : run) {
        for (int k = 0; k < 3; ++k) {
            const auto at = std::lower_bound(vertices.begin(), vertices.end(), corner(triangle, k), less);
            out.triangles.push_back(static_cast<uint8_t>(at - vertices.begin()));
        }
        const bool both = !double_sided.empty() && double_sided[triangle];
        out.flags.push_back(both ? Occluder::kDoubleSided : 0);
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

Occluder prepareOccluder(const MeshView& mesh, std::span<const uint8_t> hides,
                         std::span<const uint8_t> double_sided) {
    Sorter sorter{mesh, std::vector<glm::vec3>(mesh.triangles()), {}};
    for (uint32_t triangle = 0; triangle < mesh.triangles(); ++triangle) {
        if ((!hides.empty() && !hides[triangle]) || !keeps(mesh, triangle)) continue;
        glm::vec3 sum(0.0f);
        for (int k = 0; k < 3; ++k) sum += mesh.positions[mesh.indices[3 * size_t{triangle} + k]] / 3.0f;
        sorter.centers[triangle] = sum;
        sorter.order.push_back(triangle);
    }
    std::vector<uint32_t> ends;
    sorter.run(ends);
    Occluder out;
    uint32_t first = 0;
    for (uint32_t last : ends) {
        addCluster(out, mesh, std::span(sorter.order).subspan(first, last - first), double_sided);
        first = last;
    }
    return out;
}

}  // namespace sightline
