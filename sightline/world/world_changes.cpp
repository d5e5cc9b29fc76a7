// A world as its user changes it, and how the next snapshot is made of the last one.
// SPDX-License-Identifier: MIT
#include "sightline/world/world_changes.h"

#include <algorithm>

#include "sightline/base/assert.h"
#include "sightline/world/validate_world.h"

namespace sightline::detail {
namespace {

void setBit(Array<uint64_t>& bits, uint32_t i) {
    if (bits.size() <= i / 64) bits.resize(i / 64 + 1, 0);
    bits[i / 64] |= uint64_t{1} << i % 64;
}

/// Records are fetched so many ahead of their turn.
constexpr uint32_t kAhead = 8;

/// A commit moves at most this many objects to new places for each object that was changed.
constexpr size_t kMendedToChanged = 2;

/// An object is restless that moves again within so many commits.
constexpr uint32_t kRestless = 4;
/// Restless objects have trees of their own unless more than one of so many objects would be there: where most of a node
/// moves, it may as well move in place.
constexpr uint32_t kToMover = 4;

void clearBit(Array<uint64_t>& bits, uint32_t i) { bits[i / 64] &= ~(uint64_t{1} << i % 64); }

}  // namespace

WorldState::WorldState(Memory* from) : memory(from) {
    occluders.push_back(nullptr);
    clusters.push_back(nullptr);
    lods.push_back(nullptr);
}

void WorldState::reserve(uint32_t objects) { living_.reserve(objects / 64 + 1); }

/// The row of an object, or IdSlot::kNowhere.
uint32_t WorldState::find(ObjectId id) const {
    if (id.index == 0 || id.index > ids_.size()) return IdSlot::kNowhere;
    const IdSlot& slot = ids_[id.index - 1];
    return slot.generation == id.generation ? slot.row : IdSlot::kNowhere;
}

/// An id for the object that is appended next.
ObjectId WorldState::newId() {
    if (free_ids_.empty()) {
        ids_.push_back({});
        free_ids_.push_back(ids_.size());
    }
    const uint32_t index = free_ids_.back();
    free_ids_.pop_back();
    SIGHTLINE_DEBUG_ASSERT(index > 0 && index <= ids_.size() && ids_[index - 1].row == IdSlot::kNowhere);
    IdSlot& slot = ids_.change(index - 1);
    slot.row = objects_.size();
    return {index, ++slot.generation};
}

OccluderId WorldState::addOccluder(const Occluder& occluder, std::span<const InnerOccluder> inner) {
    occluders.push_back(makeShared<HeldOccluder>(memory, occluder, inner, volumes, memory));
    changed_ = true;
    return {occluders.size() - 1};
}

ClustersId WorldState::addClusters(const DrawClusters& given) {
    auto held = makeShared<DrawClusters>(memory, memory);
    *held = given;
    clusters.push_back(std::move(held));
    changed_ = true;
    return {clusters.size() - 1};
}

LodsId WorldState::addLods(std::span<const LodLevel> levels) {
    lods.push_back(makeShared<HeldLods>(memory, levels, memory));
    changed_ = true;
    return {lods.size() - 1};
}

ObjectId WorldState::add(const ObjectDef& object) {
    SIGHTLINE_ASSERT(object.occluder.index < occluders.size());
    SIGHTLINE_ASSERT(object.shape.index < occluders.size());
    SIGHTLINE_ASSERT(object.clusters.index < clusters.size());
    SIGHTLINE_ASSERT(object.lods.index < lods.size());
    const ObjectId id = newId();
    setBit(living_, objects_.size());
    objects_.push_back({object.transform, object.bounds, object.key, id, object.occluder, object.layers, object.shape,
                        object.limits, object.clusters, object.lods, object.hides_in_lods});
    limited_ += object.limits != ObjectLimits();
    changed_ = true;
    return id;
}

bool WorldState::move(ObjectId id, const glm::dmat4& transform) {
    const uint32_t row = find(id);
    if (row == IdSlot::kNowhere) return false;
    SIGHTLINE_DEBUG_ASSERT(row < objects_.size() && lives(row));
    ObjectRecord& object = objects_.change(row);
    object.moved |= object.transform != transform;
    object.transform = transform;
    if (row < committed_) noteMove(row, object);
    changed_ = true;
    return true;
}

void WorldState::noteMove(uint32_t row, ObjectRecord& object) {
    SIGHTLINE_DEBUG_ASSERT(row < committed_ && object.moved_in <= commit_);
    const Box3d box = worldBounds(object);
    if (object.moved_in == commit_) {
        SIGHTLINE_DEBUG_ASSERT(object.moved_number < moved_.size() && moved_[object.moved_number].row == row);
        moved_[object.moved_number].box = box;
        return;
    }
    const bool restless = object.moved_in != 0 && commit_ - object.moved_in <= kRestless;
    object.moved_in = commit_;
    object.moved_number = static_cast<uint32_t>(moved_.size());
    moved_.push_back({row, restless, box});
}

bool WorldState::remove(ObjectId id) {
    const uint32_t row = find(id);
    if (row == IdSlot::kNowhere) return false;
    SIGHTLINE_DEBUG_ASSERT(lives(row) && objects_[row].id == id);
    SIGHTLINE_DEBUG_ASSERT(limited_ > 0 || objects_[row].limits == ObjectLimits());
    limited_ -= objects_[row].limits != ObjectLimits();
    objects_.set(row, {});
    clearBit(living_, row);
    ++gaps_;
    ids_.change(id.index - 1).row = IdSlot::kNowhere;
    free_ids_.push_back(id.index);
    if (row < committed_) removed_.push_back(row);
    changed_ = true;
    return true;
}

/// Closes the gaps that removed objects left, once they are as many as the living.
void WorldState::compact() {
    if (gaps_ < size() + 1024) return;
    ObjectTable packed(memory);
    living_.clear();
    moved_.clear();
    for (uint32_t row = 0; row < objects_.size(); ++row) {
        const ObjectRecord& object = objects_[row];
        if (object.id.index == 0) continue;
        ids_.change(object.id.index - 1).row = packed.size();
        setBit(living_, packed.size());
        packed.push_back(object);
    }
    SIGHTLINE_DEBUG_ASSERT(packed.size() == size());
    objects_ = std::move(packed);
    gaps_ = 0;
    cells_.renumber();
}

/// Takes an object out of the hierarchy, or from among the unbounded.
void WorldState::takeOut(uint32_t row) {
    if (bvh_.contains(row)) {
        const uint32_t place = bvh_.remove(row);
        SIGHTLINE_DEBUG_ASSERT(place < placed_.size());
        cells_.notePlaces(place, place + 1);
        return placed_.set(place, {});
    }
    const auto at = std::lower_bound(unbounded_.begin(), unbounded_.end(), row);
    SIGHTLINE_ASSERT(at != unbounded_.end() && *at == row);
    unbounded_.erase(at);
}

/// Notes an object for the hierarchy, or puts it among the unbounded.
/// @param box  its bounds in the world
void WorldState::putIn(uint32_t row, const Box3d& box, bool restless) {
    SIGHTLINE_DEBUG_ASSERT(lives(row));
    if (box.finite()) {
        boxes_.push_back(box);
        rows_.push_back(row);
        restless_.push_back(restless);
    } else {
        unbounded_.insert(std::lower_bound(unbounded_.begin(), unbounded_.end(), row), row);
    }
}

/// Writes down what stands in a range of the hierarchy's places.
void WorldState::place(uint32_t first, uint32_t end) {
    SIGHTLINE_DEBUG_ASSERT(first <= end && end <= placed_.size() && placed_.size() == bvh_.now().order.size());
    cells_.notePlaces(first, end);
    const auto& order = bvh_.now().order;
    for (uint32_t at = first; at < end; ++at) {
        if (at + kAhead < end && order[at + kAhead] != PlacedBvh::kNone) objects_.prefetch(order[at + kAhead]);
        const uint32_t row = order[at];
        placed_.set(at, row == PlacedBvh::kNone ? PlacedObject() : placedObject(objects_[row]));
        if (at < limits_.objects.size()) limits_.objects.set(at, limitsAt(row));
    }
}

/// The same for all places from one on, which are given anew.
void WorldState::placeFrom(uint32_t first) {
    placed_.resize(bvh_.now().order.size());
    if (!limits_.empty()) limits_.objects.resize(std::min(first, limits_.objects.size()));
    place(first, placed_.size());
}

PlacedLimits::One WorldState::limitsAt(uint32_t row) const {
    return row == PlacedBvh::kNone ? PlacedLimits::One() : placedLimits(objects_[row].limits);
}

/// Brings all else up to date that goes by places, after some were given anew.
void WorldState::noteLimits() {
    if (limited_ == 0) return limits_.clear();
    const auto& order = bvh_.now().order;
    for (uint32_t at = limits_.objects.size(); at < order.size(); ++at) limits_.objects.push_back(limitsAt(order[at]));
    SIGHTLINE_DEBUG_ASSERT(limits_.objects.size() == order.size());
    noteLimitsBelow(bvh_.now(), limits_);
}

/// Builds the hierarchy anew.
void WorldState::build() {
    compact();
    unbounded_.clear();
    boxes_.clear();
    rows_.clear();
    restless_.clear();
    common_layers_ = ~0u;
    for (uint32_t row = 0; row < objects_.size(); ++row) {
        if (!lives(row)) continue;
        common_layers_ &= objects_[row].layers;
        putIn(row, worldBounds(objects_[row]));
    }
    SIGHTLINE_DEBUG_ASSERT(boxes_.size() + unbounded_.size() == size());
    bvh_.build(boxes_, rows_);
    limits_.clear();
    placed_.clear();
    placed_.resize(bvh_.now().order.size());
    place(0, placed_.size());
    noteLimits();
}

/// Puts what has moved into the order of the hierarchy: neighbours share nodes, which are then at hand.
void WorldState::sortMoved() {
    places_.clear();
    for (uint32_t i = 0; i < moved_.size(); ++i) places_.push_back(uint64_t{bvh_.slotOf(moved_[i].row)} << 32 | i);
    std::sort(places_.begin(), places_.end());
}

/// Gives what has moved its new bounds. What must find a new place is taken out, and waits in rows_ and boxes_; of the
/// trees of movers it stays, and waits in strays_.
void WorldState::moveAll() {
    sortMoved();
    for (const uint64_t place : places_) {
        const auto& [row, restless, box] = moved_[static_cast<uint32_t>(place)];
        SIGHTLINE_DEBUG_ASSERT(row < committed_);
        if (!lives(row)) continue;
        if (box.finite() && bvh_.contains(row)) {
            const bool with_movers = bvh_.isInBatch(row);
            if ((with_movers || !movers_apart_ || !restless) && bvh_.move(row, box)) continue;
            if (with_movers) {
                strays_.push_back(row);
                stray_boxes_.push_back(box);
                continue;
            }
        }
        takeOut(row);
        putIn(row, box, restless);
    }
}

/// Finds places for what has strayed in the trees of movers: where that is most of them, these are built anew.
void WorldState::renewMovers() {
    SIGHTLINE_DEBUG_ASSERT(strays_.size() == stray_boxes_.size());
    if (!strays_.empty() && 2 * strays_.size() >= bvh_.inBatches())
        return placeFrom(bvh_.renewBatches(stray_boxes_, strays_));
    for (size_t i = 0; i < strays_.size(); ++i) {
        takeOut(strays_[i]);
        putIn(strays_[i], stray_boxes_[i], true);
    }
}

/// Puts what waits in rows_ and boxes_ into the hierarchy. False: building it anew is better.
bool WorldState::enterAll() {
    SIGHTLINE_DEBUG_ASSERT(rows_.size() == boxes_.size() && rows_.size() == restless_.size());
    size_t left = 0;
    for (size_t i = 0; i < rows_.size(); ++i) {
        const bool apart = movers_apart_ && restless_[i];
        const uint32_t at = bvh_.insert(rows_[i], boxes_[i], apart ? WorldBvh::Among::kBatches : WorldBvh::Among::kAll);
        if (at == PlacedBvh::kNone) {
            rows_[left] = rows_[i];
            boxes_[left++] = boxes_[i];
        } else {
            place(at, at + 1);
        }
    }
    rows_.resize(left);
    boxes_.resize(left);
    if (bvh_.isWorn(static_cast<uint32_t>(left))) return false;
    if (left > 0) placeFrom(bvh_.append(boxes_, rows_));
    return true;
}

/// Brings the hierarchy up to date, or builds it anew where that is better.
void WorldState::update() {
    boxes_.clear();
    rows_.clear();
    restless_.clear();
    strays_.clear();
    stray_boxes_.clear();
    for (const uint32_t row : removed_) takeOut(row);
    movers_apart_ = uint64_t{kToMover} * (bvh_.inBatches() + moved_.size()) <= size();
    moveAll();
    renewMovers();
    for (uint32_t row = committed_; row < objects_.size(); ++row) {
        if (!lives(row)) continue;
        common_layers_ &= objects_[row].layers;
        putIn(row, worldBounds(objects_[row]));
    }
    const bool came = !rows_.empty() || !strays_.empty();
    if (bvh_.isWorn() || !enterAll()) return build();
    const size_t changes = moved_.size() + removed_.size() + (objects_.size() - committed_);
    const std::span<const WorldBvh::Places> mended = bvh_.mend(static_cast<uint32_t>(kMendedToChanged * changes));
    for (const WorldBvh::Places& places : mended) place(places.first, places.end);
    if (came || !mended.empty()) noteLimits();
}

void WorldState::attach(std::shared_ptr<const AttachedCells> cells) {
    cells_.attach(std::move(cells));
    changed_ = true;
}

bool WorldState::setDoor(uint32_t door, float open) {
    if (!cells_.setDoor(door, open)) return false;
    changed_ = true;
    return true;
}

/// Puts objects that have changed into the cells that they are in now. The hierarchy must be up to date.
void WorldState::updateCells() {
    cells_.begin();
    if (cells_.isAllNew()) {
        for (uint32_t row = 0; row < objects_.size(); ++row)
            if (lives(row)) cells_.put(row, objects_[row]);
    } else {
        for (const uint32_t row : removed_) cells_.take(row);
        for (const Moved& moved : moved_)
            if (lives(moved.row)) cells_.put(moved.row, objects_[moved.row]);
        for (uint32_t row = committed_; row < objects_.size(); ++row)
            if (lives(row)) cells_.put(row, objects_[row]);
    }
    cells_.finish(bvh_.now());
}

std::shared_ptr<const SnapshotState> WorldState::commit() {
    if (!changed_) return last_;
    if (last_) update();
    else build();
    if (cells_.attached()) updateCells();
    ++commit_;
    moved_.clear();
    removed_.clear();
    committed_ = objects_.size();
    changed_ = false;
    auto state = makeShared<SnapshotState>(memory, memory);
    state->objects = objects_.share();
    state->ids = ids_.share();
    state->occluders = occluders.share();
    state->clusters = clusters.share();
    state->lods = lods.share();
    if (gaps_ > 0) state->living = makeShared<RankedBits>(memory, living_, memory);
    state->unbounded = unbounded_;
    state->bvh = bvh_.share();
    state->placed = placed_.share();
    state->limits = limits_.share(memory);
    cells_.share(state->cell_state);
    state->count = size();
    state->common_layers = common_layers_;
    state->volumes = volumes;
    validateWorld(*state);
    last_ = state;
    return last_;
}

}  // namespace sightline::detail
