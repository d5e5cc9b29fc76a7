// Ray casting: the truth's image but for edges, by our own hierarchy and by Embree.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/rays/raycast.h"

#include <gtest/gtest.h>
#include <pthread.h>

#include "sightline/studies/hidden/rays/raycast_tree.h"
#include "tests/studies/hidden/agreement.h"

namespace sightline::test {
using namespace studies;
namespace {

AgreementBands bandsOf(double edge, double tie) {
    AgreementBands bands;
    bands.edge = edge;
    bands.tie = tie;
    return bands;
}

RenderSettings rays(RayTracer tracer = RayTracer::kBvh) {
    RenderSettings settings;
    settings.method = HiddenMethod::kRaycast;
    settings.ray_tracer = tracer;
    return settings;
}

TEST(Raycast, ShowsWhatIsNearest) { expectAgreement("rays, own hierarchy", rays()); }

TEST(Raycast, ShowsWhatIsNearestByEmbree) {
    if (!hasEmbree()) GTEST_SKIP() << "built without Embree";
    // Its positions and rays are in float: too coarse for the hard lists.
    expectAgreement("rays, Embree", rays(RayTracer::kEmbree), bandsOf(1e-3, 1e-5), false);
}

TEST(Raycast, DrawsNothingWhereThereIsNothing) {
    for (const RayTracer tracer : {RayTracer::kBvh, RayTracer::kEmbree}) expectEmptyImages(rays(tracer));
}

TEST(Raycast, FindsWhatTryingAllTrianglesFinds) {
    const MadeList made = clutter(9, 3000, 0.3);
    const RayTriangles triangles = rayTriangles(made.list());
    const RayTree tree(triangles);
    std::vector<RayVisit> stack;
    for (const NamedView& named : madeViews()) {
        const SampleRays all(named.view);
        for (uint32_t row = 0; row < named.view.height; row += 2)
            for (uint32_t i = 0; i < named.view.width; i += 3) {
                SampleRay ray = all.at(row, i);
                ray.t_near = std::max(ray.t_near, -100.0);
                ray.t_far = std::min(ray.t_far, 100.0);
                RayHit expected{.t = ray.t_far};
                for (const RayTriangle& triangle : triangles.triangles) {
                    double t;
                    if (meets(triangle, ray.origin + (all.eye() - triangles.origin), ray.direction, all.depthAxis(),
                              t) &&
                        t >= ray.t_near && t < expected.t)
                        expected = {t, triangle.surface};
                }
                const RayHit found = tree.nearest(all, ray, stack);
                ASSERT_EQ(found.surface, expected.surface) << named.name << " row " << row << " sample " << i;
                ASSERT_EQ(found.t, expected.t);
            }
    }
}

TEST(Raycast, MissesNothingOnSharedEdges) {
    // Samples exactly on the edges and corners of a grid of squares.
    MadeList made;
    for (int i = -9; i < 9; ++i)
        for (int j = -9; j < 9; ++j) {
            const float x = static_cast<float>(i), y = static_cast<float>(j);
            made.add({x, y, -2}, {x + 1, y, -2}, {x + 1, y + 1, -2});
            made.add({x, y, -2}, {x + 1, y + 1, -2}, {x, y + 1, -2});
        }
    View view = madeView(65, 65);
    view.projection = orthographic(16.25, 1, 0.1, 100);  // four samples a square, one at the origin
    for (const RayTracer tracer : {RayTracer::kBvh, RayTracer::kEmbree}) {
        const HiddenImage image = render(made.list(), view, rays(tracer));
        for (size_t i = 0; i < image.surface.size(); ++i) ASSERT_NE(image.surface[i], HiddenImage::kNone) << i;
    }
}

TEST(Raycast, PassesThroughBackFacesAsTheProjectorDoes) {
    MadeList made;
    made.add({-1, -1, -2}, {0, 1, -2}, {1, -1, -2}, false);  // clockwise: a back face
    made.add({-1, -1, -3}, {1, -1, -3}, {0, 1, -3}, false);
    std::vector<DrawItem> items = made.items();
    const glm::dmat4 mirror(-1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1);
    for (const bool mirrored : {false, true}) {
        items[0].transform = mirrored ? mirror : glm::dmat4(1.0);
        for (const FrontFace front : {FrontFace::kCounterClockwise, FrontFace::kClockwise}) {
            RenderSettings settings = rays();
            settings.projector.front_face = front;
            const uint32_t seen = render(DrawList(items), madeView(), settings).surface[60 * 160 + 80];
            EXPECT_EQ(seen, front == FrontFace::kCounterClockwise ? 1u : 0u) << mirrored;
        }
    }
    RenderSettings both = rays();
    both.projector.cull_back_faces = false;
    EXPECT_EQ(render(DrawList(items), madeView(), both).surface[60 * 160 + 80], 0u);
}

TEST(Raycast, SeesFarFromTheWorldsOrigin) {
    const glm::dvec3 away(4e6, -1e6, 2e6);
    const MadeList made = clutter(4, 300);
    std::vector<DrawItem> items = made.items();
    items[0].transform[3] = glm::dvec4(away, 1.0);
    View view = madeView();
    view.view = lookAt(away, away + glm::dvec3(0, 0, -1), {0, 1, 0});
    const DrawList list(items);
    expectNearest(list, view, rays(), "far", bandsOf(1e-5, 1e-8));
}

TEST(Raycast, SeesBesideATriangleAtTheEndOfTheWorld) {
    for (const float far : {1e15f, 1e31f, 3e38f}) {
        MadeList made = clutter(4, 300);
        made.add({far, far, -far}, {far, 0.5f * far, -far}, {0.7f * far, far, 0.3f * far});
        const DrawList list = made.list();
        for (const NamedView& named : madeViews())
            expectNearest(list, named.view, rays(), std::to_string(far) + " " + named.name, bandsOf(1e-5, 1e-8));
    }
}

TEST(Raycast, SeesTheFrontsThatTheProjectorDoesWhicheverWayDepthRuns) {
    const MadeList made = clutter(7, 300);
    std::vector<DrawItem> items = made.items();
    for (DrawItem& item : items) item.double_sided = {};
    const DrawList list(items);
    for (const NamedView& named : madeViews()) {
        View view = named.view;
        for (const bool mirrored : {false, true}) {
            if (mirrored)
                for (int column = 0; column < 4; ++column) view.projection[column][0] *= -1;
            View reversed = view;
            for (int column = 0; column < 4; ++column) reversed.projection[column][2] *= -1;
            EXPECT_EQ(nearestSurfaces(list, reversed).surface, nearestSurfaces(list, view).surface) << named.name;
            for (const View& either : {view, reversed})
                expectNearest(list, either, rays(), named.name, bandsOf(1e-5, 1e-8));
        }
    }
}

TEST(Raycast, ShowsTheSameForAnyNumberOfThreads) {
    const MadeList made = clutter(6, 500);
    for (const RayTracer tracer : {RayTracer::kBvh, RayTracer::kEmbree}) {
        RenderSettings settings = rays(tracer);
        settings.want_counts = true;
        const HiddenImage one = render(made.list(), madeView(), settings);
        for (const uint32_t threads : {0u, 2u, 5u, 1000u}) {
            settings.threads = threads;
            const HiddenImage many = render(made.list(), madeView(), settings);
            EXPECT_EQ(many.surface, one.surface) << threads;
            EXPECT_EQ(many.shaded, one.shaded) << threads;
            EXPECT_EQ(many.counters.passed, one.counters.passed) << threads;
            EXPECT_EQ(many.counters.rays, one.counters.rays) << threads;
        }
    }
}

TEST(Render, FrontsAndBackFacesAreThoseAskedForByEveryExactMethod) {
    MadeList made = clutter(8, 200);
    std::vector<DrawItem> items = made.items();
    for (DrawItem& item : items) item.double_sided = {};
    const DrawList list(items);
    for (const FrontFace front : {FrontFace::kCounterClockwise, FrontFace::kClockwise})
        for (const bool drop : {false, true}) {
            RenderSettings settings = rays();
            settings.projector.front_face = front;
            settings.projector.cull_back_faces = drop;
            AgreementBands bands = bandsOf(1e-5, 0x1p-22);
            bands.projector = settings.projector;
            const HiddenImage truth = render(list, madeView(), settings);
            for (int method = 1; method < kHiddenMethods; ++method) {
                settings.method = static_cast<HiddenMethod>(method);
                const HiddenImage image = render(list, madeView(), settings);
                EXPECT_EQ(compareImages(list, madeView(), truth, image, bands).wrong, 0u) << method << drop;
            }
        }
}

TEST(Threads, AreFewerWhereTheSystemGivesNoMore) {
    const MadeList made = clutter(6, 500);
    pthread_attr_t usual, greedy;
    ASSERT_EQ(pthread_getattr_default_np(&usual), 0);
    ASSERT_EQ(pthread_attr_init(&greedy), 0);
    ASSERT_EQ(pthread_attr_setstacksize(&greedy, size_t{90} << 40), 0);  // there is room for one at most
    for (const HiddenMethod method : {HiddenMethod::kZBuffer, HiddenMethod::kRaycast}) {
        RenderSettings settings;
        settings.method = method;
        const HiddenImage one = render(made.list(), madeView(), settings);
        settings.threads = 8;
        ASSERT_EQ(pthread_setattr_default_np(&greedy), 0);
        const HiddenImage few = render(made.list(), madeView(), settings);
        ASSERT_EQ(pthread_setattr_default_np(&usual), 0);
        EXPECT_EQ(few.surface, one.surface) << static_cast<int>(method);
    }
    pthread_attr_destroy(&greedy);
    pthread_attr_destroy(&usual);
}

TEST(Raycast, CastsARayASample) {
    const MadeList made = cyclicOverlap();
    const HiddenImage image = render(made.list(), madeView(), rays());
    EXPECT_EQ(image.counters.rays, 160u * 120u);
    EXPECT_EQ(image.counters.shaded, image.counters.passed);
}

}  // namespace
}  // namespace sightline::test
