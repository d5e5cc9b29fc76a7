// Occluders as bytes and back, for files that hold what was prepared. Nothing that is read is believed.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <utility>

#include "sightline/base/bytes.h"
#include "sightline/geom/occluder.h"

namespace sightline {

/// The first thing that is wrong with bytes: after that nothing is taken from them any more.
struct ByteFault {
    std::string what;  ///< empty: nothing
    uint64_t at = 0;   ///< [bytes from the beginning of the file]

    bool none() const { return what.empty(); }
    /// @return false, so that whoever finds a fault may return it
    bool wrong(std::string fault, uint64_t place) {
        if (none()) {
            what = std::move(fault);
            at = place;
        }
        return false;
    }
};

template <class T>
void putBox(ByteWriter& out, const Box<T>& box) {
    for (const auto& corner : {box.min, box.max})
        for (int axis = 0; axis < 3; ++axis) out.put(corner[axis]);
}

/// @return false, with a fault, if the number is not finite, or the box is empty or not finite
bool takeFinite(ByteCursor& from, float& value, ByteFault& fault);
bool takeBox(ByteCursor& from, Box3f& box, ByteFault& fault);

namespace occluder_bytes {

/// Records of one size each; those of an occluder follow on those of the one before.
enum Run : uint32_t {
    kHeads,  ///< bounds, and how many records of the other runs are its
    kClusters,
    kVertices,
    kPolygons,
    kEdges,
    kRuns
};
inline constexpr uint64_t kRecordBytes[kRuns] = {40, 52, 12, 5, 4};

}  // namespace occluder_bytes

/// Appends an occluder to the runs.
void putOccluder(const Occluder& occluder, std::span<Array<char>, occluder_bytes::kRuns> runs);

/// Takes occluders from runs: all indices, limits and numbers are looked at, so that one that was taken can be drawn.
class OccluderReader {
public:
    /// @param runs   kRuns of them, of whole records; they and the fault must outlive this
    OccluderReader(ByteCursor* runs, ByteFault& fault) : runs_(runs), fault_(fault) {}

    bool take(Occluder& occluder);
    /// Whether nothing is left.
    bool end();

private:
    bool wrong(const char* what, uint64_t at) { return fault_.wrong(what, at); }
    bool takeParts(Occluder& occluder);
    bool takeCluster(Occluder& occluder);
    bool checkPolygons(const Occluder& occluder, OccluderCluster& cluster, uint32_t polygons);

    ByteCursor* runs_;
    ByteFault& fault_;
    uint64_t counts_[occluder_bytes::kRuns] = {};  // of the occluder at hand
    uint64_t polygons_at_ = 0, edges_at_ = 0;
};

}  // namespace sightline
