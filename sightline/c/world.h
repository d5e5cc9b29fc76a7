// A world in C: occluders, objects that come, move and go, baked visibility, and snapshots that never change.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_WORLD_H
#define SIGHTLINE_C_WORLD_H

#include "sightline/c/base.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct slWorld slWorld;           /**< of one thread at a time */
typedef struct slSnapshot slSnapshot;     /**< immutable: any number of threads may ask it */
typedef struct slOccluder slOccluder;     /**< immutable: a mesh as something that hides */
typedef struct slClusters slClusters;     /**< immutable: the clusters that a mesh is drawn by */
typedef struct slVisibility slVisibility; /**< immutable: an opened visibility file */

typedef struct slObjectId {
    uint32_t index, generation;
} slObjectId;
typedef struct slOccluderId {
    uint32_t index;
} slOccluderId;
typedef struct slClustersId {
    uint32_t index;
} slClustersId;
typedef struct slLodsId {
    uint32_t index;
} slLodsId;
typedef struct slDoorId {
    uint32_t index;
} slDoorId;

/** An object as answers name it. */
typedef struct slVisible {
    uint64_t key; /**< yours */
    slObjectId id;
} slVisible;

/** Triangles that belong to the caller; read during the call alone. */
typedef struct slMesh {
    const float* positions; /**< x, y, z of each vertex */
    size_t vertex_count;
    size_t stride;       /**< from one vertex to the next [bytes; 0: 12] */
    const void* indices; /**< three a triangle, counter-clockwise in front; null: the vertices in their order */
    size_t index_count;  /**< a multiple of three */
    size_t index_size;   /**< [bytes: 2 or 4; 0: 4] */
} slMesh;

typedef struct slOccluderDef {
    slMesh mesh;
    const uint8_t* hides;        /**< per triangle, 0: it may be seen through (blended, masked); null: all hide */
    const uint8_t* double_sided; /**< per triangle; null: as `both_sides` says */
    bool both_sides;             /**< all triangles are drawn, and hide, from both sides */
    slLog log;
    uint32_t cookie;
} slOccluderDef;
SL_API slOccluderDef slDefaultOccluderDef(void);

/** Prepares a mesh to hide what is behind it. Only triangles that are surely drawn wherever the object is drawn may hide: not
 * what is blended, masked, skinned, or moved by a shader. Any thread; O(n log n). */
SL_API slStatus slPrepareOccluder(const slOccluderDef* def, slOccluder** occluder_out);
SL_API void slDestroyOccluder(slOccluder* occluder);
/** What of it hides. */
SL_API uint32_t slOccluderTriangles(const slOccluder* occluder);
/** The box around it, in its own space. */
SL_API slBox slOccluderBounds(const slOccluder* occluder);

/** Triangles that are drawn together: of one material. */
typedef struct slMeshPart {
    uint32_t first, count; /**< triangles of the mesh */
    bool double_sided;     /**< is drawn from both sides */
    bool hides;            /**< is opaque */
} slMeshPart;

typedef struct slClustersDef {
    slMesh mesh;
    const slMeshPart* parts; /**< that do not overlap  [size: part_count]; none: one single-sided part that hides */
    size_t part_count;
    slLog log;
    uint32_t cookie;
} slClustersDef;
SL_API slClustersDef slDefaultClustersDef(void);

/** Cuts a mesh into clusters that are culled one by one. Not for what is skinned, or moved by a shader. Any thread; O(n log n). */
SL_API slStatus slPrepareClusters(const slClustersDef* def, slClusters** clusters_out);
SL_API void slDestroyClusters(slClusters* clusters);
/** The order of triangles that slDrawRange counts in: the renderer's index buffer must be put into it.
 * @param count_out  triangles
 * @returns places in the mesh's index buffer / 3 */
SL_API const uint32_t* slClusterTriangles(const slClusters* clusters, size_t* count_out);

typedef struct slWorldDef {
    slHooks hooks;
    uint32_t objects; /**< room for so many from the start [hint] */
    bool volumes;     /**< prepare what SL_STAGE_VOLUMES and slQuerySettings::proofs need */
    uint32_t cookie;
} slWorldDef;
SL_API slWorldDef slDefaultWorldDef(void);

SL_API slStatus slCreateWorld(const slWorldDef* def, slWorld** world_out);
/** Snapshots of it live on. */
SL_API void slDestroyWorld(slWorld* world);

/** Copies an occluder; any number of objects may share it. */
SL_API slStatus slAddOccluder(slWorld* world, const slOccluder* occluder, slOccluderId* id_out);

/** Copies clusters; any number of objects may share them. */
SL_API slStatus slAddClusters(slWorld* world, const slClusters* clusters, slClustersId* id_out);

/** A level of detail: how far its surface and the finest level's are apart at most, and what drawing it takes. */
typedef struct slLod {
    double error; /**< [object units]; the finest has 0 */
    uint32_t triangles, vertices;
} slLod;
/** @param levels  finest first, errors rising  [size: count, 1 to 16] */
SL_API slStatus slAddLods(slWorld* world, const slLod* levels, size_t count, slLodsId* id_out);

/** What an object is when it enters a world. */
typedef struct slObjectDef {
    slBox bounds; /**< of all that may ever be drawn of it: all poses and levels [object units]. Empty or not finite: it
                                is always visible, and never hides */
    double transform
        [16]; /**< object to world, affine. One that mirrors turns the front of its triangles around, as in glTF: a renderer
                                that culls faces as OpenGL does shows their other side */
    uint64_t key;          /**< yours */
    slOccluderId occluder; /**< what it hides with, or null */
    slOccluderId
        shape; /**< an occluder of all triangles that may be drawn of it, by which it is asked more closely; or null.
                                May be `occluder` */
    uint32_t layers;       /**< bit mask, for slView.layers [1] */
    bool always;           /**< limits of distance and size do not cull it */
    double max_distance;   /**< its own limit, in place of the settings' [world units; 0: theirs] */
    double size_factor;    /**< it counts as so many times as large and as near [1] */
    slClustersId clusters; /**< that it is drawn by at its finest level, or null */
    slLodsId lods;         /**< its levels of detail, or null */
    bool hides_in_lods;    /**< `occluder` lies inside of every level, and `shape` holds the triangles of all */
    uint32_t cookie;
} slObjectDef;
SL_API slObjectDef slDefaultObjectDef(void);

SL_API slStatus slAddObject(slWorld* world, const slObjectDef* def, slObjectId* id_out);
/** All, or, if one of them is wrong, none.
 * @param ids_out  [size: count]; or null */
SL_API slStatus slAddObjects(slWorld* world, const slObjectDef* defs, size_t count, slObjectId* ids_out);
SL_API slStatus slMoveObject(slWorld* world, slObjectId id, const double transform[16]);
/** All but those whose ids are stale, which make SL_STALE_ID.
 * @param transforms  16 numbers each  [size: 16 * count] */
SL_API slStatus slMoveObjects(slWorld* world, const slObjectId* ids, const double* transforms, size_t count);
SL_API slStatus slRemoveObject(slWorld* world, slObjectId id);
SL_API uint32_t slObjectCount(const slWorld* world);

/** Opens the bytes of a visibility file, as `sightline bake` writes them. Nothing in them is believed: damaged ones are
 * refused, or answer every question. The bytes must outlive it, and the worlds that it is attached to and their snapshots.
 * @param name   what sentences call the file; may be null
 * @param hooks  null: none */
SL_API slStatus slOpenVisibility(const void* bytes, size_t size, const char* name, const slHooks* hooks,
                                 slVisibility** file_out);
/** After the worlds that it is attached to, and their snapshots. */
SL_API void slCloseVisibility(slVisibility* file);

/** The world has the file's cells, portals, doors and rows from the next commit on, instead of those that it had. Objects are
 * found by their keys. Errors: SL_BAD_FILE if it has no cells. */
SL_API slStatus slAttach(slWorld* world, const slVisibility* file);
SL_API void slDetach(slWorld* world);
/** A door by its name; null if there is none. */
SL_API slDoorId slFindDoor(const slWorld* world, const char* name);
/** @param open  0: shut; 1: open; between: as far as it has slid */
SL_API slStatus slSetDoor(slWorld* world, slDoorId door, double open);

/** The world as it is now. O(changes log^2 objects), and a few bytes an object. */
SL_API slStatus slCommit(slWorld* world, slSnapshot** snapshot_out);
/** Snapshots may be released on any thread, also after their world. */
SL_API void slReleaseSnapshot(slSnapshot* snapshot);
SL_API uint32_t slSnapshotObjects(const slSnapshot* snapshot);

#ifdef __cplusplus
}
#endif
#endif
