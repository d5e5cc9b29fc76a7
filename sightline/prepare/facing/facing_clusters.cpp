// Makes the records of clusters, from runs of triangles that are given.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/facing/facing_clusters.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/prepare/facing/culling_volume.h"
#include "sightline/prepare/facing/facets.h"
#include "sightline/prepare/facing/facing_cone.h"
#include "sightline/prepare/facing/triangle_masks.h"

namespace sightline {
namespace {

/// Sets a record's numbers in rows.
struct Rows {
    Array<float>& numbers;
    size_t stride, cluster;

    void set(int row, float value) { numbers[static_cast<size_t>(row) * stride + cluster] = value; }
    void set(int row, const glm::vec3& v) {
        for (int axis = 0; axis < 3; ++axis) set(row + axis, v[axis]);
    }
};

void setVolume(Rows rows, const CullingVolume& volume) {
    rows.set(FacingClusters::kOrigin, volume.origin);
    rows.set(FacingClusters::kMost, volume.most);
    rows.set(FacingClusters::kLeast, volume.least);
    rows.set(FacingClusters::kBack, volume.back);
    rows.set(FacingClusters::kFront, volume.front);
}

void setTurned(Rows rows, const TurnedBox& turned) {
    for (int k = 0; k < 3; ++k) rows.set(FacingClusters::kAxes + 3 * k, turned.axes[k]);
    rows.set(FacingClusters::kTurnedMost, turned.most);
    rows.set(FacingClusters::kTurnedLeast, turned.least);
}

void setCone(Rows rows, const FacingCone& cone) {
    rows.set(FacingClusters::kApex, cone.apex);
    rows.set(FacingClusters::kAxis, cone.axis);
    rows.set(FacingClusters::kCutoff, cone.cutoff);
}

Box3d boxOf(const MeshView& mesh, std::span<const uint32_t> triangles) {
    Box3d box;
    for (const uint32_t triangle : triangles)
        for (int k = 0; k < 3; ++k) box.grow(glm::dvec3(mesh.positions[mesh.indices[3 * triangle + k]]));
    return box;
}

Box3d relative(const Box3d& box, const glm::dvec3& origin) { return {box.min - origin, box.max - origin}; }

/// The triangles that can face an eye. A triangle with two equal corners is never drawn.
std::vector<Facet> facetsOf(const MeshView& mesh, std::span<const uint32_t> triangles, const glm::dvec3& origin) {
    std::vector<Facet> facets;
    for (const uint32_t triangle : triangles)
        if (!isDegenerate(mesh, triangle)) facets.push_back(facetOf(mesh, triangle, origin));
    return facets;
}

}  // namespace

Box3d eyeSpace(const Box3d& triangles, double factor) {
    const glm::dvec3 center = triangles.center(), half = 0.5 * (triangles.max - triangles.min);
    const double largest = std::max({half.x, half.y, half.z, 1e-30});
    glm::dvec3 reach;
    for (int axis = 0; axis < 3; ++axis) reach[axis] = factor * std::max(half[axis], 1e-3 * largest);
    return {center - reach, center + reach};
}

FacingClusters describeClusters(const MeshView& mesh, std::span<const uint32_t> triangles,
                                std::span<const uint32_t> sizes, const FacingSettings& settings, Memory* memory) {
    SIGHTLINE_ASSERT(settings.mask_steps <= TriangleMasks::kMaxSteps);
    FacingClusters out(memory);
    out.triangles.assign(triangles.begin(), triangles.end());
    const Box3d box = boxOf(mesh, triangles);
    if (!triangles.empty()) out.origin = box.center();
    const Box3d eyes = relative(eyeSpace(box, settings.eye_space), out.origin);
    out.stride = (sizes.size() + FacingClusters::kPadding - 1) / FacingClusters::kPadding * FacingClusters::kPadding;
    out.volumes.assign(FacingClusters::kVolumeRows * out.stride, 0.0f);
    if (settings.turned) out.turned.assign(FacingClusters::kTurnedRows * out.stride, 0.0f);
    if (settings.cones) out.cones.assign(FacingClusters::kConeRows * out.stride, 0.0f);
    out.mask_steps = settings.mask_steps;
    const glm::dvec3 half = 0.5 * (box.max - box.min);
    if (!triangles.empty()) out.reach = taxicabLength(half) * (1.0 + 1e-12);
    const double longest = std::max({half.x, half.y, half.z});
    if (longest > 0) out.mask_shape = glm::max(half / longest, glm::dvec3(1.0 / 32));
    out.first.push_back(0);
    for (size_t i = 0; i < sizes.size(); ++i) {
        const std::span<const uint32_t> members = triangles.subspan(out.first.back(), sizes[i]);
        const std::vector<Facet> facets = facetsOf(mesh, members, out.origin);
        const Box3d near_by = relative(eyeSpace(boxOf(mesh, members), settings.eye_space), out.origin);
        setVolume({out.volumes, out.stride, i}, makeCullingVolume(facets, settings.near_eyes ? near_by : eyes));
        if (settings.turned) setTurned({out.turned, out.stride, i}, makeTurnedBox(facets));
        if (settings.cones) {
            FacingCone cone = makeFacingCone(facets);
            if (taxicabLength(glm::dvec3(cone.apex)) > 4.0 * out.reach)
                cone = {};  // what is so far away rounds too coarsely
            setCone({out.cones, out.stride, i}, cone);
        }
        if (settings.mask_steps) {
            std::vector<Facet> all;
            for (const uint32_t triangle : members) all.push_back(facetOf(mesh, triangle, out.origin));
            out.masks.push_back(addTriangleMasks(all, out.mask_shape, settings.mask_steps, out.mask_words));
        }
        out.first.push_back(out.first.back() + sizes[i]);
    }
    SIGHTLINE_ASSERT(out.first.back() == triangles.size());
    return out;
}

}  // namespace sightline
