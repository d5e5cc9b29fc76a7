// What becomes of one object in a world of some of a snapshot's objects: the world is built, and looked at.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/trial.h"

namespace sightline::detail {
namespace {

Verdict verdictOf(Stage stage) {
    switch (stage) {
        case Stage::kPvs:
            return Verdict::kNotInPvs;
        case Stage::kPortals:
            return Verdict::kNoWindow;
        case Stage::kFrustum:
            return Verdict::kOutsideFrustum;
        case Stage::kFacing:
            return Verdict::kFacesAway;
        case Stage::kDistance:
            return Verdict::kTooFar;
        case Stage::kContribution:
            return Verdict::kTooSmall;
        default:
            return Verdict::kOccluded;
    }
}

}  // namespace

uint32_t hierarchyPlace(const SnapshotState& state, uint32_t item) {
    static_assert(TraversalRecord::kNowhere == PlacedBvh::kNone);
    return state.bvh.placeOf(state.rowOf(item));
}

LeafAnswer askLeaf(const SnapshotState& state, uint32_t place, const View& view, const Screen& screen) {
    const uint32_t slot = state.bvh.slot[state.bvh.order[place]];
    LeafAnswer answer;
    answer.boxes = eyeBoxes(state.bvh.nodes[slot / 8], state.bvh.origin - screen.eye);
    answer.slot = static_cast<int>(slot % 8);
    answer.on_screen = projectBoxes(screen, answer.boxes);
    const Frustum frustum = makeFrustum(view);
    const ViewVolume limits = makeViewLimits(view, frustum.eye).volume;
    const uint32_t outside = testFrustum(frustum, answer.boxes, (1u << frustum.count) - 1).outside |
                             testViewVolume(limits, answer.boxes, limits.allPlanes()).outside;
    answer.beyond_plane = outside >> answer.slot & 1;
    return answer;
}

Verdict Trial::run(const SnapshotState& world, const View& view, const QuerySettings& settings, uint32_t item) {
    record.stop_at = hierarchyPlace(world, item);
    frame.begin(&world, view, settings, shown);
    frame.narrowTo(candidates);
    const uint32_t parts = record.stop_at == TraversalRecord::kNowhere ? 1 : partCount(frame);
    if (parts == 1) return runPart(world, view, settings, {});
    const uint32_t columns = frame.columns();
    for (uint32_t part = 0; part < parts; ++part) {
        runPart(world, view, settings, imagePart(part, parts, columns));
        for (const KeptPlace& object : state.kept)
            if (object.place == record.stop_at) return Verdict::kVisible;
    }
    // The traversal of the whole image has every hider. If it keeps the object, a strip's reason stands.
    const TraversalRecord::Cull of_a_strip = cull;
    const Verdict verdict = runPart(world, view, settings, {});
    if (verdict != Verdict::kVisible) return verdict;
    cull = of_a_strip;
    return Verdict::kOccluded;
}

Verdict Trial::runPart(const SnapshotState& world, const View& view, const QuerySettings& settings,
                       const ImagePart& part) {
    RecordedTraversal::run(world, view, settings, candidates, shown, part);
    for (const TraversalRecord::Cull& candidate : record.culls) {
        if (!candidate.places.holds(record.stop_at)) continue;
        cull = candidate;
        return verdictOf(cull.stage);
    }
    return Verdict::kVisible;
}

}  // namespace sightline::detail
