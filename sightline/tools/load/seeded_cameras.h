// Seeded cameras that stand near surfaces and look at front faces, as a visitor would, and the rays that tell them where.
// SPDX-License-Identifier: MIT
//
// Christian Lauterbach, Michael Garland, Shubhabrata Sengupta, David Luebke, Dinesh Manocha. Fast BVH
// Construction on GPUs. 2009.
// Tomas Moller, Ben Trumbore. Fast, Minimum Storage Ray/Triangle Intersection. 1997.
#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/scene/camera_path.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// All points origin + t * direction; the direction need not be of unit length.
struct ProbeRay {
    glm::dvec3 origin, direction;
};

struct ProbeHit {
    double t = std::numeric_limits<double>::infinity();
    uint32_t object = 0;    ///< index into Scene::objects
    uint32_t triangle = 0;  ///< of the object's mesh
    bool front = false;     ///< the ray meets the triangle's front
};

/// A tree over boxes, split where their Morton codes differ: built in O(n log n), the same on every machine.
class ProbeTree {
public:
    struct Node {
        Box3d bounds;
        uint32_t first = 0;  ///< leaf: into order; else the left child, which the right one follows
        uint32_t count = 0;  ///< leaf: boxes; else 0
    };
    /// Codes of 63 bits, and halves where they are equal: no path is longer.
    static constexpr uint32_t kMaxDepth = 63 + 32;

    explicit ProbeTree(std::span<const Box3d> boxes);

    std::span<const Node> nodes() const { return nodes_; }
    std::span<const uint32_t> order() const { return order_; }

private:
    struct Coded {
        uint64_t code;
        uint32_t box;
    };
    void build(uint32_t node, uint32_t first, uint32_t last, std::span<const Coded> coded,
               std::span<const Box3d> boxes);

    std::vector<Node> nodes_;
    std::vector<uint32_t> order_;
};

/// Rays against all the triangles of a scene, which must outlive it. Every surface stops a ray, from both sides and
/// of any material, unless the caller says what does. Deterministic; const calls are thread-safe.
class RayProbe {
public:
    explicit RayProbe(const Scene& scene);

    /// Whether a hit counts.
    using Counts = std::function<bool(const ProbeHit&)>;

    /// The nearest hit with t > from, or none.
    /// @param counts  null: all do. Where two surfaces lie in one place, one of them stops a ray that asks for what is behind
    ///                the other only if this is said here
    std::optional<ProbeHit> nearest(const ProbeRay& ray, double from = 0, const Counts& counts = {}) const;

    /// The unit normal of the triangle that was hit, on its front; zero if it has no area.
    glm::dvec3 normal(const ProbeHit& hit) const;

private:
    void meet(uint32_t object, const ProbeRay& ray, double from, const Counts& counts, ProbeHit& best) const;

    const Scene* scene_;
    std::vector<std::unique_ptr<ProbeTree>> meshes_;  ///< null for meshes that no object uses
    std::unique_ptr<ProbeTree> objects_;
};

/// A camera stands off a surface point chosen by area (0.3 to 6 % of the core's diagonal (SceneCore) along the
/// normal), looks anywhere with pitch within +-30 degrees, and is taken only if most of its rays meet
/// front faces at more than 0.2 % of the diagonal; the wish fades if a scene cannot meet it.
/// Deterministic in (scene, count, seed); a scene without triangles gives cameras around the origin.
/// Vertical angle 60 degrees, near 0.05 % of the diagonal but at most 0.1, infinite far.
CameraPath seededCameras(const Scene& scene, uint32_t count, uint64_t seed);

}  // namespace sightline::tools
