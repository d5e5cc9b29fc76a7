// A world of objects that change, and its snapshots, which do not.
// SPDX-License-Identifier: MIT
#include "sightline/run/world.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/run/size_stages.h"
#include "sightline/run/world_state.h"

namespace sightline {
namespace detail {

ObjectRecord& ObjectTable::change(uint32_t place) {
    std::shared_ptr<ObjectChunk>& chunk = chunks[place / ObjectChunk::kSize];
    if (chunk.use_count() > 1) chunk = makeShared<ObjectChunk>(memory(), *chunk);
    return chunk->objects[place % ObjectChunk::kSize];
}

ObjectRecord& ObjectTable::append() {
    if (size % ObjectChunk::kSize == 0) chunks.push_back(makeShared<ObjectChunk>(memory()));
    return change(size++);
}

Box3d worldBounds(const ObjectRecord& object) {
    constexpr double kLargest = 1e30;  // [world units]: float must hold it with room for sums
    Box3d box;
    if (!object.bounds.finite() || object.bounds.empty()) return box;
    box = transformBox(object.bounds, object.transform);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(box.min[axis]) < kLargest && std::abs(box.max[axis]) < kLargest)) return Box3d();
    return box;
}

std::shared_ptr<const Array<PlacedObject>> placeObjects(const SnapshotState& state, Memory* memory) {
    auto placed = makeShared<Array<PlacedObject>>(memory);
    placed->reserve(state.bvh.order.size());
    for (uint32_t place = 0; place < state.bvh.order.size(); ++place) {
        const ObjectRecord& object = state.objectAt(place);
        placed->push_back({{object.key, object.id}, object.occluder, object.layers, object.shape});
    }
    return placed;
}

std::shared_ptr<SnapshotState> buildState(const ObjectTable& objects, const OccluderTable& occluders,
                                          Array<uint32_t> places, Memory* memory) {
    auto state = makeShared<SnapshotState>(memory, memory);
    state->objects = objects;
    state->occluders = occluders;
    state->count = static_cast<uint32_t>(places.size());
    Array<Box3d> boxes(memory);
    Array<uint32_t> boxed(memory);
    boxes.reserve(places.size());
    for (uint32_t item = 0; item < places.size(); ++item) {
        const ObjectRecord& object = objects[places[item]];
        state->common_layers &= object.layers;
        const Box3d box = worldBounds(object);
        if (box.finite()) {
            boxes.push_back(box);
            boxed.push_back(item);
        } else {
            state->unbounded.push_back(item);
        }
    }
    if (places.size() != objects.size) state->items = std::move(places);
    if (!state->unbounded.empty()) state->boxed = std::move(boxed);
    state->bvh = buildBvh(boxes, memory);
    state->placed = placeObjects(*state, memory);
    state->limits = placeLimits(*state, memory);
    return state;
}

/// What an ObjectId's index stands for.
struct IdSlot {
    static constexpr uint32_t kNowhere = ~0u;
    uint32_t place = kNowhere;
    uint32_t generation = 0;  ///< of the object that has the index now, or had it last
};

/// The world as its user changes it.
struct WorldState {
    Memory* const memory;
    ObjectTable objects{memory};
    OccluderTable occluders{memory};
    Array<IdSlot> ids{memory};         ///< per ObjectId::index - 1
    Array<uint32_t> free_ids{memory};  ///< indices of removed objects
    uint32_t living = 0;
    bool volumes = false;           ///< WorldDef::volumes
    bool rebuild = true;            ///< objects came, went, or changed between bounded and unbounded
    Array<uint32_t> moved{memory};  ///< places
    std::shared_ptr<const SnapshotState> last;

    explicit WorldState(Memory* from) : memory(from) { occluders.push_back(nullptr); }

    ObjectRecord* find(ObjectId id) {
        if (id.index == 0 || id.index > ids.size()) return nullptr;
        const IdSlot& slot = ids[id.index - 1];
        if (slot.generation != id.generation || slot.place == IdSlot::kNowhere) return nullptr;
        return &objects.change(slot.place);
    }

    /// An id for the object that is appended next.
    ObjectId newId() {
        if (free_ids.empty()) {
            ids.emplace_back();
            free_ids.push_back(static_cast<uint32_t>(ids.size()));
        }
        const uint32_t index = free_ids.back();
        free_ids.pop_back();
        IdSlot& slot = ids[index - 1];
        slot.place = objects.size;
        return {index, ++slot.generation};
    }

    std::shared_ptr<SnapshotState> build();
    std::shared_ptr<SnapshotState> refitted();
    void compact();
};

/// Closes the gaps that removed objects left, once they are as many as the living.
void WorldState::compact() {
    if (objects.size < 2 * living + 1024) return;
    ObjectTable packed(memory);
    for (uint32_t place = 0; place < objects.size; ++place) {
        if (objects[place].id.index == 0) continue;
        ids[objects[place].id.index - 1].place = packed.size;
        packed.append() = objects[place];
    }
    objects = std::move(packed);
}

std::shared_ptr<SnapshotState> WorldState::build() {
    compact();
    Array<uint32_t> places(memory);
    places.reserve(living);
    for (uint32_t place = 0; place < objects.size; ++place)
        if (objects[place].id.index != 0) places.push_back(place);
    return buildState(objects, occluders, std::move(places), memory);
}

/// The last snapshot with moved objects refitted; null if building anew is better.
std::shared_ptr<SnapshotState> WorldState::refitted() {
    if (!last->unbounded.empty() || !last->items.empty() || moved.size() > living / 4 + 16) return nullptr;
    auto state = makeShared<SnapshotState>(memory, memory);
    *state = *last;
    state->objects = objects;
    for (uint32_t place : moved) {
        const Box3d box = worldBounds(objects[place]);
        if (!box.finite()) return nullptr;
        // Float bounds far from the hierarchy's origin are coarse: a world that wanders off is built anew.
        refit(state->bvh, place, box);
    }
    constexpr double kWorthRebuilding = 1.5;
    return surfaceCost(state->bvh) <= kWorthRebuilding * state->bvh.built_cost ? state : nullptr;
}

}  // namespace detail

World::World(const WorldDef& def) : state_(makeOwned<detail::WorldState>(def.memory, def.memory)) {
    state_->objects.chunks.reserve(def.objects / detail::ObjectChunk::kSize + 1);
    state_->ids.reserve(def.objects);
    state_->volumes = def.volumes;
}
World World::create(const WorldDef& def) { return World(def); }
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

uint32_t Snapshot::objectCount() const { return state_ ? state_->count : 0; }

OccluderId World::addOccluder(const Occluder& occluder, std::span<const InnerOccluder> inner) {
    state_->occluders.push_back(
        makeShared<detail::HeldOccluder>(state_->memory, occluder, inner, state_->volumes, state_->memory));
    state_->rebuild = true;
    return {static_cast<uint32_t>(state_->occluders.size() - 1)};
}

ObjectId World::add(const ObjectDef& object) {
    SIGHTLINE_ASSERT(object.occluder.index < state_->occluders.size());
    SIGHTLINE_ASSERT(object.shape.index < state_->occluders.size());
    const ObjectId id = state_->newId();
    state_->objects.append() = {object.transform, object.bounds, object.key,   id,
                                object.occluder,  object.layers, object.shape, object.limits};
    ++state_->living;
    state_->rebuild = true;
    return id;
}

bool World::move(ObjectId id, const glm::dmat4& transform) {
    detail::ObjectRecord* object = state_->find(id);
    if (!object) return false;
    object->transform = transform;
    state_->moved.push_back(state_->ids[id.index - 1].place);
    return true;
}

bool World::remove(ObjectId id) {
    detail::ObjectRecord* object = state_->find(id);
    if (!object) return false;
    *object = {};
    state_->ids[id.index - 1].place = detail::IdSlot::kNowhere;
    state_->free_ids.push_back(id.index);
    --state_->living;
    state_->rebuild = true;
    return true;
}

Snapshot World::commit() {
    if (state_->rebuild || !state_->last) {
        state_->last = state_->build();
    } else if (!state_->moved.empty()) {
        std::shared_ptr<detail::SnapshotState> next = state_->refitted();
        state_->last = next ? next : state_->build();
    }
    state_->rebuild = false;
    state_->moved.clear();
    Snapshot snapshot;
    snapshot.state_ = state_->last;
    return snapshot;
}

uint32_t World::objectCount() const { return state_->living; }

}  // namespace sightline
