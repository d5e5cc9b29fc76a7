// Fragments one by one: shaders that discard or write depth, every comparison, counts per sample, compressed tiles.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_buffer_fragments.h"

#include <algorithm>
#include <bit>
#include <cstring>
#include <utility>

#include "sightline/studies/hidden/methods/fill.h"
#include "sightline/studies/hidden/zbuffer/tile_compression.h"

namespace sightline::studies {

bool isPlain(const DepthDraw& draw) {
    const DepthSettings& s = draw.settings;
    return s.shader.kind == ShaderKind::kPlain && s.write && s.early_test &&
           draw.comparison == draw.codec.convention.comparison && draw.image.generated.empty();
}

bool allowsEarlyTest(const DepthSettings& settings, DepthComparison comparison, const DepthConvention& convention) {
    if (!settings.early_test) return false;
    switch (settings.shader.kind) {
        case ShaderKind::kPlain:
        case ShaderKind::kDiscards:
            return true;
        case ShaderKind::kWritesDepth:
            return false;
        case ShaderKind::kWritesFarther:
            return convention.greaterIsNearer()
                       ? comparison == DepthComparison::kGreater || comparison == DepthComparison::kGreaterEqual
                       : comparison == DepthComparison::kLess || comparison == DepthComparison::kLessEqual;
    }
    return false;
}

bool rejectsAll(DepthComparison comparison, DepthKey least, DepthKey greatest, DepthKey tile_least,
                DepthKey tile_greatest) {
    switch (comparison) {
        case DepthComparison::kNever:
            return true;
        case DepthComparison::kLess:
            return least >= tile_greatest;
        case DepthComparison::kLessEqual:
            return least > tile_greatest;
        case DepthComparison::kEqual:
            return greatest < tile_least || least > tile_greatest;
        case DepthComparison::kGreater:
            return greatest <= tile_least;
        case DepthComparison::kGreaterEqual:
            return greatest < tile_least;
        case DepthComparison::kNotEqual:
            return acceptsAll(DepthComparison::kEqual, least, greatest, tile_least, tile_greatest);
        case DepthComparison::kAlways:
            return false;
    }
    return false;
}

bool acceptsAll(DepthComparison comparison, DepthKey least, DepthKey greatest, DepthKey tile_least,
                DepthKey tile_greatest) {
    switch (comparison) {
        case DepthComparison::kNever:
            return false;
        case DepthComparison::kLess:
            return greatest < tile_least;
        case DepthComparison::kLessEqual:
            return greatest <= tile_least;
        case DepthComparison::kEqual:
            return least == greatest && tile_least == tile_greatest && least == tile_least;
        case DepthComparison::kGreater:
            return least > tile_greatest;
        case DepthComparison::kGreaterEqual:
            return least >= tile_greatest;
        case DepthComparison::kNotEqual:
            return greatest < tile_least || least > tile_greatest;
        case DepthComparison::kAlways:
            return true;
    }
    return false;
}

void FragmentDrawer::countGenerated(int32_t row, int32_t sample, uint64_t mask, HiddenCounters& count) const {
    count.generated += static_cast<uint64_t>(std::popcount(mask));
    for (; mask != 0; mask &= mask - 1) {
        const int bit = std::countr_zero(mask);
        countSpan(draw_.image, draw_.image.generated, row + bit / 8, sample + bit % 8, sample + bit % 8 + 1);
    }
}

void FragmentDrawer::countSamples(std::vector<uint16_t>& counts, const TileFragments& part, uint64_t mask) const {
    if (counts.empty()) return;
    for (; mask != 0; mask &= mask - 1) {
        const int bit = std::countr_zero(mask), sample = part.sample + bit % 8;
        countSpan(draw_.image, counts, part.row + bit / 8, sample, sample + 1);
    }
}

void FragmentDrawer::show(int32_t row, int32_t sample, uint64_t mask, uint32_t surface) const {
    for (; mask != 0; mask &= mask - 1) {
        const int bit = std::countr_zero(mask);
        draw_.image.at(row + bit / 8, sample + bit % 8) = surface;
    }
}

uint64_t FragmentDrawer::passing(const TileFragments& part, const DepthKey* comes, uint64_t mask) const {
    const DepthKey* there = draw_.buffer.tileKeys(part.tile);
    uint64_t pass = 0;
    for (; mask != 0; mask &= mask - 1) {
        const int bit = std::countr_zero(mask);
        pass |= uint64_t{passes(draw_.comparison, comes[bit], there[bit])} << bit;
    }
    return pass;
}

bool FragmentDrawer::drawTile(const TileFragments& part, const DepthKey* comes, HiddenCounters& count) const {
    const DepthShader& shader = draw_.settings.shader;
    HiddenImage& image = draw_.image;
    const DepthPolygon& polygon = part.polygon;
    countGenerated(part.row, part.sample, part.mask, count);

    const bool writes_depth = shader.kind == ShaderKind::kWritesDepth || shader.kind == ShaderKind::kWritesFarther;
    uint64_t tested = 0;
    const auto test = [&](const DepthKey* keys, uint64_t mask) {
        tested |= mask;
        return passing(part, keys, mask);
    };
    const bool spared = part.accepted && !writes_depth;  // by the bounds
    uint64_t left = part.mask;
    if (early_ && !spared) left = test(comes, left);
    const uint64_t shaded = left;
    DepthKey own[64];
    if (shader.kind == ShaderKind::kDiscards && shader.keeps != nullptr) {
        for (uint64_t rest = left; rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest);
            if (!shader.keeps(polygon.surface, part.row + bit / 8, part.sample + bit % 8))
                left &= ~(uint64_t{1} << bit);
        }
    }
    if (writes_depth && shader.nearness != nullptr) {
        const DepthConvention& convention = draw_.codec.convention;
        for (uint64_t rest = left; rest != 0; rest &= rest - 1) {
            const int bit = std::countr_zero(rest), row = part.row + bit / 8, sample = part.sample + bit % 8;
            const double nearness = shader.nearness(polygon.surface, row, sample, polygon.depth.at(row, sample));
            own[bit] = draw_.codec.encode(nearness);
            if (shader.kind == ShaderKind::kWritesFarther) own[bit] = convention.farther(own[bit], comes[bit]);
        }
        comes = own;
    }
    if ((!early_ && !spared) || writes_depth) left = test(comes, left);

    count.tested += static_cast<uint64_t>(std::popcount(tested));
    count.shaded += static_cast<uint64_t>(std::popcount(shaded));
    count.passed += static_cast<uint64_t>(std::popcount(left));
    countSamples(image.tested, part, tested);
    countSamples(image.shaded, part, shaded);
    countSamples(image.passed, part, left);
    show(part.row, part.sample, left, polygon.surface);
    if (!draw_.settings.write || left == 0) return false;
    DepthKey* keys = draw_.buffer.tileKeys(part.tile);
    for (; left != 0; left &= left - 1) {
        const int bit = std::countr_zero(left);
        keys[bit] = comes[bit];
    }
    return true;
}

void FragmentDrawer::touch(uint32_t tile, DepthDrawScratch& scratch) const {
    DepthBuffer& buffer = draw_.buffer;
    const uint32_t column = tile % buffer.stride;
    if (scratch.is_touched.empty()) scratch.is_touched.assign(buffer.stride, 0);
    if (scratch.is_touched[column] != 0) return;
    scratch.is_touched[column] = 1;
    scratch.touched.push_back(tile);
    if (buffer.state[tile] == DepthBuffer::State::kCleared) return;
    const uint32_t raw = DepthBuffer::kTileSamples * draw_.codec.bytes();
    scratch.counters.depth_bytes += raw;
    scratch.counters.depth_bytes_compressed += raw;
    if (buffer.state[tile] != DepthBuffer::State::kCompressed) return;
    scratch.counters.depth_bytes_compressed += buffer.stored_bytes[tile];
    scratch.counters.depth_bytes_compressed -= raw;
    uint8_t packed[kCompressedLimit];
    std::memcpy(packed, buffer.tileKeys(tile), buffer.stored_bytes[tile]);
    decompressTile({packed, buffer.stored_bytes[tile]}, buffer.tileKeys(tile));
    buffer.state[tile] = DepthBuffer::State::kRaw;
}

void keepTiles(const DepthDraw& draw, DepthDrawScratch& scratch) {
    DepthBuffer& buffer = draw.buffer;
    const uint32_t raw = DepthBuffer::kTileSamples * draw.codec.bytes();
    for (const uint32_t tile : scratch.touched) {
        const bool written = std::exchange(scratch.is_touched[tile % buffer.stride], uint8_t{0}) > 1;
        if (buffer.state[tile] != DepthBuffer::State::kRaw) continue;
        DepthKey* keys = buffer.tileKeys(tile);
        const auto [least, greatest] = std::minmax_element(keys, keys + DepthBuffer::kTileSamples);
        buffer.least[tile] = *least;
        buffer.greatest[tile] = *greatest;
        buffer.loose[tile] = 0;
        uint8_t packed[kCompressedLimit];
        const uint32_t bytes = compressTile(keys, packed);
        if (written) {
            scratch.counters.depth_bytes += raw;
            scratch.counters.depth_bytes_compressed += std::min(bytes, raw);
        }
        if (bytes >= raw) continue;
        std::memcpy(keys, packed, bytes);
        buffer.stored_bytes[tile] = static_cast<uint16_t>(bytes);
        buffer.state[tile] = DepthBuffer::State::kCompressed;
    }
    scratch.touched.clear();
}

}  // namespace sightline::studies
