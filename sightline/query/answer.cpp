// One view's answer: its frame, a traversal for each part of its image, and the union of what these keep.
// SPDX-License-Identifier: MIT
#include "sightline/query/answer.h"

#include <algorithm>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/buffer/depth_image.h"
#include "sightline/frame/stopwatch.h"
#include "sightline/frame/validate_proofs.h"
#include "sightline/query/explain/shadows.h"
#include "sightline/query/traversal.h"
#include "sightline/tree/descend.h"

namespace sightline::detail {

Answer::Answer(Memory* memory)
    : memory_(memory), memory_of_stages_(memory), parts_(memory), tiles_(memory), merged_(memory), counted_(memory) {
    parts_.push_back(makeOwned<TraversalState>(memory, memory));
}

void Answer::begin(const Snapshot& now, const View& view, const QuerySettings& settings,
                   std::span<const uint32_t> shown, std::span<const ObjectId> proposed) {
    const Stopwatch watch;
    frame_.begin(now, view, settings, shown);
    chooseStages(frame_, memory_of_stages_, settings.time_stages ? choose_nanoseconds_ : nullptr);
    ProofMemory& proofs = parts_[0]->proofs;
    proofs.begin(frame_, proposed);
    // What rests on certificates is not shared out: nothing is drawn. Nor are proposals, which the first part would judge.
    const bool shares = proofs.way() != ProofMemory::Way::kProofs && !(proofs.possible() && !proposed.empty());
    count_ = now && shares ? partCount(frame_) : 1;
    while (parts_.size() < count_) parts_.push_back(makeOwned<TraversalState>(memory_, memory_));
    for (uint32_t part = 0; part < count_; ++part) {
        if (part > 0) parts_[part]->proofs.hidden.clear();
        parts_[part]->notes_hidden = proofs.way() == ProofMemory::Way::kTilesAndSeek;
    }
    tiles_.clear();
    for (uint32_t part = 0; part < count_ && frame_.usable; ++part) tiles_.push_back(&parts_[part]->tiles);
    merged_.clear();
    memory_of_stages_.lods.clear();
    memory_of_stages_.clusters.clear();
    choosing_ = watch.nanoseconds();
}

void Answer::run(uint32_t part) {
    SIGHTLINE_DEBUG_ASSERT(part < count_ && count_ <= parts_.size());
    const Stopwatch watch;
    TraversalState& state = *parts_[part];
    ProofMemory& proofs = state.proofs;
    const ImagePart image = count_ == 1 ? ImagePart() : imagePart(part, count_, frame_.columns());
    const bool by_proofs = proofs.way() == ProofMemory::Way::kProofs;
    const bool occludes = frame_.world && frame_.usable && frame_.uses(Stage::kOcclusion);
    if (occludes) state.turns.begin(frame_, by_proofs);
    traverse(frame_, state, image, frame_.settings.time_stages);
    if (by_proofs && proofs.way() != ProofMemory::Way::kProofs) {
        state.turns.begin(frame_, false);
        state.notes_hidden = proofs.way() == ProofMemory::Way::kTilesAndSeek;
        proofs.culled.clear();
        traverse(frame_, state, image, frame_.settings.time_stages);
    }
    if (count_ == 1) learnFrom(state.stats, state.visible.size());
    state.stats.nanoseconds = watch.nanoseconds();
}

/// Seeks certificates for what was found to be hidden, and decides how the next view is answered.
void Answer::learnFrom(QueryStats& from, size_t visible) {
    ProofMemory& proofs = parts_[0]->proofs;
    if (proofs.way() == ProofMemory::Way::kTilesAndSeek) proofs.seekAll(frame_, from, visible);
    from.proofs_sought = proofs.sought + proofs.proposalsTried();
    from.proofs_found = proofs.found;
    from.proof_rays = proofs.rays;
    from.proof_cuts = proofs.cuts();
    proofs.noteAnswered(from, visible);
    validateProofs(proofs);
}

/// Whether the answer keeps one of the objects at these places; of an answer in parts, once they are put together.
bool Answer::keepsAny(const PlaceRange& places) const {
    for (uint32_t place = places.first; place < places.first + places.count; ++place)
        if (counted_[place] == answer_) return true;
    return false;
}

/// Adds what a part found to be hidden, or what of it no other part keeps.
void Answer::addHidden(const ProofMemory::Hidden& one) {
    if (!keepsAny(one.below)) return parts_[0]->proofs.hidden.push_back(one);
    if (one.kind == Pending::Kind::kObject) return;
    const PlacedBvh& bvh = frame_.world->bvh;
    const BvhNode& node = bvh.nodes[one.index];
    const EyeBoxes boxes = eyeBoxes(node, bvh.origin - frame_.frustum.eye);
    forEachSlot(usedSlots(node), [&](int slot) {
        const bool leaf = node.child[slot] & BvhNode::kLeaf;
        addHidden({boxOf(boxes, slot), node.child[slot] & ~BvhNode::kLeaf,
                   leaf ? Pending::Kind::kObject : Pending::Kind::kNode, placesBelow(node, slot)});
    });
}

/// What all parts together found to be hidden, each thing once.
void Answer::gatherHidden() {
    Array<ProofMemory::Hidden>& all = parts_[0]->proofs.hidden;
    const size_t own = all.size();
    for (size_t i = 0; i < own; ++i) {
        const ProofMemory::Hidden one = all[i];
        addHidden(one);
    }
    for (uint32_t part = 1; part < count_; ++part)
        for (const ProofMemory::Hidden& one : parts_[part]->proofs.hidden) addHidden(one);
    std::copy(all.begin() + static_cast<ptrdiff_t>(own), all.end(), all.begin());
    all.resize(all.size() - own);
    // Wider ones first; what lies in one that was taken goes.
    std::sort(all.begin(), all.end(), [](const ProofMemory::Hidden& a, const ProofMemory::Hidden& b) {
        if (a.below.first != b.below.first) return a.below.first < b.below.first;
        return a.below.count != b.below.count ? a.below.count > b.below.count : a.kind < b.kind;
    });
    uint32_t end = 0;
    erase_if(all, [&](const ProofMemory::Hidden& one) {
        if (one.below.first + one.below.count <= end) return true;
        end = one.below.first + one.below.count;
        return false;
    });
}

void Answer::noteOff() {
    stats.off = frame_.off;
    const ProofMemory& proofs = parts_[0]->proofs;
    const QuerySettings& settings = frame_.settings;
    const auto note = [&](bool is_off, Off what) { stats.off |= is_off ? offBit(what) : 0; };
    const bool both = frame_.uses(Stage::kFrustum) && frame_.uses(Stage::kOcclusion);
    if (!frame_.world || !frame_.usable || !both || !settings.proofs || settings.stateless) return;
    note(!proofs.possible() && !frame_.world->bvh.nodes.empty(), Off::kCertificatesByView);
    note(proofs.possible() && count_ < partCount(frame_), Off::kBinsByCertificates);
    if (proofs.way() != ProofMemory::Way::kProofs) return;
    note(frame_.uses(Stage::kClusters) && frame_.world->clusters.size() > 1, Off::kClusterLookByCertificates);
    note(closedGap(settings) > 0.0, Off::kGapsByCertificates);
}

/// Notes a place; false if it has been in this answer.
bool Answer::countOnce(uint32_t place) {
    SIGHTLINE_DEBUG_ASSERT(place < counted_.size());
    if (counted_[place] == answer_) return false;
    counted_[place] = answer_;
    return true;
}

/// Objects without bounds, and each object that a part keeps, once.
void Answer::mergeVisible() {
    for (const uint32_t row : frame_.world->unbounded) {
        const ObjectRecord& object = frame_.world->objects[row];
        if (!(object.layers & frame_.view.layers)) continue;
        merged_.push_back({object.key, object.id});
        ++stats.of(Stage::kFrustum).doubt;
    }
    SIGHTLINE_DEBUG_ASSERT(count_ <= ImagePart::kMost);
    for (uint32_t part = 0; part < count_; ++part)
        SIGHTLINE_DEBUG_ASSERT(parts_[part]->kept.size() == parts_[part]->visible.size());
    uint32_t at[ImagePart::kMost] = {};
    for (;;) {
        uint32_t best = count_;
        for (uint32_t part = 0; part < count_; ++part) {
            if (at[part] == parts_[part]->kept.size()) continue;
            if (best == count_) {
                best = part;
                continue;
            }
            const KeptPlace &here = parts_[part]->kept[at[part]], &there = parts_[best]->kept[at[best]];
            if (here.nearness != there.nearness ? here.nearness > there.nearness : here.place < there.place)
                best = part;
        }
        if (best == count_) return;
        const TraversalState& state = *parts_[best];
        const uint32_t next = at[best]++;
        if (!countOnce(state.kept[next].place)) continue;
        merged_.push_back(state.visible[next]);
        stats.of(Stage::kOcclusion).doubt += state.kept[next].nearness == std::numeric_limits<float>::infinity();
    }
}

/// The stages before occlusion cull the same nodes and objects in all parts that meet them. All other objects that are
/// not kept are occluded.
void Answer::finish() {
    stats = parts_[0]->stats;
    stats.objects = frame_.objects;
    for (uint32_t part = 1; part < count_; ++part) stats.addWork(parts_[part]->stats);
    if (count_ > 1) {
        stats.of(Stage::kOcclusion).doubt = 0;
        for (StageStats& stage : stats.stages) stage.culled = 0;
        if (counted_.size() < frame_.world->placed.size()) counted_.resize(frame_.world->placed.size(), 0);
        if (++answer_ == 0) {
            std::fill(counted_.begin(), counted_.end(), 0);
            answer_ = 1;
        }
        mergeVisible();
        if (parts_[0]->notes_hidden) gatherHidden();
        for (uint32_t part = 0; part < count_; ++part)
            for (const CulledRange& range : parts_[part]->culled)
                if (range.stage != Stage::kOcclusion && countOnce(range.places.first))
                    stats.of(range.stage).culled += frame_.countObjects(range.places);
    }
    stats.visible = visible().size();
    if (count_ > 1) {
        const Stopwatch watch;
        learnFrom(stats, stats.visible);
        stats.nanoseconds += watch.nanoseconds();
    }
    addStages();
    noteOff();
}

/// Counts what the stages of cells did, and how many objects each stage had to test.
void Answer::addStages() {
    for (const Stage stage : {Stage::kPvs, Stage::kPortals}) {
        if (frame_.candidates) stats.of(stage).culled += frame_.candidates->culled(stage);
        stats.of(stage).doubt = cells().doubt(stage);
    }
    uint64_t left = stats.objects;
    const uint32_t counted = countedStages(frame_.stages);
    for (const Stage at : kStageOrder) {
        StageStats& stage = stats.of(at);
        if (count_ > 1 && at == Stage::kOcclusion)
            stage.culled = left - stats.visible - stats.of(Stage::kFacing).culled;
        stage.tested = counted & stageBit(at) ? left : 0;
        if (frame_.settings.time_stages) stage.nanoseconds += choose_nanoseconds_[static_cast<int>(at)];
        SIGHTLINE_DEBUG_ASSERT(stage.culled <= left);
        left -= stage.culled;
    }
    SIGHTLINE_ASSERT(left == stats.visible);
    stats.nanoseconds += choosing_;
}

void Answer::timed(uint64_t nanoseconds) {
    if (frame_.settings.time_stages && frame_.uses(Stage::kOcclusion)) {
        uint64_t others = 0;
        for (int stage = 0; stage < static_cast<int>(Stage::kOcclusion); ++stage)
            others += stats.stages[stage].nanoseconds;
        stats.of(Stage::kOcclusion).nanoseconds = stats.nanoseconds - others;
    }
    stats.nanoseconds = nanoseconds;
}

void Answer::refine(Stage last) {
    if (!frame_.world || !frame_.usable) return;
    AnswerView answer = view();
    for (const PipelineStep& row : kPipeline) {
        if (!row.of_answer || row.stage > last || !frame_.uses(row.stage)) continue;
        const Stopwatch watch;
        row.of_answer(frame_, memory_of_stages_, answer);
        const uint64_t took = watch.nanoseconds();
        SIGHTLINE_DEBUG_ASSERT(stats.visible == visible().size());
        if (row.stage == Stage::kLod && frame_.uses(Stage::kClusters))
            stats.of(Stage::kClusters).tested -= stats.of(row.stage).culled;
        stats.nanoseconds += took;
        if (frame_.settings.time_stages) stats.of(row.stage).nanoseconds = took;
    }
}

void Answer::reasons(std::span<uint8_t> reasons) const {
    const SnapshotState* const world = frame_.world;
    SIGHTLINE_ASSERT(!world || reasons.size() >= world->count);
    std::fill(reasons.begin(), reasons.end(), uint8_t{0});
    if (!world) return;
    const auto reasonOf = [](Stage stage) { return static_cast<uint8_t>(1 + static_cast<int>(stage)); };
    const auto isEmpty = [&](uint32_t place) { return world->bvh.order[place] == PlacedBvh::kNone; };
    if (frame_.candidates)
        for (uint32_t place = 0; place < world->placed.size(); ++place)
            if (!isEmpty(place) && !frame_.candidates->admits(place))
                reasons[world->itemAt(place)] = reasonOf(frame_.candidates->stageOf(place));
    for (uint32_t part = 0; part < count_; ++part)
        for (const CulledRange& range : parts_[part]->culled)
            for (uint32_t place = range.places.first; place < range.places.first + range.places.count; ++place) {
                if (isEmpty(place) || !frame_.isCandidate(place)) continue;
                uint8_t& reason = reasons[world->itemAt(place)];
                reason = finerReason(reason, reasonOf(range.stage));
            }
    for (uint32_t part = 0; part < count_; ++part)
        for (const KeptPlace& object : parts_[part]->kept) reasons[world->itemAt(object.place)] = 0;
    if (frame_.every_layer) return;
    for (uint32_t item = 0; item < world->count; ++item)
        if (!(world->object(item).layers & frame_.view.layers)) reasons[item] = 255;
}

Stage Answer::reasonOf(ObjectId id) const {
    const uint32_t place = frame_.world ? frame_.world->placeOf(id) : PlacedBvh::kNone;
    for (const CulledRange& range : parts_[0]->culled)
        if (place != PlacedBvh::kNone && range.places.holds(place)) return range.stage;
    return Stage::kFrustum;
}

bool Answer::wasUnasked(ObjectId id) const {
    if (!frame_.world) return false;
    const uint32_t place = frame_.world->placeOf(id);
    if (place == PlacedBvh::kNone) return false;
    for (uint32_t part = 0; part < count_; ++part) {
        const TraversalState& state = *parts_[part];
        const auto is = [&](const Visible& v) { return v.id == id; };
        if (state.turns.wasUnasked(place) && std::any_of(state.visible.begin(), state.visible.end(), is)) return true;
    }
    return false;
}

/// The certificate that culled an object in this answer; null: none did.
const Certificate* Answer::certificateFor(ObjectId id) const {
    if (!frame_.world) return nullptr;
    const uint32_t place = frame_.world->placeOf(id);
    for (const ProofMemory::Culled& culled : parts_[0]->proofs.culled)
        if (culled.places.holds(place)) return &culled.certificate;
    return nullptr;
}

bool Answer::certificateOf(ObjectId id, Array<Visible>& out) const {
    const Certificate* const certificate = certificateFor(id);
    if (!certificate) return false;
    parts_[0]->proofs.forEachNamed(frame_, *certificate, [&](const Visible& hider, uint32_t) {
        const auto is = [&](const Visible& v) { return v.id == hider.id; };
        if (std::none_of(out.begin(), out.end(), is)) out.push_back(hider);
    });
    return true;
}

bool Answer::certificateOf(ObjectId id, Array<HiderOutline>& outlines, Array<glm::dvec3>& corners) const {
    const Certificate* const certificate = certificateFor(id);
    if (certificate) addOutlines(parts_[0]->proofs, frame_, *certificate, outlines, corners);
    return certificate != nullptr;
}

void Answer::depthImage(Seams seams, std::span<float> nearness, std::span<uint8_t> covered) {
    SIGHTLINE_DEBUG_ASSERT(covered.empty() || covered.size() == nearness.size());
    for (uint32_t part = 0; part < count_; ++part) readDepthImage(parts_[part]->tiles, seams, nearness, covered, 0.0f);
}

}  // namespace sightline::detail
