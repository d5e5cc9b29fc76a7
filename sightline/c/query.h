// Queries in C: what can be seen, what it cost, and what has changed since the last answer.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_QUERY_H
#define SIGHTLINE_C_QUERY_H

#include "sightline/c/view.h"
#include "sightline/c/world.h"

#ifdef __cplusplus
extern "C" {
#endif

/** The stages of a query, coarse to fine. Those of cells need a visibility file. */
typedef enum slStage {
    SL_STAGE_PVS = 0, /**< rows of visibility */
    SL_STAGE_PORTALS, /**< windows through portals */
    SL_STAGE_FRUSTUM,
    SL_STAGE_DISTANCE,     /**< not conservative; off unless slQuerySettings.max_distance */
    SL_STAGE_CONTRIBUTION, /**< not conservative; off unless slQuerySettings.contribution */
    SL_STAGE_VOLUMES,      /**< shadows of single occluders; off by default */
    SL_STAGE_OCCLUSION,
    SL_STAGE_LOD, /**< levels of detail; culls under a hard budget alone */
    SL_STAGE_CLUSTERS,
    SL_STAGE_FACING, /**< counts objects whose faces in the view all look away; no bit of slQuerySettings.stages */
    SL_STAGE_COUNT
} slStage;

typedef enum slPortalWindows { SL_BOXES = 0, SL_OCTAGONS, SL_POLYGONS } slPortalWindows;

/** How much a query does. Begin with slDefaultQuerySettings(). */
typedef struct slQuerySettings {
    uint32_t stages;             /**< bit 1 << slStage each */
    slPortalWindows windows;     /**< how closely portals are looked through */
    uint32_t portal_depth;       /**< portals one behind the other; not conservative [0: no limit] */
    uint32_t portal_work;        /**< cells that may be entered; beyond, all are kept */
    double max_distance;         /**< what is farther is culled, although it may be visible [world units; 0: off] */
    double max_distance_fov;     /**< vertical angle that it is meant for [radians; 0: any] */
    double contribution;         /**< what looks smaller is culled, although it may be visible [pixels; 0: off] */
    double hysteresis;           /**< of both, and of levels of detail [share] */
    uint32_t occluder_volumes;   /**< that SL_STAGE_VOLUMES chooses at most */
    uint32_t occluder_triangles; /**< that are drawn at most, nearest first; beyond, nothing hides */
    uint32_t occlusion_size;     /**< longer side of the occlusion buffer [pixels] */
    bool masked;                 /**< less memory per tile, and less hidden */
    double occluder_error;       /**< by which simpler occluders may stand in [pixels of the buffer] */
    double close_gaps;           /**< narrower gaps between occluders count as closed [pixels of the buffer; 0: off] */
    bool faces;                  /**< ask objects by the faces of their boxes */
    bool second_look;            /**< ask objects by their own triangles: slObjectDef.shape */
    uint32_t second_look_polygons; /**< that may be asked; beyond, objects are kept */
    uint32_t cluster_gap; /**< runs of triangles with so few culled ones between them are one draw [triangles] */
    double lod_error;     /**< of the level to draw [pixels; 0: the finest] */
    uint32_t lod_fade;    /**< answers that a fade takes */
    double budget;        /**< of drawing, by the costs below [milliseconds; 0: none] */
    bool hard_budget;     /**< leave out what there is no time for, although it may be visible */
    double cost_object, cost_triangle, cost_vertex, cost_pixel; /**< [nanoseconds] */
    uint32_t bins;                                              /**< strips that threads can share [1 to 16] */
    uint32_t unasked_answers; /**< so long an object may be kept without being asked again [answers] */
    bool proofs;              /**< cull by certificates, by what hid a node or an object before, without drawing */
    bool stateless;           /**< answer each view by itself */
    bool time_stages;         /**< measure each stage */
    uint32_t cookie;
} slQuerySettings;
SL_API slQuerySettings slDefaultQuerySettings(void);

/** The level of detail to draw of an object. */
typedef struct slVisibleLod {
    uint8_t level; /**< 0: the finest */
    uint8_t from;  /**< the level that fades out; `level`: none does */
    float fade;    /**< how much of `level` is in */
    float morph;   /**< how far its vertices are on their way to the next coarser level */
} slVisibleLod;

/** Triangles of a kept object that has clusters. */
typedef struct slDrawRange {
    uint32_t object;       /**< index into slVisibleSet.objects */
    uint32_t first, count; /**< in the order of slClusterTriangles() */
    uint32_t part;         /**< of slClustersDef.parts */
} slDrawRange;

/** An answer. Arrays belong to the query, and hold until it is asked again. */
typedef struct slVisibleSet {
    const slVisible* objects; /**< front to back  [size: count] */
    uint32_t count;
    /** What to draw of the objects that have clusters: all else of them is turned away, outside, or hidden. */
    const slDrawRange* ranges;
    uint32_t range_count;
    const slVisibleLod* lods; /**< [size: count]; null: each is drawn by its finest level */
    const slRect* scissors;   /**< the part of the viewport that may show it  [size: count]; null: nothing is known */
    const char* problem;      /**< why the view could not be used, and all is here; null: it was used */
} slVisibleSet;

typedef struct slStageStats {
    uint64_t tested, culled; /**< objects */
    uint64_t doubt;          /**< kept because the stage could not decide */
    uint64_t nanoseconds;    /**< with slQuerySettings.time_stages */
} slStageStats;

/** What the last answer cost. Of two eyes objects are counted as the left one's, and work is that of both. */
typedef struct slQueryStats {
    slStageStats stages[SL_STAGE_COUNT];
    uint64_t objects, visible;   /**< `visible` and all `culled` make `objects` */
    uint64_t nodes_visited;      /**< of the hierarchy */
    uint64_t occluder_triangles; /**< offered to the rasterizer */
    uint64_t unasked;            /**< nodes and objects kept without a question */
    uint64_t proved;             /**< nodes and objects culled by certificates */
    uint64_t second_looks;       /**< objects asked by their own triangles */
    uint64_t nanoseconds;
    bool budget_spent;      /**< occluders were left out: occluder_triangles */
    bool second_look_spent; /**< objects were not asked: second_look_polygons */
    uint32_t off;           /**< bits of what was switched off by another setting: slOffWords() */
} slQueryStats;

/** What a bit of slQueryStats.off says, as "bins: strips need the stages frustum and occlusion"; null: it is none.
 * @param bit  its number [0 to 31] */
SL_API const char* slOffWords(uint32_t bit);

/** The scratch of one thread, to be kept from frame to frame. It allocates only when world or viewport have grown, or
 * when it remembers more certificates, or more is proposed to it, than ever before. It keeps the memory of the snapshot that it was asked last until it is
 * asked again, or destroyed. */
typedef struct slQuery slQuery;

/** @param hooks  null: none */
SL_API slStatus slCreateQuery(const slHooks* hooks, slQuery** query_out);
SL_API void slDestroyQuery(slQuery* query);

/** What may be seen. Conservative: each object with a visible point is in the answer, in exact projection of the positions
 * given, at any resolution, under any shift of the image up to slView.jitter; but for limits that are said not to be
 * conservative. The same on every processor and with any number of threads, given the same calls before.
 * @param settings  null: slDefaultQuerySettings() */
SL_API slStatus slQueryVisible(slQuery* query, const slSnapshot* snapshot, const slView* view,
                               const slQuerySettings* settings, slVisibleSet* set_out);

/** The same as keys in an array of the caller's.
 * @param keys_out   front to back  [size: capacity]
 * @param count_out  of the answer; more than capacity: SL_NO_ROOM, and slQueryKeys() has all without asking again */
SL_API slStatus slQueryVisibleKeys(slQuery* query, const slSnapshot* snapshot, const slView* view,
                                   const slQuerySettings* settings, uint64_t* keys_out, size_t capacity,
                                   size_t* count_out);
/** The keys of the last answer. */
SL_API slStatus slQueryKeys(const slQuery* query, uint64_t* keys_out, size_t capacity, size_t* count_out);

/** Two eyes. Each sees what slQueryVisible() tells of its view.
 * @param eyes_out  per object of the set: 1 the left eye may see it, 2 the right one, 3 both; the query's, as the set */
SL_API slStatus slQueryStereo(slQuery* query, const slSnapshot* snapshot, const slView* left, const slView* right,
                              const slQuerySettings* settings, slVisibleSet* set_out, const uint8_t** eyes_out);

/** Names objects that somebody else takes to be hidden: a GPU's occlusion queries, an id-buffer of an earlier frame. Nothing of it is
 * believed: answers cull those of them for which they find a certificate. Proposals stand until the next call. Ids that are
 * stale are passed over.
 * @param ids  may be null if count is 0 */
SL_API slStatus slQueryPropose(slQuery* query, const slObjectId* ids, size_t count);

/** Takes over what another query found out for its last view: who hides whom. From then on the teacher draws each of its answers and
 * seeks certificates of all that it finds hidden; this one, for 128 answers, seeks none, and draws nothing but where much comes into
 * sight at once. So ask the teacher for the same view on another thread, while you draw the frame. Nothing that was learned is
 * believed. Neither query is used by another thread meanwhile. */
SL_API slStatus slQueryLearn(slQuery* query, slQuery* teacher);

/** What came into the answer and what left it, since the answer before. */
typedef struct slChanges {
    const slVisible *appeared, *disappeared; /**< the query's, until it is asked again */
    uint32_t appeared_count, disappeared_count;
} slChanges;
SL_API slStatus slQueryChanges(slQuery* query, slChanges* changes_out);

SL_API slStatus slQueryGetStats(const slQuery* query, slQueryStats* stats_out);

/** For each object of the last answer's snapshot, in the order in which they were added: 0 visible, 1 + slStage of the stage that
 * culled it, 255 outside of the view's layers.
 * @param count_out  objects of the snapshot */
SL_API slStatus slQueryReasons(const slQuery* query, uint8_t* reasons_out, size_t capacity, size_t* count_out);

/** The occlusion buffer after the last answer, for pictures. */
typedef struct slDepthImage {
    uint32_t width, height;
    bool perspective;       /**< nearness is 1 / w; else minus the depth */
    const float* nearness;  /**< row 0 at the bottom; the query's, until it is asked again */
    const uint8_t* covered; /**< 1 where there is a depth */
} slDepthImage;
SL_API slStatus slQueryDepthImage(slQuery* query, slDepthImage* image_out);

/** The last answer as the bytes of a file: the view, the settings, the objects that the frustum and the cells left, what they
 * hide with, and what became of each; of two eyes the left one's. `sightline replay FILE` asks it again on any machine, times
 * it and judges it: send it with a report of a wrong or a slow frame. Costs a copy of all that, and a query.
 * Errors: SL_BAD_ARGUMENT: the view could not be used.
 * @param bytes_out  the query's, until it is recorded again or destroyed  [size: count] */
SL_API slStatus slQueryRecord(slQuery* query, const void** bytes_out, size_t* count_out);

#ifdef __cplusplus
}
#endif
#endif
