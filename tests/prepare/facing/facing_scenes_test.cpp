// Back faces of the dense scenes: no technique takes a face for one that is seen from its back if it faces the eye.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <numeric>

#include "sightline/cull/facing_clusters.h"
#include "sightline/prepare/facing/facets.h"
#include "sightline/prepare/facing/facing_clusters.h"
#include "sightline/prepare/facing/merge_facing.h"
#include "sightline/prepare/facing/normal_classes.h"
#include "sightline/studies/facing/back_faces.h"
#include "sightline/studies/facing/normal_masks.h"
#include "sightline/studies/facing/triangle_planes.h"
#include "sightline/tools/import/scene_file.h"
#include "tests/cull/facing_oracle.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
using namespace studies;
using namespace tools;
namespace {

/// Exact where double is not sure.
bool facesEye(const MeshView& mesh, size_t triangle, const FacingEye& eye) {
    const glm::dvec3 a(mesh.positions[mesh.indices[3 * triangle]]), b(mesh.positions[mesh.indices[3 * triangle + 1]]);
    const glm::dvec3 c(mesh.positions[mesh.indices[3 * triangle + 2]]), q = eye.point - eye.w * a;
    const double quick = glm::dot(glm::cross(b - a, c - a), q);
    const double size = glm::length(b - a) * glm::length(c - a) * (glm::length(q) + 1e-3 * glm::length(a));
    if (std::abs(quick) > 1e-12 * size) return quick > 0;
    return test::trueFacing(mesh, triangle, eye.point, eye.w) > 0;
}

using FacingScenes = test::SceneTest;

TEST_P(FacingScenes, NoTechniqueLosesAFrontFace) {
    Random random(131);
    size_t backs = 0, by_planes = 0, by_masks = 0, by_clusters = 0, by_bits = 0;
    for (const Mesh& source : scene->meshes) {
        const MeshView mesh{source.positions, source.indices};
        if (mesh.triangles() < 200) continue;
        const TrianglePlanes planes = makeTrianglePlanes(mesh);
        const NormalClasses classes = makeNormalClasses(mesh);
        // A mesh of many is cut without merging: that takes its time, and what is tested is the records.
        FacingPartition part;
        if (mesh.triangles() <= 20000) {
            part = mergeFacing(mesh);
        } else {
            part.triangles.resize(mesh.triangles());
            std::iota(part.triangles.begin(), part.triangles.end(), 0u);
            for (size_t i = 0; i < mesh.triangles(); i += 32)
                part.sizes.push_back(static_cast<uint32_t>(std::min<size_t>(32, mesh.triangles() - i)));
        }
        const FacingClusters clusters = describeClusters(mesh, part.triangles, part.sizes, {.mask_steps = 2});
        Box3d box;
        for (const glm::vec3& p : mesh.positions) box.grow(glm::dvec3(p));
        const double size = glm::length(box.max - box.min);
        const size_t bytes = (mesh.triangles() + 63) / 64 * 8;
        std::vector<uint8_t> plane_bits(bytes), mask_bits(bytes), cluster_bits((clusters.count() + 15) / 16 * 2);
        const int eyes = mesh.triangles() > 20000 ? 3 : 8;
        for (int e = 0; e < eyes; ++e) {
            View view;
            const glm::dvec3 from = box.center() + test::randomVector(random, e % 2 ? 0.6 * size : 2.0 * size);
            view.view = lookAt(from, box.center() + test::randomVector(random, 0.1 * size), {0, 1, 0});
            view.projection = e % 4 == 3 ? orthographic(size, 1.6, 0.01 * size, 10 * size)
                                         : perspective(glm::radians(60.0), 1.6, 0.01 * size);
            const FacingEye eye = facingEye(view, glm::dmat4(1.0));
            ASSERT_TRUE(eye.known());
            by_planes += findBackFaces(planes, eye, plane_bits);
            const SectorMasks sectors(view, glm::dmat4(1.0), eye.front, classes.cells, 4);
            by_clusters += findBackClusters(clusters, eye, kAllFacingTests, cluster_bits);
            for (size_t t = 0; t < mesh.triangles(); ++t) {
                const bool front = facesEye(mesh, t, eye);
                backs += !front && !isDegenerate(mesh, t);
                if (front) { ASSERT_FALSE(test::bitOf(plane_bits, t)) << source.name << " triangle " << t; }
                const int sector = sectors.sectorOf(mesh.positions[mesh.indices[3 * t]]);
                if (sector < 0) continue;
                const NormalMask& mask = sectors.mask(sector % 4, sector / 4);
                const bool masked = mask.bytes[classes.byte[t]] & classes.bit[t];
                by_masks += masked;
                if (front) { ASSERT_FALSE(masked) << source.name << " triangle " << t; }
            }
            for (size_t c = 0; c < clusters.count(); ++c) {
                const bool culled = test::bitOf(cluster_bits, c);
                const uint64_t* const bits = backTriangles(clusters, c, eye);
                for (uint32_t i = 0; i < clusters.size(c) && (culled || bits); ++i) {
                    const bool bit = bits && bits[i / 64] >> (i % 64) & 1;
                    by_bits += bit;
                    if (!culled && !bit) continue;
                    const uint32_t t = clusters.triangles[clusters.first[c] + i];
                    ASSERT_FALSE(facesEye(mesh, t, eye)) << source.name << " triangle " << t;
                }
            }
        }
    }
    EXPECT_GT(by_planes, backs * 9 / 10);
    EXPECT_GT(by_masks, 0u);
    EXPECT_GT(by_clusters, 0u);
    EXPECT_GT(by_bits, backs / 10);
}

INSTANTIATE_TEST_SUITE_P(Dense, FacingScenes,
                         testing::Values("dense-spot", "playcanvas-cave", "polyhaven-dutch-ship", "2CylinderEngine"),
                         test::sceneLabel);

}  // namespace
}  // namespace sightline
