// Draws occluder clusters into the depth tiles: projection, tile classification, coverage.
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

#include "sightline/raster/tile_ops-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

/// The centres of a tile's pixels, relative to its own.
alignas(64) constexpr float kPixelX[64] = {
    -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f, -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f,
    -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f, -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f,
    -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f, -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f,
    -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f, -3.5f, -2.5f, -1.5f, -0.5f, 0.5f, 1.5f, 2.5f, 3.5f};
alignas(64) constexpr float kPixelY[64] = {
    -3.5f, -3.5f, -3.5f, -3.5f, -3.5f, -3.5f, -3.5f, -3.5f, -2.5f, -2.5f, -2.5f, -2.5f, -2.5f, -2.5f, -2.5f, -2.5f,
    -1.5f, -1.5f, -1.5f, -1.5f, -1.5f, -1.5f, -1.5f, -1.5f, -0.5f, -0.5f, -0.5f, -0.5f, -0.5f, -0.5f, -0.5f, -0.5f,
    0.5f,  0.5f,  0.5f,  0.5f,  0.5f,  0.5f,  0.5f,  0.5f,  1.5f,  1.5f,  1.5f,  1.5f,  1.5f,  1.5f,  1.5f,  1.5f,
    2.5f,  2.5f,  2.5f,  2.5f,  2.5f,  2.5f,  2.5f,  2.5f,  3.5f,  3.5f,  3.5f,  3.5f,  3.5f,  3.5f,  3.5f,  3.5f};

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

/// Calls `look` with the place of each vector of a tile's pixels, but for rows that the window leaves out; and
/// `begin` before that with the pixels' x, once for each vector that a row has.
template <class D, class Begin, class Look>
HWY_INLINE void forPixels(D d, uint64_t window, Begin begin, Look look) {
    const size_t lanes = hn::Lanes(d), next = std::max<size_t>(lanes, 8);
    const size_t first = static_cast<size_t>(std::countr_zero(window)) & ~(next - 1);
    const size_t end = 64 - static_cast<size_t>(std::countl_zero(window));
    for (size_t h = 0; h < 8; h += lanes) {
        const auto along = begin(hn::Load(d, kPixelX + h));
        for (size_t i = first + h; i < end; i += next) look(along, i);
    }
}

/// Names a polygon as one of those that share pixels of a tile.
HWY_INLINE void addSeam(DepthTiles& tiles, uint32_t tile, uint64_t mask, uint32_t polygon) {
    tiles.entries.push_back({mask, polygon, tiles.seams[tile]});
    tiles.seams[tile] = static_cast<uint32_t>(tiles.entries.size() - 1);
    tiles.seam_mask[tile] |= mask;
    tiles.tried[tile] &= ~mask;
}

/// The tile columns of a row of tiles that the edges leave; widened by rounding to whole tiles.
void columnsOfRow(const RasterPolygon& polygon, const double* inverse_a, int32_t row, int32_t& first, int32_t& last) {
    const double y = 8.0 * row + 4.0;
    double low = polygon.x0 - 4.0, high = polygon.x1 + 5.0;  // centres of tiles that may be met
    for (int e = 0; e < polygon.edges; ++e) {
        const EdgeFunction& edge = polygon.edge[e];
        if (inverse_a[e] == 0.0) continue;
        const double at = -(edge.b * y + edge.c + 4.0 + polygon.slack) * inverse_a[e];
        if (edge.a > 0) low = std::max(low, at - 1e-3);
        else high = std::min(high, at + 1e-3);
    }
    first = std::max(polygon.x0 >> 3, static_cast<int32_t>((std::clamp(low, -4.0, polygon.x1 + 16.0) + 4.0) / 8.0) - 1);
    last = std::min(polygon.x1 >> 3, static_cast<int32_t>(std::max(high, -12.0) + 12.0) / 8 - 1);
}

/// What the tiles need of a polygon, in float. Edges that it does not have are everywhere far inside.
struct ChunkSetup {
    double inverse_a[4];         ///< of wide polygons; 0 for an edge too level to bound a row
    float a[4] = {}, b[4] = {};  ///< edge functions' change from one pixel to the next
    float dx = 0, dy = 0;        ///< the plane's
    float tilt = 0;              ///< the plane's greatest over a pixel
};

/// What a polygon is to eight tiles of a row.
struct ChunkAnswer {
    alignas(32) float edge[4][8];  ///< edge functions at the tiles' centres
    alignas(32) float depth[8];    ///< plane there
    alignas(32) float nearest[8];  ///< no point of the polygon in the tile is nearer
    float error = 0;               ///< bound on the error of depth
    uint32_t slow = 0;             ///< bit per tile to be drawn pixel by pixel
    uint32_t inside = 0;           ///< bit per tile that lies inside all edges
};

/// Looks at eight tiles at once: leaves out those that the polygon misses or that hide it, replaces the depth of
/// those that it covers whole and lies in front of, and returns the others.
void drawChunk(DepthTiles& tiles, const RasterPolygon& polygon, const ChunkSetup& setup, int32_t chunk, int32_t row,
               ChunkAnswer& out) {
    // Values are taken in double at the first tile's centre; over eight steps of at most 8 pixels float rounds by less
    // than 2^-16 pixels, which RasterPolygon::slack holds with room to spare.
    const double x = 8.0 * chunk + 4.0, y = 8.0 * row + 4.0;
    const F8 d;
    const uint32_t base = static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(chunk);
    float c[4];
    for (int e = 0; e < polygon.edges; ++e) c[e] = static_cast<float>(polygon.edge[e].at(x, y));
    const float center =
        polygon.planar ? static_cast<float>(polygon.d0 + polygon.dx * x + polygon.dy * y) : polygon.farthest;
    const float tilt = setup.tilt;
    out.error = polygon.depth_error + 0x1p-20f * (std::abs(center) + 64.0f * tilt);
    out.slow = out.inside = 0;
    const auto error = hn::Set(d, out.error);
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto step = hn::Iota(d, static_cast<float>(h));
        auto least = hn::Set(d, 1e30f);
        for (int e = 0; e < polygon.edges; ++e) {
            const auto value = hn::Add(hn::Set(d, c[e]), hn::Mul(step, hn::Set(d, 8.0f * setup.a[e])));
            hn::Store(value, d, out.edge[e] + h);
            least = hn::Min(least, value);
        }
        const auto z = hn::Add(hn::Set(d, center), hn::Mul(step, hn::Set(d, 8.0f * setup.dx)));
        auto nearest = hn::Set(d, polygon.nearest);
        if (polygon.planar) nearest = hn::Min(nearest, hn::Add(hn::Add(z, hn::Set(d, 4.0f * tilt)), error));
        hn::Store(z, d, out.depth + h);
        hn::Store(nearest, d, out.nearest + h);
        const auto met = hn::And(hn::Ge(least, hn::Set(d, -4.0f - polygon.slack)),
                                 hn::Lt(hn::LoadU(d, tiles.farthest.data() + base + h), nearest));
        const auto inside = hn::Ge(least, hn::Set(d, 4.0f + polygon.slack));
        out.inside |= static_cast<uint32_t>(bitsFromMask(d, inside)) << h;
        uint32_t left = static_cast<uint32_t>(bitsFromMask(d, met));
        if (left && polygon.covers) {
            const auto floor = hn::Set(d, polygon.farthest);
            const auto plane = hn::Sub(hn::Sub(z, hn::Set(d, 0.5f * tilt)), error);
            const auto across = hn::Add(hn::Set(d, 3.5f * tilt), error);
            const auto farthest = hn::Max(hn::Sub(plane, across), floor);
            const auto whole =
                hn::And(hn::And(met, inside), hn::Ge(farthest, hn::LoadU(d, tiles.nearest.data() + base + h)));
            const uint32_t replaced = static_cast<uint32_t>(bitsFromMask(d, whole));
            left &= ~replaced;
            if (replaced) {
                const auto put = [&](auto value, Array<float>& array)
                                     HWY_ATTR { hn::BlendedStore(value, whole, d, array.data() + base + h); };
                put(plane, tiles.plane_d);
                put(hn::Set(d, setup.dx), tiles.plane_dx);
                put(hn::Set(d, setup.dy), tiles.plane_dy);
                put(floor, tiles.plane_floor);
                put(farthest, tiles.farthest);
                put(hn::Max(hn::Add(plane, across), floor), tiles.nearest);
                for (uint32_t set = replaced; set; set &= set - 1)
                    tiles.form[base + h + static_cast<size_t>(std::countr_zero(set))] = DepthTiles::Form::kPlane;
            }
        }
        out.slow |= left << h;
    }
}

/// Bits of the pixels that a polygon covers whole, and of those that it touches.
struct TileMasks {
    uint64_t inner = 0, outer = 0;
};

HWY_INLINE TileMasks classifyPixels(const ChunkSetup& setup, const ChunkAnswer& chunk, int at, float slack,
                                    uint64_t window) {
    const F16 d;
    using V = hn::Vec<F16>;
    struct Edges {
        V e0, e1, e2, e3;
    };
    const auto inside = hn::Set(d, 0.5f + slack), touches = hn::Set(d, -0.5f - slack);
    const auto b0 = hn::Set(d, setup.b[0]), b1 = hn::Set(d, setup.b[1]);
    const auto b2 = hn::Set(d, setup.b[2]), b3 = hn::Set(d, setup.b[3]);
    TileMasks masks;
    forPixels(
        d, window,
        [&](V x) HWY_ATTR {
            const auto along = [&](int e) HWY_ATTR {
                return hn::Add(hn::Set(d, chunk.edge[e][at]), hn::Mul(hn::Set(d, setup.a[e]), x));
            };
            return Edges{along(0), along(1), along(2), along(3)};
        },
        [&](const Edges& edges, size_t i) HWY_ATTR {
            const auto y = hn::Load(d, kPixelY + i);
            const auto e01 = hn::Min(hn::Add(edges.e0, hn::Mul(b0, y)), hn::Add(edges.e1, hn::Mul(b1, y)));
            const auto e23 = hn::Min(hn::Add(edges.e2, hn::Mul(b2, y)), hn::Add(edges.e3, hn::Mul(b3, y)));
            const auto least = hn::Min(e01, e23);
            masks.inner |= bitsFromMask(d, hn::Ge(least, inside)) << i;
            masks.outer |= bitsFromMask(d, hn::Ge(least, touches)) << i;
        });
    return {masks.inner & window, masks.outer & window};
}

/// Raises the depths of the pixels that the mask names; returns those of all pixels that are nearer than the polygon.
/// @param nearest  no point of the polygon in the tile is nearer
HWY_INLINE uint64_t coverPixels(DepthTiles& tiles, uint32_t tile, const TilePlane& plane, float nearest,
                                uint64_t mask) {
    const F16 d;
    using V = hn::Vec<F16>;
    const bool empty = tiles.form[tile] == DepthTiles::Form::kEmpty;
    if (!empty) toPixels(tiles, tile);
    float* depth = tiles.depth.data() + 64 * size_t{tile};
    const auto center = hn::Set(d, plane.d), floor = hn::Set(d, plane.floor), limit = hn::Set(d, nearest);
    const auto dx = hn::Set(d, plane.dx), dy = hn::Set(d, plane.dy);
    const auto open = hn::Set(d, -std::numeric_limits<float>::infinity());
    auto least = hn::Set(d, std::numeric_limits<float>::infinity());
    uint64_t nearer = 0;
    forPixels(
        d, ~uint64_t{0}, [&](V x) HWY_ATTR { return hn::Add(center, hn::Mul(dx, x)); },
        [&](V along, size_t i) HWY_ATTR {
            const auto z = hn::Max(hn::Add(along, hn::Mul(dy, hn::Load(d, kPixelY + i))), floor);
            const auto old = empty ? open : hn::LoadU(d, depth + i);
            const auto raised = hn::IfThenElse(maskFromBits(d, mask >> i), hn::Max(old, z), old);
            hn::StoreU(raised, d, depth + i);
            least = hn::Min(least, raised);
            nearer |= bitsFromMask(d, hn::Gt(raised, limit)) << i;
        });
    tiles.covered[tile] = empty ? mask : tiles.covered[tile] | mask;
    tiles.form[tile] = DepthTiles::Form::kPixels;
    tiles.nearest[tile] = std::numeric_limits<float>::infinity();
    if (tiles.covered[tile] == ~uint64_t{0}) tiles.farthest[tile] = hn::GetLane(hn::MinOfLanes(d, least));
    return nearer;
}

/// Draws into one tile that the polygon covers in part, or whose depth it does not simply replace. Returns the pixels
/// that it shares with others.
/// @param at  the tile's place in the chunk
HWY_INLINE uint64_t drawTile(DepthTiles& tiles, uint32_t tile, const RasterPolygon& polygon, const ChunkSetup& setup,
                             const ChunkAnswer& chunk, int at, uint64_t window) {
    TileMasks masks{window, window};
    if (!(chunk.inside >> at & 1)) masks = classifyPixels(setup, chunk, at, polygon.slack, window);
    if (!polygon.covers) masks.inner = 0;
    const uint64_t seam = masks.outer & ~masks.inner;
    const float nearest = chunk.nearest[at];
    if (masks.inner) {
        TilePlane plane{polygon.farthest, 0, 0, polygon.farthest};
        if (polygon.planar)
            plane = {chunk.depth[at] - 0.5f * setup.tilt - chunk.error, setup.dx, setup.dy, polygon.farthest};
        return seam & ~coverPixels(tiles, tile, plane, nearest, masks.inner);
    }
    if (!(seam & tiles.coveredBits(tile))) return seam;
    toPixels(tiles, tile);
    return seam & pixelsNotNearer(tiles.depth.data() + 64 * size_t{tile}, nearest);
}

ChunkSetup makeChunkSetup(const RasterPolygon& polygon, bool wide) {
    ChunkSetup setup;
    for (int e = 0; e < polygon.edges; ++e) {
        const double a = polygon.edge[e].a;
        setup.a[e] = static_cast<float>(a);
        setup.b[e] = static_cast<float>(polygon.edge[e].b);
        if (wide) setup.inverse_a[e] = std::abs(a) < 1e-6 ? 0.0 : 1.0 / a;
    }
    if (!polygon.planar) return setup;
    setup.dx = static_cast<float>(polygon.dx);
    setup.dy = static_cast<float>(polygon.dy);
    setup.tilt = static_cast<float>(std::abs(polygon.dx) + std::abs(polygon.dy));
    return setup;
}

/// Draws the last of the tiles' seam polygons, and drops it again if no pixel is left to share.
void drawPolygon(DepthTiles& tiles) {
    const uint32_t record = static_cast<uint32_t>(tiles.polygons.size() - 1);
    const RasterPolygon& polygon = tiles.polygons.back().raster;
    const bool wide = (polygon.x1 >> 6) - (polygon.x0 >> 6) > 1;
    const ChunkSetup setup = makeChunkSetup(polygon, wide);
    ChunkAnswer answer;
    for (int e = polygon.edges; e < 4; ++e) std::fill_n(answer.edge[e], 8, 1e30f);
    bool shares = false;
    for (int32_t row = polygon.y0 >> 3; row <= polygon.y1 >> 3; ++row) {
        int32_t first = polygon.x0 >> 3, last = polygon.x1 >> 3;
        if (wide) columnsOfRow(polygon, setup.inverse_a, row, first, last);
        for (int32_t chunk = first & ~7; chunk <= last; chunk += 8) {
            drawChunk(tiles, polygon, setup, chunk, row, answer);
            uint32_t slow = answer.slow & 0xffu << std::max(0, first - chunk) & 0xffu >> std::max(0, chunk + 7 - last);
            for (; slow; slow &= slow - 1) {
                const int at = std::countr_zero(slow);
                const uint32_t tile = static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(chunk + at);
                const uint64_t window =
                    windowBits(polygon.x0, polygon.y0, polygon.x1, polygon.y1, 8 * (chunk + at), 8 * row);
                const uint64_t seam = drawTile(tiles, tile, polygon, setup, answer, at, window);
                if (seam) addSeam(tiles, tile, seam, record);
                shares |= seam != 0;
            }
        }
    }
    if (!shares) tiles.polygons.pop_back();
}

/// A cluster's polygons on their way to the tiles.
struct ClusterDraw {
    DepthTiles& tiles;
    const Screen& object;
    const DrawnCluster& drawn;
    const double *x, *y, *d;  ///< projected vertices
    double slack;             ///< a winding is certain if area > slack * perimeter
};

/// Twice the signed area of three projected corners.
double areaOf(const ClusterDraw& c, uint8_t i, uint8_t j, uint8_t k) {
    return (c.x[j] - c.x[i]) * (c.y[k] - c.y[i]) - (c.x[k] - c.x[i]) * (c.y[j] - c.y[i]);
}

double perimeterOf(const ClusterDraw& c, uint8_t i, uint8_t j, uint8_t k) {
    const auto side = [&](uint8_t a, uint8_t b) { return std::abs(c.x[b] - c.x[a]) + std::abs(c.y[b] - c.y[a]); };
    return side(i, j) + side(j, k) + side(k, i);
}

/// Some of a cluster's vertices, counter-clockwise on the screen.
struct Corners {
    uint8_t vertex[4];
    uint8_t count;
};

/// Makes a place among the tiles' seam polygons, where a polygon stays if it shares pixels.
SeamPolygon& addPolygon(const ClusterDraw& c, uint32_t corners) {
    SeamPolygon& polygon = c.tiles.polygons.emplace_back();
    polygon.drawn = static_cast<uint32_t>(c.tiles.drawn.size() - 1);
    polygon.corners = static_cast<uint8_t>(corners);
    return polygon;
}

void drawClipped(const ClusterDraw& c, Corners corners, bool both) {
    const OccluderCluster& cluster = c.drawn.occluder->clusters[c.drawn.cluster];
    ClippedPolygon clipped;
    for (int turn = 0; turn < (both ? 2 : 1); ++turn) {
        if (turn) std::swap(corners.vertex[1], corners.vertex[2]);
        if (!clipAtNear(c.object, *c.drawn.occluder, cluster, corners.vertex, clipped)) return;
        double area2 = 0;
        for (int i = 2; i < clipped.count; ++i)
            area2 += (clipped.x[i - 1] - clipped.x[0]) * (clipped.y[i] - clipped.y[0]) -
                     (clipped.x[i] - clipped.x[0]) * (clipped.y[i - 1] - clipped.y[0]);
        if (!(area2 > 0)) continue;
        SeamPolygon& polygon = addPolygon(c, static_cast<uint32_t>(clipped.count));
        if (!makeRasterPolygon(clipped.x, clipped.y, clipped.d, clipped.count, c.drawn.position_error,
                               c.drawn.depth_error, c.tiles.width, c.tiles.height, polygon.raster))
            return c.tiles.polygons.pop_back();
        polygon.clipped = static_cast<uint32_t>(c.tiles.clipped.size());
        c.tiles.clipped.push_back(clipped);
        return drawPolygon(c.tiles);
    }
}

/// Gathers a polygon's corners. Null if it misses the buffer.
const RasterPolygon* makePolygon(const ClusterDraw& c, const Corners& corners) {
    double x[4], y[4], d[4];
    SeamPolygon& polygon = addPolygon(c, corners.count);
    std::copy(corners.vertex, corners.vertex + 4, polygon.vertex);
    for (int k = 0; k < corners.count; ++k) {
        x[k] = c.x[corners.vertex[k]];
        y[k] = c.y[corners.vertex[k]];
        d[k] = c.d[corners.vertex[k]];
    }
    if (makeRasterPolygon(x, y, d, corners.count, c.drawn.position_error, c.drawn.depth_error, c.tiles.width,
                          c.tiles.height, polygon.raster))
        return &polygon.raster;
    c.tiles.polygons.pop_back();
    return nullptr;
}

void drawTriangle(const ClusterDraw& c, uint8_t v0, uint8_t v1, uint8_t v2, bool both) {
    Corners corners{{v0, v1, v2, 0}, 3};
    const int before = std::isnan(c.x[v0]) + std::isnan(c.x[v1]) + std::isnan(c.x[v2]);
    if (before) {
        if (before < 3 && c.drawn.clips) drawClipped(c, corners, both);
        return;
    }
    // A sliver's winding is uncertain; it is kept as it stands, for its sides join its neighbours'.
    if (areaOf(c, v0, v1, v2) < -c.slack * perimeterOf(c, v0, v1, v2)) {
        if (!both) return;
        std::swap(corners.vertex[1], corners.vertex[2]);
    }
    if (makePolygon(c, corners)) drawPolygon(c.tiles);
}

/// Draws a quadrangle at once if it is surely convex and counter-clockwise, and flat enough for one plane. Returns
/// false if its triangles have to be drawn one by one.
bool drawQuad(const ClusterDraw& c, const uint8_t* vertex, bool both) {
    constexpr float kFlat = 1e-3f;
    Corners corners{{vertex[0], vertex[1], vertex[2], vertex[3]}, 4};
    const uint8_t* v = corners.vertex;
    const double first = areaOf(c, v[0], v[1], v[2]), second = areaOf(c, v[0], v[2], v[3]);
    const double least = c.slack * (perimeterOf(c, v[0], v[1], v[2]) + perimeterOf(c, v[0], v[2], v[3]));
    if (first < -least && second < -least) {
        if (!both) return true;
        std::swap(corners.vertex[1], corners.vertex[3]);
    } else if (!(first > least && second > least)) {  // one may be front and one back; or a vertex has no image
        return false;
    }
    if (!(areaOf(c, v[0], v[1], v[3]) > least && areaOf(c, v[1], v[2], v[3]) > least)) return false;
    const RasterPolygon* polygon = makePolygon(c, corners);
    if (!polygon) return true;
    if (polygon->depth_error <= kFlat * std::abs(polygon->nearest)) {
        drawPolygon(c.tiles);
        return true;
    }
    c.tiles.polygons.pop_back();
    return false;
}

void drawPolygons(DepthTiles& tiles, const Screen& object, bool flips, const DrawnCluster& drawn) {
    const Occluder& occluder = *drawn.occluder;
    const OccluderCluster& cluster = occluder.clusters[drawn.cluster];
    const ClusterDraw c{tiles,
                        object,
                        drawn,
                        tiles.px.data() + drawn.first_vertex,
                        tiles.py.data() + drawn.first_vertex,
                        tiles.pd.data() + drawn.first_vertex,
                        4.0 * (drawn.position_error + 0x1p-16)};
    const bool reverse = flips != object.mirrored;  // front faces come out clockwise
    for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p) {
        const OccluderPolygon& polygon = occluder.polygons[p];
        const bool both = polygon.double_sided;
        uint8_t v[4];
        std::copy(polygon.vertex, polygon.vertex + 4, v);
        if (reverse) std::swap(v[1], v[polygon.corners() - 1]);
        if (polygon.corners() == 4 && drawQuad(c, v, both)) continue;
        drawTriangle(c, v[0], v[1], v[2], both);
        if (polygon.corners() == 4) drawTriangle(c, v[0], v[2], v[3], both);
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
    drawPolygons(tiles, object, flips, drawn);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(drawClusterKernel);

void drawCluster(DepthTiles& tiles, const Screen& object, bool flips, const DrawnCluster& cluster) {
    HWY_DYNAMIC_DISPATCH(drawClusterKernel)(tiles, object, flips, cluster);
}

}  // namespace sightline
#endif  // HWY_ONCE
