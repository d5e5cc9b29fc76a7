// What worlds and snapshots hold: objects in shared chunks, and the hierarchy over them.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>

#include "sightline/base/memory.h"
#include "sightline/cull/volume_parts.h"
#include "sightline/geom/occluder.h"
#include "sightline/run/world.h"
#include "sightline/space/bvh.h"

namespace sightline::detail {

/// An object as a query reads it.
struct ObjectRecord {
    glm::dmat4 transform{1.0};
    Box3d bounds;  ///< object space
    uint64_t key = 0;
    ObjectId id;  ///< null: the place is free
    OccluderId occluder;
    uint32_t layers = 0;
    OccluderId shape;
    ObjectLimits limits;
};

/// Objects in chunks that snapshots share: a commit copies only the chunks that changed.
struct ObjectChunk {
    static constexpr uint32_t kSize = 256;
    ObjectRecord objects[kSize];
};

/// Objects by place; places are given in the order of World::add.
struct ObjectTable {
    Array<std::shared_ptr<ObjectChunk>> chunks;
    uint32_t size = 0;

    explicit ObjectTable(Memory* memory) : chunks(memory) {}

    const ObjectRecord& operator[](uint32_t place) const {
        return chunks[place / ObjectChunk::kSize]->objects[place % ObjectChunk::kSize];
    }
    /// For writing: makes the chunk this table's own first.
    ObjectRecord& change(uint32_t place);
    ObjectRecord& append();
    Memory* memory() const { return chunks.get_allocator().resource(); }
};

/// What a walk needs of an object that it keeps, in the hierarchy's order: neighbours in space are neighbours here.
struct PlacedObject {
    Visible visible;
    OccluderId occluder;
    uint32_t layers = 0;
    OccluderId shape;
};

struct PlacedLimits;

/// An occluder, simpler ones in its place, and what of it hides by itself.
struct HeldOccluder : Occluder {
    Array<InnerOccluder> inner;  ///< finest first
    VolumeParts parts;           ///< none unless WorldDef::volumes

    HeldOccluder(const Occluder& from, std::span<const InnerOccluder> levels, bool volumes, Memory* memory)
        : Occluder(memory), inner(memory), parts(memory) {
        Occluder::operator=(from);
        inner.reserve(levels.size());
        for (const InnerOccluder& level : levels) {
            InnerOccluder& held = inner.emplace_back(memory);
            held.occluder = level.occluder;
            held.outside = level.outside;
            held.error = level.error;
        }
        if (volumes) parts = findVolumeParts(from, memory);
    }
};

using OccluderTable = Array<std::shared_ptr<const HeldOccluder>>;  // entry 0 is null

/// An immutable state of a world. Items are the living objects in the order of World::add.
struct SnapshotState {
    ObjectTable objects;
    OccluderTable occluders;
    Array<uint32_t> items;      ///< item to place; empty if every place is its own item
    Array<uint32_t> boxed;      ///< hierarchy item to item; empty if all items have finite bounds
    Array<uint32_t> unbounded;  ///< items that are always visible
    Bvh bvh;                    ///< over the boxed items
    std::shared_ptr<const Array<PlacedObject>> placed;  ///< per place of the hierarchy; moves leave it as it is
    std::shared_ptr<const PlacedLimits> limits;         ///< of the same places; null: no object has its own
    uint32_t count = 0;                                 ///< living objects
    uint32_t common_layers = ~0u;                       ///< layers that every object is in

    explicit SnapshotState(Memory* memory)
        : objects(memory), occluders(memory), items(memory), boxed(memory), unbounded(memory), bvh(memory) {}

    uint32_t placeOf(uint32_t item) const { return items.empty() ? item : items[item]; }
    uint32_t itemOf(uint32_t hierarchy_item) const { return boxed.empty() ? hierarchy_item : boxed[hierarchy_item]; }
    const ObjectRecord& object(uint32_t item) const { return objects[placeOf(item)]; }
    const ObjectRecord& objectAt(uint32_t place) const { return object(itemOf(bvh.order[place])); }
};

/// The state of a world that holds the objects at the given places of a table, which rise and are all in use.
/// O(places log places), and a copy of the table of chunks.
std::shared_ptr<SnapshotState> buildState(const ObjectTable& objects, const OccluderTable& occluders,
                                          Array<uint32_t> places, Memory* memory);

/// The bounds in world space; not finite if they cannot be trusted.
Box3d worldBounds(const ObjectRecord& object);

}  // namespace sightline::detail
