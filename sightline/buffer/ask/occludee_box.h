// An occludee's box, held against planes: what lies wholly behind an occluder's plane is hidden where that covers.
// SPDX-License-Identifier: MIT
//
// The argument. A ray through a pixel that some polygons cover meets one of them. Let (x, y, w, d) be what the rows of
// Screen make of a point before the eye: its pixel is (x/w, y/w), its nearness d/w. The plane of the polygon that the ray
// meets is there at least as near as d0 + dx x/w + dy y/w - error (BufferPlane). So a point of the ray for which
//     dx x + dy y + (d0 - error) w - d > 0
// lies behind the polygon, for w > 0. The left side is linear in space: if it is positive at the corner of a box where it
// is least, it is so in the whole box. Hence a box that lies behind the planes of all polygons that cover a pixel between
// them is hidden there, whatever their depths. A part of it before the near plane is not drawn and does no harm.
#pragma once

#include "sightline/base/assert.h"
#include "sightline/buffer/tiles.h"
#include "sightline/math/box.h"

namespace sightline {

/// Asks which planes a box lies behind. Keeps a few answers, for one polygon covers many tiles.
class OccludeeBox {
public:
    /// A box in the buffer's homogeneous space: of x, y, w and d each a row.
    struct Image {
        double row[4][4] = {};  ///< the center's, then what it changes by from there to three of the faces
        double error[4] = {};   ///< bound on the error of a row at any point of the box
    };

    /// How exactly a box and its place are known.
    struct Errors {
        double rounding = 0;     ///< of the box's coordinates, as a part of their size
        double pixel_error = 0;  ///< as in OccludeePlace
        double depth_error = 0;  ///< as in OccludeePlace
    };

    /// @param screen  the map from the box's space; must outlive this
    OccludeeBox(const Screen& screen, const Box3d& box, const Errors& errors)
        : screen_(&screen), box_(box), errors_(errors) {}
    /// What another one's image() gave.
    explicit OccludeeBox(const Image& image) : image_(image) {}

    /// Whether it surely lies wholly behind each of the planes, of which there is one at least.
    bool isBehind(const DepthTiles& tiles, const PlaneSet& planes) const {
        for (const uint32_t plane : planes.plane) {
            if (plane == DepthTiles::kNone) break;
            if (!isBehind(tiles, plane)) return false;
        }
        return !planes.empty();
    }
    bool isBehind(const DepthTiles& tiles, uint32_t plane) const {
        SIGHTLINE_DEBUG_ASSERT(plane < tiles.planes.size());
        const uint64_t known = known_[plane % kKnown];
        return known >> 1 == uint64_t{plane} + 1 ? known & 1 : decide(tiles, plane);
    }

    const Image& image() const {
        if (screen_) makeImage();
        return image_;
    }

private:
    static constexpr uint32_t kKnown = 32;

    void makeImage() const;
    bool decide(const DepthTiles& tiles, uint32_t plane) const;

    mutable const Screen* screen_ = nullptr;  ///< null once the image is made
    Box3d box_;
    Errors errors_;
    mutable Image image_;
    mutable uint64_t known_[kKnown] = {};  ///< 2 * (plane + 1) + the answer, at the plane's number modulo kKnown
};

}  // namespace sightline
