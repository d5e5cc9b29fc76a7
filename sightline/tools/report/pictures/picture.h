// Pictures of a frame: what the camera sees, and how many surfaces each pixel was drawn for.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// What pictures need to know of a scene, computed once. The scene must outlive it.
class PictureMaker {
public:
    explicit PictureMaker(const Scene& scene);

    const Scene& scene() const { return scene_; }
    const std::vector<Box3d>& bounds() const { return bounds_; }  ///< world space [size: objects]

    struct Frame {
        Image<Rgb> shaded;
        Image<Rgb> objects;         ///< lit alike, each object in a colour hashed from its key
        Image<glm::u8vec4> culled;  ///< to be laid over the picture: what was culled within the view, in the colour
                                    ///< of its stage, denser where more lies behind; transparent elsewhere
        Image<float> all;           ///< fragments generated per pixel when every object is submitted
        Image<float> kept;          ///< the same for the visible objects alone
        bool same = true;           ///< both drawings show the same surfaces at every sample
    };

    /// Draws a frame with 2x2 samples a pixel.
    /// @param view     its width and height are the picture's
    /// @param reasons  per object: 0 visible, else culled  [size: objects]
    Frame draw(const View& view, std::span<const uint8_t> reasons) const;

    /// What another eye sees of some objects, with 2x2 samples a pixel; shaded as a draft, in half of the time.
    struct Look {
        Image<Rgb> shaded;
        uint32_t width = 0, height = 0;  ///< [samples]
        std::vector<double> nearness;    ///< ZBufferImage::depth: per sample, rows from below
        std::vector<uint32_t> object;    ///< the same: which is seen there, or ZBufferImage::kNone
    };
    /// @param view  its sections are cut away
    Look look(const View& view, const std::vector<uint32_t>& objects) const;

private:
    /// A run of triangles of one material in one object.
    struct Part {
        uint32_t object = 0, primitive = 0;
    };

    struct Drawing;
    Drawing render(const View& view, const std::vector<uint32_t>& objects, uint32_t samples) const;
    void shade(const View& view, const Drawing& drawing, bool draft, Frame& frame) const;
    Image<glm::u8vec4> ghosts(const View& view, const std::vector<uint32_t>& objects,
                              std::span<const uint8_t> reasons) const;

    const Scene& scene_;
    std::vector<Box3d> bounds_;
    std::vector<uint8_t> ones_, zeros_;  ///< flags for the triangles of any mesh
    Box3d world_;                        // around all finite bounds
    double diagonal_ = 1;
};

/// The colour of a number on a scale from 0 to 1, dark to bright.
Rgb heatColour(double part);

/// The scale of heat maps over a value that one pixel in 500 lies above: 8, 16, 40, 80, 160 and so on, so that the ticks
/// of the legend are whole.
double heatScaleAbove(double value);

/// Means of squares of `step` pixels.
Image<float> reducedCounts(const Image<float>& counts, uint32_t step);

/// A heat map in 64 colours on a square-root scale, which tells small counts apart; `full` is the value of the brightest colour,
/// values above share it.
Image<Rgb> heatMap(const Image<float>& counts, double full);

}  // namespace sightline::tools
