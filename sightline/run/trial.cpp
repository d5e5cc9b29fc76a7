// What becomes of one object in a world of some of a snapshot's objects: the world is built, and looked at.
// SPDX-License-Identifier: MIT
#include "sightline/run/trial.h"

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
        case Stage::kDistance:
            return Verdict::kTooFar;
        case Stage::kContribution:
            return Verdict::kTooSmall;
        case Stage::kVolumes:
        case Stage::kOcclusion:
        case Stage::kClusters:
            break;
    }
    return Verdict::kOccluded;
}

}  // namespace

uint32_t hierarchyPlace(const SnapshotState& state, uint32_t item) {
    static_assert(WalkRecord::kNowhere == PlacedBvh::kNone);
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

Verdict Trial::run(const SnapshotState& state, const View& view, uint32_t item) {
    record.stop_at = hierarchyPlace(state, item);
    const uint32_t bins = record.stop_at == WalkRecord::kNowhere ? 1 : binCount(view);
    if (bins == 1) return runBin(state, view, {});
    const uint32_t columns = makeScreen(view, view.occlusion_size).width / 8;
    for (uint32_t bin = 0; bin < bins; ++bin) {
        runBin(state, view, binOf(bin, bins, columns));
        for (const KeptObject& object : walk.kept)
            if (object.place == record.stop_at) return Verdict::kVisible;
    }
    // The walk of the whole has all that hides it. Where it keeps the object, a bin's reason stands.
    const WalkRecord::Cull of_a_bin = cull;
    const Verdict verdict = runBin(state, view, {});
    if (verdict != Verdict::kVisible) return verdict;
    cull = of_a_bin;
    return Verdict::kOccluded;
}

Verdict Trial::runBin(const SnapshotState& state, const View& view, const Bin& bin) {
    record.clear();  // a walk for a view that is not usable notes nothing
    walk.run(&state, view, bin);
    for (const WalkRecord::Cull& candidate : record.culls) {
        if (!record.stopsAt(candidate.places)) continue;
        cull = candidate;
        return verdictOf(cull.stage);
    }
    return Verdict::kVisible;
}

}  // namespace sightline::detail
