// Images in memory and their PNG and JPEG forms.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/png.h"

#include <cstdlib>
#include <map>

#define STBI_WRITE_NO_STDIO
#define STB_IMAGE_WRITE_STATIC
#define STB_IMAGE_WRITE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#pragma GCC diagnostic ignored "-Wmissing-field-initializers"
#include <stb/stb_image_write.h>
#pragma GCC diagnostic pop

namespace sightline::tools {
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

uint32_t crcOf(std::string_view bytes) {
    uint32_t crc = ~0u;
    for (const char byte : bytes) {
        crc ^= static_cast<unsigned char>(byte);
        for (int bit = 0; bit < 8; ++bit) crc = crc >> 1 ^ (crc & 1 ? 0xedb88320u : 0u);
    }
    return ~crc;
}

void appendBig(std::string& out, uint32_t value) {
    for (int shift = 24; shift >= 0; shift -= 8) out += static_cast<char>(value >> shift & 0xff);
}

void appendChunk(std::string& out, const char* type, std::string_view data) {
    appendBig(out, static_cast<uint32_t>(data.size()));
    const size_t begin = out.size();
    out += type;
    out += data;
    appendBig(out, crcOf(std::string_view(out).substr(begin)));
}

/// A PNG of one byte a pixel; `colours` and `rows` are the palette and the pixels, each row behind its filter's 0.
std::string paletteFile(uint32_t width, uint32_t height, const std::vector<glm::u8vec4>& colours, std::string& rows) {
    std::string header, palette, alpha;
    appendBig(header, width);
    appendBig(header, height);
    header += std::string("\x08\x03\0\0\0", 5);  // eight bits, a palette, deflate, no interlacing
    bool clear = false;
    for (const glm::u8vec4& colour : colours) {
        for (int c = 0; c < 3; ++c) palette += static_cast<char>(colour[c]);
        alpha += static_cast<char>(colour.w);
        clear |= colour.w != 255;
    }
    int size = 0;
    auto* const bytes = reinterpret_cast<unsigned char*>(rows.data());
    unsigned char* const packed = stbi_zlib_compress(bytes, static_cast<int>(rows.size()), &size, 8);
    if (!packed) return {};
    std::string out("\x89PNG\r\n\x1a\n", 8);
    appendChunk(out, "IHDR", header);
    appendChunk(out, "PLTE", palette);
    if (clear) appendChunk(out, "tRNS", alpha);
    appendChunk(out, "IDAT", std::string_view(reinterpret_cast<char*>(packed), static_cast<size_t>(size)));
    appendChunk(out, "IEND", {});
    std::free(packed);
    return out;
}

uint32_t wordOf(const Rgb& c) { return uint32_t{c.x} << 24 | uint32_t{c.y} << 16 | uint32_t{c.z} << 8 | 255; }
uint32_t wordOf(const glm::u8vec4& c) {
    return uint32_t{c.x} << 24 | uint32_t{c.y} << 16 | uint32_t{c.z} << 8 | uint32_t{c.w};
}

template <class Pixel>
std::string encodeByPalette(const Image<Pixel>& image) {
    if (image.width == 0 || image.height == 0 || image.pixels.size() > size_t{1} << 30) return encodePng(image);
    std::map<uint32_t, uint8_t> index;
    std::vector<glm::u8vec4> colours;
    std::string rows;
    rows.reserve(image.pixels.size() + image.height);
    uint32_t last = 0;
    uint8_t place = 0;
    for (size_t i = 0; i < image.pixels.size(); ++i) {
        if (i % image.width == 0) rows += '\0';
        const uint32_t word = wordOf(image.pixels[i]);
        if (colours.empty() || word != last) {
            const auto [found, added] = index.emplace(word, static_cast<uint8_t>(colours.size()));
            if (added && colours.size() == 256) return encodePng(image);
            if (added) colours.emplace_back(word >> 24, word >> 16 & 255, word >> 8 & 255, word & 255);
            last = word;
            place = found->second;
        }
        rows += static_cast<char>(place);
    }
    return paletteFile(image.width, image.height, colours, rows);
}

}  // namespace

std::string encodePalettePng(const Image<Rgb>& image) { return encodeByPalette(image); }
std::string encodePalettePng(const Image<glm::u8vec4>& image) { return encodeByPalette(image); }

std::string encodeJpeg(const Image<Rgb>& image, int quality) {
    if (image.width == 0 || image.height == 0) return {};
    std::string out;
    const auto append = [](void* context, void* data, int size) {
        static_cast<std::string*>(context)->append(static_cast<const char*>(data), static_cast<size_t>(size));
    };
    const int w = static_cast<int>(image.width), h = static_cast<int>(image.height);
    if (!stbi_write_jpg_to_func(append, &out, w, h, 3, image.pixels.data(), quality)) return {};
    return out;
}

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

std::string dataUri(std::string_view bytes) {
    const bool jpeg = bytes.substr(0, 2) == "\xff\xd8";
    return (jpeg ? "data:image/jpeg;base64," : "data:image/png;base64,") + base64(bytes);
}

}  // namespace sightline::tools
