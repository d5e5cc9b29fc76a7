// The occlusion buffer: tiles of 8x8 pixels with a coverage mask, a depth per pixel, and seams kept aside.
// SPDX-License-Identifier: MIT
//
// Jon Hasselgren, Magnus Andersson, Tomas Akenine-Moller. Masked Software Occlusion Culling. 2016.
#pragma once

#include <cstdint>
#include <limits>

#include "sightline/base/memory.h"
#include "sightline/geom/occluder.h"
#include "sightline/raster/polygon.h"
#include "sightline/raster/screen.h"

namespace sightline {

/// A rectangle of buffer pixels and the nearest depth behind it: what an occludee's bound becomes.
struct PixelRect {
    int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;  ///< inclusive, inside the buffer
    float nearness = 0;                        ///< no point of the bound is nearer
};

/// One drawn cluster: where its projected vertices lie, and what they came from.
struct DrawnCluster {
    const Occluder* occluder = nullptr;
    const glm::dmat4* transform = nullptr;  ///< must outlive the frame
    uint64_t transform_hash = 0;
    uint32_t first_vertex = 0;  ///< in DepthTiles::px, py, pd
    uint32_t cluster = 0;
    double position_error = 0;  ///< bound on the error of a projected vertex  [pixels]
    double depth_error = 0;     ///< bound on the error of a vertex's nearness
    bool clips = true;          ///< the near plane's place is known well enough to clip at it
};

/// A triangle clipped at the near plane: up to four corners, and for each side the mesh vertices that its edge lies
/// between (none for the side that the near plane made).
struct ClippedPolygon {
    double x[4], y[4], d[4];
    uint8_t from[4], to[4];  ///< cluster vertices that side i (corner i to i + 1) lies between
    bool open[4];
    int count = 0;
};

/// A polygon that touches pixels which it does not cover alone.
struct SeamPolygon {
    static constexpr uint32_t kWhole = ~0u;

    RasterPolygon raster;
    uint64_t side_key[4] = {};  ///< per side a hash of its edge in world space, the same for both directions;
                                ///< set by setSideKeys(), when first needed
    uint64_t key_bits = 0;      ///< bit (key mod 64) of each side: polygons without a common bit share no side
    bool keyed = false;
    uint32_t drawn = 0;         ///< index into DepthTiles::drawn
    uint32_t clipped = kWhole;  ///< index into DepthTiles::clipped, or kWhole
    uint8_t vertex[4] = {};     ///< cluster vertices, counter-clockwise; not used if clipped
    uint8_t corners = 3;
    uint8_t forward = 0;  ///< bit per side: which of the two directions
    uint8_t open = 0;     ///< bit per side that the near plane made
};

/// The pixels of one tile that a seam polygon touches.
struct SeamEntry {
    uint64_t mask = 0;
    uint32_t polygon = 0;  ///< index into DepthTiles::polygons
    uint32_t next = ~0u;   ///< the next entry of the tile
};

struct TileLog;

/// The buffer. A pixel is covered when every ray through any of its points meets an occluder no farther
/// than the depth stored there. Nearness as in Screen: larger is nearer.
struct DepthTiles {
    static constexpr uint32_t kNone = ~0u;

    explicit DepthTiles(Memory* from = defaultMemory()) : memory(from) {}
    DepthTiles(const DepthTiles&) = delete;
    DepthTiles& operator=(const DepthTiles&) = delete;

    /// How a tile's depths are held.
    enum class Form : uint8_t {
        kEmpty,   ///< no pixel is covered
        kPlane,   ///< all pixels are, by one polygon: the plane arrays; the depth array is not valid
        kPixels,  ///< the depth array is valid
    };

    Memory* const memory;            ///< of all arrays
    uint32_t width = 0, height = 0;  ///< [pixels], multiples of 8
    uint32_t columns = 0, rows = 0;  ///< [tiles]
    uint32_t stride = 0;             ///< tiles from one row to the next: columns rounded up to 8

    // Per tile, side by side, so that eight tiles of a row are looked at together.
    Array<float> farthest{memory};  ///< no more than the least nearness in the tile; -infinity unless all is covered
    Array<float> nearest{memory};   ///< form kPlane: no less than the greatest; kEmpty: -infinity; kPixels: +infinity
    /// Form kPlane: nearness at pixel (x, y) of the tile is max(floor, d + dx (x - 3.5) + dy (y - 3.5)).
    Array<float> plane_d{memory}, plane_dx{memory}, plane_dy{memory}, plane_floor{memory};
    Array<Form> form{memory};
    Array<uint64_t> covered{memory};      ///< bit 8 * row + column; not kept up to date in form kPlane: all is covered
    Array<uint64_t> tried{memory};        ///< seam pixels whose present entries have been resolved
    Array<uint32_t> seams{memory};        ///< first SeamEntry, or kNone
    Array<uint64_t> seam_mask{memory};    ///< pixels that some SeamEntry of the tile names
    Array<uint32_t> paired{memory};       ///< the first SeamEntry when pairSeams() last looked
    Array<uint64_t> paired_mask{memory};  ///< pixels that it has looked at since that was the first
    Array<float> depth{memory};           ///< 64 per tile; -infinity where not covered; see Form

    uint64_t coveredBits(uint32_t tile) const {
        return form[tile] == Form::kPlane ? ~uint64_t{0} : form[tile] == Form::kEmpty ? 0 : covered[tile];
    }

    /// Of a pixel of a tile in form kPixels or kEmpty.
    float depthAt(uint32_t tile, int bit) const {
        return form[tile] == Form::kPixels ? depth[64 * size_t{tile} + static_cast<size_t>(bit)]
                                           : -std::numeric_limits<float>::infinity();
    }

    Array<double> px{memory}, py{memory},
        pd{memory};  ///< the frame's projected vertices; px is NaN before the near plane
    Array<DrawnCluster> drawn{memory};
    Array<ClippedPolygon> clipped{memory};
    Array<SeamPolygon> polygons{memory};
    Array<SeamEntry> entries{memory};

    uint64_t seam_pixels = 0;  ///< resolved since the clear
    TileLog* log = nullptr;    ///< raster/tile_log.h: takes down what is asked and answered, if there is one

    /// Makes the buffer empty. Allocates only when it grows.
    void clear(uint32_t width, uint32_t height);
};

/// Draws one cluster of an occluder: covers the pixels that single triangles cover whole, and keeps aside
/// those that they share. Back faces of single-sided triangles draw nothing.
///
/// @param object  objectScreen() of the object that the occluder belongs to
/// @param flips   the object's transform mirrors: its counter-clockwise triangles are back faces
void drawCluster(DepthTiles& tiles, const Screen& object, bool flips, const DrawnCluster& cluster);

/// What to do where only pixels that polygons share stand between an answer and a rectangle.
enum class Seams : uint8_t {
    kResolve,  ///< resolve those that decide, and remember them
    kLeave,    ///< take them for open: cheaper, and good enough to decide whether to draw something
};

/// Whether the buffer surely hides everything in the rectangle.
bool isHidden(DepthTiles& tiles, const PixelRect& rect, Seams seams = Seams::kResolve);

/// Which pixels of a tile do not surely hide what lies at the given nearnesses.
/// @param window   the pixels that matter, bit 8 * row + column; other bits of the answer are 0
/// @param nearest  per pixel: no point of what is asked about is nearer there; read where the window has a bit
uint64_t openPixels(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64],
                    Seams seams = Seams::kResolve);

/// Makes a tile's pixels valid in the depth array.
void writeOut(DepthTiles& tiles, uint32_t tile);

/// Fills in the keys of a seam polygon's sides.
void setSideKeys(const DepthTiles& tiles, SeamPolygon& polygon);

/// Finds a side that two polygons share: the same edge of the world, exactly, run through in opposite directions.
bool findSharedSide(const DepthTiles& tiles, const SeamPolygon& a, const SeamPolygon& b, int& side_a, int& side_b);

/// Covers the pixels of a tile that two polygons with a shared side cover between them, for all pairs at once.
/// @param pixels  which pixels matter; others may be covered too
void pairSeams(DepthTiles& tiles, uint32_t tile, uint64_t pixels);

/// Tries to cover one pixel by the polygons that share it; true if it is covered now.
/// @param bit     which pixel of the tile, 0 to 63
/// @param wanted  the nearness that would do: the dearer methods are tried only if the cheaper ones fall short of it
bool resolveSeam(DepthTiles& tiles, uint32_t tile, int bit, float wanted);

}  // namespace sightline
