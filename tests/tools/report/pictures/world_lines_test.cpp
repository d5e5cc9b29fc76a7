// Lines of the world lie where their ends are, and are faint or gone behind surfaces.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/world_lines.h"

#include <limits>

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

constexpr Rgb kGround{0, 0, 0}, kLine{200, 100, 50};

/// 20 by 10 pixels; its right half shows a surface five away.
class HalfCovered : public testing::TestWithParam<bool> {
protected:
    HalfCovered() {
        view_.view = lookAt({0, 0, 0}, {0, 0, -1}, {0, 1, 0});
        view_.projection = GetParam() ? orthographic(10, 2, 0.1, 100) : perspective(1.5707963267948966, 2, 0.1);
        for (uint32_t i = 0; i < 40 * 20; ++i)
            nearness_.push_back(i % 40 < 20 ? -std::numeric_limits<double>::infinity() : GetParam() ? -5 : 0.2);
    }
    Image<Rgb> drawn(const glm::dvec3& from, const glm::dvec3& to, const LineStyle& style) {
        WorldLines lines(view_, 40, 20, nearness_);
        lines.line(from, to, style);
        return lines.over(Image<Rgb>(20, 10, kGround));
    }

    View view_;
    std::vector<double> nearness_;
};

TEST_P(HalfCovered, HidesALineBehindTheSurface) {
    const Image<Rgb> behind = drawn({-4, 0, -10}, {4, 0, -10}, {kLine, 3, 1, 0});
    EXPECT_EQ(behind.at(8, 5), kLine);
    EXPECT_EQ(behind.at(11, 5), kGround);
    const Image<Rgb> faint = drawn({-4, 0, -10}, {4, 0, -10}, {kLine, 3, 1, 0.5});
    EXPECT_NEAR(faint.at(11, 5).x, 100, 1);
    const Image<Rgb> before = drawn({-2, 0, -4}, {2, 0, -4}, {kLine, 3, 1, 0});
    EXPECT_EQ(before.at(11, 5), kLine);
    const Image<Rgb> upon = drawn({-2, 0, -5}, {2, 0, -5}, {kLine, 3, 1, 0});
    EXPECT_EQ(upon.at(11, 5), kLine) << "what lies on a surface is not behind it";
}

TEST_P(HalfCovered, CutsLinesAtTheBorders) {
    const Image<Rgb> across = drawn({-1e6, 0, -4}, {1e6, 0, -4}, {kLine, 2, 1, 1});
    for (uint32_t x = 0; x < 20; ++x) EXPECT_EQ(across.at(x, 5), kLine) << x;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    for (const glm::dvec3& away : {glm::dvec3(0, 0, 9), glm::dvec3(99, 0, -4), glm::dvec3(nan, 0, -4)})
        EXPECT_EQ(drawn(away, away + glm::dvec3(1, 0, 0), {kLine, 2, 1, 1}).pixels, Image<Rgb>(20, 10, kGround).pixels);
}

TEST_P(HalfCovered, TellsWhereAPointIs) {
    const WorldLines lines(view_, 40, 20, nearness_);
    const auto middle = lines.placeOf({0, 0, -7});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, 0.5, 1e-12);
    EXPECT_NEAR(middle->y, 0.5, 1e-12);
    EXPECT_LT(lines.placeOf({0, 1, -7})->y, 0.5) << "from the top";
    EXPECT_FALSE(lines.placeOf({0, 0, 7}));
    EXPECT_FALSE(lines.placeOf({0, 99, -7}));
}

INSTANTIATE_TEST_SUITE_P(WorldLines, HalfCovered, testing::Bool(),
                         [](const auto& info) { return info.param ? "Parallel" : "Perspective"; });

}  // namespace
}  // namespace sightline
