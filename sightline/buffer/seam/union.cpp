// Whether convex polygons leave nothing of a pixel: the pixel's square minus each of them in turn.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/seam/union.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr int kMaxCorners = 12;
constexpr int kMaxRegions = 24;  // work cap
/// Of a shared side: more than the rounding of where a region was cut along it, less than what is known of its place.
constexpr double kShared = -0x1p-40;  // [pixels]

/// A convex region, counter-clockwise, relative to the pixel's centre.
struct Region {
    double x[kMaxCorners], y[kMaxCorners];  // no initial values
    int count = 0;

    bool add(double px, double py) {
        if (count == kMaxCorners) return false;
        x[count] = px;
        y[count++] = py;
        return true;
    }
};

enum class Place { kInside, kOutside, kCut, kTooManyCorners };

/// Where a region lies to the line a x + b y + c = 0, inside being the positive side. What is cut is parted in two.
Place split(const Region& region, double a, double b, double c, Region& inside, Region& outside) {
    SIGHTLINE_DEBUG_ASSERT(region.count >= 3 && region.count <= kMaxCorners);
    SIGHTLINE_DEBUG_ASSERT(&region != &inside && &region != &outside);
    double e[kMaxCorners];
    bool any_inside = false, any_outside = false;
    for (int i = 0; i < region.count; ++i) {
        e[i] = a * region.x[i] + b * region.y[i] + c;
        any_inside |= e[i] >= 0;
        any_outside |= !(e[i] >= 0);
    }
    if (!any_outside) return Place::kInside;
    if (!any_inside) return Place::kOutside;
    inside.count = outside.count = 0;
    for (int i = 0; i < region.count; ++i) {
        const int j = i + 1 < region.count ? i + 1 : 0;
        if (!(e[i] >= 0 ? inside : outside).add(region.x[i], region.y[i])) return Place::kTooManyCorners;
        if ((e[i] >= 0) == (e[j] >= 0)) continue;
        const double t = e[i] / (e[i] - e[j]);
        const double px = region.x[i] + t * (region.x[j] - region.x[i]);
        const double py = region.y[i] + t * (region.y[j] - region.y[i]);
        if (!inside.add(px, py) || !outside.add(px, py)) return Place::kTooManyCorners;
    }
    return Place::kCut;
}

struct Remainder {
    Region regions[kMaxRegions];
    int count = 0;

    bool add(const Region& region) {
        if (region.count < 3) return true;
        if (count == kMaxRegions) return false;
        regions[count++] = region;
        return true;
    }
};

/// Takes what lies inside of some lines away from a region; what is left goes to `out`. `used` tells whether anything
/// was taken.
bool subtract(const Region& region, const EdgeFunction* lines, int count, Remainder& out, bool& used) {
    SIGHTLINE_DEBUG_ASSERT(count >= 0 && count <= 4);
    Region parts[2], outside;
    const Region* rest = &region;  // what is inside the lines so far
    const int before = out.count;
    for (int k = 0; k < count; ++k) {
        Region& inside = rest == &parts[0] ? parts[1] : parts[0];
        const Place place = split(*rest, lines[k].a, lines[k].b, lines[k].c, inside, outside);
        if (place == Place::kInside) continue;
        if (place == Place::kTooManyCorners) return false;
        if (place == Place::kOutside || inside.count < 3) {  // all of it misses the region
            out.count = before;
            return out.add(region);
        }
        if (!out.add(outside)) return false;
        rest = &inside;
    }
    used = true;
    return true;
}

/// What is left of a pixel.
struct PixelRest {
    Remainder lists[2], *left = &lists[0], *next = &lists[1];

    PixelRest() {
        Region square;
        // A little larger than the pixel, so that the rounding of its own corners does not count.
        constexpr double kHalf = 0.5 + 0x1p-30;
        square.add(-kHalf, -kHalf);
        square.add(kHalf, -kHalf);
        square.add(kHalf, kHalf);
        square.add(-kHalf, kHalf);
        left->add(square);
    }
    PixelRest(const PixelRest&) = delete;
    PixelRest& operator=(const PixelRest&) = delete;

    bool empty() const { return left->count == 0; }

    /// False if a work cap is met.
    bool take(const EdgeFunction* lines, int count, bool& used) {
        next->count = 0;
        for (int r = 0; r < left->count; ++r)
            if (!subtract(left->regions[r], lines, count, *next, used)) return false;
        std::swap(left, next);
        return true;
    }

    /// Whether all regions are thin, or so small that they are holes between what is closed: inside the pixel, so that
    /// all around them is known.
    bool isThin(double gap, double hole) const {
        SIGHTLINE_DEBUG_ASSERT(gap >= 0 && hole >= 0);
        for (int r = 0; r < left->count; ++r) {
            const Region& region = left->regions[r];
            double area2 = 0, around = 0, beyond = 0;
            for (int i = 0; i < region.count; ++i) {
                const int j = i + 1 < region.count ? i + 1 : 0;
                area2 += region.x[i] * region.y[j] - region.x[j] * region.y[i];
                around += std::abs(region.x[j] - region.x[i]) + std::abs(region.y[j] - region.y[i]);
                beyond = std::max(beyond, std::max(std::abs(region.x[i]), std::abs(region.y[i])));
            }
            if (area2 > gap * around && !(around < hole && beyond < 0.5 - hole)) return false;
        }
        return true;
    }
};

/// Whether bridges between the pieces close what they leave.
bool closeGaps(const PixelRest& rest, const GapPolygon* near, int count, double gap) {
    constexpr int kMostBridges = 160, kMostPieces = 12;  // work caps
    if (count > kMostPieces || !rest.isThin(gap, 0)) return false;
    Bridge bridges[kMostBridges];
    const int made = makeBridges(near, count, gap, bridges, kMostBridges);
    PixelRest trial;
    *trial.left = *rest.left;
    bool used = false;
    for (int i = 0; i < made && !trial.empty(); ++i)  // one that would make too many regions is left out
        trial.take(bridges[i].edge, bridges[i].edges, used);
    double error = 0;
    for (int p = 0; p < count; ++p) error = std::max(error, near[p].error);
    return trial.isThin(8.0 * error, 0x1p-8 * gap);  // what is left where bridges meet
}

}  // namespace

PixelUnion subtractFromPixel(double x, double y, const UnionPiece* pieces, int count, double gap,
                             const GapPolygon* near) {
    SIGHTLINE_DEBUG_ASSERT(count >= 0 && count <= 32);
    SIGHTLINE_DEBUG_ASSERT(gap >= 0 && (gap == 0 || near != nullptr));
    PixelUnion out;
    out.nearness = -std::numeric_limits<double>::infinity();
    PixelRest rest;
    double farthest = std::numeric_limits<double>::infinity();
    for (int p = 0; p < count; ++p) {
        const RasterPolygon& polygon = *pieces[p].polygon;
        SIGHTLINE_DEBUG_ASSERT(polygon.complete && polygon.edges <= 4 && polygon.error >= 0);
        EdgeFunction lines[4];
        for (int k = 0; k < polygon.edges; ++k) {
            const EdgeFunction& edge = polygon.edge[k];
            const double margin = pieces[p].shared >> k & 1 ? kShared : polygon.error;
            lines[k] = {edge.a, edge.b, edge.at(x, y) - margin};
        }
        bool used = false;
        if (!rest.take(lines, polygon.edges, used)) {
            out.whole = false;
            return out;
        }
        if (used) {
            farthest = std::min(farthest, pieces[p].farthest);
            ++out.used;
            out.took |= uint32_t{1} << p;
            out.last = p;
        }
        if (rest.empty()) {
            out.nearness = farthest;
            return out;
        }
        if (gap > 0 && p > 0 && closeGaps(rest, near, p + 1, gap)) {
            out.nearness = pieces[p].farthest;
            out.bridged = true;
            return out;
        }
    }
    return out;
}

}  // namespace sightline
