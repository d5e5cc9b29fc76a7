// Baking in C: from meshes, and cells if they are known, to the bytes of a visibility file.
// SPDX-License-Identifier: MIT
//
// A library of its own, libsightline-bake: games link libsightline alone, and attach what was baked with slAttach().
#ifndef SIGHTLINE_C_BAKE_BAKE_H
#define SIGHTLINE_C_BAKE_BAKE_H

#include "sightline/c/world.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef struct slBakeMesh {
    slMesh mesh;
    const uint8_t* hides;        /**< per triangle, 0: it may be seen through; null: all hide */
    const uint8_t* double_sided; /**< per triangle; null: as `both_sides` says */
    bool both_sides;
} slBakeMesh;

/** An object as the world will have it: the box around its mesh as slObjectDef.bounds, the same transform, the same key. */
typedef struct slBakeObject {
    uint32_t mesh;        /**< index into slBakeDef.meshes */
    double transform[16]; /**< object to world, affine */
    uint64_t key;
    const char* name; /**< of a door: slFindDoor() asks for it; null: none */
    bool moves;       /**< it may be elsewhere when the game runs: it hides nothing, and is placed by its box then */
} slBakeObject;

/** A room: a box. Its walls are looked at: where one has a hole that nobody marked, a portal is made there. */
typedef struct slBakeCell {
    const char* name; /**< null: none */
    slBox box;
} slBakeCell;

#define SL_NOTHING 0xffffffffu

/** A hole between two rooms. */
typedef struct slBakePortal {
    const char* name;
    uint32_t cells[2];          /**< indices into slBakeDef.cells */
    const double (*corners)[3]; /**< of a flat convex polygon, in order  [size: corner_count] */
    size_t corner_count;        /**< [3 or more] */
    uint32_t door; /**< index into slBakeDef.objects of what shuts it, which `moves`; SL_NOTHING: nothing */
} slBakePortal;

typedef struct slBakeDef {
    const slBakeMesh* meshes;
    size_t mesh_count;
    const slBakeObject* objects;
    size_t object_count;
    const slBakeCell* cells; /**< none: the scene's own walls divide it */
    size_t cell_count;
    const slBakePortal* portals;
    size_t portal_count;
    bool trusted; /**< cells and portals are taken as they are, without a look at the walls */
    uint32_t
        view_cells; /**< also rows of so many boxes of space at most, from each of which objects are seen or not [0: none] */
    /** Places where viewers may be: view cells are the finer the more of them are near, and rows hold everywhere all the
     * same. None: the finer the more room there is.  [world units, some for each view cell, size: eye_count] */
    const double (*eyes)[3];
    size_t eye_count;
    slHooks hooks; /**< `jobs` share the work out; memory is the system's */
    /** Called now and then, on the calling thread. False ends the bake. Null: nobody asks. */
    bool (*progress)(void* user, const char* step, double done);
    void* user;
    uint32_t cookie;
} slBakeDef;
SL_API slBakeDef slDefaultBakeDef(void);

typedef struct slBaked slBaked;

/** Bakes. Deterministic for any number of threads. From seconds to hours: `sightline bake` of the tool tells which.
 * Errors: SL_BAD_ARGUMENT with a sentence, SL_STOPPED, SL_NO_MEMORY. */
SL_API slStatus slBake(const slBakeDef* def, slBaked** baked_out);
/** The bytes of the visibility file: for slOpenVisibility(), or to be written to a disk. */
SL_API const void* slBakedBytes(const slBaked* baked, size_t* size_out);
SL_API uint32_t slBakedCells(const slBaked* baked);
SL_API void slDestroyBaked(slBaked* baked);

#ifdef __cplusplus
}
#endif
#endif
