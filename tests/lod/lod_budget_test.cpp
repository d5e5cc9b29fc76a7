// Levels under a budget: held to the best choice of all, found by dynamic programming, and to the budget itself.
// SPDX-License-Identifier: MIT
#include "sightline/lod/lod_budget.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "sightline/base/random.h"

namespace sightline {
namespace {

struct Case {
    std::vector<std::vector<LodLevel>> levels;
    std::vector<LodItem> items;
    LodBudgetSettings settings;
};

/// Costs are whole microseconds, so that the oracle can count in them.
Case someCase(Random& random, size_t most) {
    Case made;
    made.settings.cost = {1000, 1000, 0, random.below(2) ? 0.0 : 1000};
    made.settings.hysteresis = random.below(2) ? 0.1 : 0.0;
    made.settings.hard = random.below(2);
    const size_t count = 1 + random.below(most);
    made.levels.resize(count);
    for (size_t i = 0; i < count; ++i) {
        const size_t levels = random.below(6);
        double error = 0;
        auto triangles = static_cast<uint32_t>(1 + random.below(40));
        for (size_t level = 0; level < levels; ++level) {
            made.levels[i].push_back({error, triangles, triangles});
            error += random.uniform(0.01, 2);
            triangles = std::max(1u, triangles - static_cast<uint32_t>(random.below(triangles)));
        }
    }
    for (size_t i = 0; i < count; ++i) {
        LodItem item;
        item.levels = made.levels[i];
        item.pixels_of_unit = random.uniform(0.1, 10);
        item.pixels = static_cast<double>(random.below(30));
        item.importance = random.uniform(0.5, 2);
        item.always = random.below(8) == 0;
        if (!item.levels.empty() && random.below(2)) item.last = static_cast<uint8_t>(random.below(item.levels.size()));
        if (!item.levels.empty() && random.below(3) == 0)
            item.finest = static_cast<uint8_t>(random.below(item.levels.size()));
        made.items.push_back(item);
    }
    return made;
}

double benefitOf(const Case& of, size_t i, uint8_t level) {
    if (level == LodBudget::kLeftOut) return 0;
    const LodItem& item = of.items[i];
    const double worth = item.importance * item.pixels;
    if (item.levels.empty()) return worth;
    const double error = item.levels[level].error * item.pixels_of_unit;
    double accuracy = of.settings.error / (of.settings.error + error);
    if (level == item.last) accuracy *= 1 + of.settings.hysteresis;
    return worth * accuracy;
}

uint64_t microsecondsOf(const Case& of, size_t i, uint8_t level) {
    if (level == LodBudget::kLeftOut) return 0;
    const LodItem& item = of.items[i];
    const double cost =
        item.levels.empty() ? of.settings.cost.object : of.settings.cost.of(item.levels[level], item.pixels);
    return static_cast<uint64_t>(std::llround(cost / 1000));
}

std::vector<uint8_t> choices(const Case& of, size_t i) {
    std::vector<uint8_t> out;
    const LodItem& item = of.items[i];
    if (of.settings.hard && !item.always && !item.levels.empty()) out.push_back(LodBudget::kLeftOut);
    if (item.levels.empty()) out.push_back(0);
    for (size_t level = item.finest; level < item.levels.size(); ++level) out.push_back(static_cast<uint8_t>(level));
    return out;
}

/// The best benefit within a budget, or -1 if there is no choice within it.
double bestBenefit(const Case& of, uint64_t budget) {
    std::vector<double> best(budget + 1, 0.0);
    for (size_t i = 0; i < of.items.size(); ++i) {
        std::vector<double> next(budget + 1, -1.0);
        for (const uint8_t level : choices(of, i)) {
            const uint64_t cost = microsecondsOf(of, i, level);
            for (uint64_t spent = cost; spent <= budget; ++spent)
                if (best[spent - cost] >= 0)
                    next[spent] = std::max(next[spent], best[spent - cost] + benefitOf(of, i, level));
        }
        best = next;
    }
    return *std::max_element(best.begin(), best.end());
}

uint64_t leastCost(const Case& of) {
    uint64_t sum = 0;
    for (size_t i = 0; i < of.items.size(); ++i) {
        uint64_t least = ~uint64_t{0};
        for (const uint8_t level : choices(of, i)) least = std::min(least, microsecondsOf(of, i, level));
        sum += least;
    }
    return sum;
}

TEST(LodBudget, IsWorthNearlyWhatTheBestChoiceIsAndKeepsToTheBudget) {
    Random random(1);
    LodBudget budget;
    double sum = 0, worst = 1;
    int compared = 0;
    for (int round = 0; round < 2000; ++round) {
        Case made = someCase(random, 24);
        const uint64_t microseconds = random.below(400);
        made.settings.nanoseconds = 1000.0 * static_cast<double>(microseconds);
        std::vector<uint8_t> chosen(made.items.size());
        const LodBudgetResult result = budget.choose(made.items, made.settings, chosen);
        double benefit = 0;
        uint64_t cost = 0;
        uint32_t left_out = 0;
        for (size_t i = 0; i < chosen.size(); ++i) {
            const auto allowed = choices(made, i);
            ASSERT_NE(std::find(allowed.begin(), allowed.end(), chosen[i]), allowed.end()) << "round " << round;
            benefit += benefitOf(made, i, chosen[i]);
            cost += microsecondsOf(made, i, chosen[i]);
            left_out += chosen[i] == LodBudget::kLeftOut;
        }
        ASSERT_NEAR(result.benefit, benefit, 1e-9 * (1 + benefit));
        ASSERT_NEAR(result.cost, 1000.0 * static_cast<double>(cost), 1e-3);
        ASSERT_EQ(result.left_out, left_out);
        const bool impossible = leastCost(made) > microseconds;
        ASSERT_EQ(result.exceeded, impossible) << "round " << round;
        if (impossible) {
            ASSERT_EQ(cost, leastCost(made)) << "round " << round;
            continue;
        }
        ASSERT_LE(cost, microseconds) << "round " << round;
        const double best = bestBenefit(made, microseconds);
        if (best <= 0) continue;
        ASSERT_GE(benefit, 0.5 * best) << "round " << round;
        sum += benefit / best;
        worst = std::min(worst, benefit / best);
        ++compared;
    }
    EXPECT_GT(compared, 500);
    EXPECT_GE(sum / compared, 0.99) << "worst " << worst;
}

TEST(LodBudget, IsWorthNearlyTheBestWhereThereAreMany) {
    Random random(2);
    LodBudget budget;
    for (int round = 0; round < 12; ++round) {
        Case made = someCase(random, 1);
        while (made.items.size() < 150) {
            Case more = someCase(random, 1);
            made.levels.push_back(std::move(more.levels[0]));
            LodItem item = more.items[0];
            item.levels = made.levels.back();
            made.items.push_back(item);
        }
        for (size_t i = 0; i < made.items.size(); ++i) made.items[i].levels = made.levels[i];
        const uint64_t microseconds = leastCost(made) + 200 + random.below(1500);
        made.settings.nanoseconds = 1000.0 * static_cast<double>(microseconds);
        std::vector<uint8_t> chosen(made.items.size());
        const LodBudgetResult result = budget.choose(made.items, made.settings, chosen);
        EXPECT_GE(result.benefit, 0.95 * bestBenefit(made, microseconds)) << "round " << round;
    }
}

TEST(LodBudget, WithTimeToSpareEverythingIsAsFineAsIsOfUse) {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        Case made = someCase(random, 40);
        made.settings.nanoseconds = 1e12;
        made.settings.hysteresis = 0;
        for (LodItem& item : made.items) item.pixels += 1;
        std::vector<uint8_t> chosen(made.items.size());
        LodBudget().choose(made.items, made.settings, chosen);
        for (size_t i = 0; i < chosen.size(); ++i) {
            const LodItem& item = made.items[i];
            if (item.levels.empty()) EXPECT_EQ(chosen[i], 0);
            else EXPECT_EQ(item.levels[chosen[i]].error, item.levels[item.finest].error);
        }
    }
}

TEST(LodBudget, AMemoryKeepsLevelsWhereWorthsDifferByLittle) {
    const std::vector<LodLevel> levels = {{0, 100, 60}, {0.1, 50, 30}};
    std::vector<LodItem> items(2);
    for (LodItem& item : items) {
        item.levels = levels;
        item.pixels_of_unit = 10;
        item.pixels = 100;
    }
    LodBudgetSettings settings;
    settings.cost = {0, 1, 0, 0};
    settings.nanoseconds = 150;  // one of them may be fine
    std::vector<uint8_t> chosen(2);
    Random random(4);
    LodBudget budget;
    budget.choose(items, settings, chosen);
    const uint8_t first = chosen[0];
    EXPECT_NE(chosen[0], chosen[1]);
    for (int frame = 0; frame < 100; ++frame) {
        for (size_t i = 0; i < 2; ++i) {
            items[i].last = chosen[i];
            items[i].pixels = 100 + random.uniform(-1, 1);
        }
        budget.choose(items, settings, chosen);
        ASSERT_EQ(chosen[0], first) << "frame " << frame;
    }
}

TEST(LodBudget, IsTheSameWhicheverOrderArraysWereUsedInBefore) {
    Random random(5);
    LodBudget used;
    for (int round = 0; round < 100; ++round) {
        Case made = someCase(random, 200);
        made.settings.nanoseconds = 1000.0 * static_cast<double>(random.below(4000));
        std::vector<uint8_t> a(made.items.size()), b(made.items.size());
        used.choose(made.items, made.settings, a);
        LodBudget().choose(made.items, made.settings, b);
        ASSERT_EQ(a, b);
    }
}

TEST(LodBudget, NumbersThatAreNoneKeepObjects) {
    const double nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
    const std::vector<LodLevel> levels = {{0, 100, 60}, {nan, 50, 30}, {infinity, 2, 2}};
    LodBudgetSettings settings;
    settings.cost = {0, 1, 0, 0};
    settings.nanoseconds = 1e9;
    for (const double worth : {nan, infinity, 0.0, 1.0}) {
        for (const double unit : {nan, infinity, 0.0, 1.0}) {
            LodItem item;
            item.levels = levels;
            item.pixels_of_unit = unit;
            item.pixels = worth;
            uint8_t chosen = 9;
            LodBudget().choose({&item, 1}, settings, {&chosen, 1});
            EXPECT_LT(chosen, levels.size());
        }
    }
    EXPECT_EQ(LodBudget().choose({}, settings, {}).cost, 0);
}

}  // namespace
}  // namespace sightline
