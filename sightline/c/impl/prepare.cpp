// What the C interface makes of meshes: occluders, and clusters to draw.
// SPDX-License-Identifier: MIT
#include <vector>

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/world_handles.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/prepare/occluder/occluder.h"

using namespace sightline;
using c::fail;

slOccluderDef slDefaultOccluderDef(void) {
    slOccluderDef def{};
    def.cookie = c::kOccluderCookie;
    return def;
}

slStatus slPrepareOccluder(const slOccluderDef* def, slOccluder** occluder_out) {
    if (!def || !occluder_out) return fail({}, SL_BAD_ARGUMENT, __func__, "def or occluder_out is null");
    if (def->cookie != c::kOccluderCookie)
        return fail(def->log, SL_NO_DEFAULTS, __func__, "the def did not begin as slDefaultOccluderDef()");
    c::MeshCopy mesh;
    if (const slStatus status = c::toMesh(def->mesh, def->log, __func__, mesh)) return status;
    const size_t triangles = mesh.view.triangles();
    std::vector<uint8_t> both;
    std::span<const uint8_t> hides, double_sided;
    if (def->hides) hides = {def->hides, triangles};
    if (def->double_sided) {
        double_sided = {def->double_sided, triangles};
    } else if (def->both_sides) {
        both.assign(triangles, 1);
        double_sided = both;
    }
    *occluder_out = c::makeHandle<slOccluder>(c::shareHooks(def->log), prepareOccluder(mesh.view, hides, double_sided));
    return SL_OK;
}

void slDestroyOccluder(slOccluder* occluder) { c::destroyHandle(occluder); }

uint32_t slOccluderTriangles(const slOccluder* occluder) { return occluder ? occluder->occluder.triangleCount() : 0; }

slBox slOccluderBounds(const slOccluder* occluder) {
    const Box3f box = occluder ? occluder->occluder.bounds : Box3f();
    return c::box(Box3d{glm::dvec3(box.min), glm::dvec3(box.max)});
}

slClustersDef slDefaultClustersDef(void) {
    slClustersDef def{};
    def.cookie = c::kClustersCookie;
    return def;
}

slStatus slPrepareClusters(const slClustersDef* def, slClusters** clusters_out) {
    if (!def || !clusters_out) return fail({}, SL_BAD_ARGUMENT, __func__, "def or clusters_out is null");
    if (def->cookie != c::kClustersCookie)
        return fail(def->log, SL_NO_DEFAULTS, __func__, "the def did not begin as slDefaultClustersDef()");
    c::MeshCopy mesh;
    if (const slStatus status = c::toMesh(def->mesh, def->log, __func__, mesh)) return status;
    std::vector<MeshPart> parts;
    const auto triangles = static_cast<uint32_t>(mesh.view.triangles());
    if (!def->parts || def->part_count == 0) parts.push_back({0, triangles});
    std::vector<uint8_t> taken(triangles, 0);
    for (size_t i = 0; def->parts && i < def->part_count; ++i) {
        const slMeshPart& from = def->parts[i];
        if (from.first > triangles || from.count > triangles - from.first)
            return fail(def->log, SL_BAD_ARGUMENT, __func__, "a part reaches beyond the mesh's triangles");
        for (uint32_t t = from.first; t < from.first + from.count; ++t)
            if (taken[t]++) return fail(def->log, SL_BAD_ARGUMENT, __func__, "two parts have the same triangle");
        parts.push_back({from.first, from.count, from.double_sided, from.hides});
    }
    *clusters_out = c::makeHandle<slClusters>(c::shareHooks(def->log), prepareDrawClusters(mesh.view, parts));
    return SL_OK;
}

void slDestroyClusters(slClusters* clusters) { c::destroyHandle(clusters); }

const uint32_t* slClusterTriangles(const slClusters* clusters, size_t* count_out) {
    if (count_out) *count_out = clusters ? clusters->clusters.triangles.size() : 0;
    return clusters ? clusters->clusters.triangles.data() : nullptr;
}
