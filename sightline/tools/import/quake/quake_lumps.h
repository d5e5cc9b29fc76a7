// The directory of a .bsp: which lump lies where, and records of one size in it.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/bytes.h"
#include "sightline/tools/import/gltf/gltf_fault.h"
#include "sightline/tools/import/quake/quake_map_file.h"

/// Readers of maps give up as glTF's does: by a Fault, thrown inside the importer only.
namespace sightline::tools::quake {

using gltf::at;
using gltf::fail;
using gltf::Fault;
using gltf::printable;
using Bytes = std::span<const unsigned char>;

inline ByteCursor cursorOf(Bytes bytes) {
    return ByteCursor({reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

/// The lumps that are read; a format has its own numbers for them.
enum class Lump : uint8_t {
    kEntities,
    kPlanes,
    kTextures,
    kVertices,
    kVisibility,
    kNodes,
    kTexinfo,
    kFaces,
    kLeaves,
    kLeafFaces,
    kEdges,
    kFaceEdges,
    kModels,
    kMeshIndices,
    kCount
};

struct LumpPlace {
    uint64_t offset = 0, size = 0;  ///< [bytes]
};

struct Directory {
    QuakeFormat format = QuakeFormat::kQuake;
    uint64_t table = 0;  ///< where in the file the lumps are listed: offset and size, 4 bytes each
    std::vector<LumpPlace> lumps;
    std::array<int8_t, static_cast<size_t>(Lump::kCount)> numbers;  ///< index into lumps; -1: the format has none

    int number(Lump lump) const { return numbers[static_cast<size_t>(lump)]; }
};

/// Throws a Fault: no such file, or a lump beyond its end.
Directory readDirectory(Bytes bytes);

/// Records of one size.
class Records {
public:
    Records() = default;
    Records(Bytes bytes, const char* name, size_t stride) : bytes_(bytes), name_(name), stride_(stride) {}

    const char* name() const { return name_; }
    size_t stride() const { return stride_; }
    uint32_t count() const { return static_cast<uint32_t>(bytes_.size() / stride_); }
    /// The record as numbers to be taken one by one, from byte `skip` on.
    ByteCursor record(uint64_t index, size_t skip = 0) const {
        return cursorOf(bytes_.subspan(index * stride_, stride_).subspan(skip));
    }
    /// Throws a Fault if there is no such record; `place` is who asks.
    uint32_t checked(uint64_t index, const char* place, uint64_t asker) const {
        if (index >= count()) fail(at(place, asker), "{} {} of {}", name_, index, count());
        return static_cast<uint32_t>(index);
    }

private:
    Bytes bytes_;
    const char* name_ = "";
    size_t stride_ = 1;
};

/// The lump's bytes; none if the format has no such lump.
Bytes lumpBytes(Bytes bytes, const Directory& directory, Lump lump);
/// The lump's records, as wide as the format has them. Throws a Fault if the size is no multiple of theirs.
Records lumpRecords(Bytes bytes, const Directory& directory, Lump lump);

/// The file's (x, y, z), z up, as (x, z, -y). Throws a Fault if it is not finite or beyond 1e9.
glm::vec3 takePoint(ByteCursor& cursor, const char* place, uint64_t index);

/// Fills textures, faces, points, indices and models, and the tree's bounds.
void readFaces(Bytes bytes, const Directory& directory, QuakeMapFile& map);

/// Quake 3's, which have points of their own in place of edges, and shaders.
void readQuake3Faces(Bytes bytes, const Directory& directory, QuakeMapFile& map);

}  // namespace sightline::tools::quake
