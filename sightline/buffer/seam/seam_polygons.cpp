// Makes the polygons of a drawn cluster for the seams that it left, each when it is first asked for.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/buffer/near_clip.h"
#include "sightline/buffer/covers.h"
#include "sightline/buffer/seam/seam.h"

namespace sightline {
namespace {

/// Hashes of a polygon's edge functions, the same for both signs: a side that two polygons share has the same function
/// in both, but for its sign.
void setEdgeKeys(SeamPolygon& polygon) {
    if (!polygon.raster.complete) return;
    for (int i = 0; i < polygon.raster.edges; ++i) {
        const EdgeFunction& edge = polygon.raster.edge[i];
        uint64_t h = 0x2545f4914f6cdd1dull;
        for (const double value : {edge.a, edge.b, edge.c})
            h = (h ^ std::bit_cast<uint64_t>(std::abs(value))) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
        polygon.edge_key[i] = static_cast<uint32_t>(h >> 32);
        polygon.edge_bits |= uint64_t{1} << (polygon.edge_key[i] & 63);
    }
}

/// A drawn cluster's polygons on their way to DepthTiles::polygons.
class Maker {
public:
    Maker(DepthTiles& tiles, uint32_t drawn)
        : tiles_(tiles), drawn_(drawn), cluster_(record().occluder->clusters[record().cluster]) {}

    /// Makes one of the cluster's polygons: none if it is turned away or not drawn from there, two triangles of a quadrangle that is not flat.
    void make(uint32_t p) {
        SIGHTLINE_DEBUG_ASSERT(p < cluster_.polygon_count);
        if (!isDrawn(p)) return;
        source_ = static_cast<uint8_t>(p);
        uint8_t v[4];
        const int corners = take(p, v);
        if (corners == 4 && addQuad(v)) return;
        addTriangle(v[0], v[1], v[2]);
        if (corners == 4) addTriangle(v[0], v[2], v[3]);
    }

    /// Bounds one of its polygons, by more than rounding; inverted bounds where nothing would be made.
    /// @param px,py  of the cluster's vertices
    void bound(uint32_t p, const double* px, const double* py, float (&box)[4]) {
        SIGHTLINE_DEBUG_ASSERT(p < cluster_.polygon_count);
        constexpr float kAll = std::numeric_limits<float>::infinity();
        box[0] = box[1] = kAll, box[2] = box[3] = -kAll;
        if (!isDrawn(p)) return;
        uint8_t v[4];
        const int corners = take(p, v);
        double x0 = px[v[0]], y0 = py[v[0]], x1 = x0, y1 = y0, area2 = 0;
        bool before = std::isnan(x0);
        for (int i = 1; i < corners; ++i) {
            const double vx = px[v[i]], vy = py[v[i]];
            before |= std::isnan(vx);
            x0 = std::min(x0, vx), x1 = std::max(x1, vx);
            y0 = std::min(y0, vy), y1 = std::max(y1, vy);
            if (corners == 3 && i == 2)
                area2 = (px[v[1]] - px[v[0]]) * (vy - py[v[0]]) - (vx - px[v[0]]) * (py[v[1]] - py[v[0]]);
        }
        const double e = record().position_error + 0x1p-10;
        if (before) box[0] = box[1] = -kAll, box[2] = box[3] = kAll;
        else if (!(area2 < -8.0 * e * (x1 - x0 + y1 - y0))) {
            const auto moved = [&](double at, double by) {
                const double clamped = std::clamp(at, -1e9, 1e9);
                return static_cast<float>(clamped + by * (e + std::abs(clamped) * 0x1p-22));
            };
            box[0] = moved(x0, -1.0), box[1] = moved(y0, -1.0), box[2] = moved(x1, 1.0), box[3] = moved(y1, 1.0);
        }
    }

private:
    DrawnCluster& record() { return tiles_.drawn[drawn_]; }
    size_t place(uint8_t v) {
        SIGHTLINE_DEBUG_ASSERT(v < cluster_.vertex_count && record().first_vertex + v < tiles_.vertex_count);
        return size_t{record().first_vertex} + v;
    }
    double x(uint8_t v) { return tiles_.px[place(v)]; }
    double y(uint8_t v) { return tiles_.py[place(v)]; }
    double d(uint8_t v) { return tiles_.pd[place(v)]; }
    double areaOf(uint8_t i, uint8_t j, uint8_t k) {
        return (x(j) - x(i)) * (y(k) - y(i)) - (x(k) - x(i)) * (y(j) - y(i));
    }

    /// Whether a polygon is drawn if it winds as those of this record do.
    bool isDrawn(uint32_t p) {
        return !record().backs || record().occluder->polygons[cluster_.first_polygon + p].double_sided;
    }

    /// The corners of a polygon, counter-clockwise on the screen; returns how many.
    int take(uint32_t p, uint8_t (&v)[4]) {
        const OccluderPolygon& polygon = record().occluder->polygons[cluster_.first_polygon + p];
        std::copy(polygon.vertex, polygon.vertex + 4, v);
        if (record().clockwise) std::swap(v[1], v[polygon.corners() - 1]);
        return polygon.corners();
    }

    /// A sliver's winding is uncertain; it is kept as it stands, for its sides join its neighbours'.
    bool isMade(uint8_t v0, uint8_t v1, uint8_t v2) { return areaOf(v0, v1, v2) >= -leastArea(v0, v1, v2); }

    /// A winding is certain if the area is greater than this.
    double leastArea(uint8_t i, uint8_t j, uint8_t k) {
        const auto side = [&](uint8_t a, uint8_t b) { return std::abs(x(b) - x(a)) + std::abs(y(b) - y(a)); };
        return 4.0 * (record().position_error + 0x1p-16) * (side(i, j) + side(j, k) + side(k, i));
    }

    SeamPolygon& add(int corners) {
        SIGHTLINE_DEBUG_ASSERT(corners == 3 || corners == 4);
        SeamPolygon& polygon = tiles_.polygons.emplace_back();
        polygon.drawn = drawn_;
        polygon.source = source_;
        polygon.corners = static_cast<uint8_t>(corners);
        return polygon;
    }

    bool finish(const double* px, const double* py, const double* pd) {
        SeamPolygon& polygon = tiles_.polygons.back();
        SIGHTLINE_DEBUG_ASSERT(polygon.drawn == drawn_);
        if (!makeRasterPolygon(px, py, pd, polygon.corners, record().position_error, record().depth_error, tiles_.width,
                               tiles_.height, polygon.raster)) {
            tiles_.polygons.pop_back();
            return false;
        }
        setEdgeKeys(polygon);
        return true;
    }

    bool addWhole(const uint8_t* v, int corners) {
        double px[4], py[4], pd[4];
        SeamPolygon& polygon = add(corners);
        for (int i = 0; i < corners; ++i) {
            polygon.vertex[i] = v[i];
            px[i] = x(v[i]);
            py[i] = y(v[i]);
            pd[i] = d(v[i]);
        }
        return finish(px, py, pd);
    }

    /// False if the triangles have to be added one by one: the quadrangle must surely be convex, and flat.
    bool addQuad(const uint8_t* v) {
        constexpr float kFlat = 1e-3f;
        const int corners[4][3] = {{0, 1, 2}, {0, 2, 3}, {0, 1, 3}, {1, 2, 3}};
        for (const auto& c : corners)  // false as well where a vertex has no image
            if (!(areaOf(v[c[0]], v[c[1]], v[c[2]]) > leastArea(v[c[0]], v[c[1]], v[c[2]]))) return false;
        if (!addWhole(v, 4)) return true;
        const RasterPolygon& raster = tiles_.polygons.back().raster;
        if (raster.depth_error <= kFlat * std::abs(raster.nearest)) return true;
        tiles_.polygons.pop_back();
        return false;
    }

    void addTriangle(uint8_t v0, uint8_t v1, uint8_t v2) {
        const uint8_t v[3] = {v0, v1, v2};
        const int before = std::isnan(x(v0)) + std::isnan(x(v1)) + std::isnan(x(v2));
        if (before == 3) return;
        if (before > 0) return addClipped(v);
        if (isMade(v0, v1, v2)) addWhole(v, 3);
    }

    void addClipped(const uint8_t* v) {
        ClippedPolygon clipped;
        if (record().object == ~0u || !record().clips ||
            !clipAtNear(tiles_.objects[record().object], *record().occluder, cluster_, v, 3, clipped))
            return;
        SIGHTLINE_DEBUG_ASSERT(clipped.count == 3 || clipped.count == 4);
        double area2 = 0;
        for (int i = 2; i < clipped.count; ++i)
            area2 += (clipped.x[i - 1] - clipped.x[0]) * (clipped.y[i] - clipped.y[0]) -
                     (clipped.x[i] - clipped.x[0]) * (clipped.y[i - 1] - clipped.y[0]);
        if (!(area2 > 0)) return;
        SeamPolygon& polygon = add(clipped.count);
        polygon.clipped = static_cast<uint32_t>(tiles_.clipped.size());
        for (int i = 0; i < clipped.count; ++i) polygon.open |= static_cast<uint8_t>((clipped.open[i] ? 1u : 0u) << i);
        if (finish(clipped.x, clipped.y, clipped.d)) tiles_.clipped.push_back(clipped);
    }

    DepthTiles& tiles_;
    const uint32_t drawn_;
    const OccluderCluster& cluster_;
    uint8_t source_ = 0;
};

/// Projects the vertices of a drawn cluster; those before the near guard get a NaN.
void projectDrawn(DepthTiles& tiles, uint32_t drawn) {
    DrawnCluster& record = tiles.drawn[drawn];
    if (record.first_vertex != DepthTiles::kNone) return;
    const OccluderCluster& cluster = record.occluder->clusters[record.cluster];
    const size_t first = tiles.vertex_count, count = cluster.vertex_count;
    tiles.vertex_count = first + count;
    if (tiles.px.size() < tiles.vertex_count)
        for (Array<double>* array : {&tiles.px, &tiles.py, &tiles.pd}) array->resize(2 * tiles.vertex_count);
    const Screen& object = tiles.objects[record.object];
    for (size_t i = 0; i < count; ++i) {
        const size_t at = size_t{cluster.first_vertex} + i;
        const glm::dvec4 v(record.occluder->x[at], record.occluder->y[at], record.occluder->z[at], 1.0);
        const double w = glm::dot(object.w, v);
        const bool drawn = glm::dot(object.near, v) >= object.near_guard && w > 0;
        tiles.px[first + i] = drawn ? glm::dot(object.x, v) / w : std::numeric_limits<double>::quiet_NaN();
        tiles.py[first + i] = glm::dot(object.y, v) / w;
        tiles.pd[first + i] = glm::dot(object.d, v) / w;
    }
    record.first_vertex = static_cast<uint32_t>(first);
}

}  // namespace

void seamPolygon(DepthTiles& tiles, uint32_t drawn, uint32_t polygon, uint32_t& first, uint32_t& count) {
    SIGHTLINE_DEBUG_ASSERT(drawn < tiles.drawn.size());
    projectDrawn(tiles, drawn);
    DrawnCluster& record = tiles.drawn[drawn];
    const uint32_t own = record.occluder->clusters[record.cluster].polygon_count;
    first = count = 0;
    if (polygon >= own) return;  // of its ring: a neighbour's, who names it too
    uint32_t& made = record.made;
    if (made == DepthTiles::kNone) {
        made = static_cast<uint32_t>(tiles.made.size());
        tiles.made.resize(size_t{made} + own, DepthTiles::kNone);
    }
    uint32_t& slot = tiles.made[made + polygon];
    if (slot == DepthTiles::kNone) {
        const size_t before = tiles.polygons.size();
        Maker(tiles, drawn).make(polygon);
        SIGHTLINE_DEBUG_ASSERT(tiles.polygons.size() >= before && tiles.polygons.size() - before <= 2);
        slot = static_cast<uint32_t>(4 * before + (tiles.polygons.size() - before));
    }
    first = slot / 4;
    count = slot % 4;
    SIGHTLINE_DEBUG_ASSERT(size_t{first} + count <= tiles.polygons.size());
}

uint32_t seamPlane(DepthTiles& tiles, uint32_t polygon) {
    SIGHTLINE_DEBUG_ASSERT(polygon < tiles.polygons.size());
    SeamPolygon& of = tiles.polygons[polygon];
    if (of.plane != DepthTiles::kNone) return of.plane;
    const RasterPolygon& raster = of.raster;
    BufferPlane plane{static_cast<double>(raster.farthest), 0, 0, raster.farthest, 0};  // it lies no farther
    if (raster.planar) {
        const double size = std::max(std::abs(raster.farthest), std::abs(raster.nearest));
        const double error = static_cast<double>(raster.depth_error) + 0x1p-40 * size + 0x1p-48 * std::abs(raster.d0);
        double x[ClippedPolygon::kMaxCorners], y[ClippedPolygon::kMaxCorners], d[ClippedPolygon::kMaxCorners];
        for (int i = 0; i < of.corners; ++i) {
            const size_t at = size_t{tiles.drawn[of.drawn].first_vertex} + of.vertex[i];
            const bool whole = of.clipped == SeamPolygon::kWhole;
            x[i] = whole ? tiles.px[at] : tiles.clipped[of.clipped].x[i];
            y[i] = whole ? tiles.py[at] : tiles.clipped[of.clipped].y[i];
            d[i] = whole ? tiles.pd[at] : tiles.clipped[of.clipped].d[i];
        }
        of.plane = findPlane(tiles, x, y, d, of.corners, error, 0, 24);
        if (of.plane != DepthTiles::kNone) return of.plane;
        plane = {raster.d0, raster.dx, raster.dy, raster.farthest, static_cast<float>(error + kFlatEnough * size)};
    }
    of.plane = static_cast<uint32_t>(tiles.planes.size());
    tiles.planes.push_back(plane);
    return of.plane;
}

uint32_t seamBoxes(DepthTiles& tiles, uint32_t drawn, uint32_t& count) {
    SIGHTLINE_DEBUG_ASSERT(drawn < tiles.drawn.size());
    projectDrawn(tiles, drawn);
    const DrawnCluster& record = tiles.drawn[drawn];
    count = record.occluder->clusters[record.cluster].polygon_count;
    if (record.boxes != DepthTiles::kNone) return record.boxes;
    const size_t at = tiles.boxes.size();
    tiles.boxes.resize(at + (count + 15) / 16 * size_t{64});
    Maker maker(tiles, drawn);
    const double* px = tiles.px.data() + record.first_vertex;
    const double* py = tiles.py.data() + record.first_vertex;
    for (uint32_t p = 0; p < (count + 15) / 16 * 16; ++p) {
        float box[4] = {1.0f, 1.0f, 0.0f, 0.0f};
        if (p < count) maker.bound(p, px, py, box);
        float* to = tiles.boxes.data() + at + p / 16 * size_t{64} + p % 16;
        for (size_t i = 0; i < 4; ++i) to[16 * i] = box[i];
    }
    return tiles.drawn[drawn].boxes = static_cast<uint32_t>(at);
}

}  // namespace sightline
