// Chains that no line passes: never one that a line does pass, and those that are plainly shut.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/stabbing.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace bake;
namespace {

constexpr double kExtent = 64, kPrecision = kExtent * 0x1p-38;

/// A convex polygon about a point of the line, counter-clockwise about a normal along +x.
std::vector<glm::dvec3> windowAbout(const glm::dvec3& center, double reach, Random& random) {
    const glm::dvec3 normal = glm::normalize(glm::dvec3(1, random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7)));
    const glm::dvec3 u = glm::normalize(glm::cross(normal, glm::dvec3(0, 0, 1))), v = glm::cross(normal, u);
    const uint64_t corners = 3 + random.below(5);
    std::vector<glm::dvec3> outline;
    for (uint64_t i = 0; i < corners; ++i) {
        const double angle =
            6.283185307179586 * (static_cast<double>(i) + 0.4 * random.uniform()) / static_cast<double>(corners);
        outline.push_back(center + reach * (std::cos(angle) * u + std::sin(angle) * v));
    }
    return outline;
}

double riseOf(std::span<const glm::dvec3> last, const glm::dvec3& at, const glm::dvec3& normal) {
    double rise = 1e300;
    for (const glm::dvec3& point : last) rise = std::min(rise, glm::dot(normal, point - at));
    return rise;
}

glm::dvec3 normalOf(std::span<const glm::dvec3> outline) {
    return glm::normalize(glm::cross(outline[1] - outline[0], outline[2] - outline[0]));
}

TEST(Stabbing, NeverDeniesALine) {
    StabbingChain chain;
    for (uint64_t seed = 1; seed <= 20000; ++seed) {
        Random random(seed);
        const glm::dvec3 from(-30, random.uniform(-20, 20), random.uniform(-20, 20));
        const glm::dvec3 to(30, random.uniform(-20, 20), random.uniform(-20, 20));
        const uint64_t windows = 2 + random.below(6);
        std::vector<std::vector<glm::dvec3>> outlines;
        for (uint64_t i = 0; i < windows; ++i) {
            // Thin and narrow ones, too; the line passes near a corner or within.
            const double reach = std::pow(10, random.uniform(-4, 0.5));
            const double t = static_cast<double>(i) / static_cast<double>(windows - 1);
            std::vector<glm::dvec3> outline = windowAbout(from + t * (to - from), reach, random);
            if (seed % 3 == 0) {  // through a corner: it grazes
                const glm::dvec3 shift = outline[0] - (from + t * (to - from));
                for (glm::dvec3& point : outline) point -= shift;
            }
            outlines.push_back(outline);
        }
        const glm::dvec3 normal = normalOf(outlines[0]);
        const double rise = riseOf(outlines.back(), outlines[0][0], normal);
        if (!(rise > 0)) continue;
        chain.begin(normal, kExtent, kPrecision);
        for (const auto& outline : outlines) chain.add(outline);
        EXPECT_FALSE(chain.isProvedEmpty(rise, 4 * kExtent)) << seed;
    }
}

TEST(Stabbing, ProvesWhatAPlaneShuts) {
    StabbingChain chain;
    uint64_t proved = 0, asked = 0;
    for (uint64_t seed = 1; seed <= 500; ++seed) {
        Random random(seed);
        // The last one lies aside of the lines through the first two, by more than these spread.
        const double gap = random.uniform(0.5, 5);
        const std::vector<std::vector<glm::dvec3>> outlines = {windowAbout({-10, 0, 0}, 1, random),
                                                               windowAbout({0, 0, 0}, 1, random),
                                                               windowAbout({10, 5 + gap, 0}, 1, random)};
        const glm::dvec3 normal = normalOf(outlines[0]);
        const double rise = riseOf(outlines.back(), outlines[0][0], normal);
        if (!(rise > 0)) continue;
        chain.begin(normal, kExtent, kPrecision);
        for (const auto& outline : outlines) chain.add(outline);
        ++asked;
        proved += chain.isProvedEmpty(rise, 4 * kExtent);
    }
    EXPECT_GT(asked, 400u);
    // Not all: points that are no lines may satisfy the forms.
    EXPECT_GT(static_cast<double>(proved), 0.6 * static_cast<double>(asked));
}

}  // namespace
}  // namespace sightline
