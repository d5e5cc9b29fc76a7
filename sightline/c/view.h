// A view in C: where the eye is, how it projects, and what the caller declares about the frame.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_VIEW_H
#define SIGHTLINE_C_VIEW_H

#include "sightline/c/base.h"

#ifdef __cplusplus
extern "C" {
#endif

/** Matrices and column vectors: element (row r, column c) of 4x4 is m[4 * c + r]. */

/** How a program's matrices project. Which of them say so of themselves is not guessed: the caller declares it. */
typedef enum slClipSpace {
    SL_OPENGL = 0,                   /**< -w <= z <= w */
    SL_DIRECT3D,                     /**< 0 <= z <= w, y up; Metal and WebGPU, too */
    SL_VULKAN,                       /**< 0 <= z <= w, y down */
    SL_DIRECT3D_REVERSED,            /**< near at z = w */
    SL_VULKAN_REVERSED,              /**< near at z = w */
    SL_DIRECT3D_LEFT_HANDED,         /**< the eye looks along +z */
    SL_DIRECT3D_LEFT_HANDED_REVERSED /**< the eye looks along +z, near at z = w */
} slClipSpace;

#define SL_MOST_PLANES 8

/** One eye's view for one frame. Begin with slDefaultView(). The view matrix must be rigid; the projection may be perspective
 * or parallel, off-centre, with a finite or an infinite far plane. A view that breaks a rule hides nothing:
 * slVisibleSet.problem says which rule. */
typedef struct slView {
    double view[16];        /**< world to eye */
    double projection[16];  /**< eye to clip */
    slClipSpace clip_space; /**< of both */
    uint32_t width, height; /**< of the viewport [pixels, >= 1] */
    double jitter;          /**< largest shift of the image that the frame may use [pixels, 0 to 1e6] */
    uint32_t layers;        /**< objects outside of these are neither reported nor hide */
    double
        eye_radius; /**< the answer holds for each eye as near to this one; only rows and, in perspective, distances apply
                                 [world units] */
    /** Planes n, d: what has dot(n, p) + d < 0 is cut away. [limit: SL_MOST_PLANES] */
    double sections[SL_MOST_PLANES][4];
    uint32_t section_count;
    /** Planes that limit the question to what reaches inside of all of them; nothing is cut. */
    double window[SL_MOST_PLANES][4];
    uint32_t window_count;
    uint32_t cookie; /**< of slDefaultView(); leave it alone */
} slView;

/** At the origin, looking along -z, 1280 x 720, OpenGL's clip space, half a pixel of jitter, all layers. The projection is that
 * of slPerspective() with 60 degrees and a near plane at 0.1. */
SL_API slView slDefaultView(void);

/** World to eye of an eye that looks at a target. Right-handed. A null pointer: nothing is written. */
SL_API void slLookAt(double view_out[16], const double eye[3], const double target[3], const double up[3]);

/** OpenGL's perspective.
 * @param fov_y   full vertical angle [radians, in (0, pi)]
 * @param aspect  width / height
 * @param z_far   INFINITY for an infinite far plane */
SL_API void slPerspective(double projection_out[16], double fov_y, double aspect, double z_near, double z_far);

/** OpenGL's parallel projection.
 * @param height  full height of the view volume [world units] */
SL_API void slOrthographic(double projection_out[16], double height, double aspect, double z_near, double z_far);

/** Why a view cannot be used, in words; null: it can. */
SL_API const char* slViewProblem(const slView* view);

#ifdef __cplusplus
}
#endif
#endif
