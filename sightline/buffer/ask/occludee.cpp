// A convex polygon as something that may be hidden: every pixel that it may touch, with its nearest depth there.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/ask/occludee.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/buffer/ask/occludee.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// What float evaluation adds to the slack: values at a tile's centre are taken in double, and those that matter are
/// less than 5 pixels.
constexpr float kReach = 4.0f;  // [pixels]: from a tile's centre to its sides, by |a| + |b| = 1

uint64_t occludeePixelsKernel(const OccludeePolygon& polygon, int32_t column, int32_t row, float* nearest) {
    SIGHTLINE_DEBUG_ASSERT(polygon.edges >= 0 && polygon.edges <= OccludeePolygon::kMaxEdges);
    const double x = 8.0 * column + 4.0, y = 8.0 * row + 4.0;
    float c[4] = {1e30f, 1e30f, 1e30f, 1e30f}, a[4] = {}, b[4] = {};
    const float touches = -0.5f - polygon.slack;
    bool all = true;
    for (int e = 0; e < polygon.edges; ++e) {
        c[e] = static_cast<float>(polygon.a[e] * x + polygon.b[e] * y + polygon.c[e]);
        if (c[e] < -kReach - polygon.slack) return 0;
        all &= c[e] >= kReach;
        a[e] = static_cast<float>(polygon.a[e]);
        b[e] = static_cast<float>(polygon.b[e]);
    }
    const PixelRect& rect = polygon.rect;
    const uint64_t window = windowBits(rect.x0, rect.y0, rect.x1, rect.y1, 8 * column, 8 * row);
    const double z = polygon.d0 + polygon.dx * x + polygon.dy * y;
    const float dx = static_cast<float>(polygon.dx), dy = static_cast<float>(polygon.dy);
    const float tilt = std::abs(dx) + std::abs(dy);
    const float error = polygon.depth_error + 0x1p-20f * (static_cast<float>(std::abs(z)) + 8.0f * tilt);
    const float center = static_cast<float>(z) + 0.5f * tilt + error;  // the nearest point of each pixel's square
    const F8 d;
    const auto most = hn::Set(d, rect.nearness), limit = hn::Set(d, touches), offset = hn::Iota(d, -3.5f);
    uint64_t mask = 0;
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto along = hn::Add(offset, hn::Set(d, static_cast<float>(h)));
        const auto depth = hn::Mul(hn::Set(d, dx), along);
        const auto e0 = hn::Mul(hn::Set(d, a[0]), along), e1 = hn::Mul(hn::Set(d, a[1]), along);
        const auto e2 = hn::Mul(hn::Set(d, a[2]), along), e3 = hn::Mul(hn::Set(d, a[3]), along);
        for (int line = 0; line < 8; ++line) {
            const float up = static_cast<float>(line) - 3.5f;
            hn::StoreU(hn::Min(most, hn::Add(hn::Set(d, center + dy * up), depth)), d, nearest + 8 * line + h);
            if (all) continue;
            const auto e01 =
                hn::Min(hn::Add(hn::Set(d, c[0] + b[0] * up), e0), hn::Add(hn::Set(d, c[1] + b[1] * up), e1));
            const auto e23 =
                hn::Min(hn::Add(hn::Set(d, c[2] + b[2] * up), e2), hn::Add(hn::Set(d, c[3] + b[3] * up), e3));
            mask |= bitsFromMask(d, hn::Ge(hn::Min(e01, e23), limit)) << (8 * line + static_cast<int>(h));
        }
    }
    return all ? window : mask & window;
}

/// How near a polygon may be over the pixels of a rectangle: its plane, in double, at the nearest corner.
HWY_INLINE float nearestOver(const OccludeePolygon& polygon, const PixelRect& over) {
    SIGHTLINE_DEBUG_ASSERT(over.x0 <= over.x1 && over.y0 <= over.y1);
    const double x = polygon.dx > 0 ? over.x1 + 1.0 : over.x0, y = polygon.dy > 0 ? over.y1 + 1.0 : over.y0;
    const double z = polygon.d0 + polygon.dx * x + polygon.dy * y;
    const double error = polygon.depth_error + 0x1p-20 * std::abs(z);
    return std::min(polygon.rect.nearness, static_cast<float>(z + error));
}

/// Calls `look` with each tile, its pixels that the polygon may touch and how near it is there, leaving out rows that
/// hide it; stops when it returns false.
/// @param inside  set if a row or a tile was looked at
template <class Look>
HWY_INLINE bool forOccludeeTiles(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box,
                                 bool& inside, Look look) {
    const PixelRect& rect = polygon.rect;
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.x0 && rect.x0 <= rect.x1 && static_cast<uint32_t>(rect.x1) < tiles.width);
    SIGHTLINE_DEBUG_ASSERT(0 <= rect.y0 && rect.y0 <= rect.y1 && static_cast<uint32_t>(rect.y1) < tiles.height);
    const int32_t first = rect.x0 >> 3, last = rect.x1 >> 3, low = rect.y0 >> 3, high = rect.y1 >> 3;
    alignas(64) float nearest[64];
    for (int32_t row = low; row <= high; ++row) {
        if (low < high && first < last) {
            PixelRect line{rect.x0, std::max(rect.y0, 8 * row), rect.x1, std::min(rect.y1, 8 * row + 7), 0};
            line.nearness = nearestOver(polygon, line);
            if (isHidden(tiles, line, Seams::kLeave, box)) {
                inside = true;
                continue;
            }
        }
        for (int32_t column = first; column <= last; ++column) {
            const uint32_t tile = static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(column);
            const PixelRect cell{std::max(rect.x0, 8 * column), std::max(rect.y0, 8 * row),
                                 std::min(rect.x1, 8 * column + 7), std::min(rect.y1, 8 * row + 7), 0};
            if (inside && tiles.base[tile] > nearestOver(polygon, cell)) continue;  // whatever of it is touched
            const uint64_t window = occludeePixelsKernel(polygon, column, row, nearest);
            if (!window) continue;
            inside = true;
            if (!look(tile, window, nearest)) return false;
        }
    }
    return true;
}

Cover lookAtKernel(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box) {
    if (isHidden(tiles, polygon.rect, Seams::kLeave, box)) return Cover::kHidden;
    bool undecided = false, inside = false;
    const bool closed = forOccludeeTiles(
        tiles, polygon, box, inside, [&](uint32_t tile, uint64_t window, const float(&nearest)[64]) HWY_ATTR {
            const uint64_t open = openPixels(tiles, tile, window, nearest, Seams::kLeave, box);
            undecided |= open != 0;
            return !(open & ~undecidedSeams(tiles, tile));
        });
    if (!inside) return Cover::kOutside;
    return !closed ? Cover::kOpen : undecided ? Cover::kUndecided : Cover::kHidden;
}

bool resolveHiddenKernel(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box) {
    bool inside = false;
    return forOccludeeTiles(
        tiles, polygon, box, inside, [&](uint32_t tile, uint64_t window, const float(&nearest)[64]) HWY_ATTR {
            for (uint64_t open = openPixels(tiles, tile, window, nearest, Seams::kLeave, box); open; open &= open - 1)
                if (openPixels(tiles, tile, open & -open, nearest, Seams::kResolve, box)) return false;
            return true;
        });
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace {

constexpr double kFarthestCorner = 0x1p32;  // [pixels]: beyond, a double's step shows in an edge function
constexpr double kShortestEdge = 0x1p-10;   // [pixels]: shorter edges have no direction worth asking
constexpr double kLeastHeight = 0.0625;     // [pixels]: of a triangle whose plane says more than its nearest corner
constexpr double kEvaluation = 0x1p-14;     // [pixels]: bound on the error of an edge function in float

/// The plane of the widest triangle among the corners, in front of all of them; left level where there is none.
void boundDepth(const double* x, const double* y, const double* d, int count, double perimeter, double error,
                OccludeePolygon& out) {
    SIGHTLINE_DEBUG_ASSERT(count >= 3 && error >= 0);
    double best = 0;
    int widest = 0;
    for (int i = 2; i < count; ++i) {
        const double part = (x[i - 1] - x[0]) * (y[i] - y[0]) - (x[i] - x[0]) * (y[i - 1] - y[0]);
        if (std::abs(part) <= std::abs(best)) continue;
        best = part;
        widest = i;
    }
    if (widest == 0 || !(std::abs(best) >= kLeastHeight * perimeter)) return;  // 0 >= 0 where all is one point
    const double ux = x[widest - 1] - x[0], uy = y[widest - 1] - y[0], ud = d[widest - 1] - d[0];
    const double vx = x[widest] - x[0], vy = y[widest] - y[0], vd = d[widest] - d[0];
    const double dx = (ud * vy - vd * uy) / best, dy = (vd * ux - ud * vx) / best;
    double d0 = -std::numeric_limits<double>::infinity(), size = 0;
    for (int i = 0; i < count; ++i) {
        d0 = std::max(d0, d[i] - dx * x[i] - dy * y[i]);
        size = std::max(size, std::abs(dx * x[i]) + std::abs(dy * y[i]));
    }
    const double whole = error + (std::abs(dx) + std::abs(dy)) * out.slack + 0x1p-48 * size;
    if (!(std::isfinite(d0) && whole < 1e30)) return;
    out.d0 = d0;
    out.dx = dx;
    out.dy = dy;
    out.depth_error = static_cast<float>(whole * (1.0 + 0x1p-20));
}

}  // namespace

HWY_EXPORT(occludeePixelsKernel);
HWY_EXPORT(lookAtKernel);
HWY_EXPORT(resolveHiddenKernel);

Sight makeOccludeePolygon(const double* x, const double* y, const double* d, int count, double position_error,
                          double depth_error, uint32_t width, uint32_t height, OccludeePolygon& out) {
    SIGHTLINE_DEBUG_ASSERT(count >= 3 && count <= OccludeePolygon::kMaxCorners);
    SIGHTLINE_DEBUG_ASSERT(position_error >= 0 && depth_error >= 0);
    SIGHTLINE_DEBUG_ASSERT(width > 0 && height > 0);
    double x_min = x[0], x_max = x[0], y_min = y[0], y_max = y[0], d_max = d[0], area2 = 0;
    for (int i = 1; i < count; ++i) {
        x_min = std::min(x_min, x[i]);
        x_max = std::max(x_max, x[i]);
        y_min = std::min(y_min, y[i]);
        y_max = std::max(y_max, y[i]);
        d_max = std::max(d_max, d[i]);
        if (i > 1) area2 += (x[i - 1] - x[0]) * (y[i] - y[0]) - (x[i] - x[0]) * (y[i - 1] - y[0]);
    }
    const double extent =
        std::max(std::max(std::abs(x_min), std::abs(x_max)), std::max(std::abs(y_min), std::abs(y_max)));
    const double slack = position_error + kEvaluation + 0x1p-40 * extent;
    const bool bounded = std::isfinite(area2) && std::isfinite(d_max) && extent < kFarthestCorner;
    if (!bounded) return Sight::kVisible;
    if (!(x_max + slack >= 0 && y_max + slack >= 0 && x_min - slack <= width && y_min - slack <= height))
        return Sight::kOutside;
    out.slack = static_cast<float>(slack * (1.0 + 0x1p-20));
    out.rect.x0 = static_cast<int32_t>(std::clamp(x_min - slack, 0.0, width - 1.0));
    out.rect.y0 = static_cast<int32_t>(std::clamp(y_min - slack, 0.0, height - 1.0));
    out.rect.x1 = static_cast<int32_t>(std::clamp(x_max + slack, 0.0, width - 1.0));
    out.rect.y1 = static_cast<int32_t>(std::clamp(y_max + slack, 0.0, height - 1.0));
    SIGHTLINE_DEBUG_ASSERT(out.rect.x0 <= out.rect.x1 && out.rect.y0 <= out.rect.y1);
    const double error = depth_error + std::abs(d_max) * 0x1p-36;
    out.rect.nearness = static_cast<float>(d_max + error + std::abs(d_max) * 0x1p-22);
    out.edges = 0;
    double perimeter = 0, lengths[OccludeePolygon::kMaxEdges];
    for (int i = 0; i < count; ++i) {
        const int j = i + 1 < count ? i + 1 : 0;
        const double ex = x[j] - x[i], ey = y[j] - y[i], length = std::abs(ex) + std::abs(ey);
        perimeter += length;
        if (length < kShortestEdge) continue;
        int at = out.edges;
        if (at == OccludeePolygon::kMaxEdges) {
            at = static_cast<int>(std::min_element(lengths, lengths + at) - lengths);
            if (lengths[at] >= length) continue;
            --out.edges;
        }
        lengths[at] = length;
        const double scale = (area2 < 0 ? -1.0 : 1.0) / length;
        const double a = -ey * scale, b = ex * scale;
        double least = a * x[0] + b * y[0];
        for (int k = 1; k < count; ++k) least = std::min(least, a * x[k] + b * y[k]);
        out.a[at] = a;
        out.b[at] = b;
        out.c[at] = -least;
        ++out.edges;
    }
    SIGHTLINE_DEBUG_ASSERT(out.edges <= OccludeePolygon::kMaxEdges);
    out.d0 = d_max;
    out.dx = out.dy = 0;
    out.depth_error = static_cast<float>(error * (1.0 + 0x1p-20));
    boundDepth(x, y, d, count, perimeter, error, out);
    return Sight::kOccluded;
}

uint64_t occludeePixels(const OccludeePolygon& polygon, int32_t column, int32_t row, float (&nearest)[64]) {
    SIGHTLINE_DEBUG_ASSERT(polygon.rect.x0 <= 8 * column + 7 && 8 * column <= polygon.rect.x1);
    SIGHTLINE_DEBUG_ASSERT(polygon.rect.y0 <= 8 * row + 7 && 8 * row <= polygon.rect.y1);
    return HWY_DYNAMIC_DISPATCH(occludeePixelsKernel)(polygon, column, row, nearest);
}

Cover lookAt(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box) {
    return HWY_DYNAMIC_DISPATCH(lookAtKernel)(tiles, polygon, box);
}

bool resolveHidden(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box) {
    return HWY_DYNAMIC_DISPATCH(resolveHiddenKernel)(tiles, polygon, box);
}

bool isPolygonHidden(DepthTiles& tiles, const OccludeePolygon& polygon, const OccludeeBox* box) {
    const Cover cover = lookAt(tiles, polygon, box);
    return cover == Cover::kUndecided ? resolveHidden(tiles, polygon, box) : cover != Cover::kOpen;
}

}  // namespace sightline
#endif  // HWY_ONCE
