// Lossless compression of a tile of depths: offsets from two depths, planes, or second differences.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/tile_compression.h"

#include <algorithm>
#include <bit>
#include <cstring>

namespace sightline::studies {
namespace {

constexpr int kSamples = 64;
constexpr uint32_t kRawBytes = 1 + 4 * kSamples;
/// Slopes of planes are kept in steps of 1/16: over seven samples that is less than half a unit off.
constexpr int kFraction = 4;

class BitWriter {
public:
    explicit BitWriter(uint8_t* out) : out_(out) {}
    void put(uint32_t value, int bits) {
        held_ |= uint64_t{value} << count_;
        for (count_ += bits; count_ >= 8; count_ -= 8, held_ >>= 8) out_[bytes_++] = static_cast<uint8_t>(held_);
    }
    uint32_t finish() {
        if (count_ > 0) out_[bytes_++] = static_cast<uint8_t>(held_);
        return bytes_;
    }

private:
    uint8_t* out_;
    uint64_t held_ = 0;
    int count_ = 0;
    uint32_t bytes_ = 0;
};

class BitReader {
public:
    explicit BitReader(std::span<const uint8_t> in) : in_(in) {}
    uint32_t get(int bits) {
        for (; count_ < bits; count_ += 8) held_ |= uint64_t{at_ < in_.size() ? in_[at_++] : uint8_t{0}} << count_;
        const uint32_t value = static_cast<uint32_t>(held_ & ((uint64_t{1} << bits) - 1));
        held_ >>= bits;
        count_ -= bits;
        return value;
    }

private:
    std::span<const uint8_t> in_;
    size_t at_ = 0;
    uint64_t held_ = 0;
    int count_ = 0;
};

// Small numbers of either sign as small numbers; all arithmetic is modulo 2^32, so that nothing is lost.
uint32_t fold(uint32_t difference) { return difference << 1 ^ (difference >> 31 != 0 ? ~0u : 0u); }
uint32_t unfold(uint32_t folded) { return folded >> 1 ^ ((folded & 1) != 0 ? ~0u : 0u); }

uint32_t bitsOfKey(DepthKey key) { return std::bit_cast<uint32_t>(key); }

/// What comes first: the coding and the bits of a residual.
void putHead(BitWriter& writer, TileCoding coding, int bits) {
    writer.put(static_cast<uint32_t>(coding), 3);
    writer.put(static_cast<uint32_t>(bits), 5);
}

uint32_t bytesOf(int head_bytes, int sample_bits) {
    return 1 + static_cast<uint32_t>(head_bytes) + static_cast<uint32_t>(sample_bits) * kSamples / 8;
}

uint32_t writeRaw(const DepthKey* keys, uint8_t* out) {
    out[0] = static_cast<uint8_t>(TileCoding::kRaw);
    std::memcpy(out + 1, keys, 4 * kSamples);
    return kRawBytes;
}

uint32_t writeOffset(const DepthKey* keys, uint8_t* out) {
    const auto [low, high] = std::minmax_element(keys, keys + kSamples);
    const uint32_t least = bitsOfKey(*low), greatest = bitsOfKey(*high);
    uint32_t widest = 0;
    for (int i = 0; i < kSamples; ++i)
        widest = std::max(widest, std::min(bitsOfKey(keys[i]) - least, greatest - bitsOfKey(keys[i])));
    const int bits = std::bit_width(widest);
    if (bytesOf(8, bits + 1) >= kRawBytes) return 0;
    BitWriter writer(out);
    putHead(writer, TileCoding::kOffset, bits);
    writer.put(least, 32);
    writer.put(greatest, 32);
    for (int i = 0; i < kSamples; ++i) {
        const uint32_t up = bitsOfKey(keys[i]) - least, down = greatest - bitsOfKey(keys[i]);
        writer.put(up <= down ? 0 : 1, 1);
        writer.put(std::min(up, down), bits);
    }
    return writer.finish();
}

void readOffset(BitReader& reader, int bits, DepthKey* keys) {
    const uint32_t least = reader.get(32), greatest = reader.get(32);
    for (int i = 0; i < kSamples; ++i) {
        const bool down = reader.get(1) != 0;
        const uint32_t distance = reader.get(bits);
        keys[i] = std::bit_cast<int32_t>(down ? greatest - distance : least + distance);
    }
}

struct KeyPlane {
    uint32_t corner = 0;        ///< sample 0 of row 0
    int32_t right = 0, up = 0;  ///< slopes in steps of 1 / 2^kFraction

    uint32_t at(int i) const {
        const int64_t rise = int64_t{right} * (i % 8) + int64_t{up} * (i / 8);
        return corner + static_cast<uint32_t>((rise + (1 << (kFraction - 1))) >> kFraction);
    }
    bool operator==(const KeyPlane&) const = default;
};

/// Through a corner and its neighbours `far` samples away along both axes. False if it is too steep.
bool planeAt(const DepthKey* keys, int column, int row, int far, KeyPlane& plane) {
    const int side = column == 0 ? far : -far, above = row == 0 ? far : -far;
    const int64_t at = keys[8 * row + column];
    const auto slope = [&](int64_t other, int distance, int32_t& out) {
        const int64_t steps = (other - at) * (1 << kFraction) / distance;
        out = static_cast<int32_t>(steps);
        return steps == out;
    };
    if (!slope(keys[8 * row + column + side], side, plane.right) ||
        !slope(keys[8 * (row + above) + column], above, plane.up))
        return false;
    plane.corner = 0;
    plane.corner = static_cast<uint32_t>(at) - plane.at(8 * row + column);
    return true;
}

uint32_t differs(const KeyPlane& plane, const DepthKey* keys, int i) { return fold(bitsOfKey(keys[i]) - plane.at(i)); }

void putPlane(BitWriter& writer, const KeyPlane& plane) {
    writer.put(plane.corner, 32);
    writer.put(std::bit_cast<uint32_t>(plane.right), 32);
    writer.put(std::bit_cast<uint32_t>(plane.up), 32);
}

KeyPlane getPlane(BitReader& reader) {
    KeyPlane plane;
    plane.corner = reader.get(32);
    plane.right = std::bit_cast<int32_t>(reader.get(32));
    plane.up = std::bit_cast<int32_t>(reader.get(32));
    return plane;
}

int widthOf(const KeyPlane& a, const KeyPlane& b, const DepthKey* keys) {
    uint32_t widest = 0;
    for (int i = 0; i < kSamples; ++i) widest = std::max(widest, std::min(differs(a, keys, i), differs(b, keys, i)));
    return std::bit_width(widest);
}

uint32_t writePlane(const DepthKey* keys, uint8_t* out) {
    KeyPlane best, plane;
    int bits = 32;
    for (const int corner : {0, 7, 56, 63}) {
        if (!planeAt(keys, corner % 8, corner / 8, 7, plane)) continue;
        const int width = widthOf(plane, plane, keys);
        if (width >= bits) continue;
        bits = width;
        best = plane;
    }
    if (bits > 31 || bytesOf(12, bits) >= kRawBytes) return 0;
    BitWriter writer(out);
    putHead(writer, TileCoding::kPlane, bits);
    putPlane(writer, best);
    for (int i = 0; i < kSamples; ++i) writer.put(differs(best, keys, i), bits);
    return writer.finish();
}

/// One plane from each of two opposite corners; which neighbours show the slope best, nobody knows, so all are tried.
uint32_t writeTwoPlanes(const DepthKey* keys, uint8_t* out) {
    constexpr int kOpposite[4][2] = {{0, 63}, {7, 56}, {0, 56}, {0, 7}};
    KeyPlane best[2];
    int bits = 32;
    for (const auto& corners : kOpposite)
        for (const int far : {1, 2, 3}) {
            KeyPlane planes[2];
            bool fits = true;
            for (int k = 0; k < 2; ++k) fits &= planeAt(keys, corners[k] % 8, corners[k] / 8, far, planes[k]);
            if (!fits) continue;
            const int width = widthOf(planes[0], planes[1], keys);
            if (width >= bits) continue;
            bits = width;
            std::copy(planes, planes + 2, best);
        }
    if (bits > 31 || bytesOf(24, bits + 1) >= kRawBytes) return 0;
    BitWriter writer(out);
    putHead(writer, TileCoding::kTwoPlanes, bits);
    putPlane(writer, best[0]);
    putPlane(writer, best[1]);
    for (int i = 0; i < kSamples; ++i) {
        const uint32_t first = differs(best[0], keys, i), second = differs(best[1], keys, i);
        writer.put(first <= second ? 0 : 1, 1);
        writer.put(std::min(first, second), bits);
    }
    return writer.finish();
}

/// What is expected of a sample, in order: a row's third and later ones go on as the two before, rows as the two rows
/// before. The corner and its first steps along both axes are given.
uint32_t expected(const uint32_t* z, int i) {
    const int column = i % 8, row = i / 8;
    if (row >= 2) return 2 * z[i - 8] - z[i - 16];
    if (column >= 2) return 2 * z[i - 1] - z[i - 2];
    if (row == 1 && column == 1) return z[i - 1] + z[i - 8] - z[i - 9];
    return z[i];  // given
}

constexpr int kGiven[3] = {0, 1, 8};
bool isGiven(int i) { return i == 0 || i == 1 || i == 8; }
int placeOf(int i, bool down) { return down ? i ^ 56 : i; }

uint32_t writeDifferences(const DepthKey* keys, bool down, uint8_t* out) {
    uint32_t z[kSamples], folded[kSamples], widest = 0;
    for (int i = 0; i < kSamples; ++i) z[i] = bitsOfKey(keys[placeOf(i, down)]);
    for (int i = 0; i < kSamples; ++i) widest = std::max(widest, folded[i] = fold(z[i] - expected(z, i)));
    const int bits = std::bit_width(widest);
    if (bits > 31 || bytesOf(12, bits) >= kRawBytes) return 0;
    BitWriter writer(out);
    putHead(writer, down ? TileCoding::kDifferencesDown : TileCoding::kDifferences, bits);
    for (const int i : kGiven) writer.put(z[i], 32);
    for (int i = 0; i < kSamples; ++i)
        if (!isGiven(i)) writer.put(folded[i], bits);
    return writer.finish();
}

void readDifferences(BitReader& reader, int bits, bool down, DepthKey* keys) {
    uint32_t z[kSamples];
    for (const int i : kGiven) z[i] = reader.get(32);
    for (int i = 0; i < kSamples; ++i) {
        if (!isGiven(i)) z[i] = expected(z, i) + unfold(reader.get(bits));
        keys[placeOf(i, down)] = std::bit_cast<int32_t>(z[i]);
    }
}

}  // namespace

uint32_t compressTileAs(TileCoding coding, const DepthKey* keys, uint8_t* out) {
    switch (coding) {
        case TileCoding::kRaw:
            return writeRaw(keys, out);
        case TileCoding::kOffset:
            return writeOffset(keys, out);
        case TileCoding::kPlane:
            return writePlane(keys, out);
        case TileCoding::kTwoPlanes:
            return writeTwoPlanes(keys, out);
        case TileCoding::kDifferences:
            return writeDifferences(keys, false, out);
        case TileCoding::kDifferencesDown:
            return writeDifferences(keys, true, out);
    }
    return 0;
}

uint32_t compressTile(const DepthKey* keys, uint8_t* out) {
    uint8_t trial[kCompressedLimit];
    uint32_t best = writeRaw(keys, out);
    for (int coding = 1; coding < kTileCodings; ++coding) {
        const uint32_t bytes = compressTileAs(static_cast<TileCoding>(coding), keys, trial);
        if (bytes == 0 || bytes >= best) continue;
        best = bytes;
        std::memcpy(out, trial, bytes);
    }
    return best;
}

void decompressTile(std::span<const uint8_t> packed, DepthKey* keys) {
    if (codingOf(packed) == TileCoding::kRaw) {
        std::memcpy(keys, packed.data() + 1, 4 * kSamples);
        return;
    }
    BitReader reader(packed);
    const TileCoding coding = static_cast<TileCoding>(reader.get(3));
    const int bits = static_cast<int>(reader.get(5));
    switch (coding) {
        case TileCoding::kOffset:
            return readOffset(reader, bits, keys);
        case TileCoding::kPlane: {
            const KeyPlane plane = getPlane(reader);
            for (int i = 0; i < kSamples; ++i) keys[i] = std::bit_cast<int32_t>(plane.at(i) + unfold(reader.get(bits)));
            return;
        }
        case TileCoding::kTwoPlanes: {
            const KeyPlane first = getPlane(reader), second = getPlane(reader);
            for (int i = 0; i < kSamples; ++i) {
                const KeyPlane& plane = reader.get(1) == 0 ? first : second;
                keys[i] = std::bit_cast<int32_t>(plane.at(i) + unfold(reader.get(bits)));
            }
            return;
        }
        case TileCoding::kDifferences:
            return readDifferences(reader, bits, false, keys);
        default:
            return readDifferences(reader, bits, true, keys);
    }
}

}  // namespace sightline::studies
