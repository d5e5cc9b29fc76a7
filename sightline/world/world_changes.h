// A world as its user changes it, and how the next snapshot is made of the last one.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>

#include "sightline/base/array.h"
#include "sightline/world/world_cells.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

/// Notes the rows that change between two commits. commit() then brings the hierarchy up to date and shares its pages.
class WorldState {
public:
    explicit WorldState(Memory* from);

    Memory* const memory;
    bool volumes = true;  ///< WorldDef::volumes
    OccluderTable occluders{memory};
    ClusterTable clusters{memory};
    LodTable lods{memory};

    void reserve(uint32_t objects);
    ObjectId add(const ObjectDef& object);
    bool move(ObjectId id, const glm::dmat4& transform);
    bool remove(ObjectId id);
    OccluderId addOccluder(const Occluder& occluder, std::span<const InnerOccluder> inner);
    ClustersId addClusters(const DrawClusters& given);
    LodsId addLods(std::span<const LodLevel> levels);
    /// @param cells  null: none
    void attach(std::shared_ptr<const AttachedCells> cells);
    bool setDoor(uint32_t door, float open);
    const AttachedCells* attached() const { return cells_.attached(); }
    std::shared_ptr<const SnapshotState> commit();
    uint32_t size() const { return objects_.size() - gaps_; }

private:
    struct Moved {
        uint32_t row;
        bool restless;  ///< it has moved in another commit not long ago
        Box3d box;      ///< its bounds in the world now; not finite if they cannot be trusted
    };

    uint32_t find(ObjectId id) const;
    ObjectId newId();
    bool lives(uint32_t row) const { return living_[row / 64] >> row % 64 & 1; }
    void compact();
    void build();
    void sortMoved();
    void update();
    void moveAll();
    void renewMovers();
    bool enterAll();
    void noteMove(uint32_t row, ObjectRecord& object);
    void takeOut(uint32_t row);
    void putIn(uint32_t row, const Box3d& box, bool restless = false);
    void place(uint32_t first, uint32_t end);
    void placeFrom(uint32_t first);
    PlacedLimits::One limitsAt(uint32_t row) const;
    void noteLimits();
    void updateCells();

    ObjectTable objects_{memory};
    IdTable ids_{memory};
    Array<uint32_t> free_ids_{memory};  ///< indices of removed objects
    Array<uint64_t> living_{memory};    ///< a bit per row: it holds an object
    uint32_t gaps_ = 0;                 ///< rows that hold no object
    uint32_t limited_ = 0;              ///< objects with limits of their own
    uint32_t common_layers_ = ~0u;      ///< of the objects in the last snapshot and of those that have left since

    bool changed_ = true;              ///< since the last commit
    uint32_t commit_ = 1;              ///< the number of the next one
    uint32_t committed_ = 0;           ///< rows of the last commit: those behind them are new
    Array<Moved> moved_{memory};       ///< each object once
    Array<uint32_t> removed_{memory};  ///< rows

    WorldBvh bvh_{memory};
    bool movers_apart_ = false;  ///< this commit puts restless objects into trees of their own
    PlacedObjectTable placed_{memory};
    PlacedLimits limits_{memory};
    Array<uint32_t> unbounded_{memory};  ///< rows, rising
    WorldCells cells_{memory};
    Array<Box3d> boxes_{memory};  ///< scratch: what comes into the hierarchy
    Array<uint32_t> rows_{memory};
    Array<uint8_t> restless_{memory};   ///< of rows_
    Array<Box3d> stray_boxes_{memory};  ///< scratch: what has strayed in a tree of movers
    Array<uint32_t> strays_{memory};
    Array<uint64_t> places_{memory};  ///< scratch of sortMoved()
    std::shared_ptr<const SnapshotState> last_;
};

}  // namespace sightline::detail
