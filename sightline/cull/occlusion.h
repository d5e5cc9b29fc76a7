// Occlusion against the depth tiles: occludee boxes become pixel rectangles, visible occluders are drawn.
// SPDX-License-Identifier: MIT
//
// Hansong Zhang, Dinesh Manocha, Tom Hudson, Kenneth Hoff. Visibility Culling Using Hierarchical Occlusion Maps. 1997.
#pragma once

#include <cstdint>

#include "sightline/buffer/draw/frame.h"
#include "sightline/buffer/tiles.h"

namespace sightline {

struct EyeBoxes;

/// Where eight boxes lie in an occlusion buffer.
struct ScreenAnswer {
    PixelRect rects[8];
    uint32_t doubt = 0;    ///< bit per box: touches the near plane or cannot be projected; it may be visible
    uint32_t outside = 0;  ///< bit per box: surely misses the buffer, and with it the widened viewport
};

/// Projects boxes to the smallest rectangles of whole pixels, with the nearest depth of each box; both are moved
/// to the safe side by more than rounding could have moved them. A box is outside, too, if all of it lies before the near
/// plane or on one side of the view, wherever its other parts lie.
ScreenAnswer projectBoxes(const Screen& screen, const EyeBoxes& boxes);

/// The bounds of up to eight clusters from one on, in the same way.
/// @param object  objectScreen(screen, transform)
/// @param first   [limit: < occluder.clusters.size()]
ScreenAnswer projectClusters(const Screen& object, const Occluder& occluder, uint32_t first);

/// One box in object space, in double, in the same way.
/// @param object  objectScreen(screen, transform)
struct BoxAnswer {
    PixelRect rect;  ///< of a box that is neither in doubt nor outside
    bool doubt = false, outside = false;

    BoxAnswer() = default;
    BoxAnswer(const ScreenAnswer& of, int which)
        : rect(of.rects[which]), doubt(of.doubt >> which & 1), outside(of.outside >> which & 1) {}
};
BoxAnswer projectBox(const Screen& object, const Box3f& box);

/// Whether every drawn point of a box surely lies to the left of a column of pixels, or to the right of its left
/// border. It may be asked about boxes in doubt, too.
/// @param object  the map from the box's space
/// @param x       the column's left border  [pixels]
bool isLeftOf(const Screen& object, const Box3f& box, double x);
bool isRightOf(const Screen& object, const Box3f& box, double x);

/// An object whose occluder is being drawn: its place, and how exactly that place is known.
struct OccluderInstance {
    const Occluder* occluder = nullptr;
    const glm::dmat4* transform = nullptr;  ///< must outlive the frame
    uint64_t transform_hash = 0;
    Screen screen;           ///< objectScreen() of the transform
    ObjectFrame frame;       ///< objectFrame() of it
    double pixel_error = 0;  ///< bound on the rounding of a projected vertex at w = 1 [pixels]
    double depth_error = 0;  ///< bound on the rounding of its w, or of its depth in parallel projection
    bool clips = false;      ///< and of its distance from the near plane: small against the near guard
};

OccluderInstance makeOccluderInstance(const Screen& screen, const Occluder& occluder, const glm::dmat4& transform);

/// Makes what drawCluster() needs of a cluster; false if the cluster's place is known too badly to be sound.
/// @param box  projectClusters() or projectBox() of the cluster's bounds
bool placeCluster(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box, DrawnCluster& drawn);

/// Draws one cluster, unless its place is known too badly to be sound.
/// @param box  projectClusters() or projectBox() of the cluster's bounds
/// @returns triangles offered to the rasterizer
uint32_t drawOccluder(DepthTiles& tiles, const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box);

}  // namespace sightline
