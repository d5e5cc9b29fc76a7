// Explanations in C: why an object is, or is not, in an answer, as numbers and as a sentence.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_EXPLAIN_H
#define SIGHTLINE_C_EXPLAIN_H

#include "sightline/c/query.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What a query says of one object. */
typedef enum slVerdict {
    SL_NO_SUCH_OBJECT = 0,
    SL_OUTSIDE_LAYERS,
    SL_VISIBLE,
    SL_OUTSIDE_FRUSTUM,
    SL_OCCLUDED,
    SL_TOO_FAR,    /**< although it may be visible */
    SL_TOO_SMALL,  /**< although it may be visible */
    SL_NO_CLUSTER, /**< none of its clusters is left */
    SL_NO_TIME,    /**< although it may be visible */
    SL_NOT_IN_PVS,
    SL_NO_WINDOW, /**< it lies in no window of a portal */
    SL_FACES_AWAY /**< each of its faces in the view is single-sided and looks away */
} slVerdict;

/** An occluder that hides it. */
typedef struct slHider {
    slVisible object;
    double share; /**< of the pixels that the hidden object would have */
} slHider;

#define SL_MOST_HIDERS 16

typedef struct slExplanation {
    slVerdict verdict;
    slVisible object;
    uint32_t together; /**< objects that were culled in one step with it, itself included */
    bool unasked;      /**< the query's last answer kept it without a question; this is what a question finds */
    bool
        proved; /**< the query's last answer culled it by a certificate, which names the hiders; drawing would keep it */
    bool on_screen; /**< its box has an image: `rect` and `depth` hold */
    slRect rect;
    double depth;          /**< of its nearest point, along the direction of view [world units] */
    const char* plane;     /**< of the frustum, that it is farthest outside of: "left"; null: it is not outside */
    double plane_distance; /**< how far outside [world units] */
    /** If it is occluded: occluders that hide it by themselves, and of which none can be left out. */
    slHider hiders[SL_MOST_HIDERS];
    uint32_t hider_count; /**< there may be more than SL_MOST_HIDERS; those with the largest shares are told */
    bool sufficient;      /**< false: no such set was found, and these cover parts of its rectangle */
    const char* because;  /**< why it is kept; null: it is not */
    bool open_pixel;      /**< it is kept because of the pixel at x, y */
    double x, y;          /**< [viewport pixels from the left and the top] */
} slExplanation;

/** Why slQueryVisible() of the same arguments has an object in its answer, or not. What it says was found by trying. The last
 * answer does not change. Costs some tens to hundreds of queries on worlds of few objects.
 * @param settings  null: slDefaultQuerySettings() */
SL_API slStatus slQueryExplain(const slQuery* query, const slSnapshot* snapshot, const slView* view,
                               const slQuerySettings* settings, slObjectId id, slExplanation* explanation_out);

/** The same in a sentence, as "object 7 is hidden by object 1 (100 %)".
 * @param text_out  ends with a zero; cut if it does not fit  [size: capacity]
 * @returns what the whole sentence takes, its zero included */
SL_API size_t slExplanationWords(const slExplanation* explanation, char* text_out, size_t capacity);

#ifdef __cplusplus
}
#endif
#endif
