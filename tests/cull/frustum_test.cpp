// The law of the frustum: a box with a point inside is kept, alone, in a node and in a flat list, on every target.
// SPDX-License-Identifier: MIT
#include "sightline/cull/frustum.h"

#include <gtest/gtest.h>

#include <limits>

#include "sightline/base/random.h"
#include "tests/support/targets.h"
#include "tests/support/views.h"

namespace sightline {
namespace {

/// A point inside the view volume by the definition of clip space, in double, found by unprojecting.
/// @param jittered  or beside it, where a jittered image shows it
glm::dvec3 pointInside(Random& random, const View& view, bool jittered = false) {
    const glm::dmat4 inverse = glm::inverse(view.projection);
    const double shift = jittered ? 2 * view.jitter : 0, x = 1 + shift / view.width, y = 1 + shift / view.height;
    const glm::dvec4 p =
        inverse * glm::dvec4(random.uniform(-x, x), random.uniform(-y, y), random.uniform(-1, 0.999), 1.0);
    const glm::dvec3 in_eye = glm::dvec3(p) / p.w;
    return eyePosition(view) + glm::transpose(glm::dmat3(view.view)) * in_eye;
}

BvhNode nodeOf(const Box3d* boxes, const glm::dvec3& origin) {
    BvhNode node{};
    for (int i = 0; i < 8; ++i) {
        const Box3f box = roundOutward(boxes[i], origin);
        for (int axis = 0; axis < 3; ++axis) {
            node.min[axis][i] = box.min[axis];
            node.max[axis][i] = box.max[axis];
        }
        node.count[i] = 1;
    }
    return node;
}

TEST(Frustum, KeepsEveryBoxThatHoldsAPointOfTheView) {
    test::forEachTarget([](const std::string& target) {
        Random random(1);
        for (int round = 0; round < 4000; ++round) {
            const double far = round % 3 == 0 ? 1e6 : round % 3 == 1 ? 1e9 : 0.0;
            const View view = test::anyView(random, far * glm::dvec3(1, -1, 0.5));
            const Frustum frustum = makeFrustum(view);
            Box3d boxes[8];
            for (Box3d& box : boxes) {
                // The box touches the point with its corner, edge or face: as near to being outside as can be.
                const glm::dvec3 p = pointInside(random, view, far == 0.0);
                box = {p, p};
                for (int axis = 0; axis < 3; ++axis) {
                    const double reach = random.uniform(0, 20);
                    if (random.below(2)) box.min[axis] -= reach;
                    else box.max[axis] += reach;
                }
            }
            const glm::dvec3 origin = eyePosition(view) + 100.0 * glm::dvec3(random.uniform(), random.uniform(), 1);
            const EyeBoxes eye = eyeBoxes(nodeOf(boxes, origin), origin - frustum.eye);
            ASSERT_EQ(testFrustum(frustum, eye, 63).outside, 0u) << target << " round " << round;
        }
    });
}

TEST(Frustum, AParentInsideAPlaneSparesItsChildrenThatPlane) {
    Random random(2);
    for (int round = 0; round < 2000; ++round) {
        const View view = test::anyView(random, 0.0 * glm::dvec3(1, -1, 0.5));
        const Frustum frustum = makeFrustum(view);
        Box3d boxes[8];
        for (int i = 0; i < 8; ++i) {
            const glm::dvec3 p = pointInside(random, view), size(random.uniform(0, 0.5));
            boxes[i] = {p - size, p + size};
        }
        const EyeBoxes eye = eyeBoxes(nodeOf(boxes, {0, 0, 0}), -frustum.eye);
        const FrustumAnswer answer = testFrustum(frustum, eye, 63);
        for (int i = 0; i < 8; ++i) {
            for (uint32_t plane = 0; plane < frustum.count; ++plane) {
                if (answer.planes[i] >> plane & 1) continue;
                for (int corner = 0; corner < 8; ++corner) {  // surely inside: all corners are
                    const glm::dvec3 p(corner & 1 ? boxes[i].max.x : boxes[i].min.x,
                                       corner & 2 ? boxes[i].max.y : boxes[i].min.y,
                                       corner & 4 ? boxes[i].max.z : boxes[i].min.z);
                    ASSERT_GE(glm::dot(glm::dvec3(frustum.planes[plane]), p - frustum.eye) + frustum.planes[plane].w,
                              0.0);
                }
            }
        }
    }
}

TEST(Frustum, KeepsABoxBeyondACornerAlthoughItIsOutside) {
    View view;
    view.width = view.height = 100;
    view.jitter = 0;
    view.projection = perspective(glm::radians(90.0), 1.0, 1.0, 100.0);
    const Frustum frustum = makeFrustum(view);
    // Crosses the far plane and the right one beyond the edge that they share: a known false positive.
    Box3d boxes[8];
    for (Box3d& box : boxes) box = {{105, -1, -120}, {300, 1, -95}};
    EXPECT_EQ(testFrustum(frustum, eyeBoxes(nodeOf(boxes, {0, 0, 0}), -frustum.eye), 63).outside, 0u);
    for (Box3d& box : boxes) box = {{5.0, -0.1, -1.1}, {6.0, 0.1, 2.0}};  // wholly right of the right plane
    EXPECT_EQ(testFrustum(frustum, eyeBoxes(nodeOf(boxes, {0, 0, 0}), -frustum.eye), 63).outside, 255u);
}

TEST(Frustum, KeepsWhatIsNotANumber) {
    View view;
    view.projection = perspective(1.0, 1.0, 0.1);
    const Frustum frustum = makeFrustum(view);
    EyeBoxes boxes;
    for (int axis = 0; axis < 3; ++axis)
        for (int i = 0; i < 8; ++i) boxes.min[axis][i] = boxes.max[axis][i] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_EQ(testFrustum(frustum, boxes, 63).outside, 0u);
}

TEST(Frustum, TheFlatListKeepsWhatTheNodesKeepAndNoMoreThanItsMargin) {
    test::forEachTarget([](const std::string& target) {
        Random random(3);
        for (int round = 0; round < 20; ++round) {
            const View view = test::anyView(random, 0.0 * glm::dvec3(1, -1, 0.5));
            const Frustum frustum = makeFrustum(view);
            const size_t count = 1000 + random.below(40), padded = (count + 15) / 16 * 16;
            std::vector<float> arrays[6];
            for (auto& array : arrays) array.assign(padded, 0.0f);
            std::vector<Box3d> boxes(count);
            BoxArrays flat;
            for (size_t i = 0; i < count; ++i) {
                const glm::dvec3 p(random.uniform(-40, 40), random.uniform(-40, 40), random.uniform(-40, 40));
                boxes[i] = {p, p + glm::dvec3(random.uniform(0, 3))};
                const Box3f box = roundOutward(boxes[i], {0, 0, 0});
                for (int axis = 0; axis < 3; ++axis) {
                    arrays[axis][i] = box.min[axis];
                    arrays[3 + axis][i] = box.max[axis];
                }
            }
            for (int axis = 0; axis < 3; ++axis) {
                flat.min[axis] = arrays[axis].data();
                flat.max[axis] = arrays[3 + axis].data();
            }
            flat.count = count;
            flat.reach = 50.0f;
            std::vector<uint32_t> kept(padded);
            kept.resize(cullFrustum(frustum, flat, kept));
            std::vector<uint8_t> is_kept(count, 0);
            for (uint32_t i : kept) is_kept[i] = 1;
            for (size_t i = 0; i < count; ++i) {
                double worst = std::numeric_limits<double>::infinity();  // of the farthest corner over the planes
                for (uint32_t p = 0; p < frustum.count; ++p) {
                    double sum = frustum.planes[p].w;
                    for (int axis = 0; axis < 3; ++axis)
                        sum += frustum.planes[p][axis] *
                               ((frustum.planes[p][axis] > 0 ? boxes[i].max : boxes[i].min)[axis] - frustum.eye[axis]);
                    worst = std::min(worst, sum);
                }
                if (worst >= 0.0) { ASSERT_TRUE(is_kept[i]) << target << " round " << round << " box " << i; }
                if (worst < -0.01) { ASSERT_FALSE(is_kept[i]) << target << " round " << round << " box " << i; }
            }
        }
    });
}

}  // namespace
}  // namespace sightline
