// The slow truth about shadows: rays to the sun against every triangle near them, and what may explain a difference.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "sightline/studies/hidden/shade/shadow_map.h"

namespace sightline::test {
using namespace studies;

/// Triangles in a space whose z runs to the sun, in cells across it.
class SunRays {
public:
    /// @param eye  that points are relative to
    SunRays(std::span<const DrawItem> casters, const glm::dvec3& eye, const glm::dvec3& sun) {
        const glm::dvec3 side = std::abs(sun.x) < 0.7 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 0, 1);
        const glm::dvec3 x = glm::normalize(glm::cross(side, sun));
        turn_ = glm::transpose(glm::dmat3(x, glm::cross(sun, x), sun));
        for (const DrawItem& item : casters)
            for (size_t t = 0; t < item.mesh.triangles(); ++t) {
                if (!item.writes_depth.empty() && !item.writes_depth[t]) continue;
                Triangle triangle;
                for (size_t k = 0; k < 3; ++k) {
                    const glm::dvec4 p(glm::dvec3(item.mesh.positions[item.mesh.indices[3 * t + k]]), 1);
                    triangle.p[k] = turn_ * (glm::dvec3(item.transform * p) - eye);
                    low_ = glm::min(low_, glm::dvec2(triangle.p[k]));
                    high_ = glm::max(high_, glm::dvec2(triangle.p[k]));
                }
                triangles_.push_back(triangle);
            }
        cells_.resize(kSide * kSide);
        for (uint32_t i = 0; i < triangles_.size(); ++i) {
            const Triangle& t = triangles_[i];
            const glm::ivec2 a = cellOf(glm::min(glm::min(t.p[0], t.p[1]), t.p[2]));
            const glm::ivec2 b = cellOf(glm::max(glm::max(t.p[0], t.p[1]), t.p[2]));
            for (int v = a.y; v <= b.y; ++v)
                for (int u = a.x; u <= b.x; ++u) cells_[static_cast<size_t>(v * kSide + u)].push_back(i);
        }
    }

    /// Whether a ray to the sun from a point is stopped beyond `least`.
    bool blocked(const glm::dvec3& point, double least) const {
        const glm::dvec3 from = turn_ * point;
        const glm::ivec2 cell = cellOf(from);
        for (const uint32_t i : cells_[static_cast<size_t>(cell.y * kSide + cell.x)]) {
            const glm::dvec3* p = triangles_[i].p;
            double part[3], area = 0;
            for (int k = 0; k < 3; ++k) {
                const glm::dvec2 a = glm::dvec2(p[(k + 1) % 3] - from), b = glm::dvec2(p[(k + 2) % 3] - from);
                part[k] = a.x * b.y - a.y * b.x;
                area += part[k];
            }
            if (area == 0) continue;
            double height = 0;
            bool inside = true;
            for (int k = 0; k < 3; ++k) {
                inside &= part[k] / area >= 0;
                height += part[k] / area * p[k].z;
            }
            if (inside && height - from.z > least) return true;
        }
        return false;
    }

    /// Two directions across the sun's rays.
    glm::dvec3 aside(double angle) const {
        return glm::transpose(turn_) * glm::dvec3(std::cos(angle), std::sin(angle), 0);
    }

private:
    static constexpr int kSide = 128;
    struct Triangle {
        glm::dvec3 p[3];
    };
    glm::ivec2 cellOf(const glm::dvec3& place) const {
        const glm::dvec2 part = (glm::dvec2(place) - low_) / glm::max(high_ - low_, glm::dvec2(1e-9));
        return glm::ivec2(glm::clamp(part * double(kSide), glm::dvec2(0), glm::dvec2(kSide - 1)));
    }

    glm::dmat3 turn_{1.0};
    glm::dvec2 low_{1e300}, high_{-1e300};
    std::vector<Triangle> triangles_;
    std::vector<std::vector<uint32_t>> cells_;
};

enum class ShadowVerdict {
    kAgrees,
    kExplained,        ///< the shadow's edge, or what casts, is nearer than the map can tell
    kDarkInTheLight,   ///< nothing near stops the sun
    kLightInTheShadow  ///< everything near stops it, far enough away
};

/// Compares a map with rays at a point that faces the sun.
inline ShadowVerdict judgeShadow(const ShadowMap& map, const SunRays& rays, const SurfacePoint& point, double facing) {
    const double reach = map.reach(point), texel = map.texelFor(point), contact = 4 * texel / facing;
    const glm::dvec3 start = point.position + 1e-7 * point.normal;
    if (reach == (rays.blocked(start, 0) ? 0.0 : 1.0)) return ShadowVerdict::kAgrees;
    bool any_blocked = false, any_free = !rays.blocked(start, contact);
    for (int k = 0; k < 24; ++k) {
        const glm::dvec3 near = start + 2.1 * texel * (k < 8 ? 0.5 : 1.0) * rays.aside(k * 0.7854);
        any_blocked |= rays.blocked(near, -contact);
        any_free |= !rays.blocked(near, contact);
    }
    if (reach < 1 && !any_blocked) return ShadowVerdict::kDarkInTheLight;
    if (reach > 0 && !any_free) return ShadowVerdict::kLightInTheShadow;
    return ShadowVerdict::kExplained;
}

}  // namespace sightline::test
