// Whether convex polygons leave nothing of a pixel: the pixel's square minus each of them in turn.
// SPDX-License-Identifier: MIT
#include "sightline/raster/union.h"

#include <algorithm>
#include <limits>

namespace sightline {
namespace {

constexpr int kMaxCorners = 12;
constexpr int kMaxRegions = 24;  // work cap

/// A convex region, counter-clockwise, relative to the pixel's centre.
struct Region {
    double x[kMaxCorners], y[kMaxCorners];
    int count = 0;

    bool add(double px, double py) {
        if (count == kMaxCorners) return false;
        x[count] = px;
        y[count++] = py;
        return true;
    }
};

/// Splits a region by a line: what has a x + b y + c >= 0, and the rest. False if a part has too many corners.
bool split(const Region& region, double a, double b, double c, Region& inside, Region& outside) {
    inside.count = outside.count = 0;
    double e[kMaxCorners];
    bool any_inside = false, any_outside = false;
    for (int i = 0; i < region.count; ++i) {
        e[i] = a * region.x[i] + b * region.y[i] + c;
        any_inside |= e[i] >= 0;
        any_outside |= e[i] < 0;
    }
    if (!any_outside) inside = region;
    if (!any_inside) outside = region;
    if (!any_inside || !any_outside) return true;
    for (int i = 0; i < region.count; ++i) {
        const int j = i + 1 < region.count ? i + 1 : 0;
        if (!(e[i] >= 0 ? inside : outside).add(region.x[i], region.y[i])) return false;
        if ((e[i] >= 0) == (e[j] >= 0)) continue;
        const double t = e[i] / (e[i] - e[j]);
        const double px = region.x[i] + t * (region.x[j] - region.x[i]);
        const double py = region.y[i] + t * (region.y[j] - region.y[i]);
        if (!inside.add(px, py) || !outside.add(px, py)) return false;
    }
    return true;
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

/// Takes a piece away from a region; what is left goes to `out`. `used` tells whether anything was taken.
bool subtract(const Region& region, const UnionPiece& piece, double x, double y, Remainder& out, bool& used) {
    const RasterPolygon& polygon = *piece.polygon;
    Region rest = region, inside, outside;
    Remainder cut;
    for (int k = 0; k < polygon.edges; ++k) {
        const EdgeFunction& edge = polygon.edge[k];
        const double margin = piece.shared >> k & 1 ? 0.0 : static_cast<double>(polygon.slack);
        if (!split(rest, edge.a, edge.b, edge.at(x, y) - margin, inside, outside)) return false;
        if (inside.count < 3) return out.add(region);  // the piece misses the region
        if (!cut.add(outside)) return false;
        rest = inside;
    }
    used = true;
    for (int i = 0; i < cut.count; ++i)
        if (!out.add(cut.regions[i])) return false;
    return true;
}

}  // namespace

double subtractFromPixel(double x, double y, const UnionPiece* pieces, int count) {
    constexpr double kNothing = -std::numeric_limits<double>::infinity();
    Remainder left, next;
    Region square;
    // A little larger than the pixel, so that the rounding of its own corners does not count.
    constexpr double kHalf = 0.5 + 0x1p-30;
    square.add(-kHalf, -kHalf);
    square.add(kHalf, -kHalf);
    square.add(kHalf, kHalf);
    square.add(-kHalf, kHalf);
    left.add(square);
    double farthest = std::numeric_limits<double>::infinity();
    for (int p = 0; p < count && left.count > 0; ++p) {
        bool used = false;
        next.count = 0;
        for (int r = 0; r < left.count; ++r)
            if (!subtract(left.regions[r], pieces[p], x, y, next, used)) return kNothing;
        if (used) farthest = std::min(farthest, pieces[p].farthest);
        std::swap(left, next);
    }
    return left.count == 0 ? farthest : kNothing;
}

}  // namespace sightline
