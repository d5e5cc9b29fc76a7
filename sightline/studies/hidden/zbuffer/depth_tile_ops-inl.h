// What drawing does to one tile of a depth buffer, compiled once per instruction set.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_STUDIES_HIDDEN_ZBUFFER_DEPTH_TILE_OPS_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_STUDIES_HIDDEN_ZBUFFER_DEPTH_TILE_OPS_INL_H
#undef SIGHTLINE_STUDIES_HIDDEN_ZBUFFER_DEPTH_TILE_OPS_INL_H
#else
#define SIGHTLINE_STUDIES_HIDDEN_ZBUFFER_DEPTH_TILE_OPS_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cstring>

#include <hwy/highway.h>

#include "sightline/studies/hidden/zbuffer/depth_buffer_fragments.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Depths8 = hn::CappedTag<double, 8>;  // a row of a tile
using K8 = hn::Rebind<int32_t, Depths8>;
using DepthInts8 = hn::CappedTag<int32_t, 8>;
using I16 = hn::CappedTag<int32_t, 16>;

template <class D, class Mask>
HWY_INLINE uint64_t bitsOf(D d, Mask mask) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return bits[0];
}

template <class D>
HWY_INLINE hn::Mask<D> maskOf(D d, uint64_t bits) {
    uint8_t bytes[8];
    std::memcpy(bytes, &bits, sizeof bits);
    return hn::LoadMaskBits(d, bytes);
}

/// DepthCodec::encode() for many, with what is the same for a whole polygon.
template <bool kFloating, bool kReciprocal>
struct Encoder {
    double bias, gain, shift, sign, floor, top, half, offset;

    Encoder(const DepthCodec& codec, double polygon_offset)
        : bias(codec.bias),
          gain(codec.gain),
          shift(codec.shift),
          sign(codec.sign),
          floor(codec.floor),
          top(codec.top),
          half(codec.half),
          offset(polygon_offset) {}

    HWY_INLINE hn::Vec<K8> operator()(Depths8 d, hn::Vec<Depths8> nearness) const {
        const K8 k;
        auto t = nearness;
        if (kReciprocal) {
            const auto below = hn::Add(hn::Set(d, shift), hn::Mul(hn::Set(d, sign), nearness));
            t = hn::Div(hn::Set(d, 1.0), hn::Max(below, hn::Set(d, floor)));
        }
        auto depth = hn::Add(hn::Add(hn::Set(d, bias), hn::Mul(hn::Set(d, gain), t)), hn::Set(d, offset));
        depth = hn::Min(hn::Max(depth, hn::Zero(d)), hn::Set(d, top));
        if constexpr (kFloating) return hn::BitCast(k, hn::DemoteTo(hn::Rebind<float, Depths8>(), depth));
        else return hn::DemoteTo(k, hn::Sub(hn::Floor(hn::Add(depth, hn::Set(d, half))), hn::Set(d, 0x1p31)));
    }
};

/// Where a polygon lies over a tile, and which samples it covers.
struct TilePart {
    const DepthPlane* plane;
    int32_t row, sample;  ///< of the tile's first sample
    uint64_t mask;        ///< sample 8 * j + i of the tile
};

HWY_INLINE hn::Vec<Depths8> nearnessOf(Depths8 d, const DepthPlane& plane, double start, hn::Vec<Depths8> along) {
    const auto sum = hn::Add(hn::Set(d, start), along);
    return hn::Min(hn::Max(sum, hn::Set(d, plane.low)), hn::Set(d, plane.high));
}

inline int firstRow(uint64_t mask) { return std::countr_zero(mask) >> 3; }
inline int lastRow(uint64_t mask) { return (63 - std::countl_zero(mask)) >> 3; }

/// Writes what is nearer than what is there; returns the samples that it wrote. Rows of `surfaces` are `width` apart.
template <bool kGreater, class Encode>
HWY_INLINE uint64_t writeNearer(const Encode& encode, const TilePart& part, DepthKey* HWY_RESTRICT keys,
                                uint32_t* HWY_RESTRICT surfaces, size_t width, uint32_t surface) {
    const Depths8 d;
    const K8 k;
    const hn::RebindToUnsigned<K8> u;
    const DepthPlane& plane = *part.plane;
    uint64_t written = 0;
    const int first = firstRow(part.mask), last = lastRow(part.mask);
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto along = hn::Mul(hn::Set(d, plane.per_sample),
                                   hn::Iota(d, static_cast<double>(part.sample) + static_cast<double>(h)));
        for (int r = first; r <= last; ++r) {
            const size_t at = 8 * static_cast<size_t>(r) + h;
            const double start = plane.origin + plane.per_row * (part.row + r);
            const auto comes = encode(d, nearnessOf(d, plane, start, along));
            const auto there = hn::LoadU(k, keys + at);
            const auto covered = maskOf(k, part.mask >> at & 0xff);
            const auto pass = hn::And(covered, kGreater ? hn::Gt(comes, there) : hn::Lt(comes, there));
            hn::BlendedStore(comes, pass, k, keys + at);
            hn::BlendedStore(hn::Set(u, surface), hn::RebindMask(u, pass), u,
                             surfaces + static_cast<size_t>(r) * width + h);
            written |= bitsOf(k, pass) << at;
        }
    }
    return written;
}

/// Writes all samples of a tile.
template <class Encode>
HWY_INLINE void writeAll(const Encode& encode, const TilePart& part, DepthKey* HWY_RESTRICT keys,
                         uint32_t* HWY_RESTRICT surfaces, size_t width, uint32_t surface) {
    const Depths8 d;
    const K8 k;
    const hn::RebindToUnsigned<K8> u;
    const DepthPlane& plane = *part.plane;
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto along = hn::Mul(hn::Set(d, plane.per_sample),
                                   hn::Iota(d, static_cast<double>(part.sample) + static_cast<double>(h)));
        for (int r = 0; r < 8; ++r) {
            const double start = plane.origin + plane.per_row * (part.row + r);
            hn::StoreU(encode(d, nearnessOf(d, plane, start, along)), k, keys + 8 * r + h);
            hn::StoreU(hn::Set(u, surface), u, surfaces + static_cast<size_t>(r) * width + h);
        }
    }
}

/// The keys of all samples of a tile.
template <class Encode>
HWY_INLINE void encodeTile(const Encode& encode, const TilePart& part, DepthKey* HWY_RESTRICT out) {
    const Depths8 d;
    const K8 k;
    const DepthPlane& plane = *part.plane;
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto along = hn::Mul(hn::Set(d, plane.per_sample),
                                   hn::Iota(d, static_cast<double>(part.sample) + static_cast<double>(h)));
        for (int r = 0; r < 8; ++r) {
            const double start = plane.origin + plane.per_row * (part.row + r);
            hn::StoreU(encode(d, nearnessOf(d, plane, start, along)), k, out + 8 * r + h);
        }
    }
}

inline void fillTile(DepthKey* keys, DepthKey key) {
    const I16 d;
    for (size_t i = 0; i < 64; i += hn::Lanes(d)) hn::StoreU(hn::Set(d, key), d, keys + i);
}

/// Makes a tile's bounds tight.
inline void tightenBounds(DepthBuffer& buffer, uint32_t tile) {
    buffer.loose[tile] = 0;
    const I16 d;
    const DepthKey* keys = buffer.tileKeys(tile);
    auto least = hn::LoadU(d, keys), greatest = least;
    for (size_t i = hn::Lanes(d); i < 64; i += hn::Lanes(d)) {
        least = hn::Min(least, hn::LoadU(d, keys + i));
        greatest = hn::Max(greatest, hn::LoadU(d, keys + i));
    }
    buffer.least[tile] = hn::GetLane(hn::MinOfLanes(d, least));
    buffer.greatest[tile] = hn::GetLane(hn::MaxOfLanes(d, greatest));
}

/// The samples of eight rows that a polygon covers: none of a row where begin >= end.
struct SampleSpans {
    static constexpr int32_t kFar = 1 << 28;

    alignas(32) int32_t begin[8], end[8];

    void clear() {
        std::fill(begin, begin + 8, kFar);
        std::fill(end, end + 8, 0);
    }
};

/// First sample that any row covers, first that all rows cover, and the ends of these.
struct SpanExtent {
    int32_t begin, full_begin, full_end, end;
};

inline SpanExtent extentOf(const SampleSpans& spans) {
    const DepthInts8 d;
    auto begin = hn::Set(d, SampleSpans::kFar), full_end = begin;
    auto end = hn::Zero(d), full_begin = end;
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto b = hn::Load(d, spans.begin + h), e = hn::Load(d, spans.end + h);
        const auto any = hn::Lt(b, e);
        begin = hn::IfThenElse(any, hn::Min(begin, b), begin);
        end = hn::IfThenElse(any, hn::Max(end, e), end);
        full_begin = hn::Max(full_begin, b);
        full_end = hn::Min(full_end, e);
    }
    return {hn::GetLane(hn::MinOfLanes(d, begin)), hn::GetLane(hn::MaxOfLanes(d, full_begin)),
            hn::GetLane(hn::MinOfLanes(d, full_end)), hn::GetLane(hn::MaxOfLanes(d, end))};
}

/// The samples of a tile that spans cover.
inline uint64_t tileMask(const SampleSpans& spans, int32_t sample) {
    const DepthInts8 d;
    const hn::Rebind<uint8_t, DepthInts8> bytes;
    const auto zero = hn::Zero(d), eight = hn::Set(d, 8), one = hn::Set(d, 1), at = hn::Set(d, sample);
    uint8_t rows[16] = {};
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto low = hn::Min(hn::Max(hn::Sub(hn::Load(d, spans.begin + h), at), zero), eight);
        const auto high = hn::Min(hn::Max(hn::Sub(hn::Load(d, spans.end + h), at), zero), eight);
        const auto bits = hn::Max(hn::Sub(hn::Shl(one, high), hn::Shl(one, low)), zero);
        hn::StoreU(hn::DemoteTo(bytes, bits), bytes, rows + h);
    }
    uint64_t mask;
    std::memcpy(&mask, rows, sizeof mask);
    return mask;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
