// Whose turn it is to be asked: nodes and objects that were kept before are kept for a few answers without a question.
// SPDX-License-Identifier: MIT
#include "sightline/frame/turns.h"

#include <algorithm>

#include "sightline/base/assert.h"

namespace sightline::detail {
namespace {

constexpr double kLittle = 1.0 / 16.0, kLittleProved = 1.0 / 4.0;  // Turns::little_
constexpr uint32_t kLongest = 31;                                  // of Turn::wait

bool areEqual(const ViewPlanes& a, const ViewPlanes& b) {
    return std::equal(a.all().begin(), a.all().end(), b.all().begin(), b.all().end());
}

}  // namespace

void Turns::begin(const Frame& frame, bool by_proofs) {
    most_ = 0;
    if (frame.settings.stateless || !frame.screen.perspective) return;
    most_ = std::min((by_proofs ? 4 : 1) * frame.settings.unasked_answers, kEyes - 1);
    little_ = by_proofs ? kLittleProved : kLittle;
    SIGHTLINE_DEBUG_ASSERT(frame.world && frame.usable);
    SIGHTLINE_DEBUG_ASSERT(most_ < kEyes);
    eyes_[++answer_ % kEyes] = frame.frustum.eye;
    // What was not proved to be hidden may well be: drawing asks it.
    const bool other_way = by_proofs_ && !by_proofs;
    by_proofs_ = by_proofs;
    if (other_way || frame.view.layers != layers_ || frame.stages != stages_ ||
        !areEqual(frame.view.sections, sections_)) {
        since_ = answer_;
        layers_ = frame.view.layers;
        stages_ = frame.stages;
        sections_ = frame.view.sections;
    }
    places_ = frame.world->placed.size();
    node_count_ = frame.world->bvh.nodes.size();
}

bool Turns::mayStand(const Pending& entry) const {
    if (most_ == 0) return false;
    SIGHTLINE_DEBUG_ASSERT(entry.kind != Pending::Kind::kCluster);
    const Array<Turn>& turns = entry.kind == Pending::Kind::kNode ? nodes_ : objects_;
    if (entry.index >= turns.size() || !turns[entry.index].kept) return false;
    const Turn turn = turns[entry.index];
    const uint32_t age = static_cast<uint16_t>(answer_ - turn.answer);
    const uint32_t spread = entry.index * 0x9e3779b9u >> 24 & turn.wait;
    if (age > std::min({most_, turn.wait + spread, answer_ - since_})) return false;
    SIGHTLINE_DEBUG_ASSERT(age <= most_);
    const double moved = glm::length(eyes_[answer_ % kEyes] - eyes_[(answer_ - age) % kEyes]);
    if (entry.testable) return moved * static_cast<double>(entry.rect.nearness) <= little_;
    return moved <= little_ * glm::length(glm::dvec3(entry.box.max) - glm::dvec3(entry.box.min));
}

void Turns::note(const Pending& entry, bool kept) {
    if (most_ == 0) return;
    SIGHTLINE_DEBUG_ASSERT(entry.kind != Pending::Kind::kCluster);
    const bool node = entry.kind == Pending::Kind::kNode;
    SIGHTLINE_DEBUG_ASSERT(entry.index < (node ? node_count_ : places_));
    Array<Turn>& turns = node ? nodes_ : objects_;
    if (entry.index >= turns.size()) turns.resize(node ? node_count_ : places_);
    Turn& turn = turns[entry.index];
    const uint32_t wait = !turn.kept ? 1 : std::min(kLongest, 2u * turn.wait + 1);
    turn = {static_cast<uint16_t>(answer_), static_cast<uint8_t>(kept ? wait : 0), kept};
}

bool Turns::wasUnasked(uint32_t place) const {
    return most_ > 0 && place < objects_.size() && objects_[place].kept &&
           objects_[place].answer != static_cast<uint16_t>(answer_);
}

}  // namespace sightline::detail
