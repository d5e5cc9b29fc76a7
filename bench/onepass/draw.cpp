// Draws clusters of plane groups: open edges, winding numbers in bit planes, depth from planes; asks rectangles.
// SPDX-License-Identifier: MIT
#include "bench/onepass/draw.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "bench/onepass/draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "bench/onepass/scratch.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F = hn::CappedTag<float, 16>;
using I = hn::RebindToSigned<F>;
using U = hn::RebindToUnsigned<F>;
using VF = hn::Vec<F>;
using VI = hn::Vec<I>;
using VU = hn::Vec<U>;

/// Row over vertices relative to the cluster's centre: m holds it, in floats, and its value at the centre.
struct Row {
    float x, y, z, at_centre;
};

Row rowOf(const glm::dvec4& row, const glm::dvec3& centre) {
    return {static_cast<float>(row.x), static_cast<float>(row.y), static_cast<float>(row.z),
            static_cast<float>(glm::dot(glm::dvec3(row), centre) + row.w)};
}

HWY_INLINE VF apply(const Row& row, VF x, VF y, VF z) {
    const F f;
    return hn::Add(hn::Add(hn::Mul(hn::Set(f, row.x), x), hn::Mul(hn::Set(f, row.y), y)),
                   hn::Add(hn::Mul(hn::Set(f, row.z), z), hn::Set(f, row.at_centre)));
}

/// Which groups surely show their front (1) or, drawn from both sides, their back (-1) to the eye; 0: all others. A group
/// that is not 0 has no polygon that faces otherwise, so that no winding number is less than 0.
/// @returns how many are not 0
int faceGroups(const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const glm::vec3& eye, float away, int8_t* turn) {
    const F f;
    int count = 0;
    const float reach = away + c.radius;
    for (uint32_t g = 0; g < c.groups; g += static_cast<uint32_t>(hn::Lanes(f))) {
        const size_t at = size_t{c.first_group} + g;
        const VF h = hn::Sub(hn::Add(hn::Add(hn::Mul(hn::LoadU(f, &mesh.nx[at]), hn::Set(f, eye.x)),
                                             hn::Mul(hn::LoadU(f, &mesh.ny[at]), hn::Set(f, eye.y))),
                                     hn::Mul(hn::LoadU(f, &mesh.nz[at]), hn::Set(f, eye.z))),
                             hn::LoadU(f, &mesh.nd[at]));
        // What floats may be off by, what vertices lie off the plane, and what a triangle may lean.
        const VF room =
            hn::Add(hn::LoadU(f, &mesh.thick[at]),
                    hn::Mul(hn::Add(hn::LoadU(f, &mesh.tilt[at]), hn::Set(f, 0x1p-20f)), hn::Set(f, reach)));
        const auto front = hn::Gt(h, room);
        const VF back = hn::IfThenElseZero(hn::Lt(h, hn::Neg(room)), hn::LoadU(f, &mesh.both[at]));
        const VF turns = hn::IfThenElse(front, hn::Set(f, 1.0f), hn::Neg(back));
        hn::StoreU(hn::DemoteTo(hn::Rebind<int8_t, F>(), hn::ConvertTo(I(), turns)), hn::Rebind<int8_t, F>(), turn + g);
        count += static_cast<int>(hn::CountTrue(f, hn::Ne(turns, hn::Zero(f))));
    }
    return count;
}

void projectVertices(const ObjectFrame& frame, const PlaneMesh& mesh, const PlaneMesh::Cluster& c, ClusterImage& out) {
    const F f;
    const glm::dvec3 centre(c.centre);
    const Row rx = rowOf(frame.x, centre), ry = rowOf(frame.y, centre), rw = rowOf(frame.w, centre);
    VF x0 = hn::Set(f, 3e38f), y0 = x0, w0 = x0, x1 = hn::Set(f, -3e38f), y1 = x1, w1 = x1;
    for (uint32_t i = 0; i < c.vertices; i += static_cast<uint32_t>(hn::Lanes(f))) {
        const size_t at = size_t{c.first_vertex} + i;
        const VF x = hn::LoadU(f, &mesh.x[at]), y = hn::LoadU(f, &mesh.y[at]), z = hn::LoadU(f, &mesh.z[at]);
        const VF w = apply(rw, x, y, z);
        const VF px = hn::Div(apply(rx, x, y, z), w), py = hn::Div(apply(ry, x, y, z), w);
        hn::Store(px, f, out.x + i);
        hn::Store(py, f, out.y + i);
        x0 = hn::Min(x0, px);
        x1 = hn::Max(x1, px);
        y0 = hn::Min(y0, py);
        y1 = hn::Max(y1, py);
        w0 = hn::Min(w0, w);
        w1 = hn::Max(w1, w);
    }
    const auto least = [&](VF v) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(f, v)); };
    const auto most = [&](VF v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(f, v)); };
    out.x0 = least(x0);
    out.y0 = least(y0);
    out.w_min = least(w0);
    out.x1 = most(x1);
    out.y1 = most(y1);
    out.w_max = most(w1);
}

/// Brings edges into the form that rows read.
/// @param r       no corner's image is farther from where it is drawn  [pixels]
/// @param bounds  grows by what the edges touch: x0 y0 x1 y1
void setUpEdges(EdgeList& e, float r, float height, float (&bounds)[4]) {
    const F f;
    const I i32;
    const VF vr = hn::Set(f, r), rows = hn::Set(f, height + 1);
    VF bx0 = hn::Set(f, bounds[0]), by0 = hn::Set(f, bounds[1]), bx1 = hn::Set(f, bounds[2]),
       by1 = hn::Set(f, bounds[3]);
    e.pad();
    for (int k = 0; k < e.count; k += static_cast<int>(hn::Lanes(f))) {
        const VF ax = hn::Load(f, e.ax + k), ay = hn::Load(f, e.ay + k), bx = hn::Load(f, e.bx + k),
                 by = hn::Load(f, e.by + k);
        const auto up = hn::Gt(by, ay);
        const VF yl = hn::Min(ay, by), yh = hn::Max(ay, by), xl = hn::IfThenElse(up, ax, bx),
                 xh = hn::IfThenElse(up, bx, ax);
        const VF run = hn::Sub(xh, xl), rise = hn::Sub(yh, yl);
        const auto level = hn::Lt(rise, hn::Set(f, 1e-6f));
        const VF slope = hn::IfThenElse(level, hn::Zero(f), hn::Div(run, rise));
        const VF steep = hn::Abs(slope);
        const VF error = hn::Mul(
            hn::Set(f, 0x1p-20f),
            hn::Add(hn::Mul(steep, hn::Add(hn::Abs(yl), hn::Set(f, height + 16))), hn::Add(hn::Abs(xl), hn::Abs(xh))));
        const VF grow = hn::Add(vr, error);
        const VF half = hn::Add(hn::Mul(steep, hn::Add(hn::Set(f, 0.5f), vr)), grow);
        const VF left = hn::Sub(hn::Min(ax, bx), grow), right = hn::Add(hn::Max(ax, bx), grow);
        hn::Store(xl, f, e.x + k);
        hn::Store(yl, f, e.y + k);
        hn::Store(slope, f, e.slope + k);
        hn::Store(hn::IfThenElse(level, hn::Add(hn::Abs(run), grow), half), f, e.half + k);
        hn::Store(left, f, e.left + k);
        hn::Store(right, f, e.right + k);
        const auto toRow = [&](VF v) HWY_ATTR {
            return hn::ConvertTo(i32, hn::Min(hn::Max(hn::Floor(v), hn::Set(f, -1.0f)), rows));
        };
        hn::Store(toRow(hn::Sub(yl, grow)), i32, e.first + k);
        hn::Store(toRow(hn::Add(yh, grow)), i32, e.last + k);
        // A row's middle is crossed if it lies in [yl, yh): the ceiling of y - 0.5.
        const auto crossed = [&](VF v) HWY_ATTR { return toRow(hn::Neg(hn::Floor(hn::Sub(hn::Set(f, 0.5f), v)))); };
        hn::Store(crossed(yl), i32, e.begin + k);
        hn::Store(crossed(yh), i32, e.end + k);
        hn::Store(hn::IfThenElse(hn::RebindMask(i32, up), hn::Set(i32, 1), hn::Zero(i32)), i32, e.up + k);
        hn::Store(hn::IfThenElse(hn::RebindMask(i32, level), hn::Set(i32, 1), hn::Zero(i32)), i32, e.level + k);
        hn::Store(hn::Add(hn::Add(hn::Mul(steep, vr), grow), hn::Set(f, 0.01f)), f, e.beside + k);
        bx0 = hn::Min(bx0, left);
        bx1 = hn::Max(bx1, right);
        by0 = hn::Min(by0, hn::Sub(yl, grow));
        by1 = hn::Max(by1, hn::Add(yh, grow));
    }
    bounds[0] = hn::GetLane(hn::MinOfLanes(f, bx0));
    bounds[1] = hn::GetLane(hn::MinOfLanes(f, by0));
    bounds[2] = hn::GetLane(hn::MaxOfLanes(f, bx1));
    bounds[3] = hn::GetLane(hn::MaxOfLanes(f, by1));
}

/// Of whole numbers from -2^22 to 2^22: where they are added to this, the last bits of the float are the number.
HWY_INLINE VI wholeOf(VF v) {
    const I i32;
    const F f;
    constexpr float kLast = 0x1.8p23f;
    return hn::Sub(hn::BitCast(i32, hn::Add(v, hn::Set(f, kLast))), hn::Set(i32, std::bit_cast<int32_t>(kLast)));
}

void setUpRow(const EdgeList& e, int i, int row0, float width, RowEdge& out) {
    const F f;
    const I i32;
    const VF slope = hn::Set(f, e.slope[i]), x0 = hn::Set(f, e.x[i]), y0 = hn::Set(f, e.y[i]);
    const VF half = hn::Set(f, e.half[i]), left = hn::Set(f, e.left[i]), right = hn::Set(f, e.right[i]);
    const VF beside = hn::Set(f, e.beside[i]), middle = hn::Set(f, 0.5f), one = hn::Set(f, 1.0f);
    const auto clamp = [&](VF v) HWY_ATTR { return hn::Min(hn::Max(v, hn::Set(f, -1.0f)), hn::Set(f, width + 64)); };
    // The first pixel whose middle is not left of a place: the ceiling of x - 0.5.
    const auto atMiddle = [&](VF v) HWY_ATTR { return hn::Neg(hn::Floor(hn::Sub(middle, v))); };
    const bool level = e.level[i] != 0, plus = out.plus;
    for (size_t k = 0; k < kBlockHeight; k += hn::Lanes(f)) {
        const VF y = hn::Iota(f, static_cast<float>(row0) + 0.5f + static_cast<float>(k));
        const VF x = hn::Add(hn::Mul(hn::Sub(y, y0), slope), x0);
        hn::Store(wholeOf(clamp(atMiddle(hn::Min(hn::Max(x, left), right)))), i32, out.crossed + k);
        VF first = hn::Floor(hn::Max(hn::Sub(x, half), left)),
           end = hn::Add(hn::Floor(hn::Min(hn::Add(x, half), right)), one);
        if (!level && plus) first = hn::Max(first, atMiddle(hn::Sub(x, beside)));
        if (!level && !plus) end = hn::Min(end, hn::Add(hn::Floor(hn::Add(x, hn::Sub(beside, middle))), one));
        hn::Store(wholeOf(clamp(first)), i32, out.first + k);
        hn::Store(wholeOf(clamp(end)), i32, out.end + k);
    }
}

/// Ones from a column of the block on.
HWY_INLINE VU onesFrom(VI column, VI block) {
    const I i32;
    const U u32;
    const VI at = hn::Max(hn::Sub(column, block), hn::Zero(i32));
#if HWY_TARGET <= HWY_AVX2  // there what is shifted by more than there are bits is 0
    return hn::Shl(hn::Set(u32, ~0u), hn::BitCast(u32, at));
#else
    const auto inside = hn::RebindMask(u32, hn::Lt(at, hn::Set(i32, kBlockWidth)));
    return hn::IfThenElseZero(inside, hn::Shl(hn::Set(u32, ~0u), hn::BitCast(u32, hn::Min(at, hn::Set(i32, 31)))));
#endif
}

/// The pixels of a block that are covered. From the middle of a pixel a straight way to any point of it crosses only edges that
/// touch the pixel, each once at most, and only one that has the middle on its inner side lowers the winding number there, by
/// one. So a pixel is covered if the winding number of its middle is larger than the number of such edges. Rounding moves edges
/// by no more than what they touch beside them: a middle that close counts as inside, whichever way it was counted before.
/// @returns whether there are any
bool coverBlock(const RowEdge* edges, const uint16_t* list, int count, const RowWinding& before, int column,
                uint32_t* covered) {
    const I i32;
    const U u32;
    const VI block = hn::Set(i32, column);
    VU any = hn::Zero(u32);
    for (size_t k = 0; k < kBlockHeight; k += hn::Lanes(u32)) {
        const VU bit = hn::Shl(hn::Set(u32, 1u), hn::Iota(u32, static_cast<uint32_t>(k)));
        const auto in = [&](uint32_t rows) HWY_ATTR { return hn::TestBit(hn::Set(u32, rows), bit); };
        VU low = hn::VecFromMask(u32, in(before.low)), high = hn::VecFromMask(u32, in(before.high));
        VU once = hn::Zero(u32), twice = once,
           thrice = once;  // so often an edge touches from its inner side, or more often
        for (int n = 0; n < count; ++n) {
            const RowEdge& e = edges[list[n]];
            const VU more = hn::IfThenElseZero(in(e.rows), onesFrom(hn::Load(i32, e.crossed + k), block));
            const VU carry = e.plus ? hn::And(low, more) : hn::AndNot(low, more);
            low = hn::Xor(low, more);
            high = hn::Xor(high, carry);
            const VU band =
                hn::AndNot(onesFrom(hn::Load(i32, e.end + k), block), onesFrom(hn::Load(i32, e.first + k), block));
            const VU touched = hn::IfThenElseZero(in(e.touched_rows), band);
            thrice = hn::Or(thrice, hn::And(twice, touched));
            twice = hn::Or(twice, hn::And(once, touched));
            once = hn::Or(once, touched);
        }
        // The winding number is 1 to 3, or looks as if it were: what is four times covered counts as open.
        const VU cover = hn::Or(hn::AndNot(once, hn::Or(low, high)),
                                hn::Or(hn::AndNot(twice, high), hn::AndNot(thrice, hn::And(high, low))));
        hn::Store(cover, u32, covered + k);
        any = hn::Or(any, cover);
    }
    return !hn::AllTrue(u32, hn::Eq(any, hn::Zero(u32)));
}

/// From rows of 32 pixels to masks of tiles, bit 8 * row + column.
#if HWY_TARGET == HWY_SCALAR
void tilesOf(const uint32_t* rows, uint64_t* tiles) {
    for (int t = 0; t < kBlockTiles; ++t) {
        tiles[t] = 0;
        for (int y = 0; y < 8; ++y) tiles[t] |= uint64_t{rows[8 * (t / 4) + y] >> (8 * (t % 4)) & 255} << (8 * y);
    }
}
#else
void tilesOf(const uint32_t* rows, uint64_t* tiles) {
    const hn::FixedTag<uint8_t, 16> u8;
    const hn::FixedTag<uint32_t, 4> u32;
    const hn::FixedTag<uint64_t, 2> u64;
    alignas(16) static constexpr uint8_t kByTile[16] = {0, 4, 8, 12, 1, 5, 9, 13, 2, 6, 10, 14, 3, 7, 11, 15};
    const auto order = hn::Load(u8, kByTile);
    const auto four = [&](int first) HWY_ATTR {  // of four rows: bytes of the first tile, of the second, ...
        return hn::BitCast(u32, hn::TableLookupBytes(hn::BitCast(u8, hn::Load(u32, rows + first)), order));
    };
    for (int half = 0; half < 2; ++half) {
        const auto low = four(8 * half), high = four(8 * half + 4);
        hn::Store(hn::BitCast(u64, hn::InterleaveLower(u32, low, high)), u64, tiles + 4 * half);
        hn::Store(hn::BitCast(u64, hn::InterleaveUpper(u32, low, high)), u64, tiles + 4 * half + 2);
    }
}
#endif

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

/// Sixteen edges in one row of blocks: which meet it, and where.
struct RowPlaces {
    alignas(64) int32_t first[16], last[16], begin[16], end[16];
    alignas(64) float low[16], high[16];
    uint32_t meets = 0;
};

/// @param beyond  what begins here or farther right does not matter
void placeEdges(const EdgeList& e, int at, int row0, float beyond, RowPlaces& out) {
    const F f;
    const I i32;
    out.meets = 0;
    for (size_t k = 0; k < 16; k += hn::Lanes(f)) {
        const size_t i = static_cast<size_t>(at) + k;
        const VI zero = hn::Zero(i32), top = hn::Set(i32, kBlockHeight), row = hn::Set(i32, row0);
        const auto inRow = [&](const int32_t* v, VI most)
                               HWY_ATTR { return hn::Min(hn::Max(hn::Sub(hn::Load(i32, v + i), row), zero), most); };
        const VI first = hn::Max(hn::Sub(hn::Load(i32, e.first + i), row), zero),
                 last = hn::Min(hn::Sub(hn::Load(i32, e.last + i), row), hn::Set(i32, kBlockHeight - 1));
        hn::Store(first, i32, out.first + k);
        hn::Store(last, i32, out.last + k);
        hn::Store(inRow(e.begin, top), i32, out.begin + k);
        hn::Store(inRow(e.end, top), i32, out.end + k);
        const VF middle = hn::Sub(hn::Set(f, static_cast<float>(row0) + 0.5f), hn::Load(f, e.y + i));
        const auto place = [&](VI of) HWY_ATTR {
            return hn::Add(hn::Mul(hn::Add(hn::ConvertTo(f, of), middle), hn::Load(f, e.slope + i)),
                           hn::Load(f, e.x + i));
        };
        const VF xa = place(first), xb = place(last), more = hn::Set(f, 0.01f);
        const VF room = hn::Add(hn::Add(hn::Load(f, e.half + i), more),
                                hn::Mul(hn::Set(f, 0x1p-20f), hn::Max(hn::Abs(xa), hn::Abs(xb))));
        const VF low = hn::Max(hn::Sub(hn::Min(xa, xb), room), hn::Sub(hn::Load(f, e.left + i), more));
        hn::Store(low, f, out.low + k);
        hn::Store(hn::Min(hn::Add(hn::Max(xa, xb), room), hn::Add(hn::Load(f, e.right + i), more)), f, out.high + k);
        const auto meets = hn::And(hn::Not(hn::RebindMask(f, hn::Gt(first, last))), hn::Lt(low, hn::Set(f, beyond)));
        uint8_t bits[8] = {};
        hn::StoreMaskBits(f, meets, bits);
        out.meets |= static_cast<uint32_t>(bits[0] | bits[1] << 8) << k;
    }
}

/// Draws what the edges bound.
void rasterize(DepthBlocks& image, DrawScratch& scratch, float r, float nearest, int count) {
    RowEdge* const row_edges = scratch.row_edges;
    RowLists& lists = scratch.lists;
    EdgeList& e = scratch.edges;
    GroupDepth* const groups = scratch.groups;
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    float bounds[4] = {3e38f, 3e38f, -3e38f, -3e38f};
    setUpEdges(e, r, height, bounds);
    if (!(bounds[2] > 0 && bounds[3] > 0 && bounds[0] < width && bounds[1] < height)) return;
    const int column0 = static_cast<int>(std::max(bounds[0], 0.0f)) / kBlockWidth,
              column1 = static_cast<int>(std::min(bounds[2], width - 1)) / kBlockWidth,
              block_row0 = static_cast<int>(std::max(bounds[1], 0.0f)) / kBlockHeight,
              block_row1 = static_cast<int>(std::min(bounds[3], height - 1)) / kBlockHeight;
    for (int by = block_row0; by <= block_row1; ++by) {
        int from = column1 + 1, to = -1;  // blocks that may become nearer
        for (int bx = column0; bx <= column1; ++bx)
            if (isBlockOpen(image.at(bx, by), nearest)) {
                from = std::min(from, bx);
                to = bx;
            }
        if (to < 0) continue;
        const int row0 = kBlockHeight * by;
        RowWinding before;  // left of the block at hand
        int used = 0;
        for (int b = from; b <= to; ++b) lists.count[b] = lists.left_count[b] = 0;
        RowPlaces places;
        for (int at = 0; at < e.count; at += 16) {
            placeEdges(e, at, row0, static_cast<float>(kBlockWidth * (to + 1)), places);
            if (e.count - at < 16) places.meets &= (1u << (e.count - at)) - 1;
            for (uint32_t left = places.meets; left != 0; left &= left - 1) {
                const int k = std::countr_zero(left), i = at + k, first = places.first[k], last = places.last[k],
                          begin = places.begin[k], end = places.end[k];
                const float low = places.low[k], high = places.high[k];
                const uint32_t rows = ((1u << end) - 1) & ~((1u << begin) - 1);
                const bool plus = (e.change[i] > 0) != (e.up[i] == 1);
                if (high < static_cast<float>(kBlockWidth * from)) {
                    before.count(rows, plus);
                    continue;
                }
                RowEdge& edge = row_edges[used];
                edge.rows = rows;
                edge.touched_rows = ((2u << last) - 1) & ~((1u << first) - 1);
                edge.plus = plus;
                setUpRow(e, i, row0, width, edge);
                const int b0 = std::max(static_cast<int>(std::max(low, 0.0f)) / kBlockWidth, from),
                          b1 = static_cast<int>(std::min(std::max(high, 0.0f), width + 64)) / kBlockWidth;
                for (int b = b0; b <= std::min(b1, to); ++b)
                    lists.at[b][lists.count[b]++] = static_cast<uint16_t>(used);
                if (b1 < to) lists.left[b1 + 1][lists.left_count[b1 + 1]++] = static_cast<uint16_t>(used);
                ++used;
            }
        }
        for (int bx = from; bx <= to; ++bx) {
            for (int k = 0; k < lists.left_count[bx]; ++k) {
                const RowEdge& edge = row_edges[lists.left[bx][k]];
                before.count(edge.rows, edge.plus);
            }
            if (lists.count[bx] == 0 && ((before.low | before.high) & 0xffffu) == 0) continue;
            DepthBlock& block = image.at(bx, by);
            if (!isBlockOpen(block, nearest)) continue;
            alignas(64) uint32_t covered[kBlockHeight];
            if (coverBlock(row_edges, lists.at[bx], lists.count[bx], before, kBlockWidth * bx, covered))
                updateBlock(image, block, bx, by, covered, groups, count);
        }
    }
}

/// The edges on whose sides groups are drawn otherwise, with their corners' images.
void gatherEdges(const PlaneMesh& mesh, const PlaneMesh::Cluster& c, const int8_t* turn, const ClusterImage& image,
                 EdgeList& out) {
    const F f;
    const I i32;
    const hn::Rebind<uint8_t, F> u8;
    alignas(64) uint8_t from[PlaneMesh::kMostEdges + 64], to[PlaneMesh::kMostEdges + 64];
    const uint8_t *left = &mesh.left[c.first_edge], *right = &mesh.right[c.first_edge];
    int count = 0;
    for (uint32_t i = 0; i < c.edges; ++i) {
        const int change = turn[left[i]] - turn[right[i]];
        from[count] = mesh.from[c.first_edge + i];
        to[count] = mesh.to[c.first_edge + i];
        out.change[count] = change;
        count += change != 0;
    }
    const int plain = count;
    for (int i = 0; i < plain; ++i) {
        if (std::abs(out.change[i]) < 2) continue;
        if (count == PlaneMesh::kMostEdges) {
            out.full = true;
            return;
        }
        from[count] = from[i];
        to[count] = to[i];
        out.change[count++] = out.change[i] /= 2;
    }
    std::memset(from + count, 0, 16);
    std::memset(to + count, 0, 16);
    for (int k = 0; k < count; k += static_cast<int>(hn::Lanes(f))) {
        const VI a = hn::PromoteTo(i32, hn::LoadU(u8, from + k)), b = hn::PromoteTo(i32, hn::LoadU(u8, to + k));
        hn::Store(hn::GatherIndex(f, image.x, a), f, out.ax + k);
        hn::Store(hn::GatherIndex(f, image.y, a), f, out.ay + k);
        hn::Store(hn::GatherIndex(f, image.x, b), f, out.bx + k);
        hn::Store(hn::GatherIndex(f, image.y, b), f, out.by + k);
    }
    out.count = count;
}

bool isBehind(const ImagePlane& plane, const AskedBox& box) {
    float v = plane.a * box.x[3] + plane.b * box.y[3] + plane.c * box.w[3] - 1.0f;
    float size = std::abs(plane.a * box.x[3]) + std::abs(plane.b * box.y[3]) + std::abs(plane.c * box.w[3]) + 1.0f;
    for (int k = 0; k < 3; ++k) {
        const float a = plane.a * box.x[k], b = plane.b * box.y[k], c = plane.c * box.w[k];
        v -= box.half[k] * std::abs(a + b + c);
        size += box.half[k] * (std::abs(a) + std::abs(b) + std::abs(c));
    }
    return v > 0x1p-20f * size;
}

/// Whether a tile's codes are open to one, at pixels of a window that all have codes.
bool isTileOpen(const DepthBlock& block, int tile, uint64_t window, uint16_t asked) {
    const hn::CappedTag<uint16_t, 8> d;
    const uint16_t* at = &block.codes[8 * (tile / 4)][8 * (tile % 4)];
    for (int y = 0; y < 8; ++y, at += kBlockWidth) {
        const uint32_t row = window >> (8 * y) & 255;
        if (row == 0) continue;
        uint32_t open = 0;
        for (size_t x = 0; x < 8; x += hn::Lanes(d)) {
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Eq(hn::Min(hn::Load(d, at + x), hn::Set(d, asked)), hn::Load(d, at + x)), bits);
            open |= static_cast<uint32_t>(bits[0]) << x;
        }
        if (open & row) return true;
    }
    return false;
}

bool isOpenKernel(DepthBlocks& image, int x0, int y0, int x1, int y1, float nearness, const AskedBox* box) {
    const hn::CappedTag<float, 8> f;
    const uint16_t asked = image.depths.code(nearness);
    uint32_t last = DepthBlock::kNoPlane;
    bool last_hides = false;
    for (int by = y0 / kBlockHeight; by <= y1 / kBlockHeight; ++by)
        for (int bx = x0 / kBlockWidth; bx <= x1 / kBlockWidth; ++bx) {
            const DepthBlock& block = image.at(bx, by);
            uint32_t open = 0;
            for (size_t t = 0; t < kBlockTiles; t += hn::Lanes(f)) {
                uint8_t bits[8] = {};
                hn::StoreMaskBits(f, hn::Le(hn::Load(f, block.base + t), hn::Set(f, nearness)), bits);
                open |= static_cast<uint32_t>(bits[0]) << t;
            }
            if (open == 0) continue;
            const int left = std::max(x0 - kBlockWidth * bx, 0),
                      right = std::min(x1 - kBlockWidth * bx, kBlockWidth - 1),
                      low = std::max(y0 - kBlockHeight * by, 0),
                      high = std::min(y1 - kBlockHeight * by, kBlockHeight - 1);
            const uint32_t columns = ~0u << left & ~0u >> (31 - right), rows = (2u << high) - (1u << low);
            for (; open != 0; open &= open - 1) {
                const int t = std::countr_zero(open);
                const uint64_t across = columns >> (8 * (t % 4)) & 255, down = rows >> (8 * (t / 4)) & 255;
                if (across == 0 || down == 0) continue;
                uint64_t window = 0;
                for (int y = 0; y < 8; ++y) window |= (down >> y & 1 ? across : 0) << (8 * y);
                if (box && block.plane[t] != DepthBlock::kNoPlane) {
                    if (block.plane[t] != last) last_hides = isBehind(image.planes[last = block.plane[t]], *box);
                    if (last_hides) continue;
                }
                if ((window & ~block.seen[t]) != 0 || isTileOpen(block, t, window, asked)) return true;
            }
        }
    return false;
}

/// The image of a box by its corners, with all that floats may be off by.
bool imageOfKernel(const AskedBox& box, float near_w, BoxImage& out) {
    const hn::CappedTag<float, 8> f;
    alignas(32) static constexpr float kX[8] = {-1, 1, -1, 1, -1, 1, -1, 1}, kY[8] = {-1, -1, 1, 1, -1, -1, 1, 1},
                                       kZ[8] = {-1, -1, -1, -1, 1, 1, 1, 1};
    float x0 = 3e38f, y0 = 3e38f, x1 = -3e38f, y1 = -3e38f, w0 = 3e38f;
    for (size_t k = 0; k < 8; k += hn::Lanes(f)) {
        const auto row = [&](const float(&r)[4]) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(hn::Load(f, kX + k), hn::Set(f, r[0] * box.half[0])),
                                   hn::Mul(hn::Load(f, kY + k), hn::Set(f, r[1] * box.half[1]))),
                           hn::Add(hn::Mul(hn::Load(f, kZ + k), hn::Set(f, r[2] * box.half[2])), hn::Set(f, r[3])));
        };
        const auto w = row(box.w), x = hn::Div(row(box.x), w), y = hn::Div(row(box.y), w);
        x0 = std::min(x0, hn::GetLane(hn::MinOfLanes(f, x)));
        x1 = std::max(x1, hn::GetLane(hn::MaxOfLanes(f, x)));
        y0 = std::min(y0, hn::GetLane(hn::MinOfLanes(f, y)));
        y1 = std::max(y1, hn::GetLane(hn::MaxOfLanes(f, y)));
        w0 = std::min(w0, hn::GetLane(hn::MinOfLanes(f, w)));
    }
    const auto size = [&](const float(&r)[4]) {
        return std::abs(r[0]) * box.half[0] + std::abs(r[1]) * box.half[1] + std::abs(r[2]) * box.half[2] +
               std::abs(r[3]);
    };
    const float w_error = 0x1p-20f * size(box.w), least = w0 - w_error;
    if (!(least > near_w)) return false;
    const float inverse = 1 / least, reach_x = std::max(std::abs(x0), std::abs(x1)),
                reach_y = std::max(std::abs(y0), std::abs(y1));
    const float more_x = (0x1p-20f * size(box.x) + reach_x * w_error) * inverse,
                more_y = (0x1p-20f * size(box.y) + reach_y * w_error) * inverse;
    out = {x0 - more_x, y0 - more_y, x1 + more_x, y1 + more_y, inverse * (1 + 1e-6f)};
    return true;
}

bool drawClusterKernel(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t index,
                       DrawScratch& scratch) {
    SIGHTLINE_DEBUG_ASSERT(index < mesh.clusters.size());
    ClusterImage& projected = scratch.image;
    EdgeList& edges = scratch.edges;
    GroupDepth* const groups = scratch.groups;
    ImageRect* const rects = scratch.rects;
    const PlaneMesh::Cluster& c = mesh.clusters[index];
    const glm::dvec3 eye = frame.eye - glm::dvec3(c.centre);
    const double away = glm::length(eye);
    alignas(64) int8_t turn[PlaneMesh::kNoGroup + 1] = {};
    const int facing = faceGroups(mesh, c, glm::vec3(eye), static_cast<float>(away), turn);
    if (facing == 0) return true;
    projectVertices(frame, mesh, c, projected);
    const float width = static_cast<float>(image.width), height = static_cast<float>(image.height);
    const float near_w = static_cast<float>(frame.near_w * (1 + 1e-6)), reach = static_cast<float>(away) + c.radius;
    const float w_error = 0x1p-20f * frame.length_w * reach;
    if (!(projected.w_max + w_error > near_w)) return true;
    // The images of vertices: numerators and w are off by 2^-20 of what they are made of at most.
    float r = std::numeric_limits<float>::infinity(), nearest = 1 / near_w * (1 + 1e-5f);
    if (projected.w_min > near_w + w_error) {
        const float farthest = std::max({-projected.x0, projected.x1, -projected.y0, projected.y1, width, height});
        r = 0x1p-20f * (std::max(frame.length_x, frame.length_y) + farthest * frame.length_w) * reach /
                projected.w_min +
            1e-5f;
        if (!(projected.x1 + 1 > 0 && projected.y1 + 1 > 0 && projected.x0 - 1 < width && projected.y0 - 1 < height))
            return true;
    }
    edges.count = 0;
    edges.full = false;
    const bool by_floats = r < 0.25f;
    if (by_floats) {
        nearest = (1 + 1e-5f) / (projected.w_min - w_error);
        if (!isRectOpen(image, projected.x0 - 1, projected.y0 - 1, projected.x1 + 1, projected.y1 + 1, nearest))
            return true;
        gatherEdges(mesh, c, turn, projected, edges);
    } else if (!cutEdges(frame, mesh, c, turn, width, height, edges, rects, r, nearest)) {
        return false;
    }
    if (edges.full) return false;
    if (edges.count == 0) return true;
    for (int i = 0; frame.sign < 0 && i < edges.count; ++i) edges.change[i] = -edges.change[i];
    int count = 0;
    GroupPlanes& planes = scratch.planes;
    planesOf(frame, mesh, c, eye, width, height, planes);
    for (uint32_t g = 0; g < c.groups; ++g) {
        if (turn[g] == 0) continue;
        const size_t at = size_t{c.first_group} + g;
        GroupDepth& of = groups[count++];
        of.plane = {planes.a[g], planes.b[g], planes.c[g]};
        of.least = of.plane.c - 4.0f * (std::abs(of.plane.a) + std::abs(of.plane.b));
        of.index = DepthBlock::kNoPlane;
        of.rect = by_floats ? ImageRect() : rects[g];
        for (uint32_t k = 0; by_floats && k < mesh.corner_count[at]; ++k) {
            const uint8_t v = mesh.corners[mesh.first_corner[at] + k];
            of.rect.grow(projected.x[v], projected.y[v]);
        }
    }
    rasterize(image, scratch, r, nearest, count);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE

namespace sightline::bench {

HWY_EXPORT(drawClusterKernel);
HWY_EXPORT(imageOfKernel);
HWY_EXPORT(isOpenKernel);

AskedBox askedBox(const Screen& screen, const glm::dvec3& centre, const glm::dvec3& half) {
    AskedBox out;
    const glm::dvec4 at(centre, 1);
    const auto take = [&](const glm::dvec4& row, float(&to)[4]) {
        for (int axis = 0; axis < 3; ++axis) to[axis] = static_cast<float>(row[axis]);
        to[3] = static_cast<float>(glm::dot(row, at));
    };
    take(screen.x, out.x);
    take(screen.y, out.y);
    take(screen.w, out.w);
    for (int axis = 0; axis < 3; ++axis) out.half[axis] = static_cast<float>(half[axis] * (1 + 1e-6));
    return out;
}

bool imageOf(const AskedBox& box, double near_w, BoxImage& out) {
    return HWY_DYNAMIC_DISPATCH(imageOfKernel)(box, static_cast<float>(near_w * (1 + 1e-6)), out);
}

bool drawCluster(DepthBlocks& image, const ObjectFrame& frame, const PlaneMesh& mesh, uint32_t cluster,
                 DrawScratch& scratch) {
    return frame.usable && HWY_DYNAMIC_DISPATCH(drawClusterKernel)(image, frame, mesh, cluster, scratch);
}

bool isOpen(DepthBlocks& image, int x0, int y0, int x1, int y1, float nearness, const AskedBox* box) {
    return HWY_DYNAMIC_DISPATCH(isOpenKernel)(image, x0, y0, x1, y1, nearness, box);
}

}  // namespace sightline::bench

#endif  // HWY_ONCE
