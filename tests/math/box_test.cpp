// The law of transformed boxes: no corner, and no point between corners, falls outside.
// SPDX-License-Identifier: MIT
#include "sightline/math/box.h"

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
namespace {

TEST(Box, HoldsEveryTransformedPoint) {
    Random random(1);
    for (int round = 0; round < 2000; ++round) {
        const double size = round % 3 ? 1.0 : 1e7;
        const auto number = [&] { return random.uniform(-size, size); };
        glm::dmat4 m(1.0);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) m[column][row] = number();
        Box3d box;
        box.grow(glm::dvec3(number(), number(), number()));
        box.grow(glm::dvec3(number(), number(), number()));
        const Box3d out = transformBox(box, m);
        for (int k = 0; k < 30; ++k) {
            glm::dvec3 t(random.uniform(), random.uniform(), random.uniform());
            if (k < 8) t = glm::dvec3(k & 1, k >> 1 & 1, k >> 2);
            // In extended precision: the box must hold the exact image, not its rounding.
            for (int row = 0; row < 3; ++row) {
                long double sum = m[3][row];
                for (int axis = 0; axis < 3; ++axis) {
                    const double p = t[axis] == 0   ? box.min[axis]
                                     : t[axis] == 1 ? box.max[axis]
                                                    : 0.5 * (box.min[axis] + box.max[axis]);
                    sum += static_cast<long double>(m[axis][row]) * p;
                }
                ASSERT_GE(sum, out.min[row]) << "round " << round;
                ASSERT_LE(sum, out.max[row]) << "round " << round;
            }
        }
    }
}

TEST(Box, KnowsWhenItIsEmptyOrNotFinite) {
    Box3d box;
    EXPECT_TRUE(box.empty());
    EXPECT_FALSE(box.finite());
    EXPECT_TRUE(transformBox(box, glm::dmat4(1.0)).empty());
    box.grow(glm::dvec3(1, 2, 3));
    EXPECT_FALSE(box.empty());
    EXPECT_TRUE(box.finite());
    box.max.y = std::numeric_limits<double>::quiet_NaN();
    EXPECT_TRUE(box.empty());
}

}  // namespace
}  // namespace sightline
