// The laws of preparation on real scenes: what architects, modellers and scanners left in their meshes.
// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <string>

#include "sightline/prepare/occluder/occluder.h"
#include "tests/prepare/occluder/patch_laws.h"
#include "tests/support/shared_scenes.h"

namespace sightline {
namespace {

/// What an occluder hides with: its area, and the sum of its polygons' area times normal.
struct Surface {
    double area = 0;
    glm::dvec3 facing{0.0};
    uint32_t polygons = 0;
};

Surface surfaceOf(const Occluder& o) {
    Surface out;
    for (const OccluderCluster& c : o.clusters)
        for (uint32_t p = 0; p < c.polygon_count; ++p, ++out.polygons) {
            const OccluderPolygon& polygon = o.polygons[c.first_polygon + p];
            const auto at = [&](int k) { return glm::dvec3(positionOf(o, c, polygon.vertex[k])); };
            for (int k = 2; k < polygon.corners(); ++k) {
                const glm::dvec3 n = 0.5 * glm::cross(at(k - 1) - at(0), at(k) - at(0));
                out.area += glm::length(n);
                out.facing += n;
            }
        }
    return out;
}

TEST(PreparedScenes, KeepTheLaws) {
    for (const char* name : {"bsi-duplex", "cityjson-vienna", "gazebo-willowgarage", "bimwhale-tall-building"}) {
        const auto scene = test::sharedScene(name);
        if (!scene) GTEST_SKIP() << "no scenes beside the repository";
        uint32_t before = 0, after = 0, closed = 0, edges = 0;
        for (size_t m = 0; m < scene->meshes.size(); ++m) {
            SCOPED_TRACE(::testing::Message() << name << ", mesh " << m);
            const MeshView mesh{scene->meshes[m].positions, scene->meshes[m].indices};
            const Occluder plain = prepareOccluder(mesh, {}, {}, {.rings = false, .merge = false});
            const Occluder full = prepareOccluder(mesh, {}, {}, {.own_polygons = 64, .rings = true, .merge = true});
            for (const Occluder* o : {&plain, &full}) { expectOccluderLaws(*o); }
            const Surface p = surfaceOf(plain), f = surfaceOf(full);
            EXPECT_NEAR(f.area, p.area, 1e-9 * p.area);
            EXPECT_LE(glm::distance(f.facing, p.facing), 1e-9 * p.area);
            before += p.polygons;
            after += f.polygons;
            edges += static_cast<uint32_t>(full.edges.size());
            for (const OccluderEdge& edge : full.edges) closed += edge.right != OccluderEdge::kNone;
        }
        EXPECT_LT(after, before) << name;
        EXPECT_GT(2 * closed, edges) << name;
    }
}

}  // namespace
}  // namespace sightline
