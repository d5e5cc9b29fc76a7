// Parting and meeting of triangles and tetrahedra, held against points counted in whole numbers.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/inner/separation.h"

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/prepare/occluder/exact.h"

namespace sightline {
namespace {

constexpr int kParts = 12;  // a triangle is looked at in points whose weights are twelfths

glm::vec3 randomCorner(Random& random) {
    return {float(random.below(7)) - 3, float(random.below(7)) - 3, float(random.below(7)) - 3};
}

/// Of whole numbers up to 36 times 3: exact in double.
double sixVolumes(const glm::dvec3& p, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    return glm::dot(glm::cross(b - a, c - a), p - a);
}

/// Calls `each` with points of a triangle, twelve times as large.
template <class Each>
void forPoints(const glm::vec3 (&t)[3], Each each) {
    for (int i = 0; i <= kParts; ++i)
        for (int j = 0; i + j <= kParts; ++j)
            each(double(i) * glm::dvec3(t[0]) + double(j) * glm::dvec3(t[1]) +
                 double(kParts - i - j) * glm::dvec3(t[2]));
}

bool isStrictlyInside(const glm::dvec3& p, const glm::vec3 (&tetrahedron)[4]) {
    glm::dvec3 v[4];
    for (int k = 0; k < 4; ++k) v[k] = double(kParts) * glm::dvec3(tetrahedron[k]);
    const double whole = sixVolumes(v[3], v[0], v[1], v[2]);
    const double parts[4] = {sixVolumes(p, v[0], v[1], v[2]), sixVolumes(v[3], v[0], v[1], p),
                             sixVolumes(v[3], v[0], p, v[2]), sixVolumes(v[3], p, v[1], v[2])};
    for (double part : parts)
        if (!(whole > 0 ? part > 0 : part < 0)) return false;
    return true;
}

TEST(Separation, NeverPartsATriangleFromATetrahedronThatHoldsAPointOfIt) {
    Random random(1);
    int parted = 0, met = 0, undecided = 0;
    for (int i = 0; i < 30000; ++i) {
        glm::vec3 tetrahedron[4], triangle[3];
        for (glm::vec3& p : tetrahedron) p = randomCorner(random);
        for (glm::vec3& p : triangle) p = random.below(3) ? randomCorner(random) : tetrahedron[random.below(4)];
        if (sideOf(tetrahedron[3], tetrahedron[0], tetrahedron[1], tetrahedron[2]) == Side::kOn ||
            areCollinear(triangle[0], triangle[1], triangle[2]))
            continue;
        bool meets = false;
        forPoints(triangle, [&](const glm::dvec3& p) { meets |= isStrictlyInside(p, tetrahedron); });
        const bool apart = areParted(tetrahedron, triangle);
        EXPECT_FALSE(apart && meets) << "case " << i;
        parted += apart;
        met += meets;
        undecided += !apart && !meets;
    }
    EXPECT_GT(parted, 5000);
    EXPECT_GT(met, 5000);
    EXPECT_LT(undecided, met / 4);  // those that only meet between the points looked at
}

/// Whether twelve times a point lies in a triangle.
bool holds(const glm::vec3 (&t)[3], const glm::dvec3& p) {
    const glm::dvec3 a = double(kParts) * glm::dvec3(t[0]), b = double(kParts) * glm::dvec3(t[1]),
                     c = double(kParts) * glm::dvec3(t[2]);
    const glm::dvec3 n = glm::cross(b - a, c - a);
    if (glm::dot(n, p - a) != 0) return false;
    return glm::dot(n, glm::cross(b - a, p - a)) >= 0 && glm::dot(n, glm::cross(c - b, p - b)) >= 0 &&
           glm::dot(n, glm::cross(a - c, p - c)) >= 0;
}

TEST(Separation, SaysThatTrianglesMeetIfTheyHaveAPointInCommonBesidesCorners) {
    Random random(2);
    int alone = 0, met = 0;
    for (int i = 0; i < 30000; ++i) {
        glm::vec3 a[3], b[3];
        for (glm::vec3& p : a) p = randomCorner(random);
        for (glm::vec3& p : b) p = random.below(3) ? randomCorner(random) : a[random.below(3)];
        if (i % 4 == 0)
            for (int k = 0; k < 3; ++k) a[k].z = b[k].z = 1;
        if (areCollinear(a[0], a[1], a[2]) || areCollinear(b[0], b[1], b[2])) continue;
        std::vector<glm::dvec3> common;
        for (const glm::vec3& p : a)
            for (const glm::vec3& q : b)
                if (p == q) common.push_back(double(kParts) * glm::dvec3(p));
        bool meets = common.size() == 3;
        const auto look = [&](const glm::dvec3& p, const glm::vec3(&other)[3]) {
            if (!holds(other, p)) return;
            bool expected = false;
            for (const glm::dvec3& c : common) expected |= p == c;
            if (common.size() == 2) {  // on the side between them
                const glm::dvec3 along = common[1] - common[0], to = p - common[0];
                expected |= glm::cross(along, to) == glm::dvec3(0);
            }
            meets |= !expected;
        };
        forPoints(a, [&](const glm::dvec3& p) { look(p, b); });
        forPoints(b, [&](const glm::dvec3& p) { look(p, a); });
        const bool apart = meetInCornersOnly(a, b);
        EXPECT_FALSE(apart && meets) << "case " << i;
        alone += apart;
        met += meets;
    }
    EXPECT_GT(alone, 8000);
    EXPECT_GT(met, 1000);
}

TEST(Separation, FindsThatNeighboursInAMeshMeetInTheirCornersOnly) {
    // A fan in one plane: any two have a corner or a side in common and nothing else.
    glm::vec3 rim[6];
    for (int k = 0; k < 6; ++k)
        rim[k] = {std::round(100 * std::cos(k * 1.04719755f)), 5, std::round(100 * std::sin(k * 1.04719755f))};
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < i; ++j) {
            const glm::vec3 a[3] = {{0, 5, 0}, rim[i], rim[(i + 1) % 6]}, b[3] = {{0, 5, 0}, rim[j], rim[(j + 1) % 6]};
            EXPECT_TRUE(meetInCornersOnly(a, b)) << i << " and " << j;
        }
    const glm::vec3 flat[3] = {{0, 0, 0}, {4, 0, 0}, {0, 0, 4}}, folded[3] = {{4, 0, 0}, {0, 0, 0}, {1, 0, 2}};
    EXPECT_FALSE(meetInCornersOnly(flat, folded));
}

}  // namespace
}  // namespace sightline
