// What is coded is taken again, and costs what information theory says.
// SPDX-License-Identifier: MIT
#include "sightline/visfile/bit_coder.h"

#include <gtest/gtest.h>

#include <cmath>

#include "sightline/base/random.h"

namespace sightline {
namespace {

TEST(BitCoder, TakesTheBitsThatWerePut) {
    Random random(1);
    for (const double chance : {0.0, 0.001, 0.1, 0.5, 0.93, 1.0})
        for (const size_t count : {0, 1, 2, 9, 100, 10000}) {
            std::vector<bool> bits;
            for (size_t i = 0; i < count; ++i) bits.push_back(random.uniform() < chance);
            Array<char> bytes;
            BitEncoder encoder(bytes);
            BitModel models[3], again[3];
            for (size_t i = 0; i < count; ++i) encoder.code(models[i % 3], bits[i]);
            encoder.finish();
            BitDecoder decoder(bytes);
            for (size_t i = 0; i < count; ++i) {
                ASSERT_EQ(decoder.code(again[i % 3]), bits[i]) << chance << ", bit " << i;
                ASSERT_FALSE(decoder.pastEnd());
            }
            EXPECT_TRUE(decoder.atEnd());
        }
}

TEST(BitCoder, CostsTheEntropyAndLittleMore) {
    Random random(2);
    constexpr size_t kBits = 200000;
    for (const double chance : {0.02, 0.1, 0.3, 0.5, 0.8}) {
        Array<char> bytes;
        BitEncoder encoder(bytes);
        BitModel model;
        size_t ones = 0;
        for (size_t i = 0; i < kBits; ++i) ones += encoder.code(model, random.uniform() < chance);
        encoder.finish();
        const double p = double(ones) / kBits, entropy = -p * std::log2(p) - (1 - p) * std::log2(1 - p);
        EXPECT_LT(8.0 * double(bytes.size()), 1.02 * entropy * kBits + 64) << chance;
        EXPECT_GT(8.0 * double(bytes.size()), 0.98 * entropy * kBits) << chance;
    }
}

TEST(BitCoder, NoByteHoldsMoreThan2840Bits) {
    Array<char> bytes;
    BitEncoder encoder(bytes);
    BitModel model;
    for (int i = 0; i < 1000000; ++i) encoder.code(model, false);
    encoder.finish();
    EXPECT_GT(bytes.size(), 1000000u / 2840);
    BitDecoder decoder({});
    BitModel again;
    int taken = 0;
    while (!decoder.pastEnd()) taken += 1 + 0 * decoder.code(again);
    EXPECT_LT(taken, 4 * 2840);
}

TEST(NumberModel, TakesTheNumbersThatWerePut) {
    Random random(3);
    std::vector<uint32_t> numbers = {0, 1, 2, 3, 65535, 65536, (1u << NumberModel::kBits) - 2};
    for (int i = 0; i < 5000; ++i)
        numbers.push_back(static_cast<uint32_t>(random.below(uint64_t{1} << random.below(17))));
    Array<char> bytes;
    BitEncoder encoder(bytes);
    NumberModel model, again;
    for (const uint32_t number : numbers) model.code(encoder, number);
    encoder.finish();
    BitDecoder decoder(bytes);
    for (const uint32_t number : numbers) ASSERT_EQ(again.code(decoder), number);
    EXPECT_TRUE(decoder.atEnd());
}

TEST(NumberModel, FoldsSigns) {
    for (int32_t value = -70000; value <= 70000; value += 7) {
        ASSERT_EQ(unfoldSign(foldSign(value)), value);
        ASSERT_LE(foldSign(value), 2u * static_cast<uint32_t>(std::abs(value)));
    }
}

}  // namespace
}  // namespace sightline
