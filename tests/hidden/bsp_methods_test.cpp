// Drawing by a BSP tree: both ways and all three kinds of free samples give the nearest surface everywhere.
// SPDX-License-Identifier: MIT
#include <cstdio>

#include <gtest/gtest.h>

#include "sightline/hidden/bsp_back_to_front.h"
#include "sightline/hidden/bsp_front_to_back.h"
#include "sightline/hidden/compare.h"
#include "tests/hidden/made_lists.h"

namespace sightline::test {
namespace {

struct Way {
    const char* name;
    HiddenMethod method;
    FreeSamples free_samples;
};
constexpr Way kWays[] = {{"back to front", HiddenMethod::kBspBackToFront, FreeSamples::kBits},
                         {"front to back, check", HiddenMethod::kBspFrontToBack, FreeSamples::kCheck},
                         {"front to back, segments", HiddenMethod::kBspFrontToBack, FreeSamples::kSegments},
                         {"front to back, bits", HiddenMethod::kBspFrontToBack, FreeSamples::kBits}};

HiddenImage draw(const DrawList& list, const View& view, const Way& way, bool want_counts = false) {
    RenderSettings settings;
    settings.method = way.method;
    settings.free_samples = way.free_samples;
    settings.want_counts = want_counts;
    return render(list, view, settings);
}

uint64_t covered(const HiddenImage& image) {
    uint64_t sum = 0;
    for (const uint32_t surface : image.surface) sum += surface != HiddenImage::kNone;
    return sum;
}

/// The first image is held to the truth, the others to it: they are the same sample for sample.
void expectAllRight(const MadeList& made, const View& view, bool print = true) {
    const std::vector<DrawItem> items = made.items();
    const DrawList list(items);
    const HiddenImage truth = nearestSurfaces(list, view);
    std::vector<uint32_t> first;
    for (const Way& way : kWays) {
        const HiddenImage image = draw(list, view, way);
        const Agreement agreement = compareImages(list, view, truth, image);
        EXPECT_EQ(agreement.wrong, 0u) << made.name << ", " << way.name << ": row " << agreement.row << ", sample "
                                       << agreement.sample << " shows " << agreement.found << ", expected "
                                       << agreement.expected;
        if (first.empty()) first = image.surface;
        EXPECT_TRUE(first == image.surface) << made.name << ", " << way.name;
        EXPECT_EQ(covered(image), covered(truth)) << made.name << ", " << way.name;
        if (way.method == HiddenMethod::kBspFrontToBack) {
            EXPECT_EQ(image.counters.passed, covered(image)) << made.name << ", " << way.name;
        } else if (print) {
            std::printf("%-28s %6zu samples, at edges %zu, ties %zu, splits %zu\n", made.name.c_str(),
                        size_t(agreement.samples), size_t(agreement.at_edges), size_t(agreement.ties),
                        size_t(image.counters.splits));
        }
    }
}

TEST(BspMethods, ShowTheNearestSurfaceEverywhere) {
    for (const MadeList& made : madeLists()) expectAllRight(made, madeView());
}

}  // namespace
}  // namespace sightline::test
