// Whose shadows hide an object: a certificate is sought for it alone.
// SPDX-License-Identifier: MIT
#include "sightline/query/explain/shadows.h"

#include "sightline/frame/proof_memory.h"
#include "sightline/tree/descend.h"

namespace sightline {

namespace detail {

void addOutlines(const ProofMemory& proofs, const Frame& frame, const Certificate& certificate,
                 Array<HiderOutline>& outlines, Array<glm::dvec3>& corners) {
    proofs.forEachNamed(frame, certificate, [&](const Visible& hider, uint32_t part) {
        VolumeOutline outline;
        if (!proofs.outlineOf(frame, hider.id, part, outline)) return;
        outlines.push_back({hider, static_cast<uint32_t>(corners.size()), outline.count});
        for (uint32_t i = 0; i < outline.count; ++i) corners.push_back(outline.corner[i] + frame.frustum.eye);
    });
}

}  // namespace detail

bool findShadows(const Snapshot& now, const View& view, ObjectId id, const QuerySettings& settings,
                 Array<HiderOutline>& outlines, Array<glm::dvec3>& corners, Memory* memory) {
    using namespace detail;
    outlines.clear();
    corners.clear();
    QuerySettings sought = settings;
    sought.stages = settings.stages | stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
    sought.stateless = false;
    sought.proofs = true;
    Frame frame;
    frame.begin(now, view, sought);
    ProofMemory proofs(memory);
    proofs.begin(frame);
    if (proofs.way() == ProofMemory::Way::kTiles) return false;
    const SnapshotState& world = *frame.world;
    const uint32_t place = world.placeOf(id);
    if (place == PlacedBvh::kNone) return false;
    const uint32_t slot = world.bvh.slot[world.bvh.order[place]];
    const EyeBoxes boxes = eyeBoxes(world.bvh.nodes[slot / 8], world.bvh.origin - frame.frustum.eye);
    if (!proofs.seek(frame, Pending::Kind::kObject, place, boxOf(boxes, static_cast<int>(slot % 8)), true))
        return false;
    addOutlines(proofs, frame, proofs.certificateOf(Pending::Kind::kObject, place), outlines, corners);
    return true;
}

}  // namespace sightline
