// The occlusion buffer alone in C, for programs that want a rasterizer and no world: draw what hides, ask what is hidden.
// SPDX-License-Identifier: MIT
#ifndef SIGHTLINE_C_BUFFER_H
#define SIGHTLINE_C_BUFFER_H

#include "sightline/c/query.h"

#ifdef __cplusplus
extern "C" {
#endif

/** What the buffer says of a box. Only SL_HIDDEN and SL_OUTSIDE are certain. */
typedef enum slSeen { SL_SEEN = 0, SL_HIDDEN, SL_OUTSIDE } slSeen;

/** The buffer of one thread, to be kept from frame to frame. */
typedef struct slBuffer slBuffer;

/** @param size   longer side; what it hides is hidden at every resolution of the image [pixels, 1 to 8192; 384 is as good as any]
 *  @param hooks  null: none */
SL_API slStatus slCreateBuffer(uint32_t size, const slHooks* hooks, slBuffer** buffer_out);
SL_API void slDestroyBuffer(slBuffer* buffer);

/** Empties it for a view. If the view cannot be used (SL_BAD_ARGUMENT, and the log hears why) it is empty, too: nothing is drawn, and
 * everything is SL_SEEN until the next slBufferBegin(). */
SL_API slStatus slBufferBegin(slBuffer* buffer, const slView* view);

/** Draws an occluder, best the nearest first. The occluder must live until the next slBufferBegin().
 * @param transform      object to world, affine; null: none
 * @param triangles_out  that were drawn; may be null */
SL_API slStatus slBufferDraw(slBuffer* buffer, const slOccluder* occluder, const double transform[16],
                             uint32_t* triangles_out);

/** Asks about boxes in world space.
 * @param seen_out  an slSeen each  [size: count] */
SL_API slStatus slBufferAsk(slBuffer* buffer, const slBox* boxes, size_t count, uint8_t* seen_out);

/** Asks about a box in the space of an object, which is tighter where the object is turned. */
SL_API slStatus slBufferAskOriented(slBuffer* buffer, const slBox* box, const double transform[16], slSeen* seen_out);

/** The buffer as an image; holds until it is used again. */
SL_API slStatus slBufferImage(slBuffer* buffer, slDepthImage* image_out);

#ifdef __cplusplus
}
#endif
#endif
