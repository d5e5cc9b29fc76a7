// What can be seen in a snapshot from a view: the objects, what of them to draw, and what the answer cost.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
// Jon Hasselgren, Magnus Andersson, Tomas Akenine-Moller. Masked Software Occlusion Culling. 2016.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/jobs.h"
#include "sightline/base/array.h"
#include "sightline/frame/draw_range.h"
#include "sightline/frame/stats.h"
#include "sightline/geom/image_rect.h"
#include "sightline/geom/lod.h"
#include "sightline/geom/view.h"
#include "sightline/query/explain/hider.h"
#include "sightline/world/world.h"

namespace sightline {

/// Bits of StereoSet::eyes.
inline constexpr uint8_t kLeftEye = 1, kRightEye = 2;

/// One answer for a pair of views.
struct StereoSet {
    std::span<const Visible> objects;  ///< that either eye may see, nearly front to back; valid until the next call
    std::span<const uint8_t> eyes;     ///< per object: which eyes may see it
    QueryStats left, right;            ///< of each eye's own traversal; what levels of detail cost counts as the left's
    std::span<const VisibleLod> lods;  ///< as VisibleSet::lods; both eyes see the same level
    ViewProblem left_problem = ViewProblem::kNone, right_problem = ViewProblem::kNone;  ///< as VisibleSet::problem
};

struct VisibleSet {
    std::span<const Visible> objects;  ///< front to back; valid until the query's next call
    QueryStats stats;
    /// With Stage::kClusters: the triangles to draw of the objects that have clusters, object by object; each such
    /// object has some. A triangle in no range is a back face of a single-sided surface, lies outside of the view, or
    /// is hidden.
    std::span<const DrawRange> ranges;
    /// With Stage::kLod, per object: the level of detail to draw, and what it is blended with. Empty if the stage chose
    /// nothing: every object is drawn by its finest level. An object that is drawn by another level has no ranges.
    std::span<const VisibleLod> lods;
    /// With Stage::kPortals, per object: the part of the viewport that may show it, in whole pixels, under any jitter
    /// that the view declares; the whole viewport where nothing is known. Empty if the stage decided nothing.
    std::span<const ImageRect> scissors;
    /// Why the view could not be used: nothing was culled. Look at it while you bring the library up; wordsOf() says it.
    ViewProblem problem = ViewProblem::kNone;
};

/// A part of the image through which a cell is seen.
struct SeenWindow {
    static constexpr uint32_t kNone = ~0u;

    uint32_t cell = 0;
    ImageRect rect;  ///< not widened by the jitter
    uint32_t from =
        kNone;  ///< the window of this answer that it was first seen through; kNone: the eye may be in the cell
    uint32_t portal = kNone;  ///< of CellGraph::portals, between both cells
};

/// What Stage::kPortals did.
struct CellStats {
    bool known = false;       ///< false: it did nothing, or kept everything
    uint64_t cells = 0;       ///< entered; a cell counts each time
    uint64_t portals = 0;     ///< looked at
    uint64_t whole = 0;       ///< portals too near to be cut to: the whole window was taken
    uint64_t too_deep = 0;    ///< portals beyond QuerySettings::portal_depth, not looked through: not conservative
    bool work_spent = false;  ///< QuerySettings::portal_work was too small
};

/// The objects that came into the answer, and those that left it, since the answer before.
struct VisibleChanges {
    std::span<const Visible> appeared, disappeared;  ///< valid until the query's next call
};

struct Explanation;

/// The scratch that queries need. Each thread has its own query. It allocates only when the world or the viewport has
/// grown, or when it remembers more certificates, or more is proposed to it, than ever before.
///
/// Several threads can share the work of one query. They offer themselves through a job hook, and QuerySettings::bins
/// says into how many strips the image is cut: each strip of each eye is a task. The answer is the same for any number
/// of threads, and without the hook; only nanoseconds differ.
class Query {
public:
    /// @param memory  outlives the query; used by no other thread unless it is thread-safe, or the query has jobs:
    ///                then it must be
    /// @param jobs    the hook that strips are offered to; outlives the query. Null: the caller's thread answers them
    explicit Query(Memory* memory = defaultMemory(), Jobs* jobs = nullptr);
    ~Query();
    Query(Query&&) noexcept;
    Query& operator=(Query&&) noexcept;

    /// The objects that may be visible.
    ///
    /// Conservative: in exact projection of the positions given, every object with a visible point
    /// is reported, at any resolution and under any image shift up to View::jitter. Objects in doubt
    /// (bounds that touch the near plane or hold the eye, or are not finite) are reported and counted.
    /// Deterministic: the same set, in the same order, on every instruction set, given the same calls before; with
    /// QuerySettings::stateless, whatever was asked before.
    ///
    /// QuerySettings::max_distance, ::contribution and ::hard_budget are not conservative: they cull what may be visible.
    /// Their stages count these objects apart. What is too far or too small hides nothing: all other culled objects are hidden by
    /// objects of the answer, or by what the budget left out of it.
    VisibleSet visible(const Snapshot& now, const View& view, const QuerySettings& settings = {});

    /// The objects that may be visible from either of two views, as from the eyes of a headset. Each eye's answer is
    /// that of visible() for its view, bit for bit. Each eye has an occlusion buffer of its own, because one eye sees
    /// past what blocks the other. Costs two queries. Stage::kClusters does nothing here. changes(), reasons() and
    /// depthImage() say what they mean for two eyes.
    StereoSet visibleStereo(const Snapshot& now, const View& left, const View& right,
                            const QuerySettings& settings = {});

    /// Names objects that somebody else takes to be hidden: a GPU's occlusion queries or pyramid, an id-buffer of an
    /// earlier frame. Nothing of it is believed. Answers look for a certificate of each, polygon by polygon, whether they
    /// draw or not, and cull those that have one: so what samples say becomes what is proved. What is seen is kept,
    /// whatever is proposed, and costs a search in vain: at most 32 an answer, each again after 16 answers, then 32, up to
    /// 256.
    ///
    /// Proposals stand until the next call; each costs a lookup in each answer. Ids that are stale, or of no object of the
    /// snapshot, are passed over. They do nothing where answers rest on no certificates: without
    /// QuerySettings::proofs, with ::stateless, in parallel views. QueryStats::off tells.
    void propose(std::span<const ObjectId> hidden);

    /// Takes over what another query found out for its last view: who hides whom. For their next 128 answers the two share
    /// the work. The teacher draws, and looks for a certificate of all that it finds hidden, whatever that takes. This one
    /// is spared both: its answers rest on certificates, and keep what has none. At a cut, and where
    /// much comes into sight at once, it draws; where it keeps much more than the teacher, it goes on by itself for some
    /// answers. So the teacher can work on another thread, while the frame is drawn:
    ///
    ///     query.learn(teacher);                       // once the teacher has answered
    ///     VisibleSet set = query.visible(now, view);  // here
    ///     teacher.visible(now, view);                 // meanwhile, on a thread of yours
    ///
    /// Nothing that was learned is believed: each certificate is proved anew for each view, as one of the query's own. The
    /// teacher may have been asked about another snapshot or view. No other thread uses either query during the call. It
    /// does nothing where answers rest on no certificates, as propose() says. After visibleStereo() left eyes learn from
    /// left ones, right from right. O(what the teacher found).
    void learn(Query& teacher);

    /// What the last answer changed against the one before. All objects of the first answer have appeared. Snapshot and
    /// view may have changed in between: objects are known by their ids, and an object that was removed from its world
    /// disappears. O(objects in both answers).
    VisibleChanges changes();

    /// For each object of the last answer's snapshot, in the order of World::add with removed objects
    /// left out: 0 visible, 1 + Stage of the stage that culled it, 255 outside View::layers.
    /// @param reasons  [size: Snapshot::objectCount()]
    /// Of visibleStereo(): 0 if either eye may see it; else a stage that culls what may be visible, or the finer of both.
    void reasons(std::span<uint8_t> reasons) const;
    /// The same of one eye of visibleStereo().
    /// @param eye  kLeftEye or kRightEye; after visible() both are that view
    void reasons(std::span<uint8_t> reasons, uint8_t eye) const;

    /// What the last answer was asked; of visibleStereo(), what the left eye was. Valid until the query's next call.
    /// Before the first answer the snapshot is null.
    struct Asked {
        const Snapshot& snapshot;
        const View& view;
        const QuerySettings& settings;
    };
    Asked asked() const;

    /// The windows that Stage::kPortals saw cells through; none if the stage decided nothing. After visibleStereo()
    /// they are the left eye's.
    std::span<const SeenWindow> windows();
    CellStats cellStats() const;

    /// Why visible(now, view, settings) has the object in its answer or not; see query/explain/explain.h. The last
    /// answer does not change; QuerySettings::hysteresis takes it for the answer before. Of what the last answer kept
    /// without a question it says so, and what a question would say. To explain many objects of one
    /// answer, make an Explainer: it does the shared work once.
    Explanation explain(const Snapshot& now, const View& view, ObjectId id, const QuerySettings& settings = {}) const;

    /// Whether the last answer culled an object by a certificate (QuerySettings::proofs), and whom that names: they and
    /// the object itself hide all of it that lies in the view, and nobody else is needed. After visibleStereo() it is
    /// the left eye's. O(what certificates culled).
    /// @param hiders  receives them, each once; none: it lies outside of the view, or no front of it is seen from there
    bool certificateOf(ObjectId id, Array<Visible>& hiders) const;
    /// The same part by part, for pictures. What lies behind an outline, seen from the eye, and behind the part itself, is
    /// in its shadow: all of the object that lies in the view, and shows its front, is in these shadows together. Where a
    /// slit between two faces is closed, because their sides lie on one line, both are there.
    /// @param outlines  receives the parts that hide something in this view
    /// @param corners   and their corners  [world units]
    bool certificateOf(ObjectId id, Array<HiderOutline>& outlines, Array<glm::dvec3>& corners) const;

    /// The occlusion buffer after the last answer, for pictures: nearness per buffer pixel, row 0 at the bottom, 0
    /// where nothing is known to cover the whole pixel. Occluders that came after the last object are not in it. If the
    /// answer was given by certificates (QuerySettings::proofs), there is none: 0 by 0 pixels.
    struct DepthImage {
        uint32_t width = 0, height = 0;
        bool perspective = true;           ///< nearness is 1/w; else minus the depth in eye space, and 0 is a depth too
        std::span<const float> nearness;   ///< valid until the query's next call
        std::span<const uint8_t> covered;  ///< 1 where there is a depth
    };
    /// After visibleStereo() it is the left eye's.
    /// @param resolve_seams  first resolve all pixels that polygons share, not only those that the answer needed
    DepthImage depthImage(bool resolve_seams = false);

private:
    struct Impl;
    Owned<Impl> impl_;
};

}  // namespace sightline
