// Which samples are still free while an image is drawn near to far: looked up, as lists of segments, or as bits.
// SPDX-License-Identifier: MIT
//
// Dan Gordon, Shuhong Chen. Front-to-Back Display of BSP Trees. 1991.
#pragma once

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "sightline/studies/hidden/bsp/bsp_frame.h"
#include "sightline/studies/hidden/image.h"

namespace sightline::studies {

/// A dynamic screen has
///   take(row, begin, end, draw)  which makes free samples of a span taken, and calls draw(begin, end) for their runs;
///   anyFree(window)              whether a window has a free sample;
///   forFreeRows(window, draw)    which calls draw(row_begin, row_end) for runs of rows that may have free samples in the
///                                window, and leaves out none that has;
///   full()                       whether no sample is free.
/// Spans and windows lie within the screen.

/// No memory of its own: every sample is looked at, every time.
class CheckedScreen {
public:
    explicit CheckedScreen(const HiddenImage& image) : image_(image) {}

    template <class Draw>
    void take(int32_t row, int32_t begin, int32_t end, Draw&& draw) {
        const uint32_t* line = image_.surface.data() + static_cast<size_t>(row) * image_.width;
        for (int32_t i = begin; i < end; ++i)
            if (line[i] == HiddenImage::kNone) draw(i, i + 1);
    }
    bool anyFree(const ScreenWindow& window) const { return !window.empty(); }
    template <class Draw>
    void forFreeRows(const ScreenWindow& window, Draw&& draw) const {
        draw(window.row_begin, window.row_end);
    }
    bool full() const { return false; }

private:
    const HiddenImage& image_;
};

/// Per row a linked list of segments, from left to right, in a pool of their own.
class SegmentScreen {
public:
    SegmentScreen(int32_t width, int32_t height);

    template <class Draw>
    void take(int32_t row, int32_t begin, int32_t end, Draw&& draw) {
        uint32_t before = static_cast<uint32_t>(row);  // the row's own entry is the head of its list
        uint32_t at = pool_[before].next;
        while (at != kEnd && pool_[at].end <= begin) {
            before = at;
            at = pool_[at].next;
        }
        while (at != kEnd && pool_[at].begin < end) {
            const Segment segment = pool_[at];
            const int32_t from = std::max(begin, segment.begin), to = std::min(end, segment.end);
            draw(from, to);
            free_ -= static_cast<uint64_t>(to - from);
            if (from == segment.begin && to == segment.end) {
                remove(before, at);
                at = segment.next;
                continue;
            }
            if (from > segment.begin && to < segment.end) {
                const uint32_t rest = make(to, segment.end, segment.next);
                pool_[at].end = from;
                pool_[at].next = rest;
                return;
            }
            if (from == segment.begin) pool_[at].begin = to;
            else pool_[at].end = from;
            before = at;
            at = segment.next;
        }
    }
    bool anyFree(const ScreenWindow& window) const;
    template <class Draw>
    void forFreeRows(const ScreenWindow& window, Draw&& draw) const {
        for (int32_t row = window.row_begin; row < window.row_end;) {
            if (pool_[static_cast<size_t>(row)].next == kEnd) {
                ++row;
                continue;
            }
            int32_t end = row + 1;
            while (end < window.row_end && pool_[static_cast<size_t>(end)].next != kEnd) ++end;
            draw(row, end);
            row = end;
        }
    }
    bool full() const { return free_ == 0; }
    uint64_t free() const { return free_; }

private:
    static constexpr uint32_t kEnd = ~0u;
    struct Segment {
        int32_t begin = 0, end = 0;
        uint32_t next = kEnd;
    };

    void remove(uint32_t before, uint32_t at) {
        pool_[before].next = pool_[at].next;
        pool_[at].next = unused_;
        unused_ = at;
    }
    uint32_t make(int32_t begin, int32_t end, uint32_t next) {
        uint32_t at = unused_;
        if (at == kEnd) {
            at = static_cast<uint32_t>(pool_.size());
            pool_.emplace_back();
        } else {
            unused_ = pool_[at].next;
        }
        pool_[at] = {begin, end, next};
        return at;
    }

    std::vector<Segment> pool_;  ///< first the rows' heads, then the segments
    uint32_t unused_ = kEnd;
    uint64_t free_;
};

/// A bit a sample, and a bit for each word of 64 that has a free one: words of one column and 64 rows side by side.
class BitScreen {
public:
    BitScreen(int32_t width, int32_t height);

    template <class Draw>
    void take(int32_t row, int32_t begin, int32_t end, Draw&& draw) {
        uint32_t& free_here = free_in_row_[static_cast<size_t>(row)];
        if (free_here == 0) return;
        uint64_t* line = words_.data() + static_cast<size_t>(row) * columns_;
        const int32_t first = begin >> 6, last = (end - 1) >> 6;
        const uint64_t from_begin = ~uint64_t{0} << (begin & 63), to_end = ~uint64_t{0} >> (63 - ((end - 1) & 63));
        for (int32_t column = first; column <= last; ++column) {
            uint64_t& word = line[column];
            uint64_t hit =
                word & (column == first ? from_begin : ~uint64_t{0}) & (column == last ? to_end : ~uint64_t{0});
            if (hit == 0) continue;
            word &= ~hit;
            const uint32_t count = static_cast<uint32_t>(std::popcount(hit));
            free_ -= count;
            free_here -= count;
            if (word == 0) rowsOf(row, column) &= ~(uint64_t{1} << (row & 63));
            while (hit != 0) {
                const int from = std::countr_zero(hit);
                const int to = from + std::countr_one(hit >> from);
                draw(column * 64 + from, column * 64 + to);
                if (to >= 64) break;
                hit &= ~uint64_t{0} << to;
            }
        }
    }
    bool anyFree(const ScreenWindow& window) const;
    template <class Draw>
    void forFreeRows(const ScreenWindow& window, Draw&& draw) const {
        int32_t run = -1, run_end = -1;  // of rows that have free words, across bands
        for (int32_t band = window.row_begin >> 6; band <= (window.row_end - 1) >> 6; ++band) {
            uint64_t rows = 0;
            for (int32_t column = window.begin >> 6; column <= (window.end - 1) >> 6; ++column)
                rows |= rows_[static_cast<size_t>(band) * columns_ + static_cast<size_t>(column)];
            rows &= maskOf(window.row_begin, window.row_end, band);
            while (rows != 0) {
                const int from = std::countr_zero(rows), count = std::countr_one(rows >> from);
                const int32_t begin = band * 64 + from;
                if (begin != run_end) {
                    if (run >= 0) draw(run, run_end);
                    run = begin;
                }
                run_end = begin + count;
                if (from + count >= 64) break;
                rows &= ~uint64_t{0} << (from + count);
            }
        }
        if (run >= 0) draw(run, run_end);
    }
    bool full() const { return free_ == 0; }
    uint64_t free() const { return free_; }

private:
    /// The bits of word number `word` that lie in [begin, end); the two overlap.
    static uint64_t maskOf(int32_t begin, int32_t end, int32_t word) {
        const int32_t first = begin - word * 64, last = end - word * 64;
        uint64_t mask = ~uint64_t{0};
        if (first > 0) mask &= ~uint64_t{0} << first;
        if (last < 64) mask &= ~(~uint64_t{0} << last);
        return mask;
    }
    uint64_t& rowsOf(int32_t row, int32_t column) {
        return rows_[static_cast<size_t>(row >> 6) * columns_ + static_cast<size_t>(column)];
    }

    size_t columns_;               ///< words a row
    std::vector<uint64_t> words_;  ///< per row and column: the free samples
    std::vector<uint64_t> rows_;   ///< per 64 rows and column: those whose word is not 0
    std::vector<uint32_t> free_in_row_;
    uint64_t free_;
};

}  // namespace sightline::studies
