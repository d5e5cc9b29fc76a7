// Draws polygons that share no sides, one by one: each covers the pixels that lie inside all its sides.
// SPDX-License-Identifier: MIT
//
// The argument. A pixel is covered if it lies on the inner side of each side's line, farther from it than all errors.
// Seen from a point of it each side then turns the same way, so the winding number is 1 or more; and moving the corners
// within their errors moves no side over it. So it holds for polygons that are not convex, too.
#if defined(SIGHTLINE_RASTER_LONE_POLYGON_INL_H) == defined(HWY_TARGET_TOGGLE)
#ifdef SIGHTLINE_RASTER_LONE_POLYGON_INL_H
#undef SIGHTLINE_RASTER_LONE_POLYGON_INL_H
#else
#define SIGHTLINE_RASTER_LONE_POLYGON_INL_H
#endif

#include <bit>

#include "sightline/raster/cluster_draw-inl.h"
#include "sightline/raster/small_polygons.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

constexpr double kLargeSides = 128.0;  // [pixels]: width and height of a polygon that keeps its seams in any cluster

/// The tiles as polygons in no order are merged into them.
struct MaskedTiles {
    DepthTiles& tiles;
    const float* base;
    float* layer;
    uint64_t* layer_mask;
    uint32_t* block;
    bool blocks;  ///< some tile may have one

    explicit MaskedTiles(DepthTiles& from)
        : tiles(from),
          base(from.base.data()),
          layer(from.layer.data()),
          layer_mask(from.layer_mask.data()),
          block(from.block.data()),
          blocks(!from.blocks.empty()) {}

    /// coverPixels() for tiles that are not to have blocks, without a jump that depends on depths: those are as random
    /// as the polygons' order. The layer lies in front of the base, or there is none.
    HWY_INLINE void cover(uint32_t tile, uint64_t mask, float z) const {
        if (!(z > base[tile])) return;
        const float old_z = layer[tile];
        const bool has_layer = old_z > DepthTiles::kOpen;
        const uint64_t old = layer_mask[tile] & (uint64_t{0} - has_layer), both = old | mask;
        if (HWY_UNLIKELY(both == ~uint64_t{0} || (blocks && has_layer && block[tile] != DepthTiles::kNone)))
            return coverPixels(tiles, tile, mask, z);
        const uint64_t in_front = uint64_t{0} - (z > old_z);
        const uint64_t near_mask = old ^ ((old ^ mask) & in_front);
        const uint32_t near_bits = std::bit_cast<uint32_t>(std::max(z, old_z));
        const uint32_t far_bits = std::bit_cast<uint32_t>(std::min(z, old_z));
        const uint32_t says_it_all = uint32_t{0} - (both == near_mask);
        layer[tile] = std::bit_cast<float>(far_bits ^ ((far_bits ^ near_bits) & says_it_all));
        layer_mask[tile] = both;  // the nearer one's if that says it all
        block[tile] = DepthTiles::kNone;
    }
};

/// The spans of a row of tiles: per row of pixels the first one and the one after the last.
struct PixelSpans {
    alignas(32) int32_t first[8], end[8];
    int32_t column0, column1;  ///< tiles that they meet; none if column0 > column1

    HWY_INLINE uint64_t inTile(int32_t tile) const {
        const hn::CappedTag<int32_t, 8> i32;
        const hn::Rebind<uint8_t, decltype(i32)> u8;
        const auto none = hn::Zero(i32), eight = hn::Set(i32, 8), ones = hn::Set(i32, 0xff);
        alignas(8) uint8_t bytes[8];
        for (size_t k = 0; k < 8; k += hn::Lanes(i32)) {
            const auto from = hn::Sub(hn::Load(i32, first + k), hn::Set(i32, 8 * tile));
            const auto to = hn::Sub(hn::Load(i32, end + k), hn::Set(i32, 8 * tile));
            const auto bits = hn::AndNot(hn::Shl(ones, hn::Min(hn::Max(to, none), eight)),
                                         hn::And(hn::Shl(ones, hn::Min(hn::Max(from, none), eight)), ones));
            hn::StoreU(hn::DemoteTo(u8, bits), u8, bytes + k);
        }
        uint64_t word;
        std::memcpy(&word, bytes, sizeof word);
        return word;
    }
};

/// A polygon drawn alone: its sides, counted from the lower left corner of the tiles that it may meet.
struct LonePolygon {
    double x[Corners::kMax], slope[Corners::kMax];  ///< at the centre of the lowest row; change per row
    // Bounds from a side's x in a row of pixels; those of the other hand's sides bound nothing.
    float left[Corners::kMax], right[Corners::kMax];              ///< of what lies inside
    float outer_left[Corners::kMax], outer_right[Corners::kMax];  ///< of what the polygon may touch
    int sides = 0;                                                ///< those that are not level
    double inner_low, inner_high;          ///< y between which level sides leave something inside
    double low, high, x_least, x_most;     ///< bounds of the corners
    double reach;                          ///< bound on the error of a corner  [pixels]
    int32_t column0, row0, columns, rows;  ///< [tiles]

    HWY_INLINE void setSide(int i, bool on_left, float wide) {
        constexpr float kFree = 1e30f;
        left[i] = on_left ? wide : -kFree;
        right[i] = on_left ? kFree : -wide;
        outer_left[i] = on_left ? -wide : -kFree;
        outer_right[i] = on_left ? kFree : wide;
    }
    inline void addSide(double ax, double ay, double bx, double by, int turn);
    template <bool kOuter>
    inline void spans(int32_t row, PixelSpans& inner, PixelSpans& outer) const;
};

inline void LonePolygon::addSide(double ax, double ay, double bx, double by, int turn) {
    const Line line(ax, ay, bx, by);
    if (!line.level) {
        const int i = sides++;
        slope[i] = line.slope;
        x[i] = line.x + (0.5 - line.y) * line.slope;
        // Float adds its own: a few steps of what is computed at any row.
        const double tilt = std::abs(line.slope), all = std::abs(x[i]) + 8.0 * (rows + 1) * tilt;
        const double error = line.error() + std::abs(line.x) * 0x1p-50;
        const float wide = static_cast<float>(tilt * (0.5 + reach) + reach + error + 0x1p-20 * (all + error));
        setSide(i, (by < ay) == (turn > 0), wide);
        return;
    }
    // How far the line itself may rise or fall between the polygon's left and right end.
    if (ax == bx && ay == by) return;
    const double rise = line.height == 0.0 ? 0.0 : line.height * ((x_most - x_least) / std::abs(bx - ax));
    if ((bx > ax) == (turn > 0) || !(rise < 1e9))
        inner_low = std::max(inner_low, std::max(ay, by) + rise + kEvaluation);
    if ((bx < ax) == (turn > 0) || !(rise < 1e9))
        inner_high = std::min(inner_high, std::min(ay, by) - rise - kEvaluation);
}

/// @tparam kOuter  also those of pixels that it may touch
template <bool kOuter>
inline void LonePolygon::spans(int32_t row, PixelSpans& inner, PixelSpans& outer) const {
    const F8 d;
    const hn::Rebind<int32_t, F8> i32;
    const float width = static_cast<float>(8 * columns);
    const float edge = 0x1p-20f * width;
    const float first_x = static_cast<float>(std::max(x_least, -1.0)),
                last_x = static_cast<float>(std::min(x_most, width + 1.0));
    const float e = static_cast<float>(reach) * (1.0f + 0x1p-20f);
    const auto zero = hn::Zero(d), beyond = hn::Set(d, width), one = hn::Set(d, 1.0f);
    const auto far = hn::Set(i32, 1 << 20);
    auto least = far, most = hn::Neg(far), outer_least = far, outer_most = most;
    for (size_t k = 0; k < 8; k += hn::Lanes(d)) {
        const auto rows_up = hn::Iota(d, static_cast<float>(k));
        auto low = hn::Set(d, first_x + e + edge), high = hn::Set(d, last_x - e - edge);
        auto outer_low = hn::Set(d, first_x - e - edge), outer_high = hn::Set(d, last_x + e + edge);
        for (int i = 0; i < sides; ++i) {
            const float start = static_cast<float>(x[i] + 8.0 * row * slope[i]), s = static_cast<float>(slope[i]);
            const auto at = hn::Add(hn::Set(d, start), hn::Mul(hn::Set(d, s), rows_up));
            low = hn::Max(low, hn::Add(at, hn::Set(d, left[i])));
            high = hn::Min(high, hn::Add(at, hn::Set(d, right[i])));
            if (!kOuter) continue;
            outer_low = hn::Max(outer_low, hn::Add(at, hn::Set(d, outer_left[i])));
            outer_high = hn::Min(outer_high, hn::Add(at, hn::Set(d, outer_right[i])));
        }
        const auto whole = [&](auto v) HWY_ATTR { return hn::ConvertTo(i32, hn::Min(hn::Max(v, zero), beyond)); };
        const auto note = [&](PixelSpans& to, auto first, auto end, auto& lowest, auto& highest) HWY_ATTR {
            hn::Store(first, i32, to.first + k);
            hn::Store(end, i32, to.end + k);
            const auto some = hn::Lt(first, end);
            lowest = hn::Min(lowest, hn::IfThenElse(some, first, lowest));
            highest = hn::Max(highest, hn::IfThenElse(some, end, highest));
        };
        note(inner, whole(hn::Add(low, one)), whole(high), least, most);
        if (kOuter) note(outer, whole(outer_low), whole(hn::Add(outer_high, one)), outer_least, outer_most);
    }
    const auto close = [&](PixelSpans& to, auto lowest, auto highest) HWY_ATTR {
        to.column0 = hn::GetLane(hn::MinOfLanes(i32, lowest)) >> 3;
        to.column1 = (hn::GetLane(hn::MaxOfLanes(i32, highest)) - 1) >> 3;
    };
    close(inner, least, most);
    if (kOuter) close(outer, outer_least, outer_most);
}

/// How near a polygon is in the tiles.
struct LoneDepth {
    BufferPlane plane;
    bool planar = false;
    uint32_t index = DepthTiles::kNone;  ///< of the plane, once a tile needs it
    double tilt = 0;
    float floor = 0, nearest = 0;

    HWY_INLINE float in(int32_t column, int32_t row) const {
        if (!planar) return floor;
        const double center = plane.d0 + plane.dx * (8.0 * column + 4.0) + plane.dy * (8.0 * row + 4.0);
        const double error = plane.error + 0x1p-20 * (std::abs(center) + 8.0 * tilt);
        return std::max(static_cast<float>(center - 4.0 * tilt - error), plane.floor);
    }
};

/// Whether any tile of a rectangle does not hide what is no nearer.
HWY_INLINE bool anyOpen(const DepthTiles& tiles, const LonePolygon& p, float nearest) {
    const F16 d;
    for (int32_t row = 0; row < p.rows; ++row) {
        const float* base = tiles.base.data() + size_t{static_cast<uint32_t>(p.row0 + row)} * tiles.stride +
                            static_cast<size_t>(p.column0);
        for (int32_t i = 0; i < p.columns; i += static_cast<int32_t>(hn::Lanes(d))) {
            const auto open = hn::Lt(hn::LoadU(d, base + i), hn::Set(d, nearest));
            if (!hn::AllFalse(d, hn::And(hn::FirstN(d, static_cast<size_t>(p.columns - i)), open))) return true;
        }
    }
    return false;
}

/// Carries a polygon into the tiles, row by row. Returns whether it left seams.
template <bool kSeams>
inline bool coverLone(DepthTiles& tiles, const LonePolygon& p, LoneDepth& depth, uint32_t source) {
    PixelSpans inner, outer;
    bool seams = false;
    const double limit = 8.0 * p.rows;
    const auto rowOf = [&](double y) { return static_cast<int32_t>(std::clamp(y, -1.0, limit)); };
    const int32_t in_first = rowOf(std::ceil(p.inner_low + p.reach)),
                  in_end = rowOf(std::floor(p.inner_high - p.reach));
    const int32_t out_first = rowOf(std::floor(p.low - p.reach)), out_last = rowOf(std::floor(p.high + p.reach));
    for (int32_t row = 0; row < p.rows; ++row) {
        const uint64_t in_rows =
            bytesBetween(std::clamp(in_first - 8 * row, -8, 15), std::clamp(in_end - 1 - 8 * row, -8, 15));
        if (!kSeams && !in_rows) continue;
        const uint64_t out_rows =
            bytesBetween(std::clamp(out_first - 8 * row, -8, 15), std::clamp(out_last - 8 * row, -8, 15));
        p.spans<kSeams>(row, inner, outer);
        const uint32_t at = static_cast<uint32_t>(p.row0 + row) * tiles.stride + static_cast<uint32_t>(p.column0);
        const PixelSpans& all = kSeams ? outer : inner;
        const int32_t last = std::min(all.column1, p.columns - 1);
        for (int32_t column = all.column0; column <= last; ++column) {
            const uint32_t tile = at + static_cast<uint32_t>(column);
            if (!(tiles.base[tile] < depth.nearest)) continue;
            const uint64_t covered = inner.inTile(column) & in_rows;
            if (covered) {
                const float z = depth.in(p.column0 + column, p.row0 + row);
                if (covered != ~uint64_t{0}) {
                    if (tiles.detail == Detail::kMasked) MaskedTiles(tiles).cover(tile, covered, z);
                    else coverPixels(tiles, tile, covered, z);
                } else {
                    if (depth.planar && depth.index == DepthTiles::kNone) {
                        depth.index = static_cast<uint32_t>(tiles.planes.size());
                        tiles.planes.push_back(depth.plane);
                    }
                    coverWhole(tiles, tile, z, depth.index);
                }
            }
            if (!kSeams) continue;
            const uint64_t touched = outer.inTile(column) & out_rows & ~covered;
            if (const uint64_t seam = touched ? notYetNearer(tiles, tile, touched, depth.nearest) : 0) {
                addSeam(tiles, tile, seam, source);
                seams = true;
            }
        }
    }
    return seams;
}

/// Draws one polygon. Returns whether it left seams.
/// @param turn   which way it winds
/// @param panel  it keeps its seams, however small it is
inline bool drawLone(const ClusterDraw& c, const Corners& k, int turn, bool panel, uint32_t source) {
    DepthTiles& tiles = c.tiles;
    double x0 = k.x[0], x1 = x0, y0 = k.y[0], y1 = y0, d0 = k.d[0], d1 = d0;
    for (int i = 1; i < k.count; ++i) {
        x0 = std::min(x0, k.x[i]);
        x1 = std::max(x1, k.x[i]);
        y0 = std::min(y0, k.y[i]);
        y1 = std::max(y1, k.y[i]);
        d0 = std::min(d0, k.d[i]);
        d1 = std::max(d1, k.d[i]);
    }
    LonePolygon p;
    const double far = std::max(std::max(std::abs(x0), std::abs(x1)), std::max(std::abs(y0), std::abs(y1)));
    const double e = p.reach = c.drawn.position_error + kEvaluation + far * 0x1p-48;
    if (!(x1 + e >= 0 && y1 + e >= 0 && x0 - e < tiles.width && y0 - e < tiles.height)) return false;
    const auto tileOf = [](double at, double size) {
        return static_cast<int32_t>(std::clamp(at, 0.0, size - 1.0)) >> 3;
    };
    p.column0 = tileOf(x0 - e, tiles.width);
    p.row0 = tileOf(y0 - e, tiles.height);
    p.columns = tileOf(x1 + e, tiles.width) - p.column0 + 1;
    p.rows = tileOf(y1 + e, tiles.height) - p.row0 + 1;
    LoneDepth depth;
    const double near = d1 + std::abs(d1) * 0x1p-22 + c.drawn.depth_error;
    depth.nearest = static_cast<float>(near + std::abs(near) * 0x1p-22);
    if (!anyOpen(tiles, p, depth.nearest)) return false;
    const double corner_error = std::max(std::abs(d0), std::abs(d1)) * 0x1p-36 + c.drawn.depth_error;
    depth.floor = static_cast<float>(d0 - corner_error - std::abs(d0) * 0x1p-22);
    const double flat = p.columns <= 2 && p.rows <= 2 ? 0.01 : 0x1p-10;
    if (d1 - d0 > flat * std::abs(d0)) {
        depth.planar = planeOf(k, c.drawn.depth_error, c.drawn.position_error, depth.plane);
        depth.plane.floor = depth.floor;
        depth.tilt = std::abs(depth.plane.dx) + std::abs(depth.plane.dy);
    }
    const double left = 8.0 * p.column0, bottom = 8.0 * p.row0;
    p.x_least = x0 - left;
    p.x_most = x1 - left;
    p.low = p.inner_low = y0 - bottom;
    p.high = p.inner_high = y1 - bottom;
    for (int i = 0; i < k.count; ++i) {
        const int j = i + 1 < k.count ? i + 1 : 0;
        p.addSide(k.x[i] - left, k.y[i] - bottom, k.x[j] - left, k.y[j] - bottom, turn);
    }
    const bool seams = panel || x1 - x0 + y1 - y0 >= kLargeSides;
    return seams ? coverLone<true>(tiles, p, depth, source) : coverLone<false>(tiles, p, depth, source);
}

/// Draws a triangle of some tiles' size from its snapped corners; it leaves no seams.
/// @returns false if it is to be drawn otherwise
inline bool drawMiddle(DepthTiles& tiles, const SmallPolygonsTask& task, const OccluderPolygon& polygon) {
    if (polygon.vertex[3] != OccluderPolygon::kNone) return false;
    const SnappedVertex &a = task.vertices[polygon.vertex[0]], &b = task.vertices[polygon.vertex[1]],
                        &c = task.vertices[polygon.vertex[2]];
    const int32_t x0 = std::min(a.x, std::min(b.x, c.x)), x1 = std::max(a.x, std::max(b.x, c.x));
    const int32_t y0 = std::min(a.y, std::min(b.y, c.y)), y1 = std::max(a.y, std::max(b.y, c.y));
    if (x0 == SnappedVertex::kNone || int64_t{x1} - x0 + y1 - y0 >= static_cast<int64_t>(256 * kLargeSides))
        return false;
    // Twice its area in 1/256 pixel; each coordinate's difference is below 2^15 there.
    const int64_t area = int64_t{b.x - a.x} * (c.y - a.y) - int64_t{c.x - a.x} * (b.y - a.y);
    if (area == 0) return true;
    const int turn = area > 0 ? 1 : -1;
    if (turn != (task.reverse ? -1 : 1) && !polygon.double_sided) return true;
    const int32_t width = static_cast<int32_t>(8 * task.columns), height = static_cast<int32_t>(8 * task.rows);
    if (x1 < 0 || y1 < 0 || x0 >= 256 * width || y0 >= 256 * height) return true;  // no pixel inside it
    LonePolygon p;
    p.reach = double{task.slack} + 0x1p-9;
    p.column0 = std::max(x0, 0) >> 11;
    p.row0 = std::max(y0, 0) >> 11;
    p.columns = (std::min(x1 >> 8, width - 1) >> 3) - p.column0 + 1;
    p.rows = (std::min(y1 >> 8, height - 1) >> 3) - p.row0 + 1;
    const double d0 = std::min(a.d, std::min(b.d, c.d)), d1 = std::max(a.d, std::max(b.d, c.d)), range = d1 - d0;
    LoneDepth depth;
    const double rounding = std::max(std::abs(d0), std::abs(d1)) * 0x1p-22 + task.depth_error;
    depth.nearest = static_cast<float>(d1 + 2.0 * rounding);
    if (!anyOpen(tiles, p, depth.nearest)) return true;
    depth.floor = static_cast<float>(d0 - 2.0 * rounding);
    constexpr int64_t kLeastArea = 1 << 12;  // of twice the area: 1/16 pixel
    if (area * turn >= kLeastArea && range > (p.columns <= 2 && p.rows <= 2 ? 0.01 : 0x1p-10) * std::abs(d0)) {
        const double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - a.x, vy = c.y - a.y;
        const double ud = double{b.d} - a.d, vd = double{c.d} - a.d, scale = 256.0 / static_cast<double>(area);
        BufferPlane& plane = depth.plane;
        plane.dx = (ud * vy - vd * uy) * scale;
        plane.dy = (vd * ux - ud * vx) * scale;
        plane.d0 = a.d - 0x1p-8 * (plane.dx * a.x + plane.dy * a.y);
        plane.floor = depth.floor;
        depth.tilt = std::abs(plane.dx) + std::abs(plane.dy);
        // A point of the triangle mixes its corners, at each of which the plane is wrong by no more than this.
        const double error = depth.tilt * p.reach + rounding + range * 0x1p-30 + std::abs(plane.d0) * 0x1p-46;
        plane.error = static_cast<float>(error * (1.0 + 0x1p-20));
        depth.planar = true;
    }
    const int32_t left = 2048 * p.column0, bottom = 2048 * p.row0;
    p.x_least = 0x1p-8 * (x0 - left);
    p.x_most = 0x1p-8 * (x1 - left);
    p.low = p.inner_low = 0x1p-8 * (y0 - bottom);
    p.high = p.inner_high = 0x1p-8 * (y1 - bottom);
    const SnappedVertex* corner[4] = {&a, &b, &c, &a};
    for (int i = 0; i < 3; ++i) {
        const double dx = corner[i + 1]->x - corner[i]->x, dy = corner[i + 1]->y - corner[i]->y;
        if (dy == 0.0) {  // above or below the others for good: it has the same y at both ends
            const double y = 0x1p-8 * (corner[i]->y - bottom);
            if ((dx > 0.0) == (turn > 0)) p.inner_low = std::max(p.inner_low, y);
            else p.inner_high = std::min(p.inner_high, y);
            continue;
        }
        const int side = p.sides++;
        const double slope = dx / dy, x = 0x1p-8 * (corner[i]->x - left), y = 0x1p-8 * (corner[i]->y - bottom);
        p.slope[side] = slope;
        p.x[side] = x + (0.5 - y) * slope;
        // Float adds its own: a few steps of what is computed at any row.
        const double tilt = std::abs(slope), all = std::abs(p.x[side]) + 8.0 * (p.rows + 1) * tilt;
        p.setSide(side, (dy < 0.0) == (turn > 0),
                  static_cast<float>(tilt * (0.5 + p.reach) + p.reach + 0x1p-20 * (all + 1.0)));
    }
    coverLone<false>(tiles, p, depth, 0);
    return true;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
