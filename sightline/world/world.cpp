// A world of objects that change, and its snapshots, which do not.
// SPDX-License-Identifier: MIT
#include "sightline/world/world.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "sightline/world/world_changes.h"

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

LodsId World::addLods(std::span<const LodLevel> levels) { return state_->addLods(levels); }

ObjectId World::add(const ObjectDef& object) { return state_->add(object); }
bool World::move(ObjectId id, const glm::dmat4& transform) { return state_->move(id, transform); }
bool World::remove(ObjectId id) { return state_->remove(id); }

Status World::attach(const CellSpace& space, const VisibleRows* rows) {
    if (Status status = detail::checkSpace(space, rows); !status) return status;
    state_->attach(makeShared<detail::AttachedCells>(state_->memory, space, rows, state_->memory));
    return success();
}

Status World::attach(const VisibilityFile& file) {
    if (!file.hasCells()) return Error{Error::Kind::kUsage, "the visibility file has no cells"};
    const CellSpace space = file.cellSpace();
    if (Status status = detail::checkSpace(space, &file.rows()); !status) return status;
    auto cells = makeShared<detail::AttachedCells>(state_->memory, space, &file.rows(), state_->memory);
    if (file.hasObjects()) cells->objects = file.objects();
    if (file.hasViewCells()) cells->views.emplace(file, state_->memory);
    state_->attach(std::move(cells));
    return success();
}

void World::detach() { state_->attach(nullptr); }

PortalId World::findPortal(std::string_view name) const {
    const detail::AttachedCells* cells = state_->attached();
    for (size_t i = 0; cells && i < cells->doors.size(); ++i)
        if (std::string_view(cells->doors[i].data(), cells->doors[i].size()) == name)
            return {static_cast<uint32_t>(i + 1)};
    return {};
}

bool World::setPortal(PortalId id, double open) {
    if (id.index == 0) return false;
    // Rounded up; a door whose share is not a number is open: in doubt more is visible.
    float part = std::isnan(open) ? 1.0f : static_cast<float>(std::clamp(open, 0.0, 1.0));
    if (static_cast<double>(part) < open && part < 1.0f) part = std::nextafter(part, 1.0f);
    return state_->setDoor(id.index - 1, part);
}

Snapshot World::commit() {
    Snapshot snapshot;
    snapshot.state_ = state_->commit();
    return snapshot;
}

uint32_t World::objectCount() const { return state_->size(); }

}  // namespace sightline
