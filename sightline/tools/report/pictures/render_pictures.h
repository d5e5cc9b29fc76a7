// Images of hidden-surface methods as files hold them: shaded, by object, and as heat maps.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "sightline/base/result.h"
#include "sightline/studies/hidden/shade/shade.h"
#include "sightline/studies/hidden/zbuffer/z_fighting.h"
#include "sightline/tools/report/pictures/png.h"
#include "sightline/tools/report/pictures/render_list.h"

namespace sightline::tools {
using namespace studies;

/// What is to be drawn of an image.
struct PictureSettings {
    Shading shading = Shading::kFlat;
    bool shadows = true;  ///< not without shading
    ShareWork share;
};

/// The picture, top row first. The shadow map is fitted to the image.
Image<Rgb> shadedPicture(const RenderList& scene, const View& view, const HiddenImage& image,
                         const PictureSettings& settings);

/// Key + 1 of the object at each pixel as a 24-bit colour, red the high byte; black where there is none.
/// Error (kInput): a key that 24 bits do not hold.
Result<Image<Rgb>> idPicture(const RenderList& scene, const HiddenImage& image);

/// Counts of samples as an image, top row first.
Image<float> countPicture(const HiddenImage& image, std::span<const uint16_t> counts);

/// The value that is shown brightest: 8, 16, 40, 80, 160 and so on, so that its ticks are whole. One sample in 500 may
/// lie above it.
double heatScale(std::span<const uint16_t> counts);

/// A pale picture with the pixels marked where two images show different surfaces.
Image<Rgb> differencePicture(const Image<Rgb>& shaded, const HiddenImage& a, const HiddenImage& b);

/// A pale picture with the pixels marked where a depth format confuses the two nearest surfaces (red), and where
/// they lie at the same place (blue).
Image<Rgb> fightPicture(const Image<Rgb>& shaded, const ZFightingMap& map);

/// Means of squares of pixels, so that no side is longer than `most`.
Image<Rgb> reduced(const Image<Rgb>& image, uint32_t most);

}  // namespace sightline::tools
