// Pictures are lit as the sun stands: points, normals and colours of what an image shows.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/shade/shade.h"

#include <cmath>
#include <thread>

#include <gtest/gtest.h>

#include "tests/studies/hidden/made_lists.h"

namespace sightline::test {
using namespace studies;
namespace {

const glm::dvec3 kSun = glm::normalize(glm::dvec3(0.3, 0.8, 0.5));

/// A unit sphere of triangles, away from the eye; `welded` shares the vertices of neighbours.
MadeList sphere(int rings, bool welded, const glm::vec3& centre = {0, 0, -4}) {
    MadeList made;
    made.name = "sphere";
    const auto at = [&](int ring, int step) {
        if (ring % rings == 0) return centre + glm::vec3(0, ring == 0 ? 1 : -1, 0);
        const double up = 3.14159265358979 * ring / rings, round = 3.14159265358979 * (step % (2 * rings)) / rings;
        return centre + glm::vec3(std::sin(up) * std::cos(round), std::cos(up), -std::sin(up) * std::sin(round));
    };
    for (int ring = 0; ring < rings; ++ring)
        for (int step = 0; step < 2 * rings; ++step) {
            if (ring > 0) made.add(at(ring, step), at(ring + 1, step), at(ring, step + 1), false);
            if (ring + 1 < rings) made.add(at(ring, step + 1), at(ring + 1, step), at(ring + 1, step + 1), false);
        }
    if (!welded) return made;
    MadeList shared = made;
    shared.positions.clear();
    for (uint32_t& index : shared.indices) {
        const glm::vec3 p = made.positions[index];
        size_t found = 0;
        while (found < shared.positions.size() && shared.positions[found] != p) ++found;
        if (found == shared.positions.size()) shared.positions.push_back(p);
        index = static_cast<uint32_t>(found);
    }
    return shared;
}

struct Picture {
    explicit Picture(MadeList m, const View& v = madeView())
        : made(std::move(m)), items(made.items()), list(items), view(v), image(nearestSurfaces(list, view)) {}

    std::vector<glm::u8vec3> shaded(ShadeSettings settings = {}) const {
        settings.sun = kSun;
        if (!settings.colour) settings.colour = [](uint32_t, uint32_t) { return glm::dvec3(1.0); };
        return shade(list, view, image, settings);
    }
    size_t centre() const { return size_t{view.height / 2} * view.width + view.width / 2; }

    MadeList made;
    std::vector<DrawItem> items;
    DrawList list;
    View view;
    HiddenImage image;
};

/// A square of two triangles at z = -3 with the given normal.
MadeList square(const glm::dvec3& normal) {
    const glm::dvec3 n = glm::normalize(normal);
    const glm::dvec3 u = glm::normalize(glm::cross(std::abs(n.y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0), n));
    const glm::dvec3 v = glm::cross(n, u), c(0, 0, -3);
    MadeList made;
    made.add(glm::vec3(c - u - v), glm::vec3(c + u - v), glm::vec3(c + u + v));
    made.add(glm::vec3(c - u - v), glm::vec3(c + u + v), glm::vec3(c - u + v));
    return made;
}

TEST(Shade, AWhiteSquareIsBrightestWhereItFacesTheSun) {
    int last = 256;
    for (const double turn : {0.0, 0.3, 0.6, 0.9, 1.2}) {  // about the x axis, away from the sun
        const glm::dvec3 away = glm::normalize(glm::cross(kSun, glm::dvec3(1, 0, 0)));
        const Picture picture(square(std::cos(turn) * kSun - std::sin(turn) * away));
        const int green = picture.shaded()[picture.centre()].y;
        EXPECT_LT(green, last) << turn;
        last = green;
    }
    EXPECT_GT(Picture(square(kSun)).shaded()[Picture(square(kSun)).centre()].y, 240);
}

TEST(Shade, ShowsBothSidesOfASurfaceAsTheyFace) {
    // The side that is seen counts, whichever way the triangles wind: back and front look the same.
    const Picture front(square({0, 0, 1})), back(square({0, 0, -1}));
    EXPECT_EQ(front.shaded()[front.centre()], back.shaded()[back.centre()]);
}

TEST(Shade, PointsLieInTheirTrianglesOnTheLineOfSight) {
    for (const bool parallel : {false, true})
        for (const MadeList& made : madeLists()) {
            View view = madeView(80, 60);
            if (parallel) view.projection = orthographic(5, 4.0 / 3, 0.1, 100);
            view.view = lookAt({0.3, -0.2, 0.4}, {0.2, 0.1, -3}, {0.1, 1, 0});
            const Picture picture(made, view);
            const SurfacePoints points(picture.list, view);
            Projector projector(view, {view.width, view.height, 0, 1, {}});
            std::vector<DepthPlane> planes(picture.list.surfaces());
            for (const ScreenPolygon& polygon : projectAll(picture.list, projector))
                planes[polygon.surface] = polygon.depth;
            for (uint32_t row = 0; row < view.height; ++row)
                for (uint32_t i = 0; i < view.width; ++i) {
                    const uint32_t surface = picture.image.surface[size_t{row} * view.width + i];
                    if (surface == HiddenImage::kNone) continue;
                    const SurfacePoint point = points.at(row, i, surface);
                    EXPECT_NEAR(glm::length(point.normal), 1, 1e-9);
                    EXPECT_LE(glm::dot(point.normal, points.directionAt(row, i)), 1e-9);
                    EXPECT_NEAR(point.weights.x + point.weights.y + point.weights.z, 1, 1e-12);
                    const glm::dvec4 clip = view.projection * view.view * glm::dvec4(point.position + points.eye(), 1);
                    const double nearness =
                        parallel ? glm::dot(glm::dmat3(view.view) * point.position, glm::dvec3(0, 0, 1)) : 1 / clip.w;
                    ASSERT_NEAR((clip.x / clip.w + 1) / 2 * view.width, i + 0.5, 1e-3) << made.name << " row " << row;
                    ASSERT_NEAR((clip.y / clip.w + 1) / 2 * view.height, row + 0.5, 1e-3) << made.name << " at " << i;
                    const double drawn = planes[surface].at(row, i);
                    ASSERT_NEAR(nearness, drawn, 1e-3 * std::abs(drawn)) << made.name << " row " << row << " at " << i;
                }
        }
}

TEST(Shade, SmoothNormalsOfASphereAreRadial) {
    const MadeList made = sphere(16, false);
    const std::vector<glm::vec3> normals = smoothNormals({made.positions, made.indices});
    ASSERT_EQ(normals.size(), made.indices.size());
    for (size_t i = 0; i < normals.size(); ++i) {
        EXPECT_NEAR(glm::length(normals[i]), 1, 1e-5);
        const glm::vec3 radial = glm::normalize(made.positions[made.indices[i]] - glm::vec3(0, 0, -4));
        EXPECT_GT(glm::dot(normals[i], radial), std::cos(0.05)) << i;
    }
}

TEST(Shade, SmoothNormalsDoNotDependOnHowVerticesAreShared) {
    const MadeList apart = sphere(6, false), shared = sphere(6, true);
    ASSERT_LT(shared.positions.size(), apart.positions.size());
    EXPECT_EQ(smoothNormals({apart.positions, apart.indices}), smoothNormals({shared.positions, shared.indices}));
}

TEST(Shade, CreasesStaySharp) {
    // Two faces of a roof that meet at 60 degrees, and their flat halves.
    MadeList made;
    made.add({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    made.add({1, 0, 0}, {1, 1, 0}, {0, 1, 0});
    made.add({0, 0, 0}, {0, 1, 0}, {-0.5f, 0, 0.8660254f});
    const MeshView mesh{made.positions, made.indices};
    const std::vector<glm::vec3> sharp = smoothNormals(mesh, 59), soft = smoothNormals(mesh, 91);
    for (int i = 0; i < 6; ++i) EXPECT_EQ(sharp[i], glm::vec3(0, 0, 1)) << i;
    EXPECT_NE(soft[0], glm::vec3(0, 0, 1));
    EXPECT_EQ(soft[0], soft[6]);  // one position, one normal
    EXPECT_EQ(soft[1], glm::vec3(0, 0, 1));
    made.add({0, 0, 0}, {0, 0, 0}, {0, 1, 0});  // no area: takes part in nothing
    EXPECT_EQ(smoothNormals({made.positions, made.indices}, 91)[9], glm::vec3(0));
    EXPECT_EQ(smoothNormals({made.positions, made.indices}, 91)[0], soft[0]);
}

TEST(Shade, SmoothIsBetweenItsFacesAndFlatIsConstantOnEach) {
    Picture picture(sphere(8, true));
    ShadeSettings settings;
    const std::vector<glm::u8vec3> flat = picture.shaded(settings);
    settings.shading = Shading::kSmooth;
    const std::vector<glm::u8vec3> smooth = picture.shaded(settings);
    int flat_steps = 0, smooth_steps = 0;  // the largest step between neighbours of the middle row
    const size_t line = size_t{picture.view.height / 2} * picture.view.width;
    for (size_t i = line + 1; i < line + picture.view.width; ++i) {
        const uint32_t a = picture.image.surface[i - 1], b = picture.image.surface[i];
        if (a == HiddenImage::kNone || b == HiddenImage::kNone) continue;
        if (a == b) { EXPECT_EQ(flat[i - 1], flat[i]); }
        flat_steps = std::max(flat_steps, std::abs(int(flat[i].y) - int(flat[i - 1].y)));
        smooth_steps = std::max(smooth_steps, std::abs(int(smooth[i].y) - int(smooth[i - 1].y)));
    }
    EXPECT_GT(flat_steps, 2 * smooth_steps);
}

TEST(Shade, MirroredItemsAreLitAsTheyStand) {
    // A sphere mirrored about its own centre is the same sphere.
    for (const Shading shading : {Shading::kFlat, Shading::kSmooth}) {
        const MadeList made = sphere(12, true, {0, 0, 0});
        const View view = madeView();
        ShadeSettings settings;
        settings.shading = shading;
        settings.sun = kSun;
        settings.colour = [](uint32_t, uint32_t) { return glm::dvec3(1.0); };
        std::vector<glm::u8vec3> shaded[2];
        for (const bool mirror : {false, true}) {
            std::vector<DrawItem> items = made.items();
            items[0].transform[0].x = mirror ? -1 : 1;
            items[0].transform[3] = {0, 0, -4, 1};
            const DrawList list(items);
            shaded[mirror] = shade(list, view, nearestSurfaces(list, view), settings);
        }
        const size_t centre = size_t{view.height / 2} * view.width + view.width / 2;
        for (const size_t at : {centre + 8, centre - 8, centre + 20 * view.width, centre - 20 * view.width})
            EXPECT_NEAR(shaded[0][at].y, shaded[1][at].y, 12) << at;
        EXPECT_GT(shaded[1][centre + 20 * view.width].y, shaded[1][centre - 20 * view.width].y);
    }
}

TEST(Shade, IsTheSameForAnySharingOfTheWork) {
    const Picture picture(clutter(4, 300));
    ShadeSettings settings;
    settings.shading = Shading::kSmooth;
    const std::vector<glm::u8vec3> one = picture.shaded(settings);
    settings.share = [](size_t count, const std::function<void(size_t)>& work) {
        std::thread other([&] {
            for (size_t i = 1; i < count; i += 2) work(i);
        });
        for (size_t i = (count + 1) / 2; i-- > 0;) work(2 * i);
        other.join();
    };
    EXPECT_EQ(one, picture.shaded(settings));
}

TEST(Shade, WithoutShadingColoursAreTheirOwn) {
    const Picture picture(square({0, 0, 1}));
    ShadeSettings settings;
    settings.shading = Shading::kNone;
    settings.colour = [](uint32_t, uint32_t) { return glm::dvec3(1, 0, 0.25); };
    const std::vector<glm::u8vec3> out = picture.shaded(settings);
    EXPECT_EQ(out[picture.centre()], toBytes({1, 0, 0.25}));
    EXPECT_EQ(out[0], glm::u8vec3(0));
}

}  // namespace
}  // namespace sightline::test
