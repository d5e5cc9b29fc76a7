// Draws a joined cluster whose polygons are small on the screen, from snapped vertices.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_DENSE_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_DENSE_INL_H
#undef SIGHTLINE_BUFFER_DRAW_DENSE_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_DENSE_INL_H
#endif

#include "sightline/buffer/draw/cluster_draw-inl.h"
#include "sightline/buffer/draw/small_edges-inl.h"
#include "sightline/buffer/draw/small_faces-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// Whether most polygons of a cluster may be expected to be small on the screen, and none is too far to be snapped.
inline bool isDense(const ClusterDraw& c, const Extent& extent) {
    constexpr double kMostPixels = 1024.0, kFarthest = 0x1p20;  // per polygon; [pixels]
    const double count = c.cluster.polygon_count + c.cluster.ring_count;
    return (extent.x1 - extent.x0) * (extent.y1 - extent.y0) < kMostPixels * count && extent.x0 > -kFarthest &&
           extent.y0 > -kFarthest && extent.x1 < kFarthest && extent.y1 < kFarthest && c.drawn.position_error < 0.125;
}

/// A joined cluster whose vertices all have an image, drawn from snapped vertices.
class DenseDraw {
public:
    DenseDraw(const ClusterDraw& c, const Projected& projected)
        : c_(c), extent_(projected.extent), count_(c.cluster.polygon_count + c.cluster.ring_count) {}

    /// Finds which polygons are drawn; false if none can matter.
    bool begin() {
        patch_.reach += kSnap;
        if (!beginPatch(patch_, extent_)) return false;
        snapVertices(c_.x, c_.y, c_.d, c_.cluster.vertex_count, vertices_);
        SmallPolygonsTask task;
        task.polygons = c_.polygons;
        task.count = count_;
        task.vertices = vertices_;
        task.reverse = c_.front < 0;
        task.depth_error = static_cast<float>(c_.drawn.depth_error);
        setUpFaces(patch_, task, faces_);
        return true;
    }

    /// Draws the polygons that wind one way.
    /// @param again  the scratch has been used since begin()
    /// @returns      whether seams are left
    bool draw(int8_t turn, uint32_t source, bool again) {
        if ((turn > 0 ? faces_.forward : faces_.backward) == 0) return false;
        if (again && !beginPatch(patch_, extent_)) return false;
        addDepths(patch_, faces_, turn);
        for (uint32_t i = 0; i < faces_.large_count; ++i)
            if (const uint32_t p = faces_.large[i]; faces_.turn[p] == turn)
                addDepth(patch_, cornersOf(c_, c_.polygons[p]), turn);
        gatherEdges(turn);
        OpenEdges large;
        addSmallEdges(patch_, edges_, large);
        addOpenEdges(patch_, large);
        return coverPatch(patch_, source | SeamEntry::kAllPolygons);
    }

private:
    void gatherEdges(int8_t turn) {
        int8_t drawn[256];
        for (int p = 0; p < 256; ++p) drawn[p] = faces_.turn[p] == turn ? turn : 0;
        static_assert(OccluderCluster::kMaxPolygons <= OccluderEdge::kNone);  // its turn is 0
        const OccluderEdge* edges = c_.drawn.occluder->edges.data() + c_.cluster.first_edge;
        uint32_t count = 0;
        uint16_t open[SmallEdges::kMost];
        for (uint32_t i = 0; i < c_.cluster.edge_count; ++i) {
            open[count] = static_cast<uint16_t>(i);
            count += drawn[edges[i].left] != drawn[edges[i].right];
        }
        for (uint32_t k = 0; k < count; ++k) {
            const OccluderEdge& e = edges[open[k]];
            const SnappedVertex &a = vertices_[e.from], &b = vertices_[e.to];
            edges_.ax[k] = a.x;
            edges_.ay[k] = a.y;
            edges_.bx[k] = b.x;
            edges_.by[k] = b.y;
            edges_.change[k] = static_cast<int8_t>(drawn[e.left] - drawn[e.right]);
        }
        edges_.count = count;
    }

    const ClusterDraw& c_;
    const Extent extent_;
    const uint32_t count_;
    Patch patch_ = makePatch(c_);
    SnappedVertex vertices_[256];
    SmallFaces faces_;
    SmallEdges edges_;
};

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
