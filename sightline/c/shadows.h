// Shadow casters in C: which objects can darken what a view shows.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_SHADOWS_H
#define SIGHTLINE_C_SHADOWS_H

#include "sightline/c/query.h"

#ifdef __cplusplus
extern "C" {
#endif

typedef enum slLightKind { SL_SUN = 0, SL_SPOT, SL_POINT_LIGHT } slLightKind;

typedef struct slLight {
    slLightKind kind;
    double direction[3];  /**< in which a sun and a spot shine [not zero] */
    double position[3];   /**< of a spot and of a point light */
    double half_angle;    /**< of a spot [radians, above 0, below 1.5] */
    double z_near, range; /**< of a spot and a point light: nearer casts nothing, farther is not lit [world units] */
    uint32_t cookie;
} slLight;
SL_API slLight slDefaultLight(void);

typedef struct slCasterSettings {
    uint32_t mask_size; /**< of the receivers' mask [texels, 1 to 4096] */
    double filter;      /**< radius of the shadow filter and a texel [world units across a sun's rays] */
    double bias;        /**< of the depth comparison [world units] */
    const double*
        cascades; /**< where a sun's cascades end: rising distances  [size: cascade_count]; null: one without an end */
    uint32_t cascade_count; /**< [limit: 32] */
    bool occlusion;         /**< cull what lies in the shadow of other casters */
    uint32_t cookie;
} slCasterSettings;
SL_API slCasterSettings slDefaultCasterSettings(void);

/** Arrays belong to the shadow query, and hold until it is asked again. */
typedef struct slCasterSet {
    const slVisible* casters;
    const uint32_t* cascades; /**< per caster: bit per cascade, or per face of a point light (+x -x +y -y +z -z) */
    uint32_t count;
    uint64_t in_light; /**< objects that a shadow map without culling would draw */
} slCasterSet;

/** The scratch of one thread. It keeps the memory of the snapshot that it was asked last until it is asked again, or destroyed. */
typedef struct slShadows slShadows;

/** @param hooks  null: none */
SL_API slStatus slCreateShadows(const slHooks* hooks, slShadows** shadows_out);
SL_API void slDestroyShadows(slShadows* shadows);

/** The objects that may darken a point that the view shows. A shadow map that draws these alone shows the same.
 * @param receivers  what the view shows: of slQueryVisible() for the same snapshot and view
 * @param settings   null: slDefaultCasterSettings() */
SL_API slStatus slFindCasters(slShadows* shadows, const slSnapshot* snapshot, const slView* view,
                              const slVisibleSet* receivers, const slLight* light, const slCasterSettings* settings,
                              slCasterSet* set_out);

#ifdef __cplusplus
}
#endif
#endif
