// Random places and directions, and how many random cases a test makes.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdlib>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/base/sanitized.h"
#include "sightline/math/box.h"

namespace sightline::test {

/// A number of repetitions times SIGHTLINE_TEST_ROUNDS, a factor that tools/mutate --rounds sets; at least one.
inline uint64_t scaledRounds(uint64_t count) {
    const char* share = std::getenv("SIGHTLINE_TEST_ROUNDS");
    if (!share || !*share) return count;
    return static_cast<uint64_t>(std::max(1.0, std::round(static_cast<double>(count) * std::strtod(share, nullptr))));
}

/// SIGHTLINE_LONG_TESTS=1: tests are as long as the promise says.
inline bool testsAreLong() {
    const char* wish = std::getenv("SIGHTLINE_LONG_TESTS");
    return wish && *wish && *wish != '0';
}

/// What takes a few seconds, or in long tests as many as the promise says.
inline size_t casesToMake(size_t shorter, size_t longer = 10000000) {
    return testsAreLong() ? longer : scaledRounds(shorter);
}

/// How often a test repeats. What sanitizers look for shows in few rounds, and they cost five to a hundred times as much.
inline uint64_t rounds(uint64_t whole, uint64_t sanitized) { return scaledRounds(kSanitized ? sanitized : whole); }

/// Each coordinate is between -size and size of its axis.
inline glm::dvec3 randomVector(Random& random, const glm::dvec3& size) {
    const double x = random.uniform(-size.x, size.x), y = random.uniform(-size.y, size.y);
    return {x, y, random.uniform(-size.z, size.z)};
}

inline glm::dvec3 randomVector(Random& random, double size) { return randomVector(random, glm::dvec3(size)); }

inline glm::dvec3 randomIn(Random& random, const Box3d& box) {
    const double x = random.uniform(box.min.x, box.max.x), y = random.uniform(box.min.y, box.max.y);
    return {x, y, random.uniform(box.min.z, box.max.z)};
}

/// Of length one, every direction alike.
inline glm::dvec3 randomUnit(Random& random) {
    for (;;) {
        const glm::dvec3 v = randomVector(random, 1.0);
        if (const double length = glm::length(v); length > 0.1 && length <= 1.0) return v / length;
    }
}

}  // namespace sightline::test
