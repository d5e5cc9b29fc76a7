// Makes what a renderer draws a mesh by, from the mesh and its parts.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/draw_clusters.h"

#include <algorithm>
#include <numeric>

#include "sightline/base/assert.h"
#include "sightline/math/box.h"

namespace sightline {
namespace {

glm::vec3 cornerSum(const MeshView& mesh, uint32_t triangle) {
    glm::vec3 sum(0.0f);
    for (uint32_t corner = 0; corner < 3; ++corner) sum += mesh.positions[mesh.indices[3 * triangle + corner]];
    return sum;
}

/// Writes clusters one after the other.
struct Writer {
    const MeshView& mesh;
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

    void addSingleSided(const MeshPart& part, uint32_t number, const DrawClusterSettings& settings) {
        const MeshView own{mesh.positions, mesh.indices.subspan(size_t{3} * part.first, size_t{3} * part.count)};
        FacingPartition partition = mergeFacing(own, settings.cost, settings.merge);
        size_t at = 0;
        for (uint32_t& triangle : partition.triangles) triangle += part.first;
        for (const uint32_t size : partition.sizes) {
            add(std::span(partition.triangles).subspan(at, size), number);
            at += size;
        }
    }

    /// Halves at the median of the longest side, until clusters are small.
    void addDoubleSided(const MeshPart& part, uint32_t number, uint32_t most) {
        std::vector<uint32_t> triangles(part.count);
        std::iota(triangles.begin(), triangles.end(), part.first);
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
            for (const uint32_t triangle : job) extent.grow(cornerSum(mesh, triangle));
            const glm::vec3 size = extent.size();
            const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
            const size_t half = (job.size() / 2 + most - 1) / most * most;  // whole clusters, as far as they go
            std::nth_element(job.begin(), job.begin() + static_cast<ptrdiff_t>(half), job.end(),
                             [&](uint32_t a, uint32_t b) {
                                 const float at_a = cornerSum(mesh, a)[axis], at_b = cornerSum(mesh, b)[axis];
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
    Writer writer{mesh, out};
    for (const bool double_sided : {false, true}) {
        for (uint32_t number = 0; number < parts.size(); ++number) {
            const MeshPart& part = parts[number];
            SIGHTLINE_ASSERT(size_t{part.first} + part.count <= mesh.triangles());
            if (part.double_sided != double_sided) continue;
            if (double_sided) writer.addDoubleSided(part, number, settings.triangles);
            else writer.addSingleSided(part, number, settings);
        }
        if (double_sided) continue;
        std::vector<uint32_t> sizes;
        for (size_t i = 0; i < out.count(); ++i) sizes.push_back(out.first[i + 1] - out.first[i]);
        out.facing = describeClusters(mesh, out.triangles, sizes, settings.records, memory);
    }
    writer.finish();
    return out;
}

}  // namespace sightline
