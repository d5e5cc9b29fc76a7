// The witnesses report what is seen, and only that.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/verify.h"

#include <cmath>
#include <limits>
#include <thread>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "test_scenes.h"
#include "tests/support/views.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

constexpr double kPi = 3.141592653589793;

View usualView() { return viewBy(perspective(1.0, 4.0 / 3, 0.1), 320, 240); }

WitnessSettings raysOnly() { return {.rays = 20000, .aimed_rays = 5000, .supersampling = 0}; }

WitnessSettings idBufferOnly() { return {.rays = 0, .supersampling = 2}; }

/// What each witness alone says of culled objects; both must agree on the objects.
std::vector<uint32_t> accused(const Scene& scene, const View& view, const std::vector<uint8_t>& culled) {
    const Witness witness(scene);
    std::vector<uint32_t> found[2];
    for (int i = 0; i < 2; ++i)
        for (const FalseCull& cull : witness.judge(view, culled, i ? idBufferOnly() : raysOnly()).false_culls) {
            found[i].push_back(cull.object);
            EXPECT_STREQ(cull.witness, i ? "id-buffer" : "rays");
            EXPECT_TRUE(cull.x >= 0 && cull.x <= view.width && cull.y >= 0 && cull.y <= view.height);
        }
    EXPECT_EQ(found[0], found[1]);
    return found[0];
}

using Objects = std::vector<uint32_t>;

TEST(Witness, ReportsFalseCullsAndNoOthers) {
    Scene scene = emptyScene();
    const uint32_t wall = addSquare(scene, 2), box = addBox(scene, glm::vec3(0.3f));
    addObject(scene, box, moved({0, 0, -3}));  // in front of the wall
    addObject(scene, wall, moved({0, 0, -5}));
    addObject(scene, box, moved({0, 0, -8}));    // behind the wall
    addObject(scene, box, moved({3.4, 0, -8}));  // beside it
    addObject(scene, box, moved({0, 0, 5}));     // behind the eye
    EXPECT_EQ(accused(scene, usualView(), {1, 1, 1, 1, 1}), (Objects{0, 1, 3}));
    EXPECT_EQ(accused(scene, usualView(), {0, 0, 1, 0, 1}), Objects{});
    const FrameVerdict verdict = Witness(scene).judge(usualView(), std::vector<uint8_t>{0, 0, 1, 0, 1}, raysOnly());
    EXPECT_EQ(verdict.seen, (std::vector<uint8_t>{1, 1, 0, 1, 0}));
    EXPECT_EQ(verdict.exactly_visible, 3u);
    EXPECT_EQ(verdict.rays, 20000u);
    EXPECT_EQ(verdict.id_samples, 0u);
}

TEST(Witness, PlacesCountFromTheTopLeft) {
    Scene scene = emptyScene();
    addObject(scene, addBox(scene, glm::vec3(0.1f)), moved({-1, 0.6, -3}));
    for (const WitnessSettings& settings : {raysOnly(), idBufferOnly()}) {
        const FrameVerdict verdict = Witness(scene).judge(usualView(), std::vector<uint8_t>{1}, settings);
        ASSERT_EQ(verdict.false_culls.size(), 1u);
        const double scale = 120 / std::tan(0.5) / 3;
        EXPECT_NEAR(verdict.false_culls[0].x, 160 - scale, 12);
        EXPECT_NEAR(verdict.false_culls[0].y, 120 - 0.6 * scale, 12);
    }
}

/// A wall turned and mirrored in every way: its front hides the box behind it, its back does not.
TEST(Witness, SeesThroughBackFacesOnly) {
    for (int mirror = 0; mirror < 2; ++mirror)
        for (int spin = 0; spin < 4; ++spin)
            for (int turned = 0; turned < 2; ++turned)
                for (uint32_t material = 0; material < 2; ++material) {
                    Scene scene = emptyScene();
                    const double roll = 0.3 + 1.1 * spin, yaw = turned * kPi;
                    glm::dmat4 transform = moved({0, 0, -4});
                    transform *= glm::dmat4(std::cos(yaw), 0, -std::sin(yaw), 0, 0, 1, 0, 0, std::sin(yaw), 0,
                                            std::cos(yaw), 0, 0, 0, 0, 1);
                    transform *= glm::dmat4(std::cos(roll), std::sin(roll), 0, 0, -std::sin(roll), std::cos(roll), 0, 0,
                                            0, 0, 1, 0, 0, 0, 0, 1);
                    if (mirror) transform[0] = -transform[0];
                    const uint32_t wall = addSquare(scene, 2, material);
                    addObject(scene, wall, transform);
                    addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0, 0, -8}));
                    // A mesh that two objects share is instanced.
                    addObject(scene, spin % 2 ? wall : addSquare(scene, 2), moved({0, 0, 9}));
                    const bool through = turned && material == 0;
                    EXPECT_EQ(accused(scene, usualView(), {1, 1, 0}), through ? Objects{1} : Objects{0})
                        << "mirror " << mirror << " spin " << spin << " turned " << turned << " material " << material;
                }
}

TEST(Witness, SeesAndPassesWhatDoesNotHide) {
    for (uint32_t material : {2u, 3u, 4u}) {
        Scene scene = emptyScene();
        const uint32_t box = addBox(scene, glm::vec3(0.3f)), pane = addSquare(scene, 2, material);
        addObject(scene, pane, moved({0, 0, -4}));
        addObject(scene, pane, moved({0, 0, -5}));
        addObject(scene, box, moved({0, 0, -8}));
        addObject(scene, addSquare(scene, 9), moved({0, 0, -9}));
        addObject(scene, pane, moved({0, 0, -10}));  // behind an opaque wall
        EXPECT_EQ(accused(scene, usualView(), {1, 1, 1, 0, 1}), (Objects{0, 1, 2})) << "material " << material;
    }
}

TEST(Witness, DeformingMeshesHideNothing) {
    Scene scene = emptyScene();
    const uint32_t curtain = addSquare(scene, 2);
    scene.meshes[curtain].deforms = true;
    addObject(scene, curtain, moved({0, 0, -4}));
    addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0, 0, -8}));
    EXPECT_EQ(accused(scene, usualView(), {1, 1}), (Objects{0, 1}));
}

TEST(Witness, LooksFromTheNearPlaneToTheFarPlane) {
    const double inf = std::numeric_limits<double>::infinity();
    for (const glm::dmat4& projection : {perspective(1.0, 4.0 / 3, 1.0, 10), orthographic(3, 4.0 / 3, 1, 10)}) {
        Scene scene = emptyScene();
        const uint32_t wall = addSquare(scene, 2), box = addBox(scene, glm::vec3(0.3f));
        addObject(scene, wall, moved({0, 0, -0.5}));  // before the near plane
        addObject(scene, box, moved({0, 0, -6}));
        addObject(scene, box, moved({0.9, 0, -11}));  // beyond the far plane
        EXPECT_EQ(accused(scene, viewBy(projection, 320, 240), {1, 1, 1}), Objects{1});
    }
    Scene scene = emptyScene();
    addObject(scene, addSquare(scene, 500), moved({0, 0, -1e5}));
    addObject(scene, addSquare(scene, 500), moved({0, 0, -2e5}));
    EXPECT_EQ(accused(scene, viewBy(perspective(0.005, 1, 0.1), 320, 240), {1, 1}), Objects{0});
    EXPECT_EQ(accused(scene, viewBy(orthographic(900, 1, 0.1, inf), 320, 240), {1, 1}), Objects{0});
}

TEST(Witness, NearPlaneCutsObjectsOpen) {
    // The eye stands in a box whose near wall is cut away: what is inside is seen, what is outside is not, as the
    // box shows its outside only and is passed from within.
    Scene scene = emptyScene();
    const uint32_t room = addBox(scene, glm::vec3(3), 1), box = addBox(scene, glm::vec3(0.3f));
    addObject(scene, room, moved({0, 0, 0}));
    addObject(scene, box, moved({0, 0, -2}));
    addObject(scene, box, moved({1, 0, -5}));
    EXPECT_EQ(accused(scene, usualView(), {1, 1, 1}), (Objects{0, 1}));
    View outside = viewBy(perspective(1.0, 4.0 / 3, 3.5), 320, 240);
    outside.view = lookAt({0, 0, 6}, {0, 0, 0}, {0, 1, 0});
    EXPECT_EQ(accused(scene, outside, {1, 1, 1}), (Objects{0, 1}));
}

TEST(Witness, ParallelViews) {
    Scene scene = emptyScene();
    const uint32_t wall = addSquare(scene, 1), box = addBox(scene, glm::vec3(0.3f));
    addObject(scene, wall, moved({0, 0, -3}));
    addObject(scene, box, moved({0.5, 0.5, -30}));  // hidden: nothing shrinks with distance
    addObject(scene, box, moved({1.2, 0, -30}));    // shows its side
    const View view = viewBy(orthographic(4, 4.0 / 3, 0.1, 100), 320, 240);
    EXPECT_EQ(accused(scene, view, {1, 1, 1}), (Objects{0, 2}));
}

TEST(Witness, OnePixelViewport) {
    Scene scene = emptyScene();
    const uint32_t wall = addSquare(scene, 20), box = addBox(scene, glm::vec3(0.05f));
    addObject(scene, box, moved({1, 0.5, -3}));
    addObject(scene, wall, moved({0, 0, -5}));
    addObject(scene, box, moved({0, 0, -8}));
    const View view = viewBy(perspective(1.0, 1.0, 0.1), 1, 1);
    WitnessSettings settings = idBufferOnly();
    settings.rays = 20000;
    const FrameVerdict verdict = Witness(scene).judge(view, std::vector<uint8_t>{1, 0, 1}, settings);
    ASSERT_EQ(verdict.false_culls.size(), 1u);
    EXPECT_EQ(verdict.false_culls[0].object, 0u);
    EXPECT_EQ(verdict.id_samples, 4u);
}

/// Two walls with a slit of a third of a pixel between them, and a box far behind it.
Scene slitScene(const View& view, double pixels, const glm::dvec3& shift) {
    Scene scene = emptyScene();
    const double pixel = 2 * std::tan(0.5) * 4 / view.height;  // at distance 4
    const uint32_t wall = addSquare(scene, 4), box = addBox(scene, glm::vec3(0.3f));
    addObject(scene, wall, moved(shift + glm::dvec3(-4.1234, 0, -4)));
    addObject(scene, wall, moved(shift + glm::dvec3(-4.1234 + 8 + pixels * pixel, 0, -4)));
    addObject(scene, box, moved(shift + glm::dvec3(-0.3, 0, -10)));
    return scene;
}

TEST(Witness, AimedRaysFindSlits) {
    for (const double away : {0.0, 1e6}) {
        const glm::dvec3 shift(away, 0.25 * away, -away);
        View view = viewBy(perspective(1.0, 4.0 / 3, 0.1), 1280, 960);
        view.view = lookAt(shift, shift + glm::dvec3(0, 0, -1), {0, 1, 0});
        WitnessSettings settings = raysOnly();
        settings.rays = settings.aimed_rays = 4000;
        for (const double width : {0.3, -0.3}) {
            const Scene scene = slitScene(view, width, shift);
            const FrameVerdict verdict = Witness(scene).judge(view, std::vector<uint8_t>{0, 0, 1}, settings);
            EXPECT_EQ(verdict.false_culls.size(), width > 0 ? 1u : 0u) << "away " << away << " width " << width;
        }
    }
}

/// What lies far off, or around all.
enum class Far {
    kStray,   ///< a triangle
    kDome,    ///< a box around all, with a middle of its own
    kChain,   ///< triangles each five times as far as the one before: no gap tells them from the rest
    kInMesh,  ///< a triangle of the walls' own mesh
};

void addFar(Scene& scene, Far what, double far) {
    const auto triangleAt = [](double at, double size) {
        const auto x = static_cast<float>(at), y = static_cast<float>(size);
        return std::vector<glm::vec3>{{x, 0, 0}, {x, y, 0}, {x, 0, y}};
    };
    if (what == Far::kStray) addObject(scene, addMesh(scene, triangleAt(far, 1), {0, 1, 2}), moved({0, 0, 0}));
    if (what == Far::kDome)
        addObject(scene, addBox(scene, glm::vec3(static_cast<float>(far)), 1), moved({0.3 * far, 0.2 * far, 0}));
    for (double at = 100; what == Far::kChain && at <= far; at *= 5)
        addObject(scene, addMesh(scene, triangleAt(at, 0.2 * at), {0, 1, 2}), moved({0, 0, 0}));
    if (what != Far::kInMesh) return;
    Mesh& wall = scene.meshes[0];
    for (const glm::vec3& corner : triangleAt(far, 1)) {
        wall.indices.push_back(static_cast<uint32_t>(wall.positions.size()));
        wall.positions.push_back(corner);
        wall.bounds.grow(glm::dvec3(corner));
    }
    ++wall.primitives[0].triangle_count;
}

TEST(Witness, AimedRaysFindSlitsWhateverLiesFarOff) {
    const View view = viewBy(perspective(1.0, 4.0 / 3, 0.1), 1280, 960);
    WitnessSettings settings = raysOnly();
    settings.rays = settings.aimed_rays = 4000;
    for (const Far what : {Far::kStray, Far::kDome, Far::kChain, Far::kInMesh})
        for (const double far : {1e3, 1e4, 1e5, 1e6, 1e7})
            for (const double width : {0.3, -0.3}) {
                Scene scene = slitScene(view, width, glm::dvec3(0.0));
                addFar(scene, what, far);
                std::vector<uint8_t> culled(scene.objects.size(), 0);
                culled[2] = 1;
                const FrameVerdict verdict = Witness(scene).judge(view, culled, settings);
                EXPECT_EQ(verdict.false_culls.size(), width > 0 ? 1u : 0u)
                    << "thing " << static_cast<int>(what) << " at " << far << " width " << width;
            }
}

TEST(Witness, AimedRaysFindSlitsInEachOfTwoTowns) {
    WitnessSettings settings = raysOnly();
    settings.rays = settings.aimed_rays = 4000;
    for (const double far : {1e3, 1e4, 1e5, 1e6, 1e7})
        for (uint32_t town = 0; town < 2; ++town) {
            const glm::dvec3 eye(town * far, 0, 0);
            View view = viewBy(perspective(1.0, 4.0 / 3, 0.1), 1280, 960);
            Scene scene = slitScene(view, 0.3, glm::dvec3(0.0));
            for (const SceneObject& object : slitScene(view, 0.3, glm::dvec3(far, 0, 0)).objects)
                addObject(scene, object.mesh, object.transform);
            view.view = lookAt(eye, eye + glm::dvec3(0, 0, -1), {0, 1, 0});
            const FrameVerdict verdict = Witness(scene).judge(view, std::vector<uint8_t>{0, 0, 1, 0, 0, 1}, settings);
            ASSERT_EQ(verdict.false_culls.size(), 1u) << "town " << town << ", the other at " << far;
            EXPECT_EQ(verdict.false_culls[0].object, town == 0 ? 2u : 5u) << far;
        }
}

TEST(Witness, WorldFarFromTheOrigin) {
    for (const double away : {1e6, 1e9}) {
        const glm::dvec3 shift(away, -away, 0.3 * away);
        Scene scene = emptyScene();
        const uint32_t wall = addSquare(scene, 2), box = addBox(scene, glm::vec3(0.3f));
        addObject(scene, box, moved(shift + glm::dvec3(0, 0, -3)));
        addObject(scene, wall, moved(shift + glm::dvec3(0, 0, -5)));
        addObject(scene, box, moved(shift + glm::dvec3(0, 0, -5.32)));
        addObject(scene, box, moved(shift + glm::dvec3(3.4, 0, -8)));
        View view = usualView();
        view.view = lookAt(shift, shift + glm::dvec3(0, 0, -1), {0, 1, 0});
        EXPECT_EQ(accused(scene, view, {1, 1, 1, 1}), (Objects{0, 1, 3})) << away;
    }
}

TEST(Witness, EqualDepthIsVisible) {
    Scene scene = emptyScene();
    const uint32_t wall = addSquare(scene, 2), poster = addSquare(scene, 0.5f);
    addObject(scene, wall, moved({0, 0, -4}));
    addObject(scene, poster, moved({0.3, 0.2, -4}));          // in the plane of the wall
    addObject(scene, poster, moved({-0.8, -0.3, -4.00001}));  // just behind it
    WitnessSettings settings = raysOnly();
    const FrameVerdict verdict = Witness(scene).judge(usualView(), std::vector<uint8_t>{0, 1, 1}, settings);
    ASSERT_EQ(verdict.false_culls.size(), 1u);
    EXPECT_EQ(verdict.false_culls[0].object, 1u);
}

/// Walls of many pieces, each with its own transform, turned at random: the seams are tight but for rounding, and
/// nothing behind them may be reported.
// A ceiling behind a wall, which touches it from behind in a line.
TEST(Witness, WhatTouchesInALineIsSeenByRaysAndProvedToBeHidden) {
    Scene scene = emptyScene();
    const uint32_t square = addSquare(scene, 2);
    addObject(scene, square, moved({0, 0, -4}));
    addObject(scene, square, {1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0.5, -6, 1});
    addObject(scene, square, moved({0, 4, -9}));  // and a square that looks out above the wall
    const auto falseCulls = [&](bool prove, bool lines_are_hidden) {
        WitnessSettings settings;
        settings.prove = prove;
        settings.lines_are_hidden = lines_are_hidden;
        const FrameVerdict verdict = Witness(scene).judge(usualView(), std::vector<uint8_t>{0, 1, 1}, settings);
        if (prove && lines_are_hidden) {
            EXPECT_EQ(verdict.proofs->culled_hidden, 1u);
            EXPECT_EQ(verdict.exactly_visible, 2u);
        }
        Objects out;
        for (const FalseCull& cull : verdict.false_culls) out.push_back(cull.object);
        return out;
    };
    EXPECT_EQ(falseCulls(false, false), (Objects{1, 2}));
    EXPECT_EQ(falseCulls(true, false), (Objects{1, 2}));
    EXPECT_EQ(falseCulls(false, true), (Objects{1, 2})) << "nothing was proved";
    EXPECT_EQ(falseCulls(true, true), Objects{2});
}

TEST(Witness, SeamsBetweenObjectsAreTight) {
    for (uint64_t seed = 0; seed < 6; ++seed) {
        Random random(seed);
        Scene scene = emptyScene();
        const uint32_t tile = addSquare(scene, 0.5f), box = addBox(scene, glm::vec3(0.5f));
        const double turn = random.uniform(-0.5, 0.5);
        glm::dmat4 frame(std::cos(turn), 0, -std::sin(turn), 0, 0, 1, 0, 0, std::sin(turn), 0, std::cos(turn), 0,
                         random.uniform(-1, 1), random.uniform(-1, 1), -4, 1);
        if (seed % 2) frame[3] += glm::dvec4(1e6, 1e6, -1e6, 0);
        std::vector<uint8_t> culled;
        for (int y = -8; y < 8; ++y)
            for (int x = -12; x < 12; ++x) {
                addObject(scene, tile, frame * moved({x, y, 0}));
                culled.push_back(0);
            }
        for (int i = 0; i < 40; ++i) {
            const double z = random.uniform(-3, -0.8);
            addObject(scene, box, frame * moved({random.uniform(-1, 1), random.uniform(-1, 1), z}));
            culled.push_back(1);
        }
        View view = usualView();
        if (seed % 2) view.view = lookAt({1e6, 1e6, -1e6}, {1e6, 1e6, -1e6 - 1}, {0, 1, 0});
        const FrameVerdict verdict =
            Witness(scene).judge(view, culled, {.rays = 100000, .aimed_rays = 80000, .seed = seed});
        EXPECT_TRUE(verdict.false_culls.empty())
            << "seed " << seed << " object " << (verdict.false_culls.empty() ? 0 : verdict.false_culls[0].object);
        EXPECT_GT(verdict.aimed_rays, 10000u);
    }
}

/// Objects enclosed by opaque boxes are never seen, whatever the view; everything else that is culled and seen is.
TEST(Witness, NeverAccusesWhatIsEnclosed) {
    uint64_t unconfirmed = 0;
    for (uint64_t seed = 0; seed < 8; ++seed) {
        Random random(seed);
        Scene scene = emptyScene();
        const uint32_t shell = addBox(scene, glm::vec3(0.5f)), core = addBox(scene, glm::vec3(0.4999f));
        std::vector<uint8_t> culled;
        for (int i = 0; i < 150; ++i) {
            glm::dmat4 transform(1.0);
            for (int column = 0; column < 3; ++column)
                transform[column] = glm::dvec4(random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-2, 2), 0);
            transform[3] = glm::dvec4(random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-9, 9), 1);
            const glm::dvec3 local = glm::inverse(transform) * glm::dvec4(0, 0, 0, 1);
            if (std::max({std::abs(local.x), std::abs(local.y), std::abs(local.z)}) < 0.8) continue;
            addObject(scene, shell, transform);
            addObject(scene, core, transform);
            culled.insert(culled.end(), {0, 1});
        }
        View view = seed % 4 == 3 ? viewBy(orthographic(8, 4.0 / 3, -40, 40), 320, 240)
                                  : viewBy(perspective(1.8, 4.0 / 3, 1e-4), 320, 240);
        view.view = lookAt({0, 0, 0}, {random.uniform(-1, 1), random.uniform(-1, 1), 1}, {0, 1, 0});
        const FrameVerdict verdict =
            Witness(scene).judge(view, culled, {.rays = 60000, .aimed_rays = 30000, .seed = seed});
        EXPECT_TRUE(verdict.false_culls.empty()) << "seed " << seed;
        EXPECT_GT(verdict.exactly_visible, 3u) << "seed " << seed;
        unconfirmed += verdict.unconfirmed;
    }
    RecordProperty("unconfirmed", static_cast<int>(unconfirmed));
}

/// Transforms that flatten, wholly or nearly, cannot be inverted in float: what they carry is seen and hides.
TEST(Witness, FlattenedObjectsAreSeenAndHide) {
    for (const double thickness : {0.0, 1e-9, -1e-9}) {
        Scene scene = emptyScene();
        const uint32_t box = addBox(scene, glm::vec3(1), 1);
        glm::dmat4 flat = moved({0.3, -0.2, -4});
        flat[2][2] = thickness;
        addObject(scene, box, flat);
        addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0.3, -0.2, -5}));
        EXPECT_EQ(accused(scene, usualView(), {1, 1}), Objects{0}) << "thickness " << thickness;
    }
}

/// Ten thousand triangles without area, in a real scene, once hid what lay within their boxes from the exact test.
TEST(Witness, TrianglesWithoutAreaHideNothing) {
    Scene scene = emptyScene();
    const uint32_t needles = addMesh(scene, {{-2, -2, 0}, {2, 2, 0}, {0, 0, 0}, {-2, 2, 0}, {2, -2, 0}},
                                     {0, 1, 2, 3, 4, 4, 0, 0, 0, 1, 2, 0}, 1);
    addObject(scene, needles, moved({0, 0, -2}));
    addObject(scene, addBox(scene, glm::vec3(0.5f)), moved({0.1, -0.3, -5}));
    EXPECT_EQ(accused(scene, usualView(), {0, 1}), Objects{1});
}

/// Faces of maps have such triangles, drawn from both sides: aimed rays once called them seen.
TEST(Witness, TrianglesWithoutAreaAreNotSeen) {
    size_t with_area = 0;
    for (uint64_t seed = 1; seed <= 50; ++seed) {
        Random random(seed);
        glm::dmat4 place = moved({random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-9, -2)});
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row) place[column][row] = random.uniform(-1, 1);
        Scene scene = emptyScene();
        const std::vector<glm::vec3> line = {{-0.6f, -0.25f, 1}, {0.75f, 0.875f, 1}, {-0.375f, -0.0625f, 1}};
        addObject(scene, addMesh(scene, {{-584, 350, 0}, {-602, 332, 0}, {-596, 338, 0}}, {0, 1, 2}, 1),
                  place * glm::dmat4(glm::dmat3(1.0 / 512)));
        addObject(scene, addMesh(scene, {line[0], line[1], line[0]}, {0, 1, 2}, 1), place);
        addObject(scene, addMesh(scene, {line[0], line[1], line[2], {-0.6f, 0.5f, 1}}, {0, 1, 3}, 1), place);
        const Objects seen = accused(scene, usualView(), {1, 1, 1});
        EXPECT_TRUE(seen.empty() || seen == Objects{2}) << "seed " << seed;
        with_area += seen.size();
    }
    EXPECT_GT(with_area, 40u) << "as narrow ones are that have some";
}

TEST(Witness, SaysWhenItDrawsFewerSamples) {
    Scene scene = emptyScene();
    addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0, 0, -3}));
    WitnessSettings settings = idBufferOnly();
    settings.supersampling = 4;
    settings.id_sample_limit = 320 * 240 * 5;
    const FrameVerdict verdict = Witness(scene).judge(usualView(), std::vector<uint8_t>{1}, settings);
    EXPECT_EQ(verdict.supersampling, 2u);
    EXPECT_EQ(verdict.id_samples, 320u * 240 * 4);
    EXPECT_EQ(verdict.false_culls.size(), 1u);
}

TEST(Witness, TheSameFromManyThreads) {
    Scene scene = emptyScene();
    const uint32_t box = addBox(scene, glm::vec3(0.3f));
    std::vector<uint8_t> culled;
    Random random(4);
    for (int i = 0; i < 300; ++i) {
        addObject(scene, box, moved({random.uniform(-4, 4), random.uniform(-3, 3), random.uniform(-20, -2)}));
        culled.push_back(static_cast<uint8_t>(random.below(2)));
    }
    const Witness witness(scene);
    WitnessSettings settings = idBufferOnly();
    settings.rays = 20000;
    settings.prove = true;
    std::vector<FrameVerdict> verdicts(4);
    std::vector<std::thread> threads;  // first, for what they share is made when it is first asked for
    for (FrameVerdict& verdict : verdicts)
        threads.emplace_back([&] { verdict = witness.judge(usualView(), culled, settings); });
    for (std::thread& thread : threads) thread.join();
    const FrameVerdict expected = witness.judge(usualView(), culled, settings);
    EXPECT_FALSE(expected.false_culls.empty());
    for (const FrameVerdict& verdict : verdicts) {
        ASSERT_TRUE(verdict.proofs && expected.proofs);
        EXPECT_EQ(verdict.proofs->culled_hidden, expected.proofs->culled_hidden);
        EXPECT_EQ(verdict.proofs->kept_hidden, expected.proofs->kept_hidden);
        EXPECT_EQ(verdict.seen, expected.seen);
        EXPECT_EQ(verdict.rays, expected.rays);
        EXPECT_EQ(verdict.unconfirmed, expected.unconfirmed);
        EXPECT_EQ(verdict.false_culls.size(), expected.false_culls.size());
    }
}

TEST(Witness, SurvivesNothingAndNonsense) {
    const Scene nothing = emptyScene();
    EXPECT_TRUE(Witness(nothing).judge(usualView(), {}, raysOnly()).false_culls.empty());
    Scene scene = emptyScene();
    const uint32_t box = addBox(scene, glm::vec3(0.3f)), empty = addMesh(scene, {}, {});
    const uint32_t needle = addMesh(scene, {{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {0, 0, 0}}, {0, 1, 2, 0, 0, 3});
    glm::dmat4 broken(1.0), flat(1.0);
    broken[3][1] = std::numeric_limits<double>::quiet_NaN();
    flat[2][2] = 0;
    addObject(scene, box, broken);
    addObject(scene, empty, moved({0, 0, -3}));
    addObject(scene, needle, moved({0, 0, -3}));
    addObject(scene, box, moved({0, 0, -2}) * flat);
    const std::vector<uint8_t> culled(4, 1);
    WitnessSettings settings = raysOnly();
    settings.supersampling = 1;
    const FrameVerdict verdict = Witness(scene).judge(usualView(), culled, settings);
    EXPECT_LE(verdict.false_culls.size(), 1u);
    View view = usualView();
    view.view[0][0] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(Witness(scene).judge(view, culled, settings).rays, 0u);
}

TEST(Witness, StopsWithinAFrame) {
    Scene scene = emptyScene();
    for (int i = 0; i < 40; ++i)
        addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0.1 * i - 2, 0, -4 - 0.01 * i}));
    const std::vector<uint8_t> culled(scene.objects.size(), 0);
    const Witness witness(scene);
    WitnessSettings settings{.rays = 5000, .supersampling = 2};
    settings.prove = true;
    const FrameVerdict whole = witness.judge(usualView(), culled, settings);
    EXPECT_FALSE(whole.stopped);
    bool finished = false;
    for (uint64_t limit = 0; !finished; limit = limit + 1 + limit / 8) {
        uint64_t asked = 0;
        settings.stop = [&] { return asked++ >= limit; };
        const FrameVerdict part = witness.judge(usualView(), culled, settings);
        finished = !part.stopped;
        EXPECT_LE(asked, limit + 1);  // it is asked once more at most, and works no longer
        EXPECT_LE(part.rays, whole.rays);
        for (size_t i = 0; i < part.seen.size(); ++i) EXPECT_LE(part.seen[i], whole.seen[i]);
        if (!finished) continue;
        EXPECT_EQ(part.seen, whole.seen);
        EXPECT_EQ(part.proofs->kept_hidden, whole.proofs->kept_hidden);
    }
}

}  // namespace
}  // namespace sightline
