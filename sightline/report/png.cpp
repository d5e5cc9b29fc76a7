// Images in memory and their PNG form.
// SPDX-License-Identifier: MIT
#include "sightline/report/png.h"

#include <cstdlib>

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace sightline {
namespace {

std::string encode(uint32_t width, uint32_t height, int channels, const void* pixels) {
    if (width == 0 || height == 0) return {};
    std::string out;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
    };
    const int w = static_cast<int>(width), h = static_cast<int>(height);
    if (!stbi_write_png_to_func(append, &out, w, h, channels, pixels, w * channels)) return {};
    return out;
}

}  // namespace

std::string encodePng(const Image<Rgb>& image) { return encode(image.width, image.height, 3, image.pixels.data()); }
std::string encodePng(const Image<glm::u8vec4>& image) {
    return encode(image.width, image.height, 4, image.pixels.data());
}

std::string base64(std::string_view bytes) {
    static constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    out.reserve((bytes.size() + 2) / 3 * 4);
    for (size_t i = 0; i < bytes.size(); i += 3) {
        uint32_t group = 0;
        for (size_t k = 0; k < 3; ++k)
            group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
        for (size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63] : '=';
    }
    return out;
}

std::string dataUri(std::string_view png) { return "data:image/png;base64," + base64(png); }

}  // namespace sightline
