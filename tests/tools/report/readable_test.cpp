// Numbers as a reader takes them.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/readable.h"

#include <limits>

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

TEST(Readable, GroupsLongNumbers) {
    EXPECT_EQ(readable(0), "0");
    EXPECT_EQ(readable(999), "999");
    EXPECT_EQ(readable(1000), "1,000");
    EXPECT_EQ(readable(1234567), "1,234,567");
    EXPECT_EQ(readable(0.25), "0.25");
    EXPECT_EQ(readable(-1234), "-1,234");
    EXPECT_EQ(readable(11920.4), "11,920");
    EXPECT_EQ(readable(-8.88178e-16), "0");
    EXPECT_EQ(readable(-0.0), "0");
    EXPECT_EQ(readable(0.00001234), "0.00001234");
    EXPECT_EQ(readable(999.96), "1,000");
    EXPECT_EQ(readable(12345.678, 7), "12,345.68");
    EXPECT_EQ(readable(1.0004, 3), "1");
    EXPECT_EQ(readable(std::numeric_limits<double>::infinity()), "–");
}

}  // namespace
}  // namespace sightline
