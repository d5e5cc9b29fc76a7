// Asks boxes and rectangles of the image whether something is open there.
// SPDX-License-Identifier: MIT
#if defined(SIGHTLINE_BENCH_ONEPASS_ASK_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BENCH_ONEPASS_ASK_INL_H
#undef SIGHTLINE_BENCH_ONEPASS_ASK_INL_H
#else
#define SIGHTLINE_BENCH_ONEPASS_ASK_INL_H
#endif

#include <algorithm>
#include <bit>
#include <cmath>

#include "bench/onepass/boxes.h"
#include "bench/onepass/lanes-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bench {
namespace HWY_NAMESPACE {
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

/// Whether a box is behind planes of tiles, of which many have the same.
class BoxBehindPlanes {
public:
    explicit BoxBehindPlanes(const AskedBox* box) : box_(box) {}
    bool operator()(const DepthBlocks& image, uint32_t plane) {
        if (!box_ || plane == DepthBlock::kNoPlane) return false;
        if (plane != last_) is_behind_ = isBehind(image.planes[last_ = plane], *box_);
        return is_behind_;
    }

private:
    const AskedBox* box_;
    uint32_t last_ = DepthBlock::kNoPlane;
    bool is_behind_ = false;
};

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
    BoxBehindPlanes behind(box);
    for (int by = y0 / kBlockHeight; by <= y1 / kBlockHeight; ++by)
        for (int bx = x0 / kBlockWidth; bx <= x1 / kBlockWidth; ++bx) {
            if (image.leastBase(bx, by) > nearness) continue;
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
                if (behind(image, block.plane[t])) continue;
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

}  // namespace HWY_NAMESPACE
}  // namespace sightline::bench
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
