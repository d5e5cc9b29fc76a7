// Exact proofs against scenes whose answer is known, and against rays in made ones.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/cull_proof.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/truth/scene_facts.h"
#include "sightline/tools/truth/verify.h"
#include "test_scenes.h"
#include "tests/support/random.h"
#include "tests/support/views.h"
#include "tests/tools/truth/object_proofs.h"

namespace sightline {
using namespace tools;
namespace {

using namespace test;

View parallelView() { return viewBy(orthographic(8, 4.0 / 3, 0.1, 100), 320, 240); }

TEST(CullProofs, TellHiddenFromSeen) {
    for (const View& view : {usualView(), parallelView()}) {
        Scene scene = emptyScene();
        const uint32_t wall = addSquare(scene, 2), box = addBox(scene, glm::vec3(0.3f));
        addObject(scene, box, moved({0, 0, -3}));
        addObject(scene, wall, moved({0, 0, -5}));
        addObject(scene, box, moved({0, 0, -8}));    // behind the wall
        addObject(scene, box, moved({3.4, 0, -8}));  // beside it
        addObject(scene, box, moved({0, 0, 5}));     // behind the eye
        for (const uint32_t seen : {0u, 1u, 3u}) EXPECT_SEEN(scene, view, seen);
        for (const uint32_t hidden : {2u, 4u}) EXPECT_HIDDEN(scene, view, hidden);
        EXPECT_EQ(prove(scene, view, 2).hiders, Objects{1});
        EXPECT_EQ(prove(scene, view, 4).hiders, Objects{});
    }
}

TEST(CullProofs, SayWhereAThingIsSeen) {
    Scene scene = emptyScene();
    addObject(scene, addBox(scene, glm::vec3(0.1f)), moved({-1, 0.6, -3}));
    const CullProof proof = prove(scene, usualView(), 0);
    const double scale = 120 / std::tan(0.5) / 3;
    EXPECT_NEAR(proof.x, 160 - scale, 12);
    EXPECT_NEAR(proof.y, 120 - 0.6 * scale, 12);
    View shaken = usualView();
    shaken.jitter = 100;  // changes what is asked, not where it is
    EXPECT_NEAR(prove(scene, shaken, 0).x, proof.x, 12);
}

/// A wall of panels whose sides are met by corners of others, turned and stretched in every way: nothing shows between them.
TEST(CullProofs, CloseSeamsThatAreExact) {
    for (uint64_t seed = 0; seed < 20; ++seed) {
        Random random(seed);
        Scene scene = emptyScene();
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        const auto panel = [&](float left, float right, float low, float high) {
            const auto first = static_cast<uint32_t>(positions.size());
            positions.insert(positions.end(), {{left, low, 0}, {right, low, 0}, {right, high, 0}, {left, high, 0}});
            for (const uint32_t i : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + i);
        };
        float cuts[6] = {-3};
        for (int row = 0; row < 5; ++row) cuts[row + 1] = row == 4 ? 3.0f : cuts[row] + float(random.uniform(0.4, 1.4));
        for (int row = 0; row < 5; ++row) {
            const auto middle = static_cast<float>(random.uniform(-0.8, 2));
            panel(-3, middle, cuts[row], cuts[row + 1]);
            panel(middle, 3, cuts[row], cuts[row + 1]);
        }
        glm::dmat4 transform = moved({random.uniform(-0.1, 0.1), random.uniform(-0.1, 0.1), -5});
        const double angle = random.uniform(-0.4, 0.4);
        transform[0] = glm::dvec4(std::cos(angle), std::sin(angle), 0.1, 0);
        transform[1] = glm::dvec4(-std::sin(angle), std::cos(angle), random.uniform(-0.3, 0.3), 0);
        const uint32_t wall = addMesh(scene, positions, indices);
        const uint32_t first = addObject(scene, wall, transform);
        const uint32_t behind = addObject(scene, addBox(scene, {2.2f, 2.2f, 0.2f}), moved({0, 0, -9}));
        for (const View& view : {usualView(), parallelView()}) {
            ASSERT_EQ(prove(scene, view, behind).hiders, Objects{first}) << "seed " << seed;
            // A corner that moves by as little as a float can opens a slit.
            Scene open = scene;
            const float seam =
                *std::min_element(cuts, cuts + 6, [](float a, float b) { return std::abs(a) < std::abs(b); });
            auto& corners = open.meshes[wall].positions;
            const auto corner = std::find_if(corners.begin(), corners.end(),
                                             [&](const glm::vec3& p) { return p.y == seam && std::abs(p.x) < 3; });
            corner->y = std::nextafter(corner->y, -9.0f);
            EXPECT_NE(int(prove(open, view, behind).result), int(ProofResult::kProved)) << "seed " << seed;
        }
    }
}

/// Two walls that meet, lie apart, or overlap by what a double can just tell, whose last bits no sight line in double sees.
TEST(CullProofs, TellASlitOfADoublesLastBit) {
    const uint32_t kLeft = 0, kRight = 1;
    for (uint64_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        Scene scene = emptyScene();
        const uint32_t wall = addSquare(scene, 4);
        const double angle = random.uniform(-0.3, 0.3), lean = random.uniform(-0.2, 0.2);
        glm::dmat4 turned(1.0);
        turned[0] = glm::dvec4(std::cos(angle), std::sin(angle), lean, 0);
        turned[1] = glm::dvec4(-std::sin(angle), std::cos(angle), random.uniform(-0.2, 0.2), 0);
        for (const double side : {-4.0, 4.0}) {  // of which no product is rounded
            addObject(scene, wall, turned);
            scene.objects.back().transform[3] = side * turned[0] + glm::dvec4(0, 0, 0, 1);
        }
        const uint32_t behind = addObject(scene, addBox(scene, glm::vec3(0.6f)), moved({0, 0, -4}));
        View view = random.below(2) ? usualView() : parallelView();
        view.view = lookAt(glm::dvec3(0, 0, 5) + randomVector(random, 0.2), {0, 0, 0}, {0, 1, 0});
        EXPECT_EQ(prove(scene, view, behind).hiders, (Objects{kLeft, kRight})) << "seed " << seed;
        double& right = scene.objects[kRight].transform[3].x;
        const double met = right;
        right = std::nextafter(met, 9.0);
        EXPECT_EQ(int(prove(scene, view, behind).result), int(ProofResult::kOpen)) << "seed " << seed;
        EXPECT_LT(prove(scene, view, behind).width, 1e-12);
        right = std::nextafter(met, -9.0);
        EXPECT_HIDDEN(scene, view, behind) << "seed " << seed;
    }
}

/// However many tiles hide the rest: what shows through the place of one that is missing is seen.
TEST(CullProofs, FindTheOneTileThatIsMissing) {
    for (const int missing : {2 * 24 + 2, 2 * 24 + 21, 12 * 24 + 11, 21 * 24 + 2, 21 * 24 + 21, -1}) {
        Scene scene = emptyScene();
        const uint32_t tile = addSquare(scene, 0.125f);
        for (int i = 0; i < 24 * 24; ++i)
            if (i != missing) addObject(scene, tile, moved({0.25 * (i % 24) - 2.875, 0.25 * (i / 24) - 2.875, -5}));
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        for (uint32_t i = 0; i < 16 * 16; ++i) {  // small squares, whose box is hidden but for one place
            const glm::vec3 low(0.25f * float(i % 16) - 2, 0.25f * float(i / 16) - 2, -0.01f * float(i % 7));
            const auto first = static_cast<uint32_t>(positions.size());
            positions.insert(positions.end(), {low, low + glm::vec3(0.25f, 0, 0), low + glm::vec3(0.25f, 0.25f, 0),
                                               low + glm::vec3(0, 0.25f, 0)});
            for (const uint32_t k : {0u, 1u, 2u, 0u, 2u, 3u}) indices.push_back(first + k);
        }
        glm::dmat4 large = moved({0, 0, -5.5});
        large[0] *= 1.5;
        large[1] *= 1.5;
        const uint32_t behind = addObject(scene, addMesh(scene, positions, indices), large);
        for (const View& view :
             {viewBy(perspective(1.2, 1, 0.1), 320, 320), viewBy(orthographic(7, 1, 0.1, 100), 320, 320)})
            EXPECT_EQ(int(prove(scene, view, behind).result),
                      int(missing < 0 ? ProofResult::kProved : ProofResult::kSeen))
                << missing;
    }
}

TEST(CullProofs, SeeThroughBackFacesAndWhatDoesNotHide) {
    const auto behind = [](uint32_t material, bool turned, bool mirrored, bool deforms) {
        Scene scene = emptyScene();
        glm::dmat4 transform = moved({0, 0, -4});
        if (turned) transform[0][0] = transform[2][2] = -1;
        if (mirrored) transform[1][1] = -1;
        const uint32_t wall = addSquare(scene, 2, material);
        scene.meshes[wall].deforms = deforms;
        addObject(scene, wall, transform);
        return prove(scene, usualView(), addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0, 0, -8}))).result;
    };
    for (const bool mirrored : {false, true}) {
        EXPECT_EQ(behind(0, false, mirrored, false), ProofResult::kProved);
        EXPECT_EQ(behind(0, true, mirrored, false), ProofResult::kSeen);
        EXPECT_EQ(behind(1, true, mirrored, false), ProofResult::kProved);
        EXPECT_EQ(behind(0, false, mirrored, true), ProofResult::kSeen);
        for (const uint32_t material : {2u, 3u, 4u})
            EXPECT_EQ(behind(material, false, mirrored, false), ProofResult::kSeen);
    }
}

/// What the near plane or a section cuts away of a wall hides nothing; a window cuts nothing.
TEST(CullProofs, CutWhatHidesByTheViewsPlanes) {
    Scene scene = emptyScene();
    glm::dmat4 leaning = moved({0, 0, -3});
    leaning[1] = glm::dvec4(0, 1, 1.3, 0);  // its upper half comes to the eye and past it
    addObject(scene, addSquare(scene, 6, 1), leaning);
    const uint32_t box = addBox(scene, glm::vec3(0.2f));
    const uint32_t low = addObject(scene, box, moved({0, -1.5, -8})), high = addObject(scene, box, moved({0, 1.5, -8}));
    View view = usualView();
    EXPECT_HIDDEN(scene, view, low);
    EXPECT_HIDDEN(scene, view, high);
    view.projection = perspective(1.0, 4.0 / 3, 2.7);  // y = 0.2 and above of the wall is nearer
    EXPECT_HIDDEN(scene, view, low);
    EXPECT_SEEN(scene, view, high);
    view = usualView();
    view.sections.add({0, -1, 0, 0.3});  // leaves what is below 0.3
    EXPECT_HIDDEN(scene, view, low);
    EXPECT_HIDDEN(scene, view, high);  // it was cut away itself
    view.sections = {};
    view.sections.add({0, 0, -1, -2.6});  // leaves what is behind z = -2.6
    EXPECT_HIDDEN(scene, view, low);
    EXPECT_SEEN(scene, view, high);
    view.sections = {};
    view.window.add({0, 0, -1, -2.6});
    EXPECT_HIDDEN(scene, view, high);
    scene.objects.erase(scene.objects.begin());
    EXPECT_SEEN(scene, view, 1);
    view.window.add({0, -1, 0, 0});  // what is below
    EXPECT_HIDDEN(scene, view, 1);
    EXPECT_SEEN(scene, view, 0);
}

/// What lies in a plane of the view is inside of it, and a plane without a normal has everything inside.
TEST(CullProofs, SeeWhatLiesInAPlaneOfTheView) {
    Scene scene = emptyScene();
    addObject(scene, addSquare(scene, 2), moved({0, 0, -5}));
    for (const View& view : {usualView(), parallelView()}) {
        for (const glm::dvec4& plane : {glm::dvec4(0, 0, -1, -5), glm::dvec4(0, 0, 1, 5), glm::dvec4(0.0)}) {
            View cut = view;
            cut.sections.add(plane);
            EXPECT_SEEN(scene, cut, 0);
            cut = view;
            cut.window.add(plane);
            EXPECT_SEEN(scene, cut, 0);
        }
        View nothing = view;
        nothing.sections.add({0, 0, 0, -1});
        EXPECT_HIDDEN(scene, nothing, 0);
    }
    View near = usualView();
    near.projection = perspective(1.0, 4.0 / 3, 5.0);
    EXPECT_SEEN(scene, near, 0);
}

/// What is not known is not proved.
TEST(CullProofs, SayNothingOfWhatLiesNowhere) {
    constexpr float kInfinite = std::numeric_limits<float>::infinity(), kNaN = std::numeric_limits<float>::quiet_NaN();
    Scene scene = emptyScene();
    glm::dmat4 huge(2e15);
    huge[3] = {0, 0, -1e15, 1};
    addObject(scene, addSquare(scene, 1), huge);
    const std::vector<glm::vec3> corners = {{-1, -1, 0}, {1, -1, 0}, {1, 1, 0}};
    for (const float last : {kInfinite, kNaN}) {
        std::vector<glm::vec3> positions = corners;
        positions.push_back({last, 1, 0});
        addObject(scene, addMesh(scene, positions, {0, 1, 2, 0, 2, 3}, 1), moved({0, 0, -4}));
    }
    const uint32_t empty = addObject(scene, addMesh(scene, {}, {}), moved({0, 0, -4}));
    const uint32_t behind = addObject(scene, addBox(scene, glm::vec3(0.2f)), moved({0.3, -0.3, -6}));
    const SceneFacts facts(scene);
    CullProver prover(facts, usualView());
    for (const uint32_t nowhere : {0u, 1u}) {
        EXPECT_EQ(int(prover.prove(nowhere).result), int(ProofResult::kUndecided)) << nowhere;
        EXPECT_FALSE(prover.hiddenTogether()[nowhere]);
    }
    EXPECT_EQ(int(prover.prove(2).result), int(ProofResult::kSeen)) << "of two triangles one has a place";
    EXPECT_EQ(int(prover.prove(empty).result), int(ProofResult::kProved));
    EXPECT_EQ(prover.prove(behind).hiders, Objects{2}) << "and that one hides";
}

/// Depth that runs towards the eye, and a projection that moves the eye: the culling knows these otherwise, or not at all.
TEST(CullProofs, SayNothingOfViewsThatStartElsewhere) {
    Scene scene = emptyScene();
    addObject(scene, addSquare(scene, 0.5f), moved({0, 0, -2}));
    const uint32_t behind = addObject(scene, addBox(scene, glm::vec3(0.2f)), moved({0, 0, -4}));
    View view = usualView();
    EXPECT_HIDDEN(scene, view, behind);
    view.projection = view.projection * moved({-3, 0, 0});
    EXPECT_EQ(int(prove(scene, view, behind).result), int(ProofResult::kUndecided));
    for (View reversed : {usualView(), parallelView()}) {
        for (int column = 0; column < 4; ++column) reversed.projection[column][2] *= -1;
        ASSERT_TRUE(isUsable(reversed));
        EXPECT_EQ(int(prove(scene, reversed, behind).result), int(ProofResult::kUndecided));
    }
    View far = usualView();
    far.view = lookAt({0, 0, 0}, {1, 1, 1}, {0, 1, 0});
    far.view[3] = {1.7e308, 1.7e308, 1.7e308, 1};  // the eye is beyond what a double holds
    ASSERT_TRUE(isUsable(far));
    EXPECT_EQ(int(prove(scene, far, behind).result), int(ProofResult::kUndecided));
}

/// The direction of a parallel view is rounded, so that far sight lines leave the view by a side: what is asked alone and
/// what is asked in a box among its like must have one answer.
TEST(CullProofs, BoxesOfParallelViewsHideNoMoreThanTriangles) {
    int seen = 0, hidden = 0;
    for (uint64_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        View view = viewBy(orthographic(8, 1, 0.1, 1e12), 256, 256);
        view.jitter = 0;
        view.view = lookAt({0, 0, 0}, randomUnit(random), randomUnit(random));
        const glm::dmat4 turned(glm::transpose(glm::dmat3(view.view)));
        for (const float far : {1e6f, 1e11f})
            for (const float side : {-5.0f, 5.0f}) {
                ProofResult results[2];
                for (const bool many : {false, true}) {
                    Scene scene = emptyScene();
                    glm::dmat4 wall = turned;
                    wall[0] *= 4 + 1e-20 * double(far);
                    wall[1] *= 5;
                    wall[3] = turned * glm::dvec4(0, 0, -1, 1);
                    addObject(scene, addSquare(scene, 1, 1), wall);
                    std::vector<glm::vec3> positions;
                    std::vector<uint32_t> indices;
                    for (uint32_t i = 0; i < (many ? 27u : 3u); ++i) indices.push_back(i);
                    for (size_t i = 0; i < indices.size(); i += 3)
                        positions.insert(positions.end(), {{0, 0, -2}, {side, -3, -far}, {side, 3, -far}});
                    addObject(scene, addMesh(scene, positions, indices, 1), turned);
                    results[many] = prove(scene, view, 1).result;
                }
                EXPECT_EQ(int(results[0]), int(results[1])) << "seed " << seed << ", " << far << " away";
                hidden += results[0] == ProofResult::kProved;
                seen += results[0] != ProofResult::kProved;
            }
    }
    EXPECT_GT(hidden, 10);
    EXPECT_GT(seen, 10);
}

/// A slit that a strip covers wholly, between lines that a double takes for one: nothing else of the wall is asked instead.
TEST(CullProofs, LookIntoASlitWhereItIs) {
    Scene scene = emptyScene();
    addObject(scene, addMesh(scene, {{-300, -300, 0}, {300, -300, 0}, {0, 300, 0}}, {0, 1, 2}), moved({0, 0, -9}));
    addObject(scene, addMesh(scene, {{0, -20, 0}, {0, 20, 0}, {-30, 0, 0}}, {0, 1, 2}, 1), moved({0, 0, -5}));
    glm::dmat4 tilted = moved({-1e-20, 0, -5});
    tilted[1][0] = 1e-20;
    addObject(scene, addMesh(scene, {{0, -20, 0}, {30, 0, 0}, {0, 20, 0}}, {0, 1, 2}, 1), tilted);
    const uint32_t strip =
        addMesh(scene, {{-0.2f, 1.2f, 0}, {0.2f, 1.2f, 0}, {0.2f, 6, 0}, {-0.2f, 6, 0}}, {0, 1, 2, 0, 2, 3}, 1);
    const CullProof open = prove(scene, usualView(), 0);
    EXPECT_NE(int(open.result), int(ProofResult::kProved));
    EXPECT_TRUE(open.x > 159 && open.x < 161 && open.y > -1 && open.y < 241) << open.x << ", " << open.y;
    addObject(scene, strip, moved({0, 0, -7}));
    EXPECT_NE(int(prove(scene, usualView(), 0).result), int(ProofResult::kSeen));
}

TEST(CullProofs, HoldForEveryShiftOfTheImage) {
    Scene scene = emptyScene();
    const double edge = 8 * std::tan(0.5) * 4.0 / 3, pixel = edge / 160;
    addObject(scene, addSquare(scene, 1), moved({edge + 1 + 0.5 * pixel, 0, -8}));
    View view = usualView();
    view.jitter = 0;
    EXPECT_HIDDEN(scene, view, 0);
    view.jitter = 0.4;
    EXPECT_HIDDEN(scene, view, 0);
    view.jitter = 0.6;
    EXPECT_SEEN(scene, view, 0);
}

TEST(CullProofs, ByNamedHidersAlone) {
    Scene scene = emptyScene();
    const uint32_t wall = addSquare(scene, 1);
    addObject(scene, wall, moved({-1, 0, -4}));
    addObject(scene, wall, moved({1, 0, -4}));
    addObject(scene, wall, moved({0, 0, -30}));
    const uint32_t behind = addObject(scene, addBox(scene, {0.8f, 0.5f, 0.5f}), moved({0, 0, -7}));
    const SceneFacts facts(scene);
    CullProver prover(facts, usualView());
    EXPECT_EQ(prover.prove(behind).hiders, (Objects{0, 1}));
    const auto by = [&](const Objects& hiders) { return prover.proveBy(behind, hiders).result; };
    EXPECT_EQ(by({0, 1}), ProofResult::kProved);
    EXPECT_EQ(by({0, 1, 2}), ProofResult::kProved);
    for (const Objects& few : {Objects{}, Objects{0}, Objects{1}, Objects{0, 2}, Objects{2}})
        EXPECT_NE(int(by(few)), int(ProofResult::kProved));
}

/// Triangles of any size and place, in meshes of one and of many, seen in every way: all is decided, and rays agree.
TEST(CullProofs, AgreeWithRays) {
    uint64_t hidden = 0, hidden_together = 0, seen = 0, by_rays = 0;
    for (uint64_t seed = 0; seed < 60; ++seed) {
        Random random(seed);
        Scene scene = emptyScene();
        const double size = std::pow(10.0, random.uniform(-2, 3));
        for (int object = 0; object < 60; ++object) {
            std::vector<glm::vec3> positions;
            std::vector<uint32_t> indices;
            const uint64_t triangles = random.below(3) ? 1 + random.below(4) : 1 + random.below(40);
            const double reach = random.below(4) ? 0.5 : 3;
            for (uint32_t i = 0; i < 3 * triangles; ++i) {
                positions.push_back(glm::vec3(size * randomVector(random, reach)));
                indices.push_back(i);
            }
            glm::dmat4 transform = moved(size * randomVector(random, 4.0));
            for (int column = 0; column < 3; ++column) transform[column] = glm::dvec4(randomVector(random, 1.0), 0);
            addObject(scene, addMesh(scene, positions, indices, random.below(5) ? 1 : uint32_t(random.below(4))),
                      transform);
        }
        View view = seed % 4 == 3 ? viewBy(orthographic(6 * size, 4.0 / 3, 0.01 * size, 30 * size), 320, 240)
                                  : viewBy(perspective(1.2, 4.0 / 3, 0.01 * size), 320, 240);
        view.view = lookAt(size * randomVector(random, 1.0), size * randomVector(random, 3.0), {0, 1, 0});
        view.jitter = 0;
        const SceneFacts facts(scene);
        CullProver prover(facts, view);
        const std::vector<uint8_t> all(scene.objects.size(), 1), together = prover.hiddenTogether();
        const FrameVerdict verdict =
            Witness(scene).judge(view, all, {.rays = 40000, .aimed_rays = 20000, .supersampling = 2, .seed = seed});
        for (uint32_t object = 0; object < scene.objects.size(); ++object) {
            const CullProof proof = prover.prove(object);
            EXPECT_TRUE(proof.result == ProofResult::kProved || proof.result == ProofResult::kSeen)
                << "seed " << seed << " object " << object << ": width " << proof.width << " after " << proof.cuts;
            EXPECT_FALSE(proof.result == ProofResult::kProved && verdict.seen[object])
                << "seed " << seed << " object " << object;
            EXPECT_FALSE(together[object] && proof.result != ProofResult::kProved)
                << "seed " << seed << " object " << object;
            hidden_together += together[object];
            hidden += proof.result == ProofResult::kProved;
            seen += proof.result == ProofResult::kSeen;
            by_rays += verdict.seen[object];
            if (proof.result != ProofResult::kProved || proof.hiders.empty()) continue;
            EXPECT_EQ(int(prover.proveBy(object, proof.hiders).result), int(ProofResult::kProved)) << "seed " << seed;
        }
    }
    EXPECT_GT(hidden, 500u);
    EXPECT_GT(hidden_together, hidden / 8);
    EXPECT_GT(seen, 500u);
    EXPECT_GE(by_rays, seen * 95 / 100) << "of " << seen;
}

TEST(CullProofs, GiveUpWhereTheWorkIsSpent) {
    Scene scene = emptyScene();
    const uint32_t tile = addSquare(scene, 0.5f);
    for (int x = -4; x <= 4; ++x)
        for (int y = -4; y <= 4; ++y) addObject(scene, tile, moved({x, y, -5}));
    const uint32_t behind = addObject(scene, addSquare(scene, 3), moved({0, 0, -6}));
    const SceneFacts facts(scene);
    EXPECT_EQ(int(CullProver(facts, usualView(), 5).prove(behind).result), int(ProofResult::kUndecided));
    EXPECT_EQ(int(CullProver(facts, usualView()).prove(behind).result), int(ProofResult::kProved));
}

TEST(CullProofs, AreNotClaimedWhenStopped) {
    Scene scene = emptyScene();
    const uint32_t tile = addSquare(scene, 0.5f);
    for (int x = -4; x <= 4; ++x)
        for (int y = -4; y <= 4; ++y) addObject(scene, tile, moved({x, y, -5}));
    const uint32_t behind = addObject(scene, addSquare(scene, 3), moved({0, 0, -6}));
    const uint32_t in_front = addObject(scene, addSquare(scene, 0.1f), moved({0, 0, -4}));
    const SceneFacts facts(scene);
    uint64_t proved = 0;
    for (uint64_t limit = 0; proved == 0; ++limit) {
        uint64_t asked = 0;
        CullProver prover(facts, usualView(), 1000000, [&] { return asked++ >= limit; });
        const std::vector<uint8_t> together = prover.hiddenTogether();
        EXPECT_FALSE(together[in_front]);
        const ProofResult result = prover.prove(behind).result;
        const bool stopped = asked > limit;
        EXPECT_EQ(int(result), int(stopped ? ProofResult::kUndecided : ProofResult::kProved)) << limit;
        proved += result == ProofResult::kProved;
        ASSERT_LT(limit, 100000u);
    }
}

TEST(CullProofs, SayNothingOfPlanesThatOverflow) {
    Scene scene = emptyScene();
    addObject(scene, addSquare(scene, 2), moved({0, 0, -5}));
    const uint32_t behind = addObject(scene, addBox(scene, glm::vec3(0.3f)), moved({0, 0, -8}));
    View view = usualView();
    view.view = lookAt({0, 0, 1e-3}, {0, 0, -1}, {0, 1, 0});
    view.sections.add({0, 0, 1e308, 1.79e308});
    EXPECT_HIDDEN(scene, view, behind);
    view.view = lookAt({0, 0, 1}, {0, 0, -1}, {0, 1, 0});
    ASSERT_TRUE(isUsable(view));
    EXPECT_EQ(int(prove(scene, view, behind).result), int(ProofResult::kUndecided));
}

/// The witness decides of everything, and convicts by a proof what rays have missed.
TEST(CullProofs, AreTheWitnessesThird) {
    Scene scene = emptyScene();
    addObject(scene, addSquare(scene, 3), moved({-3.0000001, 0, -5}));
    addObject(scene, addSquare(scene, 3), moved({3.0000001, 0, -5}));  // a slit of 2e-7 is between them
    const uint32_t box = addBox(scene, glm::vec3(0.3f));
    addObject(scene, box, moved({0, 0, -8}));
    addObject(scene, box, moved({1, 0, -8}));
    addObject(scene, box, moved({-1, 0, -8}));
    const std::vector<uint8_t> culled = {0, 0, 1, 1, 0};
    WitnessSettings settings{.rays = 1000, .aimed_rays = 200, .supersampling = 1};
    const FrameVerdict without = Witness(scene).judge(usualView(), culled, settings);
    EXPECT_TRUE(without.false_culls.empty());
    EXPECT_FALSE(without.proofs);
    settings.prove = true;
    const FrameVerdict verdict = Witness(scene).judge(usualView(), culled, settings);
    ASSERT_EQ(verdict.false_culls.size(), 1u);
    EXPECT_EQ(verdict.false_culls[0].object, 2u);
    EXPECT_STREQ(verdict.false_culls[0].witness, "proof");
    EXPECT_NEAR(verdict.false_culls[0].x, 160, 1e-3);
    ASSERT_TRUE(verdict.proofs);
    EXPECT_EQ(verdict.proofs->culled_hidden, 1u);
    EXPECT_EQ(verdict.proofs->culled_undecided, 0u);
    EXPECT_EQ(verdict.proofs->kept_hidden, 1u);
    EXPECT_EQ(verdict.proofs->kept_undecided, 0u);
    EXPECT_EQ(verdict.exactly_visible, 3u);
}

}  // namespace
}  // namespace sightline
