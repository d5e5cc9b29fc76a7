// The edges that bound what is drawn of a cluster, and how they are cut at the near plane.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/buffer/draw/frame.h"
#include "sightline/geom/occluder.h"

namespace sightline {

/// Edges with the change of the winding number from their right to their left, side by side.
struct EdgeList {
    static constexpr int kMost = 960, kRoom = kMost + 16;

    alignas(64) float ax[kRoom], ay[kRoom], bx[kRoom], by[kRoom];  ///< corners  [pixels]
    alignas(64) float r[kRoom];  ///< no corner's image is farther from there  [pixels]
    int change[kRoom];           ///< 1 or -1
    // What rows read: the lower corner, columns a row, what the edge touches beside it, its ends, and within how many columns a
    // middle may be on either side.
    alignas(64) float x[kRoom], y[kRoom], slope[kRoom], half[kRoom], left[kRoom], right[kRoom], beside[kRoom];
    alignas(64) int32_t first[kRoom], last[kRoom], begin[kRoom], end[kRoom], up[kRoom], level[kRoom];
    int count = 0;
    bool full = false;  ///< one had no room

    void add(float x0, float y0, float x1, float y1, float off, int by_many) {
        for (; by_many != 0; by_many += by_many > 0 ? -1 : 1) {
            if (count == kMost) {
                full = true;
                return;
            }
            ax[count] = x0;
            ay[count] = y0;
            bx[count] = x1;
            by[count] = y1;
            r[count] = off;
            change[count++] = by_many > 0 ? 1 : -1;
        }
    }
    /// Fills what is loaded with the last ones.
    void pad() {
        for (int i = count; i < count + 16; ++i) {
            ax[i] = ax[count - 1];
            ay[i] = ay[count - 1];
            bx[i] = bx[count - 1];
            by[i] = by[count - 1];
            r[i] = r[count - 1];
        }
    }
};

/// Where a group may be in the image: a rectangle, and one that stands on its corner.
struct GroupRect {
    float x0 = 3e38f, y0 = 3e38f, x1 = -3e38f, y1 = -3e38f;
    float s0 = 3e38f, t0 = 3e38f, s1 = -3e38f, t1 = -3e38f;  ///< of x + y and x - y

    void grow(float x, float y, float r) {
        const auto take = [](float v, float off, float& low, float& high) {
            low = v - off < low ? v - off : low;
            high = v + off > high ? v + off : high;
        };
        take(x, r, x0, x1);
        take(y, r, y0, y1);
        take(x + y, 2 * r, s0, s1);
        take(x - y, 2 * r, t0, t1);
    }
    GroupRect wider(float by) const {
        return {x0 - by, y0 - by, x1 + by, y1 + by, s0 - 2 * by, t0 - 2 * by, s1 + 2 * by, t1 + 2 * by};
    }
};

/// The images of the vertices of an occluder's cluster in doubles, wherever they are.
struct ExactImage {
    alignas(64) double x[256], y[256], w[256], near[256];  ///< near: before the near guard where it is not less than 0
};

/// Gathers the edges of a part that the near plane cuts, in doubles, with those that close its triangles there.
/// @param image    of the vertices
/// @param turn     per group: 1, -1, or 0: it is not drawn
/// @param reach    what edges touch beside themselves  [pixels]
/// @param rects    per group, of those that are drawn
/// @param nearest  in perspective becomes the nearness of what is nearest
/// @returns false if they are not known
bool cutEdges(const ObjectFrame& frame, const ExactImage& image, const Occluder& occluder, const PlaneMesh::Part& part,
              const int8_t* turn, float width, float height, float reach, EdgeList& edges, GroupRect* rects,
              float& nearest);

}  // namespace sightline
