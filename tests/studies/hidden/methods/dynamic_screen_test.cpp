// Segments and bits know at any time which samples are free, as an array of flags does.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/methods/dynamic_screen.h"

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline::test {
using namespace studies;
namespace {

struct Flags {
    int32_t width, height;
    std::vector<uint8_t> free;

    Flags(int32_t w, int32_t h) : width(w), height(h), free(size_t(w) * size_t(h), 1) {}
    uint8_t& at(int32_t row, int32_t i) { return free[size_t(row) * size_t(width) + size_t(i)]; }
    bool any(const ScreenWindow& w) {
        for (int32_t row = w.row_begin; row < w.row_end; ++row)
            for (int32_t i = w.begin; i < w.end; ++i)
                if (at(row, i)) return true;
        return false;
    }
    uint64_t count() const { return uint64_t(std::count(free.begin(), free.end(), 1)); }
};

/// A window that is not empty, often of a whole row, word or band.
ScreenWindow randomWindow(Random& random, int32_t width, int32_t height) {
    const auto pick = [&](int32_t size, int32_t& begin, int32_t& end) {
        begin = int32_t(random.below(uint64_t(size)));
        end = begin + 1 + int32_t(random.below(uint64_t(size - begin)));
        if (random.below(4) == 0) begin = begin & ~63;
        if (random.below(4) == 0) end = std::min((end + 63) & ~63, size);
        if (random.below(8) == 0) begin = 0;
        if (random.below(8) == 0) end = size;
    };
    ScreenWindow window;
    pick(height, window.row_begin, window.row_end);
    pick(width, window.begin, window.end);
    return window;
}

template <class Screen>
void expectAsFlags(uint64_t seed, int32_t width, int32_t height) {
    Random random(seed);
    Screen screen(width, height);
    Flags flags(width, height);
    for (int step = 0; step < 4000; ++step) {
        const ScreenWindow window = randomWindow(random, width, height);
        SCOPED_TRACE("seed " + std::to_string(seed) + ", step " + std::to_string(step));
        if (step % 8 == 0) {
            ASSERT_EQ(screen.anyFree(window), flags.any(window));
            std::vector<uint8_t> told(size_t(height), 0);
            screen.forFreeRows(window, [&](int32_t begin, int32_t end) {
                ASSERT_TRUE(begin < end && begin >= window.row_begin && end <= window.row_end);
                for (int32_t row = begin; row < end; ++row) ++told[size_t(row)];
            });
            for (int32_t row = window.row_begin; row < window.row_end; ++row) {
                ASSERT_LE(told[size_t(row)], 1);
                if (flags.any({row, row + 1, window.begin, window.end})) { ASSERT_EQ(told[size_t(row)], 1); }
            }
        }
        const int32_t row = window.row_begin;
        int32_t last = window.begin;
        screen.take(row, window.begin, window.end, [&](int32_t begin, int32_t end) {
            ASSERT_TRUE(begin >= last && begin < end && end <= window.end);
            last = end;
            for (int32_t i = begin; i < end; ++i) {
                ASSERT_EQ(flags.at(row, i), 1) << "taken twice";
                flags.at(row, i) = 0;
            }
        });
        ASSERT_FALSE(flags.any({row, row + 1, window.begin, window.end}));
        ASSERT_EQ(screen.free(), flags.count());
        ASSERT_EQ(screen.full(), flags.count() == 0);
    }
}

TEST(DynamicScreen, SegmentsAndBitsKnowWhatIsFree) {
    const int32_t sizes[][2] = {{200, 70}, {64, 64}, {1, 1}, {65, 130}, {63, 3}, {130, 64}};
    for (uint64_t seed = 0; seed < 6; ++seed) {
        expectAsFlags<SegmentScreen>(seed, sizes[seed][0], sizes[seed][1]);
        expectAsFlags<BitScreen>(seed, sizes[seed][0], sizes[seed][1]);
    }
}

}  // namespace
}  // namespace sightline::test
