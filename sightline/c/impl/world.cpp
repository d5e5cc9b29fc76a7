// Worlds of the C interface: what enters them is checked, and then the library's.
// SPDX-License-Identifier: MIT
#include "sightline/c/world.h"

#include <cstring>
#include <string_view>

#include "sightline/c/impl/convert.h"
#include "sightline/c/impl/handles.h"
#include "sightline/c/impl/world_handles.h"

using namespace sightline;
using c::fail;

slWorldDef slDefaultWorldDef(void) {
    slWorldDef def{};
    def.cookie = c::kWorldCookie;
    def.volumes = WorldDef().volumes;
    return def;
}

slStatus slCreateWorld(const slWorldDef* def, slWorld** world_out) {
    if (!def || !world_out) return fail({}, SL_BAD_ARGUMENT, __func__, "def or world_out is null");
    if (def->cookie != c::kWorldCookie)
        return fail(def->hooks.log, SL_NO_DEFAULTS, __func__, "the def did not begin as slDefaultWorldDef()");
    if (const slStatus status = c::checkHooks(&def->hooks, __func__)) return status;
    const c::SharedHooks hooks = c::shareHooks(&def->hooks);
    WorldDef to;
    to.objects = def->objects;
    to.volumes = def->volumes;
    to.memory = hooks->memory();
    *world_out = c::makeHandle<slWorld>(hooks, World::create(to));
    return SL_OK;
}

void slDestroyWorld(slWorld* world) { c::destroyHandle(world); }

slStatus slAddOccluder(slWorld* world, const slOccluder* occluder, slOccluderId* id_out) {
    if (!world || !occluder || !id_out) return c::failNull(world, __func__);
    const OccluderId id = world->world.addOccluder(occluder->occluder);
    world->occluders = id.index;
    *id_out = {id.index};
    return SL_OK;
}

slStatus slAddClusters(slWorld* world, const slClusters* clusters, slClustersId* id_out) {
    if (!world || !clusters || !id_out) return c::failNull(world, __func__);
    const ClustersId id = world->world.addClusters(clusters->clusters);
    world->clusters = id.index;
    *id_out = {id.index};
    return SL_OK;
}

slStatus slAddLods(slWorld* world, const slLod* levels, size_t count, slLodsId* id_out) {
    if (!world || !levels || !id_out) return c::failNull(world, __func__);
    if (count < 1 || count > kMostLods)
        return fail(world->log(), SL_BAD_ARGUMENT, __func__, "an object has 1 to 16 levels of detail");
    LodLevel copies[kMostLods];
    for (size_t i = 0; i < count; ++i) {
        if (i > 0 && !(levels[i].error >= levels[i - 1].error))
            return fail(world->log(), SL_BAD_ARGUMENT, __func__, "the levels' errors do not rise");
        copies[i] = {levels[i].error, levels[i].triangles, levels[i].vertices};
    }
    const LodsId id = world->world.addLods({copies, count});
    world->lods = id.index;
    *id_out = {id.index};
    return SL_OK;
}

slObjectDef slDefaultObjectDef(void) {
    const ObjectDef standard;
    slObjectDef def{};
    def.bounds = c::box(standard.bounds);
    std::memcpy(def.transform, &standard.transform, sizeof def.transform);
    def.layers = standard.layers;
    def.size_factor = standard.limits.factor;
    def.cookie = c::kObjectCookie;
    return def;
}

namespace {

/// What is wrong with a def, or null.
slStatus check(const slWorld& world, const slObjectDef& def, const char* call) {
    const auto wrong = [&](const char* what) { return fail(world.log(), SL_BAD_ARGUMENT, call, what); };
    if (def.cookie != c::kObjectCookie)
        return fail(world.log(), SL_NO_DEFAULTS, call, "a def did not begin as slDefaultObjectDef()");
    if (c::isProjective(def.transform)) return wrong(c::kProjective);
    if (def.occluder.index > world.occluders) return wrong("def.occluder is none of this world's");
    if (def.shape.index > world.occluders) return wrong("def.shape is none of this world's");
    if (def.clusters.index > world.clusters) return wrong("def.clusters are none of this world's");
    if (def.lods.index > world.lods) return wrong("def.lods are none of this world's");
    return SL_OK;
}

slObjectId addChecked(slWorld& world, const slObjectDef& def) {
    ObjectDef to;
    to.bounds = c::box(def.bounds);
    to.transform = c::matrix(def.transform);
    to.key = def.key;
    to.occluder = {def.occluder.index};
    to.layers = def.layers;
    to.shape = {def.shape.index};
    to.limits = {def.always, def.max_distance, def.size_factor};
    to.clusters = {def.clusters.index};
    to.lods = {def.lods.index};
    to.hides_in_lods = def.hides_in_lods;
    return c::id(world.world.add(to));
}

}  // namespace

slStatus slAddObject(slWorld* world, const slObjectDef* def, slObjectId* id_out) {
    return slAddObjects(world, def, 1, id_out);
}

slStatus slAddObjects(slWorld* world, const slObjectDef* defs, size_t count, slObjectId* ids_out) {
    if (!world || (!defs && count > 0)) return c::failNull(world, __func__);
    for (size_t i = 0; i < count; ++i)
        if (const slStatus status = check(*world, defs[i], __func__)) return status;
    for (size_t i = 0; i < count; ++i) {
        const slObjectId id = addChecked(*world, defs[i]);
        if (ids_out) ids_out[i] = id;
    }
    return SL_OK;
}

slStatus slMoveObject(slWorld* world, slObjectId id, const double transform[16]) {
    return slMoveObjects(world, &id, transform, 1);
}

slStatus slMoveObjects(slWorld* world, const slObjectId* ids, const double* transforms, size_t count) {
    if (!world || ((!ids || !transforms) && count > 0)) return c::failNull(world, __func__);
    for (size_t i = 0; i < count; ++i)
        if (c::isProjective(transforms + 16 * i)) return fail(world->log(), SL_BAD_ARGUMENT, __func__, c::kProjective);
    bool stale = false;
    for (size_t i = 0; i < count; ++i) stale |= !world->world.move(c::id(ids[i]), c::matrix(transforms + 16 * i));
    return stale ? fail(world->log(), SL_STALE_ID, __func__) : SL_OK;
}

slStatus slRemoveObject(slWorld* world, slObjectId id) {
    if (!world) return c::failNull(world, __func__);
    return world->world.remove(c::id(id)) ? SL_OK : fail(world->log(), SL_STALE_ID, __func__);
}

uint32_t slObjectCount(const slWorld* world) { return world ? world->world.objectCount() : 0; }

slStatus slOpenVisibility(const void* bytes, size_t size, const char* name, const slHooks* hooks,
                          slVisibility** file_out) {
    const slLog log = hooks ? hooks->log : slLog{};
    if (!bytes || !file_out) return fail(log, SL_BAD_ARGUMENT, __func__, "bytes or file_out is null");
    if (const slStatus status = c::checkHooks(hooks, __func__)) return status;
    const c::SharedHooks shared = c::shareHooks(hooks);
    Result<VisibilityFile> file = VisibilityFile::open({static_cast<const char*>(bytes), size},
                                                       name ? name : "the visibility file", shared->memory());
    if (!file) return fail(log, SL_BAD_FILE, __func__, file.error().message.c_str());
    *file_out = c::makeHandle<slVisibility>(shared, std::move(*file));
    return SL_OK;
}

void slCloseVisibility(slVisibility* file) { c::destroyHandle(file); }

slStatus slAttach(slWorld* world, const slVisibility* file) {
    if (!world || !file) return c::failNull(world, __func__);
    if (!file->file.hasCells())
        return fail(world->log(), SL_BAD_FILE, __func__, "the visibility file has no cells, as those of Quake's maps");
    const Status status = world->world.attach(file->file);
    return status ? SL_OK : fail(world->log(), SL_BAD_FILE, __func__, status.error().message.c_str());
}

void slDetach(slWorld* world) {
    if (world) world->world.detach();
}

slDoorId slFindDoor(const slWorld* world, const char* name) {
    return world && name ? slDoorId{world->world.findPortal(name).index} : slDoorId{};
}

slStatus slSetDoor(slWorld* world, slDoorId door, double open) {
    if (!world) return c::failNull(world, __func__);
    if (!(open >= 0 && open <= 1)) return fail(world->log(), SL_BAD_ARGUMENT, __func__, "open must be 0 to 1");
    return world->world.setPortal({door.index}, open) ? SL_OK : fail(world->log(), SL_STALE_ID, __func__);
}

slStatus slCommit(slWorld* world, slSnapshot** snapshot_out) {
    if (!world || !snapshot_out) return c::failNull(world, __func__);
    *snapshot_out = c::makeHandle<slSnapshot>(world->hooks, world->world.commit());
    return SL_OK;
}

void slReleaseSnapshot(slSnapshot* snapshot) { c::destroyHandle(snapshot); }

uint32_t slSnapshotObjects(const slSnapshot* snapshot) { return snapshot ? snapshot->snapshot.objectCount() : 0; }
