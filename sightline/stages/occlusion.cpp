// The occlusion stage: what the depth tiles hide is culled, and what is kept is drawn into them.
// SPDX-License-Identifier: MIT
#include "sightline/stages/occlusion.h"

#include <algorithm>

#include "sightline/base/assert.h"
#include "sightline/buffer/ask/occludee_box.h"
#include "sightline/stages/occluder_form.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {

bool isHiddenHere(TraversalState& state, PixelRect rect, Seams seams, const OccludeeBox* box) {
    return !state.tiles.clip(rect) || isHidden(state.tiles, rect, seams, box);
}

bool mayHideEnough(const Screen& screen, const PixelRect& rect, uint32_t cost) {
    // Chosen on the ten scenes of bench/peers: what is smaller takes more to draw than it saves.
    constexpr int64_t kPixelsOfCost = 2, kPartsOfImage = 1200;
    SIGHTLINE_DEBUG_ASSERT(rect.x0 <= rect.x1 && rect.y0 <= rect.y1);
    const int64_t area = int64_t{rect.x1 - rect.x0 + 1} * (rect.y1 - rect.y0 + 1);
    return area >= kPixelsOfCost * cost && area * kPartsOfImage >= int64_t{screen.width} * screen.height;
}

OccludeeBox boxAt(const Screen& screen, const Box3f& box) {
    return OccludeeBox(screen, {glm::dvec3(box.min), glm::dvec3(box.max)}, {.rounding = 0x1p-23});
}

TurnAnswer keepUnasked(const Frame&, TraversalState& state, const Pending& entry) {
    // Who hides it may have been learned since it was asked.
    const bool is_known = state.proofs.taught() && state.proofs.hasCertificate(entry.kind, entry.index);
    const bool still = !is_known && state.turns.mayStand(entry);
    state.stats.unasked += still;
    return {.settled = still};
}

TurnAnswer cullHidden(const Frame& frame, TraversalState& state, const Pending& entry) {
    if (!entry.testable) return {};
    // A node in doubt is opened: its children's smaller rectangles need fewer seams.
    const Seams seams = entry.kind == Pending::Kind::kNode ? Seams::kLeave : Seams::kResolve;
    const OccludeeBox box = boxAt(frame.screen, entry.box);
    return {.culled = isHiddenHere(state, entry.rect, seams, &box)};
}

OfferedOccluder occluderOf(const Frame& frame, uint32_t place) {
    SIGHTLINE_DEBUG_ASSERT(place < frame.world->placed.size());
    const PlacedObject& placed = frame.world->placed[place];
    if (placed.occluder.index == 0 || !(placed.layers & frame.view.layers)) return {};
    if (frame.mayBeCoarse(place)) return {};
    const glm::dmat4& transform = frame.world->objectAt(place).transform;
    SIGHTLINE_DEBUG_ASSERT(placed.occluder.index < frame.world->occluders.size());
    const HeldOccluder& held = *frame.world->occluders[placed.occluder.index];
    if (frame.limits.cut() && !isWhole(frame.limits, held, transform)) return {&held, true};
    // A simpler form hides in the name of all that is drawn of the object.
    return {&formFor(held, frame.screen, transform, frame.settings.occluder_error), false};
}

bool mayDraw(const Frame& frame, const TraversalState& state, const OfferedOccluder& offered,
             const OccluderInstance& instance, uint32_t cluster, const BoxAnswer& box) {
    SIGHTLINE_DEBUG_ASSERT(offered.occluder && cluster < offered.occluder->clusters.size());
    const OccluderCluster& of = offered.occluder->clusters[cluster];
    if (box.outside) return false;
    if (!state.part.whole()) {
        PixelRect rect = box.rect;
        if (box.doubt ? state.part.misses(instance.screen, of.bounds) : !state.tiles.clip(rect)) return false;
    }
    return !offered.cut || isWhole(frame.limits, *offered.occluder, of, *instance.transform);
}

bool drawCluster(const Frame& frame, TraversalState& state, const OccluderInstance& instance, uint32_t cluster,
                 const BoxAnswer& box, uint32_t& triangles) {
    SIGHTLINE_DEBUG_ASSERT(!box.outside && cluster < instance.occluder->clusters.size());
    if (!box.doubt && !mayHideEnough(frame.screen, box.rect, instance.occluder->planes.costOf(cluster))) return false;
    if (state.stats.occluder_triangles >= frame.settings.occluder_triangles) {
        state.stats.budget_spent = true;
        return false;
    }
    triangles = drawOccluder(state.tiles, instance, cluster, box);
    state.stats.occluder_triangles += triangles;
    return true;
}

}  // namespace sightline::detail
