// What drawing covers is covered: each point of such a pixel shows a triangle that is as near as is claimed.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/buffer/depth_image.h"
#include "sightline/cull/outline_look.h"
#include "sightline/prepare/occluder/occluder.h"
#include "tests/support/meshes.h"
#include "tests/support/random.h"
#include "tests/support/targets.h"
#include "tests/support/views.h"

namespace sightline::test {
namespace drawing {
namespace {

/// A mesh of some kind, with triangles that are drawn from both sides.
struct Made {
    TestMesh mesh;
    std::vector<uint8_t> both;
};

Made randomMesh(Random& random) {
    Made out;
    TestMesh& mesh = out.mesh;
    const auto boxes = 1 + random.below(4);
    switch (random.below(6)) {
        case 0:  // boxes, some flush
            for (uint64_t i = 0; i < boxes; ++i) {
                const glm::vec3 low(0.25f * float(random.below(16)) - 2, 0.25f * float(random.below(8)) - 1,
                                    0.25f * float(random.below(16)) - 2);
                const TestMesh box = boxMesh(low, low + glm::vec3(0.5f + 0.5f * float(random.below(4))));
                const auto first = static_cast<uint32_t>(mesh.positions.size());
                mesh.positions.insert(mesh.positions.end(), box.positions.begin(), box.positions.end());
                for (const uint32_t index : box.indices) mesh.indices.push_back(first + index);
            }
            break;
        case 1:  // a sheet, flat or bent
        case 2: {
            const uint32_t n = 2 + static_cast<uint32_t>(random.below(20));
            const double bend = random.below(2) ? random.uniform(0, 1) : 0;
            for (uint32_t y = 0; y < n; ++y)
                for (uint32_t x = 0; x < n; ++x) {
                    const double u = 4.0 * x / (n - 1) - 2, v = 4.0 * y / (n - 1) - 2;
                    mesh.positions.push_back(glm::vec3(u, v, bend * std::sin(2 * u + v) * random.uniform(0.9, 1)));
                }
            mesh.addGrid(n, n);
            break;
        }
        case 3:  // loose triangles
            for (int i = 0; i < 30; ++i) {
                const glm::dvec3 at = randomVector(random, 2.0);
                const glm::dvec3 a = randomVector(random, 1.5), b = randomVector(random, 1.5),
                                 c = randomVector(random, 1.5);
                mesh.add(glm::vec3(at + a), glm::vec3(at + b), glm::vec3(at + c));
            }
            break;
        case 4: {  // a ball
            const uint32_t n = 6 + static_cast<uint32_t>(random.below(16));
            for (uint32_t y = 0; y <= n; ++y)
                for (uint32_t x = 0; x < n; ++x) {
                    const double a = 6.283185307179586 * x / n, b = 3.141592653589793 * (0.02 + 0.96 * y / n);
                    mesh.positions.push_back(
                        glm::vec3(2 * std::sin(b) * std::cos(a), 2 * std::cos(b), 2 * std::sin(b) * std::sin(a)));
                }
            for (uint32_t y = 0; y < n; ++y)
                for (uint32_t x = 0; x < n; ++x) {
                    const uint32_t a = y * n + x, b = y * n + (x + 1) % n;
                    mesh.fan({a, b, b + n, a + n});
                }
            break;
        }
        default:  // slivers and folds: a fan of triangles around one edge
            for (int i = 0; i < 20; ++i) {
                const double a = random.uniform(0, 6.28), width = std::pow(10, random.uniform(-5, 0.3));
                mesh.add(glm::vec3(0, -2, 0), glm::vec3(0, 2, 0),
                         glm::vec3(width * std::cos(a), random.uniform(-2, 2), width * std::sin(a)));
            }
    }
    for (size_t t = 0; t < mesh.indices.size() / 3; ++t) out.both.push_back(random.below(3) == 0);
    return out;
}

struct Ray {
    glm::dvec3 eye, along;  ///< w = 1 at eye + along
};

/// The nearness of the nearest triangle that a ray meets and that is drawn; 0: none is. In doubtful places at an edge it is met.
double nearnessOf(const Made& made, const Ray& ray, double near_w) {
    double most = 0;
    const TestMesh& mesh = made.mesh;
    for (size_t t = 0; t < made.both.size(); ++t) {
        glm::dvec3 p[3];
        for (size_t k = 0; k < 3; ++k) p[k] = glm::dvec3(mesh.positions[mesh.indices[3 * t + k]]) - ray.eye;
        const glm::dvec3 normal = glm::cross(p[1] - p[0], p[2] - p[0]);
        const double facing = -glm::dot(normal, p[0]), fall = glm::dot(normal, ray.along);
        if (fall == 0 || (facing < 0 && !made.both[t])) continue;
        const double w = glm::dot(normal, p[0]) / fall;
        if (!(w >= near_w * (1 - 1e-9))) continue;
        // On which side of the three planes through the eye and an edge the ray is.
        int left = 0, right = 0;
        for (size_t k = 0; k < 3; ++k) {
            const glm::dvec3 side = glm::cross(p[k], p[(k + 1) % 3]);
            const double at = glm::dot(side, ray.along), slack = 1e-9 * glm::length(side) * glm::length(ray.along);
            left += at > -slack;
            right += at < slack;
        }
        if (left == 3 || right == 3) most = std::max(most, 1 / w);
    }
    return most;
}

/// A mesh somewhere, and who looks at it.
struct Case {
    Made made;
    glm::dmat4 transform{1.0};
    View view;

    explicit Case(Random& random) : made(randomMesh(random)) {
        transform = lookAt({0, 0, 0}, randomUnit(random), {0.1, 1, 0.2});
        for (int axis = 0; axis < 3; ++axis)
            transform[axis] *= random.uniform(0.5, 2) * (random.below(6) == 0 ? -1 : 1);
        const double far = random.below(4) == 0 ? 1e5 : 0;
        transform[3] = glm::dvec4(randomVector(random, 1.0) + far, 1);
        const double away = random.below(3) == 0 ? random.uniform(0.2, 2) : random.uniform(2, 12);
        const glm::dvec3 middle(transform[3]), eye = middle + away * randomUnit(random);
        const Camera camera{random.uniform(5, 140), 160, 90, random.below(3) ? 0.1 : 0.01};
        view = viewAt(eye, middle + randomVector(random, 1.0), camera);
    }
};

/// A case drawn alone; it holds what seams look at.
struct Drawn {
    DepthTiles& tiles;
    const Occluder occluder;

    Drawn(const Case& of, uint32_t size, DepthTiles& in)
        : tiles(in), occluder(prepareOccluder(of.made.mesh.view(), {}, of.made.both)) {
        const Screen screen = makeScreen(of.view, size);
        const OccluderInstance instance = makeOccluderInstance(screen, occluder, of.transform);
        EXPECT_TRUE(instance.frame.usable);
        tiles.clear(screen.width, screen.height);
        for (uint32_t c = 0; c < occluder.clusters.size(); ++c) {
            const BoxAnswer box = projectBox(instance.screen, occluder.clusters[c].bounds);
            if (!box.outside) drawOccluder(tiles, instance, c, box);
        }
    }
    /// What each pixel claims, row by row.
    std::vector<float> claims() const {
        std::vector<float> out(size_t{tiles.width} * tiles.height);
        readDepthImage(tiles, Seams::kLeave, out);
        return out;
    }
};

/// Where a longer search goes on: SIGHTLINE_FIRST_SEED.
uint64_t firstSeed() {
    const char* const begin = std::getenv("SIGHTLINE_FIRST_SEED");
    return begin ? std::strtoull(begin, nullptr, 10) : 1;
}

TEST(Draw, CoversNothingThatIsOpen) {
    uint64_t pixels = 0;
    const uint64_t first = firstSeed();
    for (uint64_t seed = first; seed < first + rounds(150, 20); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Case of(random);
        DepthTiles tiles;
        const std::vector<float> claims = Drawn(of, 128, tiles).claims();
        const Screen screen = makeScreen(of.view, 128), object = objectScreen(screen, of.transform);
        const glm::dmat3 rows =
            glm::transpose(glm::dmat3(glm::dvec3(object.x), glm::dvec3(object.y), glm::dvec3(object.w)));
        const glm::dmat3 from_image = glm::inverse(rows);
        const glm::dvec3 eye = -(from_image * glm::dvec3(object.x.w, object.y.w, object.w.w));
        for (uint32_t y = 0; y < tiles.height; ++y)
            for (uint32_t x = 0; x < tiles.width; ++x) {
                const float claim = claims[size_t{y} * tiles.width + x];
                if (!(claim > 0)) continue;
                ++pixels;
                // A corner of the pixel, or nearly, and a point in it.
                for (const bool corner : {true, false}) {
                    double at[2];
                    for (double& side : at) side = corner ? (random.below(2) ? 1e-6 : 1 - 1e-6) : random.uniform();
                    const Ray ray{eye, from_image * glm::dvec3(x + at[0], y + at[1], 1)};
                    ASSERT_GE(nearnessOf(of.made, ray, screen.near_w), claim * (1 - 1e-7))
                        << "pixel " << x << " " << y << " + " << at[0] << " " << at[1];
                }
            }
    }
    EXPECT_GT(pixels, rounds(100000, 10000));
}

/// An object's space, seen from a view.
struct Seen {
    Screen screen;
    glm::dmat3 from_image{1.0};
    glm::dvec3 eye{0.0};

    Seen(const View& view, uint32_t size, const glm::dmat4& transform)
        : screen(objectScreen(makeScreen(view, size), transform)) {
        const glm::dmat3 rows =
            glm::transpose(glm::dmat3(glm::dvec3(screen.x), glm::dvec3(screen.y), glm::dvec3(screen.w)));
        from_image = glm::inverse(rows);
        eye = -(from_image * glm::dvec3(screen.x.w, screen.y.w, screen.w.w));
    }
    Ray ray(double x, double y) const { return {eye, from_image * glm::dvec3(x, y, 1)}; }
};

TEST(Draw, WhatALookFindsHiddenIsHidden) {
    uint64_t hidden = 0, shown = 0, rays = 0;
    const uint64_t first = firstSeed();
    for (uint64_t seed = first; seed < first + rounds(4000, 200); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        Random random(seed);
        const Case of(random);
        DepthTiles tiles;
        Drawn drawn(of, 128, tiles);
        const std::vector<float> claims = drawn.claims();
        const auto claimAt = [&](double px, double py) {
            return claims[static_cast<size_t>(py) * tiles.width + static_cast<size_t>(px)];
        };
        const Made other = randomMesh(random);
        const Occluder shape = prepareOccluder(other.mesh.view(), {}, other.both);
        glm::dmat4 transform = lookAt({0, 0, 0}, randomUnit(random), {0.1, 1, 0.2});
        const double size = std::pow(10, random.uniform(-2.5, -0.3));
        for (int axis = 0; axis < 3; ++axis) transform[axis] *= size * (random.below(6) == 0 ? -1 : 1);
        const Seen front(of.view, 128, of.transform);
        // At the border of what is covered where there is one, and a little behind it, or farther.
        const auto isCovered = [&](double px, double py) {
            return px >= 0 && py >= 0 && px < tiles.width && py < tiles.height && claimAt(px, py) > 0;
        };
        double x = 0, y = 0;
        for (int tries = 0; tries < 200; ++tries) {
            x = random.uniform(0, tiles.width);
            y = random.uniform(0, tiles.height);
            if (isCovered(x, y) &&
                !(isCovered(x - 2, y) && isCovered(x + 2, y) && isCovered(x, y - 2) && isCovered(x, y + 2)))
                break;
        }
        const float claim = claimAt(x, y);
        const double behind = random.below(2) ? random.uniform(0.99, 1.1) : random.uniform(1, 4);
        const double w = (claim > 0 ? 1 / double(claim) : 5) * behind;
        const Ray to = front.ray(x, y);
        transform[3] = of.transform * glm::dvec4(to.eye + w * to.along, 1);
        const Seen back(of.view, 128, transform);
        LookScratch scratch(defaultMemory());
        OutlineLook found;
        const Screen screen = makeScreen(of.view, 128);
        if (askOutlines(tiles, makeOccluderInstance(screen, shape, transform), scratch, found) == Sight::kVisible) {
            ++shown;
            continue;
        }
        ++hidden;
        for (int i = 0; i < 200; ++i) {
            const size_t t = random.below(other.both.size());
            double a = random.uniform(), b = random.uniform();
            if (a + b > 1) a = 1 - a, b = 1 - b;
            if (random.below(2)) {  // beside a corner
                a = random.below(2) ? 1e-4 + 1e-4 * a : 1 - 3e-4 + 1e-4 * a;
                b = a > 0.5 ? 1e-4 : random.below(2) ? 1e-4 : 1 - 3e-4;
            }
            const auto corner = [&](size_t k) {
                return glm::dvec3(other.mesh.positions[other.mesh.indices[3 * t + k]]);
            };
            const glm::dvec4 p(corner(0) + a * (corner(1) - corner(0)) + b * (corner(2) - corner(0)), 1);
            const double pw = glm::dot(back.screen.w, p), px = glm::dot(back.screen.x, p) / pw,
                         py = glm::dot(back.screen.y, p) / pw;
            if (!(pw > back.screen.near_w && px > 0 && py > 0 && px < tiles.width && py < tiles.height)) continue;
            const double nearness = nearnessOf(other, back.ray(px, py), back.screen.near_w);
            if (nearness == 0) continue;
            ++rays;
            ASSERT_GE(nearnessOf(of.made, front.ray(px, py), front.screen.near_w), nearness * (1 - 1e-7))
                << "pixel " << px << " " << py;
        }
    }
    EXPECT_GT(hidden, rounds(200, 20));
    EXPECT_GT(shown, rounds(200, 20));
    EXPECT_GT(rays, rounds(10000, 1000));
}

TEST(Draw, IsTheSameOnEveryInstructionSet) {
    for (uint64_t seed = 1; seed <= rounds(60, 10); ++seed) {
        SCOPED_TRACE("seed " + std::to_string(seed));
        std::vector<float> first;
        const int targets = forEachTarget([&](const std::string& target) {
            Random random(seed);
            const Case of(random);
            DepthTiles tiles;
            const std::vector<float> claims = Drawn(of, 160, tiles).claims();
            if (first.empty()) first = claims;
            size_t differ = 0, where = 0;
            for (size_t i = 0; i < claims.size(); ++i)
                if (claims[i] != first[i] && ++differ == 1) where = i;
            EXPECT_EQ(differ, 0u) << target << ": pixel " << where % tiles.width << " " << where / tiles.width << ": "
                                  << claims[where] << ", not " << first[where];
        });
        EXPECT_GT(targets, 0);
    }
}

}  // namespace
}  // namespace drawing
}  // namespace sightline::test
