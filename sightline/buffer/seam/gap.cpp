// Bridges over gaps: what lies between two polygons on a line shorter than a given length.
// SPDX-License-Identifier: MIT
#include "sightline/buffer/seam/gap.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr double kShortest = 0x1p-30;  // [pixels]: of a side that is looked at
constexpr int kMostSides = 32;         // work cap

/// A side of a polygon: its first corner, its direction, its length; what lies outside is on its right.
struct GapSide {
    double x, y, dx, dy, length;

    /// How far a point lies outside.
    double outside(double px, double py) const { return dy * (px - x) - dx * (py - y); }
    double along(double px, double py) const { return dx * (px - x) + dy * (py - y); }
};

bool sideOf(const GapPolygon& polygon, int i, GapSide& side) {
    SIGHTLINE_DEBUG_ASSERT(polygon.count == 3 || polygon.count == 4);
    SIGHTLINE_DEBUG_ASSERT(i >= 0 && i < polygon.count);
    const int j = i + 1 < polygon.count ? i + 1 : 0;
    const double dx = polygon.x[j] - polygon.x[i], dy = polygon.y[j] - polygon.y[i];
    const double length = std::sqrt(dx * dx + dy * dy);
    if (!(length > kShortest)) return false;
    side = {polygon.x[i], polygon.y[i], dx / length, dy / length, length};
    return true;
}

/// A linear function along a line, from two of its values.
struct Slope {
    double at, rise;
    double operator()(double s) const { return at + rise * s; }
};

/// Keeps of [low, high] what has f >= 0.
void keep(const Slope& f, double& low, double& high) {
    if (f.rise > 0) low = std::max(low, -f.at / f.rise);
    else if (f.rise < 0) high = std::min(high, f.at / -f.rise);
    else if (f.at < 0) high = low - 1.0;
}

/// The ends of bridges between sides: to what lies beyond they are sides themselves.
struct Ends {
    static constexpr int kMost = 48;
    GapSide side[kMost];
    int count = 0;

    /// From one point to another, what lies beyond on the right.
    void add(double x0, double y0, double x1, double y1) {
        const double dx = x1 - x0, dy = y1 - y0, length = std::sqrt(dx * dx + dy * dy);
        if (length > kShortest && count < kMost) side[count++] = {x0, y0, dx / length, dy / length, length};
    }
};

/// Between two sides that face each other: lines across, at right angles to the direction halfway between theirs.
/// @param ends  gets those of the bridge, if it is given
bool bridgeSides(const GapSide& p, const GapSide& q, double gap, double wide, Bridge& out, Ends* ends) {
    SIGHTLINE_DEBUG_ASSERT(gap > 0 && wide > 0);
    constexpr double kFacing = -0.5;  // cosine
    if (p.dx * q.dx + p.dy * q.dy > kFacing) return false;
    double ux = p.dx - q.dx, uy = p.dy - q.dy;
    const double length = std::sqrt(ux * ux + uy * uy);
    ux /= length;
    uy /= length;
    const double reach = 0.5 * (std::abs(ux) + std::abs(uy)) + gap;  // of the pixel, along
    // Along u the first side goes forward, the other backward; across, each is a linear function of that.
    const auto lineOf = [&](const GapSide& side, double& low, double& high) {
        const double start = ux * side.x + uy * side.y, step = ux * side.dx + uy * side.dy;
        const double end = start + step * side.length;
        low = std::max(low, std::min(start, end));
        high = std::min(high, std::max(start, end));
        const double rise = (uy * side.dx - ux * side.dy) / step;
        return Slope{uy * side.x - ux * side.y - rise * start, rise};
    };
    double low = -reach, high = reach;
    const Slope near = lineOf(p, low, high), far = lineOf(q, low, high);
    keep({gap - (far.at - near.at), -(far.rise - near.rise)}, low, high);
    keep({far.at - near.at + wide, far.rise - near.rise}, low, high);
    if (!(low < high)) return false;
    out.edges = 0;
    for (const GapSide* side : {&p, &q}) out.add(side->dy, -side->dx, side->outside(0, 0) + wide);
    out.add(ux, uy, wide - low);
    out.add(-ux, -uy, wide + high);
    if (ends) {
        const auto place = [&](const Slope& line, double s, double& x, double& y) {
            x = ux * s + uy * line(s);
            y = uy * s - ux * line(s);
        };
        double x0, y0, x1, y1;
        place(near, low, x0, y0);
        place(far, low, x1, y1);
        if (low > -reach) ends->add(x0, y0, x1, y1);  // else beyond the pixel
        place(far, high, x0, y0);
        place(near, high, x1, y1);
        if (high < reach) ends->add(x0, y0, x1, y1);
    }
    return true;
}

/// Between a corner and the part of a side within reach.
bool bridgeCorner(double x, double y, const GapSide& side, double gap, double wide, Bridge& out) {
    const double above = side.outside(x, y);
    if (!(above > wide && above <= gap)) return false;
    const double half = std::sqrt(gap * gap - above * above), foot = side.along(x, y);
    const double first = std::max(foot - half, 0.0), last = std::min(foot + half, side.length);
    if (!(first < last)) return false;
    out.edges = 0;
    out.add(side.dy, -side.dx, side.outside(0, 0) + wide);
    for (const bool at_first : {true, false}) {
        // The line from the corner to an end of that part; inside is the other end.
        const double at = at_first ? first : last;
        const double dx = side.x + side.dx * at - x, dy = side.y + side.dy * at - y;
        const double length = std::sqrt(dx * dx + dy * dy), turn = (at_first ? -1.0 : 1.0) / length;
        const double a = turn * dy, b = -turn * dx;
        const double other = at_first ? last : first;
        const double sign = a * (side.x + side.dx * other - x) + b * (side.y + side.dy * other - y) < 0 ? -1.0 : 1.0;
        out.add(sign * a, sign * b, wide - sign * (a * x + b * y));
    }
    return true;
}

/// Around a corner that lies on a side, or so near that the errors decide.
bool bridgeTouch(double x, double y, const GapSide& side, double wide, Bridge& out) {
    const double along = side.along(x, y), far = 8.0 * wide;
    if (!(std::abs(side.outside(x, y)) <= far && along >= -far && along <= side.length + far)) return false;
    out.edges = 0;
    for (const double way : {1.0, -1.0}) {
        out.add(way, 0, far - way * x);
        out.add(0, way, far - way * y);
    }
    return true;
}

}  // namespace

int makeBridges(const GapPolygon* polygons, int count, double gap, Bridge* out, int most) {
    SIGHTLINE_DEBUG_ASSERT(count >= 0 && most >= 0);
    SIGHTLINE_DEBUG_ASSERT(gap > 0);
    int made = 0;
    Ends ends;
    double wide = 0;
    for (int p = 0; p < count; ++p) wide = std::max(wide, 2.0 * polygons[p].error + 0x1p-40);
    const double longest = gap - 3.0 * wide, reach = 0.5 + gap;
    if (!(longest > 0)) return 0;
    // The sides that come near the pixel.
    struct Near {
        GapSide side;
        int polygon;
    } sides[kMostSides];
    int side_count = 0;
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < polygons[p].count && side_count < kMostSides; ++i) {
            GapSide side;
            if (!sideOf(polygons[p], i, side) || std::abs(side.outside(0, 0)) > 2.0 * reach) continue;
            sides[side_count++] = {side, p};
        }
    for (int i = 0; i < side_count; ++i)
        for (int j = i + 1; j < side_count; ++j)
            if (made < most && sides[i].polygon != sides[j].polygon &&
                bridgeSides(sides[i].side, sides[j].side, longest, wide, out[made], &ends))
                ++made;
    // Where gaps meet, a bridge's end faces a third polygon, or the end of another.
    for (int e = 0; e < ends.count; ++e) {
        for (int f = e + 1; f < ends.count; ++f)
            if (made < most && bridgeSides(ends.side[e], ends.side[f], longest, wide, out[made], nullptr)) ++made;
        for (int j = 0; j < side_count; ++j)
            if (made < most && bridgeSides(ends.side[e], sides[j].side, longest, wide, out[made], nullptr)) ++made;
    }
    for (int p = 0; p < count; ++p)
        for (int i = 0; i < polygons[p].count; ++i) {
            const double x = polygons[p].x[i], y = polygons[p].y[i];
            if (std::max(std::abs(x), std::abs(y)) > reach) continue;
            for (int j = 0; j < side_count; ++j) {
                if (sides[j].polygon == p) continue;
                if (made < most && bridgeCorner(x, y, sides[j].side, longest, wide, out[made])) ++made;
                if (made < most && bridgeTouch(x, y, sides[j].side, wide, out[made])) ++made;
            }
        }
    SIGHTLINE_DEBUG_ASSERT(made <= most && side_count <= kMostSides);
    return made;
}

}  // namespace sightline
