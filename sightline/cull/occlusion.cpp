// Occlusion against the depth tiles: occludee boxes become pixel rectangles, visible occluders are drawn.
// SPDX-License-Identifier: MIT
#include "sightline/cull/occlusion.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/buffer/validate_tiles.h"
#include "sightline/cull/frustum.h"

#ifndef SIGHTLINE_CULL_CORNER_BOUNDS
#define SIGHTLINE_CULL_CORNER_BOUNDS
namespace sightline {
namespace {

/// What the corners of a box are on the screen: bounds, and the sizes of the terms that they come from.
struct CornerBounds {
    double x0, y0, x1, y1, w_least, near_least, d_most, w_size, near_size, d_size;
};

/// What eight boxes are on the screen, before they are rounded to whole pixels.
struct BoxBounds {
    alignas(64) float x0[8], y0[8], x1[8], y1[8], nearness[8];
    uint32_t doubt, outside;  ///< bit per box: it cannot be projected; no point of it is drawn, it has no bounds
};

}  // namespace
}  // namespace sightline
#endif

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/occlusion.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;
using V = hn::Vec<F8>;

/// A row of the screen map over eight boxes: the terms of each axis at both bounds, and the rounding.
struct RowTerms {
    V low[3], high[3], constant, error;
};

HWY_INLINE RowTerms rowTerms(F8 d, const glm::dvec4& row, const EyeBoxes& boxes, size_t i) {
    RowTerms t;
    t.constant = hn::Set(d, static_cast<float>(row.w));
    V size = hn::Abs(t.constant);
    for (int axis = 0; axis < 3; ++axis) {
        const V factor = hn::Set(d, static_cast<float>(row[axis]));
        t.low[axis] = hn::Mul(factor, hn::Load(d, boxes.min[axis] + i));
        t.high[axis] = hn::Mul(factor, hn::Load(d, boxes.max[axis] + i));
        size = hn::Add(size, hn::Max(hn::Abs(t.low[axis]), hn::Abs(t.high[axis])));
    }
    t.error = hn::Mul(size, hn::Set(d, 0x1p-20f));  // eight roundings of 2^-24 or 2^-23 of the sum of sizes
    return t;
}

HWY_INLINE V corner(const RowTerms& t, int which) {
    return hn::Add(hn::Add(which & 1 ? t.high[0] : t.low[0], which & 2 ? t.high[1] : t.low[1]),
                   hn::Add(which & 4 ? t.high[2] : t.low[2], t.constant));
}

HWY_INLINE V least(const RowTerms& t) {
    return hn::Add(hn::Add(hn::Min(t.low[0], t.high[0]), hn::Min(t.low[1], t.high[1])),
                   hn::Add(hn::Min(t.low[2], t.high[2]), t.constant));
}

HWY_INLINE V greatest(const RowTerms& t) {
    return hn::Add(hn::Add(hn::Max(t.low[0], t.high[0]), hn::Max(t.low[1], t.high[1])),
                   hn::Add(hn::Max(t.low[2], t.high[2]), t.constant));
}

/// Which boxes have no point before the eye on the near side of a border of the buffer: neither pixel >= 0 nor, with the
/// other row, pixel <= size. w is positive there, so that x.h and size * w.h - x.h tell.
HWY_INLINE hn::Mask<F8> missesBorders(F8 d, const RowTerms& across, const RowTerms& w, double size) {
    const V pixels = hn::Set(d, static_cast<float>(size)), zero = hn::Zero(d);
    const auto below = hn::Lt(hn::Add(greatest(across), across.error), zero);
    V most = hn::Sub(hn::Mul(pixels, w.constant), across.constant);
    for (int axis = 0; axis < 3; ++axis)
        most = hn::Add(most, hn::Max(hn::Sub(hn::Mul(pixels, w.low[axis]), across.low[axis]),
                                     hn::Sub(hn::Mul(pixels, w.high[axis]), across.high[axis])));
    return hn::Or(below, hn::Lt(hn::Add(most, hn::Add(across.error, hn::Mul(pixels, w.error))), zero));
}

HWY_INLINE uint32_t maskBits(F8 d, hn::Mask<F8> mask) {
    uint8_t bits[8] = {};
    hn::StoreMaskBits(d, mask, bits);
    return bits[0] & ((1u << hn::Lanes(d)) - 1);
}

void projectBoxesKernel(const Screen& screen, const EyeBoxes& boxes, BoxBounds& out) {
    const F8 d;
    out.doubt = out.outside = 0;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const RowTerms x = rowTerms(d, screen.x, boxes, i), y = rowTerms(d, screen.y, boxes, i);
        const RowTerms w = rowTerms(d, screen.w, boxes, i), near = rowTerms(d, screen.near, boxes, i);
        const V w_least = hn::Sub(least(w), w.error);
        const auto sure = hn::And(hn::Gt(least(near), near.error), hn::Gt(w_least, hn::Zero(d)));
        if (!hn::AllTrue(d, sure)) {
            const auto before = hn::Lt(hn::Add(greatest(near), near.error), hn::Zero(d));
            const auto misses =
                hn::Or(hn::Or(before, missesBorders(d, x, w, screen.width)), missesBorders(d, y, w, screen.height));
            out.doubt |= maskBits(d, hn::Not(hn::Or(sure, misses))) << i;
            out.outside |= maskBits(d, hn::AndNot(sure, misses)) << i;
            if (hn::AllFalse(d, sure)) continue;
        }
        V x0 = hn::Set(d, 3e38f), y0 = x0, x1 = hn::Neg(x0), y1 = x1;
        for (int which = 0; which < 8; ++which) {
            const V inverse = hn::Div(hn::Set(d, 1.0f), corner(w, which));
            const V px = hn::Mul(corner(x, which), inverse), py = hn::Mul(corner(y, which), inverse);
            x0 = hn::Min(x0, px);
            x1 = hn::Max(x1, px);
            y0 = hn::Min(y0, py);
            y1 = hn::Max(y1, py);
        }
        // x/w moves by at most (ex + |x/w| ew) / w.
        const V over = hn::Div(hn::Set(d, 1.0f + 0x1p-18f), w_least);
        const V wx = hn::Max(hn::Abs(x0), hn::Abs(x1)), wy = hn::Max(hn::Abs(y0), hn::Abs(y1));
        const V tiny = hn::Set(d, 0x1p-22f);
        const V grow_x = hn::Add(hn::Mul(hn::Add(x.error, hn::Mul(wx, w.error)), over), hn::Mul(wx, tiny));
        const V grow_y = hn::Add(hn::Mul(hn::Add(y.error, hn::Mul(wy, w.error)), over), hn::Mul(wy, tiny));
        hn::Store(hn::Sub(x0, grow_x), d, out.x0 + i);
        hn::Store(hn::Sub(y0, grow_y), d, out.y0 + i);
        hn::Store(hn::Add(x1, grow_x), d, out.x1 + i);
        hn::Store(hn::Add(y1, grow_y), d, out.y1 + i);
        if (screen.perspective) {
            hn::Store(over, d, out.nearness + i);
        } else {
            const RowTerms depth = rowTerms(d, screen.d, boxes, i);
            hn::Store(hn::Add(greatest(depth), depth.error), d, out.nearness + i);
        }
    }
}

/// All eight corners side by side.
void projectCornersKernel(const Screen& object, const Box3f& box, CornerBounds& out) {
    const hn::CappedTag<double, 8> d;
    alignas(64) static constexpr double kAtMost[3][8] = {
        {0, 1, 0, 1, 0, 1, 0, 1}, {0, 0, 1, 1, 0, 0, 1, 1}, {0, 0, 0, 0, 1, 1, 1, 1}};
    const auto huge = hn::Set(d, 1e300);
    auto x0 = huge, y0 = huge, x1 = hn::Neg(huge), y1 = x1, w_least = huge, near_least = huge, d_most = x1;
    auto w_size = hn::Zero(d), near_size = w_size, d_size = w_size;
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const auto along = [&](int axis) HWY_ATTR {
            const auto most = hn::Gt(hn::Load(d, kAtMost[axis] + i), hn::Zero(d));
            return hn::IfThenElse(most, hn::Set(d, static_cast<double>(box.max[axis])),
                                  hn::Set(d, static_cast<double>(box.min[axis])));
        };
        const auto cx = along(0), cy = along(1), cz = along(2);
        const auto row = [&](const glm::dvec4& r) HWY_ATTR {
            return hn::Add(hn::Add(hn::Mul(hn::Set(d, r.x), cx), hn::Mul(hn::Set(d, r.y), cy)),
                           hn::Add(hn::Mul(hn::Set(d, r.z), cz), hn::Set(d, r.w)));
        };
        const auto w = row(object.w), near = row(object.near), depth = row(object.d);
        const auto inverse = hn::Div(hn::Set(d, 1.0), w);
        const auto px = hn::Mul(row(object.x), inverse), py = hn::Mul(row(object.y), inverse);
        x0 = hn::Min(x0, px);
        x1 = hn::Max(x1, px);
        y0 = hn::Min(y0, py);
        y1 = hn::Max(y1, py);
        w_least = hn::Min(w_least, w);
        near_least = hn::Min(near_least, near);
        d_most = hn::Max(d_most, depth);
        w_size = hn::Max(w_size, hn::Abs(w));
        near_size = hn::Max(near_size, hn::Abs(near));
        d_size = hn::Max(d_size, hn::Abs(depth));
    }
    const auto least_of = [&](auto v) HWY_ATTR { return hn::GetLane(hn::MinOfLanes(d, v)); };
    const auto most_of = [&](auto v) HWY_ATTR { return hn::GetLane(hn::MaxOfLanes(d, v)); };
    out = {least_of(x0),         least_of(y0),    most_of(x1),     most_of(y1),        least_of(w_least),
           least_of(near_least), most_of(d_most), most_of(w_size), most_of(near_size), most_of(d_size)};
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace {

constexpr double kWorstPosition = 0.125;  // [pixels]: occluders known less exactly are left out

/// Rounds bounds outward to whole pixels inside the buffer; false if nothing is left, or if they are not numbers.
enum class Fit { kInside, kOutside, kDoubt };
Fit toPixels(const Screen& screen, double x0, double y0, double x1, double y1, PixelRect& rect) {
    if (!(x0 <= x1 && y0 <= y1)) return Fit::kDoubt;
    const double width = screen.width, height = screen.height;
    if (x1 < 0 || y1 < 0 || x0 > width || y0 > height) return Fit::kOutside;
    rect.x0 = static_cast<int32_t>(std::max(x0, 0.0));
    rect.y0 = static_cast<int32_t>(std::max(y0, 0.0));
    rect.x1 = static_cast<int32_t>(std::min(x1, width - 1.0));
    rect.y1 = static_cast<int32_t>(std::min(y1, height - 1.0));
    rect.x0 = std::min(rect.x0, rect.x1);
    rect.y0 = std::min(rect.y0, rect.y1);
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.x0 && static_cast<uint32_t>(rect.x1) < screen.width);
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.y0 && static_cast<uint32_t>(rect.y1) < screen.height);
    return Fit::kInside;
}

}  // namespace

HWY_EXPORT(projectBoxesKernel);
HWY_EXPORT(projectCornersKernel);

ScreenAnswer projectBoxes(const Screen& screen, const EyeBoxes& boxes) {
    BoxBounds bounds;
    ScreenAnswer answer;
    HWY_DYNAMIC_DISPATCH(projectBoxesKernel)(screen, boxes, bounds);
    answer.doubt = bounds.doubt;
    answer.outside = bounds.outside;
    for (uint32_t left = 255u & ~(answer.doubt | answer.outside); left; left &= left - 1) {
        const int i = std::countr_zero(left);
        const Fit fit = toPixels(screen, bounds.x0[i], bounds.y0[i], bounds.x1[i], bounds.y1[i], answer.rects[i]);
        answer.rects[i].nearness = bounds.nearness[i];
        if (fit == Fit::kDoubt || std::isnan(bounds.nearness[i])) answer.doubt |= 1u << i;
        else if (fit == Fit::kOutside) answer.outside |= 1u << i;
    }
    return answer;
}

ScreenAnswer projectClusters(const Screen& object, const Occluder& occluder, uint32_t first) {
    SIGHTLINE_DEBUG_ASSERT(first < occluder.clusters.size());
    const size_t last = occluder.clusters.size() - 1;
    EyeBoxes boxes;
    for (size_t i = 0; i < 8; ++i) {
        const Box3f& box = occluder.clusters[std::min(first + i, last)].bounds;
        for (int axis = 0; axis < 3; ++axis) {
            boxes.min[axis][i] = box.min[axis];
            boxes.max[axis][i] = box.max[axis];
        }
    }
    return projectBoxes(object, boxes);
}

namespace {

/// The greatest that a row of the screen map comes to over a box.
/// @param size  of the terms that the row was computed from
double mostOver(const Box3f& box, const glm::dvec4& row, const glm::dvec4& size) {
    double most = row.w, terms = size.w;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis], high = box.max[axis];
        most += std::max(row[axis] * low, row[axis] * high);
        terms += size[axis] * std::max(std::abs(low), std::abs(high));
    }
    return most + 0x1p-20 * terms;  // bounds in float are wrong by 2^-23 of themselves
}

/// Whether sign * (pixel - at) is negative for all points of a box before the eye. So it is where sign * (across.h -
/// at * w.h) is, for their w is positive.
bool liesBeyond(const Box3f& box, const glm::dvec4& across, const glm::dvec4& w, double at, double sign) {
    return mostOver(box, sign * (across - at * w), glm::abs(across) + std::abs(at) * glm::abs(w)) < 0.0;
}

/// Whether no point of a box is drawn in the buffer: also of a box that has no rectangle.
bool missesBuffer(const Screen& object, const Box3f& box) {
    return mostOver(box, object.near, glm::abs(object.near)) < 0.0 || isLeftOf(object, box, 0.0) ||
           isRightOf(object, box, object.width) || liesBeyond(box, object.y, object.w, 0.0, 1.0) ||
           liesBeyond(box, object.y, object.w, object.height, -1.0);
}

}  // namespace

bool isLeftOf(const Screen& object, const Box3f& box, double x) { return liesBeyond(box, object.x, object.w, x, 1.0); }
bool isRightOf(const Screen& object, const Box3f& box, double x) {
    return liesBeyond(box, object.x, object.w, x, -1.0);
}

BoxAnswer projectBox(const Screen& object, const Box3f& box) {
    constexpr double kRounding = 0x1p-46;
    BoxAnswer answer;
    CornerBounds c;
    HWY_DYNAMIC_DISPATCH(projectCornersKernel)(object, box, c);
    // Doubles: a millionth of a pixel is far above the rounding of any place inside the buffer.
    constexpr double kSlack = 1e-6;
    if (!(c.near_least > kRounding * c.near_size && c.w_least > kRounding * c.w_size)) {
        answer.outside = missesBuffer(object, box);
        answer.doubt = !answer.outside;
        return answer;
    }
    const Fit fit = toPixels(object, c.x0 - kSlack, c.y0 - kSlack, c.x1 + kSlack, c.y1 + kSlack, answer.rect);
    answer.outside = fit == Fit::kOutside;
    answer.doubt = fit == Fit::kDoubt;
    const double nearness = object.perspective ? 1.0 / c.w_least : c.d_most;
    answer.rect.nearness = static_cast<float>(nearness + std::abs(nearness) * 0x1p-22 + 0x1p-40 * c.d_size);
    return answer;
}

OccluderInstance makeOccluderInstance(const Screen& screen, const Occluder& occluder, const glm::dmat4& transform) {
    OccluderInstance instance;
    instance.occluder = &occluder;
    instance.transform = &transform;
    instance.screen = objectScreen(screen, transform);
    uint64_t words[16];
    static_assert(sizeof words == sizeof transform);
    std::memcpy(words, &transform, sizeof words);
    uint64_t hash = 0x2545f4914f6cdd1dull;
    for (uint64_t word : words) hash = (hash ^ word) * 0x9e3779b97f4a7c15ull, hash ^= hash >> 32;
    instance.transform_hash = hash;
    double size = 0;
    for (int row = 0; row < 3; ++row) {
        size += std::abs(transform[3][row]) + std::abs(screen.eye[row]);
        for (int column = 0; column < 3; ++column)
            size += std::abs(transform[column][row]) *
                    std::max(std::abs(occluder.bounds.min[column]), std::abs(occluder.bounds.max[column]));
    }
    const double world_error = size * 0x1p-49;  // sixteen roundings of 2^-53
    const auto errorOf = [&](const glm::dvec4& row) { return world_error * glm::length(glm::dvec3(row)); };
    instance.pixel_error =
        errorOf(screen.x) + errorOf(screen.y) + 2.0 * std::max(screen.width, screen.height) * errorOf(screen.w);
    instance.depth_error = screen.perspective ? errorOf(screen.w) : errorOf(screen.d);
    instance.clips = 4.0 * errorOf(screen.near) < screen.near_guard;
    // As far as a step in the world goes among the object's own positions.
    const glm::dmat3 inverse = glm::inverse(glm::dmat3(transform));
    const double stretch = glm::length(inverse[0]) + glm::length(inverse[1]) + glm::length(inverse[2]);
    instance.frame = objectFrame(instance.screen, glm::determinant(glm::dmat3(transform)) < 0.0, world_error * stretch,
                                 instance.clips);
    return instance;
}

bool placeCluster(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box, DrawnCluster& drawn) {
    SIGHTLINE_DEBUG_ASSERT(instance.occluder && instance.transform && cluster < instance.occluder->clusters.size());
    SIGHTLINE_DEBUG_ASSERT(!box.outside);
    const Screen& screen = instance.screen;
    double w = screen.near_w;
    if (screen.perspective && !box.doubt) w = std::max(w, 1.0 / box.rect.nearness);
    if (!(w > 0.0)) return false;
    drawn.occluder = instance.occluder;
    drawn.transform = instance.transform;
    drawn.transform_hash = instance.transform_hash;
    drawn.cluster = cluster;
    drawn.position_error = 0x1p-36 + instance.pixel_error / w;
    drawn.depth_error = screen.perspective ? instance.depth_error / (w * w) : instance.depth_error;
    drawn.clips = instance.clips;
    return drawn.position_error < kWorstPosition;
}

uint32_t drawOccluder(DepthTiles& tiles, const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box) {
    DrawnCluster drawn;
    if (!placeCluster(instance, cluster, box, drawn)) return 0;
    drawCluster(tiles, drawn, instance.screen, instance.frame);
    const int32_t right = static_cast<int32_t>(tiles.width) - 1, top = static_cast<int32_t>(tiles.height) - 1;
    validateTiles(tiles, box.doubt ? PixelRect{0, 0, right, top, 0} : box.rect);
    return instance.occluder->clusters[cluster].triangle_count;
}

}  // namespace sightline
#endif  // HWY_ONCE
