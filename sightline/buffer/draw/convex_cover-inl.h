// Carries what a convex outline bounds into the tiles: which pixels it covers and how near, and which it leaves in doubt.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BUFFER_DRAW_CONVEX_COVER_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BUFFER_DRAW_CONVEX_COVER_INL_H
#undef SIGHTLINE_BUFFER_DRAW_CONVEX_COVER_INL_H
#else
#define SIGHTLINE_BUFFER_DRAW_CONVEX_COVER_INL_H
#endif

#include <bit>

#include "sightline/buffer/covers.h"
#include "sightline/buffer/draw/convex_outline-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// The tiles as polygons in no order are merged into them.
struct MaskedTiles {
    DepthTiles& tiles;
    const float* base;
    float* layer;
    uint64_t* layer_mask;
    uint32_t* block;
    bool blocks;  ///< some tile may have one

    explicit MaskedTiles(DepthTiles& from)
        : tiles(from),
          base(from.base.data()),
          layer(from.layer.data()),
          layer_mask(from.layer_mask.data()),
          block(from.block.data()),
          blocks(from.block_count != 0) {}

    /// coverPixels() for tiles that are not to have blocks, without a jump that depends on depths: those are as random
    /// as the polygons' order. The layer lies in front of the base, or there is none.
    HWY_INLINE void cover(uint32_t tile, uint64_t mask, float z) const {
        if (!(z > base[tile])) return;
        const float old_z = layer[tile];
        const bool has_layer = old_z > DepthTiles::kOpen;
        const uint64_t old = layer_mask[tile] & (uint64_t{0} - has_layer), both = old | mask;
        if (HWY_UNLIKELY(both == ~uint64_t{0} || (blocks && has_layer && block[tile] != DepthTiles::kNone)))
            return coverPixels(tiles, tile, mask, z);
        const uint64_t in_front = uint64_t{0} - (z > old_z);
        const uint64_t near_mask = old ^ ((old ^ mask) & in_front);
        const uint32_t near_bits = std::bit_cast<uint32_t>(std::max(z, old_z));
        const uint32_t far_bits = std::bit_cast<uint32_t>(std::min(z, old_z));
        const uint32_t says_it_all = uint32_t{0} - (both == near_mask);
        layer[tile] = std::bit_cast<float>(far_bits ^ ((far_bits ^ near_bits) & says_it_all));
        layer_mask[tile] = both;  // the nearer one's if that says it all
        block[tile] = DepthTiles::kNone;
    }
};

/// How near what is covered together lies, by the planes of its polygons: where a ray meets one of them, it is no farther
/// than the farthest of all planes there. If they bound something convex from the front, that is where they meet it.
struct ConvexDepth {
    static constexpr int kMost = 4;

    BufferPlane plane[kMost];
    double tilt[kMost];
    uint32_t index[kMost];  ///< in DepthTiles::planes
    int count = 0;          ///< none: all is as near as `floor`
    float floor = 0;        ///< no point is farther
    float nearest = 0;      ///< no point is nearer

    HWY_INLINE void add(const BufferPlane& of) {
        plane[count] = of;
        index[count] = DepthTiles::kNone;
        tilt[count++] = std::abs(of.dx) + std::abs(of.dy);
    }

    /// What it claims in a tile, and the plane that says it all there, or -1.
    HWY_INLINE float in(int32_t column, int32_t row, int& alone) const {
        alone = count - 1;
        if (count == 0) return floor;
        float least = lowIn(0, column, row, 1.0);
        if (count == 1) return least;
        float others = std::numeric_limits<float>::infinity();
        alone = 0;
        for (int k = 1; k < count; ++k) {
            const float low = lowIn(k, column, row, 1.0);
            others = std::min(others, std::max(low, least));
            if (low < least) alone = k;
            least = std::min(least, low);
        }
        if (!(lowIn(alone, column, row, -1.0) <= others)) alone = -1;
        return least;
    }

private:
    /// @param sign  1: no point of the plane is farther in the tile; -1: none is nearer
    HWY_INLINE float lowIn(int k, int32_t column, int32_t row, double sign) const {
        const BufferPlane& p = plane[k];
        const double center = p.d0 + p.dx * (8.0 * column + 4.0) + p.dy * (8.0 * row + 4.0);
        const double error = p.error + 0x1p-20 * (std::abs(center) + 8.0 * tilt[k]);
        return std::max(static_cast<float>(center - sign * (4.0 * tilt[k] + error)), p.floor);
    }
};

/// Whether any tile of a rectangle does not hide what is no nearer.
HWY_INLINE bool anyOpen(const DepthTiles& tiles, const ConvexOutline& p, float nearest) {
    const F16 d;
    for (int32_t row = 0; row < p.rows; ++row) {
        const float* base = tiles.base.data() + size_t{static_cast<uint32_t>(p.row0 + row)} * tiles.stride +
                            static_cast<size_t>(p.column0);
        for (int32_t i = 0; i < p.columns; i += static_cast<int32_t>(hn::Lanes(d))) {
            const auto open = hn::Lt(hn::LoadU(d, base + i), hn::Set(d, nearest));
            if (!hn::AllFalse(d, hn::And(hn::FirstN(d, static_cast<size_t>(p.columns - i)), open))) return true;
        }
    }
    return false;
}

/// Carries what a convex outline bounds into the tiles, row by row.
struct ConvexCover {
    DepthTiles& tiles;
    const ConvexOutline& p;
    ConvexDepth& depth;
    const uint32_t source;
    bool seams = false;  ///< it has left some
    PixelSpans inner{}, outer{};
    uint64_t in_rows = 0, out_rows = 0;  ///< in the row of tiles that is dealt with

    template <bool kSeams>
    inline void coverAll();
    template <bool kSeams>
    HWY_INLINE void coverTile(int32_t column, int32_t row, uint32_t tile);
    inline void coverRun(int32_t column, int32_t row, int32_t count, uint32_t tile);

    /// The name of a plane in the tiles.
    HWY_INLINE uint32_t nameOf(int k) {
        if (k < 0) return DepthTiles::kNone;
        uint32_t& index = depth.index[k];
        if (index == DepthTiles::kNone) {
            index = static_cast<uint32_t>(tiles.planes.size());
            tiles.planes.push_back(depth.plane[k]);
        }
        return index;
    }
    /// The planes that cover a tile: the one that says it all there, or all of them.
    HWY_INLINE PlaneSet planesOf(int alone) {
        if (alone >= 0 || depth.count == 0) return PlaneSet(nameOf(alone));
        PlaneSet out;
        for (int k = 0; k < depth.count; ++k) out.add(nameOf(k));
        return out;
    }
    inline void coverByPlanes(uint32_t tile, uint64_t mask, int alone);
};

/// Covers pixels of a tile each at its own depth.
inline void ConvexCover::coverByPlanes(uint32_t tile, uint64_t mask, int alone) {
    const F16 d;
    const uint32_t column = tile % tiles.stride, row = tile / tiles.stride;
    TilePlane planes[ConvexDepth::kMost] = {planeInTile(depth.plane[std::max(alone, 0)], column, row)};
    const int count = alone < 0 ? depth.count : 1;
    for (int k = 1; k < count; ++k) planes[k] = planeInTile(depth.plane[k], column, row);
    raiseBlockTo(tiles, tile, mask, [&](size_t i) HWY_ATTR {
        auto depths = planeDepths(d, planes[0], i);
        for (int k = 1; k < count; ++k) depths = hn::Min(depths, planeDepths(d, planes[k], i));
        return depths;
    });
}

template <bool kSeams>
HWY_INLINE void ConvexCover::coverTile(int32_t column, int32_t row, uint32_t tile) {
    if (!(tiles.base[tile] < depth.nearest)) return;
    const uint64_t covered = inner.inTile(column) & in_rows;
    if (covered) {
        int alone;
        const float z = depth.in(p.column0 + column, p.row0 + row, alone);
        if (kSeams && depth.count > 0 && (alone < 0 || covered != ~uint64_t{0}))
            noteCover(tiles, tile, covered, planesOf(alone));
        const double slope = depth.count == 0 ? 0.0 : alone < 0 ? 1e300 : depth.tilt[alone];
        const bool sloped = kSeams && tiles.detail == Detail::kFull && 8.0 * slope > 0x1p-9 * std::abs(z);
        if (covered == ~uint64_t{0} && (alone >= 0 || !sloped)) coverWhole(tiles, tile, z, nameOf(alone));
        else if (sloped) coverByPlanes(tile, covered, alone);
        else if (tiles.detail == Detail::kMasked) MaskedTiles(tiles).cover(tile, covered, z);
        else coverPixels(tiles, tile, covered, z);
    }
    if (!kSeams) return;
    const uint64_t touched = outer.inTile(column) & out_rows & ~covered;
    if (const uint64_t seam = touched ? notYetNearer(tiles, tile, touched, depth.nearest) : 0) {
        addSeam(tiles, tile, seam, source, depth.nearest);
        seams = true;
    }
}

/// Covers tiles of a row that lie wholly inside the outline.
inline void ConvexCover::coverRun(int32_t column, int32_t row, int32_t count, uint32_t tile) {
    const F16 d;
    const hn::Rebind<uint32_t, F16> u;
    const auto infinity = hn::Set(d, std::numeric_limits<float>::infinity());
    for (int k = 0; k < depth.count; ++k) nameOf(k);
    for (int32_t i = 0; i < count; i += static_cast<int32_t>(hn::Lanes(d))) {
        const auto ahead = hn::Iota(d, static_cast<float>(i));
        auto least = infinity, others = infinity, most = infinity;
        auto index = hn::Set(u, DepthTiles::kNone);
        for (int k = 0; k < depth.count; ++k) {
            const BufferPlane& p = depth.plane[k];
            const double center =
                p.d0 + p.dx * (8.0 * (this->p.column0 + column) + 4.0) + p.dy * (8.0 * (this->p.row0 + row) + 4.0);
            // Float adds its own: a few steps of what is computed at any of the tiles.
            const double error = p.error + 0x1p-20 * (std::abs(center) + 8.0 * depth.tilt[k] * (count + 1));
            const double range = 4.0 * depth.tilt[k] + error;
            const auto along = hn::Mul(hn::Set(d, static_cast<float>(8.0 * p.dx)), ahead);
            const auto floor = hn::Set(d, p.floor);
            const auto low = hn::Max(hn::Add(hn::Set(d, static_cast<float>(center - range)), along), floor);
            const auto high = hn::Max(hn::Add(hn::Set(d, static_cast<float>(center + range)), along), floor);
            const auto farther = hn::Lt(low, least);
            others = hn::Min(others, hn::Max(low, least));
            most = hn::IfThenElse(farther, high, most);
            index = hn::IfThenElse(hn::RebindMask(u, farther), hn::Set(u, depth.index[k]), index);
            least = hn::Min(least, low);
        }
        if (depth.count == 0) least = hn::Set(d, depth.floor);
        const auto mixed = hn::Gt(most, others);
        const auto within = hn::FirstN(d, static_cast<size_t>(count - i));
        if (depth.count > 1)
            for (uint64_t bits = bitsFromMask(d, hn::And(within, mixed)); bits; bits &= bits - 1)
                noteCover(tiles, tile + static_cast<uint32_t>(i + std::countr_zero(bits)), ~uint64_t{0}, planesOf(-1));
        float* base = tiles.base.data() + tile + i;
        auto better = hn::And(within, hn::Gt(least, hn::LoadU(d, base)));
        if (tiles.detail == Detail::kFull && depth.count > 1) {
            for (uint64_t bits = bitsFromMask(d, hn::And(within, mixed)); bits; bits &= bits - 1)
                coverByPlanes(tile + static_cast<uint32_t>(i + std::countr_zero(bits)), ~uint64_t{0}, -1);
            better = hn::AndNot(mixed, better);
        }
        if (hn::AllFalse(d, better)) continue;
        index = hn::IfThenElse(hn::RebindMask(u, mixed), hn::Set(u, DepthTiles::kNone), index);
        hn::BlendedStore(least, better, d, base);
        hn::BlendedStore(index, hn::RebindMask(u, better), u, tiles.plane.data() + tile + i);
        float* layer = tiles.layer.data() + tile + i;
        const auto outdone = hn::And(better, hn::Le(hn::LoadU(d, layer), least));
        hn::BlendedStore(hn::Set(d, DepthTiles::kOpen), outdone, d, layer);
    }
}

template <bool kSeams>
inline void ConvexCover::coverAll() {
    const double limit = 8.0 * p.rows;
    const auto rowOf = [&](double y) { return static_cast<int32_t>(std::clamp(y, -1.0, limit)); };
    const int32_t in_first = rowOf(std::ceil(p.inner_low + p.reach)),
                  in_end = rowOf(std::floor(p.inner_high - p.reach));
    const int32_t out_first = rowOf(std::floor(p.low - p.reach)), out_last = rowOf(std::floor(p.high + p.reach));
    const auto rows = [](int32_t first, int32_t last, int32_t row) {
        return bytesBetween(std::clamp(first - 8 * row, -8, 15), std::clamp(last - 8 * row, -8, 15));
    };
    for (int32_t row = 0; row < p.rows; ++row) {
        in_rows = rows(in_first, in_end - 1, row);
        if (!kSeams && !in_rows) continue;
        const uint32_t at = static_cast<uint32_t>(p.row0 + row) * tiles.stride + static_cast<uint32_t>(p.column0);
        int32_t first = 0, last = p.columns - 1;
        if (kSeams) {
            openInRow(tiles.base.data() + at, p.columns, depth.nearest, first, last);
            if (last < 0) continue;
            out_rows = rows(out_first, out_last, row);
        }
        p.spans<kSeams>(row, inner, outer);
        const PixelSpans& all = kSeams ? outer : inner;
        first = std::max(first, all.column0);
        last = std::min(last, all.column1);
        if (kSeams && in_rows == ~uint64_t{0}) {
            const int32_t from = std::max(first, inner.whole0), end = std::min(last + 1, inner.whole_end);
            if (from < end) {
                for (int32_t column = first; column < from; ++column)
                    coverTile<kSeams>(column, row, at + static_cast<uint32_t>(column));
                coverRun(from, row, end - from, at + static_cast<uint32_t>(from));
                first = end;
            }
        }
        for (int32_t column = first; column <= last; ++column)
            coverTile<kSeams>(column, row, at + static_cast<uint32_t>(column));
    }
}

/// @tparam kSeams  it leaves seams; and it may be large
/// @param source   as SeamEntry::source
/// @returns whether it left some
template <bool kSeams>
inline bool coverConvex(DepthTiles& tiles, const ConvexOutline& p, ConvexDepth& depth, uint32_t source) {
    ConvexCover cover{tiles, p, depth, source};
    cover.coverAll<kSeams>();
    return cover.seams;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
