// Rays through the scene, by Embree: what a line of sight meets, and what it passes on its way.
// SPDX-License-Identifier: MIT
#include "sightline/tools/truth/rays.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <new>
#include <stdexcept>
#include <string>
#include <utility>

#include <embree3/rtcore.h>

#include "sightline/tools/truth/near_groups.h"

namespace sightline::tools {
namespace {

/// Embree refuses rays that begin beyond about 1e18.
constexpr double kReach = 1e17;
/// Of the sum of the sizes that a place on a surface is computed from: of the ray's origin, of its way, and of the corners.
/// Each coordinate of them is rounded by 2^-24 of itself, and the arithmetic adds some as much; this is 8 times that.
constexpr double kFloatRounding = 4 * std::numeric_limits<float>::epsilon();

/// What the filter needs beyond Embree's own context, which comes first.
struct LookContext {
    RTCIntersectContext embree;
    const uint32_t* objects;  // of the group
    RaySighting* sighting;
};

/// The number of an object in its group. Objects are instances or, where they alone use their mesh, geometries of the
/// group's scene.
uint32_t numberOf(unsigned instance, unsigned geometry) {
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
            const uint32_t number = numberOf(RTCHitN_instID(arguments->hit, arguments->N, i, 0),
                                             RTCHitN_geomID(arguments->hit, arguments->N, i));
            context->sighting->passed.push_back(
                {context->objects[number], RTCRayN_tfar(arguments->ray, arguments->N, i)});
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

/// Where a ray comes within `slack` of a box, at 0 or later; infinite: nowhere before its end.
double entryOf(const glm::dvec3& origin, const glm::dvec3& direction, double end, const Box3d& box, double slack) {
    double from = 0, to = end;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis] - slack - origin[axis], high = box.max[axis] + slack - origin[axis];
        if (direction[axis] == 0) {
            if (low > 0 || high < 0) return std::numeric_limits<double>::infinity();
            continue;
        }
        const double a = low / direction[axis], b = high / direction[axis];
        from = std::max(from, std::min(a, b));
        to = std::min(to, std::max(a, b));
    }
    return from <= to + 1e-12 * std::abs(to) ? from : std::numeric_limits<double>::infinity();
}

/// A transform to a frame whose origin lies elsewhere.
glm::dmat4 relativeTo(const glm::dvec3& middle, glm::dmat4 transform) {
    transform[3] -= glm::dvec4(middle, 0.0);
    return transform;
}

}  // namespace

struct RayScene::Impl {
    struct Group {
        NearGroup near;
        RTCScene scene = nullptr;
    };

    explicit Impl(const SceneFacts& of) : facts(of) {}

    /// A mesh that several objects share, moved to its own middle so that float keeps its detail wherever it lies.
    RTCScene sharedScene(uint32_t mesh) {
        RTCScene& scene = meshes[mesh];
        if (scene) return scene;
        scene = rtcNewScene(device);
        rtcSetSceneFlags(scene, RTC_SCENE_FLAG_ROBUST);
        RTCGeometry geometry =
            makeGeometry(device, facts.scene().meshes[mesh], facts.meshFacts(mesh), translation(-middles[mesh]));
        rtcAttachGeometry(scene, geometry);
        rtcReleaseGeometry(geometry);
        rtcCommitScene(scene);
        return scene;
    }

    /// @param transform  to the world relative to the group's middle
    RTCGeometry makeInstance(uint32_t mesh, const glm::dmat4& transform) {
        const glm::dmat4 from_middle = transform * translation(middles[mesh]);
        float columns[12];
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row) columns[3 * column + row] = static_cast<float>(from_middle[column][row]);
        RTCGeometry instance = rtcNewGeometry(device, RTC_GEOMETRY_TYPE_INSTANCE);
        rtcSetGeometryInstancedScene(instance, sharedScene(mesh));
        rtcSetGeometryTransform(instance, 0, RTC_FORMAT_FLOAT3X4_COLUMN_MAJOR, columns);
        rtcCommitGeometry(instance);
        return instance;
    }

    void build(Group& group, const std::vector<uint32_t>& users) {
        group.scene = rtcNewScene(device);
        rtcSetSceneFlags(group.scene, RTC_SCENE_FLAG_ROBUST);
        for (uint32_t i = 0; i < group.near.objects.size(); ++i) {
            const SceneObject& object = facts.scene().objects[group.near.objects[i]];
            const glm::dmat4 transform = relativeTo(group.near.middle, object.transform);
            // Objects that span the world, each with its own mesh, would make every ray enter every instance.
            RTCGeometry geometry =
                users[object.mesh] > 1 && invertible(transform)
                    ? makeInstance(object.mesh, transform)
                    : makeGeometry(device, facts.scene().meshes[object.mesh], facts.meshFacts(object.mesh), transform);
            rtcAttachGeometryByID(group.scene, geometry, i);
            rtcReleaseGeometry(geometry);
        }
        rtcCommitScene(group.scene);
    }

    /// The largest distance from a group's middle of what float rounded of a triangle: its corners, and of an instance the
    /// place of its mesh.
    double reachOf(const Group& group, uint32_t object, uint32_t triangle, bool is_instance) const {
        const Mesh& mesh = facts.mesh(object);
        const glm::dmat4 transform = relativeTo(group.near.middle, facts.scene().objects[object].transform);
        const auto distance = [&](const glm::dvec3& point) {
            return glm::length(glm::dvec3(transform * glm::dvec4(point, 1.0)));
        };
        double reach = is_instance ? distance(middles[facts.scene().objects[object].mesh]) : 0;
        for (size_t k = 0; k < 3; ++k)
            reach = std::max(reach, distance(glm::dvec3(mesh.positions[mesh.indices[3 * size_t{triangle} + k]])));
        return reach;
    }

    /// @param end  where the ray ends so far, from the near plane on; receives where it does now
    void look(const Group& group, const SightRay& ray, const glm::dvec3& eye, float& end, RaySighting& sighting) const {
        LookContext context;
        rtcInitIntersectContext(&context.embree);
        context.embree.flags = RTC_INTERSECT_CONTEXT_FLAG_COHERENT;
        context.objects = group.near.objects.data();
        context.sighting = &sighting;
        const glm::vec3 origin(ray.origin + ray.t_near * ray.direction + (eye - group.near.middle));
        RTCRayHit hit{};
        hit.ray.org_x = origin.x;
        hit.ray.org_y = origin.y;
        hit.ray.org_z = origin.z;
        hit.ray.dir_x = static_cast<float>(ray.direction.x);
        hit.ray.dir_y = static_cast<float>(ray.direction.y);
        hit.ray.dir_z = static_cast<float>(ray.direction.z);
        hit.ray.tfar = end;
        hit.ray.mask = ~0u;
        hit.hit.geomID = RTC_INVALID_GEOMETRY_ID;
        hit.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
        rtcIntersect1(group.scene, &context.embree, &hit);
        if (hit.hit.geomID == RTC_INVALID_GEOMETRY_ID) return;
        end = hit.ray.tfar;
        sighting.object = group.near.objects[numberOf(hit.hit.instID[0], hit.hit.geomID)];
        sighting.t = ray.t_near + end;
        const bool is_instance = hit.hit.instID[0] != RTC_INVALID_GEOMETRY_ID;
        const double reach = reachOf(group, sighting.object, hit.hit.primID, is_instance);
        sighting.rounding = kFloatRounding * (glm::length(glm::dvec3(origin)) + end + reach);
    }

    /// Group after group as the ray enters them, until it ends.
    void lookInOrder(const glm::dvec3& origin, const SightRay& ray, const glm::dvec3& eye, float& end,
                     RaySighting& sighting) const {
        const double slack = 1e-12 * (std::abs(origin.x) + std::abs(origin.y) + std::abs(origin.z));
        std::array<std::pair<double, uint32_t>, kMostNearGroups> entered;
        size_t count = 0;
        for (uint32_t i = 0; i < groups.size(); ++i) {
            const double at = entryOf(origin, ray.direction, end, groups[i].near.box, slack);
            if (std::isfinite(at)) entered[count++] = {at, i};
        }
        std::sort(entered.begin(), entered.begin() + static_cast<std::ptrdiff_t>(count));
        for (size_t i = 0; i < count && entered[i].first <= end; ++i)
            look(groups[entered[i].second], ray, eye, end, sighting);
    }

    const SceneFacts& facts;
    RTCDevice device = nullptr;
    std::vector<glm::dvec3> middles;  // of meshes
    std::vector<RTCScene> meshes;
    std::vector<Group> groups;
};

// What throws here leaves Embree's things where they are: short of memory, it ends the process when it lets them go.
RayScene::RayScene(const SceneFacts& facts) : impl_(std::make_unique<Impl>(facts)) {
    impl_->device = rtcNewDevice(nullptr);
    insist(impl_->device);
    const Scene& scene = facts.scene();
    impl_->meshes.assign(scene.meshes.size(), nullptr);
    for (const Mesh& mesh : scene.meshes) impl_->middles.push_back(medianCorner(mesh));
    std::vector<uint32_t> users(scene.meshes.size(), 0);
    for (const SceneObject& object : scene.objects) ++users[object.mesh];
    for (NearGroup& near : nearGroups(facts, impl_->middles)) {
        impl_->groups.push_back({std::move(near), nullptr});
        impl_->build(impl_->groups.back(), users);
    }
    insist(impl_->device);
}

RayScene::~RayScene() {
    for (const Impl::Group& group : impl_->groups) rtcReleaseScene(group.scene);
    for (RTCScene mesh : impl_->meshes)
        if (mesh) rtcReleaseScene(mesh);
    rtcReleaseDevice(impl_->device);
}

void RayScene::look(const SightRay& ray, const glm::dvec3& eye, RaySighting& sighting) const {
    sighting.passed.clear();
    sighting.object = RaySighting::kNone;
    sighting.t = ray.t_near;
    sighting.rounding = 0;
    const glm::dvec3 origin = ray.origin + ray.t_near * ray.direction + eye;
    const glm::dvec3 size = glm::abs(origin);
    // Also refuses what is not a number.
    if (!(size.x < kReach && size.y < kReach && size.z < kReach && ray.t_near < ray.t_far)) return;
    sighting.t = ray.t_far;
    float end = static_cast<float>(std::min(ray.t_far - ray.t_near, 1e30));
    if (impl_->groups.size() == 1) impl_->look(impl_->groups[0], ray, eye, end, sighting);
    else impl_->lookInOrder(origin, ray, eye, end, sighting);
    // The filter hears of surfaces in any order: those behind the end are not seen.
    std::erase_if(sighting.passed, [&](const RaySighting::Passed& passed) { return passed.t > end; });
}

}  // namespace sightline::tools
