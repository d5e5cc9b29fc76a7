// What the case "backface" measures on: made meshes and scenes, as one mesh each, and clusters of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "bench/table.h"
#include "sightline/geom/facing_eye.h"
#include "sightline/geom/mesh_view.h"
#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bench {
using namespace tools;

struct FacingMesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    MeshView view() const { return {positions, indices}; }
    Box3d box() const;
};

/// A ball with bumps, of shared vertices.
/// @param rings    2 * rings * rings quadrangles
/// @param bumps    their height, in radii
/// @param noise    how far each vertex is moved along its normal at random, in radii
FacingMesh bumpyBall(const std::string& name, int rings, double bumps, double noise);

/// All objects of a scene in world space; mirrored ones wound the other way, so that their fronts stay fronts. Triangles with two
/// corners in one place, which face nobody, are left out.
FacingMesh wholeScene(const Scene& scene);

/// A mesh in another order of its triangles, and the sizes of its clusters.
struct ClusteredMesh {
    FacingMesh mesh;  ///< its triangles cluster by cluster
    std::vector<uint32_t> sizes;
};

/// Clusters by meshoptimizer.
ClusteredMesh meshoptClusters(const FacingMesh& mesh, uint32_t triangles, float cone_weight);

/// For each cluster and eye: does meshoptimizer's cone say "back"? Bits as in findBackClusters().
class MeshoptCones {
public:
    explicit MeshoptCones(const ClusteredMesh& clustered);
    void find(const glm::dvec3& eye, std::vector<uint8_t>& back) const;

private:
    struct Cone {
        float apex[3], axis[3], cutoff;
    };
    std::vector<Cone> cones_;
};

inline bool bitOf(const std::vector<uint8_t>& bits, size_t i) { return bits[i / 8] >> (i % 8) & 1; }

/// What the tests of clusters find on clusters of several makes, what ours cost beside them, and how long all that takes.
void addClusterRows(const FacingMesh& mesh, int repeat, Table& table);

/// Eyes at random places of a box.
std::vector<FacingEye> randomEyes(const Box3d& box, int count);

}  // namespace sightline::bench
