// What snapshots of a world hold, in pages that they share: objects, and the hierarchy over them.
// SPDX-License-Identifier: MIT
#pragma once

#include <memory>
#include <span>

#include "sightline/base/assert.h"
#include "sightline/base/levelled_bits.h"
#include "sightline/base/array.h"
#include "sightline/base/paged.h"
#include "sightline/base/ranked_bits.h"
#include "sightline/cells/portals.h"
#include "sightline/cull/volume_parts.h"
#include "sightline/geom/draw_clusters.h"
#include "sightline/geom/lod.h"
#include "sightline/geom/occluder.h"
#include "sightline/tree/bvh.h"
#include "sightline/tree/world_bvh.h"
#include "sightline/world/attached_cells.h"
#include "sightline/world/cell_objects.h"
#include "sightline/world/placed_limits.h"
#include "sightline/world/world_object.h"

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
    ClustersId clusters;
    LodsId lods;
    bool hides_in_lods = false;
    bool moved = false;  ///< it does not stand where it was added

    // Of WorldState alone, beside what it changes then:
    uint32_t moved_in = 0;      ///< the last commit that it moved in; 0: none
    uint32_t moved_number = 0;  ///< among those that moved then
};

/// Objects by row; rows are given in the order of World::add. Snapshots share its pages.
using ObjectTable = Paged<ObjectRecord, 4>;

/// What an ObjectId's index stands for.
struct IdSlot {
    static constexpr uint32_t kNowhere = ~0u;
    uint32_t row = kNowhere;
    uint32_t generation = 0;  ///< of the object that has the index now, or had it last
};
using IdTable = Paged<IdSlot, 256>;  // by ObjectId::index - 1

/// What a traversal reads of an object that it keeps, in the hierarchy's order: neighbours in space are neighbours
/// here.
struct PlacedObject {
    Visible visible;
    OccluderId occluder;
    uint32_t layers = 0;  ///< none: the place is empty
    OccluderId shape;
    LodsId coarser;  ///< levels in which neither `occluder` nor `shape` hold; null: they hold in all
};
inline PlacedObject placedObject(const ObjectRecord& object) {
    return {{object.key, object.id},
            object.occluder,
            object.layers,
            object.shape,
            object.hides_in_lods ? LodsId() : object.lods};
}
using PlacedObjectTable = Paged<PlacedObject, 64>;

/// An occluder, its simpler forms, and its parts for occluder volumes.
struct HeldOccluder : Occluder {
    Array<InnerOccluder> inner;  ///< finest first
    VolumeParts parts;           ///< none unless WorldDef::volumes
    Bvh faces;                   ///< over those of the parts

    HeldOccluder(const Occluder& from, std::span<const InnerOccluder> levels, bool volumes, Memory* memory);
};

using OccluderTable = Paged<std::shared_ptr<const HeldOccluder>, 64>;  // entry 0 is null

using ClusterTable = Paged<std::shared_ptr<const DrawClusters>, 64>;  // entry 0 is null

/// A chain of levels of detail, finest first.
struct HeldLods {
    Array<LodLevel> levels;
    double least_error = 0;  ///< of the levels behind the finest; infinite if there is none

    HeldLods(std::span<const LodLevel> from, Memory* memory);
};
using LodTable = Paged<std::shared_ptr<const HeldLods>, 64>;  // entry 0 is null

/// What stands where in the cells of a world.
struct CellState {
    std::shared_ptr<const AttachedCells> cells;     ///< null: the world has no cells, and all else here is empty
    std::shared_ptr<const Array<DoorState>> doors;  ///< of the cells' doors
    CellLists lists;                                ///< of rows
    PagedBits free;                                 ///< per place of the hierarchy: an object in no cell
    uint32_t free_count = 0;
    Paged<uint32_t, 256>
        claims;  ///< with view cells: per object of the file the row that stands for it, or none from kNoRow on
    CellLists strangers;      ///< with view cells: in one cell all rows in cells that stand for no object of the file
    bool has_walls = false;   ///< the file names objects that its rows and portals rest on
    bool walls_stand = true;  ///< and all of them are where they were baked

    static constexpr uint32_t kNoRow = ~0u - 1;

    explicit CellState(Memory* memory);
    ~CellState();
    CellState(CellState&&) noexcept;
    CellState& operator=(CellState&&);
};

/// An immutable state of a world. Items are the living objects in the order of World::add; the hierarchy's are rows.
struct SnapshotState {
    ObjectTable objects;
    IdTable ids;  ///< empty in a world of some of another one's objects
    OccluderTable occluders;
    ClusterTable clusters;  ///< empty in a world of some of another one's objects
    LodTable lods;
    std::shared_ptr<const RankedBits> living;  ///< rows that hold an object; null if all do
    Array<uint32_t> unbounded;                 ///< rows of objects that are always visible, rising
    PlacedBvh bvh;                             ///< over the others
    PlacedObjectTable placed;                  ///< per place of the hierarchy
    PlacedLimits limits;                       ///< of the same places; empty: no object has limits of its own
    CellState cell_state;                      ///< empty in a world of some of another one's objects
    uint32_t count = 0;                        ///< living objects
    uint32_t common_layers = ~0u;              ///< layers that every object is in
    bool volumes = true;                       ///< WorldDef::volumes

    explicit SnapshotState(Memory* memory);
    SnapshotState(const SnapshotState&) = delete;
    SnapshotState& operator=(const SnapshotState&) = delete;
    ~SnapshotState();

    uint32_t rowOf(uint32_t item) const {
        SIGHTLINE_DEBUG_ASSERT(item < count);
        return living ? living->select(item) : item;
    }
    uint32_t itemOf(uint32_t row) const {
        SIGHTLINE_DEBUG_ASSERT(row < objects.size() && objects[row].id.index != 0);
        return living ? living->rank(row) : row;
    }
    const ObjectRecord& object(uint32_t item) const { return objects[rowOf(item)]; }
    const ObjectRecord& objectAt(uint32_t place) const {
        SIGHTLINE_DEBUG_ASSERT(place < bvh.order.size() && bvh.order[place] != PlacedBvh::kNone);
        return objects[bvh.order[place]];
    }
    uint32_t itemAt(uint32_t place) const { return itemOf(bvh.order[place]); }

    /// The row of an object, or IdSlot::kNowhere.
    uint32_t find(ObjectId id) const {
        if (id.index == 0 || id.index > ids.size()) return IdSlot::kNowhere;
        const IdSlot& slot = ids[id.index - 1];
        return slot.generation == id.generation ? slot.row : IdSlot::kNowhere;
    }
    /// The place of an object in the hierarchy, or PlacedBvh::kNone: it has no bounds, or is of another snapshot.
    uint32_t placeOf(ObjectId id) const {
        const uint32_t row = find(id);
        return row == IdSlot::kNowhere ? PlacedBvh::kNone : bvh.placeOf(row);
    }
};

/// The state of a world that holds only some of a snapshot's objects, as World::commit() would make it.
/// O(items log items), and a copy of their records.
/// @param items  of `from`, in rising order
std::shared_ptr<SnapshotState> stateOfSome(const SnapshotState& from, std::span<const uint32_t> items, Memory* memory);

/// The bounds in world space; not finite if they cannot be trusted.
Box3d worldBounds(const ObjectRecord& object);

}  // namespace sightline::detail
