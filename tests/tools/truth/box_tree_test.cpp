// The witnesses' box tree finds what a look at every box finds.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/scene_facts.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace tools;
namespace {

bool overlap(const Box3d& a, const Box3d& b) {
    return glm::all(glm::lessThanEqual(a.min, b.max)) && glm::all(glm::lessThanEqual(b.min, a.max));
}

TEST(BoxTree, FindsAllThatTouch) {
    for (uint64_t seed = 0; seed < 40; ++seed) {
        Random random(seed);
        const auto number = [&] { return random.uniform(-9, 9); };
        const auto point = [&] { return glm::dvec3(number(), number(), number()); };
        std::vector<Box3d> boxes(random.below(200));
        for (Box3d& box : boxes) {
            box.grow(point());
            if (random.below(4) != 0) box.grow(box.min + 0.2 * point());
            if (random.below(10) == 0) box = Box3d{};
        }
        BoxTree tree;
        tree.build(boxes);
        for (int i = 0; i < 20; ++i) {
            Box3d asked;
            asked.grow(point());
            asked.grow(point());
            std::vector<uint32_t> found, expected;
            tree.walk([&](const Box3d& box) { return overlap(box, asked); },
                      [&](uint32_t index) {
                          if (overlap(boxes[index], asked)) found.push_back(index);
                      });
            for (uint32_t k = 0; k < boxes.size(); ++k)
                if (boxes[k].finite() && overlap(boxes[k], asked)) expected.push_back(k);
            std::sort(found.begin(), found.end());
            ASSERT_EQ(found, expected) << "seed " << seed << " case " << i;
        }
    }
}

}  // namespace
}  // namespace sightline
