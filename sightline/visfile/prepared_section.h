// The section of prepared meshes: what a world needs of each, so that a program need not prepare it again.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/geom/prepared_mesh.h"
#include "sightline/visfile/section_file.h"

namespace sightline {

/// Meshes, and which of them each object of the file is.
struct PreparedMeshes {
    static constexpr uint32_t kNone = UINT32_MAX;

    Array<PreparedMesh> meshes;
    Array<uint32_t> mesh_of_object;  ///< per object of the file; kNone: nothing is prepared of it

    explicit PreparedMeshes(Memory* memory = defaultMemory()) : meshes(memory), mesh_of_object(memory) {}
};

namespace visibility_file {

/// The sizes of the runs in their order, 8 bytes each; the runs. Each is of records of one size.
inline constexpr uint32_t kPrepared = section_file::tagOf("prep");

enum PreparedRun : uint32_t {
    kPreparedMeshes,  ///< inner occluders; marks (1: the occluder is the shape, 2: it has its own); clusters, 0 or 1; levels; parts of these
    kPreparedInner,
    kPreparedOccluders,  ///< occluder_bytes::Run, from here on: of each mesh the occluder, the shape, the inner ones
    kPreparedClusters = kPreparedOccluders + 5,  ///< of those meshes that have them
    kPreparedNumbers,                            ///< of these
    kPreparedLevels,
    kPreparedIndices,  ///< of levels
    kPreparedRanges,   ///< of levels
    kPreparedObjects,  ///< per object its mesh
    kPreparedRuns
};
/// Of one record.  [bytes]
inline constexpr uint64_t kPreparedRecordBytes[kPreparedRuns] = {20, 28, 40, 52, 12, 5, 4, 88, 4, 16, 4, 8, 4};

}  // namespace visibility_file

/// @param meshes          as the functions of prepare/ make them
/// @param mesh_of_object  PreparedMeshes::mesh_of_object
Array<char> preparedSection(std::span<const PreparedMesh> meshes, std::span<const uint32_t> mesh_of_object,
                            Memory* memory = defaultMemory());

/// Reads a copy. Nothing in the bytes is believed: all indices, sizes and numbers are looked at, so that what was read
/// can be given to a World and drawn.
/// @param objects  of the file
/// @param file     what errors call the bytes
/// @param at       their place in it
/// Errors (kInput): one line with the file, what is wrong, and at which byte.
Result<PreparedMeshes> readPreparedSection(std::span<const char> bytes, size_t objects, std::string_view file,
                                           uint64_t at = 0, Memory* memory = defaultMemory());

}  // namespace sightline
