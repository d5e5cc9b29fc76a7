// Questions without an image in C: whether two points see each other, and what may be seen from a region.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_SIGHT_H
#define SIGHTLINE_C_SIGHT_H

#include "sightline/c/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The scratch of one thread. It keeps the memory of the snapshot that it was asked last until it is asked again, or destroyed. */
typedef struct slSight slSight;

/** @param hooks  null: none */
SL_API slStatus slCreateSight(const slHooks* hooks, slSight** sight_out);
SL_API void slDestroySight(slSight* sight);

/** What does not block. */
typedef struct slSightSettings {
    uint32_t layers;           /**< objects outside of these block nothing */
    const slObjectId* ignored; /**< nor do these: whoever looks, and what he looks at  [size: ignored_count] */
    size_t ignored_count;
    uint32_t cookie;
} slSightSettings;
SL_API slSightSettings slDefaultSightSettings(void);

typedef struct slSightLine {
    bool blocked; /**< false: the points may see each other */
    slVisible by; /**< what blocks; not always the nearest */
} slSightLine;

/** Whether the front of an occluder stands between two points. Conservative: "blocked" means that `to` cannot be seen from
 * `from`.
 * @param settings  null: slDefaultSightSettings() */
SL_API slStatus slSightLook(slSight* sight, const slSnapshot* snapshot, const double from[3], const double to[3],
                            const slSightSettings* settings, slSightLine* line_out);

typedef struct slRegionSet {
    const slVisible* objects; /**< the sight's, until it is asked again */
    uint32_t count;
    bool known; /**< false: nothing is known of that region, and all objects of the layers are here */
} slRegionSet;

/** The objects that may be seen from anywhere in a box, whichever way one looks, by the rows of a visibility file: what a server
 * must tell a player who may be there. Without frustum and occlusion. */
SL_API slStatus slSightFrom(slSight* sight, const slSnapshot* snapshot, const slBox* region, uint32_t layers,
                            slRegionSet* set_out);

#ifdef __cplusplus
}
#endif
#endif
