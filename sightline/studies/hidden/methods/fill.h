// Writes runs of samples and counts their fragments: what all methods that paint spans have in common.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "sightline/studies/hidden/image.h"

namespace sightline::studies {

/// Adds one to the samples [begin, end) of a row, if the image keeps that count.
inline void countSpan(const HiddenImage& image, std::vector<uint16_t>& counts, int32_t row, int32_t begin,
                      int32_t end) {
    if (counts.empty()) return;
    uint16_t* line = counts.data() + static_cast<size_t>(row) * image.width;
    for (int32_t i = begin; i < end; ++i) line[i] = static_cast<uint16_t>(line[i] + (line[i] != UINT16_MAX));
}

/// Writes a surface over whatever is there: fragments that are generated, passed and shaded, and never tested.
inline void fillSpan(HiddenImage& image, int32_t row, int32_t begin, int32_t end, uint32_t surface) {
    uint32_t* line = image.surface.data() + static_cast<size_t>(row) * image.width;
    std::fill(line + begin, line + end, surface);
    const uint64_t count = static_cast<uint64_t>(end - begin);
    image.counters.generated += count;
    image.counters.passed += count;
    image.counters.shaded += count;
    countSpan(image, image.generated, row, begin, end);
    countSpan(image, image.passed, row, begin, end);
    countSpan(image, image.shaded, row, begin, end);
}

}  // namespace sightline::studies
