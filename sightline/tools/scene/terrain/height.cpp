// Heights of a procedural terrain: mountains, hills and valleys from seeded noise.
// SPDX-License-Identifier: MIT
//
// Ken Perlin. Improving Noise. 2002. F. Kenton Musgrave, Craig Kolb, Robert Mace. The Synthesis and Rendering of Eroded
// Fractal Terrains. 1989.
#include "sightline/tools/scene/terrain/height.h"

#include <algorithm>
#include <cmath>

namespace sightline::tools::terrain {
namespace {

/// A gradient for each point of the lattice, with components from -1 to 1.
glm::dvec2 gradient(uint64_t seed, int64_t x, int64_t z) {
    uint64_t h =
        seed ^ (static_cast<uint64_t>(x) * 0x9e3779b97f4a7c15ull) ^ (static_cast<uint64_t>(z) * 0xc2b2ae3d27d4eb4full);
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull;
    h = (h ^ (h >> 32)) * 0xd6e8feb86659fd93ull;
    h ^= h >> 32;
    return {static_cast<double>(h & 0xffff) / 32767.5 - 1, static_cast<double>((h >> 16) & 0xffff) / 32767.5 - 1};
}

double fade(double t) { return t * t * t * (t * (t * 6 - 15) + 10); }
double fadeSlope(double t) { return 30 * t * t * (t * (t - 2) + 1); }

double smooth(double low, double high, double x) {
    const double t = std::clamp((x - low) / (high - low), 0.0, 1.0);
    return t * t * (3 - 2 * t);
}

/// Sharp crests where the noise passes through zero; each octave keeps to the crests of the one before. 0 to about 1.
double ridges(uint64_t seed, glm::dvec2 at, int octaves) {
    double sum = 0, height = 0.5, weight = 1;
    for (int i = 0; i < octaves; ++i) {
        double crest = 1 - std::abs(noise(seed + static_cast<uint64_t>(i), at).value);
        crest = std::max(0.0, crest * crest) * weight;
        weight = std::clamp(1.5 * crest, 0.0, 1.0);
        sum += crest * height;
        at = glm::dvec2(1.6 * at.x + 1.2 * at.y + 7.3, 1.6 * at.y - 1.2 * at.x - 3.1);  // twice as fine, turned
        height *= 0.5;
    }
    return sum;
}

}  // namespace

Noise noise(uint64_t seed, const glm::dvec2& at) {
    const double x = std::floor(at.x), z = std::floor(at.y);
    const auto i = static_cast<int64_t>(x), j = static_cast<int64_t>(z);
    const double u = at.x - x, v = at.y - z;
    const glm::dvec2 ga = gradient(seed, i, j), gb = gradient(seed, i + 1, j);
    const glm::dvec2 gc = gradient(seed, i, j + 1), gd = gradient(seed, i + 1, j + 1);
    const double a = ga.x * u + ga.y * v, b = gb.x * (u - 1) + gb.y * v;
    const double c = gc.x * u + gc.y * (v - 1), d = gd.x * (u - 1) + gd.y * (v - 1);
    const double s = fade(u), t = fade(v), k = a - b - c + d;
    Noise result;
    result.value = a + s * (b - a) + t * (c - a) + s * t * k;
    result.slope = ga + s * (gb - ga) + t * (gc - ga) + s * t * (ga - gb - gc + gd) +
                   glm::dvec2(fadeSlope(u) * (b - a + t * k), fadeSlope(v) * (c - a + s * k));
    return result;
}

double wornNoise(uint64_t seed, const glm::dvec2& at, int octaves) {
    glm::dvec2 point = at, slope(0);
    double sum = 0, height = 1;
    for (int i = 0; i < octaves; ++i) {
        const Noise octave = noise(seed + static_cast<uint64_t>(i), point);
        slope += octave.slope;
        sum += height * octave.value / (1 + 0.5 * glm::dot(slope, slope));
        point = glm::dvec2(1.6 * point.x + 1.2 * point.y, 1.6 * point.y - 1.2 * point.x);
        height *= 0.5;
    }
    return sum;
}

double heightAt(uint64_t seed, const glm::dvec2& at) {
    // The land, its mountains where it is high, hills all over, and valleys along the zeros of one more field.
    const glm::dvec2 wide = at / 640.0;
    const glm::dvec2 warp(noise(seed + 11, wide).value, noise(seed + 12, wide).value);
    const double land = noise(seed + 21, at / 2200.0 + 0.37).value;
    const glm::dvec2 bent = at + 90.0 * warp;
    const double mountains = smooth(-0.2, 0.35, land);
    const double hills = wornNoise(seed + 31, bent / 340.0, 7);
    const double crests = ridges(seed + 41, bent / 820.0 + 0.21, 6);
    const double valley = 1 - smooth(0.01, 0.16, std::abs(noise(seed + 51, (at + 60.0 * warp) / 900.0).value));
    double height = 60 * land + 85 * hills + (60 + 380 * mountains) * crests * crests;
    // A valley pulls the ground towards its floor, which rises and falls along it.
    const double floor = -12 + 30 * noise(seed + 61, at / 420.0).value + 8 * hills;
    height += (floor - height) * 0.94 * valley;
    return height;
}

HeightField::HeightField(uint64_t seed, uint32_t size)
    : size_(size), low_(-kSpacing * (size / 2)), heights_(size_t{size} * size) {
    for (uint32_t j = 0; j < size; ++j)
        for (uint32_t i = 0; i < size; ++i)
            heights_[size_t{j} * size + i] =
                static_cast<float>(heightAt(seed, {low_ + kSpacing * i, low_ + kSpacing * j}));
}

double HeightField::ground(const glm::dvec2& point) const {
    const double last = static_cast<double>(size_ - 1);
    const double x = std::clamp((point.x - low_) / kSpacing, 0.0, last),
                 z = std::clamp((point.y - low_) / kSpacing, 0.0, last);
    const auto i = std::min(static_cast<uint32_t>(x), size_ - 2), j = std::min(static_cast<uint32_t>(z), size_ - 2);
    const double u = x - i, v = z - j;
    const double a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
    // The squares are cut from (i, j) to (i + 1, j + 1).
    return u > v ? a + u * (b - a) + v * (c - b) : a + v * (d - a) + u * (c - d);
}

glm::dvec2 HeightField::slope(const glm::dvec2& point) const {
    constexpr double kReach = 2;
    const double x = ground(point + glm::dvec2(kReach, 0)) - ground(point - glm::dvec2(kReach, 0));
    const double z = ground(point + glm::dvec2(0, kReach)) - ground(point - glm::dvec2(0, kReach));
    return glm::dvec2(x, z) / (2 * kReach);
}

}  // namespace sightline::tools::terrain
