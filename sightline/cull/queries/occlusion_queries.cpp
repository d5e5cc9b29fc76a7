// Occlusion culling by a graphics interface's own depth buffer: which boxes to ask about, when, and what to do meanwhile.
// SPDX-License-Identifier: MIT
//
// Jiri Bittner, Michael Wimmer, Harald Piringer, Werner Purgathofer. Coherent Hierarchical Culling: Hardware Occlusion
// Queries Made Useful. 2004.
// Oliver Mattausch, Jiri Bittner, Michael Wimmer. CHC++: Coherent Hierarchical Culling Revisited. 2008.
#include "sightline/cull/queries/occlusion_queries.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <tuple>

#include "sightline/cull/frustum.h"
#include "sightline/tree/descend.h"

namespace sightline {
namespace {

constexpr uint32_t kNoParent = ~0u;
constexpr uint32_t kMostFrames = 10000;  // that are counted

/// The chance that what was hidden for so many frames stays hidden, as Mattausch and others measured it.
double chanceToStay(uint32_t hidden_for) { return 0.99 - 0.7 * std::exp(-double(hidden_for)); }

}  // namespace

OcclusionQueries::OcclusionQueries(Memory* memory)
    : remembered_(memory),
      questions_(memory),
      asked_(memory),
      free_numbers_(memory),
      waiting_(memory),
      hidden_(memory),
      seen_(memory),
      tight_(memory),
      boxes_(memory),
      drawn_(memory) {}

std::span<const uint32_t> OcclusionQueries::draw(const PlacedBvh& tree, const View& view, QueryDevice& device,
                                                 const OcclusionQuerySettings& settings) {
    begin(tree, view, device, settings);
    if (tree.nodes.size() == 0) return drawn_;
    if (isUsable(view)) {
        walk();
    } else {
        forEachSlot(usedSlots(tree.nodes[0]), [&](int slot) { gather(tree.nodes[0].child[slot], 0); });
        if (!drawn_.empty()) device.draw(drawn_);
        stats_.drawn = static_cast<uint32_t>(drawn_.size());
    }
    return drawn_;
}

void OcclusionQueries::begin(const PlacedBvh& tree, const View& view, QueryDevice& device,
                             const OcclusionQuerySettings& settings) {
    if (&device != device_) {
        for (const Place& place : asked_) remembered_[place.slot].asked = false;
        questions_.clear();
        asked_.clear();
        free_numbers_.clear();
        first_question_ = numbers_ = 0;
    }
    tree_ = &tree;
    device_ = &device;
    settings_ = settings;
    settings_.never_wait &= settings.method == QueryMethod::kChc || settings.method == QueryMethod::kChcPlusPlus;
    stats_ = {};
    ++frame_;
    if (remembered_.size() < 8 * tree.nodes.size()) remembered_.resize(8 * tree.nodes.size());
    // What was taken leaves, so that questions which stay under way from frame to frame need no more and more room.
    const uint32_t gone =
        first_question_ < questions_.size() ? questions_[first_question_].first : static_cast<uint32_t>(asked_.size());
    questions_.erase(questions_.begin(), questions_.begin() + static_cast<std::ptrdiff_t>(first_question_));
    asked_.erase(asked_.begin(), asked_.begin() + gone);
    for (Question& question : questions_) question.first -= gone;
    first_question_ = first_seen_ = 0;
    open_questions_ = 0;
    opened_ = 0;
    asking_ = false;
    waiting_.clear();
    hidden_.clear();
    seen_.clear();
    drawn_.clear();
    if (!isUsable(view)) return;
    // After frames that did not wait: what they took to be hidden is known before this one begins.
    while (!settings_.never_wait &&
           std::any_of(questions_.begin() + static_cast<std::ptrdiff_t>(first_question_), questions_.end(),
                       [](const Question& question) { return !question.of_seen; }))
        takeAnswer(true);
    frustum_ = makeFrustum(view);
    padding_.emplace(view, settings.rounding);
    forward_ = isOrthographic(view) ? -glm::dvec3(glm::transpose(glm::dmat3(view.view))[2]) : glm::dvec3(0.0);
}

void OcclusionQueries::walk() {
    const bool waits = !settings_.never_wait;
    open(0, kNoParent, (1u << frustum_.count) - 1);
    for (;;) {
        while (takeAnswer(false)) {}
        if (!waiting_.empty()) visit(nextWaiting());
        else if (!hidden_.empty()) askHidden();
        else if (!waits || open_questions_ == 0) break;
        else if (!askOneSeen()) takeAnswer(true);  // something to do for the device while it is waited for
    }
    while (askOneSeen()) {}
}

uint32_t OcclusionQueries::childOf(uint32_t slot) const { return tree_->nodes[slot / 8].child[slot % 8]; }

uint32_t OcclusionQueries::itemsBelow(uint32_t slot) const {
    const BvhNode& node = tree_->nodes[slot / 8];
    return node.count[slot % 8] - node.empty[slot % 8];
}

Box3d OcclusionQueries::paddedBox(const Box3f& box) const {
    return padding_->padded({tree_->origin + glm::dvec3(box.min), tree_->origin + glm::dvec3(box.max)});
}

bool OcclusionQueries::isLeaf(uint32_t slot) const {
    return (childOf(slot) & BvhNode::kLeaf) != 0 || itemsBelow(slot) <= settings_.leaf_items;
}

/// Of what was not looked at in the last frame nobody knows: it is asked, or drawn if nobody is to wait for an answer.
bool OcclusionQueries::wasSeen(const Remembered& slot) const {
    if (slot.visited + 1 != frame_) return settings_.never_wait;
    return slot.seen;
}

double OcclusionQueries::keyOf(const Box3f& box) {
    ++opened_;
    if (settings_.order == QueryOrder::kTree) return -opened_;  // the last first: depth first
    double key = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = box.min[axis], high = box.max[axis], forward = forward_[axis];
        const double apart = std::max({low, -high, 0.0});
        key += forward_ == glm::dvec3(0.0) ? apart * apart : std::min(forward * low, forward * high);
    }
    return settings_.order == QueryOrder::kFarthest ? -key : key;
}

void OcclusionQueries::open(uint32_t node, uint32_t parent, uint32_t planes) {
    const BvhNode& children = tree_->nodes[node];
    const EyeBoxes boxes = eyeBoxes(children, tree_->origin - frustum_.eye);
    const FrustumAnswer answer = testFrustum(frustum_, boxes, planes);
    forEachSlot(usedSlots(children), [&](int which) {
        const uint32_t slot = 8 * node + static_cast<uint32_t>(which);
        if (itemsBelow(slot) == 0) return;
        if (answer.outside >> which & 1) {
            ++stats_.outside;
            return;
        }
        remembered_[slot].parent = parent;
        waiting_.push_back({keyOf(boxOf(boxes, which)), slot, answer.planes[which]});
        std::push_heap(waiting_.begin(), waiting_.end(), comesLater);
    });
}

bool OcclusionQueries::comesLater(const Place& a, const Place& b) {
    return std::tie(b.key, b.slot) < std::tie(a.key, a.slot);
}

OcclusionQueries::Place OcclusionQueries::nextWaiting() {
    std::pop_heap(waiting_.begin(), waiting_.end(), comesLater);
    const Place place = waiting_.back();
    waiting_.pop_back();
    return place;
}

void OcclusionQueries::visit(const Place& place) {
    ++stats_.visited;
    Remembered& slot = remembered_[place.slot];
    const bool was_seen = wasSeen(slot);
    slot.visited = frame_;
    slot.seen = false;
    if (settings_.method == QueryMethod::kNone) return show(place);
    if (!padding_->isBeyondNear(paddedBox(slotBox(tree_->nodes[place.slot / 8], static_cast<int>(place.slot % 8))))) {
        ++stats_.at_near;
        return show(place);
    }
    if (settings_.method == QueryMethod::kStopAndWait) {
        ask({&place, 1}, false);
        while (open_questions_ > 0) takeAnswer(true);
    } else if (was_seen) {
        visitSeen(place);
    } else {
        visitHidden(place);
    }
}

void OcclusionQueries::visitHidden(const Place& place) {
    if (settings_.never_wait) {
        stats_.assumed += itemsBelow(place.slot);  // until an answer comes
        remembered_[place.slot].assumed = frame_;
        if (remembered_[place.slot].asked) return;
    }
    if (settings_.method == QueryMethod::kChc) return ask({&place, 1}, false);
    hidden_.push_back(place);
    if (hidden_.size() >= settings_.batch) askHidden();
}

void OcclusionQueries::visitSeen(const Place& place) {
    Remembered& slot = remembered_[place.slot];
    if (!isLeaf(place.slot)) return open(childOf(place.slot), place.slot, place.planes);
    if (settings_.method == QueryMethod::kChc) {
        if (!slot.asked) ask({&place, 1}, true);
        // Whether it is seen in this frame is what its answer says, unless that comes too late.
        if (settings_.never_wait) markSeen(place.slot);
    } else {
        if (!slot.asked && slot.ask_again <= frame_) seen_.push_back(place);
        markSeen(place.slot);
    }
    drawBelow(place);
}

void OcclusionQueries::show(const Place& place) {
    markSeen(place.slot);
    if (isLeaf(place.slot)) drawBelow(place);
    else open(childOf(place.slot), place.slot, place.planes);
}

void OcclusionQueries::drawBelow(const Place& place) {
    const size_t before = drawn_.size();
    gather(childOf(place.slot), place.planes);
    if (drawn_.size() == before) return;
    device_->draw(std::span<const uint32_t>(drawn_).subspan(before));
    stats_.drawn += static_cast<uint32_t>(drawn_.size() - before);
    asking_ = false;
}

/// Appends the items below that the frustum leaves.
void OcclusionQueries::gather(uint32_t child, uint32_t planes) {
    if ((child & BvhNode::kLeaf) != 0) {
        const uint32_t item = tree_->order[child & ~BvhNode::kLeaf];
        if (item != PlacedBvh::kNone) drawn_.push_back(item);
        return;
    }
    const BvhNode& children = tree_->nodes[child];
    FrustumAnswer answer;
    if (planes != 0) answer = testFrustum(frustum_, eyeBoxes(children, tree_->origin - frustum_.eye), planes);
    forEachSlot(usedSlots(children) & ~answer.outside,
                [&](int slot) { gather(children.child[slot], planes != 0 ? answer.planes[slot] : 0); });
}

void OcclusionQueries::markSeen(uint32_t slot) {
    while (slot != kNoParent) {
        Remembered& at = remembered_[slot];
        if (at.seen && at.visited == frame_) return;
        at.seen = true;
        at.visited = frame_;
        at.hidden_for = 0;
        slot = at.parent;
    }
}

void OcclusionQueries::ask(std::span<const Place> places, bool of_seen) {
    const bool tight = settings_.method == QueryMethod::kChcPlusPlus && settings_.tight_boxes;
    tight_.clear();
    boxes_.clear();
    for (const Place& place : places) {
        appendBoxes(*tree_, place.slot, tight, tight_);
        remembered_[place.slot].asked = true;
    }
    for (const Box3f& box : tight_) boxes_.push_back(paddedBox(box));
    Question question;
    if (free_numbers_.empty()) {
        question.number = numbers_++;
    } else {
        question.number = free_numbers_.back();
        free_numbers_.pop_back();
    }
    question.frame = frame_;
    question.first = static_cast<uint32_t>(asked_.size());
    question.count = static_cast<uint32_t>(places.size());
    question.of_seen = of_seen;
    device_->ask(question.number, boxes_);
    asked_.insert(asked_.end(), places.begin(), places.end());
    questions_.push_back(question);
    // CHC decides about this frame's nodes when all answers are there; for CHC++ what is drawn already can wait.
    open_questions_ += !of_seen || settings_.method == QueryMethod::kChc;
    stats_.switches += !asking_;
    asking_ = true;
    ++stats_.questions;
    stats_.boxes += static_cast<uint32_t>(boxes_.size());
    stats_.nodes_asked += question.count;
    stats_.together += question.count > 1;
    stats_.of_seen += of_seen;
}

/// Puts nodes together that will stay hidden most likely: as many as one question is worth, if it must be followed by one
/// for each of them should anything be seen.
void OcclusionQueries::askHidden() {
    std::sort(hidden_.begin(), hidden_.end(), [&](const Place& a, const Place& b) {
        const uint16_t of_a = remembered_[a.slot].hidden_for, of_b = remembered_[b.slot].hidden_for;
        return std::tie(of_b, a.key, a.slot) < std::tie(of_a, b.key, b.slot);
    });
    const uint32_t most = std::max(settings_.together, 1u);
    for (size_t first = 0; first < hidden_.size();) {
        double all_stay = 1, best = 0;
        size_t count = 0;
        while (first + count < hidden_.size() && count < most) {
            all_stay *= chanceToStay(remembered_[hidden_[first + count].slot].hidden_for);
            const double nodes = double(count + 1), worth = nodes / (1 + (1 - all_stay) * nodes);
            if (worth < best) break;
            best = worth;
            ++count;
        }
        ask(std::span<const Place>(hidden_).subspan(first, count), false);
        first += count;
    }
    hidden_.clear();
}

bool OcclusionQueries::askOneSeen() {
    if (first_seen_ == seen_.size()) return false;
    ask({&seen_[first_seen_++], 1}, true);
    return true;
}

/// Takes the answer that comes next. False if there is none, or if it would have to be waited for.
bool OcclusionQueries::takeAnswer(bool wait) {
    if (first_question_ == questions_.size()) return false;
    const Question question = questions_[first_question_];
    if (!device_->hasAnswer(question.number)) {
        if (!wait) return false;
        ++stats_.waits;
    }
    const bool seen = device_->answer(question.number) > settings_.threshold;
    free_numbers_.push_back(question.number);
    ++first_question_;
    for (uint32_t i = 0; i < question.count; ++i) remembered_[asked_[question.first + i].slot].asked = false;
    if (question.frame == frame_) open_questions_ -= !question.of_seen || settings_.method == QueryMethod::kChc;
    if (question.of_seen) takeOfSeen(question, seen);
    else takeOfHidden(question, seen);
    return true;
}

void OcclusionQueries::takeOfSeen(const Question& question, bool seen) {
    const uint32_t slot = asked_[question.first].slot;
    if (!seen) {
        remembered_[slot].seen = false;
    } else if (settings_.method == QueryMethod::kChc) {
        if (question.frame == frame_) markSeen(slot);
    } else {
        const uint32_t least = std::clamp(settings_.seen_frames, 1u, kMostFrames);
        const uint32_t frames = std::clamp(2u * remembered_[slot].seen_frames, least, std::min(8 * least, kMostFrames));
        remembered_[slot].seen_frames = static_cast<uint16_t>(frames);
        remembered_[slot].ask_again = frame_ + frames;
    }
}

void OcclusionQueries::takeOfHidden(const Question& question, bool seen) {
    stats_.together_failed += seen && question.count > 1;
    for (uint32_t i = 0; i < question.count; ++i) {
        const Place place = asked_[question.first + i];  // a copy: asking moves them
        Remembered& slot = remembered_[place.slot];
        const bool now = question.frame == frame_;
        const bool again = seen && now && question.count > 1;
        if (slot.assumed == frame_ && (now ? !again : seen)) {
            stats_.assumed -= itemsBelow(place.slot);
            if (now) slot.assumed = 0;
        }
        if (!seen) {
            if (slot.hidden_for < kMostFrames) ++slot.hidden_for;
            if (now) stats_.hidden += itemsBelow(place.slot);
        } else if (!now) {
            takeLate(place);
        } else if (again) {
            slot.hidden_for = 0;
            ask({&place, 1}, false);
        } else {
            // Not all that appear at once are to be asked in the same frame.
            slot.seen_frames = 0;
            slot.ask_again =
                frame_ + 1 + static_cast<uint32_t>(random_.below(std::clamp(settings_.seen_frames, 1u, kMostFrames)));
            show(place);
        }
    }
}

/// A node that a frame before this one took to be hidden is seen after all.
void OcclusionQueries::takeLate(const Place& place) {
    Remembered& slot = remembered_[place.slot];
    if (slot.assumed == frame_) {
        slot.assumed = 0;
        return show({place.key, place.slot, (1u << frustum_.count) - 1});
    }
    if (slot.visited == frame_) return;  // it is drawn
    for (uint32_t at = place.slot; at != kNoParent; at = remembered_[at].parent) {
        Remembered& above = remembered_[at];
        if (above.visited == frame_ || (above.visited + 1 == frame_ && above.seen)) break;
        above.visited = frame_ - 1;
        above.seen = true;
        above.hidden_for = 0;
    }
}

}  // namespace sightline
