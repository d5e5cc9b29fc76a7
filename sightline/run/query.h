// What can be seen in a snapshot from a view: one front-to-back walk, frustum and occlusion.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
// Jon Hasselgren, Magnus Andersson, Tomas Akenine-Moller. Masked Software Occlusion Culling. 2016.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/geom/view.h"
#include "sightline/run/world.h"

namespace sightline {

/// Counts objects; a culled tree node counts all its objects.
struct StageStats {
    uint64_t tested = 0;
    uint64_t culled = 0;
    uint64_t doubt = 0;        ///< kept because the stage could not decide
    uint64_t nanoseconds = 0;  ///< only with View::time_stages
};

struct QueryStats {
    StageStats stages[kStageCount];
    uint64_t objects = 0;  ///< in the snapshot, within View::layers
    uint64_t visible = 0;  ///< = objects - the sum of culled
    uint64_t nodes_visited = 0;
    uint64_t occluder_triangles = 0;  ///< offered to the rasterizer
    uint64_t seam_pixels = 0;         ///< resolved by exact pairing of edges
    bool budget_spent = false;        ///< some visible occluders were not rasterized
    uint64_t nanoseconds = 0;         ///< the whole query
};

struct VisibleSet {
    std::span<const Visible> objects;  ///< front to back; valid until the query's next call
    QueryStats stats;
};

/// Objects that an answer has and the one before it had not, and the other way round.
struct VisibleChanges {
    std::span<const Visible> appeared, disappeared;  ///< valid until the query's next call
};

struct Explanation;

/// Scratch of one thread; as many as there are threads. Allocates only when the world or the
/// viewport has grown.
class Query {
public:
    /// @param memory  outlives the query; used by no other thread unless it is thread-safe
    explicit Query(Memory* memory = defaultMemory());
    ~Query();
    Query(Query&&) noexcept;
    Query& operator=(Query&&) noexcept;

    /// The objects that may be visible.
    ///
    /// Conservative: in exact projection of the positions given, every object with a visible point
    /// is reported, at any resolution and under any image shift up to View::jitter. Objects in doubt
    /// (bounds that touch the near plane or hold the eye, or are not finite) are reported and counted.
    /// Deterministic: the same set, in the same order, on every instruction set.
    VisibleSet visible(const Snapshot& now, const View& view);

    /// What the last answer changed against the one before; the first answer's objects have all appeared. Snapshots and
    /// views may have changed as they like: objects are told apart by their ids, and one that was removed from its
    /// world disappears. O(objects in both answers).
    VisibleChanges changes();

    /// For each object of the last answer's snapshot, in the order of World::add with removed objects
    /// left out: 0 visible, 1 + Stage of the stage that culled it, 255 outside View::layers.
    /// @param reasons  [size: Snapshot::objectCount()]
    void reasons(std::span<uint8_t> reasons) const;

    /// Why visible(now, view) has the object in its answer or not; see run/explain.h. The last answer stays as it is.
    /// For many objects of one answer make an Explainer, which does what they share once.
    Explanation explain(const Snapshot& now, const View& view, ObjectId id) const;

    /// The occlusion buffer after the last answer, for pictures: nearness per buffer pixel, row 0 at the bottom, 0
    /// where nothing is known to cover the whole pixel. Occluders that came after the last object are not in it.
    struct DepthImage {
        uint32_t width = 0, height = 0;
        bool perspective = true;           ///< nearness is 1/w; else minus the depth in eye space, and 0 is a depth too
        std::span<const float> nearness;   ///< valid until the query's next call
        std::span<const uint8_t> covered;  ///< 1 where there is a depth
    };
    /// @param resolve_seams  look first at all pixels that polygons share, not only at those that the answer needed
    DepthImage depthImage(bool resolve_seams = false);

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
