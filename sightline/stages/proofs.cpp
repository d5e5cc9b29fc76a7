// Culling by certificates: what hid something before is held against it first, where it stands now.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/frame/proof_memory.h"

#include <algorithm>

#include "sightline/stages/occluder_form.h"
#include "sightline/stages/pipeline.h"
#include "sightline/tree/descend.h"

namespace sightline::detail {

void ProofMemory::clear() {
    of_node_.clear();
    of_place_.clear();
    seen_node_.clear();
    seen_place_.clear();
    proposed_.clear();
    certificates_.clear();
    free_.clear();
    hiders_.clear();
    number_.clear();
    std::fill(last_, last_ + kLast, kNone);
    latest_ = {};
}

bool ProofMemory::hasCertificate(Pending::Kind kind, uint32_t index) const {
    const Array<uint32_t>& of = numbers(kind);
    return index < of.size() && of[index] != 0 && !(of[index] & kFailed);
}

Certificate ProofMemory::certificateOf(Pending::Kind kind, uint32_t index) const {
    return hasCertificate(kind, index) ? certificates_[numbers(kind)[index] - 1] : Certificate();
}

void ProofMemory::forget(Pending::Kind kind, uint32_t index) {
    if (!hasCertificate(kind, index)) return;
    Array<uint32_t>& of = numbers(kind);
    free_.push_back(of[index] - 1);
    of[index] = 0;
}

void ProofMemory::makeRoom(Pending::Kind kind, size_t size) {
    Array<uint32_t>& of = numbers(kind);
    if (of.size() < size) of.resize(size, 0);
    if (seen(kind).size() < of.size()) seen(kind).resize(of.size(), 0);
}

void ProofMemory::makeRoom(const Frame& frame, Pending::Kind kind, uint32_t index) {
    const bool has_room = index < numbers(kind).size();
    makeRoom(kind, has_room                       ? 0
                   : kind == Pending::Kind::kNode ? frame.world->bvh.nodes.size()
                                                  : frame.world->placed.size());
}

/// There is room for it.
void ProofMemory::write(Pending::Kind kind, uint32_t index, const Certificate& certificate) {
    Array<uint32_t>& of = numbers(kind);
    SIGHTLINE_DEBUG_ASSERT(index < of.size() && certificate.count <= Certificate::kMost);
    if (!hasCertificate(kind, index)) {
        if (free_.empty()) {
            certificates_.push_back({});
            of[index] = static_cast<uint32_t>(certificates_.size());
        } else {
            of[index] = free_.back() + 1;
            free_.pop_back();
        }
    }
    SIGHTLINE_DEBUG_ASSERT(of[index] > 0 && of[index] <= certificates_.size());
    certificates_[of[index] - 1] = certificate;
}

void ProofMemory::learn(ProofMemory& teacher) {
    SIGHTLINE_DEBUG_ASSERT(&teacher != this);
    const bool alone = isBefore(alone_until_);
    teacher.teaches_until_ = teacher.answer_ + (alone ? 0 : kTaught);
    if (alone) return;
    taught_until_ = answer_ + kTaught;
    if (teacher.drawn_work_ > 0) {
        drawn_work_ = teacher.drawn_work_;
        drawn_visible_ = teacher.drawn_visible_;
    }
    for (const Pending::Kind kind : {Pending::Kind::kNode, Pending::Kind::kObject})
        for (const uint32_t index : kind == Pending::Kind::kNode ? teacher.found_nodes_ : teacher.found_places_) {
            // What is known here already has held for a later view.
            if (hasCertificate(kind, index) || !teacher.hasCertificate(kind, index)) continue;
            Certificate certificate = teacher.certificateOf(kind, index);
            for (uint32_t i = 0; i < certificate.count; ++i)
                certificate.hiders[i] = numberOf(teacher.hider(certificate.hiders[i]));
            makeRoom(kind, teacher.numbers(kind).size());
            write(kind, index, certificate);
        }
}

void ProofMemory::propose(const Frame& frame, Pending::Kind kind, uint32_t index, std::span<const HidingPart> parts,
                          bool closely) {
    Certificate certificate;
    certificate.closely = closely;
    for (const HidingPart& part : parts)
        if (certificate.count < Certificate::kMost) certificate.hiders[certificate.count++] = numberOf(part);
    makeRoom(frame, kind, index);
    write(kind, index, certificate);
}

uint32_t ProofMemory::numberOf(const HidingPart& part) {
    const auto slotOf = [&](const HidingPart& of) {
        uint64_t hash = (uint64_t{of.object.index} << 12 ^ of.part) * 0x9e3779b97f4a7c15ull;
        hash ^= (uint64_t{of.other.index} << 12 ^ of.other_part) * 0xbf58476d1ce4e5b9ull;
        return static_cast<size_t>(hash >> 32) & (number_.size() - 1);
    };
    if (2 * (hiders_.size() + 1) > number_.size()) {
        number_.assign(std::max<size_t>(64, 2 * number_.size()), 0);
        for (uint32_t i = 0; i < hiders_.size(); ++i) {
            size_t at = slotOf(hiders_[i].part);
            while (number_[at] != 0) at = (at + 1) & (number_.size() - 1);
            number_[at] = i + 1;
        }
    }
    SIGHTLINE_DEBUG_ASSERT((number_.size() & (number_.size() - 1)) == 0 && 2 * hiders_.size() < number_.size());
    size_t at = slotOf(part);
    for (; number_[at] != 0; at = (at + 1) & (number_.size() - 1))
        if (hiders_[number_[at] - 1].part == part) return number_[at] - 1;
    hiders_.push_back({part, 0, kNone});
    number_[at] = static_cast<uint32_t>(hiders_.size());
    return number_[at] - 1;
}

/// The object at a place, if it surely hides in this view where it is drawn, as VolumeChooser has it.
void ProofMemory::lookAt(const Frame& frame, uint32_t place, Place& out) const {
    out.answer = answer_;
    out.place = place;
    out.hides = false;
    const SnapshotState& state = *frame.world;
    SIGHTLINE_DEBUG_ASSERT(place < state.placed.size());
    const PlacedObject& placed = state.placed[place];
    if (placed.occluder.index == 0 || !frame.isInLayers(place) || !frame.isCandidate(place)) return;
    if (frame.mayBeCoarse(place) || frame.sizes.drops(place)) return;
    const HeldOccluder& occluder = *state.occluders[placed.occluder.index];
    if (occluder.parts.parts.empty()) return;
    const ObjectRecord& record = state.objectAt(place);
    if (!isWhole(frame.limits, occluder, record.transform)) return;
    if (!reachesWindow(frame.limits, record.bounds, record.transform)) return;
    out.at = placeParts(view_, occluder.parts, occluder.bounds, record.transform);
    out.hides = out.at.usable;
    out.occluder = &occluder;
}

const ProofMemory::Place& ProofMemory::placeAt(const Frame& frame, uint32_t place) {
    SIGHTLINE_DEBUG_ASSERT(places_.size() == kPlaces);
    Place& out = places_[place % kPlaces];
    if (out.answer != answer_ || out.place != place) lookAt(frame, place, out);
    return out;
}

bool ProofMemory::outlineOf(const Frame& frame, ObjectId object, uint32_t part, VolumeOutline& outline) const {
    const uint32_t at = frame.world->placeOf(object);
    if (at == PlacedBvh::kNone) return false;
    Place place;
    lookAt(frame, at, place);
    OccluderVolume volume;
    return place.hides && part < place.at.parts->partCount() && makeVolume(view_, place.at, part, volume, outline);
}

bool ProofMemory::makeVolumeOf(const Frame& frame, const HidingPart& part, OccluderVolume& volume) {
    const SnapshotState& world = *frame.world;
    const uint32_t at = world.placeOf(part.object);
    if (at == PlacedBvh::kNone) return false;
    const Place& place = placeAt(frame, at);
    if (!place.hides || part.part >= place.at.parts->partCount()) return false;
    if (part.other_part == HidingPart::kNone) {
        VolumeOutline outline;
        return makeVolume(view_, place.at, part.part, volume, outline);
    }
    const uint32_t other_at = world.placeOf(part.other);
    if (other_at == PlacedBvh::kNone) return false;
    const Place one = place;  // the other one may take its slot
    const Place& other = placeAt(frame, other_at);
    if (!other.hides || part.other_part >= other.at.parts->partCount()) return false;
    const VolumePart &a = one.at.parts->part(part.part), &b = other.at.parts->part(part.other_part);
    if (a.face_count != 1 || b.face_count != 1) return false;
    VolumeSeam seam;
    SIGHTLINE_DEBUG_ASSERT(a.first_face < one.at.parts->members.size() &&
                           b.first_face < other.at.parts->members.size());
    seam.face[0] = one.at.parts->members[a.first_face];
    seam.face[1] = other.at.parts->members[b.first_face];
    return findSeam(*one.at.parts, world.objectAt(at).transform, *other.at.parts, world.objectAt(other_at).transform,
                    seam) &&
           makeSeamVolume(view_, one.at, other.at, seam, volume);
}

const Shadow* ProofMemory::shadowOf(const Frame& frame, uint32_t hider) {
    SIGHTLINE_DEBUG_ASSERT(hider < hiders_.size());
    Hider& h = hiders_[hider];
    SIGHTLINE_DEBUG_ASSERT(h.answer != answer_ || h.shadow == kNone || h.shadow < shadows_.size());
    if (h.answer == answer_) return h.shadow == kNone ? nullptr : &shadows_[h.shadow];
    h.answer = answer_;
    h.shadow = kNone;
    Shadow shadow;
    if (!makeVolumeOf(frame, h.part, shadow.volume) || !makeShadow(image_, shadow)) return nullptr;
    h.shadow = static_cast<uint32_t>(shadows_.size());
    shadows_.push_back(shadow);
    return &shadows_.back();
}

bool ProofMemory::holds(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box) {
    if (!hasCertificate(kind, index)) return false;
    const Certificate certificate = certificateOf(kind, index);
    if (isCovered(frame, certificate, kind, index, box)) return true;
    forget(kind, index);
    if (kind == Pending::Kind::kNode) handDown(frame, index, certificate);
    return false;
}

/// What hides a node no longer may still hide most of what is below it.
void ProofMemory::handDown(const Frame& frame, uint32_t node, const Certificate& certificate) {
    SIGHTLINE_DEBUG_ASSERT(node < frame.world->bvh.nodes.size());
    const BvhNode& of = frame.world->bvh.nodes[node];
    forEachSlot(usedSlots(of), [&](int slot) {
        const bool leaf = of.child[slot] & BvhNode::kLeaf;
        const Pending::Kind kind = leaf ? Pending::Kind::kObject : Pending::Kind::kNode;
        const uint32_t index = of.child[slot] & ~BvhNode::kLeaf;
        makeRoom(frame, kind, index);
        if (numbers(kind)[index] == 0) write(kind, index, certificate);
    });
}

void ProofMemory::note(const Frame& frame, std::span<const ObjectId> proposed) {
    for (const ObjectId id : proposed) {
        const uint32_t place = frame.world->placeOf(id);
        if (place == PlacedBvh::kNone) continue;
        if (place >= proposed_.size()) proposed_.resize(frame.world->placed.size());
        Proposal& one = proposed_[place];
        if (one.answer != answer_ && one.answer + 1 != answer_) one = {};
        one.answer = answer_;
    }
}

bool ProofMemory::isProposed(const Pending& entry) const {
    if (entry.kind != Pending::Kind::kObject || entry.index >= proposed_.size()) return false;
    if (proposed_[entry.index].answer != answer_) return false;
    if (hasCertificate(entry.kind, entry.index)) return true;
    const uint32_t again = proposed_[entry.index].again;
    return proposals_tried_ < kMostSought && (again == 0 || static_cast<int32_t>(answer_ - again) >= 0);
}

/// Whether a proposed object has a certificate, or one is found.
bool ProofMemory::proveProposed(const Frame& frame, const Pending& entry) {
    SIGHTLINE_DEBUG_ASSERT(isProposed(entry));
    const uint64_t rays_before = rays, cuts_before = cuts();
    bool proved = holds(frame, entry.kind, entry.index, entry.box);
    if (!proved && proposals_tried_ < kMostSought) {
        ++proposals_tried_;
        proved = seek(frame, entry.kind, entry.index, entry.box, true);
        --sought;  // these have a budget of their own
        Proposal& one = proposed_[entry.index];
        one.rest = proved ? 0 : std::clamp(2 * one.rest, kShortestRest, kLongestRest);
        one.again = answer_ + one.rest;
    }
    rays_of_proposals_ += rays - rays_before;
    cuts_of_proposals_ += cuts() - cuts_before;
    return proved;
}

namespace {

/// Culls what was just proved to be hidden.
TurnAnswer cull(const Frame& frame, ProofMemory& proofs, const Pending& entry) {
    const Certificate certificate = proofs.certificateOf(entry.kind, entry.index);
    proofs.culled.push_back({entry.below, certificate});
    if (certificate.count > 0) return {.culled = true};
    return {.culled = true, .stage = proofs.looksAway(frame, entry) ? Stage::kFacing : Stage::kFrustum};
}

}  // namespace

/// It is drawn all the same, if anything is: so a proposal changes nothing of this answer but the object itself.
TurnAnswer cullProposed(const Frame& frame, TraversalState& state, const Pending& entry) {
    ProofMemory& proofs = state.proofs;
    if (!proofs.isProposed(entry)) return {};
    const uint32_t tried = proofs.proposalsTried();
    if (!proofs.proveProposed(frame, entry)) {
        // If it was sought, nobody but drawing knows more of it.
        const bool sought = proofs.proposalsTried() > tried;
        return {.settled = sought && proofs.way() == ProofMemory::Way::kProofs};
    }
    ++state.stats.proved;
    TurnAnswer answer = cull(frame, proofs, entry);
    answer.drawn = true;
    return answer;
}

TurnAnswer cullProved(const Frame& frame, TraversalState& state, const Pending& entry) {
    ProofMemory& proofs = state.proofs;
    const bool before = proofs.hasCertificate(entry.kind, entry.index);
    const bool proved = proofs.holds(frame, entry.kind, entry.index, entry.box);
    state.stats.proved += proved;
    if (!proved && proofs.taught()) {
        proofs.passOver(state.visible.size());
        return {};
    }
    if (!proved && proofs.sought >= ProofMemory::kMostSought) {
        proofs.passOver(state.visible.size());
        return {.settled = true};
    }
    if (!proved && !proofs.seek(frame, entry.kind, entry.index, entry.box, before)) return {};
    return cull(frame, proofs, entry);
}

}  // namespace sightline::detail
