// What one traversal of the world writes: its part of the image, its queue, its buffer, and what it kept and culled.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/cull/frustum.h"
#include "sightline/cull/occluder_volumes.h"
#include "sightline/cull/occlusion.h"
#include "sightline/cull/outline_look.h"
#include "sightline/frame/image_part.h"
#include "sightline/frame/pending.h"
#include "sightline/frame/place_range.h"
#include "sightline/frame/proof_memory.h"
#include "sightline/frame/stats.h"
#include "sightline/frame/turns.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

/// What an object was asked by.
enum class Look : uint8_t {
    kBox,        ///< the rectangle around its box, with the box's nearest depth
    kFaces,      ///< the faces of its box
    kTriangles,  ///< its own triangles
};

/// An object that was kept, and will be asked by its triangles.
struct SecondLook {
    Pending entry;
    uint32_t visible = 0;     ///< index into TraversalState::visible
    bool faces_left = false;  ///< its faces were not asked
};

/// Objects that were culled together.
struct CulledRange {
    PlaceRange places;
    Stage stage = Stage::kFrustum;
};

/// A visible object's leaf, and the nearness by which it was queued.
struct KeptPlace {
    uint32_t place = 0;
    float nearness = 0;
};

/// The volumes that each node crosses: they may still hide what is below the node.
struct OpenVolumes {
    /// A volume that crosses some boxes, and the planes that do.
    struct One {
        uint32_t volume : 8;
        uint32_t planes : 24;
    };
    static_assert(OccluderVolume::kMaxPlanes <= 24);
    /// A run of `crossing`.
    struct Run {
        uint32_t first = 0, count = 0;
        uint32_t answer = 0;  ///< the number of the answer that noted it
    };
    Array<One> crossing;  ///< first all volumes, for nodes of which nothing is noted
    Array<Run> of_node;
    uint32_t answer = 0;  ///< of the traversal at hand

    explicit OpenVolumes(Memory* memory) : crossing(memory), of_node(memory) {}
    /// Forgets what is noted of nodes.
    void begin() {
        crossing.clear();
        if (++answer > 0) return;
        of_node.clear();
        answer = 1;
    }
};

/// A node that waits where the order does not matter.
struct NodeVisit {
    uint32_t node = 0;
    uint32_t planes = 0;  ///< as Pending has it
    uint32_t slots = 0;   ///< bit per slot to look at, if the descent begins at this node
};

/// The scratch of one traversal; it stays from answer to answer.
struct TraversalState {
    explicit TraversalState(Memory* memory)
        : tiles(memory),
          queue(memory),
          instances(memory),
          visible(memory),
          kept(memory),
          culled(memory),
          second(memory),
          looks(memory),
          open_at(memory),
          turns(memory),
          proofs(memory),
          visits(memory),
          volumes(memory) {}

    ImagePart part;
    DepthTiles tiles;
    PendingQueue queue;
    Array<OccluderInstance> instances;  ///< that were queued or drawn
    Array<Visible> visible;
    Array<KeptPlace> kept;  ///< per object of `visible`, in a strip of the image; else empty
    Array<CulledRange> culled;
    Array<SecondLook> second;  ///< objects of `visible` that will be asked by their triangles
    LookScratch looks;
    /// Per place: the cluster that was open in the last answer that asked the object there by its outlines. It outlives
    /// the answer; what has moved to another place meanwhile is asked in vain.
    Array<uint32_t> open_at;
    Turns turns;                ///< it outlives the answer, too
    ProofMemory proofs;         ///< and so does this
    bool notes_hidden = false;  ///< ProofMemory::hidden is to be filled
    Array<NodeVisit> visits;    ///< the queue, where the traversal is in any order
    OpenVolumes volumes;
    QueryStats stats;

    uint32_t openAt(uint32_t place) const { return place < open_at.size() ? open_at[place] : OutlineLook::kNone; }

    void clear() {
        tiles.clear(0, 0);
        queue.clear();
        instances.clear();
        visible.clear();
        kept.clear();
        culled.clear();
        second.clear();
        stats = {};
        volumes.begin();
    }
};

/// Eight children of a node on their way through the stages.
struct Group {
    uint32_t index = 0;  ///< of the node
    const BvhNode& node;
    EyeBoxes boxes;            ///< relative to the eye
    uint32_t inherited = 0;    ///< planes of the view that the node is not inside of
    uint32_t planes[8] = {};   ///< planes of the view that each child is not inside of
    uint32_t undecided = 0;    ///< bit per child below which a stage may cull some, and leave others
    ScreenAnswer on_screen{};  ///< rectangles, where the traversal is in order
    uint32_t hider[8] = {};    ///< per child that a volume hides: the place of the volume's object
};

}  // namespace sightline::detail
