// Charts and texts of the page.
// SPDX-License-Identifier: MIT
#include "sightline/report/chart.h"

#include <cmath>
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
    const std::string html =
        chartHtml({"id", "A <title>", "µs", {{"one", "one", {1, 2, 3}}, {"two", "two", {3, 2, 1}}}});
    EXPECT_EQ(count(html, "<polyline"), 2u);
    EXPECT_EQ(count(html, "A &lt;title&gt;"), 1u);
    EXPECT_EQ(count(html, "id=\"id-now\""), 1u);
    EXPECT_EQ(count(html, "id=\"id-values\""), 1u);
    EXPECT_EQ(count(html, "tabindex=\"0\""), 1u);
}

TEST(Chart, StacksAreasUnderLines) {
    const std::string html =
        chartHtml({"id", "t", "µs", {{"a", "one", {1, 1}, true}, {"b", "two", {3, 3}, true}, {"all", "ink", {2, 2}}}});
    EXPECT_EQ(count(html, "<polygon"), 2u);
    EXPECT_EQ(count(html, "<polyline"), 1u);
    EXPECT_LT(html.find("class=\"two\""), html.find("class=\"one\""));  // the lower area lies over the higher one
    EXPECT_LT(html.find("<polygon"), html.find("<polyline"));
    EXPECT_EQ(count(html, " 1000.0,0.0"), 1u);  // 1 + 3 is the top of the axis
}

TEST(Chart, NamesItsSeries) {
    EXPECT_EQ(chartLegend({"id", "t", "u", {{"a <b>", "one", {1}}}}),
              "<div class=\"legend\"><span><i class=\"one\"></i>a &lt;b&gt;</span></div>");
}

TEST(Chart, TakesOneFrameNoneZerosGapsAndVeryMany) {
    EXPECT_EQ(chartHtml({"id", "t", "u", {}}), "");
    const double gap = std::nan("");
    for (const bool stacked : {false, true}) {
        EXPECT_EQ(count(chartHtml({"id", "t", "u", {{"a", "one", {5}, stacked}}}), "nan"), 0u);
        EXPECT_EQ(count(chartHtml({"id", "t", "u", {{"a", "one", {0, 0}, stacked}}}), "nan"), 0u);
        EXPECT_EQ(count(chartHtml({"id", "t", "u", {{"a", "one", {gap, 1, gap}, stacked}}}), "nan"), 0u);
        EXPECT_EQ(count(chartHtml({"id", "t", "u", {{"a", "one", {gap}, stacked}}}), "nan"), 0u);
    }
    const std::string many = chartHtml({"id", "t", "u", {{"a", "one", std::vector<double>(100000, 2.0)}}});
    EXPECT_LE(many.size(), 20000u);
}

TEST(Chart, GridLinesAreWhole) {
    EXPECT_EQ(gridStep(4), 1);
    EXPECT_EQ(gridStep(10), 5);
    EXPECT_EQ(gridStep(800), 200);
}

}  // namespace
}  // namespace sightline
