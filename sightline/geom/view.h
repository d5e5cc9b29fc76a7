// A view: where the eye is, how it projects, and what the caller declares about the frame.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <limits>
#include <span>

#include "sightline/math/glm_types.h"
#include "sightline/geom/query_settings.h"

namespace sightline {

/// A few half spaces of the world: a point p is inside of a plane if dot(n, p) + d >= 0. Normals have any length. A
/// plane with a zero normal has everything inside or, if d < 0, nothing.
struct ViewPlanes {
    static constexpr uint32_t kMost = 8;

    glm::dvec4 planes[kMost]{};  ///< n and d
    uint32_t count = 0;          ///< [limit: <= kMost]

    /// @returns false if there is no room: nothing has changed
    bool add(const glm::dvec4& plane) {
        if (count >= kMost) return false;
        planes[count++] = plane;
        return true;
    }
    std::span<const glm::dvec4> all() const { return {planes, count}; }
};

/// A convex outline in the world that a view looks through.
struct ViewOutline {
    static constexpr uint32_t kMost = 8;

    glm::dvec3 points[kMost]{};  ///< flat, in either order of turn
    uint32_t count = 0;          ///< 0: there is none; else 3 or more  [limit: <= kMost]
};

/// One eye's view of a world for one frame.
///
/// Matrices are column-major with column vectors: clip = projection * view * world. Clip space is
/// OpenGL's: -w <= x, y, z <= w, y up, near at z = -w; setMatrices() of geom/clip_space.h takes those of
/// other conventions. The view must be rigid (rotation and translation); the projection may be perspective or
/// orthographic, off-centre, with a finite or an infinite far plane. A view that breaks a rule makes every object
/// visible; problemOf() says which.
struct View {
    glm::dmat4 view{1.0};        ///< world to eye                                [rigid]
    glm::dmat4 projection{1.0};  ///< eye to clip
    uint32_t width = 1280;       ///< of the viewport                             [pixels, >= 1]
    uint32_t height = 720;       ///<                                             [pixels, >= 1]
    double jitter = 0.5;         ///< largest shift of the image that the frame may use  [pixels, 0 to 1e6]
    uint32_t layers = ~0u;       ///< objects outside these layers are neither reported nor hide
    /// Radius of a region of eyes: the answer holds for every eye that is as close to this one, whichever way it looks.
    /// Only rows of visibility apply then and, in perspective, distances.  [world units, >= 0; 0: this eye alone]
    double eye_radius = 0;
    /// Cuts the world open: only what is inside of all these planes is drawn. Stage::kFrustum culls objects that lie
    /// wholly outside of one. An object that is cut hides only with parts that are left whole: the cut may show what it
    /// hid before.
    ViewPlanes sections;
    /// Limits the question to a part of the world, as what a portal or a rectangle of the image shows: Stage::kFrustum
    /// culls objects that lie wholly outside of one of these planes. Nothing is cut: an object that reaches inside is
    /// drawn whole, and hides as ever. A culled object hides nothing. See addWindow().
    ViewPlanes window;
    /// Sight lines begin on this outline, wherever the eye is, as in a mirror: mirroredView(). The stages of cells
    /// start from the cells that the outline touches. It cuts nothing, and the other stages ignore it: they have
    /// `sections` and `window`.
    ViewOutline through;
};

/// Right-handed, y up in clip space; up need not be orthogonal to the direction. If up is parallel
/// to the direction, another axis is taken.
glm::dmat4 lookAt(const glm::dvec3& eye, const glm::dvec3& target, const glm::dvec3& up);

/// @param fov_y   full vertical angle            [radians, in (0, pi)]
/// @param aspect  width / height
/// @param z_far   infinity for an infinite far plane
glm::dmat4 perspective(double fov_y, double aspect, double z_near,
                       double z_far = std::numeric_limits<double>::infinity());

/// @param height  full height of the view volume [world units]
/// z_far may be infinity, which stands for 2^31 world units here.
glm::dmat4 orthographic(double height, double aspect, double z_near, double z_far);

/// The eye of a perspective view, or, for an orthographic one, the origin of its eye space.
glm::dvec3 eyePosition(const View& view);

/// The same view from an eye so far to the right along the camera's own axis: an eye of a pair.  [world units]
View shiftedEye(const View& view, double right);

/// True if clip w is the same for all points: parallel projection.
bool isOrthographic(const View& view);

/// What keeps a view from being used.
enum class ViewProblem : uint8_t {
    kNone,
    kNotFinite,   ///< a matrix, a plane or a point of the outline
    kOutOfRange,  ///< a viewport without pixels, the jitter, the eye's radius, or how many planes or points there are
    kSingular,    ///< the projection cannot be inverted
    kRowMajor,    ///< the view's last row is not 0 0 0 1: most likely it is transposed
    kNotRigid,    ///< the view scales or shears
    kMirrors,     ///< the view mirrors: most likely its eye space is left-handed
    kReversed,    ///< depth runs towards the eye: most likely it is reversed
};
ViewProblem problemOf(const View& view);
/// The same in words, with what helps: "the view matrix scales or shears".
const char* wordsOf(ViewProblem problem);

/// True if z / w grows with the distance from the eye, so that the far plane stands behind the near one, as the culling
/// stages take it to. Reversed depth stands the other way round: what its near plane cuts away would hide.
/// @param view  isUsable(view)
bool runsOutward(const View& view);

/// True if it has no problem but, at most, that its depth is reversed.
bool isUsable(const View& view);

/// The stages that a query for this view uses. They are the settings' stages without distance and contribution if the
/// settings do not say how far and how small, without levels of detail if they name neither an error nor a budget, without the stages of cells if sections cut the world open, and of a
/// view that has an eye_radius those alone that View::eye_radius names.
uint32_t stagesInUse(const View& view, const QuerySettings& settings);

}  // namespace sightline
