// Asks whether a cluster may show something: its outline outward, at the nearest depth, against what is drawn.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H
#undef SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H
#else
#define SIGHTLINE_BENCH_ONEPASS_LOOK_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "bench/onepass/ask-inl.h"
#include "bench/onepass/cluster-inl.h"
#include "bench/onepass/cover-inl.h"
#include "bench/onepass/depth-inl.h"
#include "bench/onepass/rows-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {

/// For each tile of a block the most nearness of the groups that may be in it.
void nearnessOfTiles(int column, int row, const GroupDepth* groups, int count, float nearest, float* out) {
    const hn::CappedTag<float, kBlockTiles> f;
    const TileMiddles middles(column, row);
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
        const auto x = hn::Load(f, middles.x + t), y = hn::Load(f, middles.y + t);
        auto z = hn::Zero(f);
        for (int g = 0; g < count; ++g)
            z = hn::IfThenElse(areIn(f, groups[g].rect, x, y), hn::Max(z, depthAt(f, groups[g], x, y)), z);
        hn::Store(hn::Min(z, hn::Set(f, nearest)), f, out + t);
    }
}

/// Whether one of some pixels of a block may show something that is as near as its tile's nearness.
bool arePixelsOpen(const DepthBlocks& image, const DepthBlock& block, const uint32_t* pixels, const float* nearness,
                   BoxBehindPlanes& behind) {
    const hn::CappedTag<float, kBlockTiles> f;
    alignas(64) uint64_t masks[kBlockTiles];
    tilesOf(pixels, masks);
    uint32_t any = 0, whole = 0, open = 0;
    sortMasks(masks, any, whole);
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f))
        open |= bitsOf(f, hn::Le(hn::Load(f, block.base + t), hn::Load(f, nearness + t))) << t;
    for (uint32_t left = any & open; left != 0; left &= left - 1) {
        const int t = std::countr_zero(left);
        if (behind(image, block.plane[t])) continue;
        if ((masks[t] & ~block.seen[t]) != 0 || isTileOpen(block, t, masks[t], image.depths.code(nearness[t])))
            return true;
    }
    return false;
}

/// Whether what the edges bound, with all that they touch, may show something.
bool isOutlineOpen(DepthBlocks& image, DrawScratch& scratch, float nearest, int groups, const AskedBox& box) {
    constexpr int kPlanes = 4;
    BoxBehindPlanes behind(&box);
    const auto take = [&](int column, int row, const BlockEdges& edges, const RowWinding<kPlanes>& before) HWY_ATTR {
        alignas(64) uint32_t pixels[kBlockHeight];
        alignas(32) float nearness[kBlockTiles];
        if (!touchBlock(edges, before, kBlockWidth * column, pixels)) return false;
        const int rows = static_cast<int>(image.height) - kBlockHeight * row,
                  columns = static_cast<int>(image.width) - kBlockWidth * column;
        const uint32_t inside = columns < kBlockWidth ? (1u << columns) - 1 : ~0u;
        for (int y = 0; y < kBlockHeight; ++y) pixels[y] &= y < rows ? inside : 0;
        nearnessOfTiles(column, row, scratch.groups, groups, nearest, nearness);
        return arePixelsOpen(image, image.at(column, row), pixels, nearness, behind);
    };
    return walkRows<kPlanes, false>(image, scratch, nearest * (1 + 1e-6f), take);
}

/// Whether a rectangle of the image, which may reach beside it, is open to a nearness.
bool isRectangleOpen(DepthBlocks& image, const GroupRect& rect, float nearness) {
    const float right = static_cast<float>(image.width - 1), bottom = static_cast<float>(image.height - 1);
    if (!(rect.x1 >= 0 && rect.y1 >= 0 && rect.x0 <= right + 1 && rect.y0 <= bottom + 1)) return false;
    const auto pixel = [](float v, float most) { return static_cast<int>(std::clamp(v, 0.0f, most)); };
    return isOpenKernel(image, pixel(rect.x0, right), pixel(rect.y0, bottom), pixel(rect.x1, right),
                        pixel(rect.y1, bottom), nearness, nullptr);
}

/// Whether a corner of a group that faces the eye is open. That an object is seen shows soonest there.
bool isCornerOpen(DepthBlocks& image, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const int8_t* turn,
                  float near_w, const ClusterImage& projected) {
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    for (uint32_t g = 0; g < c.groups; ++g) {
        if (turn[g] == 0) continue;
        const size_t at = size_t{c.first_group} + g;
        for (uint32_t k = 0; k < std::min(mesh.corner_count[at], 4u); ++k) {
            const uint8_t v = mesh.corners[mesh.first_corner[at] + k];
            const float x = projected.x[v], y = projected.y[v], w = projected.w[v];
            if (w > near_w && x > 0 && y > 0 && x < width && y < height &&
                image.claim(static_cast<int>(x), static_cast<int>(y)) * w < 1)
                return true;
        }
    }
    return false;
}

bool lookKernel(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t index,
                const AskedBox& box, DrawScratch& scratch) {
    SIGHTLINE_DEBUG_ASSERT(index < mesh.clusters.size());
    const PlaneMesh::Cluster& c = mesh.clusters[index];
    ClusterView view = viewOf(frame, frame.near_w * (1 - 1e-6), c);
    alignas(64) int8_t turn[PlaneMesh::kNoGroup + 1] = {}, doubt[PlaneMesh::kNoGroup + 1] = {};
    const int facing = faceGroups(mesh, c, glm::vec3(view.eye), view.away, turn, doubt);
    const bool is_doubtful = std::find(doubt, doubt + c.groups, 1) != doubt + c.groups;
    if ((facing == 0 && !is_doubtful) || !project(frame, mesh, c, view, scratch.image)) return false;
    if (isCornerOpen(image, mesh, c, turn, view.near_w, scratch.image)) return true;
    const Edges found = findEdges(image, frame, mesh, c, view, turn, scratch);
    if (found == Edges::kOutside) return false;
    if (found == Edges::kUnknown || (is_doubtful && !view.by_floats)) return true;
    for (uint32_t g = 0; is_doubtful && g < c.groups; ++g)
        if (doubt[g] != 0 && isRectangleOpen(image, rectOf(mesh, c, g, true, scratch), view.nearest)) return true;
    if (found == Edges::kNone) return false;
    const int count = groupDepths<true>(image, frame, mesh, c, view.eye, turn, view.by_floats, scratch);
    return isOutlineOpen(image, scratch, view.nearest, count, box);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
