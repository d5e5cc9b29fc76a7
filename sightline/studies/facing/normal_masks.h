// Back faces by the classes of their normals: a mask of all classes that are surely seen from the back, one operation a triangle.
// SPDX-License-Identifier: MIT
//
// Hansong Zhang, Kenneth Hoff. Fast Backface Culling Using Normal Masks. 1997.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/facing_eye.h"
#include "sightline/geom/normal_classes.h"
#include "sightline/math/box.h"

namespace sightline::studies {

/// A bit for each class of normals; set: every triangle of the class that has a point between the rays is seen from its
/// back or edge-on.
struct NormalMask {
    alignas(64) std::array<uint8_t, 256> bytes{};  ///< those beyond the last class are 0
};

/// The mask of what lies between four rays from the eye. A normal and a line of sight both are means of their corners
/// (a class's four, the window's four); if all sixteen pairs are back-facing, so are all between.
/// Nothing that is outside of the window may be culled by it for its facing: only there does it hold.
NormalMask makeNormalMask(const CornerRays& rays, FrontFace front, int cells);

/// The masks of a view's window cut into sectors * sectors parts, each of which is narrower and so finds more.
class SectorMasks {
public:
    /// @param transform  the object's, object to world
    /// @param cells      of the classes, as in NormalClasses
    /// @param sectors    on each side of the window  [limit: 1 to 16]
    SectorMasks(const View& view, const glm::dmat4& transform, FrontFace front, int cells, int sectors);

    int sectors() const { return sectors_; }

    /// For what is seen in one sector; counted from the left, and from the bottom.
    const NormalMask& mask(int column, int row) const { return masks_[static_cast<size_t>(row * sectors_ + column)]; }

    /// The sectors that a box may be seen in: columns from first[0] to last[0], rows from first[1] to last[1]. Empty if
    /// it lies beside the window.
    struct Range {
        int first[2], last[2];
        bool empty() const { return first[0] > last[0] || first[1] > last[1]; }
    };

    /// @param box  in the object's space
    Range sectorsOf(const Box3f& box) const;

    /// The number, row * sectors + column, of a sector in which the point is surely seen, or -1. A triangle may be culled
    /// by the mask of any one sector in which one of its points is seen: it faces the eye with all of itself or with nothing.
    int sectorOf(const glm::vec3& point) const;

    /// What holds for everything inside of a box: classes that are back faces in all sectors that the box is seen in. All
    /// classes, if it lies beside the window.
    NormalMask maskOf(const Box3f& box) const;

private:
    int sectors_;
    glm::dmat4 to_clip_;
    glm::dvec2 outer_;  ///< where the window ends, with the jitter; in clip x and y over w
    std::vector<NormalMask> masks_;
};

/// Sets a bit for each triangle whose class is in the mask, as findBackFaces() of studies/facing/back_faces.h; returns how many are
/// set. None is that has a point where the mask holds and is seen from its front.
/// @param back  [size: >= ceil(count / 64) * 8]
size_t findBackFaces(const NormalClasses& classes, const NormalMask& mask, std::span<uint8_t> back);

/// The same for a run of triangles.
/// @param first  a multiple of 64
/// @param back   [size: >= ceil(count / 64) * 8]; bit 0 is triangle `first`
size_t findBackFaces(const NormalClasses& classes, size_t first, size_t count, const NormalMask& mask,
                     std::span<uint8_t> back);

}  // namespace sightline::studies
