// A plain z-buffer renderer: the slow, obvious reference for images, ids and depth complexity.
// SPDX-License-Identifier: MIT
//
// Edwin Catmull. A Subdivision Algorithm for Computer Display of Curved Surfaces. 1974.
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"
#include "sightline/studies/hidden/draw_item.h"

namespace sightline::studies {

/// What a z-buffer pass leaves at each sample. Row 0 is the bottom row.
struct ZBufferImage {
    static constexpr uint32_t kNone = ~0u;
    static constexpr uint64_t kNowhere = ~0ull;
    uint32_t width = 0, height = 0;   ///< [samples]
    uint32_t first_row = 0;           ///< of the whole image: where this band begins  [samples]
    std::vector<uint32_t> id;         ///< nearest opaque surface's DrawItem::id, or kNone
    std::vector<double> depth;        ///< nearness: 1/w (perspective), -eye-space depth (orthographic);
                                      ///< larger is nearer; -infinity where nothing was drawn
    std::vector<uint16_t> generated;  ///< fragments generated per sample (depth complexity), saturating;
                                      ///< empty without ZBufferSettings::want_generated
    std::vector<uint8_t> seen;        ///< per id: 1 if any sample shows it, non-depth-writing ones included
                                      ///< [size: largest id + 1]. An opaque one is seen where `id` has it: of
                                      ///< two opaque surfaces at equal depth the first drawn is seen. One that
                                      ///< writes no depth is seen where it is not behind the final depth.
    std::vector<uint64_t> seen_at;    ///< per id: an index into `id` of a sample that shows it, the middle of its
                                      ///< longest run in a row; or kNowhere
};

struct ZBufferSettings {
    uint32_t samples = 1;        ///< per pixel and axis: 4 gives 4x4 ordered supersampling
    glm::dvec2 offset{0.0};      ///< shift of the sample grid [pixels]
    uint32_t first_row = 0;      ///< draw only a band of the image, from this row of samples ...
    uint32_t row_count = ~0u;    ///< ... so many rows, or up to the top
    bool want_generated = true;  ///< fill ZBufferImage::generated
    std::function<bool()> stop =
        {};  ///< asked now and then; true: leave out the rest, and the image is of no use. May be empty
};

/// Draws the items in the order given, those triangles that write depth before those that do not. Samples
/// lie at the centres of a regular grid; a sample exactly on a shared edge belongs to one triangle (top-left
/// rule, decided exactly for the vertices as projected to double). Clips in homogeneous space at the near plane
/// and, if finite, the far plane, and draws only samples inside of View::sections. Facing is that of the plane and the eye; a transform of negative determinant
/// flips the winding. All arithmetic in double and relative to the eye, written apart from everything that culls.
/// Triangles with a vertex that is not finite are not drawn. Memory: 12 bytes per sample of the band, 14 with
/// `generated`. A band gives the same bits as the same rows of the whole image.
ZBufferImage renderZBuffer(std::span<const DrawItem> items, const View& view, const ZBufferSettings& settings = {});

/// The same into an image that was used before, whose memory is used again.
void renderZBuffer(std::span<const DrawItem> items, const View& view, const ZBufferSettings& settings,
                   ZBufferImage& image);

}  // namespace sightline::studies
