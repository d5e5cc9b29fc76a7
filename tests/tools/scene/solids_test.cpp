// The city's solids are closed, outward, and small.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/solids.h"

#include <map>
#include <tuple>
#include <utility>

#include <gtest/gtest.h>

#include "sightline/tools/scene/city/library.h"

namespace sightline::tools::city {
namespace {

using Edge = std::pair<std::tuple<float, float, float>, std::tuple<float, float, float>>;

/// What is solid in a mesh: opaque and drawn from one side.
struct Solid {
    std::map<Edge, int> edges;  ///< directed, by position
    double volume = 0;
    size_t triangles = 0;
};

Solid solidOf(const Mesh& mesh, const std::vector<Material>& materials) {
    Solid solid;
    for (const Primitive& primitive : mesh.primitives) {
        const Material& material = materials[primitive.material];
        if (!material.hides() || material.double_sided) continue;
        for (uint32_t t = primitive.first_triangle; t < primitive.first_triangle + primitive.triangle_count; ++t) {
            glm::dvec3 corners[3];
            std::tuple<float, float, float> points[3];
            for (uint32_t k = 0; k < 3; ++k) {
                const glm::vec3& p = mesh.positions[mesh.indices[3 * t + k]];
                corners[k] = glm::dvec3(p);
                points[k] = {p.x, p.y, p.z};
            }
            for (int k = 0; k < 3; ++k) ++solid.edges[{points[k], points[(k + 1) % 3]}];
            solid.volume += glm::dot(corners[0], glm::cross(corners[1], corners[2])) / 6;
            ++solid.triangles;
        }
    }
    return solid;
}

void expectClosed(const Mesh& mesh, const std::vector<Material>& materials, uint64_t seed) {
    const Solid solid = solidOf(mesh, materials);
    for (const auto& [edge, count] : solid.edges) {
        const auto reverse = solid.edges.find({edge.second, edge.first});
        ASSERT_EQ(count, 1) << mesh.name << ", seed " << seed << ": an edge is used twice, near x "
                            << std::get<0>(edge.first) << ", y " << std::get<1>(edge.first);
        ASSERT_NE(reverse, solid.edges.end()) << mesh.name << ", seed " << seed << ": an open edge near x "
                                              << std::get<0>(edge.first) << ", y " << std::get<1>(edge.first);
    }
    EXPECT_TRUE(solid.triangles == 0 || solid.volume > 0) << mesh.name << ", seed " << seed << ": inside out";
}

TEST(CityMesh, SolidsAreClosedAndOutward) {
    for (const uint64_t seed : {0, 1, 2, 3, 4, 5, 6, 7}) {
        const Library library = makeLibrary(seed);
        for (size_t i = 0; i < library.meshes.size(); ++i)
            if (i > kGroundSmall) expectClosed(library.meshes[i], library.materials, seed);
    }
}

TEST(CityMesh, MeshesAreWholeAndWithinTheirSizes) {
    for (const uint64_t seed : {1, 99}) {
        const Library library = makeLibrary(seed);
        EXPECT_GE(library.buildings.size(), 24u);
        EXPECT_LE(library.buildings.size(), 48u);
        for (size_t i = 0; i < library.meshes.size(); ++i) {
            const Mesh& mesh = library.meshes[i];
            const bool building = i >= kItemCount;
            EXPECT_GE(mesh.triangles(), building ? 60u : 12u) << mesh.name;
            EXPECT_LE(mesh.triangles(), building ? 150u : 60u) << mesh.name << ", seed " << seed;
            uint32_t covered = 0;
            for (const Primitive& primitive : mesh.primitives) {
                EXPECT_EQ(primitive.first_triangle, covered) << mesh.name;
                EXPECT_LT(primitive.material, library.materials.size()) << mesh.name;
                covered += primitive.triangle_count;
            }
            EXPECT_EQ(covered, mesh.triangles()) << mesh.name;
            Box3d bounds;
            for (const glm::vec3& position : mesh.positions) bounds.grow(glm::dvec3(position));
            EXPECT_EQ(bounds.min, mesh.bounds.min) << mesh.name;
            EXPECT_EQ(bounds.max, mesh.bounds.max) << mesh.name;
            for (const uint32_t index : mesh.indices) ASSERT_LT(index, mesh.positions.size()) << mesh.name;
        }
    }
}

TEST(CityMesh, FurnitureDoesNotDependOnTheSeed) {
    const Library a = makeLibrary(1), b = makeLibrary(2);
    for (size_t i = 0; i < kItemCount; ++i) EXPECT_EQ(a.meshes[i].positions, b.meshes[i].positions) << a.meshes[i].name;
    ASSERT_EQ(a.meshes.size(), b.meshes.size());
}

TEST(CityMesh, EveryKindOfMaterialOccurs) {
    const Library library = makeLibrary(1);
    std::map<AlphaMode, int> triangles;
    int opaque_double_sided = 0;
    for (const Mesh& mesh : library.meshes)
        for (const Primitive& primitive : mesh.primitives) {
            const Material& material = library.materials[primitive.material];
            triangles[material.alpha_mode] += static_cast<int>(primitive.triangle_count);
            if (material.hides() && material.double_sided) ++opaque_double_sided;
        }
    EXPECT_GT(triangles[AlphaMode::kOpaque], 0);
    EXPECT_GT(triangles[AlphaMode::kMask], 0);
    EXPECT_GT(triangles[AlphaMode::kBlend], 0);
    EXPECT_GT(opaque_double_sided, 0);
}

TEST(CityMesh, TriangulationCoversThePolygonOnce) {
    // An L with vertices on straight lines, as walls with bays leave them.
    const std::vector<glm::dvec2> outline{{0, 0}, {1, 0}, {2, 0}, {6, 0}, {6, 2}, {4, 2},
                                          {3, 2}, {2, 2}, {2, 5}, {0, 5}, {0, 3}};
    const auto triangles = triangulate(outline);
    EXPECT_EQ(triangles.size(), outline.size() - 2);
    double sum = 0;
    for (const auto& [a, b, c] : triangles) {
        const glm::dvec2 ab = outline[b] - outline[a], ac = outline[c] - outline[a];
        const double twice = ab.x * ac.y - ab.y * ac.x;
        EXPECT_GT(twice, 0);
        sum += 0.5 * twice;
    }
    EXPECT_DOUBLE_EQ(sum, 18);
}

}  // namespace
}  // namespace sightline::tools::city
