// Heights of a procedural terrain: mountains, hills and valleys from seeded noise.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::tools::terrain {

inline constexpr double kSpacing = 2;      ///< from sample to sample             [metres]
inline constexpr double kLakeLevel = -14;  ///< height of all water               [metres]

/// A smooth random field: 0 at the points of a lattice, about -1 to 1 between them.
struct Noise {
    double value = 0;
    glm::dvec2 slope{0};  ///< per unit of the lattice
};

/// @param at  [lattice units]
Noise noise(uint64_t seed, const glm::dvec2& at);

/// Octaves of noise, each half as wide and half as high as the one before; a steep place gets less of the rest, as
/// if it had been worn. About -1 to 1.
double wornNoise(uint64_t seed, const glm::dvec2& at, int octaves);

/// Ground level at a point, (x, z) in metres: continuous, and the same for terrains of all sizes. A valley runs
/// through the origin.
double heightAt(uint64_t seed, const glm::dvec2& at);

/// The samples of one terrain. Heights are floats, as they are drawn.
class HeightField {
public:
    HeightField(uint64_t seed, uint32_t size);

    uint32_t size() const { return size_; }
    /// Of sample 0; the same for x and z.
    double low() const { return low_; }
    double high() const { return low_ + kSpacing * (size_ - 1); }
    float at(uint32_t i, uint32_t j) const { return heights_[size_t{j} * size_ + i]; }
    glm::vec3 position(uint32_t i, uint32_t j) const {
        return {static_cast<float>(low_ + kSpacing * i), at(i, j), static_cast<float>(low_ + kSpacing * j)};
    }

    /// Height of the drawn triangle over a point, (x, z). Points outside are moved to the rim.
    double ground(const glm::dvec2& point) const;
    /// Rise of the ground there, over a few metres, in both directions.
    glm::dvec2 slope(const glm::dvec2& point) const;

private:
    uint32_t size_;
    double low_;
    std::vector<float> heights_;  ///< rows along x
};

}  // namespace sightline::tools::terrain
