// Depth formats: how nearness becomes the number that a z-buffer keeps, and how far apart two surfaces must be for it.
// SPDX-License-Identifier: MIT
//
// Eugene Lapidous, Guofang Jiao. Optimal Depth Buffer for Low-Cost Graphics Hardware. 1999.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <string_view>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/project/screen_polygon.h"

namespace sightline::studies {

enum class DepthFormat : uint8_t {
    kUnorm16,         ///< window depth f / (f - n) * (1 - n / z) in fixed point
    kUnorm24,         ///< the same
    kUnorm32,         ///< the same
    kFloat,           ///< the same in single precision
    kReversedFloat,   ///< 1 less that (n / z without a far plane): far is at 0, where single precision is fine
    kLinear,          ///< distance from the near to the far plane, 24 bits of fixed point
    kInverse,         ///< 1 / z in single precision
    kW,               ///< the distance itself in single precision
    kIntegerInverse,  ///< floor((2^32 - 1) * n / z)
    kIntegerShifted,  ///< floor((2^32 - 1) / (1 + z)): not affine over the image, unlike the one before
};
inline constexpr int kDepthFormats = 10;
/// As the command line says them.
inline constexpr std::string_view kDepthFormatNames[kDepthFormats] = {
    "unorm16", "unorm24", "unorm32", "float",           "reversed-float",
    "linear",  "inverse", "w",       "integer-inverse", "integer-shifted"};

/// Of the depth that comes with the one that is there.
enum class DepthComparison : uint8_t { kNever, kLess, kLessEqual, kEqual, kGreater, kGreaterEqual, kNotEqual, kAlways };
inline constexpr int kDepthComparisons = 8;

/// A stored depth as a number that compares like it: a float's bits, or a fixed-point number less 2^31.
using DepthKey = int32_t;

inline bool passes(DepthComparison comparison, DepthKey comes, DepthKey there) {
    switch (comparison) {
        case DepthComparison::kNever:
            return false;
        case DepthComparison::kLess:
            return comes < there;
        case DepthComparison::kLessEqual:
            return comes <= there;
        case DepthComparison::kEqual:
            return comes == there;
        case DepthComparison::kGreater:
            return comes > there;
        case DepthComparison::kGreaterEqual:
            return comes >= there;
        case DepthComparison::kNotEqual:
            return comes != there;
        case DepthComparison::kAlways:
            return true;
    }
    return false;
}

/// Which end of the numbers is near. Whatever is a least or a greatest depth is derived from this.
struct DepthConvention {
    DepthKey near_value = 0, far_value = 0;  ///< what the near and the far plane (or infinity) are stored as
    DepthComparison comparison = DepthComparison::kGreater;  ///< passes what is nearer: kLess or kGreater

    bool greaterIsNearer() const { return comparison == DepthComparison::kGreater; }
    DepthKey nearer(DepthKey a, DepthKey b) const { return greaterIsNearer() ? std::max(a, b) : std::min(a, b); }
    DepthKey farther(DepthKey a, DepthKey b) const { return greaterIsNearer() ? std::min(a, b) : std::max(a, b); }
};

/// Distances from the eye along the direction of view that depths are made for.
struct DepthRange {
    double near_plane = 1;  ///< [world units; > 0 in perspective]
    double far_plane = 0;   ///< > near_plane; infinity if there is none
    bool orthographic = false;
};

/// Where a view's projection puts its near and far plane. A far plane is taken for infinite from 2^30 on.
DepthRange depthRange(const View& view);

/// Turns nearness (DepthPlane: 1/w in perspective, minus the distance in parallel views) into depths. All arithmetic is
/// in double up to the last step; every step is monotonic, and so is the whole: nearer surfaces never get farther
/// depths. In parallel views, formats that divide by the distance count it from as far before the near plane as the
/// eye is, or from a thousandth of the range if the near plane lies behind the eye.
class DepthCodec {
public:
    /// @param range  kLinear, and all but the last four in parallel views, need a far plane: an infinite one stands
    ///               for 2^20 times the near plane's distance, or 2^20 units from it
    DepthCodec(DepthFormat format, const DepthRange& range);

    /// @param offset  added before rounding [unit()s; of float formats: depths]
    DepthKey encode(double nearness, double offset = 0) const {
        const double depth = std::min(std::max(value(nearness) + offset, 0.0), top);
        if (floating) return std::bit_cast<int32_t>(static_cast<float>(depth));
        return static_cast<int32_t>(std::floor(depth + half) - 0x1p31);
    }
    /// Before rounding.
    double value(double nearness) const {
        return bias + gain * (reciprocal ? 1.0 / std::max(shift + sign * nearness, floor) : nearness);
    }
    double nearnessAt(double distance) const { return range.orthographic ? -distance : 1.0 / distance; }
    DepthKey encodeDistance(double distance) const { return encode(nearnessAt(distance)); }

    /// The number as memory holds it: a float's bits, or the fixed-point number.
    uint32_t pattern(DepthKey key) const {
        return floating ? std::bit_cast<uint32_t>(key) : std::bit_cast<uint32_t>(key) ^ 0x80000000u;
    }
    DepthKey keyOf(uint32_t pattern) const {
        return std::bit_cast<int32_t>(floating ? pattern : pattern ^ 0x80000000u);
    }

    /// How far apart two surfaces at a distance must be to be sure of different depths, predicted: the quantum over the
    /// depth's slope there. At half that, they are told apart every other time. [world units]
    double stepAt(double distance) const;

    /// By how much a polygon is moved away from the eye: factor * its steepest slope over a sample + units * the
    /// smallest difference that is sure to be kept. To be given to encode().
    double polygonOffset(const DepthPlane& plane, double factor, double units) const;

    uint32_t bytes() const { return format == DepthFormat::kUnorm16 ? 2 : 4; }  ///< of a depth in memory

    DepthFormat format;
    DepthRange range;
    DepthConvention convention;
    // depth = bias + gain * nearness, or bias + gain / max(floor, shift + sign * nearness), kept within [0, top]
    bool reciprocal = false, floating = false;
    double bias = 0, gain = 1, shift = 0, sign = 1;
    double floor = 0;  ///< what is divided by is no less: before the near plane of a parallel view all is as near
    double top = 0;    ///< the greatest depth
    double half = 0;   ///< 1/2 where fixed point is rounded, 0 where it is cut off

private:
    double slope(double nearness) const;    ///< of value()
    double quantum(double nearness) const;  ///< of value(), where it is nearness's
};

}  // namespace sightline::studies
