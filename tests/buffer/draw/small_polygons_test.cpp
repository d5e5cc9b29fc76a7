// Many small polygons at once against one at a time in double: nothing too much inside, nothing too little outside.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

#define HWY_COMPILE_ALL_ATTAINABLE
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "tests/buffer/draw/small_polygons_test.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/buffer/draw/small_classify-inl.h"

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {

void classifyForTest(const double (*corners)[256], uint32_t vertices, SmallPolygonsTask task, bool outer,
                     SmallPolygons& out) {
    SnappedVertex snapped[256];
    snapVertices(corners[0], corners[1], corners[2], vertices, snapped);
    task.vertices = snapped;
    if (outer) classifySmallPolygons<true>(task, out);
    else classifySmallPolygons<false>(task, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
#include "sightline/base/random.h"
#include "tests/support/targets.h"

namespace sightline {

HWY_EXPORT(classifyForTest);

namespace test {
namespace {

constexpr uint32_t kPolygons = 60, kColumns = 13, kRows = 9, kStride = 16;  // tiles

struct Point {
    double x = 0, y = 0, d = 0;
};

/// Polygons with places that are given, and the true ones within the slack of them.
struct Cluster {
    alignas(64) double given[3][256] = {};
    Point truth[4 * kPolygons];
    OccluderPolygon polygons[kPolygons];
    SmallPolygonsTask task;

    void classify(bool outer, SmallPolygons& out) const {
        HWY_DYNAMIC_DISPATCH(classifyForTest)(given, 4 * kPolygons, task, outer, out);
    }
};

void makeCorners(Random& random, Point (&p)[4]) {
    const double size = random.below(8) ? random.uniform(0.5, 12) : random.uniform(8, 60);
    const Point center{random.uniform(-10, 8 * kColumns + 10), random.uniform(-10, 8 * kRows + 10)};
    for (Point& corner : p)
        corner = {center.x + random.uniform(-0.5, 0.5) * size, center.y + random.uniform(-0.5, 0.5) * size};
    switch (random.below(7)) {
        case 0: {  // slivers
            const double t = random.uniform(-0.2, 1.2), off = random.uniform(-1, 1) * std::exp2(-random.uniform(0, 14));
            p[2] = {p[0].x + t * (p[1].x - p[0].x) + off, p[0].y + t * (p[1].y - p[0].y) - off};
            break;
        }
        case 1:  // on the borders of pixels and between
            for (Point& corner : p) corner = {std::round(2 * corner.x) / 2, std::round(2 * corner.y) / 2};
            break;
        case 2:  // two corners in one place, or nearly
            p[random.below(3)] = p[random.below(4)];
            if (random.below(2)) p[0].x += random.uniform(-0.01, 0.01);
            break;
        case 3:
        case 4: {  // round about, so convex
            const double turn = random.uniform(0, 6.3), way = random.below(2) ? 1 : -1;
            for (int k = 0; k < 4; ++k) {
                const double angle = turn + way * (1.571 * k + random.uniform(-0.3, 0.3));
                p[k] = {center.x + 0.5 * size * std::cos(angle), center.y + 0.5 * size * std::sin(angle)};
            }
            break;
        }
        case 5: {  // upright rectangles
            const double w = random.uniform(0, 12), h = random.uniform(0, 12);
            p[0] = p[1] = p[2] = p[3] = center;
            p[1].x += w, p[2].x += w, p[2].y += h, p[3].y += h;
            if (random.below(2)) std::swap(p[1], p[3]);
            break;
        }
        default:
            break;
    }
}

void makeCluster(uint64_t seed, Cluster& c) {
    Random random(seed);
    const double slacks[] = {0, 0x1p-20, 0.01, 0.125};
    c.task = {};
    c.task.polygons = c.polygons;
    c.task.count = seed % 5 ? kPolygons : 1 + static_cast<uint32_t>(random.below(kPolygons));
    c.task.columns = kColumns;
    c.task.rows = kRows;
    c.task.stride = kStride;
    c.task.reverse = random.below(2);
    c.task.slack = static_cast<float>(slacks[random.below(4)]);
    c.task.depth_error = random.below(2) ? 0x1p-12f : 0;
    const bool quads = seed % 2;
    for (uint32_t i = 0; i < kPolygons; ++i) {
        c.polygons[i] = {};
        c.polygons[i].double_sided = random.below(4) == 0;
        Point p[4];
        makeCorners(random, p);
        const int corners = quads && random.below(3) ? 4 : 3;
        for (int k = 0; k < 4; ++k) {
            const uint32_t v = 4 * i + static_cast<uint32_t>(k);
            if (k < corners) c.polygons[i].vertex[k] = static_cast<uint8_t>(v);
            const auto wrong = [&](double bound) {
                return random.below(2) ? random.uniform(-bound, bound) : random.below(2) ? bound : -bound;
            };
            p[k].d = random.uniform(-1, 1) * std::exp2(random.uniform(-8, 8));
            c.truth[v] = {p[k].x + wrong(c.task.slack), p[k].y + wrong(c.task.slack),
                          p[k].d + wrong(c.task.depth_error)};
            const bool behind = random.below(500) == 0;
            c.given[0][v] = behind ? std::numeric_limits<double>::quiet_NaN() : p[k].x;
            c.given[1][v] = p[k].y;
            c.given[2][v] = p[k].d;
        }
    }
}

/// Twice the signed area.
double areaOf(const Point& a, const Point& b, const Point& c) {
    return (b.x - a.x) * (c.y - a.y) - (c.x - a.x) * (b.y - a.y);
}

/// The triangles of one polygon that face the eye, counter-clockwise.
std::vector<std::array<Point, 3>> facing(const Cluster& c, uint32_t polygon) {
    std::vector<std::array<Point, 3>> out;
    const Point* p = c.truth + 4 * polygon;
    for (int k = 2; k < c.polygons[polygon].corners(); ++k) {
        std::array<Point, 3> t{p[0], p[k - 1], p[k]};
        const double area = areaOf(t[0], t[1], t[2]);
        if (area == 0 || ((area < 0) != c.task.reverse && !c.polygons[polygon].double_sided)) continue;
        if (area < 0) std::swap(t[1], t[2]);
        out.push_back(t);
    }
    return out;
}

bool contains(const std::array<Point, 3>& t, const Point& q, double tolerance) {
    for (int k = 0; k < 3; ++k)
        if (areaOf(t[k], t[(k + 1) % 3], q) < -tolerance) return false;
    return true;
}

/// Whether a triangle and a pixel's square overlap: no side of either has the other wholly on its outside.
bool overlaps(const std::array<Point, 3>& t, double x, double y) {
    const auto [x0, x1] = std::minmax({t[0].x, t[1].x, t[2].x});
    const auto [y0, y1] = std::minmax({t[0].y, t[1].y, t[2].y});
    if (x1 < x || y1 < y || x0 > x + 1 || y0 > y + 1) return false;
    for (int k = 0; k < 3; ++k) {
        bool inside = false;
        for (int corner = 0; corner < 4; ++corner)
            inside |= areaOf(t[k], t[(k + 1) % 3], {x + (corner & 1), y + (corner >> 1)}) >= 0;
        if (!inside) return false;
    }
    return true;
}

/// The least distance of a pixel's corners from the inside of the sides, where |a| + |b| = 1; for convex ones.
double depthInside(const Cluster& c, uint32_t polygon, double x, double y) {
    const int n = c.polygons[polygon].corners();
    double least = 1e9, sum = 0;
    Point p[4];
    for (int k = 0; k < n; ++k) p[k] = {c.given[0][4 * polygon + k], c.given[1][4 * polygon + k]};
    for (int k = 2; k < n; ++k) sum += areaOf(p[0], p[k - 1], p[k]);
    if (sum < 0) std::reverse(p, p + n);
    for (int k = 0; k < n; ++k) {
        const Point &a = p[k], &b = p[(k + 1) % n];
        const double length = std::abs(b.x - a.x) + std::abs(b.y - a.y);
        if (length < 1e-3) continue;
        for (int corner = 0; corner < 4; ++corner)
            least = std::min(least, areaOf(a, b, {x + (corner & 1), y + (corner >> 1)}) / length);
    }
    return least < 1e9 ? least : -1;
}

struct Masks {
    uint64_t inner = 0, outer = 0;
};

/// What is wrong with the answer for one polygon; empty if nothing is.
struct Judge {
    const Cluster& c;
    const SmallPolygons& out;
    uint64_t covered = 0, touched = 0, missed = 0;  ///< pixels; missed: inside by more than the bounds explain

    std::string judge(uint32_t polygon, std::map<uint32_t, Masks>& tiles, bool samples) {
        const std::vector<std::array<Point, 3>> triangles = facing(c, polygon);
        double low = 1e9, high = -1e9;
        for (const auto& t : triangles)
            for (const Point& p : t) low = std::min(low, p.d), high = std::max(high, p.d);
        if (!triangles.empty() && !tiles.empty() && !(out.farthest[polygon] <= low && out.nearest[polygon] >= high))
            return "the nearness";
        const Point* p = c.truth + 4 * polygon;
        double x0 = 1e9, x1 = -1e9, y0 = 1e9, y1 = -1e9;
        for (int k = 0; k < c.polygons[polygon].corners(); ++k) {
            x0 = std::min(x0, p[k].x), x1 = std::max(x1, p[k].x);
            y0 = std::min(y0, p[k].y), y1 = std::max(y1, p[k].y);
        }
        uint64_t bits = 0;
        for (const auto& [tile, masks] : tiles) bits += static_cast<uint64_t>(std::popcount(masks.inner | masks.outer));
        const uint64_t before = touched;
        const auto clamp = [](double v, uint32_t most) { return uint32_t(std::clamp(v, 0.0, double(most))); };
        for (uint32_t y = clamp(y0 - 1, 8 * kRows); y < clamp(y1 + 2, 8 * kRows); ++y)
            for (uint32_t x = clamp(x0 - 1, 8 * kColumns); x < clamp(x1 + 2, 8 * kColumns); ++x) {
                bool touches = false;
                for (const auto& t : triangles) touches |= overlaps(t, x, y);
                const auto at = tiles.find(y / 8 * kStride + x / 8);
                const uint64_t bit = uint64_t{1} << (y % 8 * 8 + x % 8);
                const bool inner = at != tiles.end() && at->second.inner & bit;
                const bool outer = at != tiles.end() && at->second.outer & bit;
                const std::string place = " of pixel " + std::to_string(x) + ", " + std::to_string(y);
                if (touches && !outer) return "the outer bit" + place;
                touched += outer;
                covered += inner;
                if (inner && !outer) return "the inner bit without the outer" + place;
                missed += outer && !inner && !triangles.empty() && depthInside(c, polygon, x, y) > c.task.slack + 0.01;
                if (!inner) continue;
                const int n = samples ? 16 : 1;
                for (int i = 0; i <= n; ++i)
                    for (int j = 0; j <= n; ++j) {
                        const Point q{x + double(i) / n, y + double(j) / n};
                        bool in = false;
                        for (const auto& t : triangles) in |= contains(t, q, 1e-10);
                        if (!in) return "the inner bit" + place;
                    }
            }
        if (touched - before != bits) return "bits far away";
        return {};
    }
};

uint64_t hashOf(const SmallPolygons& out, uint32_t polygons, bool outer) {
    uint64_t hash = 1;
    const auto add = [&](uint64_t value) { hash = mixSeed(hash, value); };
    add(out.count);
    for (uint32_t r = 0; r < out.count; ++r) {
        add(out.inner[r]);
        if (outer) add(out.outer[r]);
        add(out.place[r]);
    }
    add(out.large_count);
    for (uint32_t i = 0; i < out.large_count; ++i) add(out.large[i]);
    for (uint32_t p = 0; p < polygons; ++p)
        add(std::bit_cast<uint32_t>(out.farthest[p]) | uint64_t{std::bit_cast<uint32_t>(out.nearest[p])} << 32);
    return hash;
}

}  // namespace

TEST(SmallPolygons, HoldWhatTheyTouchAndNoMoreThanTheyCover) {
    auto c = std::make_unique<Cluster>();
    auto out = std::make_unique<SmallPolygons>(), bare = std::make_unique<SmallPolygons>();
    uint64_t covered = 0, touched = 0, missed = 0, large = 0;
    for (uint64_t seed = 1; seed <= 1000000 / kPolygons; ++seed) {
        makeCluster(seed, *c);
        c->classify(true, *out);
        std::vector<std::map<uint32_t, Masks>> tiles(kPolygons);
        for (uint32_t r = 0; r < out->count; ++r) {
            ASSERT_LT(out->polygon(r), c->task.count) << "seed " << seed;
            ASSERT_LT(out->tile(r) / kStride, kRows) << "seed " << seed;
            ASSERT_LT(out->tile(r) % kStride, kColumns) << "seed " << seed;
            ASSERT_TRUE(tiles[out->polygon(r)].insert({out->tile(r), {out->inner[r], out->outer[r]}}).second);
        }
        std::vector<uint8_t> is_large(kPolygons);
        for (uint32_t i = 0; i < out->large_count; ++i) {
            is_large[out->large[i]] = 1;
            ASSERT_TRUE(tiles[out->large[i]].empty());
        }
        large += out->large_count;
        Judge judge{*c, *out};
        for (uint32_t p = 0; p < c->task.count; ++p)
            if (!is_large[p]) {
                ASSERT_EQ(judge.judge(p, tiles[p], p == seed % kPolygons), "") << "seed " << seed << " polygon " << p;
            }
        covered += judge.covered;
        touched += judge.touched;
        missed += judge.missed;
        // Without the outer masks the inner ones are the same.
        c->classify(false, *bare);
        uint32_t r = 0;
        for (uint32_t i = 0; i < out->count; ++i) {
            if (!out->inner[i]) continue;
            ASSERT_LT(r, bare->count);
            ASSERT_EQ(bare->inner[r], out->inner[i]);
            ASSERT_EQ(bare->place[r++], out->place[i]);
        }
        ASSERT_EQ(r, bare->count) << "seed " << seed;
    }
    EXPECT_GT(covered, 1000000u);
    EXPECT_GT(touched, covered);
    EXPECT_EQ(missed, 0u);
    EXPECT_GT(large, 1000u);
}

TEST(SmallPolygons, AreTheSameOnEveryInstructionSet) {
    auto c = std::make_unique<Cluster>();
    auto out = std::make_unique<SmallPolygons>();
    std::vector<uint64_t> first;
    const int targets = forEachTarget([&](const std::string& name) {
        for (uint64_t seed = 1; seed <= 4000; ++seed) {
            makeCluster(seed, *c);
            uint64_t hash = 0;
            for (bool outer : {false, true}) {
                c->classify(outer, *out);
                hash = mixSeed(hash, hashOf(*out, c->task.count, outer));
            }
            if (first.size() < seed) first.push_back(hash);
            ASSERT_EQ(first[seed - 1], hash) << name << " seed " << seed;
        }
    });
    EXPECT_GT(targets, 1);
}

TEST(SmallPolygons, AreLeftOutWhereNothingIsToBeDrawn) {
    auto c = std::make_unique<Cluster>();
    auto out = std::make_unique<SmallPolygons>();
    makeCluster(1, *c);
    c->task.count = 4;
    c->task.reverse = false;
    for (uint32_t p = 0; p < 4; ++p) {
        const double x = p == 1 ? 400 : 10, y = p == 2 ? -50 : 10;
        const double xs[] = {0, 9, 0}, ys[] = {0, 0, 9};
        c->polygons[p] = {};
        for (uint8_t k = 0; k < 3; ++k) {
            const uint8_t v = static_cast<uint8_t>(4 * p + (p == 3 && k ? 3 - k : k));  // the last is turned away
            c->polygons[p].vertex[k] = v;
            c->given[0][4 * p + k] = x + xs[k];
            c->given[1][4 * p + k] = y + ys[k];
        }
    }
    c->classify(true, *out);
    ASSERT_EQ(out->count, 3u);
    EXPECT_EQ(out->large_count, 0u);
    for (uint32_t r = 0; r < out->count; ++r) EXPECT_EQ(out->polygon(r), 0u);
    c->polygons[3].double_sided = true;
    c->classify(true, *out);
    EXPECT_EQ(out->count, 6u);
    c->task.reverse = true;
    c->polygons[3].double_sided = false;
    c->classify(true, *out);
    ASSERT_EQ(out->count, 3u);
    EXPECT_EQ(out->polygon(0), 3u);
    c->given[0][13] = std::numeric_limits<double>::quiet_NaN();
    c->classify(true, *out);
    EXPECT_EQ(out->count, 0u);
    ASSERT_EQ(out->large_count, 1u);
    EXPECT_EQ(out->large[0], 3u);
}

}  // namespace test
}  // namespace sightline
#endif  // HWY_ONCE
