// Prepared meshes of the C interface.
// SPDX-License-Identifier: MIT
#include "sightline/c/prepared.h"

#include <algorithm>
#include <utility>

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/world_handles.h"

using namespace sightline;
using c::fail;

struct slPrepared {
    c::SharedHooks hooks;
    PreparedMeshes meshes;
    Array<uint64_t> keys;  // of the file's objects, rising

    const PreparedMesh* mesh(uint32_t number) const {
        return number < meshes.meshes.size() ? &meshes.meshes[number] : nullptr;
    }
};

slStatus slOpenPrepared(const slVisibility* file, slPrepared** prepared_out) {
    const slLog log = file ? file->hooks->log() : slLog{};
    if (!file || !prepared_out) return fail(log, SL_BAD_ARGUMENT, __func__, "file or prepared_out is null");
    if (!file->file.hasPrepared())
        return fail(log, SL_BAD_FILE, __func__, "the visibility file holds nothing of meshes");
    Memory* const memory = file->hooks->memory();
    Result<PreparedMeshes> read = file->file.prepared("the visibility file", memory);
    if (!read) return fail(log, SL_BAD_FILE, __func__, read.error().message.c_str());
    const PlacedObjects& objects = file->file.objects();
    Array<uint64_t> keys(memory);
    keys.reserve(objects.size());
    for (size_t i = 0; i < objects.size(); ++i) keys.push_back(objects.key(i));
    *prepared_out = c::makeHandle<slPrepared>(file->hooks, std::move(*read), std::move(keys));
    return SL_OK;
}

void slClosePrepared(slPrepared* prepared) { c::destroyHandle(prepared); }

uint32_t slPreparedMeshes(const slPrepared* prepared) {
    return prepared ? static_cast<uint32_t>(prepared->meshes.meshes.size()) : 0;
}

uint32_t slPreparedMeshOf(const slPrepared* prepared, uint64_t key) {
    if (!prepared) return PreparedMeshes::kNone;
    const auto [first, end] = std::equal_range(prepared->keys.begin(), prepared->keys.end(), key);
    return end - first == 1 ? prepared->meshes.mesh_of_object[static_cast<size_t>(first - prepared->keys.begin())]
                            : PreparedMeshes::kNone;
}

slStatus slAddPrepared(slWorld* world, const slPrepared* prepared, uint32_t mesh, slPreparedIds* ids_out) {
    if (!world || !prepared || !ids_out) return c::failNull(world, __func__);
    const PreparedMesh* from = prepared->mesh(mesh);
    if (!from) return fail(world->log(), SL_BAD_ARGUMENT, __func__, "there is no such mesh");
    *ids_out = {};
    const auto added = [&](OccluderId id) {
        world->occluders = id.index;
        return slOccluderId{id.index};
    };
    if (!from->occluder.clusters.empty())
        ids_out->occluder = added(world->world.addOccluder(from->occluder, from->inner));
    if (from->occluder_is_shape) ids_out->shape = ids_out->occluder;
    else if (from->has_shape) ids_out->shape = added(world->world.addShape(from->shape));
    if (from->clusters.count() > 0)
        ids_out->clusters.index = world->clusters = world->world.addClusters(from->clusters).index;
    if (!from->lods.levels.empty()) ids_out->lods.index = world->lods = world->world.addLods(from->lods.levels).index;
    return SL_OK;
}

const uint32_t* slPreparedTriangles(const slPrepared* prepared, uint32_t mesh, size_t* count_out) {
    const PreparedMesh* from = prepared ? prepared->mesh(mesh) : nullptr;
    const bool has = from && from->clusters.count() > 0;
    if (count_out) *count_out = has ? from->clusters.triangles.size() : 0;
    return has ? from->clusters.triangles.data() : nullptr;
}

const uint32_t* slPreparedLevel(const slPrepared* prepared, uint32_t mesh, uint32_t level, uint32_t part,
                                size_t* count_out) {
    if (count_out) *count_out = 0;
    const PreparedMesh* from = prepared ? prepared->mesh(mesh) : nullptr;
    if (!from || level == 0 || level >= from->lods.levels.size() || part >= from->lods.parts) return nullptr;
    const std::span<const uint32_t> indices = from->lods.indicesOf(level, part);
    if (count_out) *count_out = indices.size();
    return indices.empty() ? nullptr : indices.data();
}
