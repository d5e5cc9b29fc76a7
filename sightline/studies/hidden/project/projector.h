// From meshes to the screen: transforms vertices, drops back faces and what lies outside, clips the rest.
// SPDX-License-Identifier: MIT
//
// James Blinn, Martin Newell. Clipping Using Homogeneous Coordinates. 1978.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/project/clip.h"
#include "sightline/studies/hidden/project/facing.h"
#include "sightline/studies/hidden/project/homogeneous.h"
#include "sightline/studies/hidden/project/screen_polygon.h"

namespace sightline::studies {

/// What became of the triangles that project() was asked for. They add up: triangles = rejected + back_facing + accepted
/// + clipped.
struct ProjectorCounters {
    uint64_t triangles = 0;
    uint64_t rejected = 0;     ///< outside the view volume, between the samples, or not finite
    uint64_t back_facing = 0;  ///< of single-sided triangles; edge-on ones too
    uint64_t accepted = 0;     ///< drawn as they are
    uint64_t clipped = 0;      ///< cut at the near plane, the far plane, the guard band or the sides
    uint64_t produced = 0;     ///< polygons to draw: accepted, and clipped where something was left
    uint64_t spared = 0;       ///< of the accepted: outside in part, but not clipped
};

/// What is done about triangles that lie outside of the view volume in part.
enum class Clipping : uint8_t {
    kGuardBand,  ///< cut at the near and the far plane; at the sides only if they reach beyond a band far outside
    kFrustum,    ///< cut at all six planes
    kClipless,   ///< not cut: edge functions in homogeneous space, by the z-buffer alone
                 ///< (projectHomogeneous()); other methods clip at the guard band
};

struct ProjectorSettings {
    Clipping clipping = Clipping::kGuardBand;
    double guard_band = 4.0;  ///< distance of the band's planes from the centre [half viewports, > 1]
    FrontFace front_face = FrontFace::kCounterClockwise;
    FacingTest facing_test = FacingTest::kHomogeneous;
    bool cull_back_faces = true;  ///< false: the backs of single-sided triangles are drawn, too
};

/// All arithmetic is in double and relative to the eye. Clips in homogeneous space at the near plane and, if finite, the
/// far plane, and at a guard band of four half viewports, if not told otherwise. Facing is that of the plane and the eye;
/// a transform of negative determinant flips the winding.
class Projector {
public:
    Projector(const View& view, const SampleGrid& grid, const ProjectorSettings& settings = {});

    /// Takes up an item: project() speaks of its triangles from now on.
    void begin(const DrawItem& item);

    /// A triangle of the item. False if nothing of it is to be drawn. Does not set ScreenPolygon::surface.
    bool project(size_t triangle, ScreenPolygon& out);

    /// The same without clipping, for scanHomogeneous(): nothing is counted as clipped. Of facing tests, that of the
    /// screen's area gives way to the determinant.
    bool projectHomogeneous(size_t triangle, HomogeneousTriangle& out);

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
    bool isBack(size_t triangle, double side, bool flipped) const {
        const bool double_sided = !item_->double_sided.empty() && item_->double_sided[triangle] != 0;
        return !double_sided && settings_.cull_back_faces && (side > 0) == flipped;
    }
    bool isBackByPlane(size_t triangle) const;
    bool clip(ClipPolygon& polygon) const;
    DepthPlane perspectivePlane(const glm::dvec3& gradient, const ClipPolygon& polygon) const;
    DepthPlane parallelPlane(const Vertex& a, const Vertex& b, const Vertex& c, const glm::dvec3& normal) const;

    bool orthographic_, mirrored_ = false, flipped_ = false;
    bool eye_mirrored_ = false, eye_flipped_ = false;  ///< the same before the projection
    ProjectorSettings settings_;
    SampleGrid grid_;
    uint8_t clip_mask_ = Vertex::kClip;
    glm::dvec4 planes_[ClipPolygon::kMaxPlanes];
    int plane_count_ = 0;
    glm::dvec3 eye_;
    glm::dmat3 rotation_;
    glm::dmat4 projection_;
    glm::dvec2 scale_, start_, low_, high_;
    std::vector<Vertex> vertices_;
    std::vector<glm::dvec3> in_eye_space_;  ///< the vertices, if the facing test asks for them
    const DrawItem* item_ = nullptr;
    ProjectorCounters counters_;
};

/// All polygons of a list that write depth, in the order of their surfaces.
std::vector<ScreenPolygon> projectAll(const DrawList& list, Projector& projector);

}  // namespace sightline::studies
