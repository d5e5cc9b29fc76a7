// Windows clipped by planes, and the planes that separate two windows: once per instruction set, the same bits on each.
// SPDX-License-Identifier: MIT
//
// Seth Teller. Computing the Antipenumbra of an Area Light Source. 1992.

#if defined(SIGHTLINE_BAKE_WINDOW_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_BAKE_WINDOW_INL
#undef SIGHTLINE_BAKE_WINDOW_INL
#else
#define SIGHTLINE_BAKE_WINDOW_INL
#endif

#include <algorithm>

#include <hwy/highway.h>

#include "sightline/bake/flow/window.h"

HWY_BEFORE_NAMESPACE();
namespace sightline::bake::HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

using Doubles = hn::CappedTag<double, 8>;
using Double = hn::Vec<Doubles>;
using DoubleMask = hn::Mask<Doubles>;

/// Cuts off the part whose height above the plane is less than `lowest`, and never more than that, up to rounding. New
/// corners lie on edges. A window that has no room for more corners stays whole.
/// @param touching  a window whose highest corner is below this is gone
HWY_INLINE Clipped clip(Window& window, const glm::dvec4& plane, double lowest, double touching) {
    const Doubles d;
    const size_t lanes = hn::Lanes(d);
    HWY_ALIGN double heights[Window::kRoom];
    heights[0] = 0;
    const auto x = hn::Set(d, plane.x), y = hn::Set(d, plane.y), z = hn::Set(d, plane.z), w = hn::Set(d, plane.w);
    for (size_t i = 0; i < window.count; i += lanes)
        hn::StoreU(
            hn::Add(hn::Add(hn::Add(hn::Mul(x, hn::LoadU(d, window.x + i)), hn::Mul(y, hn::LoadU(d, window.y + i))),
                            hn::Mul(z, hn::LoadU(d, window.z + i))),
                    w),
            d, heights + i);
    double high = heights[0], low = heights[0];
    for (uint32_t i = 1; i < window.count; ++i) {
        high = std::max(high, heights[i]);
        low = std::min(low, heights[i]);
    }
    if (high < touching) return Clipped::kGone;
    if (low >= lowest || window.count >= Window::kMost) return Clipped::kWhole;
    Window kept;
    for (uint32_t i = 0; i < window.count; ++i) {
        const uint32_t next = i + 1 == window.count ? 0 : i + 1;
        const double a = heights[i], b = heights[next];
        if (a >= lowest) kept.add(window.corner(i));
        if ((a >= lowest) == (b >= lowest)) continue;
        // From the lower end to the higher one, whichever way the edge runs: both sides of an edge get the same point.
        const uint32_t from = a < b ? i : next, to = a < b ? next : i;
        const double share = (lowest - heights[from]) / (heights[to] - heights[from]);
        kept.add(window.corner(from) + share * (window.corner(to) - window.corner(from)));
    }
    if (kept.count == 0) return Clipped::kGone;
    kept.close();
    window.assign(kept);
    return Clipped::kCut;
}

/// Clips by all planes, one after the other.
HWY_INLINE Clipped clip(Window& window, const Separators& planes, double lowest, double touching) {
    const Doubles d;
    const size_t lanes = hn::Lanes(d);
    Clipped answer = Clipped::kWhole;
    for (size_t i = 0; i < planes.count; i += lanes) {
        const auto x = hn::LoadU(d, planes.x + i), y = hn::LoadU(d, planes.y + i), z = hn::LoadU(d, planes.z + i),
                   w = hn::LoadU(d, planes.w + i);
        auto high = hn::Set(d, -1e300), low = hn::Set(d, 1e300);
        for (uint32_t k = 0; k < window.count; ++k) {
            const auto height =
                hn::Add(hn::Add(hn::Add(hn::Mul(x, hn::Set(d, window.x[k])), hn::Mul(y, hn::Set(d, window.y[k]))),
                                hn::Mul(z, hn::Set(d, window.z[k]))),
                        w);
            high = hn::Max(high, height);
            low = hn::Min(low, height);
        }
        const auto inside = hn::FirstN(d, planes.count - i);
        if (!hn::AllFalse(d, hn::And(inside, hn::Lt(high, hn::Set(d, touching))))) return Clipped::kGone;
        const auto cuts = hn::And(inside, hn::Lt(low, hn::Set(d, lowest)));
        if (hn::AllFalse(d, cuts)) continue;
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, cuts, bits);
        for (uint32_t left = bits[0]; left; left &= left - 1) {
            const size_t at = i + static_cast<size_t>(hwy::Num0BitsBelowLS1Bit_Nonzero32(left));
            const Clipped one =
                clip(window, glm::dvec4(planes.x[at], planes.y[at], planes.z[at], planes.w[at]), lowest, touching);
            if (one == Clipped::kGone) return one;
            if (one == Clipped::kCut) answer = one;
        }
    }
    return answer;
}

/// How well points and planes are known.
struct Precision {
    double points;    ///< [world units] half the distance within which two points are the same
    double rounding;  ///< [world units] the error of sums and products of coordinates
    double reach;     ///< [world units] no two points are farther apart
};

/// The shortest edge with a shared corner whose planes are taken: a shorter one would let them turn too far.
constexpr double kShortestShared = 0x1p16;  // [precisions]

/// @param heights  of the corners above the plane  [size: window.count]
HWY_INLINE void heightsOf(const Window& window, const glm::dvec4& plane, double* heights) {
    for (uint32_t k = 0; k < window.count; ++k)
        heights[k] = plane.x * window.x[k] + plane.y * window.y[k] + plane.z * window.z[k] + plane.w;
}

/// How far corners of a window lie beyond the lines (m, -ma) of some of its edges.
HWY_INLINE Double bulgeOf(const Window& window, Double mx, Double my, Double mz, Double ma) {
    const Doubles d;
    auto bulge = hn::Zero(d);
    for (uint32_t k = 0; k < window.count && !window.straight; ++k) {
        const auto x = hn::Add(hn::Add(hn::Mul(mx, hn::Set(d, window.x[k])), hn::Mul(my, hn::Set(d, window.y[k]))),
                               hn::Mul(mz, hn::Set(d, window.z[k])));
        bulge = hn::Max(bulge, hn::Sub(x, ma));
    }
    return bulge;
}

/// Appends the valid ones of some planes, scaled.
HWY_INLINE void addPlanes(Double x, Double y, Double z, Double w, Double scale, DoubleMask valid, Separators& out) {
    const Doubles d;
    hn::CompressStore(hn::Mul(x, scale), valid, d, out.x + out.count);
    hn::CompressStore(hn::Mul(y, scale), valid, d, out.y + out.count);
    hn::CompressStore(hn::Mul(z, scale), valid, d, out.z + out.count);
    out.count += static_cast<uint32_t>(hn::CompressStore(hn::Mul(w, scale), valid, d, out.w + out.count));
}

/// For each edge of one window the plane through it, with that window below, that touches the other from below.
///
/// With n the normal of the window's plane towards the other, and m the direction in the plane out of the edge, all
/// planes through the edge with the window below are c n + m. A corner of the other at height y and x beyond the edge
/// is above by t if c y + x >= t: the largest c that one of them asks for is the plane that touches.
/// @param turning  1: own's corners run counter-clockwise about the normal; -1: clockwise
/// @param over     the planes are turned over, so that own lies above them
HWY_INLINE void addEdgePlanes(const Window& own, const glm::dvec4& plane, double turning, const Window& other,
                              bool over, const Precision& precision, Separators& out) {
    const Doubles d;
    const size_t lanes = hn::Lanes(d);
    const double above = 2 * precision.points;
    double heights[Window::kMost], inverse[Window::kMost], highest = 0;
    heightsOf(other, plane, heights);
    for (uint32_t k = 0; k < other.count; ++k) {
        inverse[k] = 1 / heights[k];
        highest = std::max(highest, heights[k]);
    }
    if (!(highest > precision.points)) return;
    double own_heights[Window::kMost], bend = 0;
    heightsOf(own, plane, own_heights);
    for (uint32_t i = 0; i < own.count; ++i) bend = std::max(bend, std::abs(own_heights[i]));
    const auto nx = hn::Set(d, plane.x), ny = hn::Set(d, plane.y), nz = hn::Set(d, plane.z);
    Double beyond[Window::kMost];
    for (size_t i = 0; i < own.count; i += lanes) {
        const auto ax = hn::LoadU(d, own.x + i), ay = hn::LoadU(d, own.y + i), az = hn::LoadU(d, own.z + i);
        const auto bx = hn::LoadU(d, own.x + i + 1), by = hn::LoadU(d, own.y + i + 1), bz = hn::LoadU(d, own.z + i + 1);
        const auto ex = hn::Sub(bx, ax), ey = hn::Sub(by, ay), ez = hn::Sub(bz, az);
        const auto length = hn::Sqrt(hn::Add(hn::Add(hn::Mul(ex, ex), hn::Mul(ey, ey)), hn::Mul(ez, ez)));
        auto valid = hn::And(hn::FirstN(d, own.count - i), hn::Gt(length, hn::Set(d, 4 * precision.points)));
        const auto turn = hn::Div(hn::Set(d, turning), length);
        const auto mx = hn::Mul(turn, hn::Sub(hn::Mul(ey, nz), hn::Mul(ez, ny)));
        const auto my = hn::Mul(turn, hn::Sub(hn::Mul(ez, nx), hn::Mul(ex, nz)));
        const auto mz = hn::Mul(turn, hn::Sub(hn::Mul(ex, ny), hn::Mul(ey, nx)));
        const auto ma = hn::Add(hn::Add(hn::Mul(mx, ax), hn::Mul(my, ay)), hn::Mul(mz, az));
        auto c = hn::Set(d, -1e300);
        auto shared = hn::Lt(length, hn::Zero(d));  // none
        for (uint32_t k = 0; k < other.count; ++k) {
            const auto vx = hn::Set(d, other.x[k]), vy = hn::Set(d, other.y[k]), vz = hn::Set(d, other.z[k]);
            const auto x = hn::Sub(hn::Add(hn::Add(hn::Mul(mx, vx), hn::Mul(my, vy)), hn::Mul(mz, vz)), ma);
            beyond[k] = x;
            if (heights[k] > precision.points) {
                c = hn::Max(c, hn::Mul(hn::Sub(hn::Set(d, above), x), hn::Set(d, inverse[k])));
                continue;
            }
            const auto same_a = hn::And(hn::And(hn::Eq(ax, vx), hn::Eq(ay, vy)), hn::Eq(az, vz));
            const auto same_b = hn::And(hn::And(hn::Eq(bx, vx), hn::Eq(by, vy)), hn::Eq(bz, vz));
            const auto same = hn::Or(same_a, same_b);
            shared = hn::Or(shared, same);
            valid = hn::And(valid, hn::Or(same, hn::Gt(x, hn::Set(d, above))));
            beyond[k] = hn::IfThenElse(same, hn::Set(d, 1e300), x);
        }
        valid = hn::And(valid, hn::Or(hn::Not(shared), hn::Gt(length, hn::Set(d, kShortestShared * precision.points))));
        valid = hn::And(valid, hn::Lt(hn::Abs(c), hn::Set(d, 1e5)));
        if (hn::AllFalse(d, valid)) continue;
        // The corners themselves are measured: rounding may have bent the outline outward beside a short edge.
        const auto bulge = bulgeOf(own, mx, my, mz, ma);
        auto low = hn::Set(d, 1e300);
        for (uint32_t k = 0; k < other.count; ++k)
            low = hn::Min(low, hn::Add(hn::Mul(c, hn::Set(d, heights[k])), beyond[k]));
        const auto one = hn::Set(d, 1.0);
        const auto noise = hn::Add(hn::Add(hn::Mul(hn::Abs(c), hn::Set(d, bend)), bulge),
                                   hn::Mul(hn::Add(hn::Abs(c), one), hn::Set(d, precision.rounding)));
        valid = hn::And(valid, hn::Gt(low, hn::Add(noise, noise)));
        const auto px = hn::Add(hn::Mul(c, nx), mx), py = hn::Add(hn::Mul(c, ny), my), pz = hn::Add(hn::Mul(c, nz), mz);
        auto pw = hn::Sub(hn::Mul(c, hn::Set(d, plane.w)), ma);
        // At a shared corner only the edge holds the plane. An error at the ends of the edge turns the plane, and the
        // error grows with the distance.
        const auto turned = hn::Mul(noise, hn::Div(hn::Set(d, precision.reach), length));
        const auto slack = hn::Add(noise, hn::IfThenElseZero(shared, turned));
        auto scale = hn::Div(one, hn::Sqrt(hn::Add(hn::Add(hn::Mul(px, px), hn::Mul(py, py)), hn::Mul(pz, pz))));
        if (over) {
            scale = hn::Neg(scale);
            pw = hn::Sub(pw, slack);
        } else {
            pw = hn::Add(pw, hn::IfThenElse(shared, slack, hn::Sub(noise, low)));
        }
        addPlanes(px, py, pz, pw, scale, valid, out);
    }
}

/// The planes through an edge of one window and a corner of the other that separate them: O(n m).
///
/// They separate in the numbers as they are, not only to within rounding: a plane is turned about its edge until all
/// corners of the other window are above those of its own by more than rounding can do, and is left out if they are
/// not. Corners that both windows have (the same numbers) may lie in the plane.
/// @param first_plane   of the first window's portal: the normal points towards the second window
/// @param second_plane  of the second window's portal: the normal points away from the first window
/// @param turning       1: the corners run counter-clockwise about these normals; -1: clockwise
HWY_INLINE void separate(const Window& first, const glm::dvec4& first_plane, const Window& second,
                         const glm::dvec4& second_plane, double turning, const Precision& precision, Separators& out) {
    out.count = 0;
    addEdgePlanes(first, first_plane, turning, second, false, precision, out);
    addEdgePlanes(second, -second_plane, -turning, first, true, precision, out);
}

}  // namespace sightline::bake::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif  // SIGHTLINE_BAKE_WINDOW_INL
