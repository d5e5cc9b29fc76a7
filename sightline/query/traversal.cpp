// The descent over the world's tree: front to back, or in any order where nothing is hidden; each node through the stages.
// SPDX-License-Identifier: MIT
#include "sightline/query/traversal.h"

#include <algorithm>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/buffer/validate_tiles.h"
#include "sightline/query/observers.h"
#include "sightline/stages/occlusion.h"
#include "sightline/stages/pipeline.h"
#include "sightline/tree/descend.h"

namespace sightline::detail {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// The rows of the pipeline that a frame uses, by moment.
struct RowsInUse {
    const PipelineStep* by_box[std::size(kPipeline)];
    const PipelineStep* by_rect[std::size(kPipeline)];
    const PipelineStep* in_turn[std::size(kPipeline)];
    uint32_t boxes = 0, rects = 0, turns = 0;
    const PipelineStep* at_end = nullptr;

    RowsInUse(const Frame& frame, bool drawn) {
        const PipelineStep::In other = drawn ? PipelineStep::In::kProved : PipelineStep::In::kDrawn;
        for (const PipelineStep& row : kPipeline) {
            if (!frame.uses(row.stage) || (row.stage == Stage::kVolumes && frame.volumes.empty())) continue;
            if (row.in == other) continue;
            if (row.by_box) by_box[boxes++] = &row;
            if (row.by_rect) by_rect[rects++] = &row;
            if (row.in_turn) in_turn[turns++] = &row;
            if (row.at_end) at_end = &row;
        }
    }
};

template <class Observer>
class Traversal {
public:
    Traversal(const Frame& frame, TraversalState& state, Observer& observer)
        : frame_(frame),
          state_(state),
          observer_(observer),
          drawn_(state.proofs.way() != ProofMemory::Way::kProofs),
          rows_(frame, drawn_) {}

    void run() {
        observer_.begin(frame_, state_);
        if (!frame_.world) return;
        if (!frame_.usable) return keepEverything();
        const bool in_order = frame_.uses(Stage::kOcclusion);
        if (in_order && drawn_) clearTiles();
        if (state_.part.whole())
            for (const uint32_t row : frame_.world->unbounded) keepInDoubt(frame_.world->objects[row]);
        if (!frame_.world->bvh.nodes.empty()) in_order ? runInOrder() : runInAnyOrder();
        validateTiles(state_.tiles);
        state_.stats.seam_pixels = state_.tiles.seam_pixels;
        state_.stats.closed_gaps = state_.tiles.closed_gaps;
    }

private:
    void clearTiles() {
        DepthTiles& tiles = state_.tiles;
        tiles.clear(frame_.screen.width, frame_.screen.height,
                    frame_.settings.masked ? OcclusionDetail::kMasked : OcclusionDetail::kFull);
        tiles.gap = closedGap(frame_.settings);
        if (!state_.part.whole()) tiles.keepColumns(state_.part.first_column, state_.part.end_column);
    }

    /// Without a usable view nothing can be proved hidden.
    void keepEverything() {
        for (uint32_t item = 0; item < frame_.world->count; ++item) keepInDoubt(frame_.world->object(item));
    }

    /// Keeps an object that no stage can look at.
    void keepInDoubt(const ObjectRecord& object) {
        if (!(object.layers & frame_.view.layers)) return;
        state_.visible.push_back({object.key, object.id});
        ++state_.stats.of(Stage::kFrustum).doubt;
    }

    /// Keeps the candidates at the given places of the hierarchy.
    void keep(uint32_t first, uint32_t count) {
        SIGHTLINE_DEBUG_ASSERT(count > 0 && first + count <= frame_.world->placed.size());
        const auto keepOne = [&](const PlacedObject& placed) {
            if (placed.layers & frame_.view.layers) state_.visible.push_back(placed.visible);
        };
        const PlacedObjectTable& placed = frame_.world->placed;
        if (count == 1) return keepOne(placed[first]);
        if (frame_.candidates)
            return frame_.candidates->forEach(first, first + count, [&](uint32_t place) { keepOne(placed[place]); });
        while (count > 0) {
            const std::span<const PlacedObject> run = placed.run(first, count);
            for (const PlacedObject& one : run) keepOne(one);
            first += static_cast<uint32_t>(run.size());
            count -= static_cast<uint32_t>(run.size());
        }
    }

    void noteCulled(const PlaceRange& places, Stage stage) {
        state_.stats.of(stage).culled += frame_.countObjects(places);
        state_.culled.push_back({places, stage});
    }

    /// Lets stages look at a node's children, one stage after the other.
    /// @returns the children that are left
    uint32_t narrow(const PipelineStep* const* rows, uint32_t count, bool by_rect, Group& group, uint32_t live) {
        for (uint32_t i = 0; i < count && live; ++i) {
            const PipelineStep& row = *rows[i];
            observer_.enter();
            const uint32_t gone = (by_rect ? row.by_rect : row.by_box)(frame_, state_, group, live);
            observer_.leave(row.stage, state_);
            SIGHTLINE_DEBUG_ASSERT((gone & ~live) == 0);
            forEachSlot(gone, [&](int slot) {
                const PlaceRange places = placesBelow(group.node, slot);
                noteCulled(places, row.stage);
                observer_.culled(places, row.stage, by_rect ? &group.on_screen.rects[slot] : nullptr,
                                 row.stage == Stage::kVolumes ? group.hider[slot] : TraversalRecord::kNowhere);
            });
            live &= ~gone;
        }
        return live;
    }

    /// Where certificates are sought for what is hidden.
    void noteHidden(const Pending& entry) {
        if (!state_.notes_hidden) return;
        state_.proofs.hidden.push_back({entry.box, entry.index, entry.kind, entry.below});
    }

    Group groupOf(uint32_t index, uint32_t planes) {
        SIGHTLINE_DEBUG_ASSERT(index < frame_.world->bvh.nodes.size());
        ++state_.stats.nodes_visited;
        const PlacedBvh& bvh = frame_.world->bvh;
        const BvhNode& node = bvh.nodes[index];
        return {index, node, eyeBoxes(node, bvh.origin - frame_.frustum.eye), planes};
    }

    uint32_t rootPlanes() const { return frame_.uses(Stage::kFrustum) ? allPlanes(frame_) : 0; }

    /// Calls open(node, slots) where the descent begins: at the root or, of few candidates, at the nodes that hold
    /// them.
    template <class Open>
    void forEachStart(Open&& open) {
        const std::span<const NodeSlots> starts = frame_.starts();
        if (starts.empty()) open(0u, frame_.candidateSlots(frame_.world->bvh.nodes[0]));
        for (const NodeSlots& start : starts) open(start.node, start.slots);
    }

    // Front to back: each node and object waits in the queue until it is the nearest, is then asked whether it is
    // hidden, and what is kept hides what is behind it.

    void runInOrder() {
        forEachStart([&](uint32_t node, uint32_t slots) { open(node, rootPlanes(), slots); });
        descendInOrder(
            state_.queue, [&] { return waiting_ > 0 && !ended(); }, [&](const Pending& entry) { takeTurn(entry); });
        if (ended()) return;
        // The looks at the end ask a buffer in which all is drawn that was found: their answers do not depend on when
        // the last object was decided.
        while (!state_.second.empty() && !state_.queue.empty()) takeTurn(state_.queue.pop());
        lookAgain();
    }

    /// The observer knows enough, or certificates do not do for this view.
    bool ended() const { return observer_.ended() || (!drawn_ && state_.proofs.way() != ProofMemory::Way::kProofs); }

    void queue(const Pending& entry) {
        waiting_ += entry.kind != Pending::Kind::kCluster;
        state_.queue.push(entry);
    }

    /// Lets the stages look at a node's children and queues those that are left.
    void open(uint32_t index, uint32_t planes, uint32_t slots) {
        SIGHTLINE_DEBUG_ASSERT(slots <= 0xff && (planes & ~rootPlanes()) == 0);
        Group group = groupOf(index, planes);
        uint32_t live = narrow(rows_.by_box, rows_.boxes, false, group, slots);
        if (!live) return;
        group.on_screen = projectBoxes(frame_.screen, group.boxes);
        live = narrow(rows_.by_rect, rows_.rects, true, group, live);
        forEachSlot(live, [&](int slot) {
            if (state_.part.whole() || !liesBeside(group, slot)) queueChild(group, slot);
        });
    }

    bool liesBeside(const Group& group, int slot) const {
        const BoxAnswer answer(group.on_screen, slot);
        if (answer.outside) return false;
        if (!answer.doubt) {
            PixelRect rect = answer.rect;
            return !state_.tiles.clip(rect);
        }
        return state_.part.misses(frame_.screen, boxOf(group.boxes, slot));
    }

    void queueChild(const Group& group, int slot) {
        const BoxAnswer answer(group.on_screen, slot);
        const bool leaf = group.node.child[slot] & BvhNode::kLeaf;
        Pending entry;
        entry.kind = leaf ? Pending::Kind::kObject : Pending::Kind::kNode;
        entry.index = group.node.child[slot] & ~BvhNode::kLeaf;
        entry.below = placesBelow(group.node, slot);
        entry.planes = group.planes[slot];
        entry.rect = answer.rect;
        entry.box = boxOf(group.boxes, slot);
        if (answer.doubt) entry.rect.nearness = kInfinity;
        if (answer.outside) entry.rect.nearness = -kInfinity;
        entry.testable = !answer.doubt && !answer.outside;
        if (answer.doubt && leaf) ++state_.stats.of(Stage::kOcclusion).doubt;
        queue(entry);
    }

    void takeTurn(const Pending& entry) {
        if (entry.kind == Pending::Kind::kCluster) return takeTurnOfCluster(entry);
        SIGHTLINE_DEBUG_ASSERT(waiting_ > 0);
        --waiting_;
        TurnAnswer answer;
        for (uint32_t i = 0; i < rows_.turns; ++i) {
            answer = rows_.in_turn[i]->in_turn(frame_, state_, entry);
            if (answer.settled) break;
            if (!answer.culled) continue;
            noteCulled(entry.below, answer.stage);
            noteHidden(entry);
            state_.turns.note(entry, false);
            observer_.culledInTurn(entry, answer.stage, answer.look);
            if (answer.drawn) offerOccluder(entry, state_.second.size());
            return;
        }
        if (!answer.settled && answer.look != Look::kTriangles) state_.turns.note(entry, true);
        if (entry.kind == Pending::Kind::kNode)
            return open(entry.index, entry.planes, frame_.candidateSlots(frame_.world->bvh.nodes[entry.index]));
        keepObject(entry, answer.look);
    }

    /// @param look  the last that it was asked by; triangles: it will be
    void keepObject(const Pending& entry, Look look) {
        SIGHTLINE_DEBUG_ASSERT(entry.kind == Pending::Kind::kObject && entry.index == entry.below.first);
        keep(entry.index, 1);
        if (!state_.part.whole() && state_.kept.size() < state_.visible.size())
            state_.kept.push_back({entry.index, entry.rect.nearness});
        const bool again = look == Look::kTriangles;
        if (!again) observer_.kept(entry, look);
        offerOccluder(entry, state_.second.size() - (again ? 1 : 0));
    }

    /// Queues the clusters of an object's occluder, or draws it at once if there is one only.
    /// @param others  objects that will be looked at again: where nothing else is left to ask, it hides nothing
    void offerOccluder(const Pending& entry, size_t others) {
        if (!drawn_ || (waiting_ == 0 && others == 0)) return;
        if (entry.testable && !mayHideEnough(frame_.screen, entry.rect, PlaneMesh::kLeastCost)) return;
        const uint32_t place = entry.index;
        const OfferedOccluder offered = occluderOf(frame_, place);
        if (!offered.occluder) return;
        const Occluder& occluder = *offered.occluder;
        const auto owner = static_cast<uint32_t>(state_.instances.size());
        state_.instances.push_back(
            makeOccluderInstance(frame_.screen, occluder, frame_.world->objectAt(place).transform));
        observer_.offered(place);
        const auto clusters = static_cast<uint32_t>(occluder.clusters.size());
        ScreenAnswer eight;
        for (uint32_t cluster = 0; cluster < clusters; ++cluster) {
            const OccluderInstance& instance = state_.instances[owner];
            if (cluster % 8 == 0) eight = projectClusters(instance.screen, occluder, cluster);
            const BoxAnswer box(eight, static_cast<int>(cluster % 8));
            if (!mayDraw(frame_, state_, offered, instance, cluster, box)) continue;
            if (clusters == 1) {
                draw(owner, cluster, box);
                continue;
            }
            Pending entry;
            entry.kind = Pending::Kind::kCluster;
            entry.index = cluster;
            entry.owner = owner;
            entry.rect = box.rect;
            if (box.doubt) entry.rect.nearness = kInfinity;
            entry.testable = !box.doubt;
            queue(entry);
        }
    }

    void takeTurnOfCluster(const Pending& entry) {
        SIGHTLINE_DEBUG_ASSERT(drawn_ && entry.owner < state_.instances.size());
        BoxAnswer box;
        box.rect = entry.rect;
        box.doubt = !entry.testable;
        if (box.doubt || !isHiddenHere(state_, box.rect, Seams::kLeave)) draw(entry.owner, entry.index, box);
    }

    void draw(uint32_t instance, uint32_t cluster, const BoxAnswer& box) {
        SIGHTLINE_DEBUG_ASSERT(drawn_ && instance < state_.instances.size());
        uint32_t triangles = 0;
        if (drawCluster(frame_, state_, state_.instances[instance], cluster, box, triangles))
            observer_.drawn(instance, cluster, box, triangles);
    }

    /// Asks kept objects once more, now that all occluders are drawn.
    void lookAgain() {
        size_t gone = 0;
        for (const SecondLook& next : state_.second) {
            SIGHTLINE_DEBUG_ASSERT(rows_.at_end && next.visible < state_.visible.size());
            const TurnAnswer answer = rows_.at_end->at_end(frame_, state_, next);
            state_.turns.note(next.entry, !answer.culled);
            if (answer.culled) {
                noteCulled(next.entry.below, answer.stage);
                noteHidden(next.entry);
                observer_.culledInTurn(next.entry, answer.stage, answer.look);
                state_.visible[next.visible].id = ObjectId();
                ++gone;
            } else {
                observer_.kept(next.entry, answer.look);
            }
            if (observer_.ended()) break;
        }
        if (gone) removeTaken();
    }

    /// Closes the gaps that objects without an id leave.
    void removeTaken() {
        SIGHTLINE_DEBUG_ASSERT(state_.kept.empty() || state_.kept.size() == state_.visible.size());
        size_t left = 0;
        for (size_t i = 0; i < state_.visible.size(); ++i) {
            if (state_.visible[i].id == ObjectId()) continue;
            if (!state_.kept.empty()) state_.kept[left] = state_.kept[i];
            state_.visible[left++] = state_.visible[i];
        }
        state_.visible.resize(left);
        if (!state_.kept.empty()) state_.kept.resize(left);
    }

    // In any order: level by level, so that nodes can be fetched ahead. A subtree of which no stage can cull a part is
    // kept at once.

    void runInAnyOrder() {
        Array<NodeVisit>& visits = state_.visits;
        visits.clear();
        forEachStart([&](uint32_t node, uint32_t slots) { visits.push_back({node, rootPlanes(), slots}); });
        const bool starts_are_all = !frame_.starts().empty();
        descendByLevels(frame_.world->bvh.nodes, visits, [&](const NodeVisit& visit) {
            Group group = groupOf(visit.node, visit.planes);
            uint32_t live = starts_are_all ? visit.slots : frame_.candidateSlots(group.node);
            live = narrow(rows_.by_box, rows_.boxes, false, group, live);
            forEachSlot(live, [&](int slot) {
                if (!(group.undecided >> slot & 1) || (group.node.child[slot] & BvhNode::kLeaf))
                    keep(group.node.first[slot], group.node.count[slot]);
                else visits.push_back({group.node.child[slot], group.planes[slot]});
            });
        });
    }

    const Frame& frame_;
    TraversalState& state_;
    Observer& observer_;
    const bool drawn_;  ///< else certificates alone say what is hidden
    const RowsInUse rows_;
    uint32_t waiting_ = 0;  ///< nodes and objects in the queue; without any, nothing is left to hide
};

void takeUp(TraversalState& state, const ImagePart& part) {
    state.clear();
    state.part = part;
    state.tiles.log = nullptr;
}

}  // namespace

void traverse(const Frame& frame, TraversalState& state, const ImagePart& part, bool timed) {
    takeUp(state, part);
    Unwatched nobody;
    Timed clock;
    if (timed) Traversal(frame, state, clock).run();
    else Traversal(frame, state, nobody).run();
}

void traverse(const Frame& frame, TraversalState& state, const ImagePart& part, TraversalRecord& record) {
    takeUp(state, part);
    Recorder recorder(record);
    Traversal(frame, state, recorder).run();
}

}  // namespace sightline::detail
