// The triangles that rays may meet, in double, and a hierarchy of eight-wide nodes above them.
// SPDX-License-Identifier: MIT
//
// Ingo Wald, Carsten Benthin, Solomon Boulos. Getting Rid of Packets. 2008.
// Sven Woop, Carsten Benthin, Ingo Wald. Watertight Ray/Triangle Intersection. 2013.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/project/projector.h"
#include "sightline/tree/bvh.h"

namespace sightline::studies {

/// Points origin + t * direction, relative to the view's eye and turned like the world. t is clip w in perspective and
/// the depth in eye space in parallel views, so that it is the same function of the place for all rays of a view.
struct SampleRay {
    glm::dvec3 origin{0.0}, direction{0.0};
    double t_near = 0, t_far = 0;  ///< t_far may be infinite; t_near > t_far: the view sees nothing there
};

class SampleRays {
public:
    explicit SampleRays(const View& view);

    /// Through the centre of sample i of a row.
    SampleRay at(double row, double sample) const;

    /// t of a point relative to the eye is dot(depthAxis(), point).
    const glm::dvec3& depthAxis() const { return depth_axis_; }
    const glm::dvec3& eye() const { return eye_; }

private:
    bool parallel_;
    glm::dvec3 eye_, depth_axis_{0.0};
    glm::dvec3 origin_{0.0}, origin_per_sample_{0.0}, origin_per_row_{0.0};
    glm::dvec3 direction_{0.0}, direction_per_sample_{0.0}, direction_per_row_{0.0};
    glm::dvec4 near_{0.0}, far_{0.0};  ///< dot(plane, (p, 1)) >= 0 inside
};

/// Corners are relative to an origin of the scene's; counter-clockwise is front, mirrored items having been turned.
struct RayTriangle {
    glm::dvec3 a{0.0}, b{0.0}, c{0.0};
    uint32_t surface = 0;
    bool double_sided = false;
};

/// The triangles of a list that write depth and whose corners are finite, relative to the point of their box that is
/// nearest to the world's origin.
struct RayTriangles {
    glm::dvec3 origin{0.0};
    std::vector<RayTriangle> triangles;
    Box3d bounds;  ///< relative to the origin
};
/// @param settings  which side is the front, and whether backs are drawn
RayTriangles rayTriangles(const DrawList& list, const ProjectorSettings& settings = {});

struct RayHit {
    static constexpr uint32_t kNone = ~0u;

    double t = 0;
    uint32_t surface = kNone;
};

/// Whether a ray's line meets a triangle from a side that is drawn. Two triangles with a common edge are never both
/// missed along it: each decides by the same product with its sign turned.
/// @param from  the ray's origin, relative to the triangles'
/// @param axis  SampleRays::depthAxis()
/// @param t     where: between the corners' values, whatever rounding does
bool meets(const RayTriangle& triangle, const glm::dvec3& from, const glm::dvec3& direction, const glm::dvec3& axis,
           double& t);

/// A node or a triangle that a ray has yet to look into.
struct RayVisit {
    float enters = 0;  ///< at the earliest, from the ray's near end on
    uint32_t child = 0;
};

class RayTree {
public:
    explicit RayTree(const RayTriangles& triangles);

    /// The nearest within the ray's ends; of equally near ones the lower surface.
    /// @param ray    both ends finite
    /// @param stack  overwritten
    RayHit nearest(const SampleRays& rays, const SampleRay& ray, std::vector<RayVisit>& stack) const;

private:
    glm::dvec3 origin_;
    Bvh bvh_;
    std::vector<RayTriangle> triangles_;  ///< by place in the hierarchy
};

}  // namespace sightline::studies
