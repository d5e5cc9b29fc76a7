// Answers of lanes as bits in memory, eight to a byte; once per instruction set.
// SPDX-License-Identifier: MIT
#include <cstdint>

#if defined(SIGHTLINE_CULL_MASK_BITS_INL_H_) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_CULL_MASK_BITS_INL_H_
#undef SIGHTLINE_CULL_MASK_BITS_INL_H_
#else
#define SIGHTLINE_CULL_MASK_BITS_INL_H_
#endif

#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Sixteen at a time at most.
using FaceLanes = hn::CappedTag<float, 16>;

/// Asks for the answers of `count` items, in steps of lanes, and writes a bit each; or adds it to those that are there.
/// @param test   from the first item of a step to the mask of its lanes; items up to a multiple of 16 are asked for
/// @param bits   [size: >= count rounded up to 16, a bit each]
template <bool add = false, class Test>
HWY_INLINE void storeAnswers(FaceLanes d, size_t count, uint8_t* HWY_RESTRICT bits, const Test& test) {
    const size_t lanes = hn::Lanes(d);
    if (lanes == 16 && !add) {  // whole bytes, as they come
        for (size_t i = 0; i < count; i += 16) hn::StoreMaskBits(d, test(i), bits + i / 8);
        return;
    }
    for (size_t i = 0; i < count; i += 16) {
        uint32_t word = 0;
        for (size_t j = 0; j < 16; j += lanes) {
            uint8_t answer[8] = {};
            hn::StoreMaskBits(d, test(i + j), answer);
            word |= (uint32_t{answer[0]} | uint32_t{answer[1]} << 8) << j;
        }
        if constexpr (add) word |= uint32_t{bits[i / 8]} | uint32_t{bits[i / 8 + 1]} << 8;
        bits[i / 8] = static_cast<uint8_t>(word);
        bits[i / 8 + 1] = static_cast<uint8_t>(word >> 8);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // toggle
