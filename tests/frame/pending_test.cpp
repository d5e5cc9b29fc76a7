// The queue of a walk gives back what a stable sort by nearness would.
// SPDX-License-Identifier: MIT
#include "sightline/frame/pending.h"

#include <algorithm>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline::detail {
namespace {

TEST(PendingQueue, GivesBackTheNearestFirstAndEqualsInOrder) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    const float extremes[] = {kInfinity, -kInfinity, 0.0f, -0.0f, 1e-42f, -1e-42f, 3e38f, -3e38f};
    Random random(5);
    PendingQueue queue(defaultMemory());
    for (int round = 0; round < 20; ++round) {
        queue.clear();
        std::vector<Pending> waiting;
        uint32_t met = 0;
        for (int step = 0; step < 3000; ++step) {
            if (random.below(5) < 3) {
                Pending entry;
                entry.rect.nearness = random.below(8) == 0 ? extremes[random.below(8)]
                                      : random.below(2)    ? static_cast<float>(random.uniform(-1, 1))
                                                           : 0.125f * static_cast<float>(random.below(9)) - 0.5f;
                entry.index = entry.serial = met++;
                queue.push(entry);
                waiting.push_back(entry);
            } else if (!waiting.empty()) {
                const auto first = std::max_element(waiting.begin(), waiting.end(), [](const auto& a, const auto& b) {
                    return a.rect.nearness != b.rect.nearness ? a.rect.nearness < b.rect.nearness : a.serial > b.serial;
                });
                const Pending got = queue.pop();
                ASSERT_EQ(got.index, first->index);
                ASSERT_EQ(got.serial, first->serial);
                waiting.erase(first);
            }
            ASSERT_EQ(queue.empty(), waiting.empty());
        }
    }
}

}  // namespace
}  // namespace sightline::detail
