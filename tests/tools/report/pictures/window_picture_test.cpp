// Windows are drawn where they are, and what is said of them adds up.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/window_picture.h"

#include <gtest/gtest.h>

namespace sightline {
using namespace tools;
namespace {

std::vector<glm::dvec2> rectangle(double left, double top, double right, double bottom) {
    return {{left, top}, {right, top}, {right, bottom}, {left, bottom}};
}

TEST(WindowPicture, TellsCellsAndAreas) {
    const std::vector<CellWindow> exact{
        {3, rectangle(0, 0, 10, 10)}, {3, rectangle(20, 0, 30, 10)}, {4, rectangle(0, 0, 5, 10)}};
    const std::vector<CellWindow> boxes{
        {3, rectangle(0, 0, 30, 10)}, {4, rectangle(0, 0, 5, 10)}, {9, rectangle(0, 0, 2, 20)}};
    const std::string text = windowText(exact, boxes);
    EXPECT_NE(text.find("2 cells seen through 3 exact windows"), std::string::npos) << text;
    EXPECT_NE(text.find("reach 3 cells and 1.56 times the area"), std::string::npos) << text;  // 390 of 250
    EXPECT_NE(windowText({}, {}).find("no cell"), std::string::npos);
}

TEST(WindowPicture, DrawsOutlinesInTheScaleOfThePicture) {
    Image<Rgb> picture(40, 20, Rgb(0, 0, 0));
    const std::vector<CellWindow> exact{{0, rectangle(20, 10, 60, 30)}};
    const Image<Rgb> drawn = windowPicture(picture, {0.5, 0.5}, exact, {});
    const Rgb ground = drawn.at(2, 2);
    EXPECT_NE(drawn.at(10, 10), ground);  // the left side lies there
    EXPECT_NE(drawn.at(20, 5), ground);   // and the upper one
    EXPECT_EQ(drawn.at(36, 10), ground);
    EXPECT_EQ(windowPicture(picture, {0.5, 0.5}, {}, {}).at(20, 10), ground);
}

TEST(WindowPicture, BearsWhatHasNoArea) {
    Image<Rgb> picture(8, 8, Rgb(9, 9, 9));
    const std::vector<CellWindow> odd{{1, {}}, {2, {{1, 1}}}, {3, {{1, 1}, {5, 5}}}, {4, rectangle(1e300, 0, 2, 2)}};
    EXPECT_EQ(windowPicture(picture, {1, 1}, odd, odd).pixels.size(), 64u);
    EXPECT_FALSE(windowText(odd, odd).empty());
}

}  // namespace
}  // namespace sightline
