// The lit image stays the same, pixel for pixel, if shadow maps draw only the casters that were kept.
// SPDX-License-Identifier: MIT
#include <filesystem>
#include <optional>

#include <glm/gtc/constants.hpp>
#include <gtest/gtest.h>

#include "sightline/query/shadow_query.h"
#include "sightline/studies/hidden/render.h"
#include "sightline/studies/hidden/shade/shadow_map.h"
#include "sightline/studies/hidden/zbuffer/zbuffer.h"
#include "sightline/tools/import/gltf/gltf.h"
#include "sightline/tools/load/load_world.h"
#include "sightline/tools/load/seeded_cameras.h"
#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/scene/procedural.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

constexpr uint32_t kMap = 512;

/// A scene, and one frame of it by the reference renderer.
struct Frame {
    const Scene& scene;
    View view;
    RenderList drawn;
    HiddenImage image;
    SurfacePoints points;

    Frame(const Scene& of, const CameraFrame& camera)
        : scene(of),
          view(makeView(camera, 320, 180)),
          drawn(scene, view),
          image(render(drawn.list(), view, {})),
          points(drawn.list(), view) {}

    template <class Visit>
    void forEachPoint(Visit visit) const {
        for (uint32_t row = 0; row < view.height; ++row)
            for (uint32_t i = 0; i < view.width; ++i) {
                const uint32_t surface = image.surface[size_t{row} * view.width + i];
                if (surface != HiddenImage::kNone) visit(points.at(row, i, surface));
            }
    }
    /// Both sides of everything that casts.
    std::vector<DrawItem> casters(const std::vector<uint8_t>& kept) const {
        static const std::vector<uint8_t> both(1u << 20, 1);
        std::vector<DrawItem> out;
        for (const DrawItem& item : drawn.casters()) {
            if (!kept[item.id]) continue;
            out.push_back(item);
            EXPECT_LE(item.mesh.triangles(), both.size());
            out.back().double_sided = std::span(both).first(item.mesh.triangles());
        }
        return out;
    }
};

/// The plainest shadow maps of a light at a point: a spot's one, or the six faces of a cube.
struct PointMaps {
    std::vector<View> views;
    std::vector<ZBufferImage> maps;

    PointMaps(std::span<const DrawItem> casters, const Light& light) {
        const auto add = [&](const glm::dvec3& toward, double angle) {
            View view;
            view.width = view.height = kMap;
            const glm::dvec3 up = std::abs(glm::normalize(toward).y) < 0.9 ? glm::dvec3(0, 1, 0) : glm::dvec3(1, 0, 0);
            view.view = lookAt(light.position, light.position + toward, up);
            view.projection = perspective(angle, 1.0, light.near);
            views.push_back(view);
            maps.push_back(renderZBuffer(casters, view, {.want_generated = false}));
        };
        if (light.kind == LightKind::kSpot) {
            add(light.direction, 2 * light.half_angle);
            return;
        }
        for (int axis = 0; axis < 3; ++axis)
            for (const double sign : {1.0, -1.0}) {
                glm::dvec3 toward(0.0);
                toward[axis] = sign;
                add(toward, glm::half_pi<double>());
            }
    }

    /// Whether the light reaches a point, by the nearest texel; nothing if the point is in no map.
    std::optional<bool> lit(const glm::dvec3& point) const {
        for (size_t k = 0; k < maps.size(); ++k) {
            const glm::dvec4 clip = views[k].projection * views[k].view * glm::dvec4(point, 1);
            if (clip.w < 0.05 || std::abs(clip.x) > clip.w || std::abs(clip.y) > clip.w) continue;
            const auto texel = [](double at) {
                return std::min(static_cast<uint32_t>((0.5 * at + 0.5) * kMap), kMap - 1);
            };
            const double there = maps[k].depth[size_t{texel(clip.y / clip.w)} * kMap + texel(clip.x / clip.w)];
            return !(there > 1 / clip.w * (1 + 1e-9));
        }
        return std::nullopt;
    }
    double texelAtOne(const Light& light) const {
        return 2 * (light.kind == LightKind::kSpot ? std::tan(light.half_angle) : 1.0) / kMap;
    }
};

struct Compared {
    uint64_t points = 0, dark = 0, changed = 0, kept = 0, in_light = 0;
};

std::vector<uint8_t> keptOf(const CasterSet& set, size_t objects) {
    std::vector<uint8_t> kept(objects, 0);
    for (const Visible& caster : set.casters) kept[caster.id.index - 1] = 1;  // objects enter in their order
    return kept;
}

void compareSun(const Frame& frame, const Snapshot& now, const glm::dvec3& sun, Compared& sum) {
    ShadowSettings map_settings;
    map_settings.sun = sun;
    map_settings.size = kMap;
    const ShadowMap all(frame.drawn.casters(), frame.points, frame.image, map_settings);
    double texel = 0;
    frame.forEachPoint([&](const SurfacePoint& point) { texel = std::max(texel, all.texelFor(point)); });
    Light light{.direction = -sun};
    CasterSettings settings;
    settings.filter = 2 * texel;  // four texels are looked up,
    settings.bias = 16 * texel;   // along the slope of the surface that asks
    Query query;
    ShadowQuery shadows;
    const CasterSet set = shadows.casters(now, frame.view, query.visible(now, frame.view).objects, light, settings);
    sum.kept += set.casters.size();
    sum.in_light += set.stats.in_light;
    const std::vector<uint8_t> kept = keptOf(set, frame.scene.objects.size());
    const ShadowMap less(frame.casters(kept), frame.points, frame.image, map_settings);
    frame.forEachPoint([&](const SurfacePoint& point) {
        const double reach = all.reach(point);
        ++sum.points;
        sum.dark += reach < 1;
        sum.changed += reach != less.reach(point);
    });
}

void comparePointLight(const Frame& frame, const Snapshot& now, const Light& light, Compared& sum) {
    const PointMaps all(frame.casters(std::vector<uint8_t>(frame.scene.objects.size(), 1)), light);
    CasterSettings settings;
    settings.filter = all.texelAtOne(light);
    Query query;
    ShadowQuery shadows;
    const CasterSet set = shadows.casters(now, frame.view, query.visible(now, frame.view).objects, light, settings);
    sum.kept += set.casters.size();
    sum.in_light += set.stats.in_light;
    const PointMaps less(frame.casters(keptOf(set, frame.scene.objects.size())), light);
    frame.forEachPoint([&](const SurfacePoint& relative) {
        const glm::dvec3 point = relative.position + frame.points.eye();
        const std::optional<bool> lit = all.lit(point);
        if (!lit || glm::length(point - light.position) > light.range) return;
        ++sum.points;
        sum.dark += !*lit;
        sum.changed += lit != less.lit(point);
    });
}

void expectSame(const Scene& scene) {
    LoadedWorld loaded = loadWorld(scene, {}, loadSettings(false, 0));
    const Snapshot now = loaded.world.commit();
    const CameraPath path = seededCameras(scene, 3, 7);
    const Box3d bounds = worldBounds(scene);
    const double size = glm::length(bounds.size());
    Compared suns, spots, around;
    for (size_t i = 0; i < path.frames.size(); ++i) {
        const Frame frame(scene, path.frames[i]);
        const double turn = 0.7 + 2.0 * static_cast<double>(i);
        compareSun(frame, now, glm::normalize(glm::dvec3(std::cos(turn), 0.3, std::sin(turn))), suns);
        // Beside the eye: a lamp that someone carries.
        const glm::dmat4 camera = glm::inverse(frame.view.view);
        Light lamp{.position = glm::dvec3(camera * glm::dvec4(0.02 * size, 0.01 * size, 0, 1)),
                   .near = 1e-3 * size,
                   .range = 10 * size};
        lamp.kind = LightKind::kSpot;
        lamp.direction = -glm::dvec3(camera[2]) + 0.2 * glm::dvec3(camera[0]);
        lamp.half_angle = 0.6;
        comparePointLight(frame, now, lamp, spots);
        lamp.kind = LightKind::kPoint;
        comparePointLight(frame, now, lamp, around);
    }
    const auto judge = [&](const char* light, const Compared& sum) {
        std::printf("%s, %s: %llu of %llu casters, %llu of %llu points dark, %llu changed\n", scene.name.c_str(), light,
                    static_cast<unsigned long long>(sum.kept), static_cast<unsigned long long>(sum.in_light),
                    static_cast<unsigned long long>(sum.dark), static_cast<unsigned long long>(sum.points),
                    static_cast<unsigned long long>(sum.changed));
        EXPECT_EQ(sum.changed, 0u) << scene.name << ", " << light;
        EXPECT_LT(sum.kept, sum.in_light) << scene.name << ", " << light;  // else nothing was tested
        EXPECT_GT(sum.dark, sum.points / 100) << scene.name << ", " << light;
        EXPECT_GT(sum.points, 10000u) << scene.name << ", " << light;
    };
    judge("sun", suns);
    judge("spot", spots);
    judge("point light", around);
}

TEST(CasterImages, OfACityStayTheSame) {
    const Result<Scene> scene = makeProcedural("city:1:200");
    ASSERT_TRUE(scene.ok());
    expectSame(*scene);
}

TEST(CasterImages, OfRealScenesStayTheSame) {
    size_t seen = 0;
    for (const char* name : {"bsi-duplex", "aws-small-house", "gazebo-willowgarage"}) {
        const std::string file = SIGHTLINE_SHARED_DIR "/scenes/" + std::string(name) + ".glb";
        if (!std::filesystem::exists(file)) continue;
        const Result<Scene> scene = loadGltf(file);
        ASSERT_TRUE(scene.ok()) << scene.error().message;
        expectSame(*scene);
        ++seen;
    }
    if (seen == 0) GTEST_SKIP() << "no scenes beside the repository";
}

}  // namespace
}  // namespace sightline
