// Carries reference images into another view, far samples before near ones, so that no depth need be compared.
// SPDX-License-Identifier: MIT
//
// Leonard McMillan, Gary Bishop. Plenoptic Modeling: An Image-Based Rendering System. 1995.
// Leonard McMillan. A List-Priority Rendering Algorithm for Redisplaying Projected Surfaces. 1995.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/images/depth_image.h"

namespace sightline::images {

/// The plane of a sample at a place of its image, as WarpMap takes it.
inline glm::dvec3 planeOf(const DepthSample& sample, uint32_t i, uint32_t row) {
    const double across = sample.per_sample, up = sample.per_row;
    return {across, up, sample.nearness - across * i - up * row};
}

/// McMillan's warping equation, x' ~ turn * x + nearness * shift, in samples of both images.
class WarpMap {
public:
    /// @param from, to  perspective views
    WarpMap(const View& from, const View& to);

    /// Where a sample goes: (i, j, 1) times the last coordinate, which is positive in front of the new eye. The nearness
    /// there is nearness / last coordinate.
    glm::dvec3 at(double sample, double row, double nearness) const {
        return turn * glm::dvec3(sample, row, 1) + nearness * shift;
    }
    /// Of a plane with nearness dot(plane, (i, j, 1)) here: above 0 if the new eye is on the old one's side of it.
    double facing(const glm::dvec3& plane) const { return 1 + glm::dot(plane, shift_back); }
    /// True if the front of a sample's piece is to the new eye.
    bool sees(const DepthSample& sample, uint32_t i, uint32_t row) const {
        return (facing(planeOf(sample, i, row)) > 0) == (sample.from_behind == 0);
    }
    /// The nearness of that plane there, as such a plane of the new image.
    glm::dvec3 planeThere(const glm::dvec3& plane) const { return plane * turn_back / facing(plane); }

    glm::dmat3 turn{1.0}, turn_back{1.0};
    glm::dvec3 shift{0.0}, shift_back{0.0};  ///< shift_back = turn_back * shift
};

/// The order in which an image's rows and columns are drawn into another view so that of two samples that fall on one place
/// the nearer is drawn later: towards the new eye's place in the image (the epipole) if that lies in front of the old eye,
/// and away from it if it lies behind. Holds for any depths, since two such samples lie on one line through the epipole.
/// It is the line that must be common: of samples whose lines lie within one pixel of each other, the farther may win.
struct WarpOrder {
    std::vector<uint32_t> rows, columns;
};
WarpOrder warpOrder(const View& from, const View& to);

/// An image that others are warped into.
struct WarpedImage {
    static constexpr float kHole = -1;

    uint32_t width = 0, height = 0;
    std::vector<glm::u8vec3> colour;
    std::vector<float> nearness;  ///< kHole where nothing came; 0: the sky

    explicit WarpedImage(const View& view)
        : width(view.width),
          height(view.height),
          colour(size_t{view.width} * view.height, glm::u8vec3(0)),
          nearness(colour.size(), kHole) {}
    uint64_t holes() const;
};

enum class HiddenBy : uint8_t {
    kOrder,   ///< what is drawn later: occlusion-compatible order, no comparison
    kZBuffer  ///< what is nearer
};

struct WarpSettings {
    HiddenBy hidden_by = HiddenBy::kOrder;
    double most_stretch = 8;  ///< a sample covers at most so many along a row or a column [samples, >= 1]
    double most_gap = 1;      ///< gaps up to this wide between neighbours are closed  [samples, >= 0]
};

/// Samples of an image with any number of them at a pixel, far to near.
struct SampleLists {
    std::span<const DepthSample> samples;
    /// Where a pixel's samples begin, and where the last one's end. Empty: one a pixel.  [size: 0 or width * height + 1]
    std::span<const uint32_t> first;
};

/// Draws the samples of one image over what is there. Each covers the rectangle around its own piece of plane as the new
/// view sees it, so that a plane has no cracks, whatever its slope; gaps between the pieces of neighbours, where surfaces
/// bend, are closed up to a limit. Pieces that turn their back to the new eye are not drawn.
/// @param from  the view that the samples were taken for
/// @param to    the view of the image  [of the image's size]
void warp(const View& from, const SampleLists& lists, const View& to, WarpedImage& image,
          const WarpSettings& settings = {});
void warp(const DepthImage& reference, const View& to, WarpedImage& image, const WarpSettings& settings = {});

/// Adds what another image shows in the same view: in holes, and where it is nearer by more than a tolerance.
/// @param tolerance  of nearness, relative to the nearer
void mergeInto(WarpedImage& image, const WarpedImage& other, double tolerance = 0.02);

/// Gives each hole the colour of the farther of what borders it left and right, or above and below if its row is empty.
/// @returns how many there were
uint64_t fillHoles(WarpedImage& image);

}  // namespace sightline::images
