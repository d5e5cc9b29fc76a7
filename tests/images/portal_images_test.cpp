// Laws of baked portal images: exact where they were taken, worse as predicted, refused where they cannot serve.
// SPDX-License-Identifier: MIT
#include "sightline/images/portal_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "sightline/images/psnr.h"
#include "tests/images/doorway_room.h"

namespace sightline::test {
namespace {

constexpr uint32_t kWidth = 60, kHeight = 120;

PortalImageSettings madeSettings() {
    PortalImageSettings settings;
    settings.width = kWidth;
    settings.height = kHeight;
    settings.across = 1;
    settings.images = {1.2, 1.5, 1.5, 1, 24, 0.9};
    settings.references = {1.2, 1.0, 2.2, 2, 5, 0.9};
    settings.layered = {1.2, 1.0, 2.2, 2, 3, 0.9};
    return settings;
}

class PortalImagesTest : public testing::Test {
protected:
    static void SetUpTestSuite() {
        room_ = new DoorwayRoom(1);
        images_ = new PortalImages(*bakePortalImages(madeDoorway(), room_->items(), madeSettings()));
    }
    static void TearDownTestSuite() {
        delete images_;
        delete room_;
    }

    static std::vector<glm::u8vec3> truthAt(const glm::dvec3& eye) {
        return coloursOf(room_->take(eye, kWidth, kHeight));
    }
    static double psnrAt(const glm::dvec3& eye, ShowMode mode, Shown* shown = nullptr) {
        PortalPicture picture;
        const Shown done = showPortal(*images_, eye, anything(mode), picture);
        EXPECT_EQ(done.result, ShowResult::kShown);
        if (shown) *shown = done;
        PictureError error;
        error.add(truthAt(eye), picture.colour);
        return error.psnr();
    }
    static ShowSettings anything(ShowMode mode) {
        ShowSettings settings;
        settings.mode = mode;
        settings.focal = 300;
        settings.most_error = std::numeric_limits<double>::infinity();
        settings.reuse = false;
        return settings;
    }

    static DoorwayRoom* room_;
    static PortalImages* images_;
};
DoorwayRoom* PortalImagesTest::room_ = nullptr;
PortalImages* PortalImagesTest::images_ = nullptr;

TEST_F(PortalImagesTest, TexelsAreTheMeansOfTheirSamples) {
    PortalImageSettings settings = madeSettings();
    settings.across = 3;
    settings.images.angles = 3;
    settings.references.arcs = settings.layered.arcs = 0;
    const PortalImages smooth = *bakePortalImages(madeDoorway(), room_->items(), settings);
    ASSERT_EQ(smooth.images.size(), 3u);
    for (size_t at = 0; at < 3; ++at) {
        const std::vector<glm::u8vec3> samples = coloursOf(room_->take(smooth.fan.eyes[at], 3 * kWidth, 3 * kHeight));
        uint64_t mixed = 0;
        for (uint32_t row = 0; row < kHeight; ++row)
            for (uint32_t i = 0; i < kWidth; ++i) {
                glm::dvec3 sum(0.0), low(255.0), high(0.0);
                for (uint32_t k = 0; k < 9; ++k) {
                    const glm::dvec3 sample(samples[(3 * row + k / 3) * 3 * kWidth + 3 * i + k % 3]);
                    sum += sample / 9.0;
                    low = glm::min(low, sample);
                    high = glm::max(high, sample);
                }
                mixed += low != high;
                const glm::dvec3 texel(smooth.images[at][row * kWidth + i]);
                ASSERT_LE(glm::length(texel - sum), 1.0) << "sample " << at << ", row " << row << ", texel " << i;
            }
        EXPECT_GT(mixed, kWidth) << "there are edges";
    }
    settings.across = 0;
    EXPECT_FALSE(bakePortalImages(madeDoorway(), room_->items(), settings).ok());
    settings.across = 8192 / kWidth + 1;
    EXPECT_FALSE(bakePortalImages(madeDoorway(), room_->items(), settings).ok());
}

TEST_F(PortalImagesTest, AreExactAtTheirSamplePoints) {
    for (const size_t at : {size_t{0}, size_t{7}, size_t{23}})
        for (const ShowMode mode : {ShowMode::kNearest, ShowMode::kBlended}) {
            Shown shown;
            EXPECT_TRUE(std::isinf(psnrAt(images_->fan.eyes[at], mode, &shown))) << "sample " << at;
            EXPECT_EQ(shown.error.pixels, 0);
        }
    for (const size_t at : {size_t{0}, size_t{6}, size_t{9}})
        EXPECT_TRUE(std::isinf(psnrAt(images_->reference_fan.eyes[at], ShowMode::kWarped))) << "sample " << at;
    for (size_t at = 0; at < images_->layered_fan.eyes.size(); ++at)
        EXPECT_GT(psnrAt(images_->layered_fan.eyes[at], ShowMode::kLayered), 45) << "sample " << at;
}

TEST_F(PortalImagesTest, GetWorseAsPredicted) {
    const glm::dvec3 sample = images_->fan.eyes[12];
    double last_error = 0, last_psnr = std::numeric_limits<double>::infinity();
    for (const double step : {0.0, 0.005, 0.02, 0.08, 0.32}) {
        Shown shown;
        const double psnr = psnrAt(sample + glm::dvec3(0, 0, step), ShowMode::kNearest, &shown);
        EXPECT_LE(psnr, last_psnr) << "step " << step;
        EXPECT_GE(shown.error.pixels, last_error);
        last_psnr = psnr;
        last_error = shown.error.pixels;
    }
    EXPECT_GT(last_error, 10);
    EXPECT_LT(last_psnr, 30);
}

TEST_F(PortalImagesTest, CarriedOnesAreBetterThanNearestBetweenSamples) {
    Random random(2);
    PictureError errors[kShowModes];
    for (int i = 0; i < 12; ++i) {
        const double angle = random.uniform(-0.8, 0.8), radius = random.uniform(1.05, 2.1);
        const glm::dvec3 eye = glm::dvec3(0.5, 1.2, 0) + radius * glm::dvec3(std::sin(angle), 0, std::cos(angle));
        for (int mode = 0; mode < kShowModes; ++mode) {
            PortalPicture picture;
            ASSERT_TRUE(showPortal(*images_, eye, anything(static_cast<ShowMode>(mode)), picture).ok());
            errors[mode].add(truthAt(eye), picture.colour);
        }
    }
    const double nearest = errors[0].psnr(), blended = errors[1].psnr();
    EXPECT_GT(blended, nearest);
    for (const ShowMode mode : {ShowMode::kWarped, ShowMode::kLayered}) {
        EXPECT_GT(errors[static_cast<int>(mode)].psnr(), nearest + 3);
        EXPECT_GT(errors[static_cast<int>(mode)].psnr(), 29) << kShowModeNames[static_cast<int>(mode)];
    }
}

TEST_F(PortalImagesTest, KeepTheirPictureWhileItsPredictionAllows) {
    for (int mode = 0; mode < kShowModes; ++mode) {
        ShowSettings settings = anything(static_cast<ShowMode>(mode));
        settings.reuse = true;
        settings.most_error = 8;
        PortalPicture picture;
        size_t reused = 0, shown = 0;
        for (int frame = 0; frame < 200; ++frame) {
            const glm::dvec3 eye = images_->fan.eyes[10] + glm::dvec3(0.001 * frame, 0, 0);
            const std::vector<glm::u8vec3> before = picture.colour;
            const Shown done = showPortal(*images_, eye, settings, picture);
            if (!done.ok()) continue;
            EXPECT_LE(done.error.pixels, settings.most_error);
            EXPECT_LE(pictureError(*images_, picture, eye, settings.focal).pixels, settings.most_error);
            reused += done.result == ShowResult::kReused;
            shown += done.result == ShowResult::kShown;
            if (done.result == ShowResult::kReused) { EXPECT_EQ(picture.colour, before); }
        }
        EXPECT_GT(shown, 0u) << kShowModeNames[mode];
        EXPECT_GT(reused, 3 * shown) << kShowModeNames[mode];
    }
}

TEST_F(PortalImagesTest, RefuseWhatTheyCannotServeAndLeaveThePictureAsItWas) {
    PortalPicture picture;
    ASSERT_TRUE(showPortal(*images_, images_->fan.eyes[3], anything(ShowMode::kNearest), picture).ok());
    const std::vector<glm::u8vec3> before = picture.colour;
    const std::pair<glm::dvec3, EyePlace> eyes[] = {{{0.5, 1, 0}, EyePlace::kInPlane},
                                                    {{0.5, 1, -1}, EyePlace::kBehind},
                                                    {{40, 1, 1}, EyePlace::kEdgeOn},
                                                    {{0.5, NAN, 1}, EyePlace::kNotFinite}};
    for (const auto& [eye, place] : eyes)
        for (int mode = 0; mode < kShowModes; ++mode) {
            const Shown shown = showPortal(*images_, eye, anything(static_cast<ShowMode>(mode)), picture);
            EXPECT_EQ(shown.result, ShowResult::kEye);
            EXPECT_EQ(shown.place, place);
            EXPECT_FALSE(shown.ok());
        }
    ShowSettings strict = anything(ShowMode::kNearest);
    strict.most_error = 1;
    const Shown far = showPortal(*images_, {0.5, 1.2, 9}, strict, picture);
    EXPECT_EQ(far.result, ShowResult::kTooFarOff);
    EXPECT_GT(far.error.pixels, 1);
    EXPECT_EQ(picture.colour, before);
}

TEST_F(PortalImagesTest, ReportWhatTheyTook) {
    const PortalBakeReport& report = images_->report;
    EXPECT_EQ(report.images, 24u);
    EXPECT_EQ(report.references, 10u);
    EXPECT_EQ(report.layered, 6u);
    EXPECT_EQ(report.image_bytes, size_t{24} * kWidth * kHeight * 3);
    EXPECT_EQ(report.reference_bytes, size_t{10} * kWidth * kHeight * 16);
    EXPECT_GT(report.layered_bytes, size_t{6} * kWidth * kHeight * 16);
    EXPECT_GT(report.triangles, 0);
    EXPECT_NEAR(images_->beyond.farthest, 6, 1e-5) << "the far wall";
    EXPECT_NEAR(images_->beyond.nearest, 0, 1e-5);
}

TEST(PortalBake, IsTheSameHoweverItIsSharedOut) {
    const DoorwayRoom room(2);
    PortalImageSettings settings = madeSettings();
    const PortalImages alone = *bakePortalImages(madeDoorway(), room.items(), settings);
    size_t calls = 0, last = 0;
    settings.progress = [&](size_t done, size_t total) {
        EXPECT_EQ(done, last + 1);
        EXPECT_EQ(total, 40u);
        last = done;
        ++calls;
    };
    settings.share = [](size_t count, const std::function<void(size_t)>& work) {
        std::thread other([&] {
            for (size_t i = 1; i < count; i += 2) work(i);
        });
        for (size_t i = 0; i < count; i += 2) work(i);
        other.join();
    };
    const PortalImages shared = *bakePortalImages(madeDoorway(), room.items(), settings);
    EXPECT_EQ(calls, 40u);
    EXPECT_EQ(shared.images, alone.images);
    EXPECT_EQ(shared.beyond.farthest, alone.beyond.farthest);
    ASSERT_EQ(shared.layered.size(), alone.layered.size());
    for (size_t i = 0; i < alone.layered.size(); ++i) {
        ASSERT_EQ(shared.layered[i].first, alone.layered[i].first);
        for (size_t k = 0; k < alone.layered[i].samples.size(); ++k)
            ASSERT_EQ(shared.layered[i].samples[k].colour, alone.layered[i].samples[k].colour);
    }
}

TEST(PortalBake, AsksForColoursByTheItemsThatItWasGiven) {
    const DoorwayRoom room(3);
    PortalImageSettings settings = madeSettings();
    settings.references.arcs = settings.layered.arcs = 0;
    settings.images.angles = 2;
    settings.take.shade.shading = Shading::kNone;
    settings.take.shade.colour = [](uint32_t item, uint32_t) { return item == 5 ? glm::dvec3(1) : glm::dvec3(0); };
    const PortalImages images = *bakePortalImages(madeDoorway(), room.items(), settings);
    const HiddenImage shown =
        render(DrawList(room.items()), *portalView(madeDoorway(), images.fan.eyes[0], 60, 120), {});
    for (size_t at = 0; at < shown.surface.size(); ++at) {
        const bool is_it =
            shown.surface[at] != HiddenImage::kNone && DrawList(room.items()).idOf(shown.surface[at]) == 5;
        ASSERT_EQ(images.images[0][at], glm::u8vec3(is_it ? 255 : 0));
    }
    PortalPicture picture;
    EXPECT_EQ(showPortal(images, {0.5, 1, 1}, {.mode = ShowMode::kWarped}, picture).result, ShowResult::kNotBaked);
}

TEST(PortalBake, KnowsThatTheSkyIsSeen) {
    TestMesh mesh = boxMesh({0, 0, -3}, {1, 1, -2});
    DrawItem item;
    item.mesh = mesh.view();
    PortalImageSettings settings = madeSettings();
    settings.layered.arcs = 0;
    const PortalImages images = *bakePortalImages(madeDoorway(), {&item, 1}, settings);
    EXPECT_TRUE(std::isinf(images.beyond.farthest));
    EXPECT_NEAR(images.beyond.nearest, 2, 1e-6);
    const PortalImages empty = *bakePortalImages(madeDoorway(), {}, settings);
    EXPECT_TRUE(std::isinf(empty.beyond.farthest));
}

TEST(PortalBake, RefusesWrongSettings) {
    const auto refused = [](const std::function<void(PortalImageSettings&)>& change) {
        PortalImageSettings settings = madeSettings();
        change(settings);
        return !bakePortalImages(madeDoorway(), {}, settings).ok();
    };
    EXPECT_TRUE(refused([](PortalImageSettings& s) { s.width = 0; }));
    EXPECT_TRUE(refused([](PortalImageSettings& s) { s.height = 100000; }));
    EXPECT_TRUE(refused([](PortalImageSettings& s) { s.images.nearest = -1; }));
    EXPECT_TRUE(refused([](PortalImageSettings& s) { s.layer_margin = 7; }));
    EXPECT_TRUE(refused([](PortalImageSettings& s) { s.references.half_angle = 1.56; }))
        << "an eye that sees it edge-on";
}

}  // namespace
}  // namespace sightline::test
