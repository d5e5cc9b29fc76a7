// What the lectures claim about back faces and clipping, measured on real scenes and on a walk through a city.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include <gtest/gtest.h>

#include "sightline/studies/hidden/project/facing.h"
#include "sightline/studies/hidden/project/projector.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/scene/city/city.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

/// Directions that are spread evenly.
std::vector<glm::dvec3> directions(int count) {
    std::vector<glm::dvec3> result;
    for (int i = 0; i < count; ++i) {
        const double z = 1 - (2 * i + 1.0) / count, angle = i * 2.399963229728653, r = std::sqrt(1 - z * z);
        result.push_back({r * std::cos(angle), r * std::sin(angle), z});
    }
    return result;
}

/// A scene's triangles in world space, at most so many, in even steps.
std::vector<glm::dvec3> worldTriangles(const Scene& scene, size_t most) {
    const size_t step = drawnTriangles(scene) / most + 1;
    std::vector<glm::dvec3> corners;
    size_t number = 0;
    for (const SceneObject& object : scene.objects) {
        const Mesh& mesh = scene.meshes[object.mesh];
        const bool mirrored = glm::determinant(glm::dmat3(object.transform)) < 0;
        for (size_t t = 0; t < mesh.triangles(); ++t)
            if (number++ % step == 0)
                for (size_t k = 0; k < 3; ++k) {
                    const uint32_t index = mesh.indices[3 * t + (mirrored ? 2 - k : k)];
                    corners.push_back(object.transform * glm::dvec4(glm::dvec3(mesh.positions[index]), 1.0));
                }
    }
    return corners;
}

struct BackShare {
    double parallel = 0, outside = 0;        ///< of triangles, mean over all directions
    double area_outside = 0, predicted = 0;  ///< of area, measured and by the formula
    size_t without_area = 0;                 ///< triangles that have no back
};

/// An eye on a sphere of radius r sees the back of a triangle at the signed distance h of its plane from the centre from
/// a share of 1/2 + h / 2r of all places. Over a closed mesh, area * h sums up to three times the volume.
BackShare measure(const std::vector<glm::dvec3>& corners, const glm::dvec3& center, double radius) {
    const std::vector<glm::dvec3> ways = directions(512);
    BackShare share;
    double area = 0;
    for (size_t i = 0; i < corners.size(); i += 3) {
        const glm::dvec3 normal = faceNormal(corners[i], corners[i + 1], corners[i + 2]);
        const double size = glm::length(normal);
        if (size == 0) {
            ++share.without_area;
            continue;
        }
        const glm::dvec3 from_center = corners[i] - center;
        int parallel = 0, outside = 0;
        for (const glm::dvec3& way : ways) {
            parallel += parallelFacing(normal, way) <= 0;
            outside += glm::dot(normal, radius * way - from_center) <= 0;
        }
        const double many = double(ways.size());
        share.parallel += parallel / many;
        share.outside += outside / many;
        share.area_outside += size * outside / many;
        share.predicted += size * 0.5 + glm::dot(normal, from_center) / (2 * radius);
        area += size;
    }
    const double triangles = double(corners.size() / 3 - share.without_area);
    share.parallel /= triangles;
    share.outside /= triangles;
    share.area_outside /= area;
    share.predicted /= area;
    return share;
}

TEST(FacingScenes, HalfOfTheFacesAreBackFacesAndAVolumeAddsItsShare) {
    const std::vector<std::filesystem::path> files = test::sharedFiles("scenes", ".glb");
    if (files.empty()) GTEST_SKIP() << "no scenes beside the repository";
    for (const std::filesystem::path& file : files) {
        const Result<Scene> scene = loadGltf(file.string());
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        const Box3d box = worldBounds(*scene);
        const double radius = 3 * 0.5 * glm::length(box.size());
        const BackShare share = measure(worldTriangles(*scene, 20000), box.center(), radius);
        std::printf(
            "%-28s back faces: %.2f %% in parallel views, %.2f %% from three radii; of the area %.2f %%, "
            "%.2f %% predicted; %zu have no area\n",
            file.filename().c_str(), 100 * share.parallel, 100 * share.outside, 100 * share.area_outside,
            100 * share.predicted, share.without_area);
        EXPECT_NEAR(share.parallel, 0.5, 0.005) << file;
        EXPECT_NEAR(share.area_outside, share.predicted, 0.005) << file;
    }
}

TEST(FacingScenes, AClosedMeshLooksTheSameWithoutItsBackFaces) {
    const auto scene = test::sharedScene("dense-spot");
    if (!scene) GTEST_SKIP() << "no scenes beside the repository";
    std::vector<DrawItem> items;
    for (const SceneObject& object : scene->objects) {
        DrawItem item;
        item.mesh = {scene->meshes[object.mesh].positions, scene->meshes[object.mesh].indices};
        item.transform = object.transform;
        items.push_back(item);
    }
    const DrawList list(items);
    const Box3d box = worldBounds(*scene);
    const double size = glm::length(box.size());
    uint64_t differing = 0, covered = 0, dropped = 0, triangles = 0;
    for (const glm::dvec3& way : directions(12)) {
        View view;
        view.width = 320;
        view.height = 240;
        view.view = lookAt(box.center() + size * way, box.center(), {0, 1, 0});
        view.projection = perspective(1.0, 4.0 / 3, 0.01 * size);
        RenderSettings culled, all;
        culled.projector.clipping = all.projector.clipping = Clipping::kClipless;
        all.projector.cull_back_faces = false;
        const HiddenImage one = render(list, view, culled), other = render(list, view, all);
        for (size_t at = 0; at < one.surface.size(); ++at) {
            differing += one.surface[at] != other.surface[at];
            covered += one.surface[at] != HiddenImage::kNone;
        }
        dropped += one.counters.geometry.back_facing;
        triangles += one.counters.geometry.triangles;
    }
    std::printf("dense-spot.glb: %zu samples, %zu differ without back faces, %.1f %% of the triangles\n",
                size_t(covered), size_t(differing), 100.0 * double(dropped) / double(triangles));
    EXPECT_GT(covered, 50000u);
    // On a silhouette a front and a back face meet, and both are equally near there.
    EXPECT_LE(differing, covered / 10000);
}

TEST(GuardBand, SparesNearlyAllThatLiesOutsideInPart) {
    const Scene scene = makeCity(1, 10000);
    ProjectorCounters sum;
    uint64_t six_planes = 0;
    for (const CameraFrame& frame : cityStreetPath(1, 24).frames) {
        const View view = makeView(frame, 1280, 720);
        const SampleGrid grid{view.width, view.height, 0, 1, {}};
        Projector band(view, grid), sides(view, grid, {.clipping = Clipping::kFrustum});
        for (const SceneObject& object : scene.objects) {
            DrawItem item;
            item.mesh = {scene.meshes[object.mesh].positions, scene.meshes[object.mesh].indices};
            item.transform = object.transform;
            for (Projector* projector : {&band, &sides}) {
                projector->begin(item);
                ScreenPolygon polygon;
                for (size_t t = 0; t < item.mesh.triangles(); ++t) projector->project(t, polygon);
            }
        }
        sum.spared += band.counters().spared;
        sum.clipped += band.counters().clipped;
        sum.triangles += band.counters().triangles;
        sum.rejected += band.counters().rejected;
        six_planes += sides.counters().clipped;
    }
    const double spared = double(sum.spared) / double(sum.spared + sum.clipped);
    std::printf(
        "a walk through city:1:10000: %zu triangles, %zu rejected, %zu outside in part; the guard band spares "
        "%.2f %% of these, and %zu are clipped instead of %zu\n",
        size_t(sum.triangles), size_t(sum.rejected), size_t(sum.spared + sum.clipped), 100 * spared,
        size_t(sum.clipped), size_t(six_planes));
    EXPECT_GE(spared, 0.95);
}

}  // namespace
}  // namespace sightline
