// Drawing by a BSP tree: both ways and all three kinds of free samples give the nearest surface everywhere.
// SPDX-License-Identifier: MIT
#include <cstdio>

#include <gtest/gtest.h>

#include "sightline/studies/hidden/bsp/bsp_render.h"
#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
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

/// The first image is held to the truth, the others to it: they are the same sample for sample.
void expectAllRight(const MadeList& made, const View& view) {
    const DrawList list = made.list();
    const HiddenImage truth = nearestSurfaces(list, view);
    std::vector<uint32_t> first;
    for (const Way& way : kWays) {
        const HiddenImage image = draw(list, view, way);
        const Agreement agreement = compareImages(list, view, truth, image);
        expectNoneWrong(agreement, made.name + ", " + way.name);
        if (first.empty()) first = image.surface;
        EXPECT_TRUE(first == image.surface) << made.name << ", " << way.name;
        EXPECT_EQ(covered(image), covered(truth)) << made.name << ", " << way.name;
        if (way.method == HiddenMethod::kBspFrontToBack) {
            EXPECT_EQ(image.counters.passed, covered(image)) << made.name << ", " << way.name;
        } else {
            std::printf("%-28s %6zu samples, at edges %zu, ties %zu, splits %zu\n", made.name.c_str(),
                        size_t(agreement.samples), size_t(agreement.at_edges), size_t(agreement.ties),
                        size_t(image.counters.splits));
        }
    }
}

TEST(BspMethods, ShowTheNearestSurfaceEverywhere) {
    for (const MadeList& made : madeLists()) expectAllRight(made, madeView());
}

TEST(BspMethods, SeeTheSameInParallel) {
    View view = madeView();
    view.projection = orthographic(4, 4.0 / 3, 0.1, 20);
    for (const MadeList& made : madeLists()) expectAllRight(made, view);
    // Off the centre, and from behind things.
    view.projection[3][0] = 0.3;
    view.view = lookAt({3, 2, -8}, {0, 0, -4}, {0, 1, 0});
    for (const MadeList& made : madeLists()) expectAllRight(made, view);
}

TEST(BspMethods, SeeRightlyFromAnywhere) {
    Random random(4);
    for (int i = 0; i < 12; ++i) {
        View view = madeView(97, 66, 0.01);
        view.view = lookAt({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-6, 0)},
                           {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-6, 0)}, {0, 1, 0});
        expectAllRight(clutter(20 + uint64_t(i), 300, 0.6), view);
        expectAllRight(interpenetration(20 + uint64_t(i)), view);
    }
}

TEST(BspMethods, StandAnyInput) {
    for (uint64_t seed = 1; seed <= 20; ++seed) {
        Random random(seed);
        MadeList made;
        made.name = "any input " + std::to_string(seed);
        for (int i = 0; i < 80; ++i) {
            glm::vec3 p[3];
            for (glm::vec3& v : p) v = {random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-5, 1)};
            const uint64_t kind = random.below(7);
            if (kind == 0) p[2] = p[1];
            if (kind == 1) p[1] = p[2] = p[0];
            if (kind == 2) p[2] = 0.5f * (p[0] + p[1]);
            if (kind == 3) p[0].z = p[1].z = p[2].z = -3;
            if (kind == 4)
                for (glm::vec3& v : p) v = glm::round(v);
            made.add(p[0], p[1], p[2], random.below(2));
            if (kind == 5) made.add(p[0], p[1], p[2]);
            if (kind == 6) made.add(p[2], p[1], p[0]);
        }
        expectAllRight(made, madeView(64, 48));
    }
}

TEST(BspMethods, CountWhatTheyDo) {
    const MadeList made = clutter(5, 3000, 1.0);
    const DrawList list = made.list();
    HiddenImage images[4];
    for (int i = 0; i < 4; ++i) {
        images[i] = draw(list, madeView(), kWays[i], true);
        const HiddenCounters& counters = images[i].counters;
        uint64_t generated = 0, passed = 0;
        for (const uint16_t count : images[i].generated) generated += count;
        for (size_t at = 0; at < images[i].passed.size(); ++at) {
            passed += images[i].passed[at];
            if (i > 0) { ASSERT_EQ(images[i].passed[at], images[i].surface[at] != HiddenImage::kNone); }
        }
        EXPECT_EQ(generated, counters.generated);
        EXPECT_EQ(passed, counters.passed);
        EXPECT_EQ(counters.shaded, counters.passed);
        EXPECT_EQ(counters.tested, i == 0 ? 0 : counters.generated);
        EXPECT_GT(counters.prepare_nanoseconds, 0u);
        EXPECT_GT(counters.splits, 0u);
    }
    // Back to front and naively front to back the same fragments are generated; a dynamic screen leaves out many.
    EXPECT_EQ(images[0].counters.generated, images[1].counters.generated);
    EXPECT_EQ(images[1].counters.skipped_subtrees, 0u);
    for (int i = 2; i < 4; ++i) {
        EXPECT_LT(images[i].counters.generated, images[1].counters.generated / 2);
        EXPECT_GT(images[i].counters.skipped_subtrees, 0u);
        EXPECT_LT(images[i].counters.nodes, images[1].counters.nodes);
    }
}

HiddenImage drawWith(const BspScene& scene, const DrawList& list, const View& view, const Way& way) {
    RenderSettings settings;
    settings.free_samples = way.free_samples;
    HiddenImage image = emptyImage(view);
    const HiddenInput input{list, view, settings};
    if (way.method == HiddenMethod::kBspBackToFront) drawBspBackToFront(scene, input, image);
    else drawBspFrontToBack(scene, input, image);
    return image;
}

TEST(BspMethods, DrawWhatIsInsertedLater) {
    const MadeList first = clutter(31, 200, 0.8), later = interpenetration(32, 40);
    std::vector<DrawItem> items{first.items()[0], later.items()[0]};
    const DrawList list(items);
    BspScene scene = buildBspScene(DrawList(std::span(items).first(1)));
    BspPolygons polygons;
    for (size_t t = 0; t < later.indices.size() / 3; ++t) {
        glm::dvec3 p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = glm::dvec3(later.positions[later.indices[3 * t + k]]);
        polygons.add(p, list.firstSurface(1) + uint32_t(t));
    }
    insertPolygons(scene.tree, polygons);
    const View view = madeView();
    const HiddenImage truth = nearestSurfaces(list, view);
    for (const Way& way : kWays) {
        const HiddenImage image = drawWith(scene, list, view, way);
        EXPECT_EQ(compareImages(list, view, truth, image).wrong, 0u) << way.name;
        EXPECT_TRUE(image.surface == draw(list, view, way).surface) << way.name;
    }
}

TEST(BspMethods, DrawMovingThingsAmongStaticOnes) {
    const MadeList still = clutter(41, 300, 0.8), ball = interpenetration(42, 12);
    std::vector<DrawItem> items{still.items()[0], ball.items()[0], ball.items()[0]};
    const DrawList list(items);
    const uint8_t moves[] = {0, 1, 1};
    BspScene scene = buildBspScene(list, moves);
    const size_t nodes = scene.tree.nodes.size();
    for (int frame = 0; frame < 8; ++frame) {
        // One turns in place, the other passes through; both go through the static ones and through each other.
        const double angle = 0.4 * frame;
        items[1].transform = {glm::dvec4(std::cos(angle), 0, -std::sin(angle), 0), glm::dvec4(0, 1, 0, 0),
                              glm::dvec4(std::sin(angle), 0, std::cos(angle), 0), glm::dvec4(0.5, 0, -1, 1)};
        items[2].transform = glm::dmat4(1.0);
        items[2].transform[3] = glm::dvec4(-2 + 0.5 * frame, 0.1, 0.3 * frame, 1);
        moveItems(scene, list);
        const View view = madeView();
        const HiddenImage truth = nearestSurfaces(list, view);
        uint64_t shown = 0;
        for (const uint32_t surface : truth.surface)
            shown += surface != HiddenImage::kNone && surface >= list.firstSurface(1);
        EXPECT_GT(shown, 100u);
        for (const Way& way : kWays) {
            const Agreement agreement = compareImages(list, view, truth, drawWith(scene, list, view, way));
            EXPECT_EQ(agreement.wrong, 0u) << "frame " << frame << ", " << way.name;
        }
    }
    EXPECT_EQ(scene.tree.nodes.size(), nodes);
}

}  // namespace
}  // namespace sightline::test
