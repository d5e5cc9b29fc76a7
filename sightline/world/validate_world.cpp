// Whether a snapshot's tables, hierarchy and cells agree: in debug builds, after each commit.
// SPDX-License-Identifier: MIT
#include "sightline/world/validate_world.h"

#ifdef SIGHTLINE_DEBUG_ASSERTS

#include <bit>

#include "sightline/base/assert.h"

namespace sightline::detail {
namespace {

bool livesAt(const SnapshotState& state, uint32_t row) {
    return row < state.objects.size() && (!state.living || state.living->has(row));
}

void validateObjects(const SnapshotState& state) {
    uint32_t living = 0;
    for (uint32_t row = 0; row < state.objects.size(); ++row) {
        const ObjectRecord& object = state.objects[row];
        SIGHTLINE_DEBUG_ASSERT((object.id.index != 0) == livesAt(state, row));
        if (object.id.index == 0) continue;
        ++living;
        SIGHTLINE_DEBUG_ASSERT((state.common_layers & ~object.layers) == 0);
        SIGHTLINE_DEBUG_ASSERT(object.occluder.index < state.occluders.size());
        SIGHTLINE_DEBUG_ASSERT(object.shape.index < state.occluders.size());
        SIGHTLINE_DEBUG_ASSERT(object.lods.index < state.lods.size());
        SIGHTLINE_DEBUG_ASSERT(state.clusters.empty() || object.clusters.index < state.clusters.size());
        SIGHTLINE_DEBUG_ASSERT(state.ids.empty() || state.find(object.id) == row);
    }
    SIGHTLINE_DEBUG_ASSERT(living == state.count);
    for (uint32_t i = 0; i < state.ids.size(); ++i) {
        const IdSlot& slot = state.ids[i];
        if (slot.row != IdSlot::kNowhere) {
            SIGHTLINE_DEBUG_ASSERT(livesAt(state, slot.row) && state.objects[slot.row].id.index == i + 1);
        }
    }
    for (size_t i = 0; i < state.unbounded.size(); ++i) {
        const uint32_t row = state.unbounded[i];
        SIGHTLINE_DEBUG_ASSERT(livesAt(state, row) && (i == 0 || state.unbounded[i - 1] < row));
        SIGHTLINE_DEBUG_ASSERT(state.bvh.placeOf(row) == PlacedBvh::kNone);
    }
}

void validatePlaces(const SnapshotState& state) {
    const PlacedBvh& bvh = state.bvh;
    SIGHTLINE_DEBUG_ASSERT(state.placed.size() == bvh.order.size());
    SIGHTLINE_DEBUG_ASSERT(state.count == state.unbounded.size() + bvh.size());
    uint32_t used = 0;
    for (uint32_t place = 0; place < bvh.order.size(); ++place) {
        const PlacedObject& placed = state.placed[place];
        const uint32_t row = bvh.order[place];
        if (row == PlacedBvh::kNone) {
            SIGHTLINE_DEBUG_ASSERT(placed.layers == 0 && placed.visible.id == ObjectId());
            continue;
        }
        ++used;
        SIGHTLINE_DEBUG_ASSERT(livesAt(state, row) && bvh.placeOf(row) == place);
        const PlacedObject is = placedObject(state.objects[row]);
        SIGHTLINE_DEBUG_ASSERT(placed.visible.key == is.visible.key && placed.visible.id == is.visible.id);
        SIGHTLINE_DEBUG_ASSERT(placed.occluder == is.occluder && placed.shape == is.shape);
        SIGHTLINE_DEBUG_ASSERT(placed.layers == is.layers && placed.coarser == is.coarser);
    }
    SIGHTLINE_DEBUG_ASSERT(used == bvh.size());
    if (state.limits.empty()) return;
    SIGHTLINE_DEBUG_ASSERT(state.limits.objects.size() == bvh.order.size());
    SIGHTLINE_DEBUG_ASSERT(state.limits.nodes.size() == bvh.nodes.size());
}

bool areSame(const Box3f& a, const Box3f& b) { return a.min == b.min && a.max == b.max; }

/// @returns how many items are below a node
uint32_t validateNode(const SnapshotState& state, uint32_t index) {
    const PlacedBvh& bvh = state.bvh;
    SIGHTLINE_DEBUG_ASSERT(index < bvh.nodes.size());
    const BvhNode& node = bvh.nodes[index];
    uint32_t all = 0;
    for (int slot = 0; slot < 8; ++slot) {
        const uint32_t child = node.child[slot], first = node.first[slot], count = node.count[slot];
        const Box3f box = slotBox(node, slot);
        if (count == 0) {
            SIGHTLINE_DEBUG_ASSERT(child == kUnusedChild && box.empty() && node.empty[slot] == 0);
            continue;
        }
        SIGHTLINE_DEBUG_ASSERT(first < bvh.order.size() && count <= bvh.order.size() - first);
        SIGHTLINE_DEBUG_ASSERT(node.empty[slot] < count && !box.empty());
        if (child & BvhNode::kLeaf) {
            SIGHTLINE_DEBUG_ASSERT(count == 1 && child == (BvhNode::kLeaf | first));
            const uint32_t row = bvh.order[first];
            SIGHTLINE_DEBUG_ASSERT(row != PlacedBvh::kNone && bvh.slot[row] == 8 * index + static_cast<uint32_t>(slot));
            SIGHTLINE_DEBUG_ASSERT(areSame(box, roundOutward(worldBounds(state.objects[row]), bvh.origin)));
            ++all;
            continue;
        }
        const uint32_t below = validateNode(state, child);
        SIGHTLINE_DEBUG_ASSERT(below == count - node.empty[slot]);
        const BvhNode& inner = bvh.nodes[child];
        SIGHTLINE_DEBUG_ASSERT(areSame(box, boundsOf(inner)));
        for (int i = 0; i < 8; ++i)
            if (inner.count[i] > 0) {
                SIGHTLINE_DEBUG_ASSERT(inner.first[i] >= first && inner.first[i] + inner.count[i] <= first + count);
            }
        all += below;
    }
    return all;
}

void validateLists(const SnapshotState& state, const CellLists& lists, uint32_t cells) {
    SIGHTLINE_DEBUG_ASSERT(lists.first.size() == cells && lists.count.size() == cells);
    uint64_t stands = 0;
    for (uint32_t cell = 0; cell < cells; ++cell) {
        uint32_t count = 0;
        for (uint32_t at = lists.first[cell]; at != CellBlock::kNone; at = lists.blocks[at].next) {
            SIGHTLINE_DEBUG_ASSERT(at < lists.blocks.size());
            const CellBlock& block = lists.blocks[at];
            SIGHTLINE_DEBUG_ASSERT(block.used == 8 || (block.used > 0 && at == lists.first[cell]));
            for (uint32_t lane = 0; lane < block.used; ++lane)
                SIGHTLINE_DEBUG_ASSERT(livesAt(state, block.row[lane]) &&
                                       state.bvh.placeOf(block.row[lane]) != PlacedBvh::kNone);
            count += block.used;
        }
        SIGHTLINE_DEBUG_ASSERT(count == lists.count[cell]);
        stands += count;
    }
    SIGHTLINE_DEBUG_ASSERT(stands == lists.stands);
}

void validateCells(const SnapshotState& state) {
    const CellState& cells = state.cell_state;
    if (!cells.cells) {
        SIGHTLINE_DEBUG_ASSERT(cells.lists.first.empty() && cells.free_count == 0 && !cells.doors);
        return;
    }
    SIGHTLINE_DEBUG_ASSERT(cells.doors && cells.doors->size() == cells.cells->graph.doors());
    validateLists(state, cells.lists, cells.cells->graph.cells());
    uint32_t free = 0;
    cells.free.forEachWord(0, state.bvh.order.size(), [&](uint32_t word, uint64_t bits) {
        for (; bits; bits &= bits - 1, ++free) {
            const uint32_t place = 64 * word + static_cast<uint32_t>(std::countr_zero(bits));
            SIGHTLINE_DEBUG_ASSERT(state.bvh.order[place] != PlacedBvh::kNone);
        }
    });
    SIGHTLINE_DEBUG_ASSERT(free == cells.free_count);
    if (!cells.cells->views) return;
    validateLists(state, cells.strangers, 1);
    SIGHTLINE_DEBUG_ASSERT(cells.claims.size() == cells.cells->objects.size());
    for (uint32_t i = 0; i < cells.claims.size(); ++i)
        SIGHTLINE_DEBUG_ASSERT(cells.claims[i] >= CellState::kNoRow || livesAt(state, cells.claims[i]));
}

}  // namespace

void validateWorld(const SnapshotState& state) {
    validateObjects(state);
    validatePlaces(state);
    if (!state.bvh.nodes.empty()) {
        const uint32_t items = validateNode(state, 0);
        SIGHTLINE_DEBUG_ASSERT(items == state.bvh.size());
    }
    validateCells(state);
}

}  // namespace sightline::detail

#endif
