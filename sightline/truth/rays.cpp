// Rays through the scene, by Embree: what a line of sight meets, and what it passes on its way.
// SPDX-License-Identifier: MIT
#include "sightline/truth/rays.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <embree3/rtcore.h>

namespace sightline {
namespace {

/// Embree refuses rays that begin beyond about 1e18.
constexpr float kReach = 1e17f;

/// What the filter needs beyond Embree's own context, which comes first.
struct LookContext {
    RTCIntersectContext embree;
    RaySighting* sighting;
};

/// Refuses back faces, and notes and refuses what hides nothing. Facing is judged in object space, where a mirrored
/// instance needs no exception.
void passThrough(const RTCFilterFunctionNArguments* arguments) {
    const auto* facts = static_cast<const MeshFacts*>(arguments->geometryUserPtr);
    auto* context = reinterpret_cast<LookContext*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        const uint32_t triangle = RTCHitN_primID(arguments->hit, arguments->N, i);
        const glm::vec3 direction(RTCRayN_dir_x(arguments->ray, arguments->N, i),
                                  RTCRayN_dir_y(arguments->ray, arguments->N, i),
                                  RTCRayN_dir_z(arguments->ray, arguments->N, i));
        const glm::vec3 normal(RTCHitN_Ng_x(arguments->hit, arguments->N, i),
                               RTCHitN_Ng_y(arguments->hit, arguments->N, i),
                               RTCHitN_Ng_z(arguments->hit, arguments->N, i));
        const bool front = glm::dot(direction, normal) < 0;
        if (!front && facts->double_sided[triangle] == 0) {
            arguments->valid[i] = 0;
        } else if (facts->hides[triangle] == 0) {
            arguments->valid[i] = 0;
            context->sighting->passed.push_back({RTCHitN_instID(arguments->hit, arguments->N, i, 0),
                                                 RTCRayN_tfar(arguments->ray, arguments->N, i)});
        }
    }
}

/// A scene of one mesh, carried through an affine transform in double.
/// @param turned  exchange two corners of each triangle
RTCScene makeMesh(RTCDevice device, const Mesh& mesh, const MeshFacts& facts, const glm::dmat4& transform,
                  bool turned) {
    RTCScene scene = rtcNewScene(device);
    rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        vertices[i] = glm::vec3(glm::dvec3(transform * glm::dvec4(glm::dvec3(mesh.positions[i]), 1.0)));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), mesh.triangles()));
    for (size_t i = 0; i < 3 * mesh.triangles(); i += 3) {
        indices[i] = mesh.indices[i];
        indices[i + 1] = mesh.indices[turned ? i + 2 : i + 1];
        indices[i + 2] = mesh.indices[turned ? i + 1 : i + 2];
    }
    rtcSetGeometryUserData(geometry, const_cast<MeshFacts*>(&facts));
    if (!facts.all_plain) rtcSetGeometryIntersectFilterFunction(geometry, passThrough);
    rtcCommitGeometry(geometry);
    rtcAttachGeometry(scene, geometry);
    rtcReleaseGeometry(geometry);
    rtcCommitScene(scene);
    return scene;
}

glm::dmat4 translation(const glm::dvec3& by) {
    glm::dmat4 transform(1.0);
    transform[3] = glm::dvec4(by, 1.0);
    return transform;
}

/// False for transforms that flatten, or nearly: rays cannot be carried back through them in float.
bool invertible(const glm::dmat4& transform) {
    const glm::dmat3 linear(transform);
    const double size = glm::length(linear[0]) * glm::length(linear[1]) * glm::length(linear[2]);
    const double longest = std::max({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    const double shortest = std::min({glm::length(linear[0]), glm::length(linear[1]), glm::length(linear[2])});
    return longest < 1e12 && shortest > 1e-12 && shortest > 1e-4 * longest &&
           std::abs(glm::determinant(linear)) > 1e-4 * size;
}

}  // namespace

struct RayScene::Impl {
    /// The object's own scene if it needs one, and the transform of its instance, relative to the centre.
    RTCScene sceneOf(const SceneFacts& facts, uint32_t index, glm::dmat4& transform) {
        const SceneObject& object = facts.scene().objects[index];
        const Mesh& mesh = facts.mesh(index);
        const MeshFacts& mesh_facts = facts.facts(index);
        transform = object.transform;
        transform[3] -= glm::dvec4(center, 0.0);
        if (!invertible(transform)) {
            const bool turned = glm::determinant(glm::dmat3(transform)) < 0;
            meshes.push_back(makeMesh(device, mesh, mesh_facts, transform, turned));
            transform = glm::dmat4(1.0);
            return meshes.back();
        }
        // A mesh is moved to its own centre, so that float keeps its detail wherever it lies.
        const glm::dvec3 mesh_center = mesh_facts.bounds.center();
        transform = transform * translation(mesh_center);
        RTCScene& shared = meshes[object.mesh];
        if (!shared) shared = makeMesh(device, mesh, mesh_facts, translation(-mesh_center), false);
        return shared;
    }

    RTCDevice device = nullptr;
    RTCScene world = nullptr;
    std::vector<RTCScene> meshes;  ///< by mesh, then those of single objects
    glm::dvec3 center{0.0};
    double rounding = 0;
};

RayScene::RayScene(const SceneFacts& facts) : impl_(std::make_unique<Impl>()) {
    impl_->device = rtcNewDevice(nullptr);
    impl_->world = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->world, RTC_SCENE_FLAG_ROBUST);
    impl_->center = facts.center();
    impl_->rounding = 4 * std::numeric_limits<float>::epsilon() * facts.radius();
    const Scene& scene = facts.scene();
    impl_->meshes.assign(scene.meshes.size(), nullptr);
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (facts.box(i).empty()) continue;
        glm::dmat4 transform;
        RTCScene mesh = impl_->sceneOf(facts, i, transform);
        float columns[12];
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                columns[3 * column + row] = static_cast<float>(transform[column][row]);
        RTCGeometry instance = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, mesh);
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        rtcAttachGeometryByID(impl_->world, instance, i);
        rtcReleaseGeometry(instance);
    }
    rtcCommitScene(impl_->world);
}

RayScene::~RayScene() {
    rtcReleaseScene(impl_->world);
    for (RTCScene mesh : impl_->meshes)
        if (mesh) rtcReleaseScene(mesh);
    rtcReleaseDevice(impl_->device);
}

void RayScene::look(const SightRay& ray, const glm::dvec3& eye, RaySighting& sighting) const {
    sighting.passed.clear();
    LookContext context;
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    context.sighting = &sighting;
    sighting.object = RaySighting::kNone;
    sighting.t = ray.t_near;
    const glm::vec3 origin(ray.origin + ray.t_near * ray.direction + (eye - impl_->center));
    // Also refuses what is not a number.
    const glm::vec3 size = glm::abs(origin);
    if (!(size.x < kReach && size.y < kReach && size.z < kReach && ray.t_near < ray.t_far)) return;
    RTCRayHit hit{};
    hit.ray.org_x = origin.x;
    hit.ray.org_y = origin.y;
    hit.ray.org_z = origin.z;
    hit.ray.dir_x = static_cast<float>(ray.direction.x);
    hit.ray.dir_y = static_cast<float>(ray.direction.y);
    hit.ray.dir_z = static_cast<float>(ray.direction.z);
    const double length = std::min(ray.t_far - ray.t_near, 1e30);
    hit.ray.tfar = static_cast<float>(length);
    hit.ray.mask = ~0u;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->world, &context.embree, &hit);
    const bool met = hit.hit.geomID != RTC_INVALID_GEOMETRY_ID;
    sighting.object = met ? hit.hit.instID[0] : RaySighting::kNone;
    sighting.t = met ? ray.t_near + hit.ray.tfar : ray.t_far;
    // The filter hears of surfaces in any order: those behind the end are not seen.
    std::erase_if(sighting.passed, [&](const RaySighting::Passed& passed) { return passed.t > hit.ray.tfar; });
}

double RayScene::rounding() const { return impl_->rounding; }

}  // namespace sightline
