// A recording of what one frame asked of its occlusion buffer: occluders, places, calls and answers; and its file.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/memory.h"
#include "sightline/base/result.h"
#include "sightline/buffer/tile_log.h"
#include "sightline/geom/occluder.h"
#include "sightline/geom/view.h"
#include "sightline/world/world.h"

namespace sightline {

/// What a frame did to its occlusion buffer, complete enough to be done again without the world. It serves to report a
/// slow or a wrong frame, and to measure frames of real scenes. OcclusionReplay does it again.
struct OcclusionRecording {
    /// An object that hid something.
    struct Instance {
        uint32_t occluder = 0;  ///< index into `occluders`
        glm::dmat4 transform{1.0};
    };
    /// A cluster that was drawn.
    struct Draw {
        uint32_t instance = 0;  ///< index into `instances`
        uint32_t cluster = 0;   ///< of the instance's occluder
    };

    View view;                  ///< matrices, viewport and jitter, on which the buffer depends; all else as in View()
    QuerySettings settings;     ///< occlusion_size, masked, close_gaps; all else as in QuerySettings()
    Array<Occluder> occluders;  ///< each once, and of it the clusters that were drawn; their bounds are the whole one's
    Array<Instance> instances;
    Array<Draw> draws;  ///< in order
    TileLog asked;  ///< the order of draws and tests, and the tests with the answers that they were given; their tiles
                    ///< are counted row by row, screen.width / 8 in a row

    explicit OcclusionRecording(Memory* memory = defaultMemory())
        : occluders(memory), instances(memory), draws(memory), asked(memory) {}
};

/// Records what Query::visible(now, view, settings) does. Costs a query, and a copy of the occluders that it draws.
/// Errors (kUsage): the view is not usable, or has no occlusion stage.
Result<OcclusionRecording> recordOcclusion(const Snapshot& now, const View& view, const QuerySettings& settings = {},
                                           Memory* memory = defaultMemory());

/// The bytes of a recording's file: the same for the same recording, on every machine.
Array<char> recordingBytes(const OcclusionRecording& recording, Memory* memory = defaultMemory());

/// Reads them. Nothing in them is believed: all indices, limits and numbers are looked at, so that a recording that was
/// read can be replayed. Takes at most some five times the memory of the bytes.
/// @param file  what errors call the bytes
/// Errors (kInput): one line with the file, what is wrong, and at which byte.
Result<OcclusionRecording> parseRecording(std::span<const char> bytes, std::string_view file,
                                          Memory* memory = defaultMemory());

namespace recording_file {

/// The file: magic, version, number of sections, contentHash() of all that follows; the sizes of the sections in their
/// order; the sections. Numbers are little-endian, sizes have 64 bits.
inline constexpr char kMagic[16] = {'s', 'i', 'g', 'h', 't', 'l', 'i', 'n', 'e', ' ', 'f', 'r', 'a', 'm', 'e', '\n'};
inline constexpr uint32_t kVersion = 3;  ///< 1 had no detail of the buffer in its view, 2 no boxes
inline constexpr size_t kHashAt = 24;    ///< [bytes]
inline constexpr size_t kHashedAt = 32;  ///< what the hash is over begins here  [bytes]

enum Section : uint32_t {
    kView,
    kOccluders,
    kClusters,
    kVertices,
    kPolygons,
    kEdges,
    kInstances,
    kCalls,
    kDraws,
    kRects,
    kTiles,
    kNearest,
    kBoxes,
    kSectionCount
};
inline constexpr const char* kSectionNames[kSectionCount] = {
    "view",  "occluders", "clusters",   "vertices", "polygons",   "edges", "instances",
    "calls", "draws",     "rectangles", "tiles",    "nearnesses", "boxes"};
/// Of one record.  [bytes]
inline constexpr uint64_t kRecordBytes[kSectionCount] = {
    2 * 128 + 4 + 4 + 8 + 4 + 4, 40, 52, 12, 5, 4, 132, 1, 8, 17, 25, 4, 160};

}  // namespace recording_file

}  // namespace sightline
