// Covers a pixel by the triangles that share it, joined where their edges are identical in world space.
// SPDX-License-Identifier: MIT
//
// The argument. Let F be a set of triangles, w(p) the number of those with counter-clockwise images that hold the
// image point p less the clockwise ones. Crossing an edge changes w unless another triangle of F has the same edge
// the other way round. So if every edge of F that meets the pixel is paired off like that, w is the same all over
// the pixel; and if it is 1 or more at one point, each ray through the pixel meets a counter-clockwise, that is a
// front-facing triangle of F, no farther than the farthest point of F in the pixel. Which edges meet the pixel, and
// which triangles hold the point, is decided with a margin above the rounding; which edges are the same, exactly.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

#include "sightline/raster/seam.h"
#include "sightline/raster/union.h"

namespace sightline {
namespace {

constexpr int kMaxTriangles = 192;   // work cap: a pixel with more of them stays open
constexpr double kMargin = 0x1p-15;  // [pixels]: above all rounding of edge functions here

struct Point {
    float x, y, z;  // no initial values: a resolver is made for each pixel
    bool operator==(const Point&) const = default;
};

/// A polygon as the pixel sees it.
struct Piece {
    double x[4], y[4];
    const SeamPolygon* polygon;
    int count;
    double error;  ///< bound on the error of sideAt()
    int group;
    bool alive;
};

/// A side that meets the pixel.
struct Side {
    uint64_t key;  ///< the same for both directions
    int piece;
    int side;
    bool forward;
};

uint64_t hashPoint(const Point& p, uint64_t seed) {
    uint32_t bits[3];
    std::memcpy(bits, &p, sizeof bits);
    uint64_t h = seed;
    for (uint32_t b : bits) h = (h ^ b) * 0x9e3779b97f4a7c15ull, h ^= h >> 29;
    return h;
}

bool less(const Point& a, const Point& b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

Point meshPoint(const DrawnCluster& drawn, uint8_t vertex) {
    const Occluder& o = *drawn.occluder;
    const size_t at = size_t{o.clusters[drawn.cluster].first_vertex} + vertex;
    return {o.x[at], o.y[at], o.z[at]};
}

/// The mesh edge that a side lies on.
void edgeOf(const DepthTiles& tiles, const SeamPolygon& polygon, int side, Point& from, Point& to) {
    const DrawnCluster& drawn = tiles.drawn[polygon.drawn];
    if (polygon.clipped != SeamPolygon::kWhole) {
        const ClippedPolygon& clipped = tiles.clipped[polygon.clipped];
        from = meshPoint(drawn, clipped.from[side]);
        to = meshPoint(drawn, clipped.to[side]);
        return;
    }
    from = meshPoint(drawn, polygon.vertex[side]);
    to = meshPoint(drawn, polygon.vertex[side + 1 < polygon.corners ? side + 1 : 0]);
}

void loadPiece(const DepthTiles& tiles, const SeamPolygon& polygon, Piece& piece) {
    const DrawnCluster& drawn = tiles.drawn[polygon.drawn];
    piece.polygon = &polygon;
    piece.error = drawn.position_error + kMargin;
    piece.alive = true;
    piece.count = polygon.corners;
    for (int i = 0; i < piece.count; ++i) {
        if (polygon.clipped != SeamPolygon::kWhole) {
            piece.x[i] = tiles.clipped[polygon.clipped].x[i];
            piece.y[i] = tiles.clipped[polygon.clipped].y[i];
        } else {
            const size_t at = size_t{drawn.first_vertex} + polygon.vertex[i];
            piece.x[i] = tiles.px[at];
            piece.y[i] = tiles.py[at];
        }
    }
}

/// The edge function of side i at a point, scaled as in RasterPolygon; NaN for a side too short for a direction.
double sideAt(const Piece& p, int i, double x, double y) {
    const int j = i + 1 < p.count ? i + 1 : 0;
    const double a = p.y[i] - p.y[j], b = p.x[j] - p.x[i];
    const double length = std::abs(a) + std::abs(b);
    if (length < 0x1p-10) return std::numeric_limits<double>::quiet_NaN();
    const bool first = std::abs(p.x[i] - x) + std::abs(p.y[i] - y) <= std::abs(p.x[j] - x) + std::abs(p.y[j] - y);
    return (a * (x - (first ? p.x[i] : p.x[j])) + b * (y - (first ? p.y[i] : p.y[j]))) / length;
}

/// False only if side i surely misses the pixel whose centre is given.
bool sideMeets(const Piece& p, int i, double x, double y) {
    const int j = i + 1 < p.count ? i + 1 : 0;
    const double reach = 0.5 + p.error;
    if (std::max(p.x[i], p.x[j]) < x - reach || std::min(p.x[i], p.x[j]) > x + reach) return false;
    if (std::max(p.y[i], p.y[j]) < y - reach || std::min(p.y[i], p.y[j]) > y + reach) return false;
    const double e = sideAt(p, i, x, y);
    return !(std::abs(e) > reach);
}

/// +1 or -1 if the point is surely inside a counter-clockwise or a clockwise piece, 0 if surely outside;
/// kUnsure if rounding could decide.
constexpr int kUnsure = 9;
int windingAt(const Piece& p, double x, double y) {
    bool positive = false, negative = false, unsure = false;
    double x_min = p.x[0], x_max = p.x[0], y_min = p.y[0], y_max = p.y[0];
    for (int i = 0; i < p.count; ++i) {
        x_min = std::min(x_min, p.x[i]);
        x_max = std::max(x_max, p.x[i]);
        y_min = std::min(y_min, p.y[i]);
        y_max = std::max(y_max, p.y[i]);
        const double e = sideAt(p, i, x, y);
        if (e > 2.0 * p.error) positive = true;
        else if (e < -2.0 * p.error) negative = true;
        else unsure = true;
    }
    const double m = 2.0 * p.error;
    if (x < x_min - m || x > x_max + m || y < y_min - m || y > y_max + m) return 0;
    if (positive && negative) return 0;
    if (unsure) return kUnsure;
    return positive ? 1 : -1;
}

bool sameTransform(const DrawnCluster& a, const DrawnCluster& b) {
    return a.transform == b.transform ||
           (a.transform_hash == b.transform_hash && std::memcmp(a.transform, b.transform, sizeof *a.transform) == 0);
}

/// Whether two sides are the same edge run through in opposite directions: exactly, in world space.
bool areOpposite(const DepthTiles& tiles, const SeamPolygon& a, int side_a, const SeamPolygon& b, int side_b) {
    Point from_a, to_a, from_b, to_b;
    edgeOf(tiles, a, side_a, from_a, to_a);
    edgeOf(tiles, b, side_b, from_b, to_b);
    return from_a == to_b && to_a == from_b && sameTransform(tiles.drawn[a.drawn], tiles.drawn[b.drawn]);
}

struct Resolver {
    Piece pieces[kMaxTriangles];
    Side sides[4 * kMaxTriangles];
    int partner[4 * kMaxTriangles];
    int piece_count = 0, side_count = 0;

    /// Lists the sides that meet the pixel. A piece with an open one there cannot help.
    void collectSides(double x, double y) {
        side_count = 0;
        for (int p = 0; p < piece_count; ++p) {
            Piece& piece = pieces[p];
            if (!piece.alive) continue;
            const int first = side_count;
            for (int i = 0; i < piece.count; ++i) {
                if (!sideMeets(piece, i, x, y)) continue;
                if (piece.polygon->open >> i & 1) {
                    piece.alive = false;
                    break;
                }
                sides[side_count++] = {piece.polygon->side_key[i], p, i, (piece.polygon->forward >> i & 1) != 0};
            }
            if (!piece.alive) side_count = first;
        }
        std::sort(sides, sides + side_count, [](const Side& a, const Side& b) {
            return a.key != b.key ? a.key < b.key : a.piece != b.piece ? a.piece < b.piece : a.side < b.side;
        });
    }

    /// Pairs each living side with an opposite one, one to one; pieces left with a single side die, and the
    /// pairing is made again until none does.
    void pairSides(const DepthTiles& tiles) {
        for (bool again = true; again;) {
            again = false;
            for (int i = 0; i < side_count; ++i) partner[i] = -1;
            for (int i = 0; i < side_count; ++i) {
                if (partner[i] >= 0 || !pieces[sides[i].piece].alive) continue;
                for (int j = i + 1; j < side_count && sides[j].key == sides[i].key; ++j) {
                    if (partner[j] >= 0 || !pieces[sides[j].piece].alive) continue;
                    if (sides[i].forward == sides[j].forward ||
                        !areOpposite(tiles, *pieces[sides[i].piece].polygon, sides[i].side,
                                     *pieces[sides[j].piece].polygon, sides[j].side))
                        continue;
                    partner[i] = j;
                    partner[j] = i;
                    break;
                }
                if (partner[i] < 0) {
                    pieces[sides[i].piece].alive = false;
                    again = true;
                }
            }
        }
    }

    int rootOf(int p) {
        while (pieces[p].group != p) p = pieces[p].group = pieces[pieces[p].group].group;
        return p;
    }

    void joinGroups() {
        for (int p = 0; p < piece_count; ++p) pieces[p].group = p;
        for (int i = 0; i < side_count; ++i)
            if (pieces[sides[i].piece].alive && partner[i] > i)
                pieces[rootOf(sides[i].piece)].group = rootOf(sides[partner[i]].piece);
    }

    /// Whether a group's winding number is 1 or more at a point of the pixel.
    bool holdsPixel(int group, double x, double y) {
        static constexpr double kPlaces[5][2] = {{0, 0}, {0.23, 0.31}, {-0.29, 0.19}, {0.37, -0.27}, {-0.17, -0.33}};
        for (const auto& place : kPlaces) {
            int winding = 0;
            bool sure = true;
            for (int p = 0; p < piece_count && sure; ++p) {
                if (!pieces[p].alive || rootOf(p) != group) continue;
                const int w = windingAt(pieces[p], x + place[0], y + place[1]);
                sure = w != kUnsure;
                winding += w;
            }
            if (sure) return winding >= 1;
        }
        return false;
    }

    /// No point of the piece inside the pixel is farther.
    static double farthestIn(const Piece& piece, double x, double y) {
        const RasterPolygon& polygon = piece.polygon->raster;
        if (!polygon.planar) return polygon.farthest;
        const double tilt = std::abs(polygon.dx) + std::abs(polygon.dy);
        const double d = polygon.d0 + polygon.dx * x + polygon.dy * y;
        return std::max<double>(polygon.farthest, d - 0.5 * tilt - polygon.depth_error - std::abs(d) * 0x1p-40);
    }

    /// The depth at which the pieces' union leaves nothing of the pixel; -infinity if it does leave something. Takes
    /// in what no shared side joins: T-junctions, and surfaces that overlap.
    double resolveByUnion(const DepthTiles& tiles, double x, double y) const {
        constexpr int kMaxPieces = 24;  // work cap
        UnionPiece found[kMaxPieces];
        const SeamPolygon* source[kMaxPieces];
        int count = 0;
        for (int p = 0; p < piece_count && count < kMaxPieces; ++p) {
            const SeamPolygon& polygon = *pieces[p].polygon;
            if (!polygon.raster.complete) continue;
            source[count] = &polygon;
            found[count++] = {&polygon.raster, 0, farthestIn(pieces[p], x, y)};
        }
        for (int i = 0; i < count; ++i)
            for (int j = i + 1; j < count; ++j) {
                int side_i, side_j;
                if (!findSharedSide(tiles, *source[i], *source[j], side_i, side_j)) continue;
                found[i].shared |= 1u << side_i;
                found[j].shared |= 1u << side_j;
            }
        std::sort(found, found + count,
                  [](const UnionPiece& a, const UnionPiece& b) { return a.farthest > b.farthest; });
        return subtractFromPixel(x, y, found, count);
    }

    /// The best depth of any group that covers the pixel; -infinity if none does.
    double resolve(const DepthTiles& tiles, double x, double y) {
        collectSides(x, y);
        pairSides(tiles);
        joinGroups();
        double best = -std::numeric_limits<double>::infinity();
        for (int g = 0; g < piece_count; ++g) {
            if (!pieces[g].alive || rootOf(g) != g || !holdsPixel(g, x, y)) continue;
            double farthest = std::numeric_limits<double>::infinity();
            for (int p = 0; p < piece_count; ++p)
                if (pieces[p].alive && rootOf(p) == g) farthest = std::min(farthest, farthestIn(pieces[p], x, y));
            best = std::max(best, farthest);
        }
        return best;
    }
};

/// Rounds to float, away from the eye.
float roundFarther(double nearness) {
    const float f = static_cast<float>(nearness);
    return f > nearness ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

/// False only if the polygon surely misses the pixel whose centre is given.
bool mayTouch(const RasterPolygon& polygon, double x, double y) {
    if (x + 0.5 < polygon.x0 || x - 0.5 > polygon.x1 + 1.0 || y + 0.5 < polygon.y0 || y - 0.5 > polygon.y1 + 1.0)
        return false;
    for (int e = 0; e < polygon.edges; ++e)
        if (polygon.edge[e].at(x, y) < -0.5 - static_cast<double>(polygon.slack)) return false;
    return true;
}

}  // namespace

void setSideKeys(const DepthTiles& tiles, SeamPolygon& polygon) {
    if (polygon.keyed) return;
    polygon.keyed = true;
    if (polygon.clipped != SeamPolygon::kWhole)
        for (int i = 0; i < polygon.corners; ++i)
            if (tiles.clipped[polygon.clipped].open[i]) polygon.open |= static_cast<uint8_t>(1u << i);
    for (int i = 0; i < polygon.corners; ++i) {
        if (polygon.open >> i & 1) continue;
        Point from, to;
        edgeOf(tiles, polygon, i, from, to);
        const bool forward = less(from, to);
        if (forward) polygon.forward |= static_cast<uint8_t>(1u << i);
        else std::swap(from, to);
        polygon.side_key[i] = hashPoint(to, hashPoint(from, tiles.drawn[polygon.drawn].transform_hash));
        polygon.key_bits |= uint64_t{1} << (polygon.side_key[i] & 63);
    }
}

bool findSharedSide(const DepthTiles& tiles, const SeamPolygon& a, const SeamPolygon& b, int& side_a, int& side_b) {
    if (!(a.key_bits & b.key_bits)) return false;
    for (int i = 0; i < a.corners; ++i) {
        if (a.open >> i & 1) continue;
        for (int j = 0; j < b.corners; ++j) {
            if (a.side_key[i] != b.side_key[j] || (b.open >> j & 1) || (a.forward >> i & 1) == (b.forward >> j & 1))
                continue;
            if (!areOpposite(tiles, a, i, b, j)) continue;
            side_a = i;
            side_b = j;
            return true;
        }
    }
    return false;
}

bool resolveSeam(DepthTiles& tiles, uint32_t tile, int bit, float wanted) {
    const uint64_t pixel = uint64_t{1} << bit;
    float claims[64];
    readClaims(tiles, tile, claims);
    const float before = claims[bit];
    const bool covered = before > DepthTiles::kOpen;
    if (tiles.seams[tile] == DepthTiles::kNone || !(tiles.seam_mask[tile] & ~tiles.tried[tile] & pixel)) return covered;
    tiles.tried[tile] |= pixel;
    ++tiles.seam_pixels;
    const double x = 8.0 * (tile % tiles.stride) + (bit & 7) + 0.5;
    const double y = 8.0 * (tile / tiles.stride) + (bit >> 3) + 0.5;
    uint32_t found[kMaxTriangles];  // not yet their places: making the next entry's polygons may move them all
    int found_count = 0;
    for (uint32_t at = tiles.seams[tile]; at != DepthTiles::kNone; at = tiles.entries[at].next) {
        const SeamEntry entry = tiles.entries[at];
        if (!(entry.mask & pixel)) continue;
        uint32_t first, count;
        seamPolygons(tiles, entry, first, count);
        for (uint32_t i = first; i < first + count; ++i) {
            const RasterPolygon& raster = tiles.polygons[i].raster;
            if (!mayTouch(raster, x, y) || raster.nearest <= before) continue;
            if (found_count == kMaxTriangles) return covered;
            found[found_count++] = i;
        }
    }
    if (found_count < 2) return covered;
    Resolver resolver;
    for (; resolver.piece_count < found_count; ++resolver.piece_count) {
        SeamPolygon& polygon = tiles.polygons[found[resolver.piece_count]];
        setSideKeys(tiles, polygon);
        loadPiece(tiles, polygon, resolver.pieces[resolver.piece_count]);
    }
    double nearness = resolver.resolve(tiles, x, y);
    if (!(nearness > wanted)) nearness = std::max(nearness, resolver.resolveByUnion(tiles, x, y));
    if (!(nearness > before)) return covered;
    claims[bit] = roundFarther(nearness);
    raiseClaims(tiles, tile, pixel, claims);
    return true;
}

}  // namespace sightline
