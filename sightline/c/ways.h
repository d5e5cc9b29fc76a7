// Ways from one place to others in C: for sound, and for whoever walks.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_WAYS_H
#define SIGHTLINE_C_WAYS_H

#include "sightline/c/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The scratch of one thread. It keeps the memory of the snapshot that it began with until it begins again, or is destroyed. */
typedef struct slWays slWays;

/** @param hooks  null: none */
SL_API slStatus slCreateWays(const slHooks* hooks, slWays** ways_out);
SL_API void slDestroyWays(slWays* ways);

/** Which ways count. */
typedef struct slWaySettings {
    double narrowest; /**< holes whose width is less are no way  [world units] */
    double farthest;  /**< longer ways are not looked for; infinite: all are  [world units] */
    uint32_t cookie;
} slWaySettings;
SL_API slWaySettings slDefaultWaySettings(void);

/** Says where ways begin, and keeps the cells and the doors of a snapshot.
 * @param settings   null: slDefaultWaySettings()
 * @param known_out  false: nothing is known of the place, for it is in no cell, or a wall of the file does not stand as it did */
SL_API slStatus slBeginWays(slWays* ways, const slSnapshot* snapshot, const double place[3],
                            const slWaySettings* settings, bool* known_out);

typedef struct slWay {
    bool known;       /**< false: nothing is known of one of the two places; `connected` is true */
    bool connected;   /**< false: there is none */
    double distance;  /**< along the points; not always of the shortest way  [world units] */
    double narrowest; /**< the width of the narrowest hole that it passes; infinite: it passes none  [world units] */
    const double* points; /**< x, y and z of both places, and between them of each bend  [size: 3 * point_count] */
    uint32_t point_count;
    const uint32_t* cells; /**< that it passes, in order  [size: cell_count] */
    uint32_t cell_count;
} slWay;

/** A way to a place through portals that are open. What `connected` denies holds: each way through the air passes an opaque
 * wall of the cells or a shut door. The arrays are the ways', until they are asked again. */
SL_API slStatus slWayTo(slWays* ways, const double place[3], slWay* way_out);

#ifdef __cplusplus
}
#endif
#endif
