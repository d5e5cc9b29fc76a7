// The opaque triangles near a cell, and the sheet of them that is the wall of one of its faces.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/marked/flat_pieces.h"
#include "sightline/geom/convex_region.h"
#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bake {
using namespace tools;

/// In the world; counter-clockwise is front.
struct WallTriangle {
    glm::dvec3 corners[3];
    uint32_t object = 0;
    bool both = false;  ///< double-sided
    /// How far the corners of two surfaces that were meant to meet may be apart, of coordinates as large as its own in its
    /// object: four units in the last place of the file's floats.  [world units]
    double rounding = 0;
};

/// The objects that hide: opaque, not deforming, and not among those that may be elsewhere.
class OpaqueWalls {
public:
    /// @param scene    must outlive this
    /// @param movable  of Scene::objects
    OpaqueWalls(const Scene& scene, std::span<const uint32_t> movable);

    /// Opaque triangles whose boxes meet a box.
    void gather(const Box3d& box, std::vector<WallTriangle>& triangles) const;

private:
    const Scene& scene_;
    std::vector<uint32_t> objects_;
    std::vector<Box3d> bounds_;  ///< of `objects_`
};

/// A frame of coordinates in a plane.
class FlatFrame {
public:
    /// @param normal  of length 1; pieces are counter-clockwise as seen from its tip
    FlatFrame(const glm::dvec3& origin, const glm::dvec3& normal);

    glm::dvec2 to(const glm::dvec3& point) const {
        return {glm::dot(u_, point - origin_), glm::dot(v_, point - origin_)};
    }
    /// Above the plane through the origin.
    double heightOf(const glm::dvec3& point) const { return glm::dot(normal_, point - origin_); }
    glm::dvec3 from(const glm::dvec2& point, double height = 0) const {
        return origin_ + point.x * u_ + point.y * v_ + height * normal_;
    }
    FlatPiece to(std::span<const glm::dvec3> outline) const;
    std::vector<glm::dvec3> from(const FlatPiece& piece, double height = 0) const;

private:
    glm::dvec3 origin_, normal_, u_, v_;
};

/// A triangle as seen from the tip of the normal; empty if its back is seen, or nothing.
FlatPiece frontOf(const FlatFrame& frame, const WallTriangle& triangle);

/// The plane of the sheet of triangles that covers most of a face. The sheet is nearly parallel to the face and nowhere
/// farther from it than `reach`; none if it covers less than half of the face.
/// @param face   of a cell, counter-clockwise as seen from inside
/// @param plane  of the face, inward
/// @param open   parts of it where there need not be any, in the frame of `frame`
/// @param reach  how far it may be  [world units]
/// @param slit   triangles that are no farther from one plane are in one sheet
std::optional<glm::dvec4> sheetNear(std::span<const glm::dvec3> face, const glm::dvec4& plane, const FlatFrame& frame,
                                    std::span<const FlatPiece> open, std::span<const WallTriangle> triangles,
                                    double reach, double slit);

}  // namespace sightline::bake
