// Draws polygons into one row of a depth buffer's tiles: coverage, hierarchical rejection, depth test.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_buffer_draw.h"

#include <algorithm>
#include <atomic>
#include <bit>

#include "sightline/studies/hidden/project/scan.h"

#ifdef __x86_64__
// The drawer has twelve forms, and each is compiled for each instruction set. AVX2 and the baseline take 7 s, all four 13 s;
// on a processor with AVX-512 the image of city:1:10000 then takes 1.04 of the time (sightline render, 1 thread).
#undef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_SSSE3 | HWY_SSE4 | HWY_AVX3 | HWY_AVX3_DL)
#endif
#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/studies/hidden/zbuffer/depth_buffer_draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/studies/hidden/zbuffer/depth_tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::studies {
namespace HWY_NAMESPACE {

/// The samples that a triangle covers of eight rows; as scanPolygon(), but eight rows at once.
void spansOfTriangle(const DepthPolygon& p, int32_t first_row, int32_t width, SampleSpans& spans) {
    const Depths8 d;
    const K8 k;
    const auto half = hn::Set(d, 0.5), limit = hn::Set(d, static_cast<double>(width)), zero = hn::Zero(d);
    const auto doubt = hn::Set(d, p.doubt);
    uint64_t doubtful = 0;
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto row = hn::Iota(d, static_cast<double>(first_row) + static_cast<double>(h));
        const auto y = hn::Add(row, half);
        const auto from_low = hn::Sub(y, hn::Set(d, p.y[0])), from_middle = hn::Sub(y, hn::Set(d, p.y[1]));
        const auto met = hn::And(hn::And(hn::Lt(hn::Set(d, p.y[0]), y), hn::Ge(hn::Set(d, p.y[2]), y)),
                                 hn::Lt(row, hn::Set(d, static_cast<double>(p.row_end))));
        const auto lower = hn::Ge(hn::Set(d, p.y[1]), y);
        const auto across = [&](auto from, int corner, int edge) HWY_ATTR {
            return hn::Sub(hn::Add(hn::Set(d, p.x[corner]), hn::Mul(from, hn::Set(d, p.slope[edge]))), half);
        };
        const auto a = across(from_low, 0, 0);
        const auto b = hn::IfThenElse(lower, across(from_low, 0, 1), across(from_middle, 1, 2));
        const auto sure = [&](auto x) HWY_ATTR { return hn::Gt(hn::Abs(hn::Sub(x, hn::Round(x))), doubt); };
        const auto both = hn::And(sure(a), sure(b));
        doubtful |= bitsOf(d, hn::And(met, hn::Not(both))) << h;
        const auto sampleOf = [&](auto x) HWY_ATTR { return hn::Min(hn::Max(hn::Ceil(x), zero), limit); };
        const auto at_a = sampleOf(a), at_b = sampleOf(b);
        const auto begin = hn::IfThenElse(met, hn::Min(at_a, at_b), hn::Set(d, double{SampleSpans::kFar}));
        hn::Store(hn::DemoteTo(k, begin), k, spans.begin + h);
        hn::Store(hn::DemoteTo(k, hn::IfThenElseZero(met, hn::Max(at_a, at_b))), k, spans.end + h);
    }
    for (; doubtful != 0; doubtful &= doubtful - 1) {
        const int r = std::countr_zero(doubtful);
        const int32_t row = first_row + r;
        const glm::dvec2 low(p.x[0], p.y[0]), middle(p.x[1], p.y[1]), high(p.x[2], p.y[2]);
        const int32_t a = firstSampleRightOf(low, high, row, width);
        const int32_t b = p.y[1] >= row + 0.5 ? firstSampleRightOf(low, middle, row, width)
                                              : firstSampleRightOf(middle, high, row, width);
        spans.begin[r] = std::min(a, b);
        spans.end[r] = std::max(a, b);
    }
}

/// True if all tiles [first, last] are known to hide what is no nearer than a key.
template <bool kGreater>
bool tilesHide(const DepthBuffer& buffer, uint32_t first, uint32_t last, DepthKey nearest) {
    const DepthKey* bounds = kGreater ? buffer.least.data() : buffer.greatest.data();
    const I16 d;
    const auto limit = hn::Set(d, nearest);
    for (uint32_t tile = first; tile <= last; tile += static_cast<uint32_t>(hn::Lanes(d))) {
        if (last - tile + 1 < hn::Lanes(d)) {
            for (; tile <= last; ++tile)
                if (kGreater ? bounds[tile] < nearest : bounds[tile] > nearest) return false;
            return true;
        }
        const auto bound = hn::LoadU(d, bounds + tile);
        if (!hn::AllFalse(d, kGreater ? hn::Lt(bound, limit) : hn::Gt(bound, limit))) return false;
    }
    return true;
}

/// Draws one row of tiles.
/// kPlain: nothing but what is nearer passes, and all that passes is written.
template <bool kFloating, bool kReciprocal, bool kGreater, bool kPlain>
class RowDrawer {
    using Encode = Encoder<kFloating, kReciprocal>;

public:
    RowDrawer(const DepthDraw& draw, uint32_t tile_row, DepthDrawScratch& scratch)
        : draw_(draw),
          buffer_(draw.buffer),
          tile_row_(tile_row),
          row_(static_cast<int32_t>(tile_row * 8)),
          width_(static_cast<int32_t>(draw.buffer.width)),
          hierarchy_(draw.settings.hierarchy && allowsEarlyTest(draw.settings, draw.comparison, draw.codec.convention)),
          fragments_(draw),
          keeping_(draw.settings.compression),
          scratch_(scratch) {}

    void draw(const PolygonBatch& batch) {
        for (const PolygonBatch::Entry& entry : batch.rows[tile_row_]) {
            if constexpr (kPlain) {
                if (hierarchy_ &&
                    tilesHide<kGreater>(buffer_, tileAt(entry.first), tileAt(entry.last), entry.nearest)) {
                    noteRejected(batch, entry.polygon);
                    continue;
                }
            }
            drawPolygon(batch, entry.polygon);
        }
    }

    void finish() {
        HiddenCounters& sum = scratch_.counters;
        sum.generated += count_.generated;
        sum.tested += count_.tested;
        sum.passed += count_.passed;
        sum.shaded += kPlain ? count_.passed : count_.shaded;
        sum.hierarchy_rejected_polygons += count_.hierarchy_rejected_polygons;
        sum.hierarchy_rejected_tiles += count_.hierarchy_rejected_tiles;
        sum.hierarchy_accepted_tiles += count_.hierarchy_accepted_tiles;
    }

private:
    struct Keys {
        DepthKey least, greatest;
    };

    /// The keys at the corners of a rectangle of samples, both ends included: bounds of all in it, as every step of the
    /// arithmetic is monotonic.
    Keys keysOver(const DepthPolygon& p, int32_t row_low, int32_t row_high, int32_t low, int32_t high) const {
        const DepthPlane& plane = p.depth;
        const bool up = plane.per_row >= 0, right = plane.per_sample >= 0;
        const DepthKey near_key = draw_.codec.encode(plane.at(up ? row_high : row_low, right ? high : low), p.offset);
        const DepthKey far_key = draw_.codec.encode(plane.at(up ? row_low : row_high, right ? low : high), p.offset);
        return {std::min(near_key, far_key), std::max(near_key, far_key)};
    }
    DepthKey nearestOver(const DepthPolygon& p, int32_t row_low, int32_t row_high, int32_t low, int32_t high) const {
        const DepthPlane& plane = p.depth;
        return draw_.codec.encode(plane.at(plane.per_row >= 0 ? row_high : row_low, plane.per_sample >= 0 ? high : low),
                                  p.offset);
    }

    uint32_t tileAt(int32_t column) const { return tile_row_ * buffer_.stride + static_cast<uint32_t>(column); }

    /// A polygon that is hidden in all rows of tiles that it meets is rejected as a whole.
    void noteRejected(const PolygonBatch& batch, uint32_t index) {
        PolygonBatch::Rejection& rejection = batch.rejections[index];
        const std::atomic_ref<uint32_t> rejected(rejection.rejected);
        count_.hierarchy_rejected_polygons +=
            rejection.rows == 1 || rejected.fetch_add(1, std::memory_order_relaxed) + 1 == rejection.rows;
    }

    void drawPolygon(const PolygonBatch& batch, uint32_t index) {
        const DepthPolygon& p = batch.polygons[index];
        const int32_t low = std::max(p.row_begin, row_), high = std::min(p.row_end, row_ + 8) - 1;
        if (hierarchy_ && isHidden(p, low, high)) {
            noteRejected(batch, index);
            if (!fragments_.countsSamples()) return;
            hidden_ = true;
        }
        if (p.outline == DepthPolygon::kTriangle) {
            spansOfTriangle(p, row_, width_, spans_);
            drawSpans(p, low, high);
        } else {
            drawOutline(batch, p, low, high);
        }
        hidden_ = false;
    }

    bool isHidden(const DepthPolygon& p, int32_t low, int32_t high) const {
        const uint32_t first = tileAt(p.begin / 8), last = tileAt((p.end - 1) / 8);
        if constexpr (kPlain) {
            return tilesHide<kGreater>(buffer_, first, last, nearestOver(p, low, high, p.begin, p.end - 1));
        } else {
            const Keys keys = keysOver(p, low, high, p.begin, p.end - 1);
            for (uint32_t tile = first; tile <= last; ++tile)
                if (!rejectsAll(draw_.comparison, keys.least, keys.greatest, buffer_.least[tile],
                                buffer_.greatest[tile]))
                    return false;
            return true;
        }
    }

    /// Any outline: span by span, as many rounds as a row has spans.
    void drawOutline(const PolygonBatch& batch, const DepthPolygon& p, int32_t low, int32_t high) {
        const size_t at = static_cast<size_t>(p.outline);
        for (int round = 0, more = 1; round < more; ++round) {
            spans_.clear();
            int seen[8] = {};
            const auto take = [&](int32_t row, int32_t begin, int32_t end) {
                const int r = row - row_;
                more = std::max(more, seen[r] + 1);
                if (seen[r]++ != round) return;
                spans_.begin[r] = begin;
                spans_.end[r] = end;
            };
            if (p.is_clipless) scanHomogeneous(batch.clipless[at], low, high + 1, width_, take);
            else scanPolygon(batch.outlines[at].outline(), low, high + 1, width_, take);
            drawSpans(p, low, high);
        }
    }

    void drawSpans(const DepthPolygon& p, int32_t low, int32_t high) {
        const SpanExtent extent = extentOf(spans_);
        if (extent.begin >= extent.end) return;
        const Encode encode(draw_.codec, p.offset);
        const bool whole_rows = high - low == 7;
        for (int32_t column = extent.begin / 8; column <= (extent.end - 1) / 8; ++column) {
            const int32_t sample = 8 * column;
            const bool full = whole_rows && sample >= extent.full_begin && sample + 8 <= extent.full_end;
            const int32_t first = std::max(sample, extent.begin), last = std::min(sample + 8, extent.end) - 1;
            const TilePart part{&p.depth, row_, sample, full ? ~uint64_t{0} : tileMask(spans_, sample)};
            if (part.mask == 0) continue;
            if constexpr (kPlain) drawPlain(encode, p, part, nearestOver(p, low, high, first, last));
            else drawGeneral(encode, p, part, keysOver(p, low, high, first, last));
        }
    }

    void touch(uint32_t tile) {
        if (keeping_) fragments_.touch(tile, scratch_);
    }

    void noteWritten(int32_t sample) {
        if (keeping_) scratch_.is_touched[static_cast<size_t>(sample / 8)] = 2;
    }

    /// Makes sure that a tile's keys are there.
    void open(uint32_t tile) {
        if (buffer_.state[tile] != DepthBuffer::State::kCleared) return;
        fillTile(buffer_.tileKeys(tile), buffer_.clear_key);
        buffer_.state[tile] = DepthBuffer::State::kRaw;
    }

    bool hides(uint32_t tile, DepthKey nearest) const {
        return kGreater ? nearest <= buffer_.least[tile] : nearest >= buffer_.greatest[tile];
    }

    void drawPlain(const Encode& encode, const DepthPolygon& p, const TilePart& part, DepthKey nearest) {
        const uint32_t tile = tileAt(part.sample / 8);
        const uint64_t covered = static_cast<uint64_t>(std::popcount(part.mask));
        if (hierarchy_) {
            bool hidden = hides(tile, nearest);
            const bool in_doubt = kGreater ? nearest <= buffer_.greatest[tile] : nearest >= buffer_.least[tile];
            if (!hidden && in_doubt && buffer_.loose[tile] != 0 && buffer_.state[tile] == DepthBuffer::State::kRaw) {
                tightenBounds(buffer_, tile);
                hidden = hides(tile, nearest);
            }
            if (hidden) {
                ++count_.hierarchy_rejected_tiles;
                return;
            }
        }
        count_.generated += covered;
        touch(tile);
        const bool cut = part.sample + 8 > width_;
        uint32_t edge[64];
        const size_t width = cut ? 8 : static_cast<size_t>(width_);
        uint32_t* image = draw_.image.surface.data() + static_cast<size_t>(row_) * static_cast<size_t>(width_) +
                          static_cast<size_t>(part.sample);
        uint32_t* surfaces = cut ? edge : image;
        DepthKey& near_bound = kGreater ? buffer_.greatest[tile] : buffer_.least[tile];
        DepthKey& far_bound = kGreater ? buffer_.least[tile] : buffer_.greatest[tile];
        if (hierarchy_ && part.mask == ~uint64_t{0}) {
            const DepthPlane& plane = p.depth;
            const DepthKey farthest = draw_.codec.encode(
                plane.at(plane.per_row >= 0 ? row_ : row_ + 7, plane.per_sample >= 0 ? part.sample : part.sample + 7),
                p.offset);
            if (kGreater ? farthest > near_bound : farthest < near_bound) {
                ++count_.hierarchy_accepted_tiles;
                count_.passed += 64;
                noteWritten(part.sample);
                writeAll(encode, part, buffer_.tileKeys(tile), surfaces, width, p.surface);
                buffer_.state[tile] = DepthBuffer::State::kRaw;
                near_bound = nearest;
                far_bound = farthest;
                buffer_.loose[tile] = 0;
                return;
            }
        }
        open(tile);
        count_.tested += covered;
        const uint64_t written =
            writeNearer<kGreater>(encode, part, buffer_.tileKeys(tile), surfaces, width, p.surface);
        if (written == 0) return;
        count_.passed += static_cast<uint64_t>(std::popcount(written));
        near_bound = kGreater ? std::max(near_bound, nearest) : std::min(near_bound, nearest);
        buffer_.loose[tile] = 1;
        noteWritten(part.sample);
        if (cut) fragments_.show(part.row, part.sample, written, p.surface);
    }

    void drawGeneral(const Encode& encode, const DepthPolygon& p, const TilePart& part, const Keys& keys) {
        const uint32_t tile = tileAt(part.sample / 8);
        if (hierarchy_ && !hidden_) {
            if (buffer_.loose[tile] != 0 && buffer_.state[tile] == DepthBuffer::State::kRaw)
                tightenBounds(buffer_, tile);
            if (rejectsAll(draw_.comparison, keys.least, keys.greatest, buffer_.least[tile], buffer_.greatest[tile])) {
                ++count_.hierarchy_rejected_tiles;
                if (!fragments_.countsSamples()) return;
                fragments_.countGenerated(part.row, part.sample, part.mask, count_);
                return;
            }
        }
        if (hidden_) return fragments_.countGenerated(part.row, part.sample, part.mask, count_);
        touch(tile);
        open(tile);
        const bool accepted = hierarchy_ && acceptsAll(draw_.comparison, keys.least, keys.greatest, buffer_.least[tile],
                                                       buffer_.greatest[tile]);
        count_.hierarchy_accepted_tiles += accepted;
        DepthKey comes[64];
        encodeTile(encode, part, comes);
        if (fragments_.drawTile({p, part.row, part.sample, part.mask, tile, accepted}, comes, count_)) {
            tightenBounds(buffer_, tile);
            noteWritten(part.sample);
        }
    }

    const DepthDraw& draw_;
    DepthBuffer& buffer_;
    const uint32_t tile_row_;
    const int32_t row_, width_;
    const bool hierarchy_;
    FragmentDrawer fragments_;
    const bool keeping_;
    bool hidden_ = false;  ///< the polygon, which is drawn for the sake of counting alone
    DepthDrawScratch& scratch_;
    HiddenCounters count_;
    SampleSpans spans_;
};

template <bool kFloating, bool kReciprocal, bool kGreater, bool kPlain>
void drawRow(const DepthDraw& draw, uint32_t tile_row, std::span<const PolygonBatch> batches,
             DepthDrawScratch& scratch) {
    RowDrawer<kFloating, kReciprocal, kGreater, kPlain> drawer(draw, tile_row, scratch);
    for (const PolygonBatch& batch : batches) drawer.draw(batch);
    drawer.finish();
}

template <bool kFloating, bool kReciprocal>
void drawRowOfFormat(const DepthDraw& draw, uint32_t tile_row, std::span<const PolygonBatch> batches,
                     DepthDrawScratch& scratch) {
    if (!isPlain(draw)) drawRow<kFloating, kReciprocal, true, false>(draw, tile_row, batches, scratch);
    else if (draw.comparison == DepthComparison::kGreater)
        drawRow<kFloating, kReciprocal, true, true>(draw, tile_row, batches, scratch);
    else drawRow<kFloating, kReciprocal, false, true>(draw, tile_row, batches, scratch);
}

void drawTileRowKernel(const DepthDraw& draw, uint32_t tile_row, std::span<const PolygonBatch> batches,
                       DepthDrawScratch& scratch) {
    const DepthCodec& codec = draw.codec;
    if (codec.floating && codec.reciprocal) drawRowOfFormat<true, true>(draw, tile_row, batches, scratch);
    else if (codec.floating) drawRowOfFormat<true, false>(draw, tile_row, batches, scratch);
    else if (codec.reciprocal) drawRowOfFormat<false, true>(draw, tile_row, batches, scratch);
    else drawRowOfFormat<false, false>(draw, tile_row, batches, scratch);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline::studies
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::studies {

HWY_EXPORT(drawTileRowKernel);

void drawTileRow(const DepthDraw& draw, uint32_t tile_row, std::span<const PolygonBatch> batches,
                 DepthDrawScratch& scratch) {
    HWY_DYNAMIC_DISPATCH(drawTileRowKernel)(draw, tile_row, batches, scratch);
    keepTiles(draw, scratch);
}

}  // namespace sightline::studies
#endif  // HWY_ONCE
