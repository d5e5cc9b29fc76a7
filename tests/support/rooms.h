// Rooms with doorways, things in them that may move, and an eye that walks through.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <vector>

#include "tests/support/made_world.h"
#include "tests/support/random.h"

namespace sightline::test {

/// Rooms of 6 x 3 x 6 units with doorways, and things in them. Walls are boxes that meet face to face.
struct Rooms : MadeWorld {
    static constexpr int kSide = 4;
    std::vector<size_t> walls, things, mounds;

    /// @param single_sided  no face of a mound is drawn from behind; else some are
    explicit Rooms(uint64_t seed, bool single_sided = false) {
        Random random(seed);
        shapes = true;
        const uint32_t columns = seed % 2 ? 6 : 21;  // one body, or many clusters
        for (uint32_t y = 0; y < columns; ++y)
            for (uint32_t x = 0; x < columns; ++x) {
                const float u = float(x) / (columns - 1), v = float(y) / (columns - 1);
                other.positions.push_back({u, 16 * u * (1 - u) * v * (1 - v), 1 - v});
            }
        other.addGrid(columns, columns);
        for (size_t t = 0; t < other.indices.size() / 3; ++t) {
            const bool both = random.below(4) == 0;
            other_double_sided.push_back(both && !single_sided);
        }
        const OccluderId mound = world.addOccluder(prepareOccluder(other.view(), {}, other_double_sided));
        const auto wall = [&](double x0, double z0, double x1, double z1, double low, double high) {
            walls.push_back(transforms.size());
            add({x0, low, z0}, {x1, high, z1});
        };
        add({0, -0.5, 0}, {6 * kSide, 0, 6 * kSide});
        add({0, 3, 0}, {6 * kSide, 3.5, 6 * kSide});
        for (int line = 0; line <= kSide; ++line)
            for (int room = 0; room < kSide; ++room)
                for (const bool along_x : {false, true}) {
                    const double at = 6 * line - 0.125, from = 6 * room, door = from + 1 + double(random.below(4));
                    const auto piece = [&](double a, double b, double low, double high) {
                        if (along_x) wall(a, at, b, at + 0.25, low, high);
                        else wall(at, a, at + 0.25, b, low, high);
                    };
                    if (line == 0 || line == kSide || random.below(3) == 0) {
                        piece(from, from + 6, 0, 3);
                        continue;
                    }
                    piece(from, door, 0, 3);
                    piece(door + 1, from + 6, 0, 3);
                    piece(door, door + 1, 2, 3);
                }
        for (int i = 0; i < 400; ++i) {
            const glm::dvec3 p{random.uniform(0.3, 6 * kSide - 1), random.uniform(0, 2),
                               random.uniform(0.3, 6 * kSide - 1)};
            const glm::dvec3 size{random.uniform(0.1, 0.7), random.uniform(0.1, 0.9), random.uniform(0.1, 0.7)};
            const bool hides = random.below(2) == 0;
            things.push_back(transforms.size());
            add(p, p + size, hides, random.below(8) == 0 ? 2 : 1);
        }
        for (int i = 0; i < 40; ++i) {  // of several clusters, some through walls, and some hang from above
            glm::dmat4 t(1.0);
            for (int axis = 0; axis < 3; ++axis) t[axis][axis] = random.uniform(0.3, axis == 1 ? 1.5 : 4);
            if (random.below(4) == 0) t[1] = -t[1];
            t[3] = glm::dvec4{random.uniform(0.3, 6 * kSide - 3), random.uniform(0.1, 2),
                              random.uniform(0.3, 6 * kSide - 3), 1};
            mounds.push_back(transforms.size());
            add(t, random.below(2) == 0, 1, mound);
        }
    }
    /// Moves a wall and a thing.
    void disturb(Random& random) {
        const size_t wall = walls[random.below(walls.size())], thing = things[random.below(things.size())];
        moveTo(wall, {random.uniform(-1, 1), 0, random.uniform(-1, 1)});
        moveTo(thing, {random.uniform(-2, 2), 0, random.uniform(-2, 2)});
    }
    void moveTo(size_t object, const glm::dvec3& by) {
        transforms[object][3] += glm::dvec4(by, 0);
        world.move(ids[object], transforms[object]);
    }
};

/// Steps of an eye that walks through them.
struct Steps {
    glm::dvec3 eye, step;
    double turn = 0, speed = 0;

    explicit Steps(Random& random) { jump(random); }
    void jump(Random& random) {
        eye = {random.uniform(0.5, 6 * Rooms::kSide - 0.5), random.uniform(0.4, 2.4),
               random.uniform(0.5, 6 * Rooms::kSide - 0.5)};
        step = glm::dvec3{random.uniform(-0.03, 0.03), 0, random.uniform(-0.03, 0.03)};
        turn = random.uniform(0, 6.28);
        speed = random.uniform(-0.02, 0.02);
    }
    View next(double degrees = 70, double near = 0.05) {
        eye += step;
        turn += speed;
        return viewFrom(eye, {std::cos(turn), -0.1, std::sin(turn)}, {degrees, 320, 180, near});
    }
};

}  // namespace sightline::test
