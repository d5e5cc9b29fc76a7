// Covers a pixel by the polygons that share it: by their union, or joined where their edges are identical.
// SPDX-License-Identifier: MIT
//
// The union is subtracted from the pixel exactly (union.cpp); what has no certain winding does not enter it.
// The argument for joining. Let F be a set of triangles, w(p) the number of those with counter-clockwise images that
// hold the image point p less the clockwise ones. Crossing an edge changes w unless another triangle of F has the same edge
// the other way round. So if every edge of F that meets the pixel is paired off like that, w is the same all over
// the pixel; and if it is 1 or more at one point, each ray through the pixel meets a counter-clockwise, that is a
// front-facing triangle of F, no farther than the farthest point of F in the pixel. Which edges meet the pixel, and
// which triangles hold the point, is decided with a margin above the rounding; which edges are the same, exactly.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/ablate.h"
#include "sightline/base/assert.h"
#include "sightline/buffer/covers.h"
#include "sightline/buffer/seam/seam.h"
#include "sightline/buffer/seam/union.h"

namespace sightline {
namespace {

constexpr int kMaxPolygons = 192;    // work cap: a pixel with more of them stays open
constexpr double kMargin = 0x1p-15;  // [pixels]: above all rounding of edge functions here

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

void loadPiece(const DepthTiles& tiles, const SeamPolygon& polygon, Piece& piece) {
    SIGHTLINE_DEBUG_ASSERT(polygon.drawn < tiles.drawn.size());
    SIGHTLINE_DEBUG_ASSERT(polygon.corners == 3 || polygon.corners == 4);
    SIGHTLINE_DEBUG_ASSERT(polygon.clipped == SeamPolygon::kWhole || polygon.clipped < tiles.clipped.size());
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
            SIGHTLINE_DEBUG_ASSERT(at < tiles.vertex_count);
            piece.x[i] = tiles.px[at];
            piece.y[i] = tiles.py[at];
        }
    }
}

/// The edge function of side i at a point, scaled as in RasterPolygon; NaN for a side too short for a direction.
double sideAt(const Piece& p, int i, double x, double y) {
    SIGHTLINE_DEBUG_ASSERT(i >= 0 && i < p.count);
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

/// No point of the polygon inside the pixel, or less than the gap beside it, is farther.
double farthestIn(const RasterPolygon& polygon, double x, double y, double gap = 0) {
    if (!polygon.planar) return polygon.farthest;
    const double tilt = std::abs(polygon.dx) + std::abs(polygon.dy);
    const double d = polygon.d0 + polygon.dx * x + polygon.dy * y;
    return std::max<double>(polygon.farthest, d - (0.5 + gap) * tilt - polygon.depth_error - std::abs(d) * 0x1p-40);
}

/// Joins pieces along identical edges.
struct Joiner {
    Piece pieces[kMaxPolygons];
    Side sides[4 * kMaxPolygons];
    int partner[4 * kMaxPolygons];
    int piece_count = 0, side_count = 0;
    int best_group = -1;  ///< the nearest that covers the pixel

    /// Lists the sides that meet the pixel. A piece with an open one there cannot help.
    void collectSides(double x, double y) {
        SIGHTLINE_DEBUG_ASSERT(piece_count >= 0 && piece_count <= kMaxPolygons);
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
                SIGHTLINE_DEBUG_ASSERT(side_count < 4 * kMaxPolygons);
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
        SIGHTLINE_DEBUG_ASSERT(p >= 0 && p < piece_count);
        while (pieces[p].group != p) p = pieces[p].group = pieces[pieces[p].group].group;
        return p;
    }

    bool isIn(int p, int group) { return pieces[p].alive && rootOf(p) == group; }

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
                if (!isIn(p, group)) continue;
                const int w = windingAt(pieces[p], x + place[0], y + place[1]);
                sure = w != kUnsure;
                winding += w;
            }
            if (sure) return winding >= 1;
        }
        return false;
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
                if (isIn(p, g)) farthest = std::min(farthest, farthestIn(pieces[p].polygon->raster, x, y));
            if (farthest > best) best_group = g;
            best = std::max(best, farthest);
        }
        return best;
    }
};

/// Rounds to float, away from the eye.
float roundFarther(double nearness) {
    SIGHTLINE_DEBUG_ASSERT(!std::isnan(nearness));
    const float f = static_cast<float>(nearness);
    return f > nearness ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

/// False only if the polygon surely misses the pixel whose centre is given, and what lies less than the gap beside it.
bool mayTouch(const RasterPolygon& polygon, double x, double y, double gap) {
    const double reach = 0.5 + gap;
    if (x + reach < polygon.x0 || x - reach > polygon.x1 + 1.0 || y + reach < polygon.y0 ||
        y - reach > polygon.y1 + 1.0)
        return false;
    for (int e = 0; e < polygon.edges; ++e)
        if (polygon.edge[e].at(x, y) < -reach - static_cast<double>(polygon.slack)) return false;
    return true;
}

/// Which corners of a pixel a polygon may hold, a bit each: those that do not surely lie the gap or more outside.
uint32_t cornersHeld(const RasterPolygon& polygon, double x, double y, double gap) {
    uint32_t held = 15;
    for (int e = 0; e < polygon.edges; ++e) {
        const EdgeFunction& edge = polygon.edge[e];
        const double center = edge.at(x, y) + static_cast<double>(polygon.slack) + gap;
        const double across = 0.5 * edge.a, along = 0.5 * edge.b;
        held &= static_cast<uint32_t>(center - across - along >= 0) |
                static_cast<uint32_t>(center + across - along >= 0) << 1 |
                static_cast<uint32_t>(center - across + along >= 0) << 2 |
                static_cast<uint32_t>(center + across + along >= 0) << 3;
    }
    return held;
}

/// What the corners of a pixel tell.
enum class Corners {
    kOpenNow,  ///< one is open to the nearness wanted
    kOpen,     ///< one is open to whatever the pixel does not hide yet
    kHeld,
};

/// A pixel that polygons share.
class PixelSeam {
public:
    /// @param before  what the pixel claims already
    PixelSeam(DepthTiles& tiles, uint32_t tile, int bit, float before)
        : tiles_(tiles),
          tile_(tile),
          pixel_(uint64_t{1} << bit),
          x_(8.0 * (tile % tiles.stride) + (bit & 7) + 0.5),
          y_(8.0 * (tile / tiles.stride) + (bit >> 3) + 0.5),
          before_(before) {}

    /// Finds the polygons that may lie in front of what the pixel claims.
    Corners gather(float wanted) {
        const float x = static_cast<float>(x_), y = static_cast<float>(y_), reach = tiles_.gap > 0 ? 0.75f : 0.5f;
        uint32_t held = 0, held_now = wanted < std::numeric_limits<float>::infinity() ? 0 : 15;
        forSeamEntries(tiles_, tile_, [&](const SeamEntry& entry) {
            if (!(entry.mask & pixel_) || !(entry.nearest > before_)) return;
            forSeamPolygons(tiles_, entry, {x - reach, y - reach, x + reach, y + reach}, [&](uint32_t i) {
                const RasterPolygon& raster = tiles_.polygons[i].raster;
                if (!(raster.nearest > before_) || !mayTouch(raster, x_, y_, tiles_.gap)) return;
                const uint32_t corners = cornersHeld(raster, x_, y_, tiles_.gap);
                held |= corners;
                if (raster.nearest > wanted) held_now |= corners;
                if (count_ < kMaxPolygons) {
                    found_[count_] = i;
                    lone_[count_] = entry.polygon() != SeamEntry::kAllPolygons;
                }
                ++count_;
            });
        });
        return count_ > kMaxPolygons || held != 15 ? Corners::kOpen
               : held_now != 15                    ? Corners::kOpenNow
                                                   : Corners::kHeld;
    }

    /// The nearness of what covers the pixel; -infinity if it is open.
    double resolve() {
        SIGHTLINE_DEBUG_ASSERT(count_ > 0 && count_ <= kMaxPolygons);
        if (detail::kAblate.unite) return joinAll();
        bool all = true;
        const double nearness = uniteAll(all);
        return all || detail::kAblate.joiner ? nearness : std::max(nearness, joinAll());
    }

private:
    /// @param all  cleared if some polygon could not enter the union, or the work was cut short
    double uniteAll(bool& all) {
        constexpr int kMost = 32;  // work cap: of more polygons the nearest are united
        struct Ranked {
            double farthest;
            int place;  ///< decides between equals
            const SeamPolygon* polygon;
        } ranked[kMaxPolygons];
        int count = 0;
        for (int i = 0; i < count_; ++i) {
            const SeamPolygon& polygon = tiles_.polygons[found_[i]];
            const double farthest = farthestIn(polygon.raster, x_, y_, tiles_.gap);
            all &= polygon.raster.complete && polygon.clipped == SeamPolygon::kWhole;
            if (polygon.raster.complete && farthest > before_) ranked[count++] = {farthest, i, &polygon};
        }
        std::sort(ranked, ranked + count, [](const Ranked& a, const Ranked& b) {
            return a.farthest != b.farthest ? a.farthest > b.farthest : a.place < b.place;
        });
        if (count > kMost) {
            count = kMost;
            all = false;
        }
        UnionPiece pieces[kMost];
        for (int i = 0; i < count; ++i) pieces[i] = {&ranked[i].polygon->raster, 0, ranked[i].farthest};
        for (int i = 0; i < count; ++i)
            for (int j = i + 1; j < count; ++j) {
                int side_i, side_j;
                if (!findSharedSide(tiles_, *ranked[i].polygon, *ranked[j].polygon, side_i, side_j)) continue;
                SIGHTLINE_DEBUG_ASSERT(side_i >= 0 && side_i < 4 && side_j >= 0 && side_j < 4);
                pieces[i].shared |= 1u << side_i;
                pieces[j].shared |= 1u << side_j;
            }
        GapPolygon near[kMost];
        if (tiles_.gap > 0)
            for (int i = 0; i < count; ++i) near[i] = nearPixel(*ranked[i].polygon);
        const PixelUnion united = subtractFromPixel(x_, y_, pieces, count, tiles_.gap, near);
        SIGHTLINE_DEBUG_ASSERT(united.used >= 0 && united.used <= count && united.last < count);
        all &= united.whole;
        // What one polygon alone covers was covered when it was drawn: lookAtSeams() counts on that.
        if (united.used == 1 && tiles_.gap == 0 && united.nearness > before_ && lone_[ranked[united.last].place])
            return -std::numeric_limits<double>::infinity();
        tiles_.closed_gaps += united.bridged;
        if (united.nearness > -std::numeric_limits<double>::infinity())
            noteCoverBy(count, [&](int i) { return united.took >> i & 1 ? ranked[i].place : -1; });
        return united.nearness;
    }

    GapPolygon nearPixel(const SeamPolygon& polygon) const {
        Piece piece;
        loadPiece(tiles_, polygon, piece);
        GapPolygon out;
        out.count = piece.count;
        out.error = polygon.raster.error;
        for (int i = 0; i < piece.count; ++i) {
            out.x[i] = piece.x[i] - x_;
            out.y[i] = piece.y[i] - y_;
        }
        return out;
    }

    double joinAll() const {
        Joiner joiner;
        for (; joiner.piece_count < count_; ++joiner.piece_count) {
            SeamPolygon& polygon = tiles_.polygons[found_[joiner.piece_count]];
            setSideKeys(tiles_, polygon);
            loadPiece(tiles_, polygon, joiner.pieces[joiner.piece_count]);
        }
        const double nearness = joiner.resolve(tiles_, x_, y_);
        if (joiner.best_group >= 0)
            noteCoverBy(count_, [&](int p) { return joiner.isIn(p, joiner.best_group) ? p : -1; });
        return nearness;
    }

    /// Notes that some of the polygons cover the pixel between them. Where gaps are closed they do not.
    /// @param placeOf  of one of them its place in found_, or -1
    template <class PlaceOf>
    void noteCoverBy(int count, PlaceOf placeOf) const {
        if (tiles_.gap > 0) return;
        PlaneSet planes;
        for (int i = 0; i < count; ++i)
            if (const int place = placeOf(i); place >= 0 && !planes.add(seamPlane(tiles_, found_[place]))) return;
        noteCover(tiles_, tile_, pixel_, planes);
    }

    DepthTiles& tiles_;
    const uint32_t tile_;
    const uint64_t pixel_;
    const double x_, y_;
    const float before_;
    uint32_t found_[kMaxPolygons];  // not yet their places: making the next one may move them all
    bool lone_[kMaxPolygons];       // named one by one, not with all polygons of a patch
    int count_ = 0;
};

}  // namespace

bool resolveSeam(DepthTiles& tiles, uint32_t tile, int bit, float wanted) {
    SIGHTLINE_DEBUG_ASSERT(tile < tiles.base.size() && bit >= 0 && bit < 64);
    const uint64_t pixel = uint64_t{1} << bit;
    float claims[64];
    readClaims(tiles, tile, claims);
    const float before = claims[bit];
    if (before > wanted) return true;
    if (tiles.seams[tile] == DepthTiles::kNone || !(tiles.seam_mask[tile] & ~tiles.tried[tile] & pixel)) return false;
    if (detail::kAblate.seams) return false;
    PixelSeam seam(tiles, tile, bit, before);
    const Corners corners = seam.gather(wanted);
    if (corners == Corners::kOpenNow) return false;
    tiles.tried[tile] |= pixel;
    if (corners == Corners::kOpen) return false;
    ++tiles.seam_pixels;
    const double nearness = seam.resolve();
    if (!(nearness > before)) return false;
    claims[bit] = roundFarther(nearness);
    SIGHTLINE_DEBUG_ASSERT(claims[bit] >= before);
    raiseClaims(tiles, tile, pixel, claims);
    return claims[bit] > wanted;
}

}  // namespace sightline
