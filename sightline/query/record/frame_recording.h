// A recording of one frame: what was asked, the objects in question, what they hide with, and the answer; and its file.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string_view>

#include "sightline/base/array.h"
#include "sightline/base/result.h"
#include "sightline/geom/lod.h"
#include "sightline/geom/occluder.h"
#include "sightline/geom/query_settings.h"
#include "sightline/geom/view.h"
#include "sightline/world/world.h"

namespace sightline {

/// A frame that can be asked again elsewhere, without the program that asked it: for a report of a wrong or a slow
/// frame, for a regression test, and as a benchmark of somebody's own load. FrameReplay asks it again.
///
/// Objects that are in none of View::layers, and those that the frustum, the PVS or the portals culled, are not in it.
/// Clusters that are drawn one by one are not in it either: Stage::kClusters does nothing in a replay.
struct FrameRecording {
    /// What World::addOccluder() takes.
    struct Form {
        Occluder occluder;
        Array<InnerOccluder> inner;  ///< finest first

        explicit Form(Memory* memory) : occluder(memory), inner(memory) {}
    };
    /// A cull by a certificate, and whom that names: they and the object itself hide it.
    struct Certificate {
        uint32_t hidden = 0;            ///< index into `objects`
        uint32_t first = 0, count = 0;  ///< in `named`
    };

    View view;
    QuerySettings settings;           ///< each within the limits of its row of kQuerySettings
    bool volumes = true;              ///< WorldDef::volumes
    Array<Form> forms;                ///< the objects' OccluderId 1 is the first
    Array<Array<LodLevel>> chains;    ///< their LodsId 1 is the first
    Array<ObjectDef> objects;         ///< in the order of World::add
    Array<uint8_t> reasons;           ///< the recorded answer, as Query::reasons() has it, per object
    Array<uint8_t> again;             ///< that of a query which knows these objects alone, and nothing from before
    Array<Certificate> certificates;  ///< by `hidden`, rising
    Array<uint32_t> named;            ///< indices into `objects`

    explicit FrameRecording(Memory* memory = defaultMemory())
        : forms(memory),
          chains(memory),
          objects(memory),
          reasons(memory),
          again(memory),
          certificates(memory),
          named(memory) {}

    std::span<const uint32_t> namedBy(const Certificate& certificate) const {
        return std::span(named).subspan(certificate.first, certificate.count);
    }
};

/// The bytes of a recording's file: the same for the same recording, on every machine.
Array<char> recordingBytes(const FrameRecording& recording, Memory* memory = defaultMemory());

/// Whether bytes begin as those of a recording do.
bool isRecording(std::span<const char> bytes);

/// Reads them. Nothing in them is believed: all indices, limits and numbers are looked at, so that a recording that was
/// read can be asked again. Takes at most some eight times the memory of the bytes.
/// @param file  what errors call the bytes
/// Errors (kInput): one line with the file, what is wrong, and at which byte.
Result<FrameRecording> parseRecording(std::span<const char> bytes, std::string_view file,
                                      Memory* memory = defaultMemory());

namespace recording_file {

/// The file: magic, version, number of sections, contentHash() of all that follows; the sizes of the sections in their
/// order; the sections. Numbers are little-endian, sizes have 64 bits.
inline constexpr char kMagic[16] = {'s', 'i', 'g', 'h', 't', 'l', 'i', 'n', 'e', ' ', 'f', 'r', 'a', 'm', 'e', '\n'};
inline constexpr uint32_t kVersion = 4;   ///< up to 3 it held the calls of the occlusion buffer
inline constexpr size_t kHashAt = 24;     ///< [bytes]
inline constexpr size_t kHashedAt = 32;   ///< what the hash is over begins here  [bytes]
inline constexpr size_t kNameBytes = 32;  ///< of a setting, with zeros behind it

enum Section : uint32_t {
    kView,
    kSettings,
    kForms,
    kInner,
    kOccluders,  ///< of each form, and behind it its inner ones
    kClusters,
    kVertices,
    kPolygons,
    kEdges,
    kChains,
    kLevels,
    kObjects,
    kReasons,
    kAgain,
    kCertificates,
    kNamed,
    kSectionCount
};
/// Of one record.  [bytes]
inline constexpr uint64_t kRecordBytes[kSectionCount] = {
    2 * 128 + 4 + 4 + 8 + 4 + 8 + 2 * (4 + 32 * ViewPlanes::kMost) + 4 + 24 * ViewOutline::kMost + 4,
    kNameBytes + 8,
    4,
    28,
    40,
    52,
    12,
    5,
    4,
    4,
    16,
    48 + 128 + 8 + 4 * 4 + 2 * 8 + 4,
    1,
    1,
    8,
    4};

}  // namespace recording_file

}  // namespace sightline
