// Whether an answer rests on certificates: what they miss, and what they cost beside drawing.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/frame/proof_memory.h"

#include <algorithm>

#include "sightline/tree/descend.h"

namespace sightline::detail {
namespace {

constexpr uint32_t kMostAnswers = 128;  // by certificates alone, one after the other
constexpr uint32_t kShortRest = 64, kLongRest = 512;
constexpr double kMostWork = 0.85;                       // of that of drawing
constexpr double kMostExpected = 0.7;                    // the same, of what is only expected
constexpr double kWorkOfProof = 1, kWorkOfHider = 0.75;  // about, of a certificate in an answer
constexpr uint32_t kFewAnswers = 4;                      // that are given before the work is compared
constexpr uint64_t kMostCuts = 600;                      // polygons cut for one view that is drawn
constexpr uint32_t kTeachersShare = 32;                  // times as much may be sought where it is done for others
constexpr uint32_t kTeacherWaits = 16;                   // answers, until what was sought in vain is sought again
constexpr uint32_t kMostDrawn = 16;        // views, one after the other, for which certificates are sought
constexpr double kMostLoose = 0.12;        // of what is visible: that certificates may keep although it is hidden
constexpr double kMostLooseTaught = 0.15;  // the same, of what a teacher keeps
constexpr double kFewLoose = 3;            // objects that are kept besides, whatever the teacher keeps
constexpr double kMostDrawnTaught = 0.6;   // of answers
constexpr double kMostWorkAlone = 0.6;     // of that of drawing: certificates with more are not sought
constexpr double kFewTaught = 8;           // answers that these are averages of
constexpr double kLeastUnasked = 0.25;     // of what is visible, where a view follows another
constexpr size_t kMostHiders = 1u << 16;

}  // namespace

void ProofMemory::begin(const Frame& frame, std::span<const ObjectId> proposed) {
    if (++answer_ == 0) {  // numbers of answers begin anew
        clear();
        places_.clear();
        answer_ = 1;
    }
    shadows_.clear();
    hidden.clear();
    culled.clear();
    found_nodes_.clear();
    found_places_.clear();
    proposals_tried_ = 0;
    rays_of_proposals_ = cuts_of_proposals_ = 0;
    cuts_before_ = rest_.cuts();
    sought = found = passed_over_ = 0;
    rays = polygons = 0;
    way_ = Way::kTiles;
    const QuerySettings& settings = frame.settings;
    possible_ = settings.proofs && !settings.stateless && frame.usable && frame.world &&
                !frame.world->bvh.nodes.empty() && frame.uses(Stage::kOcclusion) && frame.uses(Stage::kFrustum);
    if (!possible_) return;
    view_ = makeVolumeView(frame.view, frame.screen, frame.world->bvh.origin - frame.frustum.eye);
    image_ = makeImageFrame(frame.screen);
    possible_ = view_.usable && image_.usable;
    if (!possible_) return;
    if (hiders_.size() > kMostHiders) clear();
    if (places_.empty()) places_.resize(kPlaces);
    note(frame, proposed);
    if (teaches() || taught()) {
        way_ = teaches() ? Way::kTilesAndSeek : Way::kProofs;
        return;
    }
    if (frame.view.layers != layers_ || frame.stages != stages_) next_by_proofs_ = false;
    layers_ = frame.view.layers;
    stages_ = frame.stages;
    if (next_by_proofs_ && answers_ < kMostAnswers) {
        way_ = Way::kProofs;
        return;
    }
    answers_ = 0;
    next_by_proofs_ = false;
    if (static_cast<int32_t>(answer_ - rest_until_) >= 0) way_ = Way::kTilesAndSeek;
}

bool ProofMemory::hasFailed(Pending::Kind kind, uint32_t index) const {
    const Array<uint32_t>& of = numbers(kind);
    return index < of.size() && (of[index] & kFailed) && (of[index] & kClosely) &&
           ((answer_ - of[index]) & (kClosely - 1)) < (teaches() ? kTeacherWaits : kMostAnswers);
}

/// Looks for certificates for a node or an object that is hidden, or else for what is below it.
/// @returns how many objects are left without
uint32_t ProofMemory::seekBelow(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box) {
    SIGHTLINE_DEBUG_ASSERT(possible_ && kind != Pending::Kind::kCluster);
    const uint32_t share = teaches() ? kTeachersShare : 1;
    if (cuts() - cuts_of_proposals_ >= share * kMostCuts) {
        spent_ = true;
        return 0;
    }
    const auto count = [&] {  // it is held against a view once answers rest on it
        expected_work_ += kWorkOfProof + kWorkOfHider * certificateOf(kind, index).count;
        if (teaches()) (kind == Pending::Kind::kNode ? found_nodes_ : found_places_).push_back(index);
        return 0u;
    };
    // A teacher hands on what holds now.
    if (teaches() ? holds(frame, kind, index, box) : hasCertificate(kind, index)) return count();
    if (!hasFailed(kind, index)) {
        if (sought >= share * kMostSought) {
            spent_ = true;
            return 0;
        }
        if (seek(frame, kind, index, box, true)) return count();
    }
    if (kind == Pending::Kind::kObject) return 1;
    const PlacedBvh& bvh = frame.world->bvh;
    SIGHTLINE_DEBUG_ASSERT(index < bvh.nodes.size());
    const BvhNode& node = bvh.nodes[index];
    const EyeBoxes boxes = eyeBoxes(node, bvh.origin - frame.frustum.eye);
    uint32_t slots = frame.candidateSlots(node) & usedSlots(node);
    if (frame.uses(Stage::kFrustum)) slots &= ~testFrustum(frame.frustum, boxes, allPlanes(frame) & 63).outside;
    uint32_t left = 0;
    forEachSlot(slots, [&](int slot) {
        const uint32_t child = node.child[slot];
        const bool leaf = child & BvhNode::kLeaf;
        if (leaf && (!frame.isInLayers(child & ~BvhNode::kLeaf) || frame.sizes.drops(child & ~BvhNode::kLeaf))) return;
        left += seekBelow(frame, leaf ? Pending::Kind::kObject : Pending::Kind::kNode, child & ~BvhNode::kLeaf,
                          boxOf(boxes, slot));
    });
    return left;
}

void ProofMemory::seekAll(const Frame& frame, const QueryStats& stats, size_t visible) {
    SIGHTLINE_DEBUG_ASSERT(way_ == Way::kTilesAndSeek);
    const double unasked = static_cast<double>(stats.unasked);
    const bool follows = unasked >= kLeastUnasked * static_cast<double>(visible);
    if (frame.settings.unasked_answers > 0 && !follows && !teaches()) return;
    uint64_t loose = 0;
    spent_ = false;
    expected_work_ = 0;
    for (const Hidden& one : hidden) loose += seekBelow(frame, one.kind, one.index, one.box);
    if (teaches()) return;
    if (static_cast<double>(loose) > kMostLoose * static_cast<double>(visible) + 1) return rest();
    if (drawn_work_ > 0 && expected_work_ > kMostExpected * drawn_work_) return rest();
    if (!spent_) next_by_proofs_ = true, drawn_ = 0;
    else if (++drawn_ >= kMostDrawn) rest();
}

/// Nobody seeks certificates for some answers, and for more if that did not do before.
void ProofMemory::rest() {
    next_by_proofs_ = false;
    drawn_ = 0;
    rest_for_ = std::clamp(2 * rest_for_, kShortRest, kLongRest);
    rest_until_ = answer_ + rest_for_;
}

/// That of the last answer, about. What each unit took on several scenes; time itself must not decide, for answers would
/// differ.  [microseconds]
double ProofMemory::workOf(const QueryStats& stats) const {
    const auto n = [](uint64_t count) { return static_cast<double>(count); };
    if (way_ != Way::kProofs)
        return 0.18 * n(stats.occluder_triangles) + 0.4 * n(stats.second_look_polygons) + 6 * n(stats.nodes_visited);
    SIGHTLINE_DEBUG_ASSERT(stats.proof_cuts >= cuts_of_proposals_ && stats.proof_rays >= rays_of_proposals_);
    return 0.55 * n(stats.proof_cuts - cuts_of_proposals_) + 0.03 * n(polygons) +
           6 * n(stats.proof_rays - rays_of_proposals_) + n(stats.proved) + 3 * n(stats.nodes_visited);
}

/// Goes on by itself for some answers, if it keeps much more than the teacher does, or must draw all the same.
void ProofMemory::noteTaught(const QueryStats& stats, size_t visible) {
    const bool drew = way_ != Way::kProofs;
    // The first one was answered before the teacher had found anything.
    const double kept = static_cast<double>(visible), share = taught_ > 1 ? 1.0 / kFewTaught : 1;
    const auto note = [&](double& average, double value) { average += share * (value - average); };
    note(drew_here_, drew ? 1 : 0);
    note(kept_here_, kept);
    note(kept_there_, drew ? kept : static_cast<double>(drawn_visible_));
    if (!drew) note(proof_work_, workOf(stats));
    if (++taught_ == kShortRest) alone_for_ = rest_for_ = 0;
    const bool loose = taught_ >= 2 * kFewTaught && kept_here_ > (1 + kMostLooseTaught) * kept_there_ + kFewLoose;
    const bool often = taught_ >= kFewTaught && drew_here_ > kMostDrawnTaught;
    if (!loose && !often) return;
    taught_ = 0;
    taught_until_ = answer_;
    alone_for_ = std::clamp(2 * alone_for_, kShortRest, kLongRest);
    alone_until_ = answer_ + alone_for_;
    answers_ = 0;
    next_by_proofs_ = !often && proof_work_ < kMostWorkAlone * drawn_work_;  // it seeks what it was not taught
    if (!next_by_proofs_) rest();
}

void ProofMemory::noteAnswered(const QueryStats& stats, size_t visible) {
    if (taught()) return noteTaught(stats, visible);
    const double work = workOf(stats);
    if (way_ != Way::kProofs) {
        drawn_work_ += (work - drawn_work_) / (drawn_work_ > 0 ? 4 : 1);
        drawn_visible_ = visible;
        return;
    }
    // More is kept: it is seen, or not proved to be hidden. Drawing tells.
    if (static_cast<double>(visible) > (1 + kMostLoose) * static_cast<double>(drawn_visible_) + 3)
        next_by_proofs_ = false;
    proof_work_ += (work - proof_work_) / (answers_ > 0 ? 8 : 1);
    if (++answers_ == kShortRest) rest_for_ = 0;
    // The first of them have much to find.
    if (answers_ >= kFewAnswers && proof_work_ > (answers_ < 4 * kFewAnswers ? 3 : kMostWork) * drawn_work_) rest();
}

}  // namespace sightline::detail
