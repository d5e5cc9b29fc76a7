// A world of objects that change, and its snapshots, which do not.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>

#include <glm/glm.hpp>

#include "sightline/base/memory.h"
#include "sightline/base/result.h"
#include "sightline/geom/draw_clusters.h"
#include "sightline/geom/lod.h"
#include "sightline/geom/occluder.h"
#include "sightline/world/world_object.h"

namespace sightline {

struct CellSpace;
class VisibilityFile;
class VisibleRows;

namespace detail {
class WorldState;
struct SnapshotState;
}  // namespace detail

/// An immutable state of a world; cheap to copy, safe to share among threads, lives as long as any
/// copy of it does.
class Snapshot {
public:
    uint32_t objectCount() const;
    const detail::SnapshotState& state() const { return *state_; }
    explicit operator bool() const { return state_ != nullptr; }

private:
    friend class World;
    std::shared_ptr<const detail::SnapshotState> state_;
};

/// How a world is set up.
struct WorldDef {
    uint32_t objects = 0;  ///< room for so many from the start  [hint]
    bool volumes = true;   ///< prepare the parts that occluders hide by in Stage::kVolumes and in certificates
                           ///< (QuerySettings::proofs), which cull nothing otherwise; addOccluder() then takes
                           ///< about as long as prepareOccluder()
    Memory* memory = defaultMemory();  ///< of the world and its snapshots; outlives them. It must be thread-safe if
                                       ///< other threads than the world's release snapshots
};

/// The objects as they change. Not thread-safe itself; its snapshots are.
class World {
public:
    static World create(const WorldDef& def);
    World() : World(WorldDef()) {}
    ~World();
    World(World&&) noexcept;
    World& operator=(World&&) noexcept;

    /// Copies the occluder; many objects may share it. It lives as long as the world and its snapshots.
    ///
    /// @param inner  simpler occluders for it, finest first: prepareInner(). A query draws one instead if none of its
    ///               solids reaches before the near plane, so that no eye and no cut is inside of them, and if its
    ///               error is no more than QuerySettings::occluder_error
    OccluderId addOccluder(const Occluder& occluder, std::span<const InnerOccluder> inner = {});

    /// The same for ObjectDef::shape; the ids are of one kind. prepareOccluder(mesh, {}, double_sided) makes it.
    OccluderId addShape(const Occluder& shape) { return addOccluder(shape); }

    /// Copies the clusters; many objects may share them. They live as long as the world and its snapshots.
    ClustersId addClusters(const DrawClusters& clusters);

    /// Copies a chain of levels of detail; many objects may share it. It lives as long as the world and its snapshots.
    /// @param levels  finest first, errors rising  [size: <= kMostLods; of more the coarsest are left out]
    LodsId addLods(std::span<const LodLevel> levels);

    /// Bounds that are NaN, infinite, or empty make an object that is always visible and never hides.
    ObjectId add(const ObjectDef& object);
    /// False if the id is stale.
    bool move(ObjectId id, const glm::dmat4& transform);
    bool remove(ObjectId id);

    /// Divides the world by cells, for Stage::kPvs and Stage::kPortals, from the next commit on. The cells replace
    /// those that were attached before, and every door is open.
    ///
    /// The world takes it for granted that the walls between cells are drawn and have not moved, whatever View::layers
    /// says: what they hide is culled. An object stands in the cells that its bounds reach into, wherever it moves.
    /// Both stages keep an object that reaches into no cell.
    /// @param space  copied
    /// @param rows   the rows of visibility that CellSpace::row_of_cell leads to; null: Stage::kPvs does nothing. Their
    ///               bytes must outlive the world and its snapshots
    /// Errors (kUsage): what is wrong with the space; nothing has changed.
    Status attach(const CellSpace& space, const VisibleRows* rows = nullptr);
    /// The same with what a visibility file holds: cells, portals, doors, rows, and the cells of objects by their keys.
    /// An object takes its cells from the file if its bounds are those that were baked, it has not moved since it was
    /// added, and no other object has its key and its bounds. The cells of all other objects are found by their bounds.
    /// Both stages keep everything, and count it as doubt, while some object that the file calls a wall is not where it
    /// was baked, or while View::layers may leave out a wall.
    /// @param file  hasCells(); outlives the world and its snapshots
    Status attach(const VisibilityFile& file);
    /// Removes the cells, from the next commit on.
    void detach();
    /// A door of the attached cells by its name; null if there is none. Of equal names the first.
    PortalId findPortal(std::string_view name) const;
    /// Opens or shuts the portals of a door, from the next commit on. Whatever draws the door is an object of its own.
    /// @param open  0: shut; 1: open; between: CellDoor::slide says what part of its portals is left
    /// @returns false if there is no such door
    bool setPortal(PortalId id, double open);

    /// The world as it is now. Costs O(changes log² objects), and a few bytes an object to share the pages that have
    /// not changed; O(objects log objects) the first time, and again after about as many changes as there are objects.
    Snapshot commit();

    uint32_t objectCount() const;

private:
    explicit World(const WorldDef& def);

    Owned<detail::WorldState> state_;
};

}  // namespace sightline
