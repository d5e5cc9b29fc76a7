// No cracks and no double writes: meshes that are clipped and scanned cover each sample that they should exactly once.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <span>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "sightline/base/random.h"
#include "sightline/studies/hidden/project/projector.h"
#include "sightline/studies/hidden/project/scan.h"
#include "tests/support/meshes.h"

namespace sightline {
using namespace studies;
namespace {

constexpr int kWidth = 16, kHeight = 8, kSamples = kWidth * kHeight;
/// Samples nearer than this to the mesh's border, or to where the near or the far plane cuts it, may be covered or not.
constexpr double kBand = 1e-6;

/// A mesh on the plane z = 0 that tiles the rectangle from low to high.
struct FlatMesh : test::TestMesh {
    glm::vec2 low{0.0f}, high{0.0f};
};

/// Cells whose inner corners are shaken, each cut along one of its diagonals.
/// @param shake  in cells: less than a quarter, so that no triangle turns over
FlatMesh shakenGrid(Random& random, const glm::vec2& low, const glm::vec2& high, uint32_t most_cells, double shake) {
    FlatMesh mesh{{}, low, high};
    const uint32_t columns = 1 + uint32_t(random.below(most_cells)), rows = 1 + uint32_t(random.below(most_cells));
    for (uint32_t y = 0; y <= rows; ++y)
        for (uint32_t x = 0; x <= columns; ++x) {
            double u = x, v = y;
            if (x > 0 && x < columns) u += random.uniform(-shake, shake);
            if (y > 0 && y < rows) v += random.uniform(-shake, shake);
            glm::vec2 p = low + (high - low) * glm::vec2(u / columns, v / rows);
            if (x == 0) p.x = low.x;
            if (x == columns) p.x = high.x;
            if (y == 0) p.y = low.y;
            if (y == rows) p.y = high.y;
            mesh.positions.push_back({p, 0});
        }
    for (uint32_t y = 0; y < rows; ++y)
        for (uint32_t x = 0; x < columns; ++x) {
            const uint32_t a = y * (columns + 1) + x, b = a + 1, c = a + columns + 2, d = a + columns + 1;
            if (random.below(2)) mesh.fan({a, b, c, d});
            else mesh.fan({b, c, d, a});
        }
    return mesh;
}

/// A fan from a hub to points on the border.
FlatMesh fan(Random& random, const glm::vec2& low, const glm::vec2& high) {
    FlatMesh mesh{{}, low, high};
    const glm::vec2 size = high - low;
    mesh.positions.push_back({low + size * glm::vec2(random.uniform(0.1, 0.9), random.uniform(0.1, 0.9)), 0});
    const glm::vec2 corners[4] = {low, {high.x, low.y}, high, {low.x, high.y}};
    for (int side = 0; side < 4; ++side) {
        const glm::vec2 a = corners[side], b = corners[(side + 1) % 4];
        mesh.positions.push_back({a, 0});
        if (random.below(2) == 0) continue;
        glm::vec2 p = a + static_cast<float>(random.uniform(0.2, 0.8)) * (b - a);
        (side % 2 ? p.x : p.y) = side % 2 ? a.x : a.y;  // on the border, exactly
        mesh.positions.push_back({p, 0});
    }
    const uint32_t rim = uint32_t(mesh.positions.size()) - 1;
    for (uint32_t i = 0; i < rim; ++i) mesh.fan({0, 1 + i, 1 + (i + 1) % rim});
    return mesh;
}

View randomView(Random& random, uint64_t kind) {
    View view;
    view.width = kWidth;
    view.height = kHeight;
    const glm::dvec3 eye(random.uniform(-3, 3), random.uniform(-3, 3), std::pow(10.0, random.uniform(-2, 0.7)));
    const double far = random.below(3) == 0 ? random.uniform(1, 10) : std::numeric_limits<double>::infinity();
    if (kind == 0) {
        // Straight down on a grid of samples: vertices and edges that lie on samples exactly.
        view.view = lookAt({0, 0, 4}, {0, 0, 0}, {0, 1, 0});
        view.projection = orthographic(8, 2, 1, 8);
        return view;
    }
    view.view =
        lookAt(eye, eye + glm::dvec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 0.2)), {0, 0, 1});
    if (kind == 1) view.projection = orthographic(random.uniform(2, 9), 2, random.uniform(-2, 3), 8);
    else view.projection = perspective(random.uniform(0.4, 2.2), 2, std::pow(10.0, random.uniform(-3, 0.3)), far);
    return view;
}

/// How far places are within the part of the rectangle that is to be seen, negative outside [samples]. By solving for
/// the point that a line of sight meets in the plane: no triangles, no clipping.
class Truth {
public:
    Truth(const View& view, const FlatMesh& mesh) {
        const glm::dmat4 m = view.projection * view.view;
        // Rows of clip coordinates over (x, y, 1) of the plane z = 0.
        const auto row = [&](int i) { return glm::dvec3(m[0][i], m[1][i], m[3][i]); };
        const glm::dvec3 x = row(0), y = row(1), z = row(2), w = row(3);
        // The point, times an unknown: cross(x - X w, y - Y w) = base + X * by_x + Y * by_y.
        const double turn = glm::dot(glm::cross(x, y), w) > 0 ? 1 : -1;  // what lies before the eye is positive
        const glm::dvec3 base = turn * glm::cross(x, y);
        const glm::dvec3 by_x = -turn * glm::cross(w, y), by_y = -turn * glm::cross(x, w);
        const glm::dvec3 limits[6] = {
            {1, 0, -mesh.low.x}, {-1, 0, mesh.high.x}, {0, 1, -mesh.low.y}, {0, -1, mesh.high.y}, z + w, w - z};
        for (int i = 0; i < 6; ++i) {
            const glm::dvec3& limit = limits[i];
            const double f = glm::dot(limit, base);
            const glm::dvec2 slope(glm::dot(limit, by_x) * 2.0 / kWidth, glm::dot(limit, by_y) * 2.0 / kHeight);
            const double steep = std::max(glm::length(slope), 1e-9 * std::abs(f));
            functions_[i] = glm::dvec3(slope, f - glm::dot(slope, glm::dvec2(kWidth, kHeight)) * 0.5) / steep;
        }
    }

    /// @param place  sample i of row j lies at (i + 0.5, j + 0.5)
    double inside(const glm::dvec2& place) const {
        double least = std::numeric_limits<double>::infinity();
        for (const glm::dvec3& f : functions_) least = std::min(least, glm::dot(f, glm::dvec3(place, 1)));
        return least;
    }

private:
    glm::dvec3 functions_[6];
};

/// Counts the edges of polygons that cross the visible part of the mesh and do not have their reverse, bit by bit, in
/// another polygon.
class Edges {
public:
    void add(std::span<const glm::dvec2> outline) {
        for (size_t i = 0; i < outline.size(); ++i) {
            const glm::dvec2 a = outline[i], b = outline[(i + 1) % outline.size()];
            if (a != b) edges_.push_back({a, b});
        }
    }
    int unpaired(const Truth& truth, uint64_t& paired) const {
        int count = 0;
        for (const auto& [a, b] : edges_) {
            const glm::dvec2 middle = 0.5 * (a + b);
            const bool in_view = middle.x > 0 && middle.x < kWidth && middle.y > 0 && middle.y < kHeight;
            // A triangle between two rows or columns of samples is dropped, and its edges with it.
            const glm::dvec2 low = glm::min(a, b) - 0.5, high = glm::max(a, b) - 0.5;
            const bool at_samples = std::ceil(low.x) <= high.x && std::ceil(low.y) <= high.y;
            if (!in_view || !at_samples || truth.inside(middle) <= kBand) continue;
            ++paired;
            count += std::find(edges_.begin(), edges_.end(), std::pair(b, a)) == edges_.end();
        }
        return count;
    }

private:
    std::vector<std::pair<glm::dvec2, glm::dvec2>> edges_;
};

struct Sums {
    uint64_t meshes = 0, paired = 0, covered = 0, unsure = 0, clipped[3] = {}, spared = 0, differing = 0;
};

/// Draws a mesh in one of three ways.
void cover(const FlatMesh& mesh, const View& view, int way, int (&counts)[kSamples], Edges& edges, Sums& sums) {
    DrawItem item;
    item.mesh = {mesh.positions, mesh.indices};
    ProjectorSettings settings{.cull_back_faces = false};
    settings.clipping = way == 1 ? Clipping::kFrustum : Clipping::kGuardBand;
    Projector projector(view, {kWidth, kHeight, 0, 1, {}}, settings);
    projector.begin(item);
    const auto add = [&](int32_t row, int32_t begin, int32_t end) {
        for (int32_t i = begin; i < end; ++i) ++counts[row * kWidth + i];
    };
    for (size_t t = 0; t < item.mesh.triangles(); ++t) {
        ScreenPolygon polygon;
        HomogeneousTriangle triangle;
        if (way < 2 && projector.project(t, polygon)) {
            scanPolygon(polygon.outline(), 0, kHeight, kWidth, add);
            edges.add(polygon.outline());
        }
        if (way == 2 && projector.projectHomogeneous(t, triangle)) scanHomogeneous(triangle, 0, kHeight, kWidth, add);
    }
    sums.clipped[way] += projector.counters().clipped;
    if (way == 0) sums.spared += projector.counters().spared;
}

void checkMesh(uint64_t seed, Sums& sums) {
    Random random(mixSeed(77, seed));
    const uint64_t kind = random.below(8);
    const double size = kind == 0 ? 1 : std::pow(10.0, random.uniform(-1, 2.5));
    glm::vec2 low(-size * random.uniform(0.1, 3), -size * random.uniform(0.1, 3));
    glm::vec2 high(size * random.uniform(0.1, 3), size * random.uniform(0.1, 3));
    const bool on_grid = kind == 0;
    if (on_grid) {
        low = {-8 + float(random.below(6)), -5 + float(random.below(4))};
        high = {2 + float(random.below(7)), 2 + float(random.below(4))};
    }
    FlatMesh mesh =
        random.below(2) ? shakenGrid(random, low, high, on_grid ? 2 : 3, on_grid ? 0.1 : 0.24) : fan(random, low, high);
    if (on_grid)
        for (glm::vec3& p : mesh.positions) p = glm::round(p * 2.0f) * 0.5f;
    const View view = randomView(random, kind);
    const Truth truth(view, mesh);
    int counts[3][kSamples] = {};
    for (int way = 0; way < 3; ++way) {
        Edges edges;
        cover(mesh, view, way, counts[way], edges, sums);
        ASSERT_EQ(edges.unpaired(truth, sums.paired), 0) << "seed " << seed << " way " << way;
    }
    ++sums.meshes;
    for (int at = 0; at < kSamples; ++at) {
        const double inside = truth.inside({at % kWidth + 0.5, at / kWidth + 0.5});
        const bool unsure = std::abs(inside) <= kBand;
        sums.unsure += unsure;
        sums.covered += inside > kBand;
        for (int way = 0; way < 3; ++way) {
            if (unsure) ASSERT_LE(counts[way][at], 1) << "seed " << seed << " sample " << at << " way " << way;
            else ASSERT_EQ(counts[way][at], inside > 0) << "seed " << seed << " sample " << at << " way " << way;
        }
        sums.differing += counts[0][at] != counts[1][at] || counts[0][at] != counts[2][at];
    }
}

/// A million meshes, in four parts that can run side by side.
class ClipCracks : public ::testing::TestWithParam<uint64_t> {};
INSTANTIATE_TEST_SUITE_P(Quarters, ClipCracks, ::testing::Range(uint64_t{0}, uint64_t{4}));

TEST_P(ClipCracks, ThereAreNoneAndNoDoubleWrites) {
    const uint64_t meshes = 250000, first = GetParam() * meshes;
    Sums sums;
    for (uint64_t seed = first; seed < first + meshes && !HasFatalFailure(); ++seed) checkMesh(seed, sums);
    std::printf(
        "%zu meshes, %zu samples covered once, %zu within the band; clipped %zu triangles at the guard band, "
        "%zu at six planes, %zu not at all (%zu samples differ); the band spared %zu; %zu edges equal their reverse\n",
        size_t(sums.meshes), size_t(sums.covered), size_t(sums.unsure), size_t(sums.clipped[0]),
        size_t(sums.clipped[1]), size_t(sums.clipped[2]), size_t(sums.differing), size_t(sums.spared),
        size_t(sums.paired));
    EXPECT_GT(sums.clipped[0], sums.meshes);
    EXPECT_GT(sums.covered, 10 * sums.meshes);
    EXPECT_GT(sums.paired, sums.meshes);
}

}  // namespace
}  // namespace sightline
