// The tiled z-buffer: one image whatever is saved, whoever shares the work, whichever instructions do it.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"

#include <gtest/gtest.h>

#include "tests/studies/hidden/made_lists.h"
#include "tests/support/targets.h"

namespace sightline::test {
using namespace studies;
namespace {

View parallelView(uint32_t width, uint32_t height) {
    View view = madeView(width, height);
    view.projection = orthographic(4.0, double(width) / height, 0.5, 50.0);
    return view;
}

/// Relative differences in nearness that a format may take for a tie in these scenes, up to 8 units away.
AgreementBands bandsOf(const DrawList& list, const View& view, DepthFormat format) {
    const DepthCodec codec = depthCodecFor(list, view, format);
    AgreementBands bands;
    for (double distance = std::max(codec.range.near_plane, 0.1); distance < 8; distance *= 1.1)
        bands.tie = std::max(bands.tie, 2 * codec.stepAt(distance) / distance);
    return bands;
}

void expectSame(const HiddenImage& a, const HiddenImage& b, const std::string& what, bool counters = true) {
    ASSERT_EQ(a.surface.size(), b.surface.size()) << what;
    for (size_t i = 0; i < a.surface.size(); ++i)
        ASSERT_EQ(a.surface[i], b.surface[i]) << what << ": sample " << i % a.width << " of row " << i / a.width;
    if (!counters) return;
    EXPECT_EQ(a.counters.generated, b.counters.generated) << what;
    EXPECT_EQ(a.counters.tested, b.counters.tested) << what;
    EXPECT_EQ(a.counters.passed, b.counters.passed) << what;
    EXPECT_EQ(a.counters.shaded, b.counters.shaded) << what;
    EXPECT_EQ(a.counters.hierarchy_rejected_polygons, b.counters.hierarchy_rejected_polygons) << what;
    EXPECT_EQ(a.counters.hierarchy_rejected_tiles, b.counters.hierarchy_rejected_tiles) << what;
    EXPECT_EQ(a.counters.hierarchy_accepted_tiles, b.counters.hierarchy_accepted_tiles) << what;
    EXPECT_EQ(a.counters.depth_bytes_compressed, b.counters.depth_bytes_compressed) << what;
    EXPECT_EQ(a.counters.geometry.produced, b.counters.geometry.produced) << what;
    EXPECT_EQ(a.counters.geometry.rejected, b.counters.geometry.rejected) << what;
}

TEST(ZBufferMethod, ShowsTheNearestSurface) {
    for (const MadeList& made : madeLists()) {
        const DrawList list = made.list();
        for (const View& view : {madeView(160, 120), madeView(173, 61), madeView(7, 5), parallelView(131, 97)}) {
            RenderSettings settings;
            expectNearest(list, view, settings, made.name + ", width " + std::to_string(view.width),
                          bandsOf(list, view, settings.depth.format));
        }
    }
}

TEST(ZBufferMethod, ShowsTheNearestSurfaceInEveryFormat) {
    for (int format = 0; format < kDepthFormats; ++format)
        for (const MadeList& made : {cyclicOverlap(), interpenetration(7), clutter(7, 300), throughTheEye(7)}) {
            const DrawList list = made.list();
            for (const View& view : {madeView(90, 75), parallelView(77, 70)}) {
                RenderSettings settings;
                settings.depth.format = static_cast<DepthFormat>(format);
                expectNearest(list, view, settings, std::string(kDepthFormatNames[format]) + " " + made.name,
                              bandsOf(list, view, settings.depth.format));
            }
        }
}

TEST(ZBufferMethod, CoversExactlyTheSamplesOfScanPolygon) {
    // Always passing, so that the image is the last polygon's; every fragment counts.
    for (uint64_t seed = 1; seed <= 6; ++seed) {
        MadeList made = clutter(seed, 500, 0.3);
        for (glm::vec3& p : made.positions) p = glm::round(p * 16.0f) / 16.0f;  // many corners and edges on samples
        const DrawList list = made.list();
        View view = madeView(64, 64);
        view.projection = orthographic(4.0, 1.0, 0.5, 50.0);
        Projector projector(view, {view.width, view.height, 0, 1, {}});
        HiddenImage truth;
        truth.surface.assign(64 * 64, HiddenImage::kNone);
        for (const ScreenPolygon& polygon : projectAll(list, projector))
            scanPolygon(polygon.outline(), 0, 64, 64, [&](int32_t row, int32_t begin, int32_t end) {
                truth.counters.generated += static_cast<uint64_t>(end - begin);
                std::fill(truth.surface.begin() + row * 64 + begin, truth.surface.begin() + row * 64 + end,
                          polygon.surface);
            });
        RenderSettings settings;
        settings.depth.comparison = DepthComparison::kAlways;
        const HiddenImage image = render(list, view, settings);
        EXPECT_EQ(image.surface, truth.surface) << made.name;
        EXPECT_EQ(image.counters.generated, truth.counters.generated) << made.name;
    }
}

TEST(ZBufferMethod, IsTheSameForAnyThreadsAndInstructions) {
    for (const MadeList& made : {clutter(11, 3000, 0.3), interpenetration(5, 200), throughTheEye(3)})
        for (const View& view : {madeView(203, 117), parallelView(90, 121)})
            for (const DepthFormat format : {DepthFormat::kReversedFloat, DepthFormat::kUnorm24, DepthFormat::kW,
                                             DepthFormat::kIntegerShifted, DepthFormat::kLinear}) {
                const DrawList list = made.list();
                RenderSettings settings;
                settings.depth.format = format;
                settings.depth.compression = format == DepthFormat::kUnorm24;
                const HiddenImage one = render(list, view, settings);
                for (settings.threads = 2; settings.threads <= 4; ++settings.threads)
                    expectSame(one, render(list, view, settings), std::to_string(settings.threads) + " threads");
                settings.threads = 2;
                EXPECT_GE(forEachTarget([&](const std::string& target) {
                              expectSame(one, render(list, view, settings), target);
                          }),
                          2);
            }
}

TEST(ZBufferMethod, IsTheSameWhateverItSaves) {
    for (uint64_t seed = 1; seed <= 12; ++seed) {
        const MadeList made = seed % 2 != 0 ? clutter(seed, 1500, 0.5) : interpenetration(seed, 150);
        const DrawList list = made.list();
        const View view = seed % 3 != 0 ? madeView(121, 90) : parallelView(99, 80);
        RenderSettings settings;
        settings.depth.format = static_cast<DepthFormat>(seed % kDepthFormats);
        settings.depth.hierarchy = false;
        settings.depth.fast_clear = false;
        const HiddenImage plain = render(list, view, settings);
        EXPECT_EQ(plain.counters.tested, plain.counters.generated);
        for (int options = 1; options < 16; ++options) {
            settings.depth.hierarchy = (options & 1) != 0;
            settings.depth.fast_clear = (options & 2) != 0;
            settings.depth.compression = (options & 4) != 0;
            settings.want_counts = (options & 8) != 0;
            const HiddenImage image = render(list, view, settings);
            expectSame(plain, image, "seed " + std::to_string(seed) + " options " + std::to_string(options), false);
            EXPECT_EQ(plain.counters.passed, image.counters.passed) << "seed " << seed << " options " << options;
            if (settings.want_counts) { EXPECT_EQ(plain.counters.generated, image.counters.generated); }
            if (settings.depth.hierarchy) { EXPECT_LT(image.counters.tested, plain.counters.tested); }
            if (settings.depth.compression) {
                EXPECT_LT(image.counters.depth_bytes_compressed, image.counters.depth_bytes);
            }
        }
    }
}

TEST(ZBufferMethod, TestsAndShadesLessNearToFar) {
    MadeList walls[6];
    std::vector<DrawItem> items;
    for (int i = 0; i < 6; ++i) {  // far to near in the list
        const float z = -20.0f + 2.5f * static_cast<float>(i);
        walls[i].add({z, z, z}, {-z, z, z - 0.1f}, {0, -2 * z, z});
        items.push_back(walls[i].items()[0]);
    }
    const DrawList list(items);
    RenderSettings settings;
    settings.want_counts = true;
    const HiddenImage far_to_near = render(list, madeView(), settings);
    settings.depth.near_to_far = true;
    const HiddenImage near_to_far = render(list, madeView(), settings);
    expectSame(far_to_near, near_to_far, "near to far", false);
    EXPECT_EQ(far_to_near.counters.generated, near_to_far.counters.generated);
    EXPECT_EQ(far_to_near.counters.shaded, far_to_near.counters.generated);
    EXPECT_EQ(near_to_far.counters.passed, covered(near_to_far));
    EXPECT_EQ(near_to_far.counters.shaded, covered(near_to_far));
    EXPECT_LT(2 * near_to_far.counters.tested, far_to_near.counters.generated);
}

TEST(ZBufferMethod, CountsPerSampleAddUp) {
    const MadeList made = clutter(21, 800, 0.6);
    const DrawList list = made.list();
    const View view = madeView(97, 83);
    for (const ShaderKind kind :
         {ShaderKind::kPlain, ShaderKind::kDiscards, ShaderKind::kWritesDepth, ShaderKind::kWritesFarther})
        for (const bool early : {false, true}) {
            RenderSettings settings;
            settings.want_counts = true;
            settings.depth.early_test = early;
            settings.depth.shader.kind = kind;
            settings.depth.shader.keeps = [](uint32_t surface, int32_t row, int32_t sample) {
                return ((surface + uint32_t(row) + uint32_t(sample)) & 1) == 0;
            };
            const HiddenImage image = render(list, view, settings);
            const auto sum = [](const std::vector<uint16_t>& counts) {
                uint64_t total = 0;
                for (const uint16_t count : counts) total += count;
                return total;
            };
            EXPECT_EQ(sum(image.generated), image.counters.generated);
            EXPECT_EQ(sum(image.tested), image.counters.tested);
            EXPECT_EQ(sum(image.passed), image.counters.passed);
            EXPECT_EQ(sum(image.shaded), image.counters.shaded);
            EXPECT_GT(image.counters.passed, 0u);
        }
}

TEST(ZBufferMethod, LeavesOutItemsThatNobodyCouldSee) {
    // Items all around the eye: those that are left out as a whole change nothing.
    MadeList made = clutter(2, 40, 0.5);
    Random random(9);
    std::vector<DrawItem> items;
    for (int i = 0; i < 400; ++i) {
        DrawItem item = made.items()[0];
        item.transform = glm::dmat4(1.0);
        item.transform[3] = glm::dvec4(random.uniform(-60, 60), random.uniform(-60, 60), random.uniform(-60, 60), 1.0);
        items.push_back(item);
    }
    const DrawList list(items);
    for (const View& view : {madeView(120, 90), parallelView(120, 90)}) {
        AgreementBands bands;
        bands.tie = isOrthographic(view) ? 1e-5 : 1e-6;
        const ProjectorCounters g = expectNearest(list, view, {}, "many items", bands).counters.geometry;
        EXPECT_EQ(g.triangles, g.rejected + g.back_facing + g.accepted + g.clipped);
        EXPECT_EQ(g.triangles, list.surfaces());
    }
}

}  // namespace
}  // namespace sightline::test
