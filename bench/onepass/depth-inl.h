// The depth of groups in the image, and how blocks take it in.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H
#undef SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H
#else
#define SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H
#endif

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "bench/onepass/frame.h"
#include "bench/onepass/lanes-inl.h"
#include "bench/onepass/scratch.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {
/// A plane that is h below the eye has nearness -(to_image * normal) / h; of points that may lie off it, no less than that of
/// the plane that is farther from the eye by as much.
void planesOf(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const glm::dvec3& eye,
              float width, float height, GroupPlanes& out) {
    const hn::CappedTag<double, 8> d;
    const hn::Rebind<float, decltype(d)> f;
    const auto set = [&](double v) HWY_ATTR { return hn::Set(d, v); };
    for (uint32_t g = 0; g < c.groups; g += static_cast<uint32_t>(hn::Lanes(d))) {
        const size_t at = size_t{c.first_group} + g;
        const auto load = [&](const std::vector<float>& from)
                              HWY_ATTR { return hn::PromoteTo(d, hn::LoadU(f, &from[at])); };
        const auto nx = load(mesh.nx), ny = load(mesh.ny), nz = load(mesh.nz);
        const auto dot = [&](double x, double y, double z) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(nx, set(x)), hn::Mul(ny, set(y))), hn::Mul(nz, set(z)));
        };
        const auto h = hn::Sub(dot(eye.x, eye.y, eye.z), load(mesh.nd));
        const auto away = hn::Add(hn::Abs(h), load(mesh.thick));
        const auto scale = hn::Div(hn::IfThenElse(hn::Gt(h, hn::Zero(d)), set(-1), set(1)), away);
        const glm::dmat3& m = frame.to_image;
        const auto a = hn::Mul(dot(m[0][0], m[1][0], m[2][0]), scale),
                   b = hn::Mul(dot(m[0][1], m[1][1], m[2][1]), scale),
                   e = hn::Mul(dot(m[0][2], m[1][2], m[2][2]), scale);
        // Rounding of the three to floats, and of what is computed with them.
        const auto size =
            hn::Add(hn::Add(hn::Mul(hn::Abs(a), set(width)), hn::Mul(hn::Abs(b), set(height))), hn::Abs(e));
        hn::StoreU(hn::DemoteTo(f, a), f, out.a + g);
        hn::StoreU(hn::DemoteTo(f, b), f, out.b + g);
        hn::StoreU(hn::DemoteTo(f, hn::Sub(e, hn::Mul(size, set(0x1p-20)))), f, out.c + g);
    }
}

/// Raises codes of pixels.
void raiseCodes(DepthBlock& block, const uint32_t* rows, const uint16_t (&codes)[kBlockTiles]) {
    const hn::CappedTag<uint16_t, 32> d;
    alignas(64) uint16_t of_half[2][kBlockWidth];
    for (int x = 0; x < kBlockWidth; ++x)
        for (int half = 0; half < 2; ++half) of_half[half][x] = codes[4 * half + x / 8];
    for (int y = 0; y < kBlockHeight; ++y) {
        if (rows[y] == 0) continue;
        for (size_t x = 0; x < kBlockWidth; x += hn::Lanes(d)) {
            uint8_t bits[8] = {};
            const uint32_t left = rows[y] >> x;
            std::memcpy(bits, &left, sizeof left);
            const auto was = hn::Load(d, block.codes[y] + x);
            const auto is = hn::Max(was, hn::Load(d, of_half[y / 8] + x));
            hn::Store(hn::IfThenElse(hn::LoadMaskBits(d, bits), is, was), d, block.codes[y] + x);
        }
    }
}

void clearCodes(DepthBlock& block, int tile) {
    for (int y = 0; y < 8; ++y) std::memset(&block.codes[8 * (tile / 4) + y][8 * (tile % 4)], 0, 8 * sizeof(uint16_t));
}

uint16_t leastCode(const DepthBlock& block, int tile) {
    const hn::CappedTag<uint16_t, 8> d;
    const uint16_t* at = &block.codes[8 * (tile / 4)][8 * (tile % 4)];
    uint16_t all[8];
    for (size_t x = 0; x < 8; x += hn::Lanes(d)) {
        auto least = hn::Load(d, at + x);
        for (int y = 1; y < 8; ++y) least = hn::Min(least, hn::Load(d, at + kBlockWidth * y + x));
        hn::StoreU(least, d, all + x);
    }
    return *std::min_element(all, all + 8);
}

/// For each tile of a block the least depth of the groups that may be in it, how many those are, and the last of them.
struct TileDepths {
    alignas(32) float z[kBlockTiles], meets[kBlockTiles], last[kBlockTiles];
};

void depthOfTiles(int column, int row, const GroupDepth* groups, int count, TileDepths& out) {
    const hn::CappedTag<float, 8> f;
    alignas(32) static constexpr float kX[kBlockTiles] = {4, 12, 20, 28, 4, 12, 20, 28},
                                       kY[kBlockTiles] = {4, 4, 4, 4, 12, 12, 12, 12};
    const float x0 = static_cast<float>(kBlockWidth * column), y0 = static_cast<float>(kBlockHeight * row);
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
        const auto x = hn::Add(hn::Load(f, kX + t), hn::Set(f, x0)), y = hn::Add(hn::Load(f, kY + t), hn::Set(f, y0));
        auto z = hn::Set(f, std::numeric_limits<float>::infinity()), meets = hn::Zero(f), last = hn::Zero(f);
        for (int g = 0; g < count; ++g) {
            const GroupDepth& of = groups[g];
            const auto near_by =
                hn::And(hn::And(hn::Ge(x, hn::Set(f, of.rect.x0 - 5)), hn::Le(x, hn::Set(f, of.rect.x1 + 5))),
                        hn::And(hn::Ge(y, hn::Set(f, of.rect.y0 - 5)), hn::Le(y, hn::Set(f, of.rect.y1 + 5))));
            const auto depth = hn::Add(hn::Add(hn::Mul(hn::Set(f, of.plane.a), x), hn::Mul(hn::Set(f, of.plane.b), y)),
                                       hn::Set(f, of.least));
            z = hn::IfThenElse(near_by, hn::Min(z, depth), z);
            meets = hn::Add(meets, hn::IfThenElseZero(near_by, hn::Set(f, 1.0f)));
            last = hn::IfThenElse(near_by, hn::Set(f, static_cast<float>(g)), last);
        }
        hn::Store(z, f, out.z + t);
        hn::Store(meets, f, out.meets + t);
        hn::Store(last, f, out.last + t);
    }
}

/// Takes what a cluster covers of a block into it.
void updateBlock(DepthBlocks& image, DepthBlock& block, int column, int row, const uint32_t* covered,
                 GroupDepth* groups, int count) {
    alignas(32) uint64_t masks[kBlockTiles];
    TileDepths depths;
    tilesOf(covered, masks);
    depthOfTiles(column, row, groups, count, depths);
    uint16_t codes[kBlockTiles] = {};
    uint32_t part[2] = {0, 0};  // bits of tiles that are raised by pixel
    for (int t = 0; t < kBlockTiles; ++t) {
        const float z = depths.z[t];
        if (masks[t] == 0 || depths.meets[t] == 0 || !(z > block.base[t])) continue;
        if (masks[t] == ~uint64_t{0}) {
            block.base[t] = z;
            block.plane[t] = DepthBlock::kNoPlane;
            if (depths.meets[t] > 1) continue;
            GroupDepth& group = groups[static_cast<int>(depths.last[t])];
            if (group.index == DepthBlock::kNoPlane) {
                group.index = static_cast<uint32_t>(image.planes.size());
                image.planes.push_back(group.plane);
            }
            block.plane[t] = group.index;
            continue;
        }
        codes[t] = image.depths.code(z);
        if (codes[t] == 0) continue;
        part[t / 4] |= 255u << (8 * (t % 4));
        if (block.seen[t] == 0) clearCodes(block, t);
        block.seen[t] |= masks[t];
    }
    if ((part[0] | part[1]) == 0) return;
    uint32_t rows[kBlockHeight];
    for (int y = 0; y < kBlockHeight; ++y) rows[y] = covered[y] & part[y / 8];
    raiseCodes(block, rows, codes);
    for (int t = 0; t < kBlockTiles; ++t) {
        if (codes[t] == 0 || block.seen[t] != ~uint64_t{0}) continue;
        const float z = image.depths.nearness(leastCode(block, t));
        if (!(z > block.base[t])) continue;
        block.base[t] = z;
        block.plane[t] = DepthBlock::kNoPlane;
    }
}

bool isBlockOpen(const DepthBlock& block, float nearest) {
    const hn::CappedTag<float, 8> f;
    bool open = false;
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f))
        open |= !hn::AllFalse(f, hn::Lt(hn::Load(f, block.base + t), hn::Set(f, nearest)));
    return open;
}

/// Whether a block that a rectangle of the image meets is open to a nearness.
bool isRectOpen(DepthBlocks& image, float x0, float y0, float x1, float y1, float nearest) {
    const int column0 = static_cast<int>(std::max(x0, 0.0f)) / kBlockWidth,
              column1 = static_cast<int>(std::min(x1, static_cast<float>(image.width - 1))) / kBlockWidth,
              row0 = static_cast<int>(std::max(y0, 0.0f)) / kBlockHeight,
              row1 = static_cast<int>(std::min(y1, static_cast<float>(image.height - 1))) / kBlockHeight;
    for (int row = row0; row <= row1; ++row)
        for (int column = column0; column <= column1; ++column)
            if (isBlockOpen(image.at(column, row), nearest)) return true;
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
