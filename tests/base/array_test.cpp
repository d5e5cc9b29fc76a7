// Arrays in a memory of their own: they do what std::vector does, whatever is done to them, and give back all that they take.
// SPDX-License-Identifier: MIT
#include "sightline/base/array.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <list>
#include <memory>
#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "tests/support/memory.h"
#include "tests/support/random.h"

namespace sightline::test {
namespace {

/// An element that owns something, and that copies, moves and ends with care.
struct Owner {
    std::unique_ptr<uint64_t> value = std::make_unique<uint64_t>(0);

    Owner() = default;
    Owner(uint64_t v) : value(std::make_unique<uint64_t>(v)) {}
    Owner(const Owner& from) : value(std::make_unique<uint64_t>(*from.value)) {}
    Owner(Owner&& from) noexcept : value(std::move(from.value)) {}
    Owner& operator=(const Owner& from) {
        value = std::make_unique<uint64_t>(*from.value);  // it may have been moved from
        return *this;
    }
    Owner& operator=(Owner&& from) noexcept {
        value = std::move(from.value);
        return *this;
    }
    bool operator==(const Owner& other) const { return *value == *other.value; }
};

/// Random calls, each made to an Array and to a std::vector.
template <class T>
void expectAsVector(uint64_t seed) {
    CountingMemory memory, elsewhere;
    {
        Random random(seed);
        Array<T> array(&memory);
        std::vector<T> vector;
        for (int step = 0; step < 300; ++step) {
            const uint64_t value = random.below(1000);
            const size_t size = vector.size(), at = size == 0 ? 0 : random.below(static_cast<uint32_t>(size));
            const std::vector<T> some = {T(value), T(value + 1), T(value + 2)};
            switch (random.below(20)) {
                case 0:
                    array.push_back(T(value)), vector.push_back(T(value));
                    break;
                case 1:
                    array.emplace_back(value), vector.emplace_back(value);
                    break;
                case 2:
                    if (size > 0) array.push_back(array[at]), vector.push_back(vector[at]);  // one of its own
                    break;
                case 3:
                    if (size > 0) array.pop_back(), vector.pop_back();
                    break;
                case 4:
                    array.insert(array.begin() + at, T(value)), vector.insert(vector.begin() + at, T(value));
                    break;
                case 5:
                    array.insert(array.begin() + at, some.begin(), some.end());
                    vector.insert(vector.begin() + at, some.begin(), some.end());
                    break;
                case 6:
                    array.insert(array.begin() + at, 3, T(value));
                    vector.insert(vector.begin() + at, 3, T(value));
                    break;
                case 7:
                    if (size > 0) array.erase(array.begin() + at), vector.erase(vector.begin() + at);
                    break;
                case 8: {
                    const size_t end = at + (size == 0 ? 0 : random.below(static_cast<uint32_t>(size - at + 1)));
                    array.erase(array.begin() + at, array.begin() + end);
                    vector.erase(vector.begin() + at, vector.begin() + end);
                    break;
                }
                case 9:
                    array.resize(value % 40), vector.resize(value % 40);
                    break;
                case 10:
                    array.resize(size + value % 9, T(value));
                    vector.resize(size + value % 9, T(value));
                    break;
                case 11:
                    array.assign(value % 20, T(value)), vector.assign(value % 20, T(value));
                    break;
                case 12:
                    array.assign(some.begin(), some.end()), vector.assign(some.begin(), some.end());
                    break;
                case 13: {
                    const std::list<T> list(some.begin(), some.end());
                    array.assign(list.begin(), list.end()), vector.assign(list.begin(), list.end());
                    break;
                }
                case 14:
                    array.reserve(value % 100), vector.reserve(value % 100);
                    break;
                case 15:
                    array.shrink_to_fit();
                    break;
                case 16: {
                    Array<T> copy(array, &elsewhere);
                    array.clear();
                    array = std::move(copy);  // from another memory: element by element
                    break;
                }
                case 17: {
                    Array<T> moved(std::move(array));
                    array = Array<T>(&memory);
                    array.swap(moved);
                    break;
                }
                case 18: {
                    const auto odd = [](const T& element) { return element == T(7) || element == T(8); };
                    EXPECT_EQ(erase_if(array, odd), std::erase_if(vector, odd));
                    break;
                }
                default:
                    if (random.below(8) == 0) array.clear(), vector.clear();
            }
            ASSERT_TRUE(std::equal(array.begin(), array.end(), vector.begin(), vector.end())) << seed << " " << step;
            ASSERT_EQ(array.empty(), vector.empty());
            ASSERT_GE(array.capacity(), array.size());
            ASSERT_EQ(array.memory(), &memory);
        }
    }
    EXPECT_EQ(memory.bytes, 0u);
    EXPECT_EQ(elsewhere.bytes, 0u);
    EXPECT_GT(memory.allocations, 0u);
}

TEST(Array, DoesWhatAVectorDoes) {
    for (uint64_t seed = 1; seed <= rounds(200, 40); ++seed) {
        expectAsVector<uint64_t>(seed);
        expectAsVector<Owner>(seed);
    }
}

TEST(Array, GivesItsMemoryToArraysInIt) {
    CountingMemory memory;
    {
        Array<Array<uint32_t>> rows(&memory);
        rows.emplace_back();
        rows.resize(5);
        rows.push_back(Array<uint32_t>(3, 7u));
        for (const Array<uint32_t>& row : rows) EXPECT_EQ(row.memory(), &memory);
        EXPECT_EQ(rows.back(), (Array<uint32_t>{7, 7, 7}));
        for (uint32_t i = 0; i < 100; ++i) rows[i % 5].push_back(i);
        rows.shrink_to_fit();
        EXPECT_EQ(rows[3].size(), 20u);
    }
    EXPECT_EQ(memory.bytes, 0u);
}

TEST(Array, OfNothingTakesNothing) {
    CountingMemory memory;
    Array<uint64_t> array(&memory);
    array.reserve(0);
    array.resize(0);
    array.shrink_to_fit();
    Array<uint64_t> copy(array, &memory);
    EXPECT_EQ(copy, array);
    EXPECT_EQ(memory.allocations, 0u);
}

TEST(Memory, OfTheProgramAlignsAsItIsAsked) {
    for (size_t alignment = 1; alignment <= 4096; alignment *= 2) {
        void* place = defaultMemory()->allocate(3 * alignment, alignment);
        EXPECT_EQ(reinterpret_cast<uintptr_t>(place) % alignment, 0u);
        defaultMemory()->deallocate(place, 3 * alignment, alignment);
    }
}

}  // namespace
}  // namespace sightline::test
