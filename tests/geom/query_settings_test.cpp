// The table of a query's settings: names are told apart, and what holds unless it is asked otherwise may be asked for.
// SPDX-License-Identifier: MIT
#include "sightline/geom/query_settings.h"
#include "sightline/geom/setting_rows.h"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace sightline {
namespace {

TEST(QuerySettings, RowsHaveNamesOfTheirOwnAndStandardsWithinTheirLimits) {
    std::set<std::string> names, options;
    forEachSetting([&](const auto& row) {
        EXPECT_TRUE(names.insert(row.name).second) << row.name << " is there twice";
        if (row.option) { EXPECT_TRUE(options.insert(row.option).second) << "--" << row.option << " is there twice"; }
        EXPECT_NE(std::string(row.help), "") << row.name;
        EXPECT_LT(row.least, row.most) << row.name;
        const auto standard = static_cast<double>(row.standard());
        EXPECT_GE(standard, row.least) << row.name;
        EXPECT_LE(standard, row.most) << row.name;
    });
}

}  // namespace
}  // namespace sightline
