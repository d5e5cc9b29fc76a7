// Compressed tiles: the same keys, bit for bit, whatever they are; small where they are planes.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/tile_compression.h"

#include <functional>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline::test {
using namespace studies;
namespace {

struct Tile {
    DepthKey keys[64];
};

std::string textOf(const Tile& tile) {
    std::string text;
    for (const DepthKey key : tile.keys) text += std::to_string(key) + " ";
    return text;
}

/// By every coding, and by the best.
uint32_t expectRoundTrip(const Tile& tile, const std::string& what) {
    uint8_t packed[kCompressedLimit];
    uint32_t least = kCompressedLimit;
    for (int coding = 0; coding < kTileCodings; ++coding) {
        const uint32_t bytes = compressTileAs(static_cast<TileCoding>(coding), tile.keys, packed);
        if (bytes == 0) continue;
        least = std::min(least, bytes);
        EXPECT_LE(bytes, 257u) << what;
        EXPECT_EQ(codingOf({packed, bytes}), static_cast<TileCoding>(coding)) << what;
        Tile back;
        decompressTile({packed, bytes}, back.keys);
        EXPECT_TRUE(std::equal(tile.keys, tile.keys + 64, back.keys))
            << what << " coding " << coding << ": " << textOf(tile);
    }
    const uint32_t best = compressTile(tile.keys, packed);
    EXPECT_EQ(best, least) << what;
    Tile back;
    decompressTile({packed, best}, back.keys);
    EXPECT_TRUE(std::equal(tile.keys, tile.keys + 64, back.keys)) << what << ": " << textOf(tile);
    return best;
}

/// A plane of nearness as a format keeps it.
Tile planar(const DepthCodec& codec, Random& random) {
    const double nearness = std::pow(10.0, random.uniform(-3, 0));
    const double right = nearness * random.uniform(-1e-3, 1e-3), up = nearness * random.uniform(-1e-3, 1e-3);
    Tile tile;
    for (int i = 0; i < 64; ++i) tile.keys[i] = codec.encode(nearness + right * (i % 8) + up * (i / 8));
    return tile;
}

/// Below a line through the tile one, above it the other.
Tile mixed(const Tile& a, const Tile& b, Random& random) {
    const double x = random.uniform(-1, 1), y = random.uniform(-1, 1), rest = random.uniform(-3, 3);
    Tile tile;
    for (int i = 0; i < 64; ++i) tile.keys[i] = (x * (i % 8 - 3.5) + y * (i / 8 - 3.5) > rest ? a : b).keys[i];
    return tile;
}

TEST(TileCompression, GivesBackRandomKeys) {
    Random random(1);
    for (int i = 0; i < 3000; ++i) {
        Tile tile;
        const int bits = static_cast<int>(random.below(33));
        const uint32_t base = static_cast<uint32_t>(random.next());
        for (DepthKey& key : tile.keys)
            key = std::bit_cast<int32_t>(base + (bits == 0 ? 0 : static_cast<uint32_t>(random.next() >> (64 - bits))));
        const uint32_t bytes = expectRoundTrip(tile, "random, bits " + std::to_string(bits));
        if (bits == 32) { EXPECT_EQ(bytes, 257u); }
    }
}

TEST(TileCompression, GivesBackAdversarialKeys) {
    const DepthKey lowest = std::numeric_limits<DepthKey>::min(), highest = std::numeric_limits<DepthKey>::max();
    const std::function<DepthKey(int)> rules[] = {
        [&](int) { return lowest; },
        [&](int) { return highest; },
        [&](int i) { return i % 2 != 0 ? lowest : highest; },
        [&](int i) { return i / 8 % 2 != 0 ? lowest : highest; },
        [&](int i) { return i == 27 ? highest : lowest; },
        [&](int i) { return i == 0 ? highest : 0; },
        [&](int i) { return i == 63 ? lowest : 1; },
        [&](int i) { return i * 33554432 - 1073741824; },
        [&](int i) { return i % 8 * 268435455 - 1073741824; },
        [&](int i) {
            return i == 0 ? 0 : i == 1 ? highest : i == 8 ? lowest : -1;
        },
        [&](int i) { return i < 32 ? i : highest - i; },
    };
    int number = 0;
    for (const auto& rule : rules) {
        Tile tile;
        for (int i = 0; i < 64; ++i) tile.keys[i] = rule(i);
        expectRoundTrip(tile, "rule " + std::to_string(number++));
    }
}

TEST(TileCompression, MakesPlanesSmall) {
    for (const DepthFormat format : {DepthFormat::kReversedFloat, DepthFormat::kUnorm24, DepthFormat::kUnorm16,
                                     DepthFormat::kFloat, DepthFormat::kIntegerInverse, DepthFormat::kW}) {
        const DepthCodec codec(format, {0.1, 1e4, false});
        Random random(3);
        uint64_t one = 0, two = 0, partly = 0;
        constexpr int kTiles = 500;
        for (int i = 0; i < kTiles; ++i) {
            const Tile a = planar(codec, random), b = planar(codec, random);
            Tile clear;
            std::fill(clear.keys, clear.keys + 64, codec.convention.far_value);
            EXPECT_LE(expectRoundTrip(clear, "cleared"), 20u);
            one += expectRoundTrip(a, "planar");
            two += expectRoundTrip(mixed(a, b, random), "two planes");
            partly += expectRoundTrip(mixed(a, clear, random), "plane and cleared");
        }
        const std::string name(kDepthFormatNames[static_cast<int>(format)]);
        EXPECT_LE(one, 64u * kTiles) << name;  // a quarter
        EXPECT_LE(two, 170u * kTiles) << name;
        EXPECT_LE(partly, 150u * kTiles) << name;
    }
}

TEST(TileCompression, EachCodingIsTheBestForSomething) {
    const DepthCodec codec(DepthFormat::kReversedFloat, {0.1, 1e4, false});
    Random random(9);
    bool best[kTileCodings] = {};
    uint8_t packed[kCompressedLimit];
    for (int i = 0; i < 4000; ++i) {
        const Tile a = planar(codec, random), b = planar(codec, random);
        Tile tile = i % 4 == 0 ? a : mixed(a, b, random);
        if (i % 4 == 2) {  // two depths
            for (DepthKey& key : tile.keys) key = (key & 1) != 0 ? 1000 : 2000000;
        } else if (i % 4 == 3) {
            for (DepthKey& key : tile.keys) key = std::bit_cast<int32_t>(static_cast<uint32_t>(random.next()));
        }
        if (i % 8 == 1)  // curved along one axis
            for (int k = 0; k < 64; ++k) tile.keys[k] = 40000 * (k % 8) * (i % 16 == 1 ? k / 8 : 7 - k / 8) + 3 * k;
        const uint32_t bytes = compressTile(tile.keys, packed);
        best[static_cast<int>(codingOf({packed, bytes}))] = true;
    }
    for (int coding = 0; coding < kTileCodings - 1; ++coding) EXPECT_TRUE(best[coding]) << coding;
}

}  // namespace
}  // namespace sightline::test
