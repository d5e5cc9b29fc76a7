// Rays through the scene, by Embree: what a line of sight meets, and what it passes on its way.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/rays.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>

#include <embree3/rtcore.h>

namespace sightline::tools {
namespace {

/// Embree refuses rays that begin beyond about 1e18.
constexpr float kReach = 1e17f;

/// What the filter needs beyond Embree's own context, which comes first.
struct LookContext {
    RTCIntersectContext embree;
    RaySighting* sighting;
};

/// Objects are instances or, where they alone use their mesh, geometries of the world scene.
uint32_t objectOf(unsigned instance, unsigned geometry) {
    return instance != RTC_INVALID_GEOMETRY_ID ? instance : geometry;
}

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
            const uint32_t object = objectOf(RTCHitN_instID(arguments->hit, arguments->N, i, 0),
                                             RTCHitN_geomID(arguments->hit, arguments->N, i));
            context->sighting->passed.push_back({object, RTCRayN_tfar(arguments->ray, arguments->N, i)});
        }
    }
}

/// Throws what Embree complained of since the last time. A tree that was not built would let every ray pass, and a
/// witness that sees nothing convicts nobody.
void insist(RTCDevice device) {
    const RTCError error = rtcGetDeviceError(device);
    if (error == RTC_ERROR_OUT_OF_MEMORY) throw std::bad_alloc();
    if (error != RTC_ERROR_NONE) throw std::runtime_error("Embree failed with error " + std::to_string(error));
}

/// The triangles of one mesh, carried through an affine transform in double; mirrored ones are turned around.
RTCGeometry makeGeometry(RTCDevice device, const Mesh& mesh, const MeshFacts& facts, const glm::dmat4& transform) {
    const bool turned = glm::determinant(glm::dmat3(transform)) < 0;
    RTCGeometry geometry = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
    auto* vertices = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
        geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), mesh.positions.size()));
    if (!vertices) throw std::bad_alloc();
    for (size_t i = 0; i < mesh.positions.size(); ++i)
        vertices[i] = glm::vec3(glm::dvec3(transform * glm::dvec4(glm::dvec3(mesh.positions[i]), 1.0)));
    auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3,
                                                                   3 * sizeof(uint32_t), mesh.triangles()));
    if (!indices) throw std::bad_alloc();
    for (size_t i = 0; i < 3 * mesh.triangles(); i += 3) {
        indices[i] = mesh.indices[i];
        indices[i + 1] = mesh.indices[turned ? i + 2 : i + 1];
        indices[i + 2] = mesh.indices[turned ? i + 1 : i + 2];
    }
    rtcSetGeometryUserData(geometry, const_cast<MeshFacts*>(&facts));
    if (!facts.all_plain) rtcSetGeometryIntersectFilterFunction(geometry, passThrough);
    rtcCommitGeometry(geometry);
    return geometry;
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
    /// A mesh that several objects share, moved to its own centre so that float keeps its detail wherever it lies.
    RTCScene sharedScene(const SceneFacts& facts, uint32_t mesh) {
        RTCScene& scene = meshes[mesh];
        if (scene) return scene;
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        const MeshFacts& mesh_facts = facts.meshFacts(mesh);
        RTCGeometry geometry =
            makeGeometry(device, facts.scene().meshes[mesh], mesh_facts, translation(-mesh_facts.bounds.center()));
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        return scene;
    }

    /// @param transform  to the world relative to its centre
    RTCGeometry makeInstance(const SceneFacts& facts, uint32_t mesh, const glm::dmat4& transform) {
        const glm::dmat4 from_center = transform * translation(facts.meshFacts(mesh).bounds.center());
        float columns[12];
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) columns[3 * column + row] = static_cast<float>(from_center[column][row]);
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, sharedScene(facts, mesh));
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        return instance;
    }

    RTCDevice device = nullptr;
    RTCScene world = nullptr;
    std::vector<RTCScene> meshes;
    glm::dvec3 center{0.0};
    double rounding = 0;
};

// What throws here leaves Embree's things where they are: short of memory, it ends the process when it lets them go.
RayScene::RayScene(const SceneFacts& facts) : impl_(std::make_unique<Impl>()) {
    impl_->device = rtcNewDevice(nullptr);
    insist(impl_->device);
    impl_->world = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->world, RTC_SCENE_FLAG_ROBUST);
    impl_->center = facts.center();
    impl_->rounding = 4 * std::numeric_limits<float>::epsilon() * facts.radius();
    const Scene& scene = facts.scene();
    impl_->meshes.assign(scene.meshes.size(), nullptr);
    std::vector<uint32_t> users(scene.meshes.size(), 0);
    for (const SceneObject& object : scene.objects) ++users[object.mesh];
    for (uint32_t i = 0; i < scene.objects.size(); ++i) {
        if (facts.box(i).empty()) continue;
        const uint32_t mesh = scene.objects[i].mesh;
        glm::dmat4 transform = scene.objects[i].transform;
        transform[3] -= glm::dvec4(impl_->center, 0.0);
        // Objects that span the world, each with its own mesh, would make every ray enter every instance.
        RTCGeometry geometry = users[mesh] > 1 && invertible(transform)
                                   ? impl_->makeInstance(facts, mesh, transform)
                                   : makeGeometry(impl_->device, scene.meshes[mesh], facts.meshFacts(mesh), transform);
        rtcAttachGeometryByID(impl_->world, geometry, i);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(impl_->world);
    insist(impl_->device);
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
    sighting.object = met ? objectOf(hit.hit.instID[0], hit.hit.geomID) : RaySighting::kNone;
    sighting.t = met ? ray.t_near + hit.ray.tfar : ray.t_far;
    // The filter hears of surfaces in any order: those behind the end are not seen.
    std::erase_if(sighting.passed, [&](const RaySighting::Passed& passed) { return passed.t > hit.ray.tfar; });
}

double RayScene::rounding() const { return impl_->rounding; }

}  // namespace sightline::tools
