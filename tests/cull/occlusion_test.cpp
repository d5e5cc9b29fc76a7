// The law of projected bounds: no point of a box falls outside its rectangle or nearer than its nearness.
// SPDX-License-Identifier: MIT
#include "sightline/cull/occlusion.h"

#include <limits>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/cull/frustum.h"
#include "tests/support/targets.h"

namespace sightline {
namespace {

struct Projected {
    double x, y, nearness, near;
};

Projected project(const Screen& screen, const glm::dvec3& p) {
    const glm::dvec4 h(p - screen.eye, 1.0);
    const double w = glm::dot(screen.w, h);
    return {glm::dot(screen.x, h) / w, glm::dot(screen.y, h) / w, glm::dot(screen.d, h) / w, glm::dot(screen.near, h)};
}

bool holds(const Screen& screen, const PixelRect& rect, const Projected& p) {
    if (p.x < 0 || p.y < 0 || p.x > screen.width || p.y > screen.height) return true;  // not seen at all
    return p.x >= rect.x0 && p.x <= rect.x1 + 1 && p.y >= rect.y0 && p.y <= rect.y1 + 1 && p.nearness <= rect.nearness;
}

TEST(Occlusion, BoxesBesideAColumnHaveNoPointThere) {
    Random random(11);
    int left = 0, right = 0, of_the_eye = 0;
    for (int round = 0; round < 4000; ++round) {
        View view;
        view.view = lookAt({0, 0, 0}, {random.uniform(-1, 1), random.uniform(-1, 1), -1}, {0, 1, 0});
        view.projection = round % 5 == 4 ? orthographic(random.uniform(1, 50), 1.8, 0.1, 500.0)
                                         : perspective(glm::radians(random.uniform(1, 150)), 1.8, 0.1);
        const Screen screen = makeScreen(view, 640);
        Box3f box;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = static_cast<float>(random.uniform(-30, 30));
            box.max[axis] = box.min[axis] + static_cast<float>(random.uniform(0, 20));
        }
        const double x = random.uniform(0, screen.width);
        const bool is_left = isLeftOf(screen, box, x), is_right = isRightOf(screen, box, x);
        EXPECT_FALSE(is_left && is_right);
        left += is_left;
        right += is_right;
        of_the_eye += (is_left || is_right) && projectBox(screen, box).doubt;
        for (int i = 0; i < 64; ++i) {
            glm::dvec4 h(1.0);
            for (int axis = 0; axis < 3; ++axis) {
                const double at = i < 8 ? i >> axis & 1 : random.uniform();
                h[axis] = box.min[axis] + at * (double{box.max[axis]} - box.min[axis]);
            }
            const double w = glm::dot(screen.w, h);
            if (!(w > 0.0)) continue;
            const double px = glm::dot(screen.x, h) / w;
            EXPECT_FALSE(is_left && px >= x) << "round " << round;
            EXPECT_FALSE(is_right && px <= x) << "round " << round;
        }
    }
    EXPECT_GT(left, 400);
    EXPECT_GT(right, 400);
    EXPECT_GT(of_the_eye, 50);
    Box3f broken{glm::vec3(std::numeric_limits<float>::quiet_NaN()), glm::vec3(1)};
    const Screen screen = makeScreen(View(), 640);
    EXPECT_FALSE(isLeftOf(screen, broken, 5) || isRightOf(screen, broken, 5));
}

TEST(Occlusion, RectanglesHoldEveryPointOfTheirBoxes) {
    test::forEachTarget([](const std::string& target) {
        Random random(4);
        int decided = 0;
        for (int round = 0; round < 1500; ++round) {
            View view;
            view.width = 1 + static_cast<uint32_t>(random.below(1500));
            view.height = 1 + static_cast<uint32_t>(random.below(1500));
            const double far = round % 4 == 0 ? 1e6 : 0.0, aspect = double(view.width) / view.height;
            const glm::dvec3 eye(far + random.uniform(), -far, far);
            view.view = lookAt(eye, eye + glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), -1), {0, 1, 0});
            view.projection = round % 5 == 4 ? orthographic(random.uniform(1, 50), aspect, 0.1, 500.0)
                                             : perspective(glm::radians(random.uniform(1, 150)), aspect, 0.1);
            const Screen screen = makeScreen(view, 1280);
            BvhNode node{};
            Box3d boxes[8];
            for (int i = 0; i < 8; ++i) {
                const glm::dvec3 p =
                    eye + glm::dvec3(random.uniform(-30, 30), random.uniform(-30, 30), random.uniform(-60, 5));
                boxes[i] = {p, p + random.uniform(0.0, 10.0) *
                                       glm::dvec3(random.uniform(), random.uniform(), random.uniform())};
                const Box3f box = roundOutward(boxes[i], eye);
                for (int axis = 0; axis < 3; ++axis) {
                    node.min[axis][i] = box.min[axis];
                    node.max[axis][i] = box.max[axis];
                }
            }
            const ScreenAnswer answer = projectBoxes(screen, eyeBoxes(node, eye - screen.eye));
            for (int i = 0; i < 8; ++i) {
                Box3f relative;
                relative.min = glm::vec3(node.min[0][i], node.min[1][i], node.min[2][i]);
                relative.max = glm::vec3(node.max[0][i], node.max[1][i], node.max[2][i]);
                glm::dmat4 place(1.0);
                place[3] = glm::dvec4(eye, 1.0);
                const BoxAnswer slow = projectBox(objectScreen(screen, place), relative);
                for (int k = 0; k < 40; ++k) {
                    glm::dvec3 t(random.uniform(), random.uniform(), random.uniform());
                    if (k < 8) t = glm::dvec3(k & 1, k >> 1 & 1, k >> 2);
                    const Projected p = project(screen, boxes[i].min + t * boxes[i].size());
                    if (p.near < 0) continue;  // not drawn
                    const bool seen = p.x >= 0 && p.y >= 0 && p.x <= screen.width && p.y <= screen.height;
                    if (!(answer.doubt >> i & 1)) {
                        ++decided;
                        if (answer.outside >> i & 1) {
                            ASSERT_FALSE(seen) << target << " round " << round;
                        } else {
                            ASSERT_TRUE(holds(screen, answer.rects[i], p)) << target << " round " << round;
                        }
                    }
                    if (slow.doubt) continue;
                    if (slow.outside) {
                        ASSERT_FALSE(seen) << "round " << round;
                    } else {
                        ASSERT_TRUE(holds(screen, slow.rect, p)) << "round " << round;
                    }
                }
            }
        }
        EXPECT_GT(decided, 100000);
    });
}

TEST(Occlusion, ABoxThatHoldsTheEyeOrMeetsTheNearPlaneIsInDoubt) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.125);
    const Screen screen = makeScreen(view, 1280);
    BvhNode node{};
    const Box3f boxes[3] = {
        {{-1, -1, -1}, {1, 1, 1}}, {{-1, -1, -0.1f}, {1, 1, -0.05f}}, {{-1, -1, -3}, {1, 1, -0.125f}}};
    for (int i = 0; i < 8; ++i)
        for (int axis = 0; axis < 3; ++axis) {
            node.min[axis][i] = boxes[i % 3].min[axis];
            node.max[axis][i] = boxes[i % 3].max[axis];
        }
    const ScreenAnswer answer = projectBoxes(screen, eyeBoxes(node, {0, 0, 0}));
    EXPECT_EQ(answer.doubt, 0b01101101u);
    EXPECT_EQ(answer.outside, 0b10010010u);
    EXPECT_TRUE(projectBox(screen, boxes[0]).doubt);
    EXPECT_TRUE(projectBox(screen, boxes[2]).doubt);
    EXPECT_TRUE(projectBox(screen, boxes[1]).outside) << "all of it lies before the near plane";
}

TEST(Occlusion, ABoxBesideTheEyeIsOutside) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.125);
    const Screen screen = makeScreen(view, 1280);
    const Box3f boxes[8] = {{{-9, -9, 1}, {9, 9, 20}},      // behind
                            {{-9, -1, -1}, {-2, 1, 5}},     // on the left
                            {{2, -1, -1}, {9, 1, 5}},       // on the right
                            {{-1, -9, -1}, {1, -2, 5}},     // below
                            {{-1, 2, -1}, {1, 9, 5}},       // above
                            {{-9, -1, -20}, {-2, 1, 5}},    // on the left, but its far end is in the view
                            {{-9, -9, -20}, {9, 9, 5}},     // all around
                            {{-1, -1, -20}, {1, 1, -10}}};  // in front
    BvhNode node{};
    for (int i = 0; i < 8; ++i) {
        for (int axis = 0; axis < 3; ++axis) {
            node.min[axis][i] = boxes[i].min[axis];
            node.max[axis][i] = boxes[i].max[axis];
        }
        const BoxAnswer answer = projectBox(screen, boxes[i]);
        EXPECT_EQ(answer.outside, i < 5) << i;
        EXPECT_EQ(answer.doubt, i == 5 || i == 6) << i;
    }
    test::forEachTarget([&](const std::string& target) {
        const ScreenAnswer answer = projectBoxes(screen, eyeBoxes(node, {0, 0, 0}));
        EXPECT_EQ(answer.outside, 0b00011111u) << target;
        EXPECT_EQ(answer.doubt, 0b01100000u) << target;
    });
}

}  // namespace
}  // namespace sightline
