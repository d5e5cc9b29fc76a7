// The clusters of one object's triangles: their edges, and from where each is seen from its backs alone.
// SPDX-License-Identifier: MIT
#include "apps/viewer/object_clusters.h"

#include <algorithm>

#include "sightline/cull/facing_clusters.h"
#include "sightline/geom/convex_region.h"
#include "sightline/prepare/facing/draw_clusters.h"
#include "sightline/studies/hidden/shade/light.h"

namespace sightline::viewer {
using namespace tools;
namespace {

constexpr glm::vec3 kBackInk(0.35f, 0.35f, 0.4f), kVolumeInk(1.0f, 0.35f, 0.8f);

DrawClusters clustersOf(const Scene& scene, const Mesh& mesh) {
    if (mesh.deforms || mesh.triangles() == 0 || mesh.triangles() > ObjectClusters::kMostTriangles)
        return DrawClusters();
    std::vector<MeshPart> parts;
    for (const Primitive& primitive : mesh.primitives)
        parts.push_back({primitive.first_triangle, primitive.triangle_count,
                         scene.materials[primitive.material].double_sided,
                         scene.materials[primitive.material].hides()});
    return prepareDrawClusters({mesh.positions, mesh.indices}, parts);
}

}  // namespace

ObjectClusters::ObjectClusters(const Scene& scene, uint32_t object)
    : scene_(scene), object_(object), clusters_(clustersOf(scene, scene.meshes[scene.objects[object].mesh])) {}

/// A byte for each cluster.
std::vector<uint8_t> ObjectClusters::backOf(const View& view) const {
    std::vector<uint8_t> back(count(), 0), bits((withBacks() + 15) / 16 * 2);
    if (withBacks() == 0) return back;
    const FacingEye eye = facingEye(view, scene_.objects[object_].transform);
    findBackClusters(clusters_.facing, eye, kVolumeTest, bits);
    for (size_t i = 0; i < withBacks(); ++i) back[i] = bits[i / 8] >> (i % 8) & 1;
    return back;
}

size_t ObjectClusters::back(const View& view) const {
    const std::vector<uint8_t> back = backOf(view);
    return static_cast<size_t>(std::count(back.begin(), back.end(), 1));
}

void ObjectClusters::addEdges(const View& view, LineDrawer& lines) const {
    const SceneObject& of = scene_.objects[object_];
    const Mesh& mesh = scene_.meshes[of.mesh];
    const std::vector<uint8_t> back = backOf(view);
    for (size_t cluster = 0; cluster < count(); ++cluster) {
        const glm::vec3 ink = back[cluster] ? kBackInk : glm::vec3(studies::hashedColour(cluster));
        for (uint32_t i = clusters_.first[cluster]; i < clusters_.first[cluster + 1]; ++i) {
            glm::dvec3 corners[3];
            for (size_t k = 0; k < 3; ++k)
                corners[k] = of.transform *
                             glm::dvec4(mesh.positions[mesh.indices[3 * size_t{clusters_.triangles[i]} + k]], 1.0);
            lines.outline(corners, ink);
        }
    }
}

void ObjectClusters::addVolume(size_t cluster, LineDrawer& lines) const {
    const SceneObject& of = scene_.objects[object_];
    const FacingClusters& facing = clusters_.facing;
    const CullingVolume volume = facing.volume(cluster);
    const glm::dvec3 origin = facing.origin + glm::dvec3(volume.origin);
    const Box3d& box = scene_.meshes[of.mesh].bounds;
    std::vector<glm::dvec4> planes = planesOfBox({box.min - box.size(), box.max + box.size()});
    // The sum of max(most * q, least * q) is the largest of eight sums: each must not be above `back`.
    for (int signs = 0; signs < 8; ++signs) {
        glm::dvec3 normal;
        for (int axis = 0; axis < 3; ++axis)
            normal[axis] = static_cast<double>((signs >> axis & 1 ? volume.most : volume.least)[axis]);
        const double length = glm::length(normal);
        if (!(length > 0)) continue;
        planes.emplace_back(-normal / length, (static_cast<double>(volume.back) + glm::dot(normal, origin)) / length);
    }
    const ConvexRegion region = convexRegion(planes);
    if (region.kind != ConvexRegion::Kind::kSolid) return;
    for (const RegionFace& face : region.faces) {
        std::vector<glm::dvec3> outline;
        for (const glm::dvec3& corner : face.outline) outline.emplace_back(of.transform * glm::dvec4(corner, 1.0));
        lines.outline(outline, kVolumeInk);
    }
}

}  // namespace sightline::viewer
