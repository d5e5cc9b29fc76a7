// A triangle as it lies on the grid of samples, clipped and projected.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <glm/glm.hpp>

namespace sightline::studies {

/// Nearness over the samples: origin + per_row * row + per_sample * sample, kept within [low, high]. Nearness is 1/w
/// in perspective and minus the depth in eye space in parallel views: larger is nearer, and both are affine here.
struct DepthPlane {
    double origin = 0, per_row = 0, per_sample = 0, low = 0, high = 0;

    double at(double row, double sample) const {
        return std::clamp(origin + per_row * row + per_sample * sample, low, high);
    }
};

/// Convex, either winding. Points are on the grid of samples: sample i of row j lies at (i + 0.5, j + 0.5).
struct ScreenPolygon {
    static constexpr int kMaxPoints = 10;

    glm::dvec2 points[kMaxPoints];
    int count = 0;
    DepthPlane depth;      ///< of the whole triangle, over sample centres: depth.at(j, i)
    uint32_t surface = 0;  ///< DrawList's number

    std::span<const glm::dvec2> outline() const { return {points, static_cast<size_t>(count)}; }
};

/// The samples of an image, or of a band of it.
struct SampleGrid {
    uint32_t width = 0;      ///< [samples]
    uint32_t height = 0;     ///< rows of the band
    uint32_t first_row = 0;  ///< of the whole image: where the band begins
    uint32_t samples = 1;    ///< per pixel and axis
    glm::dvec2 offset{0.0};  ///< shift of the grid [pixels]
};

}  // namespace sightline::studies
