// Draws occluder clusters into the depth tiles, and asks them whether a rectangle is hidden: the SIMD kernels.
// SPDX-License-Identifier: MIT
#include "sightline/raster/tiles.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/raster/near_clip.h"
#include "sightline/raster/polygon.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/raster/draw.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;
using D8 = hn::CappedTag<double, 8>;

/// Projects a cluster's vertices into px, py, pd; those before the near guard get a NaN.
void projectVertices(const Screen& object, const Occluder& occluder, const OccluderCluster& cluster, double* px,
                     double* py, double* pd) {
    const D8 d;
    const hn::Rebind<float, D8> f;
    const auto row = [&](const glm::dvec4& r, auto x, auto y, auto z) HWY_ATTR {
        return hn::Add(hn::Add(hn::Mul(hn::Set(d, r.x), x), hn::Mul(hn::Set(d, r.y), y)),
                       hn::Add(hn::Mul(hn::Set(d, r.z), z), hn::Set(d, r.w)));
    };
    const auto guard = hn::Set(d, object.near_guard);
    const auto behind = hn::Set(d, std::numeric_limits<double>::quiet_NaN());
    const float *xs = occluder.x.data() + cluster.first_vertex, *ys = occluder.y.data() + cluster.first_vertex,
                *zs = occluder.z.data() + cluster.first_vertex;
    for (size_t i = 0; i < cluster.vertex_count; i += hn::Lanes(d)) {
        const auto x = hn::PromoteTo(d, hn::LoadU(f, xs + i));
        const auto y = hn::PromoteTo(d, hn::LoadU(f, ys + i));
        const auto z = hn::PromoteTo(d, hn::LoadU(f, zs + i));
        const auto w = row(object.w, x, y, z);
        const auto drawn = hn::And(hn::Ge(row(object.near, x, y, z), guard), hn::Gt(w, hn::Zero(d)));
        const auto inverse = hn::Div(hn::Set(d, 1.0), w);
        hn::StoreU(hn::IfThenElse(drawn, hn::Mul(row(object.x, x, y, z), inverse), behind), d, px + i);
        hn::StoreU(hn::Mul(row(object.y, x, y, z), inverse), d, py + i);
        hn::StoreU(hn::Mul(row(object.d, x, y, z), inverse), d, pd + i);
    }
}

/// One tile's view of a polygon: everything relative to the tile's centre, in float.
struct TilePolygon {
    float a[4], b[4], c[4];
    int edges = 0;        ///< those that do not contain the whole tile
    DepthTiles::Plane plane;  ///< the farthest nearness over each pixel
    uint64_t window = 0;  ///< pixels inside the polygon's bounds
};

/// A plane's depths at the pixels of one row whose offsets from the tile's centre are given.
template <class D, class Vec>
HWY_INLINE Vec planeDepth(D d, const DepthTiles::Plane& plane, int row, Vec x) {
    const auto base = hn::Set(d, plane.d + plane.dy * (static_cast<float>(row) - 3.5f));
    return hn::Max(hn::Add(base, hn::Mul(hn::Set(d, plane.dx), x)), hn::Set(d, plane.floor));
}

/// Writes a plane out, or -infinity for an empty tile, so that single pixels can change.
void toPixels(DepthTiles::Tile& tile, float* depth) {
    const F8 d;
    const auto open = hn::Set(d, -std::numeric_limits<float>::infinity());
    const auto offset = hn::Iota(d, -3.5f);
    for (int row = 0; row < 8; ++row)
        for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
            const auto z = planeDepth(d, tile.plane, row, hn::Add(offset, hn::Set(d, static_cast<float>(h))));
            hn::StoreU(tile.form == DepthTiles::Form::kPlane ? z : open, d, depth + 8 * row + h);
        }
    tile.form = DepthTiles::Form::kPixels;
}

float leastDepth(const float* depth) {
    const F8 d;
    auto least = hn::LoadU(d, depth);
    for (size_t i = hn::Lanes(d); i < 64; i += hn::Lanes(d)) least = hn::Min(least, hn::LoadU(d, depth + i));
    return hn::GetLane(hn::MinOfLanes(d, least));
}

float tilt(const DepthTiles::Plane& plane) { return 3.5f * (std::abs(plane.dx) + std::abs(plane.dy)); }

/// Raises the depths of all pixels of a tile that the polygon covers whole.
void coverWholeTile(DepthTiles::Tile& tile, float* depth, const DepthTiles::Plane& plane) {
    // The last factor keeps the bound below the plane's own rounding.
    const float across = tilt(plane) * (1.0f + 0x1p-20f) + 0x1p-20f * std::abs(plane.d);
    const float farthest = std::max(plane.floor, plane.d - across);
    const bool in_front = tile.form == DepthTiles::Form::kEmpty ||
                          (tile.form == DepthTiles::Form::kPlane &&
                           farthest >= std::max(tile.plane.floor, tile.plane.d + tilt(tile.plane) * (1.0f + 0x1p-20f)));
    if (in_front) {
        tile.form = DepthTiles::Form::kPlane;
        tile.plane = plane;
        tile.covered = ~uint64_t{0};
        tile.farthest = farthest;
        return;
    }
    if (tile.form != DepthTiles::Form::kPixels) toPixels(tile, depth);
    const F8 d;
    const auto offset = hn::Iota(d, -3.5f);
    auto least = hn::Set(d, std::numeric_limits<float>::infinity());
    for (int row = 0; row < 8; ++row)
        for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
            float* place = depth + 8 * row + h;
            const auto z = planeDepth(d, plane, row, hn::Add(offset, hn::Set(d, static_cast<float>(h))));
            const auto raised = hn::Max(z, hn::LoadU(d, place));
            hn::StoreU(raised, d, place);
            least = hn::Min(least, raised);
        }
    tile.covered = ~uint64_t{0};
    tile.farthest = hn::GetLane(hn::MinOfLanes(d, least));
}

/// Bits of the pixels, and what a partial polygon does to them.
struct TileMasks {
    uint64_t inner = 0;  ///< covered whole by this polygon
    uint64_t outer = 0;  ///< touched by it
};

TileMasks classifyPixels(const TilePolygon& p, float slack) {
    const F8 d;
    const auto offset = hn::Iota(d, -3.5f);
    const auto inside = hn::Set(d, 0.5f + slack), touches = hn::Set(d, -0.5f - slack);
    TileMasks masks;
    for (int row = 0; row < 8; ++row) {
        if (!((p.window >> (8 * row)) & 255)) continue;
        const float y = static_cast<float>(row) - 3.5f;
        for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
            const auto at = hn::Add(offset, hn::Set(d, static_cast<float>(h)));
            auto least = hn::Set(d, 1e30f);
            for (int e = 0; e < p.edges; ++e)
                least = hn::Min(least, hn::Add(hn::Set(d, p.c[e] + p.b[e] * y), hn::Mul(hn::Set(d, p.a[e]), at)));
            uint8_t bits[8] = {};
            hn::StoreMaskBits(d, hn::Ge(least, inside), bits);
            masks.inner |= uint64_t{bits[0]} << (8 * row + h);
            hn::StoreMaskBits(d, hn::Ge(least, touches), bits);
            masks.outer |= uint64_t{bits[0]} << (8 * row + h);
        }
    }
    masks.outer &= p.window;
    masks.inner &= p.window;
    return masks;
}

/// Raises the depths of the covered pixels of a tile.
void coverPixels(DepthTiles::Tile& tile, float* depth, const DepthTiles::Plane& plane, uint64_t inner) {
    const F8 d;
    if (tile.form != DepthTiles::Form::kPixels) toPixels(tile, depth);
    const auto offset = hn::Iota(d, -3.5f);
    for (int row = 0; row < 8; ++row) {
        const uint64_t bits = (inner >> (8 * row)) & 255;
        if (!bits) continue;
        for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
            float* place = depth + 8 * row + h;
            const uint8_t part[8] = {static_cast<uint8_t>(bits >> h)};
            const auto z = planeDepth(d, plane, row, hn::Add(offset, hn::Set(d, static_cast<float>(h))));
            const auto old = hn::LoadU(d, place);
            hn::StoreU(hn::IfThenElse(hn::LoadMaskBits(d, part), hn::Max(old, z), old), d, place);
        }
    }
    tile.covered |= inner;
    if (tile.covered == ~uint64_t{0}) tile.farthest = leastDepth(depth);
}

/// Pixels of a tile whose depth does not surely lie in front of the given nearness.
uint64_t pixelsNotNearer(const float* depth, float nearness) {
    const F8 d;
    const auto limit = hn::Set(d, nearness);
    uint64_t open = 0;
    for (size_t i = 0; i < 64; i += hn::Lanes(d)) {
        uint8_t bits[8] = {};
        hn::StoreMaskBits(d, hn::Gt(hn::LoadU(d, depth + i), limit), bits);
        open |= uint64_t{static_cast<uint8_t>(~bits[0] & ((1u << hn::Lanes(d)) - 1))} << i;
    }
    return open;
}

/// Bits of the columns and rows of a tile that a pixel rectangle meets.
uint64_t windowBits(int32_t x0, int32_t y0, int32_t x1, int32_t y1, int32_t tile_x, int32_t tile_y) {
    const int left = std::max(0, x0 - tile_x), right = std::min(7, x1 - tile_x);
    const int low = std::max(0, y0 - tile_y), high = std::min(7, y1 - tile_y);
    const uint64_t columns = (0xffu >> (7 - right)) & (0xffu << left) & 0xffu;
    uint64_t rows = ~uint64_t{0} << (8 * low);
    if (high < 7) rows &= (uint64_t{1} << (8 * (high + 1))) - 1;
    return columns * 0x0101010101010101ull & rows;
}

/// Adds a seam triangle's pixels to a tile, making its record at the first need.
void addSeam(DepthTiles& tiles, DepthTiles::Tile& tile, uint64_t mask, const SeamTriangle& triangle,
             uint32_t& record) {
    if (record == DepthTiles::kNone) {
        record = static_cast<uint32_t>(tiles.triangles.size());
        tiles.triangles.push_back(triangle);
    }
    tiles.entries.push_back({mask, record, tile.seams});
    tile.seams = static_cast<uint32_t>(tiles.entries.size() - 1);
    tile.tried &= ~mask;
}

/// The part of a polygon that one tile sees; false if there is none, or none that the tile does not hide.
bool seenByTile(const RasterPolygon& polygon, double tilt, const DepthTiles::Tile& tile, int32_t column, int32_t row,
                TilePolygon& p, float& nearest) {
    const double x = 8.0 * column + 4.0, y = 8.0 * row + 4.0;
    p.edges = 0;
    for (int e = 0; e < polygon.edges; ++e) {
        const float c = static_cast<float>(polygon.edge[e].at(x, y));
        if (c < -4.0f - polygon.slack) return false;
        if (c >= 4.0f + polygon.slack) continue;
        p.a[p.edges] = static_cast<float>(polygon.edge[e].a);
        p.b[p.edges] = static_cast<float>(polygon.edge[e].b);
        p.c[p.edges++] = c;
    }
    nearest = polygon.nearest;
    p.plane = {polygon.farthest, 0, 0, polygon.farthest};
    if (polygon.planar) {
        const double d = polygon.d0 + polygon.dx * x + polygon.dy * y;
        const double error = polygon.depth_error + 0x1p-21 * (std::abs(d) + 4.0 * tilt);
        nearest = std::min(nearest, static_cast<float>(d + 4.0 * tilt + error));
        if (tile.farthest >= nearest) return false;
        p.plane = {static_cast<float>(d - 0.5 * tilt - error), static_cast<float>(polygon.dx),
                   static_cast<float>(polygon.dy), polygon.farthest};
    }
    p.window = windowBits(polygon.x0, polygon.y0, polygon.x1, polygon.y1, 8 * column, 8 * row);
    return true;
}

/// The tile columns of a row of tiles that the edges leave; widened by rounding to whole tiles.
void columnsOfRow(const RasterPolygon& polygon, int32_t row, int32_t& first, int32_t& last) {
    const double y = 8.0 * row + 4.0;
    double low = polygon.x0 - 4.0, high = polygon.x1 + 5.0;  // centres of tiles that may be met
    for (int e = 0; e < polygon.edges; ++e) {
        const EdgeFunction& edge = polygon.edge[e];
        if (std::abs(edge.a) < 1e-6) continue;
        const double at = -(edge.b * y + edge.c + 4.0 + polygon.slack) / edge.a;
        if (edge.a > 0) low = std::max(low, at - 1e-3);
        else high = std::min(high, at + 1e-3);
    }
    first = std::max(polygon.x0 >> 3, static_cast<int32_t>((std::clamp(low, -4.0, polygon.x1 + 16.0) + 4.0) / 8.0) - 1);
    last = std::min(polygon.x1 >> 3, static_cast<int32_t>(std::max(high, -12.0) + 12.0) / 8 - 1);
}

void drawPolygon(DepthTiles& tiles, const RasterPolygon& polygon, const SeamTriangle& triangle) {
    uint32_t record = DepthTiles::kNone;
    const double tilt = std::abs(polygon.dx) + std::abs(polygon.dy);
    for (int32_t row = polygon.y0 >> 3; row <= polygon.y1 >> 3; ++row) {
        int32_t column, last;
        columnsOfRow(polygon, row, column, last);
        for (; column <= last; ++column) {
            const uint32_t index = static_cast<uint32_t>(row) * tiles.columns + static_cast<uint32_t>(column);
            DepthTiles::Tile& tile = tiles.tiles[index];
            if (tile.farthest >= polygon.nearest) continue;
            TilePolygon p;
            float nearest;
            if (!seenByTile(polygon, tilt, tile, column, row, p, nearest)) continue;
            float* depth = tiles.depth.data() + 64 * size_t{index};
            if (polygon.covers && p.edges == 0 && p.window == ~uint64_t{0}) {
                coverWholeTile(tile, depth, p.plane);
                continue;
            }
            TileMasks masks = classifyPixels(p, polygon.slack);
            if (!polygon.covers) masks.inner = 0;
            uint64_t seam = masks.outer & ~masks.inner;
            if (masks.inner) coverPixels(tile, depth, p.plane, masks.inner);
            if (seam & tile.covered) {
                if (tile.form == DepthTiles::Form::kPlane) toPixels(tile, depth);
                seam &= pixelsNotNearer(depth, nearest);
            }
            if (seam) addSeam(tiles, tile, seam, triangle, record);
        }
    }
}

void drawClipped(DepthTiles& tiles, const Screen& object, bool reverse, bool both, const DrawnCluster& drawn,
                 SeamTriangle triangle) {
    const OccluderCluster& cluster = drawn.occluder->clusters[drawn.cluster];
    ClippedPolygon clipped;
    if (reverse) std::swap(triangle.vertex[1], triangle.vertex[2]);
    for (int turn = 0; turn < (both ? 2 : 1); ++turn) {
        if (turn) std::swap(triangle.vertex[1], triangle.vertex[2]);
        if (!clipAtNear(object, *drawn.occluder, cluster, triangle.vertex, clipped)) return;
        double area2 = 0;
        for (int i = 2; i < clipped.count; ++i)
            area2 += (clipped.x[i - 1] - clipped.x[0]) * (clipped.y[i] - clipped.y[0]) -
                     (clipped.x[i] - clipped.x[0]) * (clipped.y[i - 1] - clipped.y[0]);
        if (!(area2 > 0)) continue;
        RasterPolygon polygon;
        if (makeRasterPolygon(clipped.x, clipped.y, clipped.d, clipped.count, drawn.position_error, drawn.depth_error,
                              tiles.width, tiles.height, polygon)) {
            triangle.clipped = static_cast<uint32_t>(tiles.clipped.size());
            tiles.clipped.push_back(clipped);
            drawPolygon(tiles, polygon, triangle);
        }
        return;
    }
}

void drawTriangles(DepthTiles& tiles, const Screen& object, bool flips, const DrawnCluster& drawn) {
    const Occluder& occluder = *drawn.occluder;
    const OccluderCluster& cluster = occluder.clusters[drawn.cluster];
    const double *px = tiles.px.data() + drawn.first_vertex, *py = tiles.py.data() + drawn.first_vertex,
                 *pd = tiles.pd.data() + drawn.first_vertex;
    const bool reverse = flips != object.mirrored;  // front faces come out clockwise
    const uint8_t* index = occluder.triangles.data() + 3 * size_t{cluster.first_triangle};
    const uint8_t* flags = occluder.flags.data() + cluster.first_triangle;
    const double slack = 4.0 * (drawn.position_error + 0x1p-16);
    for (uint32_t t = 0; t < cluster.triangle_count; ++t, index += 3) {
        SeamTriangle triangle;
        triangle.drawn = static_cast<uint32_t>(tiles.drawn.size() - 1);
        triangle.vertex[0] = index[0];
        triangle.vertex[1] = index[reverse ? 2 : 1];
        triangle.vertex[2] = index[reverse ? 1 : 2];
        const bool both = flags[t] & Occluder::kDoubleSided;
        double x[3], y[3], d[3];
        for (int k = 0; k < 3; ++k) x[k] = px[triangle.vertex[k]];
        if (!(x[0] == x[0] && x[1] == x[1] && x[2] == x[2])) {
            const bool any = x[0] == x[0] || x[1] == x[1] || x[2] == x[2];
            if (any && drawn.clips) drawClipped(tiles, object, false, both, drawn, triangle);
            continue;
        }
        for (int k = 0; k < 3; ++k) y[k] = py[triangle.vertex[k]];
        const double area2 = (x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0]);
        if (area2 < 0) {
            const double perimeter = std::abs(x[1] - x[0]) + std::abs(y[1] - y[0]) + std::abs(x[2] - x[1]) +
                                     std::abs(y[2] - y[1]) + std::abs(x[0] - x[2]) + std::abs(y[0] - y[2]);
            // A sliver's winding is uncertain; it is kept as it stands, for its edges join its neighbours'.
            if (area2 < -slack * perimeter) {
                if (!both) continue;
                std::swap(triangle.vertex[1], triangle.vertex[2]);
                std::swap(x[1], x[2]);
                std::swap(y[1], y[2]);
            }
        }
        for (int k = 0; k < 3; ++k) d[k] = pd[triangle.vertex[k]];
        RasterPolygon polygon;
        if (makeRasterPolygon(x, y, d, 3, drawn.position_error, drawn.depth_error, tiles.width, tiles.height, polygon))
            drawPolygon(tiles, polygon, triangle);
    }
}

void drawClusterKernel(DepthTiles& tiles, const Screen& object, bool flips, const DrawnCluster& cluster) {
    const OccluderCluster& source = cluster.occluder->clusters[cluster.cluster];
    const size_t first = tiles.px.size(), padded = (source.vertex_count + 7u) / 8 * 8;
    tiles.px.resize(first + padded);
    tiles.py.resize(first + padded);
    tiles.pd.resize(first + padded);
    tiles.drawn.push_back(cluster);
    DrawnCluster& drawn = tiles.drawn.back();
    drawn.first_vertex = static_cast<uint32_t>(first);
    projectVertices(object, *drawn.occluder, source, tiles.px.data() + first, tiles.py.data() + first,
                    tiles.pd.data() + first);
    drawTriangles(tiles, object, flips, drawn);
}

/// What a tile leaves open of a rectangle: pixels that are not surely nearer than the rectangle.
uint64_t openPixels(DepthTiles& tiles, uint32_t index, const PixelRect& rect, int32_t column, int32_t row) {
    DepthTiles::Tile& tile = tiles.tiles[index];
    if (tile.farthest > rect.nearness) return 0;
    const uint64_t window = windowBits(rect.x0, rect.y0, rect.x1, rect.y1, 8 * column, 8 * row);
    if (tile.form == DepthTiles::Form::kEmpty) return window;
    float* depth = tiles.depth.data() + 64 * size_t{index};
    if (tile.form == DepthTiles::Form::kPlane) toPixels(tile, depth);
    return window & pixelsNotNearer(depth, rect.nearness);
}

bool isHiddenKernel(DepthTiles& tiles, const PixelRect& rect) {
    // First the cheap answer: a pixel that is open and that no seam can close makes the rectangle visible.
    bool undecided = false;
    for (int32_t row = rect.y0 >> 3; row <= rect.y1 >> 3; ++row)
        for (int32_t column = rect.x0 >> 3; column <= rect.x1 >> 3; ++column) {
            const uint32_t index = static_cast<uint32_t>(row) * tiles.columns + static_cast<uint32_t>(column);
            const uint64_t open = openPixels(tiles, index, rect, column, row);
            if (!open) continue;
            const DepthTiles::Tile& tile = tiles.tiles[index];
            uint64_t seams = 0;
            for (uint32_t at = tile.seams; at != DepthTiles::kNone; at = tiles.entries[at].next)
                seams |= tiles.entries[at].mask;
            if (open & (~seams | tile.tried)) return false;
            undecided = true;
        }
    if (!undecided) return true;
    for (int32_t row = rect.y0 >> 3; row <= rect.y1 >> 3; ++row)
        for (int32_t column = rect.x0 >> 3; column <= rect.x1 >> 3; ++column) {
            const uint32_t index = static_cast<uint32_t>(row) * tiles.columns + static_cast<uint32_t>(column);
            for (uint64_t open = openPixels(tiles, index, rect, column, row); open; open &= open - 1) {
                const int bit = std::countr_zero(open);
                if (!resolveSeam(tiles, index, bit)) return false;
                if (!(tiles.depth[64 * size_t{index} + bit] > rect.nearness)) return false;
            }
        }
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(drawClusterKernel);
HWY_EXPORT(isHiddenKernel);
HWY_EXPORT(toPixels);

void drawCluster(DepthTiles& tiles, const Screen& object, bool flips, const DrawnCluster& cluster) {
    HWY_DYNAMIC_DISPATCH(drawClusterKernel)(tiles, object, flips, cluster);
}

void writeOut(DepthTiles& tiles, uint32_t tile) {
    if (tiles.tiles[tile].form != DepthTiles::Form::kPixels)
        HWY_DYNAMIC_DISPATCH(toPixels)(tiles.tiles[tile], tiles.depth.data() + 64 * size_t{tile});
}

bool isHidden(DepthTiles& tiles, const PixelRect& rect) {
    return HWY_DYNAMIC_DISPATCH(isHiddenKernel)(tiles, rect);
}

}  // namespace sightline
#endif  // HWY_ONCE
