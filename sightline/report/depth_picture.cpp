// A picture of an occlusion buffer: what it claims, near to far, and where it is open.
// SPDX-License-Identifier: MIT
#include "sightline/report/depth_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline {

Image<Rgb> depthPicture(const DepthClaims& claims) {
    constexpr double kDark = 24, kLight = 244;
    const auto farness = [&](size_t i) {
        const double nearness = claims.nearness[i];
        return claims.perspective ? -std::log(std::max(nearness, 1e-300)) : -nearness;
    };
    double nearest = std::numeric_limits<double>::infinity(), farthest = -nearest;
    for (size_t i = 0; i < claims.nearness.size(); ++i) {
        if (!claims.covered[i] || !std::isfinite(farness(i))) continue;
        nearest = std::min(nearest, farness(i));
        farthest = std::max(farthest, farness(i));
    }
    Image<Rgb> image(claims.width, claims.height, kOpenPixel);
    for (uint32_t y = 0; y < claims.height; ++y)
        for (uint32_t x = 0; x < claims.width; ++x) {
            const size_t from = size_t{claims.height - 1 - y} * claims.width + x;
            if (!claims.covered[from]) continue;
            const double part = farthest > nearest ? (farness(from) - nearest) / (farthest - nearest) : 0.0;
            image.at(x, y) =
                Rgb(static_cast<uint8_t>(std::lround(kLight + (kDark - kLight) * std::clamp(part, 0.0, 1.0))));
        }
    return image;
}

}  // namespace sightline
