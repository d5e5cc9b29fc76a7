// From meshes to the screen: transforms vertices, drops back faces and what lies outside, clips the rest.
// SPDX-License-Identifier: MIT
//
// James Blinn, Martin Newell. Clipping Using Homogeneous Coordinates. 1978.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/hidden/clip.h"
#include "sightline/hidden/draw_item.h"
#include "sightline/hidden/screen_polygon.h"

namespace sightline {

/// What became of the triangles that project() was asked for. They add up: triangles = rejected + back_facing + accepted
/// + clipped.
struct ProjectorCounters {
    uint64_t triangles = 0;
    uint64_t rejected = 0;     ///< outside the view volume, between the samples, or not finite
    uint64_t back_facing = 0;  ///< of single-sided triangles; edge-on ones too
    uint64_t accepted = 0;     ///< drawn as they are
    uint64_t clipped = 0;      ///< cut at the near plane, the far plane or the guard band
    uint64_t produced = 0;     ///< polygons to draw: accepted, and clipped where something was left
};

/// All arithmetic is in double and relative to the eye. Clips in homogeneous space at the near plane and, if finite, the
/// far plane, and at a guard band of four viewports. Facing is that of the plane and the eye; a transform of negative
/// determinant flips the winding.
class Projector {
public:
    Projector(const View& view, const SampleGrid& grid);

    /// Takes up an item: project() speaks of its triangles from now on.
    void begin(const DrawItem& item);

    /// A triangle of the item. False if nothing of it is to be drawn. Does not set ScreenPolygon::surface.
    bool project(size_t triangle, ScreenPolygon& out);

    const ProjectorCounters& counters() const { return counters_; }

    /// A plane of the world, dot(plane, (p, 1)) >= 0 inside, as it is seen: a surface's point at sample i of row j lies
    /// inside iff dot(result, (i, j, nearness, 1)) >= 0, with its nearness there.
    glm::dvec4 overSamples(const glm::dvec4& plane) const;

    bool orthographic() const { return orthographic_; }
    const glm::dvec3& eye() const { return eye_; }  ///< of a parallel view: the origin of its eye space

private:
    /// A vertex as projected, and which planes it lies outside of.
    struct Vertex {
        enum : uint8_t {
            kLeft = 1,
            kRight = 2,
            kBottom = 4,
            kTop = 8,
            kNear = 16,
            kFar = 32,
            kGuard = 64,
            kBroken = 128
        };
        static constexpr uint8_t kReject = kLeft | kRight | kBottom | kTop | kNear | kFar | kBroken;
        static constexpr uint8_t kClip = kNear | kFar | kGuard;

        glm::dvec4 clip{0.0};   ///< x, y, the near plane's distance z + w, w
        glm::dvec2 point{0.0};  ///< on the grid of samples, unless kClip says that it has none yet
        double eye_z = 0;
        uint8_t outside = 0;
    };

    glm::dvec2 pointOf(const glm::dvec4& clip) const {
        return (glm::dvec2(clip.x / clip.w, clip.y / clip.w) - start_) / scale_ + 0.5;
    }
    DepthPlane perspectivePlane(const glm::dvec3& gradient, const ClipPolygon& polygon) const;
    DepthPlane parallelPlane(const Vertex& a, const Vertex& b, const Vertex& c, const glm::dvec3& normal) const;

    bool orthographic_, mirrored_ = false, flipped_ = false;
    glm::dvec3 eye_;
    glm::dmat3 rotation_;
    glm::dmat4 projection_;
    glm::dvec2 scale_, start_, low_, high_;
    std::vector<Vertex> vertices_;
    const DrawItem* item_ = nullptr;
    ProjectorCounters counters_;
};

/// All polygons of a list that write depth, in the order of their surfaces.
std::vector<ScreenPolygon> projectAll(const DrawList& list, Projector& projector);

}  // namespace sightline
