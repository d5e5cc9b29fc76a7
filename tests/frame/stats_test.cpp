// The table of a query's counters: names are told apart, and the work of two walks adds up.
// SPDX-License-Identifier: MIT
#include "sightline/frame/stats.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace sightline {
namespace {

TEST(QueryStats, RowsHaveNamesOfTheirOwn) {
    std::set<std::string> names;
    for (const CounterRow& row : kQueryCounters) EXPECT_TRUE(names.insert(row.name).second) << row.name;
    for (const CounterFlagRow& row : kQueryFlags) EXPECT_TRUE(names.insert(row.name).second) << row.name;
}

TEST(QueryStats, WorkAddsUpAndWhatTheAnswerCountsDoesNot) {
    QueryStats one, other;
    uint64_t next = 1;
    for (const CounterRow& row : kQueryCounters) {
        one.*row.member = next;
        other.*row.member = 1000 * next++;
    }
    for (int stage = 0; stage < kStageCount; ++stage) {
        one.stages[stage] = {1, 2, 3, 4};
        other.stages[stage] = {10, 20, 30, 40};
    }
    for (const CounterFlagRow& row : kQueryFlags) {
        QueryStats sum;
        sum.addWork(sum);
        EXPECT_FALSE(sum.*row.member) << row.name;
        QueryStats spent;
        spent.*row.member = true;
        sum.addWork(spent);
        EXPECT_TRUE(sum.*row.member) << row.name;
        sum.addWork(QueryStats());
        EXPECT_TRUE(sum.*row.member) << row.name;
    }
    one.addWork(other);
    next = 1;
    for (const CounterRow& row : kQueryCounters) {
        EXPECT_EQ(one.*row.member, row.kind == CounterRow::kOfAnswer ? next : 1001 * next) << row.name;
        ++next;
    }
    for (const StageStats& stage : one.stages) {
        EXPECT_EQ(stage.tested, 1u);
        EXPECT_EQ(stage.culled, 2u);
        EXPECT_EQ(stage.doubt, 33u);
        EXPECT_EQ(stage.nanoseconds, 44u);
    }
}

}  // namespace
}  // namespace sightline
