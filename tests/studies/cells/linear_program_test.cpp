// The law of linear programs: a common point is never denied, and found but for what rounding may decide.
// SPDX-License-Identifier: MIT
#include "sightline/studies/cells/linear_program.h"

#include <gtest/gtest.h>

#include <vector>

#include "sightline/base/random.h"

namespace sightline {
using namespace studies;
namespace {

double height(const glm::dvec3& line, const glm::dvec2& p) { return glm::dot(glm::dvec2(line), p) + line.z; }
double height(const glm::dvec4& plane, const glm::dvec3& p) { return glm::dot(glm::dvec3(plane), p) + plane.w; }

/// The most that the least of all heights can be, at the corners of what the lines cut: -infinity if there is no corner.
/// All corners are tried: where there is a common point, one of them is one.
double bestCorner(std::vector<glm::dvec3> lines, double half) {
    for (const double sign : {1.0, -1.0}) {
        lines.emplace_back(sign, 0, half);
        lines.emplace_back(0, sign, half);
    }
    double best = -INFINITY;
    for (size_t a = 0; a < lines.size(); ++a)
        for (size_t b = 0; b < a; ++b) {
            const double area = lines[a].x * lines[b].y - lines[a].y * lines[b].x;
            if (std::abs(area) < 1e-9) continue;
            const glm::dvec2 p((lines[a].y * lines[b].z - lines[b].y * lines[a].z) / area,
                               (lines[b].x * lines[a].z - lines[a].x * lines[b].z) / area);
            double least = INFINITY;
            for (const glm::dvec3& line : lines) least = std::min(least, height(line, p));
            best = std::max(best, least);
        }
    return best;
}

double bestCorner(std::vector<glm::dvec4> planes, double half) {
    for (const double sign : {1.0, -1.0})
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec4 side(0, 0, 0, half);
            side[axis] = sign;
            planes.push_back(side);
        }
    double best = -INFINITY;
    for (size_t a = 0; a < planes.size(); ++a)
        for (size_t b = 0; b < a; ++b)
            for (size_t c = 0; c < b; ++c) {
                const glm::dvec3 n(planes[a]), m(planes[b]), k(planes[c]);
                const double volume = glm::dot(n, glm::cross(m, k));
                if (std::abs(volume) < 1e-9) continue;
                const glm::dvec3 p = -(planes[a].w * glm::cross(m, k) + planes[b].w * glm::cross(k, n) +
                                       planes[c].w * glm::cross(n, m)) /
                                     volume;
                double least = INFINITY;
                for (const glm::dvec4& plane : planes) least = std::min(least, height(plane, p));
                best = std::max(best, least);
            }
    return best;
}

glm::dvec3 randomLine(Random& random, bool whole) {
    for (;;) {
        glm::dvec3 line(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-3, 4));
        if (whole) line = glm::round(line);
        if (glm::length(glm::dvec2(line)) > 0.5) return line;
    }
}

glm::dvec4 randomPlane(Random& random, bool whole) {
    for (;;) {
        glm::dvec4 plane(random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-4, 4), random.uniform(-3, 4));
        if (whole) plane = glm::round(plane);
        if (glm::length(glm::dvec3(plane)) > 0.5) return plane;
    }
}

TEST(LinearProgram, FindsWhatTheCornersFindInThePlane) {
    Random random(1);
    int common = 0, none = 0;
    for (int round = 0; round < 20000; ++round) {
        std::vector<glm::dvec3> lines(1 + random.below(12));
        const bool whole = round % 2 != 0;  // then lines meet in points, and lie in one another
        for (glm::dvec3& line : lines) line = randomLine(random, whole);
        const double best = bestCorner(lines, 2.0);
        glm::dvec2 point(random.uniform(-3, 3), random.uniform(-3, 3));
        const bool found = commonPoint(lines, glm::dvec2(-2.0), glm::dvec2(2.0), point);
        if (best >= 0.0) { ASSERT_TRUE(found) << "round " << round; }
        if (best < -1e-9) { ASSERT_FALSE(found) << "round " << round; }
        if (!found) continue;
        for (const glm::dvec3& line : lines) ASSERT_GE(height(line, point), -1e-9) << "round " << round;
        ASSERT_LE(std::max(std::abs(point.x), std::abs(point.y)), 2.0 + 1e-9);
        common += best >= 0.0;
        none += best < 0.0;
    }
    EXPECT_GT(common, 2000);
    EXPECT_LT(none, 100);
}

TEST(LinearProgram, FindsWhatTheCornersFindInSpace) {
    Random random(2);
    int common = 0, none = 0;
    for (int round = 0; round < 6000; ++round) {
        std::vector<glm::dvec4> planes(1 + random.below(10));
        const bool whole = round % 2 != 0;
        for (glm::dvec4& plane : planes) plane = randomPlane(random, whole);
        const double best = bestCorner(planes, 2.0);
        glm::dvec3 point(random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3));
        const bool found = commonPoint(planes, glm::dvec3(-2.0), glm::dvec3(2.0), point);
        if (best >= 0.0) { ASSERT_TRUE(found) << "round " << round; }
        if (best < -1e-8) { ASSERT_FALSE(found) << "round " << round; }
        none += best < -1e-8;
        if (!found) continue;
        for (const glm::dvec4& plane : planes) ASSERT_GE(height(plane, point), -1e-8) << "round " << round;
        common += best >= 0.0;
    }
    EXPECT_GT(common, 600);
    EXPECT_GT(none, 600);
}

TEST(LinearProgram, APointInCommonIsNeverDeniedHoweverThinWhatIsLeft) {
    Random random(3);
    for (int round = 0; round < 20000; ++round) {
        // All lines pass the point, or leave it in by one last bit: exact, as the numbers are small and whole.
        const auto whole = [&] { return std::floor(random.uniform(-64, 65)); };
        const double scale = std::exp2(std::floor(random.uniform(-20, 20)));
        const glm::dvec3 p(whole() / 64, whole() / 64, whole() / 64);
        std::vector<glm::dvec3> lines(1 + random.below(20));
        for (glm::dvec3& line : lines) {
            line = {whole(), whole(), 0};
            line.z = -glm::dot(glm::dvec2(line), glm::dvec2(p));
            line *= scale;
        }
        glm::dvec2 start(random.uniform(-1, 1), random.uniform(-1, 1));
        ASSERT_TRUE(commonPoint(lines, glm::dvec2(-1.0), glm::dvec2(1.0), start)) << "round " << round;
        std::vector<glm::dvec4> planes(1 + random.below(12));
        for (glm::dvec4& plane : planes) {
            plane = {whole(), whole(), whole(), 0};
            plane.w = -glm::dot(glm::dvec3(plane), p);
            plane *= scale;
        }
        glm::dvec3 from(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
        ASSERT_TRUE(commonPoint(planes, glm::dvec3(-1.0), glm::dvec3(1.0), from)) << "round " << round;
    }
}

TEST(LinearProgram, WithoutDirectionAConditionHoldsOrNot) {
    glm::dvec2 p(0.0);
    EXPECT_TRUE(commonPoint(std::vector<glm::dvec3>{{0, 0, 0}}, glm::dvec2(-1.0), glm::dvec2(1.0), p));
    EXPECT_FALSE(commonPoint(std::vector<glm::dvec3>{{0, 0, -1}}, glm::dvec2(-1.0), glm::dvec2(1.0), p));
    glm::dvec3 q(0.0);
    EXPECT_TRUE(commonPoint(std::vector<glm::dvec4>{{0, 0, 0, 0}}, glm::dvec3(-1.0), glm::dvec3(1.0), q));
    EXPECT_FALSE(commonPoint(std::vector<glm::dvec4>{{0, 0, 0, -1}}, glm::dvec3(-1.0), glm::dvec3(1.0), q));
}

}  // namespace
}  // namespace sightline
