// The frustum stage beside plainer ways to do the same.
// SPDX-License-Identifier: MIT
#include <glm/gtc/constants.hpp>

#include "bench/cases.h"
#include "bench/flat_boxes.h"
#include "bench/frustum_walks.h"
#include "sightline/base/random.h"
#include "sightline/query/query.h"
#include "sightline/tools/scene/building/building.h"
#include "sightline/tools/scene/city/city.h"

namespace sightline::bench {
namespace {

std::vector<Box3d> randomBoxes(size_t count) {
    Random random(1);
    std::vector<Box3d> boxes;
    boxes.reserve(count);
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec3 p(random.uniform(-1000, 1000), random.uniform(-1000, 1000), random.uniform(-1000, 1000));
        boxes.push_back({p, p + glm::dvec3(random.uniform(0.5, 4), random.uniform(0.5, 4), random.uniform(0.5, 4))});
    }
    return boxes;
}

struct PlainPlane {
    float n[3], d;
};

std::vector<PlainPlane> plainPlanes(const Frustum& frustum) {
    std::vector<PlainPlane> planes;
    for (uint32_t i = 0; i < frustum.count; ++i) {
        const glm::dvec4& p = frustum.planes[i];
        const double d = p.w - glm::dot(glm::dvec3(p), frustum.eye);
        planes.push_back({{float(p.x), float(p.y), float(p.z)}, float(d)});
    }
    return planes;
}

/// All eight corners against each plane, one box after the other.
size_t cullByCorners(const std::vector<PlainPlane>& planes, const std::vector<Box3f>& boxes,
                     std::vector<uint32_t>& kept) {
    size_t count = 0;
    for (size_t i = 0; i < boxes.size(); ++i) {
        bool outside = false;
        for (const PlainPlane& plane : planes) {
            bool all = true;
            for (int corner = 0; corner < 8 && all; ++corner) {
                float sum = plane.d;
                for (int axis = 0; axis < 3; ++axis)
                    sum += plane.n[axis] * (corner >> axis & 1 ? boxes[i].max[axis] : boxes[i].min[axis]);
                all = sum < 0;
            }
            outside |= all;
        }
        if (!outside) kept[count++] = static_cast<uint32_t>(i);
    }
    return count;
}

/// The corner farthest inside each plane, one box after the other.
size_t cullByPVertex(const std::vector<PlainPlane>& planes, const std::vector<Box3f>& boxes,
                     std::vector<uint32_t>& kept) {
    size_t count = 0;
    for (size_t i = 0; i < boxes.size(); ++i) {
        bool outside = false;
        for (const PlainPlane& plane : planes) {
            float sum = plane.d;
            for (int axis = 0; axis < 3; ++axis)
                sum += plane.n[axis] * (plane.n[axis] > 0 ? boxes[i].max[axis] : boxes[i].min[axis]);
            if (sum < 0) {
                outside = true;
                break;
            }
        }
        if (!outside) kept[count++] = static_cast<uint32_t>(i);
    }
    return count;
}

}  // namespace

Table benchFrustum(const Options& options) {
    const std::vector<Box3d> boxes = options.scene ? objectBoxes(*options.scene) : randomBoxes(1000000);
    std::vector<Box3f> plain;
    World world;
    for (const Box3d& box : boxes) {
        plain.push_back(roundOutward(box, glm::dvec3(0.0)));
        ObjectDef def;
        def.bounds = box;
        world.add(def);
    }
    const Snapshot now = world.commit();
    FlatBoxes flat(boxes);
    Box3d all;
    for (const Box3d& box : boxes) all.grow(box);
    View view;
    view.view = lookAt(all.center(), all.center() + glm::dvec3(1, 0.1, 0.3), {0, 1, 0});
    view.projection = perspective(glm::radians(60.0), 16.0 / 9.0, 0.1);
    const Frustum frustum = makeFrustum(view);
    const std::vector<PlainPlane> planes = plainPlanes(frustum);
    std::vector<uint32_t> kept(boxes.size() + 16);
    Query query;
    size_t by_query = 0, by_flat = 0;
    const std::vector<double> times = threadTimes(
        {[&] { cullByCorners(planes, plain, kept); }, [&] { cullByPVertex(planes, plain, kept); },
         [&] { by_flat = cullFrustum(frustum, flat.arrays, flat.kept); },
         [&] { by_query = query.visible(now, view, {.stages = stageBit(Stage::kFrustum)}).objects.size(); }},
        options.repeat ? options.repeat : 15);
    const std::string where = options.scene ? options.scene->name : "1,000,000 boxes";
    const double per_box = 1e3 / static_cast<double>(std::max<size_t>(boxes.size(), 1));
    Table table{"frustum", {}};
    const Rows row{table, where, "ns/box", per_box};
    row("p-vertex, one by one", times[1], "eight corners, one by one", times[0]);
    row("flat, SIMD", times[2], "eight corners, one by one", times[0]);
    row("flat, SIMD", times[2], "p-vertex, one by one", times[1]);
    row("hierarchy, plane masks, whole query", times[3], "eight corners, one by one", times[0]);
    row("hierarchy, plane masks, whole query", times[3], "flat, SIMD", times[2]);
    row("kept by the hierarchy", by_query, "boxes", "kept by the flat list", by_flat);
    const FrustumWorld measured{where, boxes, flat, view, options.repeat ? options.repeat : 15};
    addHierarchyRows(measured, table);
    addCoherencyRows(measured, table);
    addRefinementRows(measured, table);
    addBoundRows(measured, table);
    return table;
}

}  // namespace sightline::bench
