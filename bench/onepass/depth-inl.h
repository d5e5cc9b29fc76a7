// The depth of groups in the image, and how blocks take it in.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H
#undef SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H
#else
#define SIGHTLINE_BENCH_ONEPASS_DEPTH_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "bench/onepass/cover-inl.h"
#include "bench/onepass/frame.h"
#include "bench/onepass/lanes-inl.h"
#include "bench/onepass/scratch.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {
/// A plane that is h below the eye has nearness -(to_image * normal) / h; of points that may lie off it, no less than that of
/// the plane that is farther from the eye by as much, and no more than that of the plane that is nearer by as much.
/// @tparam kNearest  what is no less than the nearness of any point; else what is no more
template <bool kNearest>
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
        const auto thick = load(mesh.thick), away = kNearest ? hn::Sub(hn::Abs(h), thick) : hn::Add(hn::Abs(h), thick);
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
        const auto room = hn::Mul(size, set(0x1p-20));
        hn::StoreU(hn::DemoteTo(f, kNearest ? hn::Add(e, room) : hn::Sub(e, room)), f, out.c + g);
    }
}

/// Raises codes of pixels: bits of rows, in each half of a block the codes of its tiles.
void raiseCodes(DepthBlock& block, const uint32_t* rows, const uint16_t (&codes)[kBlockTiles]) {
    const hn::CappedTag<uint16_t, 32> d;
    for (int half = 0; half < 2; ++half) {
        alignas(64) uint16_t raised[kBlockWidth];
        for (int x = 0; x < kBlockWidth; ++x) raised[x] = codes[4 * half + x / 8];
        for (int y = 8 * half; y < 8 * half + 8; ++y) {
            if (rows[y] == 0) continue;
            for (size_t x = 0; x < kBlockWidth; x += hn::Lanes(d)) {
                uint8_t bits[8] = {};
                const uint32_t left = rows[y] >> x;
                std::memcpy(bits, &left, sizeof left);
                const auto is = hn::Max(hn::Load(d, block.codes[y] + x), hn::Load(d, raised + x));
                hn::BlendedStore(is, hn::LoadMaskBits(d, bits), d, block.codes[y] + x);
            }
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

/// For each tile of a block the least depth of the groups that may be in it, infinite where there are none.
struct TileDepths {
    alignas(32) float z[kBlockTiles], last[kBlockTiles];  ///< the last of the groups, as a number
    uint32_t single = 0;                                  ///< tiles of one group, as bits
};

template <class D, class M>
HWY_INLINE uint32_t bitsOf(D d, M mask) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return bits[0];
}

template <class D>
HWY_INLINE hn::Mask<D> maskOf(D d, uint32_t bits) {
    const uint8_t bytes[8] = {static_cast<uint8_t>(bits)};
    return hn::LoadMaskBits(d, bytes);
}

/// The middles of a block's tiles.
struct TileMiddles {
    alignas(32) float x[kBlockTiles], y[kBlockTiles];

    TileMiddles(int column, int row) {
        for (int t = 0; t < kBlockTiles; ++t) {
            x[t] = static_cast<float>(kBlockWidth * column + 8 * (t % 4) + 4);
            y[t] = static_cast<float>(kBlockHeight * row + 8 * (t / 4) + 4);
        }
    }
};

/// Which middles of tiles are where a group may be.
template <class D, class V>
HWY_INLINE hn::Mask<D> areIn(D f, const GroupRect& rect, V x, V y) {
    const auto within = [&](V v, float low, float high)
                            HWY_ATTR { return hn::And(hn::Ge(v, hn::Set(f, low)), hn::Le(v, hn::Set(f, high))); };
    return hn::And(hn::And(within(x, rect.x0, rect.x1), within(y, rect.y0, rect.y1)),
                   hn::And(within(hn::Add(x, y), rect.s0, rect.s1), within(hn::Sub(x, y), rect.t0, rect.t1)));
}

/// The depth of a group in tiles: the least there, or for a look the nearest.
template <class D, class V>
HWY_INLINE V depthAt(D f, const GroupDepth& of, V x, V y) {
    return hn::Add(hn::Add(hn::Mul(hn::Set(f, of.plane.a), x), hn::Mul(hn::Set(f, of.plane.b), y)),
                   hn::Set(f, of.bound));
}

void depthOfTiles(int column, int row, const GroupDepth* groups, int count, TileDepths& out) {
    const hn::CappedTag<float, kBlockTiles> f;
    const TileMiddles middles(column, row);
    out.single = 0;
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
        const auto x = hn::Load(f, middles.x + t), y = hn::Load(f, middles.y + t);
        auto z = hn::Set(f, std::numeric_limits<float>::infinity()), meets = hn::Zero(f), last = hn::Zero(f);
        for (int g = 0; g < count; ++g) {
            const auto near_by = areIn(f, groups[g].rect, x, y);
            z = hn::IfThenElse(near_by, hn::Min(z, depthAt(f, groups[g], x, y)), z);
            meets = hn::Add(meets, hn::IfThenElseZero(near_by, hn::Set(f, 1.0f)));
            last = hn::IfThenElse(near_by, hn::Set(f, static_cast<float>(g)), last);
        }
        hn::Store(z, f, out.z + t);
        hn::Store(last, f, out.last + t);
        out.single |= bitsOf(f, hn::Eq(meets, hn::Set(f, 1.0f))) << t;
    }
}

/// Which of the masks of a block's tiles are not 0, and which are whole, as bits.
void sortMasks(const uint64_t* masks, uint32_t& any, uint32_t& whole) {
    const hn::CappedTag<uint64_t, kBlockTiles> d;
    any = whole = 0;
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(d)) {
        const auto mask = hn::Load(d, masks + t);
        any |= bitsOf(d, hn::Ne(mask, hn::Zero(d))) << t;
        whole |= bitsOf(d, hn::Eq(mask, hn::Set(d, ~uint64_t{0}))) << t;
    }
}

/// Takes what a cluster covers of a block into it.
void updateBlock(DepthBlocks& image, DepthBlock& block, int column, int row, const uint32_t* covered,
                 GroupDepth* groups, int count) {
    const hn::CappedTag<float, kBlockTiles> f;
    const hn::Rebind<uint32_t, decltype(f)> u;
    alignas(64) uint64_t masks[kBlockTiles];
    TileDepths depths;
    tilesOf(covered, masks);
    depthOfTiles(column, row, groups, count, depths);
    uint32_t any = 0, whole = 0, nearer = 0;
    sortMasks(masks, any, whole);
    for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
        const auto z = hn::Load(f, depths.z + t);
        const auto is = hn::And(hn::Gt(z, hn::Load(f, block.base + t)),
                                hn::Lt(z, hn::Set(f, std::numeric_limits<float>::infinity())));
        nearer |= bitsOf(f, is) << t;
    }
    uint32_t raised = any & whole & nearer;  // tiles whose base becomes nearer
    if (raised != 0) {
        for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
            const auto mask = maskOf(f, raised >> t);
            hn::BlendedStore(hn::Load(f, depths.z + t), mask, f, block.base + t);
            hn::BlendedStore(hn::Set(u, DepthBlock::kNoPlane), hn::RebindMask(u, mask), u, block.plane + t);
        }
        for (uint32_t left = raised & depths.single; left != 0; left &= left - 1) {
            const int t = std::countr_zero(left);
            GroupDepth& group = groups[static_cast<int>(depths.last[t])];
            if (group.index == DepthBlock::kNoPlane) {
                group.index = static_cast<uint32_t>(image.planes.size());
                image.planes.push_back(group.plane);
            }
            block.plane[t] = group.index;
        }
    }
    uint16_t codes[kBlockTiles] = {};
    uint32_t part[2] = {0, 0}, filled = 0;  // bits of tiles that are raised by pixel; tiles with a code at every pixel
    for (uint32_t left = any & ~whole & nearer; left != 0; left &= left - 1) {
        const int t = std::countr_zero(left);
        codes[t] = image.depths.code(depths.z[t]);
        if (codes[t] == 0) continue;
        part[t / 4] |= 255u << (8 * (t % 4));
        if (block.seen[t] == 0) clearCodes(block, t);
        block.seen[t] |= masks[t];
        filled |= (block.seen[t] == ~uint64_t{0} ? 1u : 0u) << t;
    }
    if ((part[0] | part[1]) != 0) {
        uint32_t rows[kBlockHeight];
        for (int y = 0; y < kBlockHeight; ++y) rows[y] = covered[y] & part[y / 8];
        raiseCodes(block, rows, codes);
    }
    for (; filled != 0; filled &= filled - 1) {
        const int t = std::countr_zero(filled);
        const float z = image.depths.nearness(leastCode(block, t));
        if (!(z > block.base[t])) continue;
        block.base[t] = z;
        block.plane[t] = DepthBlock::kNoPlane;
        raised |= 1u << t;
    }
    if (raised == 0) return;
    auto least = hn::Load(f, block.base);
    for (size_t t = hn::Lanes(f); t < kBlockTiles; t += hn::Lanes(f))
        least = hn::Min(least, hn::Load(f, block.base + t));
    image.leastBase(column, row) = hn::GetLane(hn::MinOfLanes(f, least));
}

/// The first and the last of some blocks of a row that are open to a nearness.
struct OpenBlocks {
    int first, last;  ///< last < first: none
};

OpenBlocks openBlocks(DepthBlocks& image, int row, int column0, int column1, float nearest) {
    const F f;
    OpenBlocks out{column1 + 1, -1};
    for (int at = column0; at <= column1; at += static_cast<int>(hn::Lanes(f))) {
        uint8_t bytes[8] = {};
        hn::StoreMaskBits(f, hn::Lt(hn::LoadU(f, &image.leastBase(at, row)), hn::Set(f, nearest)), bytes);
        uint32_t bits = bytes[0] | static_cast<uint32_t>(bytes[1]) << 8;
        if (column1 - at < 31) bits &= (2u << (column1 - at)) - 1;
        if (bits == 0) continue;
        out.first = std::min(out.first, at + std::countr_zero(bits));
        out.last = at + 31 - std::countl_zero(bits);
    }
    return out;
}

/// Whether a block that a rectangle of the image meets is open to a nearness.
bool isRectOpen(DepthBlocks& image, float x0, float y0, float x1, float y1, float nearest) {
    const int column0 = static_cast<int>(std::max(x0, 0.0f)) / kBlockWidth,
              column1 = static_cast<int>(std::min(x1, static_cast<float>(image.width - 1))) / kBlockWidth,
              row0 = static_cast<int>(std::max(y0, 0.0f)) / kBlockHeight,
              row1 = static_cast<int>(std::min(y1, static_cast<float>(image.height - 1))) / kBlockHeight;
    for (int row = row0; row <= row1; ++row)
        if (openBlocks(image, row, column0, column1, nearest).last >= 0) return true;
    return false;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
