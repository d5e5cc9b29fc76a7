// The walk behind a query: front to back over the hierarchy, stage by stage; and what it notes on request.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993.
#pragma once

#include <cstdint>

#include "sightline/cull/bounds.h"
#include "sightline/cull/frustum.h"
#include "sightline/cull/occlusion.h"
#include "sightline/cull/triangles.h"
#include "sightline/geom/view_limits.h"
#include "sightline/raster/tile_log.h"
#include "sightline/run/admission.h"
#include "sightline/run/last_drawn.h"
#include "sightline/run/pending.h"
#include "sightline/run/query.h"
#include "sightline/run/size_stages.h"
#include "sightline/run/volumes.h"
#include "sightline/run/world_state.h"

namespace sightline::detail {

/// A node on the way down, and the planes that it is not inside of.
struct Visit {
    uint32_t node = 0;
    uint32_t planes = 0;  ///< bits of the frustum's, and from kLimitBit on of the view's limits
    VolumeRange volumes;  ///< that it crosses
};

inline constexpr uint32_t kLimitBit = 6;

/// What an object was asked by.
enum class Look : uint8_t {
    kBox,        ///< the rectangle around its box, with the box's nearest depth
    kFaces,      ///< the faces of its box
    kTriangles,  ///< its own triangles
};

/// An object that was kept, and will be asked by its triangles.
struct SecondLook {
    Pending entry;
    uint32_t visible = 0;  ///< index into Walk::visible
};

/// Which part of a view is walked: the whole of it, or one of its bins.
struct Bin {
    uint32_t index = 0, count = 1;
    uint32_t first_column = 0, end_column = 0;  ///< of tiles; not used of the whole
};

inline constexpr uint32_t kMostBins = 16;

/// A bin of equal widths.
/// @param columns  of the buffer  [tiles]
Bin binOf(uint32_t index, uint32_t count, uint32_t columns);

/// How many bins a view is walked in: View::bins, or 1 where there is nothing to share out.
uint32_t binCount(const View& view);

/// An object that a bin keeps.
struct KeptObject {
    uint32_t place = 0;
    float nearness = 0;  ///< by which it was in line
};

/// Objects that were culled together.
struct CulledRange {
    PlaceRange places;
    Stage stage = Stage::kFrustum;
};

/// What a walk did, step by step, for those who ask why. Places are the hierarchy's.
struct WalkRecord {
    static constexpr uint32_t kNowhere = ~0u;

    /// A cluster that was rasterized.
    struct Draw {
        uint32_t instance = 0;  ///< index into Walk::instances
        uint32_t cluster = 0;
        uint32_t triangles = 0;
        BoxAnswer box;
    };
    /// Objects that were culled together, and what they were taken for.
    struct Cull {
        PlaceRange places;
        Stage stage = Stage::kFrustum;
        bool off_screen = false;    ///< the rectangle misses the buffer; no plane decided
        PixelRect rect;             ///< by the occlusion stage: what was hidden
        uint32_t hider = kNowhere;  ///< by a volume: the place of the object that hides it
        Look look = Look::kBox;     ///< that decided
        bool boxed = true;          ///< the rectangle is that of the box; else its box has none
    };
    /// The rectangle of the object at `stop_at`, where it was kept.
    struct Kept {
        PixelRect rect;
        bool testable = false;   ///< the occlusion stage could look at it
        Look look = Look::kBox;  ///< the last that was tried
    };

    Array<Draw> draws;
    Array<Cull> culls;
    Array<uint32_t> owners;       ///< per Walk::instances: the object's place
    uint32_t stop_at = kNowhere;  ///< the walk ends once the occlusion stage has decided on this place
    bool stopped = false;         ///< it did, and the depth tiles are as they were then
    Kept kept;
    TileLog* log = nullptr;  ///< takes down each call of the depth tiles in its order, if there is one

    explicit WalkRecord(Memory* memory) : draws(memory), culls(memory), owners(memory) {}

    void clear();
    bool stopsAt(const PlaceRange& places) const {
        return stop_at >= places.first && stop_at - places.first < places.count;
    }
};

/// Writes down which stage of cells culls what: 1 + Stage per item.
void notAdmitted(const SnapshotState& state, const Admission& admission, std::span<uint8_t> reasons);

/// One answer in the making, or one bin's part of it. What it needs stays from walk to walk.
///
/// A bin's walk is that of the whole view, in a buffer of which all beside the bin's columns is hidden. What the
/// frustum and the volumes decide about a node does not hang on the bin; nodes and objects that lie beside it are passed
/// over without a word.
struct Walk {
    explicit Walk(Memory* from) : memory(from) {}

    Memory* const memory;
    const SnapshotState* snapshot = nullptr;  ///< outlives the answer; null: there is none
    View view;
    Bin bin;
    WalkRecord* record = nullptr;  ///< filled, if there is one
    /// What the stages of cells leave; set before run(), outlives the answer. Null: everything. What is not admitted is
    /// passed over without a word: they have counted it.
    const Admission* admission = nullptr;
    bool every_layer = true;  ///< no object is outside the view's layers
    Frustum frustum;
    ViewLimits limits;
    RefinedVolume refined;  ///< of both, if `refining`
    bool refining = false;  ///< View::refinement
    Screen screen;
    SizeStages sizes;  ///< SizeStages::shown is set before run()
    VolumeStage volumes{memory};
    DepthTiles tiles{memory};
    bool remembers = false;  ///< `last` is kept from answer to answer: of a query, not of those who ask why
    LastDrawn last{memory};
    PendingQueue pending{memory};
    Array<Visit> visits{memory};
    Array<OccluderInstance> instances{memory};
    Array<Visible> visible{memory};
    Array<KeptObject> kept{memory};  ///< of a bin: who stands in `visible`, one by one
    Array<double> work{memory};      ///< with View::balance_bins: per column of tiles what was done there, less what
                                     ///< was done in the one before  [nanoseconds, or so]
    Array<CulledRange> culled{memory};
    Array<SecondLook> second{memory};
    TriangleScratch looks{memory};
    QueryStats stats;
    uint32_t undecided = 0;  ///< nodes and objects in line; without any, nothing is left to hide

    Visit root;  ///< all that stages may ask

    const SnapshotState& state() const { return *snapshot; }
    bool uses(Stage stage) const { return view.stages & stageBit(stage); }
    StageStats& of(Stage stage) { return stats.stages[static_cast<int>(stage)]; }

    /// The whole answer: `visible`, `culled` and `stats`, but for the time that it took.
    void run(const SnapshotState* now, const View& new_view) { run(now, new_view, {}); }
    /// The same of a bin, of which `stats` has what it did, but for the objects that its stages culled; and of objects
    /// without bounds nothing.
    void run(const SnapshotState* now, const View& new_view, const Bin& part);
    /// As Query::reasons(), of the whole view.
    void reasons(std::span<uint8_t> reasons) const;
    /// How many objects of a range of places are within the view's layers, and admitted.
    uint64_t inLayers(const PlaceRange& places) const;
    /// The part of an object's rectangle that lies where its cells are seen. An empty one has its right edge left of its
    /// left one, or its top below its bottom.
    PixelRect inWindow(uint32_t place, PixelRect rect) const;
    /// Keeps an object that no stage can look at.
    void keep(const ObjectRecord& object);

private:
    bool isPart() const { return bin.count > 1; }
    bool liesBeside(const Screen& from, const Box3f& box) const;
    bool isBeside(const BoxAnswer& on_screen, const Screen& from, const Box3f& box) const;
    uint32_t findBeside(const ScreenAnswer& on_screen, const EyeBoxes& boxes, uint32_t of) const;
    bool isHiddenHere(PixelRect rect, Seams seams);
    void countWork(PixelRect rect, bool on_screen, double cost);
    void begin(const SnapshotState* now, const View& new_view);
    void keepEverything();
    void walk();
    uint32_t cullBySize(uint32_t node, const EyeBoxes& boxes, uint32_t left);
    void chooseVolumes();
    FrustumAnswer askPlanes(const EyeBoxes& boxes, uint32_t planes) const;
    void chooseRefinement();
    uint32_t refine(const EyeBoxes& boxes, const FrustumAnswer& answer) const;
    void walkUnordered();
    void expand(const Visit& from, uint32_t slots = 0xff);
    void expandAll();
    uint32_t cutToWindows(const BvhNode& node, uint32_t left, ScreenAnswer& on_screen);
    uint32_t admittedSlots(const BvhNode& node) const;
    VolumesAnswer askVolumes(const BvhNode& node, const EyeBoxes& boxes, VolumeRange range, uint32_t left);
    void meet(const BvhNode& node, int slot, const Visit& below, const ScreenAnswer& on_screen);
    void visit(const Pending& entry);
    bool lookCloser(const Pending& entry);
    void lookAgain();
    bool hasSecondLook(const ObjectRecord& object) const;
    bool settle(const Pending& entry, Look look, Sight sight, uint64_t& count);
    void report(uint32_t first, uint32_t count);
    void reportAdmitted(uint32_t first, uint32_t count);
    void drawLast();
    void offerVisible(uint32_t place);
    void offerOccluder(uint32_t place, bool in_line);
    bool mayHide(uint32_t place) const;
    void draw(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box);
    void cull(const PlaceRange& places, Stage stage, const PixelRect* rect, uint32_t hider = WalkRecord::kNowhere);
    void push(const Pending& entry);
    void finish();
    void noteDraw(const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box, uint32_t triangles);
    void noteCull(const PlaceRange& places, Stage stage, const PixelRect* rect, uint32_t hider);
    void noteKept(const Pending& entry, Look look);
};

}  // namespace sightline::detail
