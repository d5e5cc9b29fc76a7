// Culling by certificates: what hid something before is held against it first, where it stands now.
// SPDX-License-Identifier: MIT
#include "sightline/frame/proof_memory.h"

#include <algorithm>
#include <cmath>

#include "sightline/stages/occluder_form.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {
namespace {

constexpr uint32_t kMostPolygons = 48;  // of an object that are looked at one by one

double sum(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

Box3d doubled(const Box3f& box) { return {glm::dvec3(box.min), glm::dvec3(box.max)}; }

/// Whether the eye is surely behind a polygon.
/// @param corner  relative to the eye, each off by `error` at most
bool facesAway(const OccluderPolygon& polygon, const glm::dvec3 (&corner)[4], double flips, double error) {
    for (int k = 2; k < polygon.corners(); ++k) {
        const glm::dvec3 a = corner[k - 1] - corner[0], b = corner[k] - corner[0];
        // Positive: the eye is in front. A volume of three edges, each off by twice the error, summed from six products.
        const double height = -flips * glm::dot(glm::cross(a, b), corner[0]);
        const double u = sum(a), v = sum(b), w = sum(corner[0]);
        const double slack =
            4.0 * error * (u * v + v * w + w * u + 4.0 * error * (u + v + w + error)) + 0x1p-48 * u * v * w;
        if (!(height < -slack)) return false;
    }
    return true;
}

}  // namespace

void ProofMemory::clear() {
    of_node_.clear();
    of_place_.clear();
    certificates_.clear();
    free_.clear();
    hiders_.clear();
    number_.clear();
    std::fill(last_, last_ + kLast, kNone);
    latest_ = {};
}

bool ProofMemory::hasCertificate(Pending::Kind kind, uint32_t index) const {
    const Array<uint32_t>& of = numbers(kind);
    return index < of.size() && of[index] != 0 && !(of[index] & kFailed);
}

Certificate ProofMemory::certificateOf(Pending::Kind kind, uint32_t index) const {
    return hasCertificate(kind, index) ? certificates_[numbers(kind)[index] - 1] : Certificate();
}

void ProofMemory::forget(Pending::Kind kind, uint32_t index) {
    if (!hasCertificate(kind, index)) return;
    Array<uint32_t>& of = numbers(kind);
    free_.push_back(of[index] - 1);
    of[index] = 0;
}

void ProofMemory::makeRoom(const Frame& frame, Pending::Kind kind, uint32_t index) {
    Array<uint32_t>& of = numbers(kind);
    if (index >= of.size())
        of.resize(kind == Pending::Kind::kNode ? frame.world->bvh.nodes.size() : frame.world->placed.size(), 0);
}

void ProofMemory::write(const Frame& frame, Pending::Kind kind, uint32_t index, const Certificate& certificate) {
    makeRoom(frame, kind, index);
    Array<uint32_t>& of = numbers(kind);
    if (!hasCertificate(kind, index)) {
        if (free_.empty()) {
            certificates_.push_back({});
            of[index] = static_cast<uint32_t>(certificates_.size());
        } else {
            of[index] = free_.back() + 1;
            free_.pop_back();
        }
    }
    certificates_[of[index] - 1] = certificate;
}

void ProofMemory::propose(const Frame& frame, Pending::Kind kind, uint32_t index, std::span<const HidingPart> parts) {
    Certificate certificate;
    for (const HidingPart& part : parts)
        if (certificate.count < Certificate::kMost) certificate.hiders[certificate.count++] = numberOf(part);
    write(frame, kind, index, certificate);
}

uint32_t ProofMemory::numberOf(const HidingPart& part) {
    const auto slotOf = [&](const HidingPart& of) {
        uint64_t hash = (uint64_t{of.object.index} << 12 ^ of.part) * 0x9e3779b97f4a7c15ull;
        hash ^= (uint64_t{of.other.index} << 12 ^ of.other_part) * 0xbf58476d1ce4e5b9ull;
        return static_cast<size_t>(hash >> 32) & (number_.size() - 1);
    };
    if (2 * (hiders_.size() + 1) > number_.size()) {
        number_.assign(std::max<size_t>(64, 2 * number_.size()), 0);
        for (uint32_t i = 0; i < hiders_.size(); ++i) {
            size_t at = slotOf(hiders_[i].part);
            while (number_[at] != 0) at = (at + 1) & (number_.size() - 1);
            number_[at] = i + 1;
        }
    }
    size_t at = slotOf(part);
    for (; number_[at] != 0; at = (at + 1) & (number_.size() - 1))
        if (hiders_[number_[at] - 1].part == part) return number_[at] - 1;
    hiders_.push_back({part, 0, kNone});
    number_[at] = static_cast<uint32_t>(hiders_.size());
    return number_[at] - 1;
}

/// The object at a place, if it surely hides in this view where it is drawn, as VolumeChooser has it.
const ProofMemory::Place& ProofMemory::placeAt(const Frame& frame, uint32_t place) {
    Place& out = places_[place % kPlaces];
    if (out.answer == answer_ && out.place == place) return out;
    out.answer = answer_;
    out.place = place;
    out.hides = false;
    const SnapshotState& state = *frame.world;
    const PlacedObject& placed = state.placed[place];
    if (placed.occluder.index == 0 || !frame.isInLayers(place) || !frame.isCandidate(place)) return out;
    if (frame.mayBeCoarse(place) || frame.sizes.drops(place)) return out;
    const HeldOccluder& occluder = *state.occluders[placed.occluder.index];
    if (occluder.parts.parts.empty()) return out;
    const ObjectRecord& record = state.objectAt(place);
    if (!isWhole(frame.limits, occluder, record.transform)) return out;
    if (!reachesWindow(frame.limits, record.bounds, record.transform)) return out;
    out.at = placeParts(view_, occluder.parts, occluder.bounds, record.transform);
    out.hides = out.at.usable;
    out.occluder = &occluder;
    return out;
}

bool ProofMemory::makeVolumeOf(const Frame& frame, const HidingPart& part, OccluderVolume& volume) {
    const SnapshotState& world = *frame.world;
    const uint32_t at = world.placeOf(part.object);
    if (at == PlacedBvh::kNone) return false;
    const Place& place = placeAt(frame, at);
    if (!place.hides || part.part >= place.at.parts->partCount()) return false;
    if (part.other_part == HidingPart::kNone) {
        VolumeOutline outline;
        return makeVolume(view_, place.at, part.part, volume, outline);
    }
    const uint32_t other_at = world.placeOf(part.other);
    if (other_at == PlacedBvh::kNone) return false;
    const Place one = place;  // the other one may take its slot
    const Place& other = placeAt(frame, other_at);
    if (!other.hides || part.other_part >= other.at.parts->partCount()) return false;
    const VolumePart &a = one.at.parts->part(part.part), &b = other.at.parts->part(part.other_part);
    if (a.face_count != 1 || b.face_count != 1) return false;
    VolumeSeam seam;
    seam.face[0] = one.at.parts->members[a.first_face];
    seam.face[1] = other.at.parts->members[b.first_face];
    return findSeam(*one.at.parts, world.objectAt(at).transform, *other.at.parts, world.objectAt(other_at).transform,
                    seam) &&
           makeSeamVolume(view_, one.at, other.at, seam, volume);
}

const Shadow* ProofMemory::shadowOf(const Frame& frame, uint32_t hider) {
    Hider& h = hiders_[hider];
    if (h.answer == answer_) return h.shadow == kNone ? nullptr : &shadows_[h.shadow];
    h.answer = answer_;
    h.shadow = kNone;
    Shadow shadow;
    if (!makeVolumeOf(frame, h.part, shadow.volume) || !makeShadow(image_, shadow)) return nullptr;
    h.shadow = static_cast<uint32_t>(shadows_.size());
    shadows_.push_back(shadow);
    return &shadows_.back();
}

/// The corners of what of an object may face the eye: its vertices if they are few, else a box around them, both as the
/// object stands.
/// @param error  receives how far a corner may lie elsewhere
/// @returns how many; 0: nothing of it does
uint32_t ProofMemory::cornersOf(const Frame& frame, uint32_t place, glm::dvec3* corners, double& error,
                                bool& box) const {
    const ObjectRecord& object = frame.world->objectAt(place);
    const glm::dvec3 shift = glm::dvec3(object.transform[3]) - frame.frustum.eye;
    const glm::dmat3 linear(object.transform);
    double size = sum(glm::dvec3(object.transform[3])) + sum(frame.frustum.eye);
    for (int axis = 0; axis < 3; ++axis)
        size += sum(linear[axis]) * std::max(std::abs(object.bounds.min[axis]), std::abs(object.bounds.max[axis]));
    error = view_.eye_error + 0x1p-49 * size;
    uint32_t count = 0;
    Box3d bounds = object.bounds;
    box = true;
    if (object.shape.index != 0 && frame.settings.second_look && !frame.mayBeCoarse(place)) {
        const Occluder& shape = *frame.world->occluders[object.shape.index];
        if (shape.polygons.size() <= kMostPolygons) {
            bounds = Box3d();
            box = false;
            const double flips = glm::determinant(linear) < 0 ? -1 : 1;
            for (const OccluderCluster& cluster : shape.clusters) {
                uint64_t used[(OccluderCluster::kMaxVertices + 63) / 64] = {};
                const auto at = [&](uint32_t v) {
                    const uint32_t i = cluster.first_vertex + v;
                    return glm::dvec3(shape.x[i], shape.y[i], shape.z[i]);
                };
                for (uint32_t p = cluster.first_polygon; p < cluster.first_polygon + cluster.polygon_count; ++p) {
                    const OccluderPolygon& polygon = shape.polygons[p];
                    glm::dvec3 corner[4];
                    for (int k = 0; k < polygon.corners(); ++k) corner[k] = linear * at(polygon.vertex[k]) + shift;
                    if (!polygon.double_sided && facesAway(polygon, corner, flips, error)) continue;
                    for (int k = 0; k < polygon.corners(); ++k)
                        used[polygon.vertex[k] / 64] |= uint64_t{1} << polygon.vertex[k] % 64;
                }
                for (uint32_t v = 0; v < cluster.vertex_count; ++v) {
                    if (!(used[v / 64] >> v % 64 & 1)) continue;
                    bounds.grow(at(v));
                    if (!box && count < Uncovered::kMostCorners) corners[count++] = linear * at(v) + shift;
                    else box = true;
                }
            }
            if (!box) return count;
        }
    }
    for (count = 0; count < 8; ++count) corners[count] = linear * bounds.corner(count) + shift;
    return count;
}

/// The corners of a node's box, or those of an object.
/// @returns false if they cannot be told apart from the eye
bool ProofMemory::takeUp(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box) {
    glm::dvec3 corners[Uncovered::kMostCorners];
    uint32_t count = 8;
    bool by_box = true;
    double error = view_.place_error;
    if (kind == Pending::Kind::kObject) {
        count = cornersOf(frame, index, corners, error, by_box);
    } else {
        for (uint32_t i = 0; i < 8; ++i) {
            corners[i] = doubled(box).corner(i);
            error = std::max(error, view_.place_error + 0x1p-23 * sum(corners[i]));  // rounded to float
        }
    }
    if (count == 0) {
        rest_.clear();
        return true;
    }
    return rest_.begin(view_, image_, corners, count, error, by_box);
}

bool ProofMemory::isCovered(const Frame& frame, const Certificate& certificate, const Box3f& box, Pending::Kind kind,
                            uint32_t index) {
    if (certificate.count == 1) {
        const Shadow* shadow = shadowOf(frame, certificate.hiders[0]);
        if (!shadow) return false;
        if (shadow->holds(box)) return true;
    }
    if (!takeUp(frame, kind, index, box)) return false;
    for (const uint32_t hider : certificate.all()) {
        const Shadow* shadow = shadowOf(frame, hider);
        if (!shadow) continue;
        rest_.remove(*shadow);
        if (rest_.nothing()) return true;
    }
    return rest_.nothing();
}

bool ProofMemory::holds(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box) {
    if (!hasCertificate(kind, index)) return false;
    const Certificate certificate = certificateOf(kind, index);
    if (isCovered(frame, certificate, box, kind, index)) return true;
    forget(kind, index);
    return false;
}

TurnAnswer cullProved(const Frame& frame, TraversalState& state, const Pending& entry) {
    ProofMemory& proofs = state.proofs;
    const bool proved = proofs.holds(frame, entry.kind, entry.index, entry.box);
    state.stats.proved += proved;
    if (!proved && proofs.sought >= ProofMemory::kMostSought) {
        proofs.passOver(state.visible.size());
        return {.settled = true};
    }
    if (!proved && !proofs.seek(frame, entry.kind, entry.index, entry.box)) return {};
    const Certificate certificate = proofs.certificateOf(entry.kind, entry.index);
    proofs.culled.push_back({entry.below, certificate});
    // Where nobody had to hide it, it lies beside the image, or faces away.
    return {.culled = true, .stage = certificate.count > 0 ? Stage::kOcclusion : Stage::kFrustum};
}

}  // namespace sightline::detail
