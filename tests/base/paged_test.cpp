// Arrays in pages: copies stay as they were, and share what has not changed.
// SPDX-License-Identifier: MIT
#include "sightline/base/paged.h"

#include <gtest/gtest.h>

#include <vector>

#include "sightline/base/random.h"

namespace sightline::test {
namespace {

TEST(Paged, CopiesStayAsTheyWereWhateverHappens) {
    Random random(2);
    Paged<uint32_t, 8> array;
    std::vector<uint32_t> truth;
    std::vector<std::pair<Paged<uint32_t, 8>, std::vector<uint32_t>>> copies;
    const auto expectSame = [](const Paged<uint32_t, 8>& paged, const std::vector<uint32_t>& plain) {
        ASSERT_EQ(paged.size(), plain.size());
        for (uint32_t i = 0; i < plain.size(); ++i) {
            ASSERT_EQ(paged[i], plain[i]);
            const std::span<const uint32_t> run = paged.run(i, 5);
            ASSERT_EQ(run.size(), std::min(5u, 8 - i % 8));
            ASSERT_EQ(run.data(), &paged[i]);
        }
    };
    for (int step = 0; step < 20000; ++step) {
        const auto value = static_cast<uint32_t>(random.next());
        const uint64_t kind = random.below(100);
        if (kind < 40) {
            array.push_back(value);
            truth.push_back(value);
        } else if (kind < 90 && !truth.empty()) {
            const size_t i = random.below(truth.size());
            array.set(i, value);
            truth[i] = value;
        } else if (kind < 95) {
            const auto size = static_cast<uint32_t>(random.below(60));
            array.resize(size);
            truth.resize(size, 0);
        } else if (kind == 99 && random.below(10) == 0) {
            array.clear();
            truth.clear();
        } else {
            copies.emplace_back(array.share(), truth);
            if (random.below(4) == 0) copies.emplace_back(copies.back().first.copy(), truth);
            if (copies.size() > 30) copies.erase(copies.begin() + static_cast<ptrdiff_t>(random.below(copies.size())));
        }
        expectSame(array, truth);
    }
    for (const auto& [copy, plain] : copies) expectSame(copy, plain);
}

TEST(Paged, ACopySharesThePagesThatDoNotChange) {
    Paged<uint32_t, 8> array;
    for (uint32_t i = 0; i < 80; ++i) array.push_back(i);
    const Paged<uint32_t, 8> copy = array.share();
    array.set(41, 7);
    int shared = 0;
    for (uint32_t i = 0; i < 80; i += 8) shared += &array[i] == &copy[i];
    EXPECT_EQ(shared, 9);
    EXPECT_EQ(copy[41], 41u);
    const uint32_t* at = &array[41];
    array.set(42, 8);
    EXPECT_EQ(&array[41], at) << "the page is its own since the first change";
}

}  // namespace
}  // namespace sightline::test
