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

/// One tile's view of a polygon.
struct TilePolygon {
    float a[4], b[4], at_center[4];  ///< of the edges that do not contain the whole tile
    int cutting = 0;                 ///< how many those are
    TilePlane plane;                 ///< the farthest nearness over each pixel
    float nearest = 0;               ///< no point of the polygon in the tile is nearer
    uint64_t window = ~uint64_t{0};  ///< pixels inside the polygon's bounds
};

/// Raises the depths of a tile's pixels that the mask names.
void coverPixels(DepthTiles& tiles, uint32_t tile, const TilePlane& plane, uint64_t mask) {
    const F16 d;
    toPixels(tiles, tile);
    float* depth = tiles.depth.data() + 64 * size_t{tile};
    const auto center = hn::Set(d, plane.d), floor = hn::Set(d, plane.floor);
    const auto dx = hn::Set(d, plane.dx), dy = hn::Set(d, plane.dy);
    auto least = hn::Set(d, std::numeric_limits<float>::infinity());
    for (size_t i = 0; i < 64; i += hn::Lanes(d)) {
        const auto across = hn::Add(hn::Mul(dx, hn::Load(d, kPixelX + i)), hn::Mul(dy, hn::Load(d, kPixelY + i)));
        const auto z = hn::Max(hn::Add(center, across), floor);
        const auto old = hn::LoadU(d, depth + i);
        const auto raised = hn::IfThenElse(maskFromBits(d, mask >> i), hn::Max(old, z), old);
        hn::StoreU(raised, d, depth + i);
        least = hn::Min(least, raised);
    }
    tiles.covered[tile] |= mask;
    if (tiles.covered[tile] == ~uint64_t{0}) tiles.farthest[tile] = hn::GetLane(hn::MinOfLanes(d, least));
}

/// Bits of the pixels that a polygon covers whole, and of those that it touches.
struct TileMasks {
    uint64_t inner = 0, outer = 0;
};

TileMasks classifyPixels(const RasterPolygon& polygon, const TilePolygon& p) {
    const F16 d;
    const uint64_t lanes = hn::Lanes(d) < 64 ? (uint64_t{1} << hn::Lanes(d)) - 1 : ~uint64_t{0};
    const auto inside = hn::Set(d, 0.5f + polygon.slack), touches = hn::Set(d, -0.5f - polygon.slack);
    TileMasks masks;
    for (size_t i = 0; i < 64; i += hn::Lanes(d)) {
        if (!(p.window >> i & lanes)) continue;
        const auto x = hn::Load(d, kPixelX + i), y = hn::Load(d, kPixelY + i);
        auto least = hn::Set(d, 1e30f);
        for (int e = 0; e < p.cutting; ++e) {
            const auto across = hn::Add(hn::Mul(hn::Set(d, p.a[e]), x), hn::Mul(hn::Set(d, p.b[e]), y));
            least = hn::Min(least, hn::Add(hn::Set(d, p.at_center[e]), across));
        }
        masks.inner |= bitsFromMask(d, hn::Ge(least, inside)) << i;
        masks.outer |= bitsFromMask(d, hn::Ge(least, touches)) << i;
    }
    masks.outer &= p.window;
    masks.inner &= p.window;
    return masks;
}

/// Adds a seam polygon's pixels to a tile, making its record at the first need.
void addSeam(DepthTiles& tiles, uint32_t tile, uint64_t mask, const RasterPolygon& raster, const SeamPolygon& source,
             uint32_t& record) {
    if (record == DepthTiles::kNone) {
        record = static_cast<uint32_t>(tiles.polygons.size());
        tiles.polygons.push_back(source);
        tiles.polygons.back().raster = raster;
    }
    tiles.entries.push_back({mask, record, tiles.seams[tile]});
    tiles.seams[tile] = static_cast<uint32_t>(tiles.entries.size() - 1);
    tiles.seam_mask[tile] |= mask;
    tiles.tried[tile] &= ~mask;
}

/// Draws into one tile that the polygon covers in part, or whose depth it does not simply replace.
void drawTile(DepthTiles& tiles, uint32_t tile, const RasterPolygon& polygon, const TilePolygon& p,
              const SeamPolygon& source, uint32_t& record) {
    TileMasks masks{p.window, p.window};
    if (p.cutting) masks = classifyPixels(polygon, p);
    if (!polygon.covers) masks.inner = 0;
    uint64_t seam = masks.outer & ~masks.inner;
    if (masks.inner) coverPixels(tiles, tile, p.plane, masks.inner);
    if (seam & tiles.coveredBits(tile)) {
        toPixels(tiles, tile);
        seam &= pixelsNotNearer(tiles.depth.data() + 64 * size_t{tile}, p.nearest);
    }
    if (seam) addSeam(tiles, tile, seam, polygon, source, record);
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

/// What changes from tile to tile along a row.
struct ChunkSetup {
    double inverse_a[4];  ///< of wide polygons; 0 for an edge too level to bound a row
    float step_a[4];      ///< edge functions' change from one tile to the next
    float step_d;         ///< the plane's
    float tilt;           ///< the plane's change over a pixel
};

/// What a polygon is to eight tiles of a row.
struct ChunkAnswer {
    alignas(32) float edge[4][8];  ///< edge functions at the tiles' centres
    alignas(32) float depth[8];    ///< plane there
    alignas(32) float nearest[8];  ///< no point of the polygon in the tile is nearer
    float error = 0;               ///< bound on the error of depth
    uint32_t slow = 0;             ///< bit per tile to be drawn pixel by pixel
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
    out.slow = 0;
    const auto error = hn::Set(d, out.error);
    for (size_t h = 0; h < 8; h += hn::Lanes(d)) {
        const auto step = hn::Iota(d, static_cast<float>(h));
        auto least = hn::Set(d, 1e30f);
        for (int e = 0; e < polygon.edges; ++e) {
            const auto value = hn::Add(hn::Set(d, c[e]), hn::Mul(step, hn::Set(d, setup.step_a[e])));
            hn::Store(value, d, out.edge[e] + h);
            least = hn::Min(least, value);
        }
        const auto z = hn::Add(hn::Set(d, center), hn::Mul(step, hn::Set(d, setup.step_d)));
        auto nearest = hn::Set(d, polygon.nearest);
        if (polygon.planar) nearest = hn::Min(nearest, hn::Add(hn::Add(z, hn::Set(d, 4.0f * tilt)), error));
        hn::Store(z, d, out.depth + h);
        hn::Store(nearest, d, out.nearest + h);
        const auto met = hn::And(hn::Ge(least, hn::Set(d, -4.0f - polygon.slack)),
                                 hn::Lt(hn::LoadU(d, tiles.farthest.data() + base + h), nearest));
        uint32_t left = static_cast<uint32_t>(bitsFromMask(d, met));
        if (left && polygon.covers) {
            const auto floor = hn::Set(d, polygon.farthest);
            const auto plane = hn::Sub(hn::Sub(z, hn::Set(d, 0.5f * tilt)), error);
            const auto across = hn::Add(hn::Set(d, 3.5f * tilt), error);
            const auto farthest = hn::Max(hn::Sub(plane, across), floor);
            const auto whole = hn::And(hn::And(met, hn::Ge(least, hn::Set(d, 4.0f + polygon.slack))),
                                       hn::Ge(farthest, hn::LoadU(d, tiles.nearest.data() + base + h)));
            const uint32_t replaced = static_cast<uint32_t>(bitsFromMask(d, whole));
            left &= ~replaced;
            if (replaced) {
                const auto put = [&](auto value, std::vector<float>& array)
                                     HWY_ATTR { hn::BlendedStore(value, whole, d, array.data() + base + h); };
                put(plane, tiles.plane_d);
                put(hn::Set(d, static_cast<float>(polygon.dx)), tiles.plane_dx);
                put(hn::Set(d, static_cast<float>(polygon.dy)), tiles.plane_dy);
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

/// One tile's view of a polygon, from its chunk's.
TilePolygon seenByTile(const RasterPolygon& polygon, const ChunkSetup& setup, const ChunkAnswer& chunk, int at,
                       int32_t column, int32_t row) {
    TilePolygon p;
    for (int e = 0; e < polygon.edges; ++e) {
        if (chunk.edge[e][at] >= 4.0f + polygon.slack) continue;
        p.a[p.cutting] = static_cast<float>(polygon.edge[e].a);
        p.b[p.cutting] = static_cast<float>(polygon.edge[e].b);
        p.at_center[p.cutting++] = chunk.edge[e][at];
    }
    p.nearest = chunk.nearest[at];
    p.plane = {polygon.farthest, 0, 0, polygon.farthest};
    if (polygon.planar)
        p.plane = {chunk.depth[at] - 0.5f * setup.tilt - chunk.error, static_cast<float>(polygon.dx),
                   static_cast<float>(polygon.dy), polygon.farthest};
    const bool within =
        8 * column >= polygon.x0 && 8 * column + 7 <= polygon.x1 && 8 * row >= polygon.y0 && 8 * row + 7 <= polygon.y1;
    if (!within) p.window = windowBits(polygon.x0, polygon.y0, polygon.x1, polygon.y1, 8 * column, 8 * row);
    return p;
}

ChunkSetup makeChunkSetup(const RasterPolygon& polygon, bool wide) {
    ChunkSetup setup;
    for (int e = 0; e < polygon.edges; ++e) {
        const double a = polygon.edge[e].a;
        setup.step_a[e] = static_cast<float>(8.0 * a);
        if (wide) setup.inverse_a[e] = std::abs(a) < 1e-6 ? 0.0 : 1.0 / a;
    }
    setup.step_d = polygon.planar ? static_cast<float>(8.0 * polygon.dx) : 0.0f;
    setup.tilt = polygon.planar ? static_cast<float>(std::abs(polygon.dx) + std::abs(polygon.dy)) : 0.0f;
    return setup;
}

void drawPolygon(DepthTiles& tiles, const RasterPolygon& polygon, const SeamPolygon& source) {
    uint32_t record = DepthTiles::kNone;
    const bool wide = (polygon.x1 >> 6) - (polygon.x0 >> 6) > 1;
    const ChunkSetup setup = makeChunkSetup(polygon, wide);
    ChunkAnswer answer;
    for (int32_t row = polygon.y0 >> 3; row <= polygon.y1 >> 3; ++row) {
        int32_t first = polygon.x0 >> 3, last = polygon.x1 >> 3;
        if (wide) columnsOfRow(polygon, setup.inverse_a, row, first, last);
        for (int32_t chunk = first & ~7; chunk <= last; chunk += 8) {
            drawChunk(tiles, polygon, setup, chunk, row, answer);
            uint32_t slow = answer.slow & 0xffu << std::max(0, first - chunk) & 0xffu >> std::max(0, chunk + 7 - last);
            for (; slow; slow &= slow - 1) {
                const int at = std::countr_zero(slow);
                const uint32_t tile = static_cast<uint32_t>(row) * tiles.stride + static_cast<uint32_t>(chunk + at);
                drawTile(tiles, tile, polygon, seenByTile(polygon, setup, answer, at, chunk + at, row), source, record);
            }
        }
    }
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

void drawClipped(const ClusterDraw& c, SeamPolygon source, bool both) {
    const OccluderCluster& cluster = c.drawn.occluder->clusters[c.drawn.cluster];
    ClippedPolygon clipped;
    for (int turn = 0; turn < (both ? 2 : 1); ++turn) {
        if (turn) std::swap(source.vertex[1], source.vertex[2]);
        if (!clipAtNear(c.object, *c.drawn.occluder, cluster, source.vertex, clipped)) return;
        double area2 = 0;
        for (int i = 2; i < clipped.count; ++i)
            area2 += (clipped.x[i - 1] - clipped.x[0]) * (clipped.y[i] - clipped.y[0]) -
                     (clipped.x[i] - clipped.x[0]) * (clipped.y[i - 1] - clipped.y[0]);
        if (!(area2 > 0)) continue;
        RasterPolygon polygon;
        if (makeRasterPolygon(clipped.x, clipped.y, clipped.d, clipped.count, c.drawn.position_error,
                              c.drawn.depth_error, c.tiles.width, c.tiles.height, polygon)) {
            source.clipped = static_cast<uint32_t>(c.tiles.clipped.size());
            source.corners = static_cast<uint8_t>(clipped.count);
            c.tiles.clipped.push_back(clipped);
            drawPolygon(c.tiles, polygon, source);
        }
        return;
    }
}

/// Gathers a polygon's corners and draws it.
bool makePolygon(const ClusterDraw& c, const SeamPolygon& source, RasterPolygon& polygon) {
    double x[4], y[4], d[4];
    for (int k = 0; k < source.corners; ++k) {
        x[k] = c.x[source.vertex[k]];
        y[k] = c.y[source.vertex[k]];
        d[k] = c.d[source.vertex[k]];
    }
    return makeRasterPolygon(x, y, d, source.corners, c.drawn.position_error, c.drawn.depth_error, c.tiles.width,
                             c.tiles.height, polygon);
}

void drawTriangle(const ClusterDraw& c, SeamPolygon source, bool both) {
    uint8_t* v = source.vertex;
    source.corners = 3;
    const int before = std::isnan(c.x[v[0]]) + std::isnan(c.x[v[1]]) + std::isnan(c.x[v[2]]);
    if (before) {
        if (before < 3 && c.drawn.clips) drawClipped(c, source, both);
        return;
    }
    // A sliver's winding is uncertain; it is kept as it stands, for its sides join its neighbours'.
    if (areaOf(c, v[0], v[1], v[2]) < -c.slack * perimeterOf(c, v[0], v[1], v[2])) {
        if (!both) return;
        std::swap(v[1], v[2]);
    }
    RasterPolygon polygon;
    if (makePolygon(c, source, polygon)) drawPolygon(c.tiles, polygon, source);
}

/// Draws a quadrangle at once if it is surely convex and counter-clockwise, and flat enough for one plane. Returns
/// false if its triangles have to be drawn one by one.
bool drawQuad(const ClusterDraw& c, SeamPolygon source, bool both) {
    constexpr float kFlat = 1e-3f;
    uint8_t* v = source.vertex;
    const double first = areaOf(c, v[0], v[1], v[2]), second = areaOf(c, v[0], v[2], v[3]);
    const double least = c.slack * (perimeterOf(c, v[0], v[1], v[2]) + perimeterOf(c, v[0], v[2], v[3]));
    if (first < -least && second < -least) {
        if (!both) return true;
        std::swap(v[1], v[3]);
    } else if (!(first > least && second > least)) {  // one may be front and one back; or a vertex has no image
        return false;
    }
    if (!(areaOf(c, v[0], v[1], v[3]) > least && areaOf(c, v[1], v[2], v[3]) > least)) return false;
    RasterPolygon polygon;
    if (!makePolygon(c, source, polygon)) return true;
    if (!(polygon.depth_error <= kFlat * std::abs(polygon.nearest))) return false;
    drawPolygon(c.tiles, polygon, source);
    return true;
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
        SeamPolygon source;
        source.drawn = static_cast<uint32_t>(tiles.drawn.size() - 1);
        source.corners = static_cast<uint8_t>(polygon.corners());
        std::copy(polygon.vertex, polygon.vertex + 4, source.vertex);
        if (source.corners == 3) {
            if (reverse) std::swap(source.vertex[1], source.vertex[2]);
            drawTriangle(c, source, polygon.double_sided);
            continue;
        }
        if (reverse) std::swap(source.vertex[1], source.vertex[3]);
        if (drawQuad(c, source, polygon.double_sided)) continue;
        drawTriangle(c, source, polygon.double_sided);
        source.vertex[1] = source.vertex[2];
        source.vertex[2] = source.vertex[3];
        drawTriangle(c, source, polygon.double_sided);
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
