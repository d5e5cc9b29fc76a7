// PNGs as an independent reader takes them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#define STBI_ONLY_PNG
#define STBI_ONLY_JPEG
#define STB_IMAGE_STATIC
#define STB_IMAGE_IMPLEMENTATION
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wunused-function"
#include <stb/stb_image.h>
#pragma GCC diagnostic pop

namespace sightline::test {

struct Decoded {
    int width = 0, height = 0, channels = 0;  ///< those that the file has; 0: it cannot be read
    std::vector<uint8_t> bytes;               ///< the top row first
};

/// @param channels  wanted of each pixel; 0: those that the file has
inline Decoded decodePng(const std::string& file, int channels = 0) {
    Decoded out;
    stbi_uc* data = stbi_load_from_memory(reinterpret_cast<const stbi_uc*>(file.data()), static_cast<int>(file.size()),
                                          &out.width, &out.height, &out.channels, channels);
    if (!data) return {};
    const int each = channels ? channels : out.channels;
    out.bytes.assign(data, data + size_t(out.width) * size_t(out.height) * size_t(each));
    stbi_image_free(data);
    return out;
}

}  // namespace sightline::test
