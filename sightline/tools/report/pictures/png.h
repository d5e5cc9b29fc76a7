// Images in memory and their PNG and JPEG forms.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::tools {

using Rgb = glm::u8vec3;

/// Pixels row by row, the top row first.
template <class Pixel>
struct Image {
    uint32_t width = 0, height = 0;
    std::vector<Pixel> pixels;

    Image() = default;
    Image(uint32_t w, uint32_t h, Pixel fill = Pixel(0)) : width(w), height(h), pixels(size_t{w} * h, fill) {}
    Pixel& at(uint32_t x, uint32_t y) { return pixels[size_t{y} * width + x]; }
    const Pixel& at(uint32_t x, uint32_t y) const { return pixels[size_t{y} * width + x]; }
};

/// The bytes of a PNG file; empty for an image without pixels.
std::string encodePng(const Image<Rgb>& image);
std::string encodePng(const Image<glm::u8vec4>& image);

/// The same picture by a palette where it has at most 256 colours, which is a third of the size; else as above.
std::string encodePalettePng(const Image<Rgb>& image);
std::string encodePalettePng(const Image<glm::u8vec4>& image);

/// The bytes of a JPEG file: for photographs of a scene, where a tenth of the bytes does.
/// @param quality  [1 to 100]
std::string encodeJpeg(const Image<Rgb>& image, int quality);

std::string base64(std::string_view bytes);

/// `data:image/png;base64,...`, or `data:image/jpeg`, as the bytes begin: a picture that lies in the page itself.
std::string dataUri(std::string_view bytes);

}  // namespace sightline::tools
