// Decompresses the primitives of KHR_draco_mesh_compression.
// SPDX-License-Identifier: MIT
//
// Fan Zhang, Ondrej Stava, Frank Galligan, Kai Ninomiya, Patrick Cozzi. KHR_draco_mesh_compression. 2017.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "sightline/tools/import/gltf/gltf_document.h"

namespace sightline::tools::gltf {

/// One attribute that is wanted from a stream, and how.
struct DracoAttribute {
    std::string name;                         ///< "POSITION"
    uint32_t id = 0;                          ///< its unique id in the stream
    Component component = Component::kFloat;  ///< what it is converted to
    uint32_t components = 1;                  ///< an element has
};

struct DracoMesh {
    uint32_t vertices = 0;
    std::vector<uint32_t> indices;                       ///< [size: 3 * triangles]; each below `vertices`
    std::vector<std::vector<unsigned char>> attributes;  ///< packed elements, in the order asked for
};

/// How many triangles and vertices a stream must hold; none: any number.
struct DracoCounts {
    std::optional<uint64_t> triangles, vertices;
};

/// False in a build without the library: decodeDraco is then a Fault that says so.
bool dracoSupported();

/// Decodes a stream that is not trusted. What the library is about to allocate is charged to the budget as soon as the
/// stream claims it, and given back at the end; the result itself is for the caller to charge.
DracoMesh decodeDraco(Bytes stream, const std::vector<DracoAttribute>& attributes, const DracoCounts& counts,
                      Budget& budget, const std::string& place);

/// Attributes of a primitive by name, each with its accessor.
using NamedAccessors = std::vector<std::pair<std::string, uint32_t>>;

/// Puts accessors into the document that take their data from a stream, in place of those of a primitive that the
/// stream holds. Streams that several primitives name in the same way are shared.
/// @param json        the extension's object
/// @param attributes  those that are needed; replaced where the stream holds them
/// @param indices     replaced
/// @param triangles   the stream must have as many as `indices` says; a strip says nothing of them
/// @return            index into Document::streams
uint32_t useDraco(Document& document, const Json& json, NamedAccessors& attributes, std::optional<uint32_t>& indices,
                  bool triangles, const std::string& place);

/// Fills the accessors of a stream, if they are not filled.
void unpackDraco(Document& document, uint32_t stream);

/// Announces that a stream will be needed once more; the last release drops what was unpacked.
void retainDraco(Document& document, uint32_t stream);
void releaseDraco(Document& document, uint32_t stream);

}  // namespace sightline::tools::gltf
