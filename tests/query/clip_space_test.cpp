// Matrices of every convention see the same, and views that break a rule say so and cull nothing.
// SPDX-License-Identifier: MIT
#include "sightline/geom/clip_space.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "tests/support/made_world.h"

namespace sightline::test {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();

/// A camera, and its matrices as a program with some convention writes them: each from the definition of its clip space,
/// not from another one's.
struct Camera3 {
    glm::dvec3 eye, right, up, back;
    double slope_x, slope_y, near, far;
    bool parallel;

    glm::dmat4 view(const ClipSpace& space) const {
        const glm::dvec3 z = space.left_handed ? -back : back;
        glm::dmat4 m(1.0);
        for (int axis = 0; axis < 3; ++axis) m[axis] = glm::dvec4(right[axis], up[axis], z[axis], 0);
        m[3] = glm::dvec4(-glm::dot(right, eye), -glm::dot(up, eye), -glm::dot(z, eye), 1);
        return m;
    }
    /// Depth z of the eye space runs from `sign` * near to `sign` * far.
    glm::dmat4 projection(const ClipSpace& space) const {
        const double sign = space.left_handed ? 1.0 : -1.0;
        const double low = space.depth == ClipDepth::kZeroToOne ? 0.0 : -1.0;
        const double at_near = space.reversed ? 1.0 : low, at_far = space.reversed ? low : 1.0;
        glm::dmat4 m(0.0);
        m[0][0] = 1.0 / slope_x;
        m[1][1] = (space.y_down ? -1.0 : 1.0) / slope_y;
        // ndc = a + b / depth, or a + b depth in parallel.
        double a, b;
        if (parallel) {
            b = (at_far - at_near) / (far - near);
            a = at_near - b * near;
            m[2][2] = sign * b;
            m[3][2] = a;
            m[3][3] = 1.0;
            return m;
        }
        if (std::isinf(far)) {
            a = at_far;
            b = (at_near - at_far) * near;
        } else {
            b = (at_near - at_far) / (1.0 / near - 1.0 / far);
            a = at_near - b / near;
        }
        m[2][2] = sign * a;
        m[3][2] = b;
        m[2][3] = sign;
        return m;
    }
    View seenBy(const ClipSpace& space) const {
        View out;
        out.width = 320;
        out.height = 180;
        setMatrices(out, view(space), projection(space), space);
        return out;
    }
};

Camera3 randomCamera(Random& random) {
    const View turned = test::randomView(random, {}, {12, 3, 12});
    Camera3 camera;
    camera.eye = eyePosition(turned);
    camera.right = glm::dvec3(turned.view[0][0], turned.view[1][0], turned.view[2][0]);
    camera.up = glm::dvec3(turned.view[0][1], turned.view[1][1], turned.view[2][1]);
    camera.back = glm::dvec3(turned.view[0][2], turned.view[1][2], turned.view[2][2]);
    camera.parallel = random.below(4) == 0;
    camera.slope_y = camera.parallel ? random.uniform(3, 9) : random.uniform(0.3, 1.2);
    camera.slope_x = camera.slope_y * 16.0 / 9.0;
    camera.near = random.uniform(0.05, 0.5);
    camera.far = !camera.parallel && random.below(2) ? kNever : random.uniform(15, 60);
    return camera;
}

std::vector<uint64_t> keysSeen(const Snapshot& now, const View& view) {
    Query query;
    const VisibleSet set = query.visible(now, view);
    EXPECT_EQ(set.problem, ViewProblem::kNone) << wordsOf(set.problem);
    return keysOf(set);
}

TEST(ClipSpace, AllConventionsSeeTheSame) {
    MadeWorld made(1, 300);
    const Snapshot now = made.world.commit();
    Random random(1);
    uint64_t culled = 0;
    for (int i = 0; i < 40; ++i) {
        const Camera3 camera = randomCamera(random);
        const View plain = camera.seenBy({});
        const std::vector<uint64_t> seen = keysSeen(now, plain);
        culled += 300 - seen.size();
        for (const NamedClipSpace& named : kClipSpaces) {
            const View view = camera.seenBy(named.space);
            // Each entry is the same but for the rounding of the definitions.
            for (int c = 0; c < 4; ++c)
                for (int r = 0; r < 4; ++r) {
                    EXPECT_NEAR(view.projection[c][r], plain.projection[c][r], 1e-9) << named.name << " camera " << i;
                    EXPECT_EQ(view.view[c][r], plain.view[c][r]) << named.name << " camera " << i;
                }
            EXPECT_EQ(keysSeen(now, view), seen) << named.name << " camera " << i;
        }
    }
    EXPECT_GT(culled, 40u * 200u);
}

TEST(ClipSpace, TellsWhatIsCertain) {
    Random random(2);
    for (int i = 0; i < 400; ++i) {
        Camera3 camera = randomCamera(random);
        for (const NamedClipSpace& named : kClipSpaces) {
            const ClipSpace& space = named.space;
            const ClipSpace told = tellClipSpace(camera.view(space), camera.projection(space));
            EXPECT_EQ(told.left_handed, space.left_handed) << named.name << " camera " << i;
            EXPECT_EQ(told.y_down, space.y_down) << named.name << " camera " << i;
            EXPECT_EQ(told.reversed, space.reversed) << named.name << " camera " << i;
            if (space.reversed && !camera.parallel) {
                EXPECT_EQ(told.depth, space.depth) << named.name << " camera " << i;
            }
            if (!space.reversed) { EXPECT_EQ(told.depth, ClipDepth::kMinusOneToOne) << named.name << " camera " << i; }
        }
        // Reversed from 1 to -1, which nobody names: near is told right, far may be taken for farther.
        camera.parallel = false;
        const ClipSpace other{ClipDepth::kMinusOneToOne, true};
        EXPECT_EQ(tellClipSpace(camera.view(other), camera.projection(other)), other);
    }
}

TEST(ClipSpace, WhatCannotBeToldIsTakenForMore) {
    // Reversed, far less than twice as far as near: its range cannot be told.
    Random random(3);
    MadeWorld made(3, 200);
    const Snapshot now = made.world.commit();
    for (int i = 0; i < 20; ++i) {
        Camera3 camera = randomCamera(random);
        camera.parallel = false;
        camera.near = 8;
        camera.far = 14;
        const ClipSpace space{ClipDepth::kZeroToOne, true};
        View told = camera.seenBy(space);
        setMatrices(told, camera.view(space), camera.projection(space),
                    tellClipSpace(camera.view(space), camera.projection(space)));
        const std::vector<uint64_t> exact = keysSeen(now, camera.seenBy(space)), more = keysSeen(now, told);
        for (const uint64_t key : exact) EXPECT_NE(std::find(more.begin(), more.end(), key), more.end()) << key;
    }
}

struct Broken {
    ViewProblem problem;
    void (*spoil)(View&);
};

TEST(ClipSpace, ViewsThatBreakARuleCullNothingAndSayWhich) {
    const Broken cases[] = {
        {ViewProblem::kNotFinite, [](View& v) { v.view[3][0] = std::nan(""); }},
        {ViewProblem::kNotFinite,
         [](View& v) {
             v.sections.add({0, kNever, 0, 0});
         }},
        {ViewProblem::kOutOfRange, [](View& v) { v.width = 0; }},
        {ViewProblem::kOutOfRange, [](View& v) { v.jitter = -1; }},
        {ViewProblem::kSingular, [](View& v) { v.projection = glm::dmat4(0.0); }},
        {ViewProblem::kRowMajor, [](View& v) { v.view = glm::transpose(v.view); }},
        {ViewProblem::kNotRigid, [](View& v) { v.view = v.view * glm::dmat4(glm::dmat3(2.0)); }},
        {ViewProblem::kNotRigid, [](View& v) { v.view[0] += 0.1 * v.view[1]; }},
        {ViewProblem::kMirrors, [](View& v) { v.view[0] = -v.view[0]; }},
        {ViewProblem::kReversed,
         [](View& v) {
             for (int c = 0; c < 4; ++c) v.projection[c][2] = v.projection[c][3] - v.projection[c][2];
         }},
    };
    MadeWorld made(4, 100);
    const Snapshot now = made.world.commit();
    Query query;
    for (const Broken& broken : cases) {
        View view = viewAt({1, 2, 3}, {0, 0, 0}, {60.0, 320, 180});
        EXPECT_LT(query.visible(now, view).objects.size(), 100u);
        broken.spoil(view);
        const VisibleSet set = query.visible(now, view);
        EXPECT_EQ(set.problem, broken.problem) << wordsOf(broken.problem) << " / " << wordsOf(set.problem);
        EXPECT_EQ(set.objects.size(), 100u) << wordsOf(broken.problem);
        const StereoSet pair = query.visibleStereo(now, viewAt({1, 2, 3}, {0, 0, 0}), view);
        EXPECT_EQ(pair.left_problem, ViewProblem::kNone);
        EXPECT_EQ(pair.right_problem, broken.problem);
        EXPECT_STRNE(wordsOf(broken.problem), "");
    }
}

TEST(ClipSpace, AViewThatIsOffByTheRoundingOfFloatsIsRigid) {
    Random random(5);
    for (int i = 0; i < 200; ++i) {
        View view = test::randomView(random);
        for (int c = 0; c < 4; ++c)
            for (int r = 0; r < 4; ++r) view.view[c][r] = static_cast<float>(view.view[c][r]);
        EXPECT_EQ(problemOf(view), ViewProblem::kNone);
        view.view = glm::inverse(glm::inverse(view.view));
        EXPECT_EQ(problemOf(view), ViewProblem::kNone);
    }
}

}  // namespace
}  // namespace sightline::test
