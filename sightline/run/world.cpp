// A world of objects that change, and its snapshots, which do not.
// SPDX-License-Identifier: MIT
#include "sightline/run/world.h"

#include "sightline/run/world_changes.h"

namespace sightline {
World::World(const WorldDef& def) : state_(makeOwned<detail::WorldState>(def.memory, def.memory)) {
    state_->reserve(def.objects);
    state_->volumes = def.volumes;
}
World World::create(const WorldDef& def) { return World(def); }
World::~World() = default;
World::World(World&&) noexcept = default;
World& World::operator=(World&&) noexcept = default;

uint32_t Snapshot::objectCount() const { return state_ ? state_->count : 0; }

OccluderId World::addOccluder(const Occluder& occluder, std::span<const InnerOccluder> inner) {
    return state_->addOccluder(occluder, inner);
}

ClustersId World::addClusters(const DrawClusters& clusters) { return state_->addClusters(clusters); }

ObjectId World::add(const ObjectDef& object) { return state_->add(object); }
bool World::move(ObjectId id, const glm::dmat4& transform) { return state_->move(id, transform); }
bool World::remove(ObjectId id) { return state_->remove(id); }

Snapshot World::commit() {
    Snapshot snapshot;
    snapshot.state_ = state_->commit();
    return snapshot;
}

uint32_t World::objectCount() const { return state_->size(); }

}  // namespace sightline
