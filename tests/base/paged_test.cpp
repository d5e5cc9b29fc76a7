// Arrays in pages: copies stay as they were, and share what has not changed.
// SPDX-License-Identifier: MIT
#include "sightline/base/paged.h"

#include <gtest/gtest.h>

#include <atomic>
#include <mutex>
#include <set>
#include <thread>
#include <vector>

#include "sightline/base/random.h"
#include "tests/support/memory.h"

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

/// A number that counts how many of its kind there are.
struct Counted {
    static inline std::atomic<int> living{0};
    uint64_t value = 0;

    Counted(uint64_t of = 0) : value(of) { ++living; }
    Counted(const Counted& other) : value(other.value) { ++living; }
    Counted& operator=(const Counted&) = default;
    ~Counted() { --living; }
};
using CountedArray = Paged<Counted, 4>;

/// Items of the pages that any of the arrays has.
int itemsOfPages(const std::vector<const CountedArray*>& arrays) {
    std::set<const Counted*> pages;
    for (const CountedArray* array : arrays)
        for (uint32_t i = 0; i < array->size(); i += 4) pages.insert(&(*array)[i]);
    return static_cast<int>(4 * pages.size());
}

TEST(Paged, APageGoesWithTheLastCopyThatHasIt) {
    CountingMemory memory;
    for (const uint64_t seed : {3u, 4u, 5u}) {
        Random random(seed);
        std::vector<CountedArray> copies;
        CountedArray array(&memory);
        for (uint32_t i = 0; i < 100; ++i) array.push_back(i);
        for (int step = 0; step < 4000; ++step) {
            for (uint64_t changes = random.below(12); changes-- > 0;) {
                const uint64_t kind = random.below(20);
                if (kind == 0) array.push_back(random.next());
                else if (kind == 1) array.resize(static_cast<uint32_t>(1 + random.below(160)));
                else array.set(random.below(array.size()), random.next());
            }
            if (random.below(40) == 0) array.clear();
            if (array.empty()) array.push_back(7);
            if (random.below(60) == 0) {  // what comes after it knows nothing of the copies that there are
                CountedArray next(&memory);
                for (uint32_t i = 0; i < array.size(); ++i) next.push_back(array[i]);
                array = std::move(next);
            }
            copies.push_back(array.share());
            if (random.below(5) == 0) copies.push_back(copies.back().copy());
            while (copies.size() > 2 + random.below(20)) {
                const size_t ends = random.below(copies.size());
                std::swap(copies[ends], copies.back());
                copies.pop_back();
            }
            std::vector<const CountedArray*> all = {&array};
            for (const CountedArray& copy : copies) all.push_back(&copy);
            ASSERT_EQ(Counted::living, itemsOfPages(all)) << "seed " << seed << ", step " << step;
        }
    }
    EXPECT_EQ(Counted::living, 0);
    EXPECT_EQ(memory.bytes, 0u);
}

TEST(Paged, CopiesOutliveTheArrayThatTheyComeFrom) {
    CountingMemory memory;
    {
        std::vector<CountedArray> copies;
        {
            CountedArray array(&memory);
            for (uint32_t i = 0; i < 50; ++i) {
                array.push_back(i);
                array.set(i / 2, i);
                copies.push_back(array.share());
            }
        }
        for (uint32_t i = 0; i < 50; ++i) {
            EXPECT_EQ(copies[i].size(), i + 1);
            EXPECT_EQ(copies[i][i / 2].value, i);
        }
    }
    EXPECT_EQ(Counted::living, 0);
    EXPECT_EQ(memory.bytes, 0u);
}

TEST(Paged, ManyChangesTakeNoMoreMemoryThanTheCopiesNeed) {
    CountingMemory memory;
    Paged<uint64_t, 16> array(&memory);
    for (uint32_t i = 0; i < 16000; ++i) array.push_back(i);
    Random random(9);
    const Paged<uint64_t, 16> first = array.share();
    Paged<uint64_t, 16> last = array.share();
    const size_t whole = memory.bytes;
    for (int frame = 0; frame < 1000; ++frame) {
        for (int i = 0; i < 100; ++i) array.set(random.below(array.size()), random.next());
        last = array.share();
        // The first copy's pages, the array's, and room for those of two frames.
        ASSERT_LT(memory.bytes, 3 * whole) << frame;
    }
    const uint64_t before = memory.allocations;
    for (int frame = 0; frame < 100; ++frame) {
        for (int i = 0; i < 100; ++i) array.set(random.below(array.size()), random.next());
        last = array.share();
    }
    EXPECT_LT(memory.allocations - before, 100u * 20) << "pages come from those that were let go";
    for (uint32_t i = 0; i < first.size(); ++i) ASSERT_EQ(first[i], i);
}

TEST(Paged, CopiesMayEndOnAnyThreadMeanwhile) {
    struct Given {
        CountedArray copy;
        uint64_t sum;
    };
    {
        CountedArray array;
        std::vector<uint64_t> values(400);
        for (size_t i = 0; i < values.size(); ++i) array.push_back(0);
        std::mutex mutex;
        std::vector<Given> given;
        std::atomic<bool> done{false};
        std::atomic<int> read{0};
        std::vector<std::thread> threads;
        for (int t = 0; t < 3; ++t)
            threads.emplace_back([&, t] {
                Random random(static_cast<uint64_t>(t));
                for (bool last = false; !last;) {
                    last = done;
                    std::vector<Given> mine;
                    {
                        const std::lock_guard lock(mutex);
                        while (!given.empty() && mine.size() < 1 + random.below(6)) {
                            std::swap(given[random.below(given.size())], given.back());
                            mine.push_back(std::move(given.back()));
                            given.pop_back();
                        }
                    }
                    for (const Given& of : mine) {
                        uint64_t sum = 0;
                        for (uint32_t i = 0; i < of.copy.size(); ++i) sum += of.copy[i].value;
                        EXPECT_EQ(sum, of.sum);
                        ++read;
                    }
                }
            });
        Random random(8);
        for (int frame = 0; frame < 3000; ++frame) {
            for (int i = 0; i < 20; ++i) {
                const size_t at = random.below(values.size());
                values[at] = random.below(1000);
                array.set(at, values[at]);
            }
            uint64_t sum = 0;
            for (const uint64_t value : values) sum += value;
            const std::lock_guard lock(mutex);
            given.push_back({array.share(), sum});
            if (given.size() > 40) given.erase(given.begin());
        }
        done = true;
        for (std::thread& thread : threads) thread.join();
        EXPECT_GT(read, 0);
    }
    EXPECT_EQ(Counted::living, 0);
}

}  // namespace
}  // namespace sightline::test
