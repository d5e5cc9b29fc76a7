// Decompresses buffer views of EXT_meshopt_compression and KHR_meshopt_compression.
// SPDX-License-Identifier: MIT
//
// Arseny Kapoulkine, Jasper St. Pierre, Mike Lischke. EXT_meshopt_compression. 2021.
// Arseny Kapoulkine, Jasper St. Pierre, Alexey Knyazev, Don McCurdy. KHR_meshopt_compression. 2025.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sightline/tools/import/gltf/gltf_container.h"
#include "sightline/tools/import/gltf/gltf_json.h"

namespace sightline::tools::gltf {

struct Compression {
    enum class Mode : uint8_t { kAttributes, kTriangles, kIndices };
    enum class Filter : uint8_t { kNone, kOctahedral, kQuaternion, kExponential, kColor };
    uint32_t buffer = 0;
    uint64_t offset = 0, length = 0;  ///< [bytes] compressed
    uint32_t stride = 0;              ///< [bytes] of an element
    uint64_t count = 0;
    Mode mode = Mode::kAttributes;
    Filter filter = Filter::kNone;

    uint64_t decodedSize() const { return count * stride; }
};

/// The extension's object of a buffer or a buffer view, of whichever name; the second has the layout of the first, a
/// filter for colours, and a second version of the vertex codec. Null if there is none.
const Json* findMeshopt(const Json& json, const std::string& place);

/// Reads and checks the extension's object: stride and count suit the mode and the filter, and the decoded
/// size is one that this many bytes can hold.
Compression readCompression(const Json& json, size_t buffers, const std::string& place);

/// @param source  [size: compression.length]
/// @return        [size: compression.decodedSize()]
std::vector<unsigned char> decompress(const Compression& compression, Bytes source, const std::string& place);

}  // namespace sightline::tools::gltf
