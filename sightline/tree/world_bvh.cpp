// The hierarchy of a world whose items come, move and go: items below a node have neighbouring places, some to spare.
// SPDX-License-Identifier: MIT
//
// Jon Louis Bentley, James B. Saxe. Decomposable Searching Problems I: Static-to-Dynamic Transformation. 1980.
#include "sightline/tree/world_bvh.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/tree/bvh_node.h"
#include "sightline/tree/bvh_split.h"

namespace sightline {
namespace {

/// A subtree of so many items is an item's neighbourhood.
constexpr uint32_t kNeighbours = 16;
/// An item strays if its neighbourhood grows to more than this times the surface that it was built with.
constexpr float kStrayed = 4.0f;
/// A subtree has decayed that has grown to more than this times the surface that it was built with.
constexpr float kDecayed = 1.4f;
/// Subtrees of so many items are built anew by themselves.
constexpr uint32_t kFewestMended = 16, kMostMended = 4096;
/// Items to a place to spare, where nodes have room.
constexpr uint32_t kItemsToSpare = 3;

bool isLeaf(uint32_t child) { return child & BvhNode::kLeaf; }

bool isEmpty(const BvhNode& node) {
    return std::all_of(std::begin(node.count), std::end(node.count), [](uint32_t count) { return count == 0; });
}

/// Empties a slot. If the slot keeps a place, that is a spare one.
void vacate(BvhNode& node, uint32_t slot, uint32_t place) {
    SIGHTLINE_DEBUG_ASSERT(slot < 8);
    clearSlot(node, static_cast<int>(slot));
    node.first[slot] = place;
}

/// An unused slot with a place, or 8.
uint32_t spareSlot(const BvhNode& node) {
    for (uint32_t slot = 0; slot < 8; ++slot)
        if (node.count[slot] == 0 && node.first[slot] != PlacedBvh::kNone) return slot;
    return 8;
}

/// A node of which no slot has a place.
BvhNode nodeWithoutPlaces() {
    BvhNode node = emptyNode();
    std::fill(std::begin(node.first), std::end(node.first), PlacedBvh::kNone);
    return node;
}

bool operator==(const Box3f& a, const Box3f& b) { return a.min == b.min && a.max == b.max; }

float reachOf(const Box3f& box) {
    float reach = 0;
    for (int axis = 0; axis < 3; ++axis) reach = std::max({reach, std::abs(box.min[axis]), std::abs(box.max[axis])});
    return reach;
}

}  // namespace

uint32_t PlacedBvh::size() const {
    uint32_t items = 0;
    for (int slot = 0; slot < 8 && !nodes.empty(); ++slot) items += nodes[0].count[slot] - nodes[0].empty[slot];
    return items;
}

float PlacedBvh::reach() const {
    const Box3f all = nodes.empty() ? Box3f() : boundsOf(nodes[0]);
    return all.empty() ? 0.0f : reachOf(all);
}

WorldBvh::WorldBvh(Memory* memory)
    : memory_(memory),
      now_(memory),
      parent_(memory),
      fresh_(memory),
      marked_(memory),
      decayed_(memory),
      given_anew_(memory),
      free_nodes_(memory),
      trees_(memory),
      items_(memory),
      boxes_(memory),
      sorted_(memory) {}

void WorldBvh::clear() {
    now_.nodes.clear();
    now_.order.clear();
    now_.slot.clear();
    parent_.clear();
    fresh_.clear();
    marked_.clear();
    decayed_.clear();
    free_nodes_.clear();
    living_ = 0;
    reach_ = farthest_ = 0;
    trees_.clear();
    items_.clear();
    boxes_.clear();
}

uint32_t WorldBvh::newNode() {
    if (!free_nodes_.empty()) {
        const uint32_t index = free_nodes_.back();
        free_nodes_.pop_back();
        SIGHTLINE_DEBUG_ASSERT(index < now_.nodes.size() && !marked_[index]);
        now_.nodes.set(index, nodeWithoutPlaces());
        return index;
    }
    now_.nodes.push_back(nodeWithoutPlaces());
    parent_.push_back(kNone);
    fresh_.push_back(0.0f);
    marked_.push_back(0);
    SIGHTLINE_DEBUG_ASSERT(parent_.size() == now_.nodes.size() && fresh_.size() == parent_.size());
    return now_.nodes.size() - 1;
}

void WorldBvh::freeNode(uint32_t index) {
    SIGHTLINE_DEBUG_ASSERT(index > 0 && index < now_.nodes.size());
    marked_[index] = 0;
    free_nodes_.push_back(index);
}

/// Notes that a child, which is a node or an item's place, is in a slot.
void WorldBvh::hang(uint32_t parent, uint32_t child) {
    SIGHTLINE_DEBUG_ASSERT(parent / 8 < now_.nodes.size());
    if (!isLeaf(child)) parent_[child] = parent;
    else now_.slot.set(now_.order[child & ~BvhNode::kLeaf], parent);
}

/// Puts a root above the tree that has been the only one.
void WorldBvh::openRoot() {
    SIGHTLINE_DEBUG_ASSERT(trees_.size() == 1 && !now_.nodes.empty());
    const uint32_t below = newNode();
    const BvhNode node = now_.nodes[0];
    now_.nodes.set(below, node);
    fresh_[below] = fresh_[0];
    for (uint32_t slot = 0; slot < 8; ++slot)
        if (node.count[slot] > 0) hang(8 * below + slot, node.child[slot]);
    BvhNode root = nodeWithoutPlaces();
    if (isEmpty(node)) {
        freeNode(below);
    } else {
        setSlot(root, 0, boundsOf(node));
        root.first[0] = 0;
        root.child[0] = below;
        root.count[0] = placesOf(0);
        root.empty[0] = placesOf(0) - living_;
        parent_[below] = 0;
    }
    now_.nodes.set(0, root);
    fresh_[0] = 0.0f;
}

uint32_t WorldBvh::placesOf(size_t tree) const {
    SIGHTLINE_DEBUG_ASSERT(tree < trees_.size());
    const uint32_t end = tree + 1 < trees_.size() ? trees_[tree + 1].first : now_.order.size();
    SIGHTLINE_DEBUG_ASSERT(end >= trees_[tree].first);
    return end - trees_[tree].first;
}

/// Builds a tree over items_ and boxes_, two or more, in places from `first` on that are there and empty.
/// @param root    the node that becomes its root; it is new
/// @param parent  slot that it hangs in, or kNone
/// @param spare   places that nodes may have besides those of their items
void WorldBvh::growTree(uint32_t root, uint32_t parent, uint32_t first, uint32_t spare, Growth growth) {
    const uint32_t count = static_cast<uint32_t>(items_.size());
    SIGHTLINE_DEBUG_ASSERT(count > 0 && boxes_.size() == count);
    SIGHTLINE_DEBUG_ASSERT(root < now_.nodes.size() && isEmpty(now_.nodes[root]));
    SIGHTLINE_DEBUG_ASSERT(first + count + spare <= now_.order.size());
    sorted_.resize(count);
    BvhSplitter splitter(sorted_, memory_);
    splitter.boxes.assign(boxes_.begin(), boxes_.end());
    splitter.centers.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
        sorted_[i] = i;
        splitter.centers[i] = splitCenter(boxes_[i]);
        farthest_ = std::max(farthest_, reachOf(boxes_[i]));
    }
    if (growth == Growth::kQuick) splitter.sortAlongCurve();
    struct Job {
        BvhRange range;
        uint32_t index, parent;
    };
    Array<Job> jobs({{{0, count, splitter.boundsOf(0, count)}, root, parent}}, memory_);
    Array<uint32_t> made(memory_);  // parents before children, each with all that is below it before the next
    uint32_t next = first, to_spare = spare, met = 0;
    while (!jobs.empty()) {
        Job job = jobs.back();
        jobs.pop_back();
        if (job.index == kNone) job.index = newNode();
        made.push_back(job.index);
        parent_[job.index] = job.parent;
        fresh_[job.index] = halfArea(job.range.bounds);
        if (job.parent != parent) now_.nodes.change(job.parent / 8).child[job.parent % 8] = job.index;
        BvhRange parts[8];
        const uint32_t used = static_cast<uint32_t>(growth == Growth::kQuick ? splitter.cutToEight(job.range, parts)
                                                                             : splitter.splitToEight(job.range, parts));
        BvhNode& node = now_.nodes.change(job.index);
        for (uint32_t part = used; part-- > 0;) {
            setSlot(node, static_cast<int>(part), parts[part].bounds);
            node.count[part] = parts[part].count();
            node.empty[part] = 0;
            const uint32_t at = 8 * job.index + part;
            if (parts[part].count() > 1) {
                jobs.push_back({parts[part], kNone, at});
                continue;
            }
            const uint32_t item = items_[sorted_[parts[part].first]];
            SIGHTLINE_DEBUG_ASSERT(next < first + count + spare);
            node.first[part] = next;
            node.child[part] = BvhNode::kLeaf | next;
            now_.order.set(next++, item);
            setSlotOf(item, at);
            ++met;
        }
        // As many places to spare so far as items, shared out.
        for (uint32_t part = 0; part < 8; ++part) {
            if (part < used) continue;
            const bool has = to_spare > 0 && uint64_t{spare - to_spare} * count <= uint64_t{spare} * met;
            node.first[part] = has ? next++ : kNone;
            to_spare -= has;
        }
    }
    SIGHTLINE_DEBUG_ASSERT(next <= first + count + spare && met == count);
    for (size_t i = made.size(); i-- > 1;) {
        const uint32_t above = parent_[made[i]];
        BvhNode& node = now_.nodes.change(above / 8);
        const BvhNode& below = now_.nodes[made[i]];
        uint32_t begins = ~0u, places = 0, empty = 0;
        for (int slot = 0; slot < 8; ++slot) {
            if (below.first[slot] == kNone) continue;
            begins = std::min(begins, below.first[slot]);
            places += std::max(below.count[slot], 1u);
            empty += below.count[slot] == 0 ? 1 : below.empty[slot];
        }
        SIGHTLINE_DEBUG_ASSERT(begins >= first && begins + places <= first + count + spare && empty < places);
        node.first[above % 8] = begins;
        node.count[above % 8] = places;
        node.empty[above % 8] = empty;
    }
}

void WorldBvh::setSlotOf(uint32_t item, uint32_t slot) {
    for (uint32_t unknown = now_.slot.size(); unknown <= item; ++unknown) now_.slot.push_back(kNone);
    now_.slot.set(item, slot);
}

/// Hangs a tree over items_ and boxes_ into the next slot of the root, with places behind all others.
/// @returns the first of them
uint32_t WorldBvh::hangTree(Growth growth) {
    const uint32_t slot = static_cast<uint32_t>(trees_.size()), first = now_.order.size();
    const uint32_t count = static_cast<uint32_t>(items_.size()), spare = count > 1 ? count / kItemsToSpare : 0;
    SIGHTLINE_DEBUG_ASSERT(slot > 0 && slot < kTrees);
    SIGHTLINE_DEBUG_ASSERT(count > 0 && boxes_.size() == count);
    trees_.push_back({first});
    for (uint32_t i = 0; i < count + spare; ++i) now_.order.push_back(kNone);
    Box3f bounds;
    for (const Box3f& box : boxes_) bounds.grow(box);
    BvhNode& root = now_.nodes.change(0);
    setSlot(root, static_cast<int>(slot), bounds);
    root.first[slot] = first;
    root.count[slot] = count + spare;
    root.empty[slot] = spare;
    living_ += count;
    if (count > 1) {
        const uint32_t index = newNode();
        now_.nodes.change(0).child[slot] = index;
        growTree(index, slot, first, spare, growth);
    } else {
        now_.order.set(first, items_[0]);
        now_.nodes.change(0).child[slot] = BvhNode::kLeaf | first;
        setSlotOf(items_[0], slot);
        farthest_ = std::max(farthest_, reachOf(bounds));
    }
    return first;
}

void WorldBvh::build(std::span<const Box3d> boxes, std::span<const uint32_t> items) {
    SIGHTLINE_ASSERT(boxes.size() == items.size());
    clear();
    if (boxes.empty()) return;
    Box3d world;
    for (const Box3d& box : boxes) {
        SIGHTLINE_DEBUG_ASSERT(box.finite() && !box.empty());
        world.grow(box);
    }
    now_.origin = world.center();
    items_.assign(items.begin(), items.end());
    boxes_.reserve(boxes.size());
    for (const Box3d& box : boxes) boxes_.push_back(roundOutward(box, now_.origin));
    trees_.push_back({0});
    const uint32_t count = static_cast<uint32_t>(boxes.size()), spare = count / kItemsToSpare;
    for (uint32_t i = 0; i < count + spare; ++i) now_.order.push_back(kNone);
    living_ = count;
    growTree(newNode(), kNone, 0, spare, Growth::kGood);
    reach_ = farthest_;
}

/// Takes all items below a child into items_ and boxes_, in the order of their places, and gives its nodes back. A tree
/// over them must be built at once: till then their slots are wrong.
void WorldBvh::gather(uint32_t child, const Box3f& box) {
    if (isLeaf(child)) {
        SIGHTLINE_DEBUG_ASSERT((child & ~BvhNode::kLeaf) < now_.order.size() &&
                               now_.order[child & ~BvhNode::kLeaf] != kNone);
        items_.push_back(now_.order[child & ~BvhNode::kLeaf]);
        boxes_.push_back(box);
        return;
    }
    SIGHTLINE_DEBUG_ASSERT(child < now_.nodes.size());
    const BvhNode node = now_.nodes[child];
    for (int slot = 0; slot < 8; ++slot)
        if (node.count[slot] > 0) gather(node.child[slot], slotBox(node, slot));
    freeNode(child);
}

uint32_t WorldBvh::append(std::span<const Box3d> boxes, std::span<const uint32_t> items) {
    SIGHTLINE_ASSERT(boxes.size() == items.size());
    if (boxes.empty()) return now_.order.size();
    if (trees_.empty()) {
        build(boxes, items);
        return 0;
    }
    items_.assign(items.begin(), items.end());
    boxes_.clear();
    for (const Box3d& box : boxes) boxes_.push_back(roundOutward(box, now_.origin));
    if (trees_.size() == 1) openRoot();
    while (trees_.size() > 1 && (trees_.size() == kTrees || placesOf(trees_.size() - 1) <= 2 * items_.size()))
        takeInLast();
    return hangTree(Growth::kGood);
}

/// Takes all items of the last batch into items_ and boxes_, and its places away.
void WorldBvh::takeInLast() {
    SIGHTLINE_DEBUG_ASSERT(trees_.size() > 1 && items_.size() == boxes_.size());
    const uint32_t slot = static_cast<uint32_t>(trees_.size() - 1), before = static_cast<uint32_t>(items_.size());
    const BvhNode root = now_.nodes[0];
    if (root.count[slot] > 0) gather(root.child[slot], slotBox(root, static_cast<int>(slot)));
    vacate(now_.nodes.change(0), slot, kNone);
    SIGHTLINE_DEBUG_ASSERT(living_ >= items_.size() - before);
    living_ -= static_cast<uint32_t>(items_.size()) - before;
    now_.order.resize(trees_.back().first);
    trees_.pop_back();
}

uint32_t WorldBvh::inBatches() const {
    uint32_t items = 0;
    for (size_t slot = 1; slot < trees_.size(); ++slot) items += now_.nodes[0].count[slot] - now_.nodes[0].empty[slot];
    return items;
}

uint32_t WorldBvh::renewBatches(std::span<const Box3d> boxes, std::span<const uint32_t> items) {
    SIGHTLINE_ASSERT(boxes.size() == items.size());
    if (items.empty()) return now_.order.size();
    for (size_t i = 0; i < items.size(); ++i) {
        SIGHTLINE_ASSERT(isInBatch(items[i]));
        const uint32_t at = now_.slot[items[i]];
        setSlot(now_.nodes.change(at / 8), static_cast<int>(at % 8), roundOutward(boxes[i], now_.origin));
    }
    items_.clear();
    boxes_.clear();
    while (trees_.size() > 1) takeInLast();
    return hangTree(Growth::kQuick);
}

/// Makes the bounds above a node tight again, and takes it away if nothing is below it.
void WorldBvh::tightenAbove(uint32_t index) {
    SIGHTLINE_DEBUG_ASSERT(index < parent_.size());
    while (parent_[index] != kNone) {
        const uint32_t above = parent_[index];
        const int slot = static_cast<int>(above % 8);
        if (isEmpty(now_.nodes[index])) {
            // One of the node's places stays with the slot, unless that is the root's: there trees begin.
            const uint32_t place = above / 8 == 0 && trees_.size() > 1 ? kNone : now_.nodes[above / 8].first[slot];
            vacate(now_.nodes.change(above / 8), above % 8, place);
            freeNode(index);
        } else {
            const Box3f box = boundsOf(now_.nodes[index]);
            if (slotBox(now_.nodes[above / 8], slot) == box) return;
            setSlot(now_.nodes.change(above / 8), slot, box);
            noteDecay(index, now_.nodes[above / 8].count[slot], box);
        }
        index = above / 8;
    }
}

void WorldBvh::noteDecay(uint32_t index, uint32_t places, const Box3f& box) {
    SIGHTLINE_DEBUG_ASSERT(index < marked_.size());
    if (marked_[index] || places < kFewestMended || places > kMostMended) return;
    if (halfArea(box) <= kDecayed * fresh_[index]) return;
    marked_[index] = 1;
    decayed_.push_back(index);
}

/// Adds to how many places above a node are empty.
void WorldBvh::countEmpty(uint32_t index, uint32_t more) {
    for (uint32_t above = parent_[index]; above != kNone; above = parent_[above / 8]) {
        BvhNode& node = now_.nodes.change(above / 8);
        node.empty[above % 8] += more;
        SIGHTLINE_DEBUG_ASSERT(node.empty[above % 8] <= node.count[above % 8]);
    }
}

uint32_t WorldBvh::insert(uint32_t item, const Box3d& box, Among among) {
    SIGHTLINE_ASSERT(!contains(item));
    SIGHTLINE_DEBUG_ASSERT(box.finite() && !box.empty());
    if (trees_.empty() || (among == Among::kBatches && trees_.size() == 1)) return kNone;
    const Box3f bounds = roundOutward(box, now_.origin);
    uint32_t index = 0, found = kNone;
    int from = among == Among::kBatches ? 1 : 0;  // the root's first slot has the tree that was built
    for (bool deeper = true; deeper;) {
        const BvhNode& node = now_.nodes[index];
        if (spareSlot(node) < 8) found = index;
        deeper = false;
        float least = 0;
        uint32_t best = kNone;
        for (int slot = std::exchange(from, 0); slot < 8; ++slot) {
            if (node.count[slot] == 0 || isLeaf(node.child[slot])) continue;
            Box3f grown = slotBox(node, slot);
            const float before = halfArea(grown);
            grown.grow(bounds);
            const float growth = halfArea(grown) - before;
            if (best != kNone && !(growth < least)) continue;
            least = growth;
            best = node.child[slot];
            // What would decay by it is not for it.
            deeper = halfArea(grown) <= kDecayed * fresh_[best];
        }
        if (deeper) index = best;
    }
    if (found == kNone) return kNone;
    const uint32_t slot = spareSlot(now_.nodes[found]);
    BvhNode& node = now_.nodes.change(found);
    const uint32_t place = node.first[slot];
    SIGHTLINE_DEBUG_ASSERT(place < now_.order.size() && now_.order[place] == kNone);
    setSlot(node, static_cast<int>(slot), bounds);
    node.child[slot] = BvhNode::kLeaf | place;
    node.count[slot] = 1;
    now_.order.set(place, item);
    setSlotOf(item, 8 * found + slot);
    countEmpty(found, ~0u);
    ++living_;
    farthest_ = std::max(farthest_, reachOf(bounds));
    tightenAbove(found);
    return place;
}

/// Builds all below a node anew in the places that it has.
void WorldBvh::rebuildBelow(uint32_t index) {
    SIGHTLINE_DEBUG_ASSERT(parent_[index] != kNone);
    const uint32_t above = parent_[index], first = now_.nodes[above / 8].first[above % 8];
    const uint32_t count = now_.nodes[above / 8].count[above % 8];
    items_.clear();
    boxes_.clear();
    const BvhNode node = now_.nodes[index];
    for (int slot = 0; slot < 8; ++slot)
        if (node.count[slot] > 0) gather(node.child[slot], slotBox(node, slot));
    SIGHTLINE_DEBUG_ASSERT(!items_.empty() && items_.size() <= count);
    for (uint32_t place = first; place < first + count; ++place) now_.order.set(place, kNone);
    now_.nodes.set(index, nodeWithoutPlaces());
    growTree(index, above, first, count - static_cast<uint32_t>(items_.size()), Growth::kGood);
    given_anew_.push_back({first, first + count});
}

std::span<const WorldBvh::Places> WorldBvh::mend(uint32_t most) {
    given_anew_.clear();
    const auto places = [&](uint32_t index) { return now_.nodes[parent_[index] / 8].count[parent_[index] % 8]; };
    erase_if(decayed_, [&](uint32_t index) { return !marked_[index]; });
    std::sort(decayed_.begin(), decayed_.end(),
              [&](uint32_t a, uint32_t b) { return places(a) != places(b) ? places(a) < places(b) : a < b; });
    uint32_t left = std::max(most, kMostMended);
    for (const uint32_t index : decayed_) {
        if (!marked_[index]) continue;  // a node above it has been built anew, or it is here twice
        if (places(index) > left) break;
        marked_[index] = 0;
        left -= places(index);
        rebuildBelow(index);
    }
    erase_if(decayed_, [&](uint32_t index) { return !marked_[index]; });
    return given_anew_;
}

bool WorldBvh::move(uint32_t item, const Box3d& box) {
    SIGHTLINE_ASSERT(contains(item));
    SIGHTLINE_DEBUG_ASSERT(box.finite() && !box.empty());
    const Box3f bounds = roundOutward(box, now_.origin);
    const uint32_t at = now_.slot[item];
    const Box3f before = slotBox(now_.nodes[at / 8], static_cast<int>(at % 8));
    if (before == bounds) return true;
    // The neighbourhood: the first node above with so many items. What it was built with lies in one piece.
    Box3f grown = bounds;
    for (uint32_t index = at / 8; parent_[index] != kNone; index = parent_[index] / 8) {
        const uint32_t above = parent_[index];
        const BvhNode& node = now_.nodes[above / 8];
        grown.grow(slotBox(node, static_cast<int>(above % 8)));
        if (node.count[above % 8] < kNeighbours) continue;
        if (halfArea(grown) > kStrayed * fresh_[index]) return false;
        break;
    }
    farthest_ = std::max(farthest_, reachOf(bounds));
    setSlot(now_.nodes.change(at / 8), static_cast<int>(at % 8), bounds);
    tightenAbove(at / 8);
    return true;
}

uint32_t WorldBvh::remove(uint32_t item) {
    SIGHTLINE_ASSERT(contains(item));
    const uint32_t at = now_.slot[item], place = now_.nodes[at / 8].first[at % 8];
    SIGHTLINE_DEBUG_ASSERT(now_.order[place] == item && living_ > 0);
    now_.slot.set(item, kNone);
    now_.order.set(place, kNone);
    const bool is_tree = at / 8 == 0 && trees_.size() > 1;
    vacate(now_.nodes.change(at / 8), at % 8, is_tree ? kNone : place);
    --living_;
    countEmpty(at / 8, 1);
    tightenAbove(at / 8);
    return place;
}

bool WorldBvh::isWorn(uint32_t coming) const {
    if (trees_.empty()) return false;
    const uint32_t came = now_.order.size() - placesOf(0) + coming;
    constexpr float kReaches = 4.0f;  // floats far from the origin are coarse
    return came > placesOf(0) / 2 + kNeighbours || now_.order.size() > 3 * living_ + kNeighbours ||
           farthest_ > kReaches * reach_;
}

PlacedBvh WorldBvh::share() {
    PlacedBvh copy(memory_);
    copy.origin = now_.origin;
    copy.nodes = now_.nodes.share();
    copy.order = now_.order.share();
    copy.slot = now_.slot.share();
    return copy;
}

}  // namespace sightline
