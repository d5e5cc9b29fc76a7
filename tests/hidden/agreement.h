// The law of all exact methods: their images are those of the slow truth, on every made list, view and image size.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>

#include <gtest/gtest.h>

#include "sightline/hidden/compare.h"
#include "tests/hidden/made_lists.h"

namespace sightline::test {

struct NamedView {
    std::string name;
    View view;
};

/// Perspective with an infinite and a finite far plane, orthographic, and odd sizes.
inline std::vector<NamedView> madeViews() {
    std::vector<NamedView> views;
    views.push_back({"perspective", madeView()});
    View view = madeView(333, 3);
    view.projection = perspective(1.2, 333.0 / 3, 0.05, 5.0);
    views.push_back({"perspective to 5, 333x3", view});
    view = madeView();
    view.projection = orthographic(4, 4.0 / 3, 0.1, 100);
    views.push_back({"orthographic", view});
    view = madeView(7, 5);
    view.projection = orthographic(3, 7.0 / 5, -2, 6);
    view.view = lookAt({0.3, -0.2, 1}, {-1, 0.5, -6}, {0.1, 1, 0});
    views.push_back({"orthographic, turned, 7x5", view});
    view = madeView(1, 1);
    views.push_back({"perspective, 1x1", view});
    view = madeView(97, 61);
    view.view = lookAt({1, 0.7, -0.5}, {-0.5, -0.3, -5}, {0, 1, 0.3});
    views.push_back({"perspective, turned, 97x61", view});
    return views;
}

/// Holds a method to the truth on all made lists and views; prints how many samples differ, and why that is no fault.
inline void expectAgreement(const char* what, const RenderSettings& settings, const AgreementBands& bands = {}) {
    Agreement all;
    for (const MadeList& made : madeLists()) {
        const std::vector<DrawItem> items = made.items();
        const DrawList list(items);
        for (const NamedView& named : madeViews()) {
            const HiddenImage truth = nearestSurfaces(list, named.view), found = render(list, named.view, settings);
            const Agreement agreement = compareImages(list, named.view, truth, found, bands);
            EXPECT_TRUE(agreement.agrees())
                << what << ", " << made.name << ", " << named.name << ": " << agreement.wrong << " samples, first row "
                << agreement.row << " sample " << agreement.sample << ": " << int32_t(agreement.found) << " for "
                << int32_t(agreement.expected);
            all.samples += agreement.samples;
            all.differing += agreement.differing;
            all.at_edges += agreement.at_edges;
            all.ties += agreement.ties;
        }
    }
    std::printf("%s: of %llu samples %llu differ, %llu of them at edges, %llu ties\n", what,
                static_cast<unsigned long long>(all.samples), static_cast<unsigned long long>(all.differing),
                static_cast<unsigned long long>(all.at_edges), static_cast<unsigned long long>(all.ties));
}

/// Nothing to draw: an empty list, one without triangles, and a scene behind the eye.
inline void expectEmptyImages(const RenderSettings& settings) {
    const auto expectEmpty = [&](const std::vector<DrawItem>& items) {
        const HiddenImage image = render(DrawList(items), madeView(9, 4), settings);
        EXPECT_EQ(image.surface, std::vector<uint32_t>(36, HiddenImage::kNone));
    };
    expectEmpty({});
    expectEmpty({DrawItem{}});
    MadeList made;
    made.add({-1, -1, 3}, {1, -1, 3}, {0, 1, 3});
    expectEmpty(made.items());
}

}  // namespace sightline::test
