// What of a node or an object is held against shadows: its corners, and whether a certificate's parts hide them all.
// SPDX-License-Identifier: MIT
#include "sightline/stages/proof_bodies.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline::detail {
namespace {

double sum(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

Box3d doubled(const Box3f& box) { return {glm::dvec3(box.min), glm::dvec3(box.max)}; }

/// Whether the eye is surely behind a polygon.
/// @param corner  relative to the eye, each off by `error` at most
bool facesAway(const OccluderPolygon& polygon, const glm::dvec3 (&corner)[4], double flips, double error) {
    SIGHTLINE_DEBUG_ASSERT(error >= 0);
    for (int k = 2; k < polygon.corners(); ++k) {
        const glm::dvec3 a = corner[k - 1] - corner[0], b = corner[k] - corner[0];
        // Positive: the eye is in front. A volume of three edges, each off by twice the error, summed from six products.
        const double height = -flips * glm::dot(glm::cross(a, b), corner[0]);
        const double u = sum(a), v = sum(b), w = sum(corner[0]);
        const double slack =
            4.0 * error * (u * v + v * w + w * u + 4.0 * error * (u + v + w + error)) + 0x1p-48 * u * v * w;
        if (!(height < -slack)) return false;
    }
    return true;
}

}  // namespace

/// The polygons of an object, if what is drawn of it is no more than these; else null.
const Occluder* ProofMemory::shapeAt(const Frame& frame, uint32_t place) const {
    SIGHTLINE_DEBUG_ASSERT(place < frame.world->placed.size());
    const OccluderId shape = frame.world->placed[place].shape;
    if (shape.index == 0 || !frame.settings.second_look || frame.mayBeCoarse(place)) return nullptr;
    SIGHTLINE_DEBUG_ASSERT(shape.index < frame.world->occluders.size());
    return frame.world->occluders[shape.index].get();
}

/// In how many parts something is proved: an object of many polygons cluster by cluster.
uint32_t ProofMemory::clustersOf(const Frame& frame, Pending::Kind kind, uint32_t index) const {
    const Occluder* const shape = kind == Pending::Kind::kObject ? shapeAt(frame, index) : nullptr;
    if (!shape || shape->polygons.size() <= kMostPolygons || shape->clusters.size() > kMostClusters) return 1;
    return std::max<uint32_t>(1, static_cast<uint32_t>(shape->clusters.size()));
}

void ProofMemory::takeUpObject(const Frame& frame, uint32_t place, const Body& body) {
    const ObjectRecord& object = frame.world->objectAt(place);
    const glm::dvec3 shift = glm::dvec3(object.transform[3]) - frame.frustum.eye;
    const glm::dmat3 linear(object.transform);
    double size = sum(glm::dvec3(object.transform[3])) + sum(frame.frustum.eye);
    for (int axis = 0; axis < 3; ++axis)
        size += sum(linear[axis]) * std::max(std::abs(object.bounds.min[axis]), std::abs(object.bounds.max[axis]));
    corners_.error = view_.eye_error + 0x1p-49 * size;
    corners_.count = 0;
    const auto setBox = [&](const Box3d& box) {
        corners_.box = true;
        for (corners_.count = 0; corners_.count < 8; ++corners_.count)
            corners_.at[corners_.count] = linear * box.corner(corners_.count) + shift;
    };
    const Occluder* const shape = shapeAt(frame, place);
    const bool one = body.end - body.first == 1;
    if (!shape || body.form == Body::kWhole || (!one && shape->polygons.size() > kMostPolygons))
        return setBox(object.bounds);
    SIGHTLINE_DEBUG_ASSERT(body.first < body.end && body.end <= shape->clusters.size());
    if (body.form == Body::kBox) return setBox(doubled(shape->clusters[body.first].bounds));
    Box3d bounds;
    bool many = false;
    const double flips = glm::determinant(linear) < 0 ? -1 : 1;
    for (uint32_t i = body.first; i < body.end; ++i) {
        const OccluderCluster& cluster = shape->clusters[i];
        uint64_t used[(OccluderCluster::kMaxVertices + 63) / 64] = {};
        const auto at = [&](uint32_t v) {
            const uint32_t k = cluster.first_vertex + v;
            return glm::dvec3(shape->x[k], shape->y[k], shape->z[k]);
        };
        for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p) {
            if (body.form == Body::kPolygon && p != body.polygon) continue;
            const OccluderPolygon& polygon = shape->polygons[p];
            glm::dvec3 corner[4];
            for (int k = 0; k < polygon.corners(); ++k) corner[k] = linear * at(polygon.vertex[k]) + shift;
            ++polygons;
            if (!polygon.double_sided && facesAway(polygon, corner, flips, corners_.error)) continue;
            for (int k = 0; k < polygon.corners(); ++k)
                used[polygon.vertex[k] / 64] |= uint64_t{1} << polygon.vertex[k] % 64;
        }
        for (uint32_t v = 0; v < cluster.vertex_count; ++v) {
            if (!(used[v / 64] >> v % 64 & 1)) continue;
            bounds.grow(at(v));
            many = many || corners_.count == Uncovered::kMostCorners;
            if (!many) corners_.at[corners_.count++] = linear * at(v) + shift;
        }
    }
    SIGHTLINE_DEBUG_ASSERT(corners_.count <= Uncovered::kMostCorners);
    corners_.box = false;
    if (many) setBox(bounds);
}

bool ProofMemory::looksAway(const Frame& frame, const Pending& entry) const {
    if (entry.kind != Pending::Kind::kObject) return false;
    const Occluder* const shape = shapeAt(frame, entry.index);
    if (!shape || (!looks_away_ && shape->polygons.size() > kMostPolygons)) return false;
    const glm::dmat4& transform = frame.world->objectAt(entry.index).transform;
    const glm::dvec3 shift = glm::dvec3(transform[3]) - frame.frustum.eye;
    const glm::dmat3 linear(transform), to_object = glm::transpose(linear);
    const double flips = glm::determinant(linear) < 0 ? -1 : 1;
    // Of a point of the object's space: x and y in the image and w, and the height over the near plane.
    const auto rowOf = [&](const glm::dvec3& row, double more) {
        return glm::dvec4(to_object * row, glm::dot(row, shift) + more);
    };
    const glm::dvec4 x = rowOf(image_.x, 0), y = rowOf(image_.y, 0), w = rowOf(image_.w, 0),
                     near = rowOf(glm::dvec3(view_.near), view_.near.w);
    for (const OccluderCluster& cluster : shape->clusters)
        for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p) {
            const OccluderPolygon& polygon = shape->polygons[p];
            if (polygon.double_sided) continue;
            const auto at = [&](int k) {
                const uint32_t v = cluster.first_vertex + polygon.vertex[k];
                return glm::dvec3(shape->x[v], shape->y[v], shape->z[v]);
            };
            glm::dvec4 middle(at(0), 1.0);
            for (int k = 1; k < polygon.corners(); ++k) middle += glm::dvec4(at(k), 1.0);
            const double wide = glm::dot(w, middle);
            if (!(std::abs(glm::dot(x, middle)) < wide && std::abs(glm::dot(y, middle)) < wide)) continue;
            if (glm::dot(near, middle) < 0) continue;
            const glm::dvec3 from = linear * at(0) + shift;
            if (flips * glm::dot(glm::cross(linear * (at(1) - at(0)), linear * (at(2) - at(0))), from) > 0) return true;
        }
    return false;
}

/// Finds the corners of a node's box, or of a body of an object.
void ProofMemory::takeUp(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, const Body& body) {
    SIGHTLINE_DEBUG_ASSERT(kind != Pending::Kind::kCluster);
    if (kind == Pending::Kind::kObject) return takeUpObject(frame, index, body);
    corners_.box = true;
    corners_.error = view_.place_error;
    for (corners_.count = 0; corners_.count < 8; ++corners_.count) {
        const glm::dvec3 corner = doubled(box).corner(corners_.count);
        corners_.at[corners_.count] = corner;
        corners_.error = std::max(corners_.error, view_.place_error + 0x1p-23 * sum(corner));  // rounded to float
    }
}

/// Whether a certificate's parts hide the body at hand. If not, what is left of it stays for more, unless that cannot be
/// told from the eye: then `rest_` has nothing.
bool ProofMemory::hiddenBy(const Frame& frame, const Certificate& certificate, const Body& body) {
    rest_.clear();
    SIGHTLINE_DEBUG_ASSERT(possible_ && corners_.count <= Uncovered::kMostCorners && corners_.error >= 0);
    if (corners_.count == 0) {
        looks_away_ = true;
        return true;
    }
    for (const uint32_t hider : certificate.all()) {
        const Shadow* const shadow = shadowOf(frame, hider);
        if (shadow && shadow->holds(corners_.at, corners_.count, corners_.error)) return true;
    }
    if (body.form == Body::kWhole) return false;
    if (!rest_.begin(view_, image_, corners_.at, corners_.count, corners_.error, corners_.box)) {
        rest_.clear();
        return false;
    }
    for (uint32_t i = 0; i < certificate.count && !rest_.nothing(); ++i)
        if (const Shadow* shadow = shadowOf(frame, certificate.hiders[i])) rest_.take(*shadow);
    return rest_.nothing();
}

/// Whether a certificate holds.
bool ProofMemory::isCovered(const Frame& frame, const Certificate& certificate, Pending::Kind kind, uint32_t index,
                            const Box3f& box) {
    looks_away_ = false;
    return forEachBody(frame, kind, index, certificate.closely, [&](const Body& body) {
        takeUp(frame, kind, index, box, body);
        return hiddenBy(frame, certificate, body);
    });
}

}  // namespace sightline::detail
