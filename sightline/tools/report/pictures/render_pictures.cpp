// Images of hidden-surface methods as files hold them: shaded, by object, and as heat maps.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/render_pictures.h"

#include <algorithm>
#include <cmath>

#include <fmt/core.h>

#include "sightline/tools/report/pictures/scene_look.h"

namespace sightline::tools {
using namespace studies;
namespace {

/// Rows of samples grow upward, rows of pictures downward.
template <class Pixel, class At>
Image<Pixel> turnedOver(uint32_t width, uint32_t height, At&& at) {
    Image<Pixel> out(width, height);
    for (uint32_t y = 0; y < height; ++y)
        for (uint32_t x = 0; x < width; ++x) out.at(x, y) = at(size_t{height - 1 - y} * width + x);
    return out;
}

constexpr Rgb kRed(214, 30, 60), kBlue(36, 92, 200);

/// A pale picture with marks.
/// @param mark  the colour for a sample, or null
template <class Mark>
Image<Rgb> marked(const Image<Rgb>& shaded, Mark&& mark) {
    Image<Rgb> out = shaded;
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            Rgb& pixel = out.at(x, y);
            const Rgb* const colour = mark(size_t{out.height - 1 - y} * out.width + x);
            pixel = colour ? *colour : Rgb(static_cast<uint8_t>(160 + (pixel.x + 2 * pixel.y + pixel.z) / 12));
        }
    return out;
}

}  // namespace

Image<Rgb> shadedPicture(const RenderList& scene, const View& view, const HiddenImage& image,
                         const PictureSettings& settings) {
    ShadeSettings shading;
    shading.shading = settings.shading;
    shading.diagonal = diagonalOf(scene.bounds());
    if (const glm::dvec3 eye = eyePosition(view); !scene.bounds().empty())
        shading.clear = glm::length(glm::clamp(eye, scene.bounds().min, scene.bounds().max) - eye);
    shading.colour = [&](uint32_t item, uint32_t triangle) { return scene.colourOf(item, triangle); };
    shading.share = settings.share;
    std::optional<ShadowMap> shadows;
    if (settings.shadows && settings.shading != Shading::kNone) {
        ShadowSettings light;
        light.sun = shading.sun;
        light.size = std::clamp(3 * std::max(image.width, image.height) / 2, 256u, 3072u);
        light.share = settings.share;
        shadows.emplace(scene.casters(), SurfacePoints(scene.list(), view), image, light);
        shading.shadows = &*shadows;
    }
    const std::vector<Rgb> colours = shade(scene.list(), view, image, shading);
    return turnedOver<Rgb>(image.width, image.height, [&](size_t at) { return colours[at]; });
}

Result<Image<Rgb>> idPicture(const RenderList& scene, const HiddenImage& image) {
    constexpr uint64_t kLargestKey = 0xfffffe;
    uint64_t largest = 0;
    Image<Rgb> out = turnedOver<Rgb>(image.width, image.height, [&](size_t at) {
        const uint32_t surface = image.surface[at];
        if (surface == HiddenImage::kNone) return Rgb(0);
        const uint64_t key = scene.keyOf(surface);
        largest = std::max(largest, key);
        const uint32_t code = static_cast<uint32_t>(key + 1);
        return Rgb(code >> 16 & 255, code >> 8 & 255, code & 255);
    });
    if (largest > kLargestKey)
        return Error{Error::Kind::kInput,
                     fmt::format("{}: object {} has a key beyond 24 bits, and cannot be in an image of ids",
                                 scene.scene().name, largest)};
    return out;
}

Image<float> countPicture(const HiddenImage& image, std::span<const uint16_t> counts) {
    return turnedOver<float>(image.width, image.height, [&](size_t at) { return static_cast<float>(counts[at]); });
}

double heatScale(std::span<const uint16_t> counts) {
    if (counts.empty()) return 8;
    std::vector<uint16_t> sorted(counts.begin(), counts.end());
    const auto place = sorted.begin() + static_cast<ptrdiff_t>((sorted.size() - 1) * 499 / 500);
    std::nth_element(sorted.begin(), place, sorted.end());
    for (double scale = 8;; scale *= 10)
        for (const double factor : {1.0, 2.0, 5.0})
            if (factor * scale >= *place) return factor * scale;
}

Image<Rgb> differencePicture(const Image<Rgb>& shaded, const HiddenImage& a, const HiddenImage& b) {
    return marked(shaded, [&](size_t at) { return a.surface[at] != b.surface[at] ? &kRed : nullptr; });
}

Image<Rgb> fightPicture(const Image<Rgb>& shaded, const ZFightingMap& map) {
    return marked(shaded, [&](size_t at) {
        return map.fights[at] == Fight::kFormat ? &kRed : map.fights[at] == Fight::kCoplanar ? &kBlue : nullptr;
    });
}

Image<Rgb> reduced(const Image<Rgb>& image, uint32_t most) {
    const uint32_t step = (std::max(image.width, image.height) + most - 1) / std::max(most, 1u);
    if (step <= 1) return image;
    Image<Rgb> out((image.width + step - 1) / step, (image.height + step - 1) / step);
    for (uint32_t y = 0; y < out.height; ++y)
        for (uint32_t x = 0; x < out.width; ++x) {
            glm::uvec3 sum(0);
            uint32_t count = 0;
            for (uint32_t v = y * step; v < std::min((y + 1) * step, image.height); ++v)
                for (uint32_t u = x * step; u < std::min((x + 1) * step, image.width); ++u, ++count)
                    sum += glm::uvec3(image.at(u, v));
            out.at(x, y) = Rgb((sum + count / 2) / count);
        }
    return out;
}

}  // namespace sightline::tools
