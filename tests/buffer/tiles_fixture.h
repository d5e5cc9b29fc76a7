// Draws meshes straight into depth tiles and holds the result to rays through every covered pixel.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/cull/occlusion.h"
#include "sightline/prepare/occluder/occluder.h"
#include "tests/support/meshes.h"
#include "tests/support/views.h"

namespace sightline::test {

struct Solid : TestMesh {
    std::vector<uint8_t> double_sided;
    glm::dmat4 transform{1.0};
};

/// A frame drawn by the code under test; owns what the tiles point to.
struct Drawing {
    View view;
    Screen screen;
    DepthTiles tiles;
    std::vector<Solid> solids;
    std::vector<Occluder> occluders;

    explicit Drawing(const View& v, Memory* memory = defaultMemory())
        : view(v), screen(makeScreen(v, 4096)), tiles(memory) {
        tiles.clear(screen.width, screen.height);
    }
    /// With all seams resolved.
    Drawing(const View& v, std::vector<Solid> what) : Drawing(v) { drawAndResolve(std::move(what)); }

    void draw(std::vector<Solid> what) {
        solids = std::move(what);
        for (const Solid& solid : solids) occluders.push_back(prepareOccluder(solid.view(), {}, solid.double_sided));
        for (size_t i = 0; i < solids.size(); ++i) {
            const OccluderInstance instance = makeOccluderInstance(screen, occluders[i], solids[i].transform);
            for (uint32_t c = 0; c < occluders[i].clusters.size(); ++c) {
                const BoxAnswer box = projectBox(instance.screen, occluders[i].clusters[c].bounds);
                if (!box.outside) drawOccluder(tiles, instance, c, box);
            }
        }
    }

    void drawAndResolve(std::vector<Solid> what) {
        draw(std::move(what));
        resolveAll();
    }

    void resolve(uint32_t x, uint32_t y) {
        resolveSeam(tiles, y / 8 * tiles.stride + x / 8, static_cast<int>(y % 8 * 8 + x % 8),
                    std::numeric_limits<float>::infinity());
    }

    void resolveAll() {
        for (uint32_t y = 0; y < tiles.height; ++y)
            for (uint32_t x = 0; x < tiles.width; ++x) resolve(x, y);
    }

    bool covered(uint32_t x, uint32_t y) const { return depth(x, y) > DepthTiles::kOpen; }
    float depth(uint32_t x, uint32_t y) const {
        float claims[64];
        readClaims(tiles, y / 8 * tiles.stride + x / 8, claims);
        return claims[y % 8 * 8 + x % 8];
    }
    uint64_t coveredPixels() const {
        uint64_t n = 0;
        for (uint32_t y = 0; y < tiles.height; ++y)
            for (uint32_t x = 0; x < tiles.width; ++x) n += covered(x, y);
        return n;
    }
    uint64_t openPixels() const { return uint64_t{tiles.width} * tiles.height - coveredPixels(); }
};

/// Sends rays from the eye of a drawing among its triangles. Plain ray casting: nothing of the rasterizer's arithmetic.
/// Triangles are brought before the eye once, and passed over where a ray is beside their image.
class RayCaster {
public:
    explicit RayCaster(const Drawing& drawing)
        : inverse_(glm::inverse(drawing.view.projection)),
          wide_x_(1.0 + 2.0 * drawing.view.jitter / drawing.view.width),
          wide_y_(1.0 + 2.0 * drawing.view.jitter / drawing.view.height),
          width_(drawing.screen.width),
          height_(drawing.screen.height),
          parallel_(!drawing.screen.perspective) {
        for (const Solid& solid : drawing.solids) {
            const glm::dmat4 to_eye = drawing.view.view * solid.transform;
            const bool flips = glm::determinant(glm::dmat3(solid.transform)) < 0;
            for (size_t t = 0; t + 2 < solid.indices.size(); t += 3) {
                Triangle triangle;
                for (int k = 0; k < 3; ++k)
                    triangle.v[k] =
                        glm::dvec3(to_eye * glm::dvec4(glm::dvec3(solid.positions[solid.indices[t + k]]), 1.0));
                if (flips) std::swap(triangle.v[1], triangle.v[2]);
                triangle.both = !solid.double_sided.empty() && solid.double_sided[t / 3];
                bound(triangle, drawing.view.projection);
                triangles_.push_back(triangle);
            }
        }
    }

    /// The nearness of the nearest drawn front face along the ray through a buffer point; -infinity if there is none.
    /// Edges are widened by 1e-9.
    double cast(double px, double py) const {
        const double nx = (2.0 * px / width_ - 1.0) * wide_x_, ny = (2.0 * py / height_ - 1.0) * wide_y_;
        const glm::dvec4 h = inverse_ * glm::dvec4(nx, ny, -1.0, 1.0);
        const glm::dvec3 near = glm::dvec3(h) / h.w;
        const glm::dvec3 origin = parallel_ ? near : glm::dvec3(0.0);
        const glm::dvec3 direction = parallel_ ? glm::dvec3(0, 0, -1) : near;
        const double t_near = parallel_ ? 0.0 : 1.0;
        double best = -std::numeric_limits<double>::infinity();
        for (const Triangle& triangle : triangles_) {
            if (!(px >= triangle.low.x && px <= triangle.high.x && py >= triangle.low.y && py <= triangle.high.y))
                continue;
            const glm::dvec3(&v)[3] = triangle.v;
            const glm::dvec3 n = glm::cross(v[1] - v[0], v[2] - v[0]);
            const double slope = glm::dot(n, direction);
            if (slope == 0.0 || (slope > 0.0 && !triangle.both)) continue;  // a back face is not drawn
            const double hit = glm::dot(n, v[0] - origin) / slope;
            if (!(hit >= t_near * (1.0 - 1e-7))) continue;
            const glm::dvec3 p = origin + hit * direction;
            bool inside = true;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec3 edge = v[(k + 1) % 3] - v[k];
                const double side = glm::dot(glm::cross(edge, p - v[k]), n);
                inside &= side >= -1e-9 * glm::length(edge) * glm::length(n) * std::max(1.0, glm::length(p));
            }
            if (inside) best = std::max(best, parallel_ ? p.z : 1.0 / -p.z);
        }
        return best;
    }

private:
    struct Triangle {
        glm::dvec3 v[3];  ///< relative to the eye
        glm::dvec2 low{-std::numeric_limits<double>::infinity()}, high{std::numeric_limits<double>::infinity()};
        bool both = false;
    };

    /// Bounds its image with a hundredth of a pixel to spare, unless a corner lies near the eye or behind it.
    void bound(Triangle& triangle, const glm::dmat4& projection) const {
        glm::dvec2 low(1e300), high(-1e300);
        for (const glm::dvec3& v : triangle.v) {
            const glm::dvec4 h = projection * glm::dvec4(v, 1.0);
            if (!(h.w > 1e-2)) return;
            const glm::dvec2 pixel((h.x / h.w / wide_x_ + 1.0) * 0.5 * width_,
                                   (h.y / h.w / wide_y_ + 1.0) * 0.5 * height_);
            const glm::dvec2 spare = 0.01 + 1e-6 * glm::abs(pixel);
            low = glm::min(low, pixel - spare);
            high = glm::max(high, pixel + spare);
        }
        triangle.low = low;
        triangle.high = high;
    }

    const glm::dmat4 inverse_;
    const double wide_x_, wide_y_, width_, height_;
    const bool parallel_;
    std::vector<Triangle> triangles_;
};

/// Sends rays through each covered pixel, corners and border included; returns a line on the first that gets past.
inline std::string findLeak(const Drawing& drawing, uint64_t seed, int rays_per_pixel) {
    Random random(seed);
    const RayCaster rays(drawing);
    for (uint32_t y = 0; y < drawing.tiles.height; ++y)
        for (uint32_t x = 0; x < drawing.tiles.width; ++x) {
            if (!drawing.covered(x, y)) continue;
            for (int i = 0; i < rays_per_pixel; ++i) {
                const double u = i < 4 ? i & 1 : random.uniform(), v = i < 4 ? i >> 1 : random.uniform();
                const double truth = rays.cast(x + u, y + v);
                if (truth >= drawing.depth(x, y)) continue;
                return "seed " + std::to_string(seed) + ": the ray through (" + std::to_string(x + u) + ", " +
                       std::to_string(y + v) + ") meets nothing nearer than " + std::to_string(truth) +
                       ", but the pixel claims " + std::to_string(drawing.depth(x, y));
            }
        }
    return {};
}

inline View smallView(uint32_t width = 96, uint32_t height = 64) {
    return viewBy(perspective(1.0, double(width) / height, 0.1), width, height);
}

/// A rectangle of quads in the plane z, its vertices moved at random: a joined surface with folds and slivers.
inline Solid makeSheet(Random& random, int columns, int rows, glm::vec3 low, glm::vec3 high, float noise) {
    Solid sheet;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const float u = static_cast<float>(i) / columns, v = static_cast<float>(j) / rows;
            const auto jump = [&] { return noise * static_cast<float>(random.uniform(-1, 1)); };
            const glm::vec3 p(low.x + u * (high.x - low.x), low.y + v * (high.y - low.y), low.z + u * (high.z - low.z));
            sheet.positions.push_back(p + glm::vec3(jump(), jump(), jump()));
        }
    sheet.addGrid(static_cast<uint32_t>(columns) + 1, static_cast<uint32_t>(rows) + 1);
    return sheet;
}

}  // namespace sightline::test
