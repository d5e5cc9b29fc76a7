// Makes what a renderer draws a mesh by, from the mesh and its parts.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/draw_clusters.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "sightline/base/assert.h"
#include "sightline/math/box.h"
#include "sightline/math/finite.h"
#include "sightline/prepare/facing/facets.h"
#include "sightline/prepare/inner/solids.h"

namespace sightline {
namespace {

bool hasFiniteCorners(const MeshView& mesh, uint32_t triangle) {
    for (uint32_t corner = 0; corner < 3; ++corner)
        if (!isFinite(mesh.positions[mesh.indices[3 * triangle + corner]])) return false;
    return true;
}

/// Where a triangle lies, for putting near ones together; one that is not finite, at the origin.
glm::vec3 middleOf(const MeshView& mesh, uint32_t triangle) {
    glm::vec3 sum(0.0f);
    for (uint32_t corner = 0; corner < 3; ++corner) sum += mesh.positions[mesh.indices[3 * triangle + corner]] / 3.0f;
    return isFinite(sum) ? sum : glm::vec3(0.0f);
}

/// Solids of fewer triangles are not worth clusters of their own.
constexpr size_t kFewestOfSolid = 48;

/// A solid that is drawn double-sided: the inner sides are never seen from outside.
struct Closed {
    std::vector<uint32_t> triangles;  ///< those that are double-sided
    Box3f box;                        ///< of all
    bool turned = false;              ///< its triangles wind the other way
};

/// Each triangle is in one at most.
std::vector<Closed> findClosed(const MeshView& mesh, std::span<const MeshPart> parts) {
    std::vector<Closed> found;
    std::vector<uint8_t> double_sided(mesh.triangles(), 0), taken(mesh.triangles(), 0);
    std::vector<uint32_t> given;
    bool any = false;
    for (const MeshPart& part : parts) {
        if (!part.hides) continue;
        any |= part.double_sided;
        for (uint32_t t = part.first; t < part.first + part.count; ++t) {
            double_sided[t] = part.double_sided;
            if (!isDegenerate(mesh, t) && hasFiniteCorners(mesh, t)) given.push_back(t);
        }
    }
    if (!any) return found;
    // By the first of all vertices at the same place.
    std::vector<uint32_t> order, place(mesh.positions.size());
    for (uint32_t i = 0; i < mesh.positions.size(); ++i)
        if (isFinite(mesh.positions[i])) order.push_back(i);
    const auto before = [&](uint32_t a, uint32_t b) {
        const glm::vec3 &p = mesh.positions[a], &q = mesh.positions[b];
        return p.x != q.x ? p.x < q.x : p.y != q.y ? p.y < q.y : p.z != q.z ? p.z < q.z : a < b;
    };
    std::sort(order.begin(), order.end(), before);
    for (size_t i = 0; i < order.size(); ++i)
        place[order[i]] =
            i > 0 && mesh.positions[order[i]] == mesh.positions[order[i - 1]] ? place[order[i - 1]] : order[i];
    for (const bool turned : {false, true}) {
        std::vector<SolidTriangle> triangles;
        for (const uint32_t t : given) {
            const uint32_t* corner = &mesh.indices[3 * size_t{t}];
            triangles.push_back({{place[corner[0]], place[corner[turned ? 2 : 1]], place[corner[turned ? 1 : 2]]}});
        }
        for (const Solid& solid : findSolids(mesh.positions, triangles)) {
            if (solid.triangles.size() < kFewestOfSolid) continue;
            // What is single-sided is drawn as it is given.
            if (turned && std::any_of(solid.triangles.begin(), solid.triangles.end(),
                                      [&](uint32_t i) { return !double_sided[given[i]] || taken[given[i]]; }))
                continue;
            Closed closed;
            closed.turned = turned;
            for (const uint32_t i : solid.triangles) {
                taken[given[i]] = 1;
                if (double_sided[given[i]]) closed.triangles.push_back(given[i]);
                for (const uint32_t vertex : triangles[i].vertex) closed.box.grow(mesh.positions[vertex]);
            }
            std::sort(closed.triangles.begin(), closed.triangles.end());
            if (!closed.triangles.empty()) found.push_back(std::move(closed));
        }
    }
    return found;
}

/// Writes clusters one after the other.
struct Writer {
    const MeshView& mesh;
    const MeshView& facing;  ///< the same, with triangles wound as their solids' outsides want it
    DrawClusters& out;
    std::vector<Box3f> boxes = {};

    void add(std::span<const uint32_t> triangles, uint32_t part) {
        Box3f box;
        for (const uint32_t triangle : triangles)
            for (uint32_t corner = 0; corner < 3; ++corner)
                box.grow(mesh.positions[mesh.indices[3 * triangle + corner]]);
        boxes.push_back(box);
        out.triangles.insert(out.triangles.end(), triangles.begin(), triangles.end());
        out.first.push_back(static_cast<uint32_t>(out.triangles.size()));
        out.part.push_back(part);
    }

    /// Triangles that have backs.
    void addFacing(std::span<const uint32_t> triangles, uint32_t part, const DrawClusterSettings& settings) {
        std::vector<uint32_t> indices;
        for (const uint32_t triangle : triangles)
            for (uint32_t corner = 0; corner < 3; ++corner) indices.push_back(facing.indices[3 * triangle + corner]);
        FacingPartition partition = mergeFacing({mesh.positions, indices}, settings.cost, settings.merge);
        size_t at = 0;
        for (uint32_t& triangle : partition.triangles) triangle = triangles[triangle];
        for (const uint32_t size : partition.sizes) {
            add(std::span(partition.triangles).subspan(at, size), part);
            at += size;
        }
    }

    /// Halves at the median of the longest side, until clusters are small.
    void addNear(std::vector<uint32_t> triangles, uint32_t number, uint32_t most) {
        std::vector<std::span<uint32_t>> jobs;
        if (!triangles.empty()) jobs.push_back(triangles);
        while (!jobs.empty()) {
            const std::span<uint32_t> job = jobs.back();
            jobs.pop_back();
            if (job.size() <= most) {
                add(job, number);
                continue;
            }
            Box3f extent;
            for (const uint32_t triangle : job) extent.grow(middleOf(mesh, triangle));
            const glm::vec3 size = extent.size();
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const size_t half = (job.size() / 2 + most - 1) / most * most;  // whole clusters, as far as they go
            std::nth_element(job.begin(), job.begin() + static_cast<ptrdiff_t>(half), job.end(),
                             [&](uint32_t a, uint32_t b) {
                                 const float at_a = middleOf(mesh, a)[axis], at_b = middleOf(mesh, b)[axis];
                                 return at_a != at_b ? at_a < at_b : a < b;
                             });
            jobs.push_back(job.subspan(half));
            jobs.push_back(job.first(half));
        }
    }

    void finish() {
        const size_t count = out.count();
        out.stride = (count + DrawClusters::kPadding - 1) / DrawClusters::kPadding * DrawClusters::kPadding;
        out.bounds.resize(DrawClusters::kBoundsRows * out.stride);
        for (size_t i = 0; i < out.stride && count > 0; ++i) {
            const Box3f& box = boxes[std::min(i, count - 1)];
            for (int axis = 0; axis < 3; ++axis) {
                out.bounds[static_cast<size_t>(DrawClusters::kMin + axis) * out.stride + i] = box.min[axis];
                out.bounds[static_cast<size_t>(DrawClusters::kMax + axis) * out.stride + i] = box.max[axis];
            }
        }
    }
};

}  // namespace

DrawClusters prepareDrawClusters(const MeshView& mesh, std::span<const MeshPart> parts,
                                 const DrawClusterSettings& settings, Memory* memory) {
    SIGHTLINE_ASSERT(settings.triangles > 0);
    DrawClusters out(memory);
    out.first.push_back(0);
    const std::vector<Closed> closed = findClosed(mesh, parts);
    std::vector<uint32_t> indices(mesh.indices.begin(), mesh.indices.end()), part_of(mesh.triangles(), 0);
    std::vector<uint8_t> is_closed(mesh.triangles(), 0);
    for (const Closed& solid : closed)
        for (const uint32_t t : solid.triangles) {
            is_closed[t] = 1;
            if (solid.turned) std::swap(indices[3 * size_t{t} + 1], indices[3 * size_t{t} + 2]);
        }
    const MeshView facing{mesh.positions, indices};
    Writer writer{mesh, facing, out};
    std::vector<uint32_t> triangles;
    for (uint32_t number = 0; number < parts.size(); ++number) {
        const MeshPart& part = parts[number];
        SIGHTLINE_ASSERT(size_t{part.first} + part.count <= mesh.triangles());
        std::fill_n(part_of.begin() + part.first, part.count, number);
        if (part.double_sided) continue;
        triangles.resize(part.count);
        std::iota(triangles.begin(), triangles.end(), part.first);
        writer.addFacing(triangles, number, settings);
    }
    for (const Closed& solid : closed) {
        const auto first = static_cast<uint32_t>(out.count());
        for (size_t at = 0, end = 0; at < solid.triangles.size(); at = end) {
            const uint32_t number = part_of[solid.triangles[at]];
            while (end < solid.triangles.size() && part_of[solid.triangles[end]] == number) ++end;
            writer.addFacing(std::span(solid.triangles).subspan(at, end - at), number, settings);
        }
        out.closed.push_back({first, static_cast<uint32_t>(out.count()) - first, solid.box});
    }
    std::vector<uint32_t> sizes;
    for (size_t i = 0; i < out.count(); ++i) sizes.push_back(out.first[i + 1] - out.first[i]);
    out.facing = describeClusters(facing, out.triangles, sizes, settings.records, memory);
    for (uint32_t number = 0; number < parts.size(); ++number) {
        const MeshPart& part = parts[number];
        if (!part.double_sided) continue;
        triangles.clear();
        for (uint32_t t = part.first; t < part.first + part.count; ++t)
            if (!is_closed[t]) triangles.push_back(t);
        writer.addNear(triangles, number, settings.triangles);
    }
    writer.finish();
    return out;
}

}  // namespace sightline
