// From the plain values of the C interface to the library's own, checked.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstring>
#include <span>
#include <tuple>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/c/impl/handles.h"
#include "sightline/c/query.h"
#include "sightline/geom/image_rect.h"
#include "sightline/geom/mesh_view.h"
#include "sightline/geom/setting_rows.h"
#include "sightline/geom/view.h"
#include "sightline/math/box.h"
#include "sightline/world/world_object.h"

namespace sightline::c {

inline glm::dvec3 vec(const double v[3]) { return {v[0], v[1], v[2]}; }
inline Box3d box(const slBox& from) { return {vec(from.low), vec(from.high)}; }
inline slBox box(const Box3d& from) {
    return {{from.min.x, from.min.y, from.min.z}, {from.max.x, from.max.y, from.max.z}};
}
/// Null is the identity.
glm::dmat4 matrix(const double m[16]);
/// A matrix whose last row is not 0 0 0 1.
bool isProjective(const double m[16]);
inline constexpr char kProjective[] =
    "the transform is not affine: its last row is not 0 0 0 1. Matrices are column-major: is it transposed?";

inline ObjectId id(slObjectId from) { return {from.index, from.generation}; }
inline slObjectId id(ObjectId from) { return {from.index, from.generation}; }
inline slVisible visible(const Visible& from) { return {from.key, id(from.id)}; }

/// What a caller wrote into a field of an enumeration, whatever it is.
template <class Enumeration>
uint32_t numberOf(const Enumeration& field) {
    uint32_t number = 0;
    static_assert(sizeof field == sizeof number);
    std::memcpy(&number, &field, sizeof number);
    return number;
}

/// Copies the settings from one structure to the other, either way: all but the windows, whose types differ.
template <class From, class To>
void copySettings(const From& from, To& to) {
    static_assert(std::tuple_size_v<decltype(kQuerySettings)> == 31, "slQuerySettings lacks a setting");
    to.stages = from.stages;
    to.portal_depth = from.portal_depth;
    to.portal_work = from.portal_work;
    to.max_distance = from.max_distance;
    to.max_distance_fov = from.max_distance_fov;
    to.contribution = from.contribution;
    to.hysteresis = from.hysteresis;
    to.occluder_volumes = from.occluder_volumes;
    to.occluder_triangles = from.occluder_triangles;
    to.occlusion_size = from.occlusion_size;
    to.masked = from.masked;
    to.occluder_error = from.occluder_error;
    to.close_gaps = from.close_gaps;
    to.faces = from.faces;
    to.second_look = from.second_look;
    to.second_look_polygons = from.second_look_polygons;
    to.cluster_gap = from.cluster_gap;
    to.lod_error = from.lod_error;
    to.lod_fade = from.lod_fade;
    to.budget = from.budget;
    to.hard_budget = from.hard_budget;
    to.cost_object = from.cost_object;
    to.cost_triangle = from.cost_triangle;
    to.cost_vertex = from.cost_vertex;
    to.cost_pixel = from.cost_pixel;
    to.bins = from.bins;
    to.unasked_answers = from.unasked_answers;
    to.proofs = from.proofs;
    to.stateless = from.stateless;
    to.time_stages = from.time_stages;
}

/// The library's arrays as the caller reads them: the same numbers in the same places.
const slVisible* visibles(std::span<const Visible> from);
const slRect* rects(std::span<const ImageRect> from);
inline slRect rect(const ImageRect& from) { return {from.left, from.top, from.right, from.bottom}; }

/// Copies what fits. SL_NO_ROOM if there is more.
template <class T>
slStatus copyOut(std::span<const T> from, T* out, size_t capacity, size_t* count_out) {
    const size_t fits = from.size() < capacity ? from.size() : capacity;
    std::copy_n(from.data(), fits, out);
    *count_out = from.size();
    return fits < from.size() ? SL_NO_ROOM : SL_OK;
}

/// Says what is wrong with a view or with settings. The view itself may yet be one that hides nothing.
slStatus toView(const slView* from, const slLog& log, const char* call, View& view_out);
slStatus toSettings(const slQuerySettings* from, const slLog& log, const char* call, QuerySettings& settings_out);

/// A caller's mesh as the library reads it; what lies otherwise is copied.
struct MeshCopy {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    MeshView view;
};
slStatus toMesh(const slMesh& from, const slLog& log, const char* call, MeshCopy& mesh_out);

}  // namespace sightline::c
