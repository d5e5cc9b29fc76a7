// Depth formats: how nearness becomes the number that a z-buffer keeps, and how far apart two surfaces must be for it.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/zbuffer/depth_format.h"

#include <limits>

namespace sightline::studies {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

bool needsFarPlane(DepthFormat format, bool orthographic) {
    if (format == DepthFormat::kLinear) return true;
    return orthographic && format < DepthFormat::kInverse;
}

double fixedPointTop(DepthFormat format) {
    switch (format) {
        case DepthFormat::kUnorm16:
            return 0x1p16 - 1;
        case DepthFormat::kUnorm24:
        case DepthFormat::kLinear:
            return 0x1p24 - 1;
        default:
            return 0x1p32 - 1;
    }
}

bool isFloating(DepthFormat format) {
    return format == DepthFormat::kFloat || format == DepthFormat::kReversedFloat || format == DepthFormat::kInverse ||
           format == DepthFormat::kW;
}

}  // namespace

DepthRange depthRange(const View& view) {
    const glm::dmat4& p = view.projection;
    DepthRange range;
    range.orthographic = isOrthographic(view);
    if (range.orthographic) {
        const double w = p[3][3];
        range.near_plane = (w + p[3][2]) / p[2][2];
        range.far_plane = (p[3][2] - w) / p[2][2];
        if (!std::isfinite(range.near_plane)) range.near_plane = 0;
        if (!(range.far_plane > range.near_plane && range.far_plane < 0x1p30)) range.far_plane = kInfinity;
    } else {
        // z = p22 / p23 * w + p32: equal to -w at the near plane, to w at the far one.
        const double slope = p[2][2] / p[2][3];
        range.near_plane = -p[3][2] / (slope + 1);
        range.far_plane = p[3][2] / (1 - slope);
        if (!(range.near_plane > 0 && range.near_plane < kInfinity)) range.near_plane = 1;
        if (!(range.far_plane > range.near_plane && range.far_plane < 0x1p30 * range.near_plane))
            range.far_plane = kInfinity;
    }
    return range;
}

DepthCodec::DepthCodec(DepthFormat format_, const DepthRange& range_) : format(format_), range(range_) {
    const bool parallel = range.orthographic;
    if (range.far_plane == kInfinity && needsFarPlane(format, parallel))
        range.far_plane = parallel ? range.near_plane + 0x1p20 : range.near_plane * 0x1p20;
    const double n = range.near_plane, f = range.far_plane;
    floating = isFloating(format);
    top = floating ? std::numeric_limits<float>::max() : fixedPointTop(format);
    half = floating || format >= DepthFormat::kIntegerInverse ? 0.0 : 0.5;
    const double base =
        n > 0 ? n : (f < kInfinity ? (f - n) / 1000 : 1.0);  // the near plane's distance, in parallel views
    const bool from_distance = parallel && format >= DepthFormat::kInverse;
    if (from_distance) {
        floor = base / 2;
        shift = base - n;
        sign = -1;
    }
    const double scale = floating ? 1.0 : top;
    bool greater = true;
    switch (format) {
        case DepthFormat::kUnorm16:
        case DepthFormat::kUnorm24:
        case DepthFormat::kUnorm32:
        case DepthFormat::kFloat: {
            const double most = f == kInfinity ? 1.0 : f / (f - n);
            bias = parallel ? -n / (f - n) * scale : most * scale;
            gain = parallel ? -scale / (f - n) : -most * n * scale;
            greater = false;
            break;
        }
        case DepthFormat::kReversedFloat:
            bias = parallel ? f / (f - n) : f == kInfinity ? 0.0 : -n / (f - n);
            gain = parallel ? 1 / (f - n) : f == kInfinity ? n : n * (f / (f - n));
            break;
        case DepthFormat::kLinear:
            reciprocal = !parallel;
            bias = -n / (f - n) * scale;
            gain = (parallel ? -scale : scale) / (f - n);
            greater = false;
            break;
        case DepthFormat::kInverse:
            reciprocal = parallel;
            break;
        case DepthFormat::kW:
            reciprocal = !parallel;
            if (parallel) {
                bias = shift;
                gain = -1;
            }
            greater = false;
            break;
        case DepthFormat::kIntegerInverse:
            reciprocal = parallel;
            gain = scale * base;
            break;
        case DepthFormat::kIntegerShifted:
            reciprocal = true;
            shift += 1;
            floor += parallel ? 1 : 0;
            // 1 / (1 + 1/v) = 1 - 1 / (1 + v)
            bias = parallel ? 0.0 : scale;
            gain = parallel ? scale : -scale;
            break;
    }
    convention.comparison = greater ? DepthComparison::kGreater : DepthComparison::kLess;
    convention.near_value = encode(nearnessAt(n));
    convention.far_value = encode(f == kInfinity ? (parallel ? -0x1p60 : 0.0) : nearnessAt(f));
    if (format == DepthFormat::kW) convention.far_value = std::bit_cast<int32_t>(static_cast<float>(top));
}

double DepthCodec::slope(double nearness) const {
    if (!reciprocal) return std::abs(gain);
    const double below = std::max(shift + sign * nearness, floor);
    return std::abs(gain) / (below * below);
}

double DepthCodec::quantum(double nearness) const {
    if (!floating) return 1;
    const double depth = std::abs(value(nearness));
    return std::ldexp(1.0, std::max(depth > 0 ? std::ilogb(depth) : -126, -126) - 23);
}

double DepthCodec::stepAt(double distance) const {
    const double nearness = nearnessAt(distance);
    const double change = range.orthographic ? 1.0 : nearness * nearness;  // of nearness with the distance
    return quantum(nearness) / (slope(nearness) * change);
}

double DepthCodec::polygonOffset(const DepthPlane& plane, double factor, double units) const {
    if (factor == 0 && units == 0) return 0;
    const double tilt = std::max(std::abs(plane.per_row), std::abs(plane.per_sample));
    const double steepest = std::max(slope(plane.low), slope(plane.high)) * tilt;
    const double smallest = std::max(quantum(plane.low), quantum(plane.high));
    const double offset = factor * steepest + units * smallest;
    return convention.greaterIsNearer() ? -offset : offset;
}

}  // namespace sightline::studies
