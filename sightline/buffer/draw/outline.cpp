// Where a cluster may be in the image, and how near: its outline drawn outward, at the nearest depth of its groups.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/draw/outline.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/buffer/draw/outline.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/draw/cluster-inl.h"
#include "sightline/buffer/draw/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// The pixels of a block that the edges touch or go around: all of them where the planes do not hold the winding numbers.
/// @returns whether there are any
template <int kPlanes>
bool touchBlock(const BlockEdges& edges, const RowWinding<kPlanes>& before, int column, uint32_t* pixels) {
    const U u32;
    if (edges.most >= 1 << kPlanes) {
        std::fill_n(pixels, kBlockHeight, ~0u);
        return true;
    }
    VU all = hn::Zero(u32);
    for (size_t k = 0; k < kBlockHeight; k += hn::Lanes(u32)) {
        const BlockRows rows{hn::Shl(hn::Set(u32, 1u), hn::Iota(u32, static_cast<uint32_t>(k))), hn::Set(I(), column),
                             k};
        VU winding[kPlanes], any = hn::Zero(u32);
        for (int p = 0; p < kPlanes; ++p) winding[p] = rows.all(before.plane[p]);
        for (int n = 0; n < edges.count; ++n) {
            const RowEdge& e = edges.row[edges.list[n]];
            countEdge(winding, rows.right(e), e.plus);
            any = hn::Or(any, rows.touched(e));
        }
        for (const VU& of : winding) any = hn::Or(any, of);
        hn::Store(any, u32, pixels + k);
        all = hn::Or(all, any);
    }
    return !hn::AllTrue(u32, hn::Eq(all, hn::Zero(u32)));
}

/// For each tile of a block the most nearness of the groups that may be in it.
void nearnessOfTiles(int column, int row, const GroupDepth* groups, int count, float nearest, float* out) {
    const hn::CappedTag<float, kBlockTiles> f;
    const TileMiddles middles(column, row);
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
        const auto x = hn::Load(f, middles.x + t), y = hn::Load(f, middles.y + t);
        auto z = hn::Set(f, -std::numeric_limits<float>::infinity());
        for (int g = 0; g < count; ++g)
            z = hn::IfThenElse(areIn(f, groups[g].rect, x, y), hn::Max(z, depthAt(f, groups[g], x, y)), z);
        hn::Store(hn::Min(z, hn::Set(f, nearest)), f, out + t);
    }
}

/// One part of a cluster on its way to a sink.
struct OutlineWalk {
    DepthTiles& tiles;
    const ObjectFrame& frame;
    const Occluder& shape;
    const PlaneMesh::Part& part;
    const OutlineOf which;
    OutlineSink& sink;
    Outline& out;
    alignas(64) int8_t turn[PlaneMesh::kNoGroup + 1] = {}, doubt[PlaneMesh::kNoGroup + 1] = {};

    bool give(uint32_t tile, uint64_t mask, float nearness) {
        if (mask == 0 || (which == OutlineOf::kOpen && tiles.base[tile] > nearness)) return true;
        out.ended = !sink.take(tile, mask, nearness);
        return !out.ended;
    }
    bool give(int x, int y, float nearness) {
        const auto column = static_cast<uint32_t>(x / 8), row = static_cast<uint32_t>(y / 8);
        return give(row * tiles.stride + column, uint64_t{1} << (8 * (y % 8) + x % 8), nearness);
    }

    /// The corners of groups that may face the eye, no nearer than they are: that an object is seen shows soonest there.
    void giveCorners(const PartView& view, const PartImage& image) {
        const float width = static_cast<float>(tiles.width), height = static_cast<float>(tiles.height);
        const PlaneMesh& mesh = shape.planes;
        for (uint32_t g = 0; g < part.groups && !out.ended; ++g) {
            if (turn[g] == 0 && doubt[g] == 0) continue;
            const size_t at = size_t{part.first_group} + g;
            for (uint32_t k = 0; k < std::min(mesh.corner_count[at], 4u) && !out.ended; ++k) {
                const uint8_t v = mesh.corners[mesh.first_corner[at] + k];
                const float x = image.x[v], y = image.y[v], w = image.w[v];
                if (!(x >= 0 && y >= 0 && x < width && y < height)) continue;
                if (out.in_view && !frame.perspective) return;
                out.in_view = true;
                if (which == OutlineOf::kOpen && frame.perspective)
                    give(static_cast<int>(x), static_cast<int>(y), (1 - 1e-5f) / (w + view.errors.z));
            }
        }
    }

    /// All pixels of a rectangle, which may reach beside the image.
    void giveRect(const GroupRect& rect, float nearness) {
        const float right = static_cast<float>(tiles.width - 1), top = static_cast<float>(tiles.height - 1);
        if (!(rect.x1 >= 0 && rect.y1 >= 0 && rect.x0 <= right + 1 && rect.y0 <= top + 1)) return;
        const auto pixel = [](float v, float most) { return static_cast<int>(std::clamp(v, 0.0f, most)); };
        const int x0 = pixel(rect.x0, right), y0 = pixel(rect.y0, top), x1 = pixel(rect.x1, right),
                  y1 = pixel(rect.y1, top);
        for (int row = y0 / 8; row <= y1 / 8; ++row)
            for (int column = x0 / 8; column <= x1 / 8; ++column)
                if (!give(static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(column),
                          windowBits(x0, y0, x1, y1, 8 * column, 8 * row), nearness))
                    return;
    }

    void run() {
        DrawScratch& scratch = scratchOf(tiles);
        const PlaneMesh& mesh = shape.planes;
        constexpr float kInfinity = std::numeric_limits<float>::infinity();
        PartView view = viewOf(frame, part, 0);
        const Facing facing = faceGroups(frame, mesh, part, glm::vec3(view.eye), view.away, turn, doubt);
        int drawn = facing.fronts + facing.backs, doubts = facing.doubts;
        if (which == OutlineOf::kBacks) {
            for (uint32_t g = 0; g < part.groups; ++g) turn[g] = turn[g] == 0 && doubt[g] == 0 ? -1 : 0;
            std::fill_n(doubt, part.groups, int8_t{0});
            drawn = static_cast<int>(part.groups) - drawn - doubts;
            doubts = 0;
        }
        if (drawn + doubts == 0) return;
        // Nothing that is drawn is cut off: the guard lies before the near plane.
        if (!project(frame, mesh, part, -frame.near_guard, view, scratch.image)) return;
        if (view.by_floats) {
            giveCorners(view, scratch.image);
            if (out.ended) return;
        }
        const bool all = which != OutlineOf::kOpen;
        const Edges found =
            findEdges(tiles, frame, shape, part, view, -frame.near_guard, turn, scratch, all ? kInfinity : -kInfinity);
        if (found == Edges::kOutside || found == Edges::kHidden) return;
        out.known &= found != Edges::kUnknown && (doubts == 0 || view.by_floats);
        if (!out.known) return;
        for (uint32_t g = 0; g < part.groups && doubts > 0; ++g) {
            if (doubt[g] != 0) giveRect(rectOf(mesh, part, g, true, scratch), view.nearest);
            if (out.ended) return;
        }
        if (found == Edges::kNone) return;
        view.nearest = std::min(view.nearest, frame.nearest);
        const int count = groupDepths<true>(tiles, frame, mesh, part, view, turn, scratch);
        constexpr int kPlanes = 4;
        const auto take = [&](int column, int row, const BlockEdges& edges,
                              const RowWinding<kPlanes>& before) HWY_ATTR {
            alignas(64) uint32_t pixels[kBlockHeight];
            alignas(32) float nearness[kBlockTiles];
            alignas(64) uint64_t masks[kBlockTiles];
            if (!touchBlock(edges, before, kBlockWidth * column, pixels)) return false;
            tilesOf(pixels, masks);
            nearnessOfTiles(column, row, scratch.groups, count, view.nearest, nearness);
            for (uint32_t left = openTiles(tiles, column, row, kInfinity); left != 0; left &= left - 1) {
                const int t = std::countr_zero(left);
                const uint32_t tile =
                    static_cast<uint32_t>(2 * row + t / 4) * tiles.stride + static_cast<uint32_t>(4 * column + t % 4);
                if (!give(tile, masks[t], nearness[t])) return true;
            }
            return false;
        };
        walkRows<kPlanes>(tiles, scratch, all ? kInfinity : std::nextafter(view.nearest, kInfinity), take);
    }
};

void forOutlineKernel(DepthTiles& tiles, const ObjectFrame& frame, const Occluder& shape, uint32_t cluster,
                      OutlineOf which, OutlineSink& sink, Outline& out) {
    const PlaneMesh& mesh = shape.planes;
    for (uint32_t p = mesh.first_part[cluster]; p < mesh.first_part[cluster + 1] && out.known && !out.ended; ++p)
        OutlineWalk{tiles, frame, shape, mesh.parts[p], which, sink, out}.run();
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(forOutlineKernel);

Outline forOutline(DepthTiles& tiles, const ObjectFrame& frame, const Occluder& shape, uint32_t cluster,
                   OutlineOf which, OutlineSink& sink) {
    SIGHTLINE_DEBUG_ASSERT(tiles.width > 0 && tiles.height > 0 && cluster < shape.clusters.size());
    Outline out;
    out.known = frame.usable && shape.planes.is_whole;
    if (out.known) HWY_DYNAMIC_DISPATCH(forOutlineKernel)(tiles, frame, shape, cluster, which, sink, out);
    return out;
}

}  // namespace sightline
#endif  // HWY_ONCE
