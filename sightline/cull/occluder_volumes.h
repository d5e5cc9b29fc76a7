// Hides boxes in the shadow volumes of a few large convex occluders, in object space: no pixels.
// SPDX-License-Identifier: MIT
//
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
// Tom Hudson, Dinesh Manocha, Jonathan Cohen, Ming Lin, Kenneth Hoff, Hansong Zhang. Accelerated Occlusion Culling Using
// Shadow Frusta. 1997.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/buffer/screen.h"
#include "sightline/cull/frustum.h"
#include "sightline/cull/volume_parts.h"

namespace sightline {

/// What all volumes of a view have in common.
struct VolumeView {
    Screen screen;
    bool usable = false;        ///< false: the projection's rays do not meet in the eye; there are no volumes
    glm::dvec3 direction{0.0};  ///< of the rays of a parallel view  [unit length]
    glm::dvec4 near{0.0};       ///< the row of the near plane, of unit normal: near.(q, 1) >= near_guard is drawn
    double near_guard = 0;      ///< [world units]
    double eye_error = 0;       ///< bound on the rounding of the eye  [world units]
    double place_error = 0;     ///< bound on the rounding of boxes' places relative to the eye  [world units]
    double pixels_at_one = 0;   ///< pixels of the buffer per steradian, or per square world unit in parallel views
};

/// @param view    isUsable(view)
/// @param offset  tree origin - eye: where the boxes that will be asked come from  [world units]
VolumeView makeVolumeView(const View& view, const Screen& screen, const glm::dvec3& offset);

/// An object whose parts may make volumes: its place, and how exactly that is known.
struct VolumePlace {
    const VolumeParts* parts = nullptr;
    glm::dmat3 linear{1.0}, covector{1.0};  ///< object to world; of normals, to scale
    glm::dvec3 shift{0.0};                  ///< object's origin - eye
    glm::dvec3 eye{0.0};                    ///< in object space; the direction of the rays, in a parallel view. Rounded
    glm::dvec3 extent{0.0};                 ///< no corner is farther from the object's origin on any axis
    double norm = 0;                        ///< bound on what the transform stretches by
    double error = 0;                       ///< bound on the rounding of a corner relative to the eye  [world units]
    bool flips = false, usable = false;
};
VolumePlace placeParts(const VolumeView& view, const VolumeParts& parts, const Box3f& bounds,
                       const glm::dmat4& transform);

/// How much of the buffer a part can cover at most, about; for choosing.  [pixels]
double roughPixels(const VolumeView& view, const VolumePlace& place, uint32_t part);

/// A convex region behind an occluder, for one view: whatever lies wholly in it is hidden.
///
/// The planes are q -> dot(normal, q) + distance, for positions q relative to the eye. A point is in the volume if each
/// plane is above slack[0] + slack[1] * |q| there.
///
/// Why nothing in it can be seen. Let F be the occluding polygons of the part that are taken for front faces, and let
/// the ray be the line from the eye (in parallel views: against their direction) to a point p of the volume.
///
/// 1. The ray meets a front face of F. Project everything onto a plane from the eye. (One on whose far side all of F and
///    p lie: parallel to the face that the eye is farthest in front of; makeVolume() looks at each corner.) The number of
///    counter-clockwise polygons of F around an image point less the clockwise ones is the winding number of F's
///    boundary around it: sides that two of them share cancel. Each plane through the eye and a side of the boundary has
///    p on its inner side, so that p sees each side turn counter-clockwise by less than half a turn; a sum of positive
///    angles that is a multiple of the full turn is at least one turn. So a counter-clockwise polygon, a front face,
///    holds the image point, whether or not F was chosen well. Corners of the boundary are left out only where the chord
///    keeps p outside of the convex hull of what it cuts off: there the winding number stays.
/// 2. It does so before p: the point h where it meets the face lies in the hull of the face's corners. p is farther
///    than all of them in the direction that looks from the face's front to its back, in which the ray rises.
/// 3. h is drawn. N, the distance from the near plane, must not be negative at h. Where a face has a corner nearer than
///    the guard g, a plane through the eye keeps p where it must be: with S(q) = dot(n, q) + c, zero or less on all of the
///    face and c at the eye, take G = N - g + k S with k so that G vanishes at the eye (in parallel views: so that it
///    does not change along the rays). G(h) is then a positive multiple of G(p) (or equal to it), so that G(p) > 0
///    makes N(h) > g - k S(h) >= g. So the near plane need not be clipped at, and an occluder may reach behind the eye.
///    Other planes of the frustum do not matter: h is on the ray of p, and is in view if p is. Nor does the shift of the
///    image that the caller declares: it does not move the eye.
/// 4. h may itself be hidden, and its object culled: what hides it on the same ray is nearer, of finitely many
///    polygons, and the nearest of them all is drawn. So occluders need not be visible.
///
/// Rounding: corners are known within VolumePlace::error; each plane's slack holds what that, and the plane's own
/// rounding, can turn it by; testVolume() adds the rounding of float and of the boxes. Equality is visible.
struct OccluderVolume {
    static constexpr uint32_t kMaxPlanes = 24;
    static constexpr uint32_t kMaxSides = 12;
    static constexpr uint32_t kMaxOutline = 2 * VolumeParts::kMaxCorners;

    uint32_t planes = 0;
    float normal[kMaxPlanes][3];
    float distance[kMaxPlanes];
    float slack[kMaxPlanes][2];
    uint32_t allPlanes() const { return (1u << planes) - 1; }
};

/// The outline of a volume's occluder, for measuring: corners relative to the eye.
struct VolumeOutline {
    glm::dvec3 corner[OccluderVolume::kMaxOutline];
    uint32_t count = 0;
};

/// @param part     of VolumeParts::part()
/// @param outline  filled if the volume is made
/// @returns false if the part shows no front face, or if the volume's planes would be known too badly
bool makeVolume(const VolumeView& view, const VolumePlace& place, uint32_t part, OccluderVolume& volume,
                VolumeOutline& outline);

/// Two faces with sides that lie exactly on one line and run opposite ways.
struct VolumeSeam {
    uint32_t face[2] = {};  ///< in VolumeParts::faces, of one object and of the same or another one
    uint32_t side[2] = {};  ///< of its outline: from this corner to the next
};

/// Finds such sides, by exact predicates on where the corners stand.
/// @returns false also where it is not known exactly where they stand: objects that are not only moved or turned by right
///          angles, unless their transforms are the same
bool findSeam(const VolumeParts& one, const glm::dmat4& transform, const VolumeParts& other,
              const glm::dmat4& other_transform, VolumeSeam& seam);

/// The volume of what lies behind two faces close to the line where they meet: their planes, but for those of the two
/// sides. Perspective views.
///
/// Why nothing in it can be seen. The planes through the eye and the two sides are one plane, of which each face claims the
/// half that the other one does not: the sides run opposite ways, and both faces are seen from the side that their outlines
/// run around counter-clockwise, or both from the other one. So a point that is above all other planes is, with that one, in the volume of the
/// one face or of the other; on the plane itself, in both.
/// @param seam  findSeam() has found it, for where the objects stand now
bool makeSeamVolume(const VolumeView& view, const VolumePlace& one, const VolumePlace& other, const VolumeSeam& seam,
                    OccluderVolume& volume);

/// The part of an outline that is in view.  [pixels of the buffer]
double visiblePixels(const VolumeView& view, const VolumeOutline& outline);

/// Whether a volume holds the whole outline: the occluder there hides nothing that this one does not hide.
bool holds(const OccluderVolume& volume, const VolumeOutline& outline);

/// What eight boxes are to a volume.
struct VolumeAnswer {
    uint32_t hidden = 0;   ///< bit per box: wholly in the volume
    uint32_t outside = 0;  ///< bit per box: no point of it is in the volume
    uint32_t planes[8];    ///< per box that is neither: bit per plane that it is not surely above
};

/// Tests boxes against the planes named in `active`; planes that hold a parent wholly need not be asked again.
/// A box that touches a plane, or that rounding might place on it, is not hidden; nor is a NaN.
/// @param wanted  bit per box that is asked about; the others' bits stay clear
VolumeAnswer testVolume(const OccluderVolume& volume, const EyeBoxes& boxes, uint32_t active, uint32_t wanted = 0xff);

/// About which share of each of eight boxes lies in a volume, as if its planes cut the boxes independently of one another;
/// for choosing.
/// @param share  [size: 8, aligned to 64 bytes]
void shadowShares(const OccluderVolume& volume, const EyeBoxes& boxes, float* share);

}  // namespace sightline
