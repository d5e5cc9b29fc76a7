// Clusters of a mesh's triangles that are seen from their backs together, as the tests at run time read them.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998 (the volumes).
// Subodh Kumar, Dinesh Manocha, William Garrett, Ming Lin. Hierarchical Back-Face Computation. 1996 (the idea).
// Arseny Kapoulkine. meshoptimizer 0.18. 2022 (the cone with an apex).
// Ulrich Haar, Sebastian Aaltonen. GPU-Driven Rendering Pipelines. 2015 (the masks of triangles).
#pragma once

#include <cstddef>
#include <cstdint>

#include "sightline/math/glm_types.h"
#include "sightline/base/array.h"

namespace sightline {

/// Where all triangles of a cluster are seen from their backs, and where from their fronts: with q = eye - origin and
/// unit normals, a triangle's n * q is at most the sum of max(most * q, least * q) over the axes, and at least that of min().
/// If the first is not above `back`, the least n * (p - origin), all are back faces; if the second is above `front`, the
/// largest, all are front faces. Both regions are convex. 40 bytes, and 4 more for the test for fronts.
struct CullingVolume {
    glm::vec3 origin{0.0f};              ///< relative to FacingClusters::origin
    glm::vec3 most{1.0f}, least{-1.0f};  ///< of the normals' components; rounded outward
    float back = -3e38f, front = 3e38f;  ///< rounded to where less is culled
};
static_assert(sizeof(CullingVolume) == 44);

/// All triangles are seen from their backs from where (apex - eye) * axis > cutoff * |apex - eye|.
struct FacingCone {
    glm::vec3 apex{0.0f};  ///< relative to FacingClusters::origin
    glm::vec3 axis{0.0f};  ///< of unit length
    float cutoff = 2.0f;   ///< the sine of the normals' largest angle with the axis, rounded up; above 1: never
};
static_assert(sizeof(FacingCone) == 28);

/// The frame of a volume whose axes are turned towards the mean normal. Origin and distances are those of the cluster's
/// CullingVolume: turning does not change them.
struct TurnedBox {
    glm::vec3 axes[3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    glm::vec3 most{1.0f}, least{-1.0f};
};
static_assert(sizeof(TurnedBox) == 60);

/// From where single triangles are seen from their backs: space around a box, of the shape that is the same for all, is cut into
/// sectors by the box's faces, each in steps * steps cells; a sector has a bit for each triangle that is a back face for every
/// eye in it.
struct TriangleMasks {
    static constexpr uint32_t kMaxSteps = 4;

    glm::vec3 center{0.0f};   ///< of the box that holds the cluster, relative to FacingClusters::origin
    float half = -1.0f;       ///< its half sides over mask_shape; negative: no masks
    uint32_t first_word = 0;  ///< in FacingClusters::mask_words: of the first sector; one after the other
};

/// Clusters of one mesh, in object space, each a run of triangles in an order of their own. Plain data;
/// prepare/facing/facing_clusters.h makes it. What is drawn by it must have the mesh's own positions: not skinned, not morphed.
struct FacingClusters {
    static constexpr size_t kPadding = 16;
    /// Rows of the arrays: a number of each cluster after the other.
    enum VolumeRow { kOrigin = 0, kMost = 3, kLeast = 6, kBack = 9, kFront = 10, kVolumeRows = 11 };
    enum TurnedRow { kAxes = 0, kTurnedMost = 9, kTurnedLeast = 12, kTurnedRows = 15 };
    enum ConeRow { kApex = 0, kAxis = 3, kCutoff = 6, kConeRows = 7 };

    glm::dvec3 origin{0.0};     ///< what all positions here are relative to
    double reach = 0;           ///< no corner of a triangle is farther from it, by the sum of the three axes
    Array<uint32_t> triangles;  ///< by their place in the mesh's index buffer / 3, cluster by cluster
    Array<uint32_t> first;      ///< per cluster and one more: its first place in `triangles`

    size_t stride = 0;     ///< of the rows: clusters rounded up to kPadding; the padding is never culled
    Array<float> volumes;  ///< CullingVolume, each cluster's  [size: kVolumeRows * stride]
    Array<float> turned;   ///< TurnedBox  [size: kTurnedRows * stride, or 0]
    Array<float> cones;    ///< FacingCone  [size: kConeRows * stride, or 0]

    uint32_t mask_steps = 0;     ///< sectors: 6 * steps * steps; 0: there are no masks
    glm::dvec3 mask_shape{1.0};  ///< of the boxes: their sides over the longest; eyes are expected alike on all faces
    Array<TriangleMasks> masks;  ///< per cluster; or empty
    Array<uint64_t> mask_words;  ///< (size of the cluster + 63) / 64 for each sector

    explicit FacingClusters(Memory* memory = defaultMemory())
        : triangles(memory),
          first(memory),
          volumes(memory),
          turned(memory),
          cones(memory),
          masks(memory),
          mask_words(memory) {}

    size_t count() const { return first.empty() ? 0 : first.size() - 1; }
    uint32_t size(size_t cluster) const { return first[cluster + 1] - first[cluster]; }
    uint32_t sectors() const { return 6 * mask_steps * mask_steps; }

    CullingVolume volume(size_t i) const {
        const auto at = [&](int row) { return volumes[static_cast<size_t>(row) * stride + i]; };
        const auto vector = [&](int row) { return glm::vec3(at(row), at(row + 1), at(row + 2)); };
        return {vector(kOrigin), vector(kMost), vector(kLeast), at(kBack), at(kFront)};
    }
};

/// A node over clusters that lie next to one another in their order.
struct FacingNode {
    CullingVolume volume;
    uint32_t first = 0, count = 0;  ///< its clusters
    uint32_t next = 0;              ///< the node after its last descendant
};

/// Nodes over FacingClusters, parents first; makeFacingTree() makes it. Clusters under no node are tested by themselves.
struct FacingTree {
    Array<FacingNode> nodes;

    explicit FacingTree(Memory* memory = defaultMemory()) : nodes(memory) {}
};

}  // namespace sightline
