// Embree beside our own hierarchy; compiled only where Embree is there.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/rays/raycast_embree.h"

#include <cstdint>
#include <new>

#include <embree3/rtcore.h>

namespace sightline::studies {
namespace {

/// What the filter needs beyond Embree's own context, which comes first.
struct RayContext {
    RTCIntersectContext embree;
    glm::dvec3 from{0.0}, direction{0.0};
};

/// Refuses the back faces of single-sided triangles, and what is seen edge-on.
void passBackFaces(const RTCFilterFunctionNArguments* arguments) {
    const auto* triangles = static_cast<const RayTriangle*>(arguments->geometryUserPtr);
    const auto* context = reinterpret_cast<const RayContext*>(arguments->context);
    for (unsigned i = 0; i < arguments->N; ++i) {
        if (arguments->valid[i] == 0) continue;
        const RayTriangle& triangle = triangles[RTCHitN_primID(arguments->hit, arguments->N, i)];
        const glm::dvec3 normal = glm::cross(triangle.b - triangle.a, triangle.c - triangle.a);
        const double away = glm::dot(normal, context->direction);
        if (away == 0 || (away > 0 && !triangle.double_sided)) arguments->valid[i] = 0;
    }
}

}  // namespace

struct EmbreeTree::Impl {
    RTCDevice device = nullptr;
    RTCScene scene = nullptr;
    RayTriangles triangles;
    glm::dvec3 middle{0.0};  ///< of the triangles' box, where float has most to give
};

// What throws here leaves Embree's things where they are: short of memory, it ends the process when it lets them go.
EmbreeTree::EmbreeTree(RayTriangles triangles) : impl_(std::make_unique<Impl>()) {
    impl_->triangles = std::move(triangles);
    impl_->device = rtcNewDevice(nullptr);
    if (!impl_->device) throw std::bad_alloc();
    impl_->scene = rtcNewScene(impl_->device);
    rtcSetSceneFlags(impl_->scene, RTC_SCENE_FLAG_ROBUST);
    const std::vector<RayTriangle>& all = impl_->triangles.triangles;
    if (!all.empty()) {
        impl_->middle = impl_->triangles.bounds.center();
        RTCGeometry geometry = rtcNewGeometry(impl_->device, RTC_GEOMETRY_TYPE_TRIANGLE);
        auto* corners = static_cast<glm::vec3*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_VERTEX, 0, RTC_FORMAT_FLOAT3, sizeof(glm::vec3), 3 * all.size()));
        auto* indices = static_cast<uint32_t*>(rtcSetNewGeometryBuffer(
            geometry, RTC_BUFFER_TYPE_INDEX, 0, RTC_FORMAT_UINT3, 3 * sizeof(uint32_t), all.size()));
        if (!corners || !indices) throw std::bad_alloc();
        for (const RayTriangle& triangle : all)
            for (const glm::dvec3& corner : {triangle.a, triangle.b, triangle.c})
                *corners++ = glm::vec3(corner - impl_->middle);
        for (uint32_t i = 0; i < 3 * all.size(); ++i) indices[i] = i;
        rtcSetGeometryUserData(geometry, const_cast<RayTriangle*>(all.data()));
        rtcSetGeometryIntersectFilterFunction(geometry, passBackFaces);
        rtcCommitGeometry(geometry);
        rtcAttachGeometry(impl_->scene, geometry);
        rtcReleaseGeometry(geometry);
    }
    rtcCommitScene(impl_->scene);
    if (rtcGetDeviceError(impl_->device) != RTC_ERROR_NONE) throw std::bad_alloc();
}

EmbreeTree::~EmbreeTree() {
    rtcReleaseScene(impl_->scene);
    rtcReleaseDevice(impl_->device);
}

RayHit EmbreeTree::nearest(const SampleRays& rays, const SampleRay& ray) const {
    RayContext context;
    rtcInitIntersectContext(&context.embree);
    context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
    context.from = ray.origin + (rays.eye() - impl_->triangles.origin);
    context.direction = ray.direction;
    RayHit result;
    const glm::vec3 origin(context.from - impl_->middle + ray.t_near * ray.direction);
    const glm::vec3 size = glm::abs(origin);
    // Embree refuses rays that begin beyond about 1e18, and this refuses what is not a number as well.
    if (!(size.x < 1e17f && size.y < 1e17f && size.z < 1e17f && ray.t_near <= ray.t_far)) return result;
    RTCRayHit hit{};
    hit.ray.org_x = origin.x;
    hit.ray.org_y = origin.y;
    hit.ray.org_z = origin.z;
    hit.ray.dir_x = static_cast<float>(ray.direction.x);
    hit.ray.dir_y = static_cast<float>(ray.direction.y);
    hit.ray.dir_z = static_cast<float>(ray.direction.z);
    hit.ray.tfar = static_cast<float>(ray.t_far - ray.t_near);
    hit.ray.mask = ~0u;
    hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
    hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
    rtcIntersect1(impl_->scene, &context.embree, &hit);
    if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return result;
    return {ray.t_near + hit.ray.tfar, impl_->triangles.triangles[hit.hit.primID].surface};
}

}  // namespace sightline::studies
