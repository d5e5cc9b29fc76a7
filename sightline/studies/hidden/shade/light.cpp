// The light that pictures are lit with: one sun, a sky, haze, and colours for things that have none.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/shade/light.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/random.h"

namespace sightline::studies {
namespace {

uint8_t toByte(double linear) {
    const double v = std::clamp(linear, 0.0, 1.0);
    const double encoded = v <= 0.0031308 ? 12.92 * v : 1.055 * std::pow(v, 1 / 2.4) - 0.055;
    return static_cast<uint8_t>(255 * encoded + 0.5);
}

}  // namespace

glm::dvec3 defaultSun() { return glm::normalize(glm::dvec3(0.45, 0.75, 0.5)); }

glm::dvec3 hashedColour(uint64_t key) {
    Random random(mixSeed(key, 1));
    const double hue = random.uniform(0, 6), grey = random.uniform(0.45, 0.7);
    const auto channel = [&](double shift) {
        const double distance = std::abs(std::fmod(hue + shift, 6.0) - 3.0);
        return grey * (0.62 + 0.38 * std::clamp(distance - 1.0, 0.0, 1.0));
    };
    return {channel(0), channel(4), channel(2)};
}

glm::dvec3 skyColour(double above_horizon) {
    const double t = std::clamp(0.5 + 1.2 * above_horizon, 0.0, 1.0);
    return glm::mix(glm::dvec3(0.80, 0.84, 0.87), glm::dvec3(0.38, 0.55, 0.78), t);
}

double lightOn(const glm::dvec3& normal, const glm::dvec3& sun, double reach) {
    const glm::dvec3 opposite(-sun.x, 0, -sun.z);
    const double other_side = 0.5 + 0.5 * glm::dot(normal, opposite);
    return 0.22 + 0.16 * (0.5 + 0.5 * normal.y) + 0.14 * other_side +
           0.58 * reach * std::max(0.0, glm::dot(normal, sun));
}

glm::dvec3 throughHaze(const glm::dvec3& colour, const glm::dvec3& sky, double distance) {
    return glm::mix(colour, sky, 0.5 * (1 - std::exp(-1.6 * distance)));
}

glm::u8vec3 toBytes(const glm::dvec3& linear) { return {toByte(linear.x), toByte(linear.y), toByte(linear.z)}; }

}  // namespace sightline::studies
