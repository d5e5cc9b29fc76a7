// What snapshots of a world hold, in pages that they share: objects, and the hierarchy over them.
// SPDX-License-Identifier: MIT
#include "sightline/world/world_state.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/geom/make_plane_mesh.h"

namespace sightline::detail {

HeldOccluder::HeldOccluder(const Occluder& from, std::span<const InnerOccluder> levels, bool volumes, Memory* memory)
    : Occluder(memory), inner(memory), parts(memory), faces(memory) {
    Occluder::operator=(from);
    if (planes.first_part.empty()) makePlaneMesh(*this);
    inner.reserve(levels.size());
    for (const InnerOccluder& level : levels) {
        InnerOccluder& held = inner.emplace_back(memory);
        held.occluder = level.occluder;
        held.outside = level.outside;
        held.error = level.error;
    }
    if (!volumes) return;
    parts = findVolumeParts(from, memory);
    Array<Box3d> boxes(parts.faces.size(), Box3d(), memory);
    for (size_t i = 0; i < boxes.size(); ++i)
        for (uint32_t k = 0; k < parts.faces[i].count; ++k)
            boxes[i].grow(parts.corners[parts.outline[parts.faces[i].first + k]]);
    if (!boxes.empty()) faces = buildBvh(boxes, memory);
}

HeldLods::HeldLods(std::span<const LodLevel> from, Memory* memory)
    : levels(memory), least_error(std::numeric_limits<double>::infinity()) {
    from = from.first(std::min<size_t>(from.size(), kMostLods));
    levels.assign(from.begin(), from.end());
    for (size_t i = 1; i < levels.size(); ++i)
        if (levels[i].error < least_error) least_error = levels[i].error;
}

CellState::CellState(Memory* memory) : lists(memory), free(memory), claims(memory), strangers(memory) {}
CellState::~CellState() = default;
CellState::CellState(CellState&&) noexcept = default;
CellState& CellState::operator=(CellState&&) = default;

SnapshotState::SnapshotState(Memory* memory)
    : objects(memory),
      ids(memory),
      occluders(memory),
      clusters(memory),
      lods(memory),
      unbounded(memory),
      bvh(memory),
      placed(memory),
      limits(memory),
      cell_state(memory) {}
SnapshotState::~SnapshotState() = default;

Box3d worldBounds(const ObjectRecord& object) {
    constexpr double kLargest = 1e30;  // [world units]: float must hold it with room for sums
    Box3d box;
    if (!object.bounds.finite() || object.bounds.empty()) return box;
    box = transformBox(object.bounds, object.transform);
    for (int axis = 0; axis < 3; ++axis)
        if (!(std::abs(box.min[axis]) < kLargest && std::abs(box.max[axis]) < kLargest)) return Box3d();
    return box;
}

std::shared_ptr<SnapshotState> stateOfSome(const SnapshotState& from, std::span<const uint32_t> items, Memory* memory) {
    auto state = makeShared<SnapshotState>(memory, memory);
    state->volumes = from.volumes;
    ObjectTable objects(memory);
    Array<Box3d> boxes(memory);
    Array<uint32_t> rows(memory);
    for (size_t i = 0; i < items.size(); ++i)
        SIGHTLINE_DEBUG_ASSERT(items[i] < from.count && (i == 0 || items[i - 1] < items[i]));
    for (const uint32_t item : items) {
        const uint32_t row = objects.size();
        objects.push_back(from.object(item));
        state->common_layers &= objects.back().layers;
        const Box3d box = worldBounds(objects.back());
        if (box.finite()) {
            boxes.push_back(box);
            rows.push_back(row);
        } else {
            state->unbounded.push_back(row);
        }
    }
    WorldBvh bvh(memory);
    bvh.build(boxes, rows);
    PlacedObjectTable placed(memory);
    PlacedLimits limits(memory);
    const bool limited = !from.limits.empty();
    for (uint32_t place = 0; place < bvh.now().order.size(); ++place) {
        const uint32_t row = bvh.now().order[place];
        const bool empty = row == PlacedBvh::kNone;
        placed.push_back(empty ? PlacedObject() : placedObject(objects[row]));
        if (limited) limits.objects.push_back(empty ? PlacedLimits::One() : placedLimits(objects[row].limits));
    }
    if (limited) noteLimitsBelow(bvh.now(), limits);
    state->count = objects.size();
    state->objects = objects.share();
    state->occluders = from.occluders.copy();
    state->lods = from.lods.copy();
    state->bvh = bvh.share();
    state->placed = placed.share();
    state->limits = limits.share(memory);
    return state;
}

}  // namespace sightline::detail
