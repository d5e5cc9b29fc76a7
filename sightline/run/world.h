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
#include "sightline/geom/occluder.h"
#include "sightline/math/box.h"

namespace sightline {

struct CellSpace;
class VisibilityFile;
class VisibleRows;

/// Ids are plain values; zero is null. A removed object's id is never given out again: its index is, with the next
/// generation.
struct ObjectId {
    uint32_t index = 0;
    uint32_t generation = 0;
    bool operator==(const ObjectId&) const = default;
};
struct OccluderId {
    uint32_t index = 0;
    bool operator==(const OccluderId&) const = default;
};
struct ClustersId {
    uint32_t index = 0;
    bool operator==(const ClustersId&) const = default;
};

/// What may shut portals of the attached cells: a door.
struct PortalId {
    uint32_t index = 0;
    bool operator==(const PortalId&) const = default;
};

/// What the stages of distance and contribution, which are not conservative, may do with an object.
struct ObjectLimits {
    bool always = false;      ///< neither of them culls it
    double max_distance = 0;  ///< its own, in place of View::max_distance; 0: the view's  [world units]
    double factor = 1;        ///< it counts as so many times as large, and is kept so many times as far by the view's
                              ///< distance. What is not a positive number counts as `always`
    bool operator==(const ObjectLimits&) const = default;
};

/// What an object is when it enters a world.
struct ObjectDef {
    Box3d bounds;               ///< object space, of everything that may be drawn: all LODs, all poses
    glm::dmat4 transform{1.0};  ///< object to world, affine
    uint64_t key = 0;           ///< yours; reported back
    OccluderId occluder;        ///< what it hides with, or null
    uint32_t layers = 1;        ///< bit mask; View::layers selects
    /// Its own triangles, for View::second_look; or null. It must hold every triangle that may be drawn of it, also those
    /// that hide nothing, in every level of detail; none that a shader moves. May be the same as `occluder`.
    OccluderId shape;
    ObjectLimits limits;  ///< for View::max_distance and View::contribution
    /// What it is drawn by, for VisibleSet::ranges; or null. They must hold every triangle that may be drawn of it, and lie
    /// within `bounds`.
    ClustersId clusters;
};

/// What a query says of an object.
struct Visible {
    uint64_t key = 0;  ///< ObjectDef::key
    ObjectId id;
};

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
    uint32_t objects = 0;              ///< room for so many from the start  [hint]
    bool volumes = false;              ///< prepare occluders for Stage::kVolumes too, which culls nothing without;
                                       ///< takes addOccluder() about as long as prepareOccluder()
    Memory* memory = defaultMemory();  ///< of the world and its snapshots. Thread-safe, if snapshots are let go by
                                       ///< other threads than the world's; outlives the world and its snapshots
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
    /// @param inner  simpler ones for it, finest first: prepareInner(). A query draws one instead where nothing of its
    ///               solids lies before the near plane, so that no eye and no cut is inside of them, and where its error
    ///               is no more than View::occluder_error
    OccluderId addOccluder(const Occluder& occluder, std::span<const InnerOccluder> inner = {});

    /// The same for ObjectDef::shape; the ids are of one kind. prepareOccluder(mesh, {}, double_sided) makes it.
    OccluderId addShape(const Occluder& shape) { return addOccluder(shape); }

    /// Copies the clusters; many objects may share them. They live as long as the world and its snapshots.
    ClustersId addClusters(const DrawClusters& clusters);

    /// Bounds that are NaN, infinite, or empty make an object that is always visible and never hides.
    ObjectId add(const ObjectDef& object);
    /// False if the id is stale.
    bool move(ObjectId id, const glm::dmat4& transform);
    bool remove(ObjectId id);

    /// Divides the world by cells, for Stage::kPvs and Stage::kPortals, from the next commit on. What was attached before
    /// gives way to it; every door is open.
    ///
    /// The walls of the cells are held to be drawn and to stand where they stood: what is behind them is culled whoever is in
    /// View::layers. Objects stand in the cells that their bounds reach into, wherever they move; one that reaches into no
    /// cell is kept by both stages.
    /// @param space  copied
    /// @param rows   what is seen from where, by CellSpace::row_of_cell; null: Stage::kPvs does nothing. Their bytes must
    ///               outlive the world and its snapshots
    /// Errors (kUsage): what is wrong with the space; nothing has changed.
    Status attach(const CellSpace& space, const VisibleRows* rows = nullptr);
    /// The same with what a visibility file holds: cells, portals, doors, rows, and the cells of objects, which they are
    /// told by their keys. An object takes them from there if it stands where it stood when they were baked (its bounds do),
    /// has not moved since it was added, and no other has its key and its bounds; all others go by their bounds.
    /// Both stages keep everything, and count it as doubt, while an object that the file calls a wall is not known to stand
    /// where it was baked, or View::layers may leave one out.
    /// @param file  hasCells(); outlives the world and its snapshots
    Status attach(const VisibilityFile& file);
    /// Takes the cells off again, from the next commit on.
    void detach();
    /// A door of the attached cells by its name; null if there is none. Of equal names the first.
    PortalId findPortal(std::string_view name) const;
    /// Opens or shuts the portals of a door, from the next commit on. Whatever draws the door is an object of its own.
    /// @param open  0: shut; 1: open; between: CellDoor::slide says what part of its portals is left
    /// @returns false if there is no such door
    bool setPortal(PortalId id, double open);

    /// The world as it is now. Costs O(changes log² objects), and a few bytes an object to share with it what has not
    /// changed; O(objects log objects) the first time, and now and then after as many changes as there are objects.
    Snapshot commit();

    uint32_t objectCount() const;

private:
    explicit World(const WorldDef& def);

    Owned<detail::WorldState> state_;
};

}  // namespace sightline
