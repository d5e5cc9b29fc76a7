// Debug drawing in C: what a query saw and left out, as lines that any renderer can show.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_DEBUG_DRAW_H
#define SIGHTLINE_C_DEBUG_DRAW_H

#include "sightline/c/explain.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Who draws. */
typedef struct slDebugDraw {
    /** @param color  0xRRGGBB */
    void (*line)(void* user, const double from[3], const double to[3], uint32_t color);
    void* user;
} slDebugDraw;

enum {
    SL_DRAW_FRUSTUM = 1, /**< of the view: white */
    SL_DRAW_VISIBLE = 2, /**< boxes of what the answer has: green */
    SL_DRAW_CULLED =
        4 /**< boxes of what it has not: red by occlusion, yellow by cells, grey by the frustum, blue by other stages */
};

/** Draws the last answer of a query.
 * @param snapshot, view  of that answer
 * @param what            bits of SL_DRAW_... */
SL_API slStatus slDrawAnswer(const slQuery* query, const slSnapshot* snapshot, const slView* view, uint32_t what,
                             const slDebugDraw* draw);

/** Draws the box of an object, and those of the occluders that hide it: magenta and orange. */
SL_API slStatus slDrawExplanation(const slSnapshot* snapshot, const slExplanation* explanation,
                                  const slDebugDraw* draw);

#ifdef __cplusplus
}
#endif
#endif
