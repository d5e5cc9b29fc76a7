// Which samples are still free while an image is drawn near to far: looked up, as lists of segments, or as bits.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/dynamic_screen.h"

namespace sightline::studies {

SegmentScreen::SegmentScreen(int32_t width, int32_t height)
    : pool_(static_cast<size_t>(height)), free_(static_cast<uint64_t>(width) * static_cast<uint64_t>(height)) {
    pool_.reserve(4 * pool_.size());
    for (int32_t row = 0; row < height && width > 0; ++row) {
        const uint32_t whole = make(0, width, kEnd);
        pool_[static_cast<size_t>(row)].next = whole;
    }
}

bool SegmentScreen::anyFree(const ScreenWindow& window) const {
    if (window.begin >= window.end) return false;
    for (int32_t row = window.row_begin; row < window.row_end; ++row) {
        uint32_t at = pool_[static_cast<size_t>(row)].next;
        while (at != kEnd && pool_[at].end <= window.begin) at = pool_[at].next;
        if (at != kEnd && pool_[at].begin < window.end) return true;
    }
    return false;
}

BitScreen::BitScreen(int32_t width, int32_t height)
    : columns_((static_cast<size_t>(width) + 63) / 64),
      words_(columns_ * static_cast<size_t>(height), ~uint64_t{0}),
      rows_(columns_ * ((static_cast<size_t>(height) + 63) / 64), ~uint64_t{0}),
      free_in_row_(static_cast<size_t>(height), static_cast<uint32_t>(width)),
      free_(static_cast<uint64_t>(width) * static_cast<uint64_t>(height)) {
    if (width <= 0 || height <= 0) return;
    const uint64_t last_word = maskOf(0, width, static_cast<int32_t>(columns_) - 1);
    for (size_t row = 0; row < static_cast<size_t>(height); ++row) words_[(row + 1) * columns_ - 1] = last_word;
    const int32_t last_band = (height - 1) >> 6;
    for (size_t column = 0; column < columns_; ++column)
        rows_[static_cast<size_t>(last_band) * columns_ + column] = maskOf(0, height, last_band);
}

bool BitScreen::anyFree(const ScreenWindow& window) const {
    if (window.empty()) return false;
    const int32_t first = window.begin >> 6, last = (window.end - 1) >> 6;
    for (int32_t band = window.row_begin >> 6; band <= (window.row_end - 1) >> 6; ++band) {
        const uint64_t inside = maskOf(window.row_begin, window.row_end, band);
        for (int32_t column = first; column <= last; ++column) {
            uint64_t rows = rows_[static_cast<size_t>(band) * columns_ + static_cast<size_t>(column)] & inside;
            const uint64_t mask = maskOf(window.begin, window.end, column);
            if (rows != 0 && mask == ~uint64_t{0}) return true;
            for (; rows != 0; rows &= rows - 1) {
                const size_t row = static_cast<size_t>(band) * 64 + static_cast<size_t>(std::countr_zero(rows));
                if ((words_[row * columns_ + static_cast<size_t>(column)] & mask) != 0) return true;
            }
        }
    }
    return false;
}

}  // namespace sightline::studies
