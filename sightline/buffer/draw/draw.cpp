// Draws clusters: their open edges, winding numbers in bit planes, depth from the planes of their groups.
// SPDX-License-Identifier: MIT
//
// The argument. Let F be a set of polygons that face the eye, w(p) how many of their images hold the image point p. Crossing an edge
// changes w unless another polygon of F has the same edge the other way round: all but the open edges cancel. So where w is 1 or
// more, a ray through p meets a polygon of F, no farther than the farthest point of F there. w is a sum over the open edges that
// cross the row to the left of p. How much of a pixel that tells is said in cover-inl.h.
#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/buffer/draw/scratch.h"
#include "sightline/buffer/tiles.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/buffer/draw/draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/draw/cluster-inl.h"
#include "sightline/buffer/draw/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// The names of a cluster in the seams that it leaves: of its fronts, and of its polygons that show their backs.
struct SeamNames {
    DepthTiles& tiles;
    const DrawnCluster& cluster;
    const ObjectFrame& frame;
    uint32_t fronts = DepthTiles::kNone, backs = DepthTiles::kNone;

    uint32_t nameOf(uint32_t& name, bool of_backs) {
        if (name == DepthTiles::kNone) {
            name = static_cast<uint32_t>(tiles.drawn.size());
            DrawnCluster& record = tiles.drawn.emplace_back(cluster);
            record.clockwise = (frame.sign < 0) != of_backs;
            record.backs = of_backs;
        }
        return name << 8 | SeamEntry::kAllPolygons;
    }
};

void drawPart(DepthTiles& tiles, const ObjectFrame& frame, const Occluder& occluder, const PlaneMesh::Part& c,
              SeamNames& names) {
    const PlaneMesh& mesh = occluder.planes;
    DrawScratch& scratch = scratchOf(tiles);
    PartView view = viewOf(frame, c, static_cast<float>(tiles.gap));
    alignas(64) int8_t turn[PlaneMesh::kNoGroup + 1] = {};
    const Facing facing = faceGroups(frame, mesh, c, glm::vec3(view.eye), view.away, turn, nullptr);
    if (facing.fronts + facing.backs == 0 || !project(frame, mesh, c, frame.near_guard, view, scratch.image)) return;
    if (findEdges(tiles, frame, occluder, c, view, frame.near_guard, turn, scratch) != Edges::kSome) return;
    const int count = groupDepths<false>(tiles, frame, mesh, c, view, turn, scratch);
    const auto seam = [&](uint32_t tile, uint64_t mask) {
        if (facing.fronts > 0) addSeam(tiles, tile, mask, names.nameOf(names.fronts, false), view.nearest);
        if (facing.backs > 0) addSeam(tiles, tile, mask, names.nameOf(names.backs, true), view.nearest);
    };
    walkRows<2>(tiles, scratch, view.nearest,
                [&](int column, int row, const BlockEdges& edges, const RowWinding<2>& before) HWY_ATTR {
                    alignas(64) uint32_t covered[kBlockHeight], touched[kBlockHeight];
                    if (coverBlock(edges, before, kBlockWidth * column, covered, touched))
                        updateBlock(tiles, column, row, covered, touched, scratch.groups, count, view.nearest,
                                    view.farthest, seam);
                    return false;
                });
}

void drawClusterKernel(DepthTiles& tiles, const DrawnCluster& cluster, const ObjectFrame& frame) {
    const PlaneMesh& mesh = cluster.occluder->planes;
    SeamNames names{tiles, cluster, frame};
    for (uint32_t part = mesh.first_part[cluster.cluster]; part < mesh.first_part[cluster.cluster + 1]; ++part)
        drawPart(tiles, frame, *cluster.occluder, mesh.parts[part], names);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(drawClusterKernel);

void drawCluster(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, const ObjectFrame& frame) {
    SIGHTLINE_DEBUG_ASSERT(cluster.occluder != nullptr && cluster.transform != nullptr);
    SIGHTLINE_DEBUG_ASSERT(cluster.cluster < cluster.occluder->clusters.size());
    SIGHTLINE_DEBUG_ASSERT(cluster.occluder->planes.first_part.size() == cluster.occluder->clusters.size() + 1);
    SIGHTLINE_DEBUG_ASSERT(cluster.position_error >= 0 && cluster.depth_error >= 0);
    SIGHTLINE_DEBUG_ASSERT(tiles.width > 0 && tiles.height > 0);
    if (!frame.usable) return;
    const size_t before = tiles.drawn.size();
    HWY_DYNAMIC_DISPATCH(drawClusterKernel)(tiles, cluster, frame);
    if (tiles.drawn.size() == before) return;
    for (size_t i = before; i < tiles.drawn.size(); ++i)
        tiles.drawn[i].object = static_cast<uint32_t>(tiles.objects.size());
    tiles.objects.push_back(object);
}

}  // namespace sightline
#endif  // HWY_ONCE
