// Makes the polygons of a drawn cluster for the seams that it left: projected once more, wound, cut at the near plane.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "sightline/raster/near_clip.h"
#include "sightline/raster/seam.h"

namespace sightline {
namespace {

/// A drawn cluster's polygons on their way to DepthTiles::polygons.
class Maker {
public:
    Maker(DepthTiles& tiles, uint32_t drawn)
        : tiles_(tiles), drawn_(drawn), cluster_(record().occluder->clusters[record().cluster]) {}

    void make() {
        record().first_polygon = static_cast<uint32_t>(tiles_.polygons.size());
        const Occluder& occluder = *record().occluder;
        for (uint32_t p = 0; p < cluster_.polygon_count; ++p) {
            const OccluderPolygon& polygon = occluder.polygons[cluster_.first_polygon + p];
            source_ = static_cast<uint8_t>(p);
            uint8_t v[4];
            std::copy(polygon.vertex, polygon.vertex + 4, v);
            // Counter-clockwise on the screen.
            if (record().clockwise) std::swap(v[1], v[polygon.corners() - 1]);
            if (polygon.corners() == 4 && addQuad(v)) continue;
            addTriangle(v[0], v[1], v[2]);
            if (polygon.corners() == 4) addTriangle(v[0], v[2], v[3]);
        }
        record().polygon_count = static_cast<uint32_t>(tiles_.polygons.size()) - record().first_polygon;
    }

private:
    DrawnCluster& record() { return tiles_.drawn[drawn_]; }
    double x(uint8_t v) { return tiles_.px[size_t{record().first_vertex} + v]; }
    double y(uint8_t v) { return tiles_.py[size_t{record().first_vertex} + v]; }
    double d(uint8_t v) { return tiles_.pd[size_t{record().first_vertex} + v]; }
    double areaOf(uint8_t i, uint8_t j, uint8_t k) {
        return (x(j) - x(i)) * (y(k) - y(i)) - (x(k) - x(i)) * (y(j) - y(i));
    }

    /// A winding is certain if the area is greater than this.
    double leastArea(uint8_t i, uint8_t j, uint8_t k) {
        const auto side = [&](uint8_t a, uint8_t b) { return std::abs(x(b) - x(a)) + std::abs(y(b) - y(a)); };
        return 4.0 * (record().position_error + 0x1p-16) * (side(i, j) + side(j, k) + side(k, i));
    }

    SeamPolygon& add(int corners) {
        SeamPolygon& polygon = tiles_.polygons.emplace_back();
        polygon.drawn = drawn_;
        polygon.source = source_;
        polygon.corners = static_cast<uint8_t>(corners);
        return polygon;
    }

    bool finish(const double* px, const double* py, const double* pd) {
        SeamPolygon& polygon = tiles_.polygons.back();
        if (makeRasterPolygon(px, py, pd, polygon.corners, record().position_error, record().depth_error, tiles_.width,
                              tiles_.height, polygon.raster))
            return true;
        tiles_.polygons.pop_back();
        return false;
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
        // A sliver's winding is uncertain; it is kept as it stands, for its sides join its neighbours'.
        if (areaOf(v0, v1, v2) >= -leastArea(v0, v1, v2)) addWhole(v, 3);
    }

    void addClipped(const uint8_t* v) {
        ClippedPolygon clipped;
        if (record().object == ~0u || !record().clips ||
            !clipAtNear(tiles_.objects[record().object], *record().occluder, cluster_, v, 3, clipped))
            return;
        double area2 = 0;
        for (int i = 2; i < clipped.count; ++i)
            area2 += (clipped.x[i - 1] - clipped.x[0]) * (clipped.y[i] - clipped.y[0]) -
                     (clipped.x[i] - clipped.x[0]) * (clipped.y[i - 1] - clipped.y[0]);
        if (!(area2 > 0)) return;
        SeamPolygon& polygon = add(clipped.count);
        polygon.clipped = static_cast<uint32_t>(tiles_.clipped.size());
        if (finish(clipped.x, clipped.y, clipped.d)) tiles_.clipped.push_back(clipped);
    }

    DepthTiles& tiles_;
    const uint32_t drawn_;
    const OccluderCluster& cluster_;
    uint8_t source_ = 0;
};

}  // namespace

void seamPolygons(DepthTiles& tiles, const SeamEntry& entry, uint32_t& first, uint32_t& count) {
    if (tiles.drawn[entry.drawn()].first_polygon == ~0u) Maker(tiles, entry.drawn()).make();
    const DrawnCluster& drawn = tiles.drawn[entry.drawn()];
    first = drawn.first_polygon;
    count = drawn.polygon_count;
    if (entry.polygon() == SeamEntry::kAllPolygons) return;
    // One polygon of the cluster: at most two, for a quadrangle may have been taken apart.
    const uint32_t end = first + count;
    while (first < end && tiles.polygons[first].source < entry.polygon()) ++first;
    uint32_t last = first;
    while (last < end && tiles.polygons[last].source == entry.polygon()) ++last;
    count = last - first;
}

}  // namespace sightline
