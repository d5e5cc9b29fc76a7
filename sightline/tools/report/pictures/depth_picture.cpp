// A picture of an occlusion buffer: what it claims, near to far, and where it is open.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/depth_picture.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace sightline::tools {

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

Image<Rgb> viewportPart(const Image<Rgb>& buffer, const glm::dvec2& viewport, double jitter, uint32_t width,
                        uint32_t height) {
    const auto from = [&](uint32_t at, uint32_t count, double pixels, uint32_t side) {
        const double place = ((at + 0.5) / count * pixels + jitter) / (pixels + 2.0 * jitter) * side;
        return std::min(static_cast<uint32_t>(std::max(place, 0.0)), side - 1);
    };
    Image<Rgb> out(width, height, kOpenPixel);
    if (buffer.width == 0 || buffer.height == 0) return out;
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x)
            out.at(x, y) =
                buffer.at(from(x, width, viewport.x, buffer.width), from(y, height, viewport.y, buffer.height));
    return out;
}

}  // namespace sightline::tools
