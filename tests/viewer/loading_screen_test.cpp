// What the window shows while a scene is loaded.
// SPDX-License-Identifier: MIT
#include "apps/viewer/loading_screen.h"

#include "tests/viewer/driven_viewer.h"

namespace sightline::viewer {
namespace {

TEST_F(ViewerTest, ALoadingScreenShowsHowFarItIs) {
    context_->makeCurrent();
    Result<LoadingScreen> screen = LoadingScreen::create();
    ASSERT_TRUE(screen.ok()) << screen.error().message;
    const auto picture = [&](const LoadingPart& now) {
        for (int i = 0; i < 2; ++i)  // windows take their places in the first frame
            EXPECT_TRUE(screen->frame({}, 640, 360, 1, "city.glb", now).ok());
        const Result<Image<Rgb>> shown = screen->image().picture();
        EXPECT_TRUE(shown.ok());
        return shown ? *shown : Image<Rgb>();
    };
    const Image<Rgb> begun = picture({"reading", 0}), half = picture({"reading", 0.5}), done = picture({"reading", 1});
    EXPECT_EQ(begun.width, 640u);
    EXPECT_GT(differing(begun, half), 1000u);
    EXPECT_GT(differing(begun, done), 3 * differing(begun, half) / 2);
    EXPECT_GT(differing(half, picture({"preparing", 0.5})), 20u);
    EXPECT_EQ(differing(done, picture({"reading", 7})), 0u) << "no more than all";
}

}  // namespace
}  // namespace sightline::viewer
