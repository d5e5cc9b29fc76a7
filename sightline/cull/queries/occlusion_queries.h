// Occlusion culling by a graphics interface's own depth buffer: which boxes to ask about, when, and what to do meanwhile.
// SPDX-License-Identifier: MIT
//
// Jiri Bittner, Michael Wimmer, Harald Piringer, Werner Purgathofer. Coherent Hierarchical Culling: Hardware Occlusion
// Queries Made Useful. 2004.
// Oliver Mattausch, Jiri Bittner, Michael Wimmer. CHC++: Coherent Hierarchical Culling Revisited. 2008.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include "sightline/base/array.h"
#include "sightline/base/random.h"
#include "sightline/cull/queries/asked_boxes.h"
#include "sightline/cull/queries/query_device.h"
#include "sightline/geom/frustum.h"
#include "sightline/geom/view.h"
#include "sightline/tree/world_bvh.h"

namespace sightline {

enum class QueryMethod : uint8_t {
    kNone,         ///< nothing is asked: draws what the frustum leaves
    kStopAndWait,  ///< each node is asked and waited for, the nearest first
    kChc,          ///< what was seen is drawn at once and asked again; what was hidden is asked, and the walk goes on
    kChcPlusPlus,  ///< what was seen is asked now and then; what was hidden in batches, several nodes a question
};
inline constexpr int kQueryMethods = 4;
inline constexpr const char* kQueryMethodNames[kQueryMethods] = {"none", "stop-and-wait", "chc", "chc++"};

/// Which of the nodes that wait is taken first.
enum class QueryOrder : uint8_t { kNearest, kTree, kFarthest };

struct OcclusionQuerySettings {
    QueryMethod method = QueryMethod::kChcPlusPlus;
    QueryOrder order = QueryOrder::kNearest;
    /// True: what was hidden in the last frame stays hidden until an answer says otherwise, and no answer is waited for.
    /// That is not conservative, and counted; it is what interfaces leave whose answers come a frame late, as a browser's.
    /// Of CHC and CHC++ alone.
    bool never_wait = false;
    uint64_t threshold = 0;  ///< a node that shows no more samples counts as hidden; only 0 is conservative  [samples]
    /// A node of so few items is asked and drawn as one: for items that are drawn in less time than a question takes.  [>= 1]
    uint32_t leaf_items = 1;
    RasterRounding rounding;

    // Of CHC++.
    uint32_t batch = 64;     ///< nodes that were hidden are asked when so many have come together
    uint32_t together = 16;  ///< nodes in one question at most; 1: each by itself
    /// What has come into sight is taken to be seen for about so many frames. Each answer that it still is doubles them, up
    /// to eight times as many.  [>= 1]
    uint32_t seen_frames = 5;
    bool tight_boxes = true;  ///< a node is asked by its children's boxes, if they are not much larger than its own
};

/// What a frame did.
struct OcclusionQueryStats {
    uint32_t visited = 0;          ///< nodes and items that were drawn, opened or asked
    uint32_t outside = 0;          ///< beside these: outside the frustum
    uint32_t at_near = 0;          ///< taken to be seen because their box may reach the near plane
    uint32_t questions = 0;        ///< all of them
    uint32_t boxes = 0;            ///< in them
    uint32_t nodes_asked = 0;      ///< nodes and items in them
    uint32_t together = 0;         ///< questions about several nodes
    uint32_t together_failed = 0;  ///< of these: something was seen, and each node had to be asked by itself
    uint32_t of_seen = 0;          ///< questions about what had been drawn already
    uint32_t switches = 0;         ///< from drawing to asking
    uint32_t waits = 0;            ///< for an answer
    uint32_t drawn = 0;            ///< items
    uint32_t hidden = 0;           ///< items below nodes that this frame's answers call hidden
    uint32_t assumed = 0;  ///< items below nodes that were hidden before, and whose answer has not come: never_wait
};

/// One view's memory from frame to frame, and the walk over the tree that draws and asks. It knows no graphics interface.
///
/// The promise. An item that is not drawn lies outside the frustum, or its box showed no sample behind what was drawn
/// before the question: so the image is, sample for sample, that of all items, if the interface's depth test keeps what is
/// nearest, all items write depth, and `rounding` covers its rounding. This holds for this image's samples alone, not for
/// every point of the scene as the stages of Query promise; and not with a threshold above 0, or with never_wait.
/// Nothing is believed of the frames before: they only say whom to draw first and whom to ask. So items may move, come and
/// go, and the eye may jump. Which of the hidden items are drawn depends on when answers arrive.
///
/// @invariant allocates only when the tree, or what waits in a frame, is larger than ever before
class OcclusionQueries {
public:
    explicit OcclusionQueries(Memory* memory = defaultMemory());

    /// Draws a frame. Questions of CHC and CHC++ stay under way from frame to frame: another device drops them, and the last
    /// one must not have been another device at the same address. A view that is not usable draws all items.  O(nodes that are seen, and the hidden ones beside them).
    /// @returns the items that were drawn, in order; good until the next call
    std::span<const uint32_t> draw(const PlacedBvh& tree, const View& view, QueryDevice& device,
                                   const OcclusionQuerySettings& settings = {});

    const OcclusionQueryStats& stats() const { return stats_; }

private:
    /// What is remembered of a slot (node's index * 8 + slot).
    struct Remembered {
        uint32_t visited = 0;      ///< frame
        uint32_t assumed = 0;      ///< frame in which it was taken to be hidden, and is not drawn: never_wait
        uint32_t ask_again = 0;    ///< frame from which on it is asked again, if it is seen
        uint32_t parent = 0;       ///< slot above it when it was visited
        uint16_t hidden_for = 0;   ///< frames in a row
        uint16_t seen_frames = 0;  ///< until it is asked again; 0: it has come into sight
        bool seen = false;
        bool asked = false;  ///< a question about it is under way
    };
    /// A slot that waits to be visited or asked.
    struct Place {
        double key = 0;  ///< the smallest comes first
        uint32_t slot = 0;
        uint32_t planes = 0;  ///< of the frustum, that it is not wholly inside of
    };
    struct Question {
        uint32_t number = 0;            ///< the device's
        uint32_t frame = 0;             ///< in which it was asked
        uint32_t first = 0, count = 0;  ///< nodes, in asked_
        bool of_seen = false;           ///< about what is drawn already
    };

    void begin(const PlacedBvh& tree, const View& view, QueryDevice& device, const OcclusionQuerySettings& settings);
    void walk();
    void open(uint32_t node, uint32_t parent, uint32_t planes);
    void visit(const Place& place);
    void visitHidden(const Place& place);
    void visitSeen(const Place& place);
    void show(const Place& place);
    void drawBelow(const Place& place);
    void gather(uint32_t child, uint32_t planes);
    void markSeen(uint32_t slot);

    void ask(std::span<const Place> places, bool of_seen);
    void askHidden();
    bool askOneSeen();
    bool takeAnswer(bool wait);
    void takeOfSeen(const Question& question, bool seen);
    void takeOfHidden(const Question& question, bool seen);
    void takeLate(const Place& place);

    bool isLeaf(uint32_t slot) const;
    uint32_t childOf(uint32_t slot) const;
    uint32_t itemsBelow(uint32_t slot) const;
    bool wasSeen(const Remembered& slot) const;
    static bool comesLater(const Place& a, const Place& b);
    Place nextWaiting();
    double keyOf(const Box3f& box);
    Box3d paddedBox(const Box3f& box) const;  ///< @param box  relative to the tree's origin

    // From frame to frame.
    Array<Remembered> remembered_;  ///< per slot
    Array<Question> questions_;     ///< those under way begin at first_question_
    Array<Place> asked_;            ///< nodes of questions_
    Array<uint32_t> free_numbers_;
    uint32_t numbers_ = 0;  ///< of questions, that were ever used
    uint32_t frame_ = 1;
    Random random_{1};

    // Of one frame.
    const PlacedBvh* tree_ = nullptr;
    QueryDevice* device_ = nullptr;
    OcclusionQuerySettings settings_;
    Frustum frustum_;
    std::optional<BoxPadding> padding_;
    glm::dvec3 forward_{0.0};  ///< of a parallel view; else zero
    Array<Place> waiting_;     ///< a heap
    Array<Place> hidden_;      ///< were hidden, and are to be asked
    Array<Place> seen_;        ///< were drawn, and are to be asked; begin at first_seen_
    Array<Box3f> tight_;
    Array<Box3d> boxes_;
    Array<uint32_t> drawn_;
    size_t first_question_ = 0, first_seen_ = 0;
    uint32_t open_questions_ = 0;  ///< of this frame, that it cannot end without
    double opened_ = 0;            ///< slots that have waited
    bool asking_ = false;          ///< the device's last call was a question
    OcclusionQueryStats stats_;
};

}  // namespace sightline
