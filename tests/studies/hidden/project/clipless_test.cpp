// The choice of clipping changes no image: at six planes, at a guard band of any width, and not at all.
// SPDX-License-Identifier: MIT
#include <numeric>

#include "tests/studies/hidden/agreement.h"

namespace sightline::test {
using namespace studies;
namespace {

TEST(Clipless, AgreesWithTheTruth) {
    RenderSettings settings;
    settings.method = HiddenMethod::kZBuffer;
    settings.projector.clipping = Clipping::kClipless;
    AgreementBands bands;
    bands.tie = 0x1p-22;  // depths are kept in float
    expectAgreement("clipless", settings, bands);
    expectEmptyImages(settings);
}

TEST(Clipless, CountsWhatItDoes) {
    RenderSettings settings;
    settings.method = HiddenMethod::kZBuffer;
    settings.projector.clipping = Clipping::kClipless;
    settings.want_counts = true;
    settings.depth.hierarchy = false;
    const MadeList made = throughTheEye(7, 40);
    const HiddenImage image = render(made.list(), madeView(), settings);
    const auto sum = [](const std::vector<uint16_t>& counts) {
        return std::accumulate(counts.begin(), counts.end(), uint64_t{0});
    };
    EXPECT_GT(image.counters.generated, image.counters.passed);
    EXPECT_EQ(image.counters.generated, image.counters.tested);
    EXPECT_EQ(sum(image.generated), image.counters.generated);
    EXPECT_EQ(sum(image.passed), image.counters.passed);
    EXPECT_EQ(sum(image.shaded), image.counters.shaded);
    EXPECT_EQ(image.counters.geometry.clipped, 0u);
    EXPECT_GT(image.counters.geometry.spared, 0u);
}

TEST(Clipping, AtSixPlanesChangesNoImage) {
    RenderSettings settings;
    settings.method = HiddenMethod::kWarnock;
    settings.projector.clipping = Clipping::kFrustum;
    expectAgreement("six planes", settings);
}

TEST(Clipping, AtAnyGuardBandChangesNoImage) {
    RenderSettings settings;
    settings.method = HiddenMethod::kWarnock;
    for (const double width : {1.5, 1e6}) {
        settings.projector.guard_band = width;
        expectAgreement(width > 2 ? "a wide guard band" : "a narrow guard band", settings);
    }
}

TEST(Clipping, CountersOfAllChoicesAddUp) {
    for (const MadeList& made : madeLists()) {
        const DrawList list = made.list();
        for (const NamedView& named : madeViews()) {
            std::vector<ProjectorSettings> choices(4);
            choices[1].clipping = Clipping::kFrustum;
            choices[2].guard_band = 1.5;
            choices[3].guard_band = 1e6;
            std::vector<ProjectorCounters> counters;
            for (const ProjectorSettings& choice : choices) {
                Projector projector(named.view, {named.view.width, named.view.height, 0, 1, {}}, choice);
                projectAll(list, projector);
                const ProjectorCounters& c = counters.emplace_back(projector.counters());
                EXPECT_EQ(c.triangles, c.rejected + c.back_facing + c.accepted + c.clipped) << made.name;
                EXPECT_LE(c.produced, c.accepted + c.clipped) << made.name;
                EXPECT_EQ(c.back_facing, counters[0].back_facing) << made.name << ", " << named.name;
            }
            EXPECT_EQ(counters[1].spared, 0u);
            EXPECT_LE(counters[0].clipped, counters[2].clipped) << made.name << ", " << named.name;
            EXPECT_LE(counters[3].clipped, counters[0].clipped) << made.name << ", " << named.name;
        }
    }
}

}  // namespace
}  // namespace sightline::test
