// What can be seen in a snapshot from a view: one front-to-back walk, frustum and occlusion.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
// Jon Hasselgren, Magnus Andersson, Tomas Akenine-Moller. Masked Software Occlusion Culling. 2016.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/jobs.h"
#include "sightline/base/memory.h"
#include "sightline/geom/image_rect.h"
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

/// Of a view in bins: what was done, in all bins together. The counts of objects that were kept and culled are those of
/// the answer; what faces and triangles cull there, several bins may count.
struct QueryStats {
    StageStats stages[kStageCount];
    uint64_t objects = 0;  ///< in the snapshot, within View::layers
    uint64_t visible = 0;  ///< = objects - the sum of culled
    uint64_t nodes_visited = 0;
    uint64_t occluder_triangles = 0;  ///< offered to the rasterizer
    uint64_t seam_pixels = 0;         ///< resolved: by the union of the polygons that share them
    uint64_t closed_gaps = 0;         ///< of those, pixels that are covered because View::close_gaps closed gaps there
    bool budget_spent = false;        ///< some visible occluders were not rasterized
    uint64_t faces_tested = 0;        ///< objects asked by their boxes' faces
    uint64_t faces_culled = 0;        ///< of these: by the occlusion stage or, out of the view, by the frustum's
    uint64_t second_looks = 0;        ///< objects asked by their own triangles
    uint64_t second_look_culled = 0;  ///< the same of these
    uint64_t second_look_polygons = 0;  ///< that they were asked by
    bool second_look_spent = false;     ///< View::second_look_polygons kept an object from being asked to the end
    uint64_t clusters_tested = 0;       ///< of objects that were kept until then
    uint64_t clusters_back = 0;         ///< of these: seen from their backs
    uint64_t clusters_outside = 0;      ///< of the others: outside of the view
    uint64_t clusters_hidden = 0;       ///< of the rest: hidden
    uint64_t cluster_triangles = 0;     ///< all, of the objects of which some are left
    uint64_t drawn_triangles = 0;       ///< of VisibleSet::ranges
    uint64_t draw_ranges = 0;           ///< VisibleSet::ranges
    uint64_t nanoseconds = 0;           ///< the whole query
};

/// Triangles of a kept object that has clusters: what of it may be seen.
struct DrawRange {
    uint32_t object = 0;            ///< index into VisibleSet::objects
    uint32_t first = 0, count = 0;  ///< in the order of DrawClusters::triangles
    uint32_t part = 0;              ///< DrawClusters::part
};

/// Bits of StereoSet::eyes.
inline constexpr uint8_t kLeftEye = 1, kRightEye = 2;

/// One answer for a pair of views.
struct StereoSet {
    std::span<const Visible> objects;  ///< that either eye may see, nearly front to back; valid until the next call
    std::span<const uint8_t> eyes;     ///< per object: which eyes may see it
    QueryStats left, right;            ///< of each eye's own walk
};

struct VisibleSet {
    std::span<const Visible> objects;  ///< front to back; valid until the query's next call
    QueryStats stats;
    /// Of the objects that have clusters, with Stage::kClusters, by object: each has some. What is in none of them is
    /// seen from its back, by surfaces that are single-sided, or outside of the view, or hidden.
    std::span<const DrawRange> ranges;
    /// Per object, with Stage::kPortals: the part of the viewport that may show it, in whole pixels, whatever the frame's
    /// jitter; the whole viewport where nothing is known. Empty if the stage had nothing to say.
    std::span<const ImageRect> scissors;
};

/// A part of the image through which a cell is seen.
struct SeenWindow {
    static constexpr uint32_t kNone = ~0u;

    uint32_t cell = 0;
    ImageRect rect;  ///< not widened by the jitter
    uint32_t from =
        kNone;  ///< the window, of the same answer, that it was looked through first; kNone: the eye may be in it
    uint32_t portal = kNone;  ///< of CellGraph::portals, between both cells
};

/// What Stage::kPortals did.
struct CellStats {
    bool known = false;       ///< false: it did nothing, or kept everything
    uint64_t cells = 0;       ///< entered; one that was entered again counts again
    uint64_t portals = 0;     ///< looked at
    uint64_t whole = 0;       ///< of these, so near that the whole window was taken
    uint64_t too_deep = 0;    ///< not gone through for View::portal_depth: not conservative
    bool work_spent = false;  ///< View::portal_work
};

/// Objects that an answer has and the one before it had not, and the other way round.
struct VisibleChanges {
    std::span<const Visible> appeared, disappeared;  ///< valid until the query's next call
};

struct Explanation;

/// Scratch of one thread; as many as there are threads. Allocates only when the world or the
/// viewport has grown.
///
/// Several threads can share one query: they offer themselves through a job hook, and the view says in how many bins
/// it is walked (View::bins). Then each bin, of stereo views each eye's, is a task. The answer is the same for any number
/// of threads, in every respect but nanoseconds, and the same as without the hook.
class Query {
public:
    /// @param memory  outlives the query; used by no other thread unless it is thread-safe, or the query has jobs:
    ///                then it must be
    /// @param jobs    where bins are offered; outlives the query. Null: they are walked one after the other, here
    explicit Query(Memory* memory = defaultMemory(), Jobs* jobs = nullptr);
    ~Query();
    Query(Query&&) noexcept;
    Query& operator=(Query&&) noexcept;

    /// The objects that may be visible.
    ///
    /// Conservative: in exact projection of the positions given, every object with a visible point
    /// is reported, at any resolution and under any image shift up to View::jitter. Objects in doubt
    /// (bounds that touch the near plane or hold the eye, or are not finite) are reported and counted.
    /// Deterministic: the same set, in the same order, on every instruction set.
    ///
    /// With View::last_visible_first the occluders that the last answer kept are drawn before anything is asked. The
    /// answer is conservative in the same way, and may be another one than without: it depends on the calls before it,
    /// and is the same for the same calls. The same holds of View::balance_bins.
    ///
    /// View::max_distance and View::contribution cull what may be visible: their stages count it apart, and what they
    /// leave out hides nothing, so that what is culled otherwise is hidden by the objects of the answer alone.
    VisibleSet visible(const Snapshot& now, const View& view);

    /// The objects that may be visible from either of two views, as the eyes of a headset: for each eye exactly what
    /// visible() says of its view, bit for bit. One occlusion buffer for each eye: what one eye sees past the other does
    /// not. Costs the two queries. Stage::kClusters does nothing here. changes(), reasons() and depthImage() then speak of both eyes, as they say.
    StereoSet visibleStereo(const Snapshot& now, const View& left, const View& right);

    /// What the last answer changed against the one before; the first answer's objects have all appeared. Snapshots and
    /// views may have changed as they like: objects are told apart by their ids, and one that was removed from its
    /// world disappears. O(objects in both answers).
    VisibleChanges changes();

    /// For each object of the last answer's snapshot, in the order of World::add with removed objects
    /// left out: 0 visible, 1 + Stage of the stage that culled it, 255 outside View::layers.
    /// @param reasons  [size: Snapshot::objectCount()]
    /// Of visibleStereo(): 0 if either eye may see it, else the finer of both stages.
    void reasons(std::span<uint8_t> reasons) const;
    /// The same of one eye of visibleStereo().
    /// @param eye  kLeftEye or kRightEye; after visible() both are that view
    void reasons(std::span<uint8_t> reasons, uint8_t eye) const;

    /// The windows that Stage::kPortals saw cells through; none if it had nothing to say. After visibleStereo() the left
    /// eye's.
    std::span<const SeenWindow> windows();
    CellStats cellStats() const;

    /// Why visible(now, view) has the object in its answer or not; see run/explain.h. The last answer stays as it is, and
    /// stands for the one before with View::hysteresis.
    /// For many objects of one answer make an Explainer, which does what they share once. Bins are taken at equal widths.
    Explanation explain(const Snapshot& now, const View& view, ObjectId id) const;

    /// The occlusion buffer after the last answer, for pictures: nearness per buffer pixel, row 0 at the bottom, 0
    /// where nothing is known to cover the whole pixel. Occluders that came after the last object are not in it.
    struct DepthImage {
        uint32_t width = 0, height = 0;
        bool perspective = true;           ///< nearness is 1/w; else minus the depth in eye space, and 0 is a depth too
        std::span<const float> nearness;   ///< valid until the query's next call
        std::span<const uint8_t> covered;  ///< 1 where there is a depth
    };
    /// After visibleStereo() it is the left eye's.
    /// @param resolve_seams  look first at all pixels that polygons share, not only at those that the answer needed
    DepthImage depthImage(bool resolve_seams = false);

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
