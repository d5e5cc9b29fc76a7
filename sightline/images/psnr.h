// How much two pictures differ: the peak signal-to-noise ratio.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstddef>
#include <limits>
#include <span>

#include <glm/glm.hpp>

namespace sightline::images {

/// Squared differences of pictures' bytes, summed up over as many as one likes.
struct PictureError {
    double squares = 0;
    size_t bytes = 0;

    void add(const glm::u8vec3& a, const glm::u8vec3& b) {
        for (int channel = 0; channel < 3; ++channel) {
            const double difference = double(a[channel]) - double(b[channel]);
            squares += difference * difference;
        }
        bytes += 3;
    }
    /// @param a, b  of one size
    void add(std::span<const glm::u8vec3> a, std::span<const glm::u8vec3> b) {
        for (size_t i = 0; i < a.size(); ++i) add(a[i], b[i]);
    }
    /// 10 log10 (255^2 / mean square); infinite if there is no difference  [dB]
    double psnr() const {
        if (!(squares > 0)) return std::numeric_limits<double>::infinity();
        return 10 * std::log10(255.0 * 255.0 * static_cast<double>(bytes) / squares);
    }
};

}  // namespace sightline::images
