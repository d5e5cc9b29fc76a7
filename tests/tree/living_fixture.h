// What the tests of hierarchies that live share: random boxes and views, and the slow truth about them.
// SPDX-License-Identifier: MIT
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "sightline/cull/frustum.h"
#include "sightline/geom/view.h"
#include "tests/support/random.h"

namespace sightline::test {

/// SIGHTLINE_LONG_TESTS=1 makes tests of random changes as long as the promise says: a million.
inline uint32_t changesToMake(uint32_t shorter) { return static_cast<uint32_t>(casesToMake(shorter, 1000000)); }

inline glm::dvec3 randomPoint(Random& random, double world) { return randomVector(random, world); }

/// Mostly small; one in twenty is as large as the world, one in fifty a point.
inline Box3d randomBox(Random& random, const glm::dvec3& at, double world) {
    if (random.below(50) == 0) return {at, at};
    const double size = world * random.uniform(0.001, random.below(20) ? 0.02 : 1.0);
    const double y = random.uniform(), z = random.uniform();
    return {at, at + size * glm::dvec3(1.0, y, z)};
}

/// Perspective with and without a far plane, off-centre, and parallel; from inside the world, mostly.
inline View randomView(Random& random, double world, const glm::dvec3& middle = glm::dvec3(0.0)) {
    View view;
    const glm::dvec3 eye = middle + randomPoint(random, world * 1.2);
    const glm::dvec3 target = middle + randomPoint(random, world);
    view.view = lookAt(eye, target, {0.1, 1, 0.2});
    const double fov = random.uniform(0.1, 2.0), aspect = random.uniform(0.5, 2.0);
    switch (random.below(4)) {
        case 0:
            view.projection = perspective(fov, aspect, 0.01 * world);
            break;
        case 1:
            view.projection = perspective(fov, aspect, 0.01 * world, random.uniform(0.1, 2.0) * world);
            break;
        case 2:
            view.projection = perspective(fov, aspect, 0.01 * world, world);
            view.projection[2][0] += random.uniform(-0.5, 0.5);
            break;
        default: {
            const double height = world * random.uniform(0.1, 1.0);
            view.projection = orthographic(height, aspect, -world, random.uniform(0.1, 2.0) * world);
        }
    }
    return view;
}

/// The numbers of the boxes that a flat list keeps, in rising order; an empty box is in no list and always kept.
inline std::vector<uint32_t> keptByFlat(const Frustum& frustum, const std::vector<Box3f>& boxes,
                                        const glm::dvec3& origin, float reach) {
    std::vector<uint32_t> ids, answer;
    for (uint32_t i = 0; i < boxes.size(); ++i) (boxes[i].empty() ? answer : ids).push_back(i);
    const size_t padded = (ids.size() + 15) / 16 * 16;
    std::vector<float> bounds[6];
    BoxArrays arrays;
    for (int axis = 0; axis < 3; ++axis) {
        bounds[axis].assign(padded, 0.0f);
        bounds[3 + axis].assign(padded, 0.0f);
        for (size_t i = 0; i < ids.size(); ++i) {
            bounds[axis][i] = boxes[ids[i]].min[axis];
            bounds[3 + axis][i] = boxes[ids[i]].max[axis];
        }
        arrays.min[axis] = bounds[axis].data();
        arrays.max[axis] = bounds[3 + axis].data();
    }
    arrays.count = ids.size();
    arrays.origin = origin;
    arrays.reach = reach;
    std::vector<uint32_t> kept(padded);
    kept.resize(cullFrustum(frustum, arrays, kept));
    for (uint32_t i : kept) answer.push_back(ids[i]);
    std::sort(answer.begin(), answer.end());
    return answer;
}

/// Whether a box is surely outside some plane, by exact enough arithmetic: then, and only then, may it be culled.
inline bool touches(const Frustum& frustum, const Box3d& box) {
    for (uint32_t i = 0; i < frustum.count; ++i) {
        long double sum = frustum.planes[i].w;
        for (int axis = 0; axis < 3; ++axis) {
            const long double n = frustum.planes[i][axis];
            sum += n * ((n >= 0 ? box.max[axis] : box.min[axis]) - static_cast<long double>(frustum.eye[axis]));
        }
        if (sum < 0) return false;
    }
    return true;
}

inline float reachOf(const std::vector<Box3f>& boxes) {
    float reach = 0.0f;
    for (const Box3f& box : boxes)
        for (int axis = 0; axis < 3 && !box.empty(); ++axis)
            reach = std::max(reach, std::max(std::abs(box.min[axis]), std::abs(box.max[axis])));
    return reach;
}

}  // namespace sightline::test
