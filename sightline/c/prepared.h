// What a visibility file holds of meshes, in C: so that a program need not prepare them again.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_PREPARED_H
#define SIGHTLINE_C_PREPARED_H

#include "sightline/c/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Immutable: a copy of what `sightline bake --prepare` wrote of the meshes of a file's objects. */
typedef struct slPrepared slPrepared;

/** Nothing in the file is believed: what is opened can be given to a world and drawn, or is refused. That it is of the meshes
 * that are drawn is not looked at. O(bytes).
 * @param file  not needed any more afterwards
 * Errors: SL_BAD_FILE if it holds nothing of meshes, or something damaged. */
SL_API slStatus slOpenPrepared(const slVisibility* file, slPrepared** prepared_out);
SL_API void slClosePrepared(slPrepared* prepared);

SL_API uint32_t slPreparedMeshes(const slPrepared* prepared);
/** The mesh of an object by its key: below slPreparedMeshes(). UINT32_MAX: nothing is prepared of it, the file has no such object, or
 * it has several. O(log objects). */
SL_API uint32_t slPreparedMeshOf(const slPrepared* prepared, uint64_t key);

/** For slObjectDef; null where the file holds nothing of the kind. */
typedef struct slPreparedIds {
    slOccluderId occluder; /**< with simpler ones inside of it, if the file has them */
    slOccluderId shape;
    slClustersId clusters;
    slLodsId lods;
} slPreparedIds;

/** Gives a mesh to a world: once, for all objects that share it. */
SL_API slStatus slAddPrepared(slWorld* world, const slPrepared* prepared, uint32_t mesh, slPreparedIds* ids_out);

/** As slClusterTriangles(): the order of triangles that slDrawRange counts in; null: the mesh has no clusters.
 * @param count_out  triangles */
SL_API const uint32_t* slPreparedTriangles(const slPrepared* prepared, uint32_t mesh, size_t* count_out);

/** The triangles of a part of the mesh (a material, say) in a level of detail: three indices each, of the mesh's own vertices.
 * @param level      from 1 on: the finest is the mesh itself
 * @param count_out  indices
 * @returns null: there is no such level or part, or nothing of the part is left in it */
SL_API const uint32_t* slPreparedLevel(const slPrepared* prepared, uint32_t mesh, uint32_t level, uint32_t part,
                                       size_t* count_out);

#ifdef __cplusplus
}
#endif
#endif
