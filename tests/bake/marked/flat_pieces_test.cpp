// What is left of a polygon when others are taken away, against points.
// SPDX-License-Identifier: MIT
#include "sightline/bake/marked/flat_pieces.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include "sightline/base/random.h"

namespace sightline {
using namespace bake;
namespace {

/// The distance to a convex polygon, negative inside.
double distanceTo(const FlatPiece& piece, const glm::dvec2& point) {
    double inside = std::numeric_limits<double>::infinity(), outside = inside;
    for (size_t i = 0; i < piece.size(); ++i) {
        const glm::dvec2 &a = piece[i], &b = piece[(i + 1) % piece.size()], along = b - a, to = point - a;
        const double length = glm::length(along);
        if (length == 0) continue;
        inside = std::min(inside, (along.x * to.y - along.y * to.x) / length);
        const double t = std::clamp(glm::dot(to, along) / (length * length), 0.0, 1.0);
        outside = std::min(outside, glm::length(to - t * along));
    }
    return inside >= 0 ? -outside : outside;
}

double distanceTo(const std::vector<FlatPiece>& pieces, const glm::dvec2& point) {
    double least = std::numeric_limits<double>::infinity();
    for (const FlatPiece& piece : pieces) least = std::min(least, distanceTo(piece, point));
    return least;
}

FlatPiece randomPiece(Random& random, size_t corners, double size) {
    const glm::dvec2 middle(random.uniform(0, 1), random.uniform(0, 1));
    std::vector<glm::dvec2> points;
    for (size_t i = 0; i < corners; ++i)
        points.push_back(middle + size * glm::dvec2(random.uniform(-1, 1), random.uniform(-1, 1)));
    // Slivers as well.
    if (random.below(3) == 0)
        for (glm::dvec2& point : points) point.y = middle.y + 1e-4 * (point.y - middle.y);
    return hullOf(points);
}

const FlatPiece kSquare{{0, 0}, {1, 0}, {1, 1}, {0, 1}};

TEST(FlatRest, IsWhatWasNotTaken) {
    Random random(1);
    for (int round = 0; round < 300; ++round) {
        FlatRest rest(kSquare);
        std::vector<FlatPiece> taken;
        for (uint64_t i = 0, n = 1 + random.below(30); i < n; ++i) {
            taken.push_back(randomPiece(random, 3 + random.below(4), random.uniform(0.01, 0.5)));
            rest.take(taken.back());
        }
        for (int i = 0; i < 200; ++i) {
            const glm::dvec2 point(random.uniform(0, 1), random.uniform(0, 1));
            const double to_taken = distanceTo(taken, point), to_rest = distanceTo(rest.pieces(), point);
            EXPECT_TRUE(to_taken <= 1e-12 || to_rest <= 1e-12) << "lost, round " << round;
            EXPECT_TRUE(to_taken >= -1e-9 || to_rest >= 0) << "not taken, round " << round;
        }
    }
}

TEST(FlatRest, NothingIsLeftOfWhatIsTakenWhole) {
    FlatRest rest(kSquare);
    rest.take({{0, 0}, {1, 0}, {0, 1}});
    EXPECT_FALSE(rest.empty());
    rest.take(grownBy({{1, 0}, {1, 1}, {0, 1}}, 1e-9));
    EXPECT_TRUE(rest.empty());
}

// The tip of a sliver, and what has no area, do not grow farther than the rest.
TEST(GrownBy, HoldsWhatIsNearAndNoMore) {
    Random random(2);
    for (int round = 0; round < 2000; ++round) {
        const FlatPiece piece = randomPiece(random, 3 + random.below(3), 0.3);
        const double by = std::pow(10, random.uniform(-6, -1));
        const FlatPiece grown = grownBy(piece, by);
        for (const glm::dvec2& corner : grown) {
            EXPECT_LE(distanceTo(piece, corner), 1.1 * by) << "round " << round;
            EXPECT_GE(distanceTo(piece, corner), 0.99 * by) << "round " << round;
        }
        for (size_t i = 0; i < piece.size(); ++i) {
            const double angle = random.uniform(0, 6.3);
            const glm::dvec2 near_by = piece[i] + 0.999 * by * glm::dvec2(std::cos(angle), std::sin(angle));
            EXPECT_LE(distanceTo(grown, near_by), 0) << "round " << round;
        }
    }
    EXPECT_FALSE(grownBy({{0, 0}, {1, 0}}, 0.1).empty());
}

TEST(HolesOf, HoldAllPiecesInFewer) {
    Random random(3);
    for (int round = 0; round < 200; ++round) {
        FlatRest rest(kSquare);
        for (uint64_t i = 0, n = 1 + random.below(40); i < n; ++i)
            rest.take(randomPiece(random, 3 + random.below(4), random.uniform(0.05, 0.5)));
        const size_t most = 1 + random.below(12);
        const std::vector<FlatHole> holes = holesOf(rest.pieces(), 1e-9, most);
        double area = 0;
        size_t count = 0;
        std::vector<FlatPiece> all;
        for (const FlatHole& hole : holes) {
            area += hole.area;
            count += hole.pieces.size();
            all.insert(all.end(), hole.pieces.begin(), hole.pieces.end());
        }
        double whole = 0;
        for (const FlatPiece& piece : rest.pieces()) {
            whole += areaOf(piece);
            for (const glm::dvec2& corner : piece) EXPECT_LE(distanceTo(all, corner), 1e-9) << "round " << round;
            glm::dvec2 middle(0);
            for (const glm::dvec2& corner : piece) middle += corner / double(piece.size());
            EXPECT_LE(distanceTo(all, middle), 1e-9) << "round " << round;
        }
        EXPECT_NEAR(area, whole, 1e-12);
        EXPECT_LE(count, most) << "round " << round;
    }
}

TEST(HolesOf, PutsTogetherWhatIsOneRectangle) {
    FlatRest rest(kSquare);
    for (const FlatPiece& wall : {FlatPiece{{0, 0}, {1, 0}, {0.4, 0.4}, {0.4, 0.2}},
                                  {{0, 0}, {0.4, 0.4}, {0, 1}},
                                  {{1, 0}, {1, 1}, {0.6, 0.4}, {0.6, 0.2}},
                                  {{1, 1}, {0, 1}, {0.4, 0.4}, {0.6, 0.4}},
                                  {{0, 0}, {1, 0}, {0.6, 0.2}, {0.4, 0.2}}})
        rest.take(hullOf(wall));
    const std::vector<FlatHole> holes = holesOf(rest.pieces(), 1e-9, 8);
    ASSERT_LE(holes.size(), 1u);
}

}  // namespace
}  // namespace sightline
