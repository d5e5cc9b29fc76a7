// The picture that is timed shows the same surfaces as the id-buffer that is checked, in their colours.
// SPDX-License-Identifier: MIT
#include "apps/gl/renderers.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
namespace {

/// Red and green tell surfaces apart by their ratio, which light does not change.
std::vector<uint32_t> tellingColours(uint32_t surfaces) {
    std::vector<uint32_t> colours;
    for (uint32_t i = 0; i < surfaces; ++i) {
        const uint32_t mixed = (i + 1) * 2654435761u;
        colours.push_back(0xff000000u | 0xff0000u | (mixed >> 24) << 8 | (mixed >> 16 & 0xffu));
    }
    return colours;
}

/// Pixels whose picture is not the colour, under some light, of the surface that the id-buffer shows.
size_t countOdd(const HiddenImage& ids, const std::vector<uint32_t>& picture, const std::vector<uint32_t>& colours) {
    size_t odd = 0;
    for (size_t i = 0; i < picture.size(); ++i) {
        if (ids.surface[i] == HiddenImage::kNone) {
            odd += picture[i] != 0;
            continue;
        }
        const uint32_t base = colours[ids.surface[i]], seen = picture[i];
        const double light = (seen >> 16 & 0xff) / 255.0;
        bool fits = light >= 0.34 && light <= 1.0 && seen >> 24 == 0xff;
        for (const int shift : {0, 8})
            fits = fits && std::abs(light * (base >> shift & 0xff) - (seen >> shift & 0xff)) <= 1.6;
        odd += !fits;
    }
    return odd;
}

TEST(GlFlatRenderer, ShowsTheSurfacesOfTheIdBufferInTheirColours) {
    const Result<GlContext> context = GlContext::create(2);
    if (!context) GTEST_SKIP() << context.error().message;
    for (uint64_t seed = 1; seed <= 4; ++seed) {
        // Four copies of a list, one of them mirrored.
        const MadeList made = clutter(seed, 500, 0.5);
        std::vector<DrawItem> items;
        for (int i = 0; i < 4; ++i) {
            items.push_back(made.items()[0]);
            items.back().transform[0].x = i == 2 ? -1 : 1;
            items.back().transform[3] = glm::dvec4(i - 1.5, 0.3 * i, 0, 1);
        }
        const DrawList list(items);
        const std::vector<uint32_t> colours = tellingColours(list.surfaces());
        Result<GlFlatRenderer> flat = GlFlatRenderer::create(*context, list, colours);
        Result<GlIdRenderer> ids = GlIdRenderer::create(*context, list);
        ASSERT_TRUE(flat.ok()) << flat.error().message;
        ASSERT_TRUE(ids.ok()) << ids.error().message;
        for (const bool parallel : {false, true}) {
            View view = madeView(320, 240);
            if (parallel) view.projection = orthographic(6, 4.0 / 3, 0.1, std::numeric_limits<double>::infinity());
            ASSERT_TRUE(flat->draw(view).ok());
            ASSERT_TRUE(ids->draw(view).ok());
            const HiddenImage image = *ids->read();
            const size_t odd = countOdd(image, *flat->read(), colours);
            EXPECT_LE(odd, image.surface.size() / 500) << "seed " << seed << (parallel ? ", parallel" : "");
            EXPECT_GT(size_t(std::count_if(image.surface.begin(), image.surface.end(),
                                           [](uint32_t surface) { return surface != HiddenImage::kNone; })),
                      image.surface.size() / 4);
        }
    }
}

TEST(GlFlatRenderer, DrawsNothingOfAnEmptyListAndSaysWhenAnImageIsTooLarge) {
    const Result<GlContext> context = GlContext::create(1);
    if (!context) GTEST_SKIP() << context.error().message;
    const DrawList list(std::span<const DrawItem>{});
    Result<GlFlatRenderer> flat = GlFlatRenderer::create(*context, list);
    ASSERT_TRUE(flat.ok()) << flat.error().message;
    ASSERT_TRUE(flat->draw(madeView(64, 64)).ok());
    const Result<std::vector<uint32_t>> picture = flat->read();
    ASSERT_TRUE(picture.ok()) << picture.error().message;
    EXPECT_EQ(*picture, std::vector<uint32_t>(64 * 64, 0u));
    EXPECT_FALSE(flat->draw(madeView(1u << 20, 8)).ok());
}

}  // namespace
}  // namespace sightline::test
