// The occlusion buffer: tiles of 8x8 pixels, each a depth for all of it and one nearer layer; seams are kept aside.
// SPDX-License-Identifier: MIT
//
// Jon Hasselgren, Magnus Andersson, Tomas Akenine-Moller. Masked Software Occlusion Culling. 2016.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

#include "sightline/base/array.h"
#include "sightline/base/assert.h"
#include "sightline/buffer/polygon.h"
#include "sightline/buffer/screen.h"
#include "sightline/geom/occluder.h"

namespace sightline {

/// A rectangle of buffer pixels and the nearest depth behind it: what an occludee's bound becomes.
struct PixelRect {
    int32_t x0 = 0, y0 = 0, x1 = -1, y1 = -1;  ///< inclusive, inside the buffer
    float nearness = 0;                        ///< no point of the bound is nearer
};

/// One drawn cluster, or those of its polygons that wind one way: where its projected vertices lie, and what they
/// came from.
struct DrawnCluster {
    const Occluder* occluder = nullptr;
    const glm::dmat4* transform = nullptr;  ///< must outlive the frame
    uint64_t transform_hash = 0;
    bool clockwise = false;       ///< of its polygons, those that come out clockwise
    bool backs = false;           ///< these are backs: those alone that have two sides
    uint32_t first_vertex = ~0u;  ///< in DepthTiles::px, py, pd, once a seam has asked for a polygon
    uint32_t object = ~0u;        ///< in DepthTiles::objects
    uint32_t cluster = 0;
    uint32_t made = ~0u;   ///< in DepthTiles::made, one for each of its own polygons, once a seam has asked for one
    uint32_t boxes = ~0u;  ///< in DepthTiles::boxes, once a seam has asked which polygons lie in a tile
    double position_error = 0;  ///< bound on the error of a projected vertex  [pixels]
    double depth_error = 0;     ///< bound on the error of a vertex's nearness
    bool clips = true;          ///< the near plane's place is known well enough to clip at it
};

/// A polygon clipped at the near plane: its corners, and for each side the mesh vertices that its edge lies between
/// (none for the side that the near plane made).
struct ClippedPolygon {
    static constexpr int kMaxCorners = 5;
    double x[kMaxCorners], y[kMaxCorners], d[kMaxCorners];
    uint8_t from[kMaxCorners], to[kMaxCorners];  ///< cluster vertices that side i (corner i to i + 1) lies between
    bool open[kMaxCorners];
    int count = 0;
};

/// A polygon that touches pixels which it does not cover alone.
struct SeamPolygon {
    static constexpr uint32_t kWhole = ~0u;

    RasterPolygon raster;
    uint32_t edge_key[4] = {};  ///< where it is complete: per side a hash of its edge function, the same for both signs
    uint64_t edge_bits = 0;     ///< bit (key mod 64) of each side: polygons without a common bit share no side
    uint64_t side_key[4] = {};  ///< per side a hash of its edge in world space, the same for both directions;
                                ///< set by setSideKeys(), when first needed
    bool keyed = false;
    uint32_t plane = ~0u;       ///< index into DepthTiles::planes, once seamPlane() has been asked for it
    uint32_t drawn = 0;         ///< index into DepthTiles::drawn
    uint32_t clipped = kWhole;  ///< index into DepthTiles::clipped, or kWhole
    uint8_t source = 0;         ///< which polygon of the cluster it comes from
    uint8_t vertex[4] = {};     ///< cluster vertices, counter-clockwise; not used if clipped
    uint8_t corners = 3;
    uint8_t forward = 0;  ///< bit per side: which of the two directions
    uint8_t open = 0;     ///< bit per side that the near plane made
};

/// The pixels of one tile that the open edges of a drawn cluster touch.
struct SeamEntry {
    static constexpr uint32_t kAllPolygons = 255;

    uint64_t mask = 0;
    uint32_t source = 0;  ///< 256 * index into DepthTiles::drawn + the polygon of the cluster, or kAllPolygons
    float nearest = 0;    ///< no point of what it names is nearer
    uint32_t drawn() const { return source >> 8; }
    uint32_t polygon() const { return source & 255; }
};

/// Some of a tile's entries, in two lines of the cache.
struct alignas(64) SeamChunk {
    static constexpr uint32_t kMost = 7;

    uint64_t mask[kMost];  ///< no initial values
    uint32_t source[kMost];
    float nearest[kMost];
    uint32_t next = ~0u;  ///< of the entries before these
    uint32_t count = 0;
    uint32_t before = 0;  ///< how many those are

    SeamEntry entry(uint32_t i) const {
        SIGHTLINE_DEBUG_ASSERT(i < count && count <= kMost);
        return {mask[i], source[i], nearest[i]};
    }
};

/// The depth of a plane: nearness at buffer point (x, y) is no less than max(floor, d0 + dx x + dy y) - error.
struct BufferPlane {
    double d0 = 0, dx = 0, dy = 0;
    float floor = 0;  ///< already rounded away from the eye
    float error = 0;
};

/// A few planes: indices into DepthTiles::planes, and kNone behind them.
struct PlaneSet {
    static constexpr uint32_t kMost = 4, kNone = ~0u;

    uint32_t plane[kMost];

    explicit PlaneSet(uint32_t one = kNone, uint32_t other = kNone)
        : plane{one, other == one ? kNone : other, kNone, kNone} {}
    bool operator==(const PlaneSet&) const = default;
    bool empty() const { return plane[0] == kNone; }
    /// Of exactly one plane that plane, else kNone.
    uint32_t alone() const { return plane[1] == kNone ? plane[0] : kNone; }
    /// @returns false if there is no room
    bool add(uint32_t index) {
        SIGHTLINE_DEBUG_ASSERT(index != kNone);
        for (uint32_t& place : plane)
            if (place == index || place == kNone) {
                place = index;
                return true;
            }
        return false;
    }
};

/// Each ray through one of these pixels of a tile meets a polygon on one of the planes.
struct TileCover {
    uint64_t mask = 0;
    PlaneSet planes;
};

enum class OcclusionDetail : uint8_t {
    kMasked,  ///< two depths and a mask; where they do not fit, the farthest depth stands for all: smallest, but looser
    kFull,    ///< a depth per pixel where two depths do not fit
};
using Detail = OcclusionDetail;

struct ObjectFrame;
struct TileLog;
class OccludeeBox;

/// The buffer. A pixel is covered when every ray through any of its points meets an occluder no farther
/// than the depth claimed there. Nearness as in Screen: larger is nearer.
///
/// What a tile claims at a pixel is the nearest of: its base (a constant, or a plane where one polygon covers it
/// all), and its layer (one depth for the pixels of a mask; or a block of 64 depths). Beside the depths it knows which
/// planes cover its pixels, for what lies wholly behind them: its covers, and the base's plane (covers.h).
struct DepthTiles {
    static constexpr uint32_t kNone = ~0u;
    static constexpr float kOpen = -std::numeric_limits<float>::infinity();
    static constexpr uint32_t kCovers = 8;  ///< of a tile, at most
    static constexpr size_t kBeyond = 16;   ///< arrays of tiles go on for so many, which are loaded with the last ones

    explicit DepthTiles(Memory* from = defaultMemory()) : memory(from) {}
    DepthTiles(const DepthTiles&) = delete;
    DepthTiles& operator=(const DepthTiles&) = delete;

    Memory* const memory;                       ///< of all arrays
    uint32_t width = 0, height = 0;             ///< [pixels], multiples of 8
    uint32_t columns = 0, rows = 0;             ///< [tiles]
    uint32_t stride = 0;                        ///< tiles from one row to the next: columns rounded up to 16
    uint32_t first_column = 0, end_column = 0;  ///< tiles beside these columns do not matter: keepColumns()
    Detail detail = Detail::kFull;

    // Per tile, side by side, so that sixteen tiles of a row are looked at together.
    Array<float> base{memory};           ///< no pixel of the tile claims less; kOpen unless all is covered
    Array<float> layer{memory};          ///< kOpen: there is no layer. Else its depth, or the greatest in the block
    Array<uint32_t> seams{memory};       ///< its last SeamChunk, or kNone
    Array<uint32_t> plane{memory};       ///< where base > kOpen: index into planes, or kNone
    Array<uint64_t> layer_mask{memory};  ///< with a layer: its pixels, bit 8 * row + column
    Array<uint32_t> block{memory};       ///< with a layer: index into blocks, or kNone
    Array<uint64_t> seam_mask{memory};   ///< with seams: pixels that some SeamEntry of the tile names
    Array<uint64_t> tried{memory};       ///< with seams: pixels whose present entries have been resolved
    Array<float> lid{memory};            ///< with seams: pixels of lid_mask are surely open to this nearness and to
    Array<uint64_t> lid_mask{memory};    ///< greater ones, unless the tile claims more there

    Array<uint8_t> cover_count{memory};  ///< of its covers, how many are in use
    Array<TileCover> covers{memory};     ///< kCovers each

    Array<BufferPlane> planes{memory};
    Array<float> blocks{memory};                       ///< 64 each; kOpen where the layer claims nothing
    uint32_t block_count = 0;                          ///< in use
    Array<double> px{memory}, py{memory}, pd{memory};  ///< projected vertices that seams need: px is NaN before the
    size_t vertex_count = 0;                           ///< near plane; so many are in use
    Array<DrawnCluster> drawn{memory};                 ///< those that left seams
    Array<Screen> objects{memory};                     ///< theirs
    Array<ClippedPolygon> clipped{memory};
    Array<SeamPolygon> polygons{memory};
    Array<uint32_t> made{memory};  ///< per polygon of a drawn cluster: 4 * its first SeamPolygon + how many, or kNone
    Array<float> boxes{memory};  ///< per sixteen polygons of one: 16 least x, 16 least y, 16 greatest x, 16 greatest y
    Array<SeamChunk> chunks{memory};

    Array<char> scratch{memory};  ///< of drawing

    /// Gaps narrower than this between occluders are closed; set after clear(), which makes it 0  [pixels]
    double gap = 0;

    uint64_t seam_pixels = 0;  ///< resolved since the clear
    uint64_t closed_gaps = 0;  ///< of those, pixels that are covered because gaps in them were closed
    TileLog* log = nullptr;    ///< buffer/tile_log.h: takes down what is asked and answered, if there is one

    /// Pixels of a tile that claim a depth.
    uint64_t coveredBits(uint32_t tile) const {
        SIGHTLINE_DEBUG_ASSERT(tile < base.size());
        return base[tile] > kOpen ? ~uint64_t{0} : layer[tile] > kOpen ? layer_mask[tile] : 0;
    }

    /// Pixels of a tile that open edges touch.
    uint64_t seamBits(uint32_t tile) const {
        SIGHTLINE_DEBUG_ASSERT(tile < seams.size());
        return seams[tile] == kNone ? 0 : seam_mask[tile];
    }

    /// Makes the buffer empty. Allocates only when it grows.
    void clear(uint32_t width, uint32_t height, Detail detail = Detail::kFull);

    /// To be called after clear(). Tiles beside the given columns claim to be nearer than anything, so that nothing is
    /// drawn there and nothing is open there. Inside the columns all answers are the same as without.
    void keepColumns(uint32_t first, uint32_t end);

    /// Makes a rectangle smaller by what lies beside the columns that matter; false if nothing is left.
    bool clip(PixelRect& rect) const {
        SIGHTLINE_DEBUG_ASSERT(first_column <= end_column && end_column <= columns);
        rect.x0 = std::max(rect.x0, static_cast<int32_t>(8 * first_column));
        rect.x1 = std::min(rect.x1, static_cast<int32_t>(8 * end_column) - 1);
        return rect.x0 <= rect.x1;
    }
};

/// Draws one cluster of an occluder: covers the pixels that its polygons cover together, and keeps aside those that
/// its open edges touch. Back faces of single-sided triangles draw nothing.
///
/// @param cluster  all but what drawing finds out: vertices, polygons, object, clockwise
/// @param object   objectScreen() of the object that the occluder belongs to
/// @param frame    objectFrame() of it
void drawCluster(DepthTiles& tiles, const DrawnCluster& cluster, const Screen& object, const ObjectFrame& frame);

/// What to do where only pixels that polygons share stand between an answer and a rectangle.
enum class Seams : uint8_t {
    kResolve,  ///< resolve those that decide, and remember them
    kLeave,    ///< take them for open: cheaper, and good enough to decide whether to draw something
};

/// Whether the buffer surely hides everything in the rectangle.
/// @param box  of what is asked about, if it is known: then planes hide it, too
bool isHidden(DepthTiles& tiles, const PixelRect& rect, Seams seams = Seams::kResolve,
              const OccludeeBox* box = nullptr);

/// Which pixels of a tile do not surely hide what lies at the given nearnesses.
/// @param window   the pixels that matter, bit 8 * row + column; other bits of the answer are 0
/// @param nearest  per pixel: no point of what is asked about is nearer there; read where the window has a bit
/// @param box      of what is asked about, if it is known: then planes hide it, too
uint64_t openPixels(DepthTiles& tiles, uint32_t tile, uint64_t window, const float (&nearest)[64],
                    Seams seams = Seams::kResolve, const OccludeeBox* box = nullptr);

/// The same of what lies at one nearness.
uint64_t openPixels(DepthTiles& tiles, uint32_t tile, uint64_t window, float nearest, Seams seams = Seams::kResolve,
                    const OccludeeBox* box = nullptr);

/// Pixels of a tile that seams may still cover; openPixels() with Seams::kResolve decides them.
uint64_t undecidedSeams(const DepthTiles& tiles, uint32_t tile);

/// The depth that each pixel of a tile claims; DepthTiles::kOpen where it claims none.
void readClaims(const DepthTiles& tiles, uint32_t tile, float (&claims)[64]);

/// Raises what a tile claims at the pixels of a mask.
/// @param depths  per pixel, read where the mask has a bit
void raiseClaims(DepthTiles& tiles, uint32_t tile, uint64_t mask, const float (&depths)[64]);

/// Tries to cover one pixel by the polygons that share it; true if it claims more than the nearness wanted now. What
/// else was asked before does not change the answer.
/// @param bit  which pixel of the tile, 0 to 63
bool resolveSeam(DepthTiles& tiles, uint32_t tile, int bit, float wanted);

}  // namespace sightline
