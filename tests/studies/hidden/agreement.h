// The law of all exact methods: their images are those of the slow truth, on every made list, view and image size.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdio>

#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;

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

/// Lists that are hard on orders and on rounding: corners on a coarse grid, so that faces coincide, share edges and end
/// on samples; planes that are one plane but for float's rounding, or nearly; floors seen almost edge-on; needles; huge
/// triangles through the near plane; fans around a vertex with doubles.
inline MadeList hardList(uint64_t seed) {
    MadeList made;
    made.name = "hard list " + std::to_string(seed);
    Random random(seed);
    const auto uniform = [&](double x, double y, double near, double far) {
        return glm::dvec3(random.uniform(-x, x), random.uniform(-y, y), random.uniform(far, near));
    };
    const int kind = static_cast<int>(seed % 7), count = 5 + static_cast<int>(random.below(60));
    const double offset = std::pow(10.0, random.uniform(-9, -4));
    for (int i = 0; i < count; ++i) {
        glm::dvec3 p[3];
        const double tilt = static_cast<double>(random.below(3)) - 1, level = random.uniform(-1e-3, 0.5);
        const double scale = std::pow(10.0, random.uniform(-2, 4)),
                     angle = 0.5235987755982988 * double(random.below(12));
        for (glm::dvec3& v : p) {
            v = uniform(3, 2, -2, -6);
            if (kind == 0) v = 0.5 * glm::round(2.0 * v);
            if (kind == 1) v.z = -4.3 + 0.3 * tilt + 0.31 * tilt * v.x + 0.17 * v.y;
            if (kind == 2) v.z = -4 + offset * random.uniform(-1, 1);
            if (kind == 3) v = {v.x, level * (1 + 1e-3 * random.uniform()), random.uniform(-30, 1)};
            if (kind == 5) v = scale * uniform(1, 1, 0.3, -1);
        }
        if (kind == 4) p[2] = p[0] + 1e-4 * random.uniform() * (p[1] - p[0]) + offset * uniform(1, 1, 1, -1);
        if (kind == 6) {
            p[0] = {0, 0, -3};
            p[1] = {2 * std::cos(angle), 2 * std::sin(angle), -3 - 0.5 * double(random.below(3))};
            p[2] = {2 * std::cos(angle + 0.5236), 2 * std::sin(angle + 0.5236), -3 - 0.5 * double(random.below(3))};
        }
        const bool both = random.below(4) != 0;
        for (uint64_t copies = random.below(20) == 0 ? 2 : 1; copies > 0; --copies)
            made.add(glm::vec3(p[0]), glm::vec3(p[1]), glm::vec3(p[2]), both);
    }
    return made;
}

/// Holds a method to the truth on all made lists and all views, and on hard lists unless told otherwise; prints how many samples differ, and why that is no fault.
inline void expectAgreement(const char* what, const RenderSettings& settings, const AgreementBands& bands = {},
                            bool hard = true) {
    Agreement all;
    std::vector<MadeList> lists = madeLists();
    for (uint64_t seed = 1; hard && seed <= 140; ++seed) lists.push_back(hardList(seed));
    for (const MadeList& made : lists) {
        const DrawList list = made.list();
        for (const NamedView& named : madeViews()) {
            const HiddenImage truth = nearestSurfaces(list, named.view), found = render(list, named.view, settings);
            const Agreement agreement = compareImages(list, named.view, truth, found, bands);
            expectNoneWrong(agreement, what + (", " + made.name + ", " + named.name));
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
