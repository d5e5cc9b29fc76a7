// An independent renderer bears the reference out: Mesa's software GL sees the same surfaces, but for samples at edges.
// SPDX-License-Identifier: MIT
#include "apps/gl/renderers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "sightline/studies/hidden/compare.h"
#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "tests/studies/hidden/made_lists.h"
#include "tests/support/shared_scenes.h"

namespace sightline::test {
using namespace studies;
using namespace tools;
namespace {

/// Mesa snaps vertices to multiples of 1/256 of a pixel: by at most sqrt(2)/512, which moves an edge by no more.
constexpr double kEdgeBand = 1.0 / 256;
/// Depths are planes in float.
constexpr double kTieBand = 1e-5;

AgreementBands bands() {
    AgreementBands bands;
    bands.edge = kEdgeBand;
    bands.tie = kTieBand;
    return bands;
}

class GlIdRendererTest : public testing::Test {
protected:
    void SetUp() override {
        if (!context_) GTEST_SKIP() << context_.error().message;
    }

    HiddenImage drawn(const DrawList& list, const View& view) {
        Result<GlIdRenderer> renderer = GlIdRenderer::create(*context_, list);
        EXPECT_TRUE(renderer.ok()) << renderer.error().message;
        const Status done = renderer->draw(view);
        EXPECT_TRUE(done.ok()) << done.error().message;
        return *renderer->read();
    }

    /// Holds Mesa's ids against the reference's; a failure names the case and the first sample that nothing explains.
    Agreement compare(const DrawList& list, const View& view, const std::string& name) {
        const HiddenImage expected = nearestSurfaces(list, view), found = drawn(list, view);
        const Agreement result = compareImages(list, view, expected, found, bands());
        EXPECT_EQ(result.wrong, 0u) << name << ": sample " << result.sample << " of row " << result.row << " shows "
                                    << result.found << " instead of " << result.expected;
        holdZBuffer(list, view, found, name);
        add(result, sum_);
        return result;
    }

    /// The tiled z-buffer, on two threads, sees what Mesa sees: both keep reversed depths in float.
    void holdZBuffer(const DrawList& list, const View& view, const HiddenImage& mesa, const std::string& name) {
        RenderSettings settings;
        settings.method = HiddenMethod::kZBuffer;
        settings.threads = 2;
        const HiddenImage image = render(list, view, settings);
        const Agreement result = compareImages(list, view, mesa, image, bands());
        EXPECT_EQ(result.wrong, 0u) << name << ", z-buffer: sample " << result.sample << " of row " << result.row
                                    << " shows " << result.found << " instead of " << result.expected;
        add(result, zbuffer_sum_);
    }

    static void add(const Agreement& more, Agreement& sum) {
        sum.samples += more.samples;
        sum.differing += more.differing;
        sum.at_edges += more.at_edges;
        sum.ties += more.ties;
        sum.wrong += more.wrong;
    }

    /// Says the sums, and begins new ones.
    void print(const char* what) {
        for (const bool tiled : {false, true}) {
            Agreement& sum = tiled ? zbuffer_sum_ : sum_;
            std::printf("%s, %s: %zu of %zu samples differ: %zu at edges, %zu ties, %zu unexplained\n", what,
                        tiled ? "z-buffer" : "reference", size_t(sum.differing), size_t(sum.samples),
                        size_t(sum.at_edges), size_t(sum.ties), size_t(sum.wrong));
            sum = {};
        }
    }

    Result<GlContext> context_ = GlContext::create(2);
    Agreement sum_, zbuffer_sum_;  ///< of the reference and of the tiled z-buffer, against Mesa
};

uint64_t seeds() { return std::getenv("SIGHTLINE_FULL") != nullptr ? 200 : 10; }

TEST_F(GlIdRendererTest, SeesWhatTheReferenceSeesInMadeLists) {
    std::vector<MadeList> lists{cyclicOverlap()};
    for (uint64_t seed = 1; seed <= seeds(); ++seed) {
        lists.push_back(interpenetration(seed));
        lists.push_back(clutter(seed, 2000));
        lists.push_back(clutter(seed, 300, 3.0));
        lists.push_back(coplanar(seed));
        lists.push_back(slivers(seed));
        lists.push_back(throughTheEye(seed));
    }
    for (const MadeList& made : lists) {
        for (const double z_near : {0.1, 0.001}) {
            const Agreement result = compare(made.list(), madeView(320, 240, z_near),
                                             made.name + ", near plane at " + std::to_string(z_near));
            EXPECT_LE(result.differing, 60u) << made.name;
        }
    }
    print("made lists");
}

TEST_F(GlIdRendererTest, SeesTheSameInEveryKindOfView) {
    for (uint64_t seed = 1; seed <= seeds(); ++seed) {
        const MadeList made = clutter(seed, 1500);
        std::vector<DrawItem> items = made.items();
        View view = madeView(320, 240);
        const glm::dmat4 usual = view.projection;
        const auto hold = [&](const char* name) {
            compare(DrawList(items), view, std::string(name) + ", " + made.name);
        };
        view.projection = perspective(1.0, 4.0 / 3, 0.1, 6.0);
        hold("finite far plane");
        view.projection = orthographic(6, 4.0 / 3, 0.1, 20);
        hold("parallel");
        view.projection = orthographic(6, 4.0 / 3, 0.1, std::numeric_limits<double>::infinity());
        hold("parallel, infinite far plane");
        view.projection = usual;
        view.projection[2][0] = 0.4;
        view.projection[2][1] = -0.3;
        hold("off-centre");
        view.projection = usual;
        view.projection[0] = -view.projection[0];
        hold("mirrored projection");
        view.projection = usual;
        items[0].transform[0] = -items[0].transform[0];
        hold("mirrored item");
        // A world far from its origin, where float knows no more than half a unit.
        const glm::dvec3 away(4e6, -2e6, 8e6);
        items[0].transform = glm::dmat4(1.0);
        items[0].transform[3] = glm::dvec4(away, 1.0);
        view.view = lookAt(away, away + glm::dvec3(0.2, -0.1, -1), {0, 1, 0});
        hold("far from the origin");
    }
    print("views");
}

TEST_F(GlIdRendererTest, DropsTheBackFacesOfSingleSidedTrianglesOnly) {
    MadeList made;
    made.add({-3, -1, -4}, {-1, -1, -4}, {-2, 1, -4}, false);  // 0: front
    made.add({-1, -1, -4}, {0, 1, -4}, {1, -1, -4}, false);    // 1: back
    made.add({1, -1, -4}, {2, 1, -4}, {3, -1, -4}, true);      // 2: back, double-sided
    std::vector<DrawItem> items = made.items();
    View view = madeView(240, 120);
    const auto shows = [&](uint32_t surface) {
        const HiddenImage image = drawn(DrawList(items), view);
        return std::find(image.surface.begin(), image.surface.end(), surface) != image.surface.end();
    };
    // A mirror turns the winding in the image, but not what is front and what is back.
    for (const double side : {1.0, -1.0}) {
        items[0].transform[0].x = side;
        EXPECT_TRUE(shows(0)) << side;
        EXPECT_FALSE(shows(1)) << side;
        EXPECT_TRUE(shows(2)) << side;
    }
    // Seen from behind they change places.
    view.view = lookAt({0, 0, -8}, {0, 0, 0}, {0, 1, 0});
    EXPECT_FALSE(shows(0));
    EXPECT_TRUE(shows(1));
    EXPECT_TRUE(shows(2));
}

TEST_F(GlIdRendererTest, LeavesOutWhatWritesNoDepth) {
    MadeList made;
    made.add({-3, -3, -4}, {3, -3, -4}, {0, 3, -4});
    made.add({-3, -3, -5}, {3, -3, -5}, {0, 3, -5});
    std::vector<DrawItem> items = made.items();
    const std::vector<uint8_t> writes{0, 1};
    items[0].writes_depth = writes;
    HiddenImage image = drawn(DrawList(items), madeView());
    EXPECT_EQ(image.at(60, 80), 1u);
    EXPECT_EQ(image.at(119, 0), HiddenImage::kNone);
}

TEST_F(GlIdRendererTest, SeesWhatTheReferenceSeesInRealScenes) {
    const std::vector<std::filesystem::path> files = test::sharedFiles("scenes", ".glb");
    if (files.empty()) GTEST_SKIP() << "no scenes beside the repository";
    Agreement all, zbuffer_all;
    for (const std::filesystem::path& file : files) {
        const Result<Scene> scene = loadGltf(file.string());
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        if (drawnTriangles(*scene) > 150000) continue;
        int frame_number = 0;
        for (const CameraFrame& frame : seededCameras(*scene, std::getenv("SIGHTLINE_FULL") ? 64 : 4, 1).frames) {
            const std::string name = file.filename().string() + ", camera " + std::to_string(frame_number++);
            const View view = makeView(frame, 640, 360);
            const RenderList in_view(*scene, view);
            const Agreement result = compare(in_view.list(), view, name);
            EXPECT_LE(result.at_edges, result.samples / 1000) << name;
        }
        add(sum_, all);
        add(zbuffer_sum_, zbuffer_all);
        print(file.filename().c_str());
    }
    sum_ = all;
    zbuffer_sum_ = zbuffer_all;
    print("all scenes");
}

TEST(GlContext, TwoLiveAtOnceAndDrawTheSameWithAnyNumberOfThreads) {
    const MadeList made = clutter(7, 3000);
    const DrawList list = made.list();
    Result<GlContext> one = GlContext::create(0), two = GlContext::create(3);
    if (!one) GTEST_SKIP() << one.error().message;
    ASSERT_TRUE(two.ok()) << two.error().message;
    const Result<GlContext> three = GlContext::create(1);
    ASSERT_FALSE(three.ok());
    EXPECT_EQ(three.error().message.find('\n'), std::string::npos);
    std::vector<HiddenImage> images;
    for (const GlContext* context : {&*one, &*two, &*one}) {
        Result<GlIdRenderer> renderer = GlIdRenderer::create(*context, list);
        ASSERT_TRUE(renderer.ok()) << renderer.error().message;
        ASSERT_TRUE(renderer->draw(madeView(640, 480)).ok());
        images.push_back(*renderer->read());
    }
    EXPECT_EQ(images[0].surface, images[1].surface);
    EXPECT_EQ(images[0].surface, images[2].surface);
}

}  // namespace
}  // namespace sightline::test
