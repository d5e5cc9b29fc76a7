// What the stages keep from frame to frame: cells and what is seen from them, volumes, and clusters.
// SPDX-License-Identifier: MIT
//
// John Airey, John Rohlf, Frederick Brooks. Towards Image Realism with Interactive Update Rates in Complex Virtual
// Building Environments. 1990.
// David Luebke, Chris Georges. Portals and Mirrors: Simple, Fast Evaluation of Potentially Visible Sets. 1995.
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998.
// Thomas Funkhouser, Carlo Sequin. Adaptive Display Algorithm for Interactive Frame Rates During Visualization of Complex
// Virtual Environments. 1993.
// Ulrich Haar, Sebastian Aaltonen. GPU-Driven Rendering Pipelines. 2015.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sightline/base/assert.h"
#include "sightline/cells/portals.h"
#include "sightline/cells/pvs.h"
#include "sightline/cull/occluder_volumes.h"
#include "sightline/frame/candidates.h"
#include "sightline/frame/draw_range.h"
#include "sightline/frame/frame.h"
#include "sightline/frame/traversal_state.h"
#include "sightline/lod/lod_budget.h"
#include "sightline/lod/lod_choice.h"
#include "sightline/world/world.h"

namespace sightline::detail {

/// Keeps the rows of visibility as long as the eye's cells stay the same, and the objects in them as long as the
/// snapshot stays the same. begin(), then findRows(), then findWindows(), for each view.
class CellMemory {
public:
    explicit CellMemory(Memory* memory)
        : start_(memory),
          view_start_(memory),
          pvs_(memory),
          seen_objects_(memory),
          flood_(memory),
          candidates_(memory) {}

    /// Lets go of the snapshot that was asked last.
    void forget() {
        now_ = {};
        pvs_of_ = nullptr;
        stages_ = 0;
        rows_filled_ = flooded_ = false;
    }
    /// Takes up a view: finds the cells that the eye may be in.
    void begin(const Frame& frame);
    /// Stage::kPvs: the candidates are the objects that the rows of the eye's view cells show or, without these, the
    /// objects in cells that the rows of its cells show.  O(these objects), when the eye comes into other cells.
    void findRows(const Frame& frame);
    /// Stage::kPortals: the candidates are those of the rows' candidates that reach into windows.
    void findWindows(const Frame& frame);
    /// The candidates that both stages leave; null: neither culls anything. Good until the next view.
    const Candidates* candidates() { return stages_ ? &candidates_ : nullptr; }

    /// How many objects were kept in the last view because the eye is in no cell or the work was spent.
    uint64_t doubt(Stage stage) const {
        SIGHTLINE_DEBUG_ASSERT(stage == Stage::kPvs || stage == Stage::kPortals);
        return doubt_[static_cast<int>(stage)];
    }
    /// The cells that the eye may be in; empty if it is in none, or if the stages are off.
    std::span<const uint32_t> start() const { return start_; }
    /// The view cells that the eye may be in; empty if their rows decided nothing.
    std::span<const uint32_t> viewStart() const { return view_start_; }
    /// Null unless Stage::kPortals decided something.
    const PortalFlood* flood() const { return flooded_ ? &flood_ : nullptr; }
    const PortalStats& portalStats() const { return portal_stats_; }

private:
    bool uses(Stage stage) const { return stages_ & stageBit(stage); }
    void giveUp(Stage stage, const Frame& frame);
    void fillRows();
    bool showMost() const;
    void fillWindows(const glm::dvec3& eye);

    Snapshot now_;  ///< the snapshot of `candidates_`
    uint32_t layers_ = 0;
    uint32_t stages_ = 0;  ///< those of the two stages that decide
    bool rows_filled_ = false;
    Array<uint32_t> start_, view_start_;
    PotentiallyVisible pvs_;           ///< rows of cells
    PotentiallyVisible seen_objects_;  ///< rows of view cells: objects of the file
    std::shared_ptr<const AttachedCells> pvs_of_;
    PortalFlood flood_;
    Candidates candidates_;
    bool flooded_ = false;
    PortalStats portal_stats_;
    uint64_t doubt_[2] = {};
};

/// Chooses the volumes of a view. Its scratch stays from view to view.
///
/// Candidates are found by a descent of its own over the hierarchy, the nodes first that look largest from the eye,
/// within limits that count work: so the choice is the same everywhere. Every face and every body of an object that is
/// met gets an estimate of the pixels that it may cover, its solid angle; volumes are made for the best, and of these
/// the ones are taken that hold the most objects, as far as the topmost boxes of the hierarchy tell (ground covers many
/// pixels, and hides nothing), but none whose occluder another one hides. Occluders need not be visible (OccluderVolume
/// says why), but their objects must be in the view's layers: only what is surely drawn, or hidden by what is drawn,
/// hides.
class VolumeChooser {
public:
    static constexpr uint32_t kMostVolumes = 64;
    static constexpr uint32_t kMostNodes = 32;    ///< opened while choosing
    static constexpr uint32_t kMostObjects = 64;  ///< looked at while choosing
    static constexpr uint32_t kMostOfObject = 8;  ///< parts of one object that are estimated

    explicit VolumeChooser(Memory* memory)
        : volumes_(memory), owners_(memory), heap_(memory), places_(memory), candidates_(memory), made_(memory) {}

    /// Writes Frame::volumes; they are good until the next view. Objects hide nothing if they are no candidates, too
    /// far, too small, or cut by a section.
    void choose(Frame& frame);

private:
    struct Met {
        double pixels = 0;
        uint32_t serial = 0;
        uint32_t index = 0;  ///< node, or place of an object
        uint32_t planes = 0;
        uint8_t depth = 0;  ///< below the root; 2 stands for more
        bool leaf = false;
        bool operator<(const Met& other) const {
            return pixels != other.pixels ? pixels < other.pixels : serial > other.serial;
        }
    };
    struct Candidate {
        double pixels = 0;
        uint32_t owner = 0;  ///< index into places_
        uint32_t part = 0;
        uint32_t object = 0;  ///< place
    };
    struct Made {
        uint32_t object = 0;
        OccluderVolume volume;
        VolumeOutline outline;
    };

    void gather(const Frame& frame, const VolumeView& shared);
    void openNode(const Frame& frame, const VolumeView& shared, const Met& from);
    void lookAt(const Frame& frame, const VolumeView& shared, uint32_t place);
    void take(const VolumeView& shared, uint32_t most);
    double heldObjects(const OccluderVolume& volume) const;

    Array<OccluderVolume> volumes_;
    Array<uint32_t> owners_;  ///< per volume
    Array<Met> heap_;
    Array<VolumePlace> places_;
    Array<Candidate> candidates_;
    Array<Made> made_;
    /// The boxes of the root's children and of their children, with how many objects in view each has.
    struct Top {
        EyeBoxes boxes;
        float objects[8];
    };
    Top top_[9];
    uint32_t top_count_ = 0;
    double least_ = 0;  ///< a part that covers less is not worth a volume  [pixels]
    uint32_t serial_ = 0;
};

/// An answer as the last stages work on it.
struct AnswerView {
    Array<Visible>& visible;
    QueryStats& stats;
    std::span<DepthTiles* const> tiles;  ///< of each part of the image; none if the view is not usable
    std::span<VisibleLod> lods = {};     ///< per object; empty: no levels were chosen
};

/// The levels of detail of one answer, and what is remembered of the one before.
///
/// An object of which the last answer had a level keeps to it as LodRule says. One that was not in it begins with the
/// coarsest level that may be drawn, and nothing is faded. An object without bounds has its finest level.
class LodMemory {
public:
    explicit LodMemory(Memory* memory)
        : lods_(memory), items_(memory), asked_(memory), chosen_(memory), remembered_(memory), culled_(memory) {}

    /// Chooses a level for each object, and removes from the answer what a hard budget leaves out.
    /// @param frames  one, or those of both eyes: then a level is good enough for either, and nothing is left out
    void run(std::span<const Frame* const> frames, Array<Visible>& visible, QueryStats& stats);
    /// Forgets the levels of the answer at hand, not what is remembered of it.
    void clear();

    /// Per object of the answer; empty if no levels were chosen.
    std::span<VisibleLod> lods() { return lods_; }
    std::span<const VisibleLod> lods() const { return lods_; }
    /// Writes the objects that were left out into an answer's reasons.
    void reasons(const SnapshotState& now, std::span<uint8_t> reasons) const;
    bool leftOut(uint32_t row) const;

private:
    struct Remembered {
        uint32_t generation = 0;
        uint32_t answer = 0;
        LodState state;
    };
    /// An object of the answer.
    struct Asked {
        uint32_t row = 0;
        double unit = 0;     ///< pixels of a unit of the object's space
        bool known = false;  ///< the last answer had a level of it
        LodState last;
        LodRange range;
    };

    void ask(std::span<const Frame* const> frames, const Visible& object);
    void spendBudget(const QuerySettings& settings, bool may_leave_out, QueryStats& stats);
    void settle(const Frame& frame, Array<Visible>& visible, QueryStats& stats);
    std::span<const LodLevel> levelsOf(const SnapshotState& world, uint32_t row) const;

    Array<VisibleLod> lods_;
    LodBudget budget_;
    Array<LodItem> items_;
    Array<Asked> asked_;
    Array<uint8_t> chosen_;         ///< per object of the answer: a level, or LodBudget::kLeftOut
    Array<Remembered> remembered_;  ///< by ObjectId::index
    Array<uint32_t> culled_;        ///< rows
    uint32_t answer_ = 0;
};

/// The clusters of one answer. Its arrays stay from answer to answer.
///
/// Clusters are hidden by what the traversal drew. That is sound as the second look is: along each ray the nearest
/// point of all that is drawn has nothing in front of it, so that its cluster is kept, and hides what others hid. Of an
/// image in parts a cluster is hidden if it is in each part that it meets. Where nothing was drawn, none is.
class ClusterMemory {
public:
    explicit ClusterMemory(Memory* memory) : ranges_(memory), culled_(memory), left_(memory) {}

    /// Looks at the clusters of the kept objects, removes objects without a cluster left from the answer, and counts.
    void run(const Frame& frame, AnswerView& answer);
    void clear();

    std::span<const DrawRange> ranges() const { return ranges_; }
    /// Counts what the stage finds of one object's clusters. The answer of the same frame must keep the object.
    QueryStats look(const Frame& frame, uint32_t row, AnswerView& answer);
    /// Writes the objects that it culled into an answer's reasons.
    void reasons(const SnapshotState& now, std::span<uint8_t> reasons) const;

private:
    bool select(const Frame& frame, const DrawClusters& clusters, const ObjectRecord& object,
                std::span<DepthTiles* const> tiles, uint32_t visible, QueryStats& stats);
    void findFacing(const DrawClusters& clusters, const ObjectRecord& object, const View& view, const Screen* screen,
                    QueryStats& stats);
    void findSeen(const DrawClusters& clusters, const Frame& frame, const Screen& screen,
                  std::span<DepthTiles* const> tiles, QueryStats& stats);
    void addRanges(const DrawClusters& clusters, uint32_t gap, uint32_t visible, QueryStats& stats);

    Array<DrawRange> ranges_;
    Array<uint32_t> culled_;  ///< rows
    Array<uint8_t> left_;     ///< a bit per cluster of the object at hand
};

struct StageMemory {
    explicit StageMemory(Memory* memory) : cells(memory), volumes(memory), lods(memory), clusters(memory) {}

    CellMemory cells;
    VolumeChooser volumes;
    LodMemory lods;
    ClusterMemory clusters;
};

}  // namespace sightline::detail
