// Charts and texts of the page.
// SPDX-License-Identifier: MIT
#include "sightline/report/chart.h"

#include <limits>

#include <gtest/gtest.h>

namespace sightline {
namespace {

size_t count(const std::string& text, const std::string& word) {
    size_t found = 0;
    for (size_t at = text.find(word); at != std::string::npos; at = text.find(word, at + 1)) ++found;
    return found;
}

TEST(Chart, GroupsLongNumbers) {
    EXPECT_EQ(readable(0), "0");
    EXPECT_EQ(readable(999), "999");
    EXPECT_EQ(readable(1000), "1,000");
    EXPECT_EQ(readable(1234567), "1,234,567");
    EXPECT_EQ(readable(0.25), "0.25");
    EXPECT_EQ(readable(-1234), "-1,234");
    EXPECT_EQ(readable(std::numeric_limits<double>::infinity()), "–");
}

TEST(Chart, EscapesWhatHtmlWouldRead) { EXPECT_EQ(escapeHtml("<a b=\"c\">&'"), "&lt;a b=&quot;c&quot;&gt;&amp;&#39;"); }

TEST(Chart, DrawsALinePerSeries) {
    const std::string svg = chartSvg({"id", "A <title>", "µs", {{"one", "one", {1, 2, 3}}, {"two", "two", {3, 2, 1}}}});
    EXPECT_EQ(count(svg, "<polyline"), 2u);
    EXPECT_EQ(count(svg, "class=\"hit\""), 3u);
    EXPECT_EQ(count(svg, "A &lt;title&gt;"), 1u);
    EXPECT_EQ(count(svg, "id=\"id-now\""), 1u);
}

TEST(Chart, TakesOneFrameNoneZerosAndVeryMany) {
    EXPECT_EQ(chartSvg({"id", "t", "u", {}}), "");
    EXPECT_EQ(count(chartSvg({"id", "t", "u", {{"a", "one", {5}}}}), "nan"), 0u);
    EXPECT_EQ(count(chartSvg({"id", "t", "u", {{"a", "one", {0, 0}}}}), "nan"), 0u);
    const std::string many = chartSvg({"id", "t", "u", {{"a", "one", std::vector<double>(100000, 2.0)}}});
    EXPECT_LE(count(many, "class=\"hit\""), 800u);
}

}  // namespace
}  // namespace sightline
