// Cameras for tests: where they stand, where they look, and how large their images are.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/geom/view.h"
#include "tests/support/random.h"

namespace sightline::test {

struct Camera {
    double degrees = 60;  ///< the full vertical angle
    uint32_t width = 160, height = 90;
    double z_near = 0.1;
    glm::dvec3 up{0, 1, 0};
};

/// Looks from the origin along -z.
inline View viewBy(const glm::dmat4& projection, uint32_t width, uint32_t height) {
    View view;
    view.width = width;
    view.height = height;
    view.projection = projection;
    return view;
}

/// Looks from the eye at a place.
inline View viewAt(const glm::dvec3& eye, const glm::dvec3& target, const Camera& camera = {}) {
    const double aspect = double(camera.width) / camera.height;
    View view = viewBy(perspective(glm::radians(camera.degrees), aspect, camera.z_near), camera.width, camera.height);
    view.view = lookAt(eye, target, camera.up);
    return view;
}

/// Looks from the eye in a direction.
inline View viewFrom(const glm::dvec3& eye, const glm::dvec3& direction, const Camera& camera = {}) {
    return viewAt(eye, eye + direction, camera);
}

/// Stands anywhere within `reach` of the middle on each axis and looks anywhere, more level than steep.
inline View randomView(Random& random, const Camera& camera = {}, const glm::dvec3& reach = {20, 4, 20}) {
    const glm::dvec3 eye = randomVector(random, reach);
    return viewFrom(eye, randomVector(random, {1, 0.5, 1}), camera);
}

/// Views of every kind from within 5 units of a place: of 1 to 150 degrees, with and without a far plane, off-centre,
/// stretched, and parallel.
inline View anyView(Random& random, const glm::dvec3& place = glm::dvec3(0.0)) {
    View view;
    view.width = 1 + static_cast<uint32_t>(random.below(2000));
    view.height = 1 + static_cast<uint32_t>(random.below(2000));
    const glm::dvec3 eye = place + randomVector(random, 5.0), direction = randomUnit(random);
    view.view = lookAt(eye, eye + direction, randomUnit(random));
    const double aspect = random.uniform(0.5, 2);
    if (random.below(4) == 0) {
        view.projection = orthographic(random.uniform(0.1, 30), aspect, 0.1, 100.0);
        return view;
    }
    const double angle = glm::radians(random.uniform(1, 150));
    view.projection = random.below(3) ? perspective(angle, aspect, 0.1) : perspective(angle, aspect, 0.1, 100.0);
    if (random.below(3) == 0) view.projection[2] += glm::dvec4(random.uniform(-1, 1), random.uniform(-1, 1), 0, 0);
    return view;
}

}  // namespace sightline::test
