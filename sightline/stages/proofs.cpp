// Culling by certificates: what hid something before is held against it first, and rays find whom to ask else.
// SPDX-License-Identifier: MIT
#include "sightline/frame/proof_memory.h"

#include <algorithm>
#include <cmath>

#include "sightline/stages/occluder_form.h"
#include "sightline/stages/pipeline.h"
#include "sightline/tree/descend.h"

namespace sightline::detail {
namespace {

constexpr uint32_t kMostSought = 32;    // for one view
constexpr uint32_t kMostAnswers = 128;  // by certificates alone, one after the other
constexpr uint32_t kShortRest = 64, kLongRest = 512;
constexpr uint32_t kMostPolygons = 48;  // of an object that are looked at one by one
constexpr double kMostWork = 0.8;       // of that of drawing
constexpr uint32_t kFewAnswers = 4;     // that are given before the work is compared
constexpr uint64_t kMostCuts = 600;     // polygons cut for one view that is drawn
constexpr uint32_t kMostDrawn = 16;     // views, one after the other, for which certificates are sought
constexpr double kMostLoose = 0.12;     // of what is visible: that certificates may keep although it is hidden
constexpr size_t kMostHiders = 1u << 16;
constexpr uint32_t kMostTries = 2;    // of parts along a ray that are not before the occludee's box
constexpr double kLeastTaken = 0.02;  // of what is left: less is not worth a place in a certificate

double sum(const glm::dvec3& v) { return std::abs(v.x) + std::abs(v.y) + std::abs(v.z); }

Box3d doubled(const Box3f& box) { return {glm::dvec3(box.min), glm::dvec3(box.max)}; }

/// Whether a box lies wholly in a volume, as testVolume() has it.
bool isWithin(const OccluderVolume& volume, const Box3f& box) {
    double reach = 0;
    for (int axis = 0; axis < 3; ++axis)
        reach += std::max(std::abs(static_cast<double>(box.min[axis])), std::abs(static_cast<double>(box.max[axis])));
    for (uint32_t plane = 0; plane < volume.planes; ++plane) {
        double lowest = volume.distance[plane];
        for (int axis = 0; axis < 3; ++axis) {
            const double n = volume.normal[plane][axis];
            lowest += n * static_cast<double>(n > 0 ? box.min[axis] : box.max[axis]);
        }
        const double still = volume.slack[plane][0], turn = volume.slack[plane][1];
        if (!(lowest > still + turn * reach)) return false;
    }
    return true;
}

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

/// A ray from the eye against eight boxes: which one it may meet. It decides nothing that has to be sure.
struct RayBoxes {
    RayBoxes(const glm::dvec3& direction, double to) : far(static_cast<float>(to) * 1.0001f) {
        for (int axis = 0; axis < 3; ++axis) {
            const double d = direction[axis];
            inverse[axis] = static_cast<float>(1.0 / (std::abs(d) > 1e-12 ? d : std::copysign(1e-12, d)));
        }
    }
    uint32_t meets(const EyeBoxes& boxes) const {
        float enter[8], leave[8];
        for (int i = 0; i < 8; ++i) enter[i] = 0, leave[i] = far;
        for (int axis = 0; axis < 3; ++axis)
            for (int i = 0; i < 8; ++i) {
                const float a = boxes.min[axis][i] * inverse[axis], b = boxes.max[axis][i] * inverse[axis];
                enter[i] = std::max(enter[i], std::min(a, b));
                leave[i] = std::min(leave[i], std::max(a, b));
            }
        uint32_t slots = 0;
        for (int i = 0; i < 8; ++i) slots |= uint32_t{enter[i] <= leave[i] * 1.0001f + 1e-6f} << i;
        return slots;
    }

    float inverse[3], far;
};

/// Where a ray from the eye enters a box.
double entry(const Box3f& box, const glm::dvec3& direction) {
    double enters = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (direction[axis] == 0) continue;
        const double nearer = direction[axis] > 0 ? box.min[axis] : box.max[axis];
        enters = std::max(enters, nearer / direction[axis]);
    }
    return enters;
}

ObjectId idAt(const Frame& frame, uint32_t place) { return frame.world->placed[place].visible.id; }

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

void ProofMemory::begin(const Frame& frame) {
    if (++answer_ == 0) {  // numbers of answers begin anew
        clear();
        places_.clear();
        answer_ = 1;
    }
    shadows_.clear();
    hidden.clear();
    culled.clear();
    cuts_before_ = rest_.cuts();
    sought = found = passed_over_ = 0;
    rays = 0;
    way_ = Way::kTiles;
    const QuerySettings& settings = frame.settings;
    possible_ = settings.proofs && !settings.stateless && settings.bins <= 1 && frame.usable && frame.world &&
                !frame.world->bvh.nodes.empty() && frame.uses(Stage::kOcclusion) && frame.uses(Stage::kFrustum);
    // Clusters are held against what was drawn.
    if (possible_ && frame.uses(Stage::kClusters) && frame.world->clusters.size() > 1) possible_ = false;
    if (!possible_) return;
    view_ = makeVolumeView(frame.view, frame.screen, frame.world->bvh.origin - frame.frustum.eye);
    image_ = makeImageFrame(frame.screen);
    possible_ = view_.usable && image_.usable;
    if (!possible_) return;
    if (hiders_.size() > kMostHiders) clear();
    if (places_.empty()) places_.resize(kPlaces);
    if (frame.view.layers != layers_ || frame.stages != stages_) next_by_proofs_ = false;
    layers_ = frame.view.layers;
    stages_ = frame.stages;
    if (next_by_proofs_ && answers_ < kMostAnswers) {
        way_ = Way::kProofs;
        return;
    }
    answers_ = 0;
    next_by_proofs_ = false;
    if (static_cast<int32_t>(answer_ - rest_until_) >= 0) way_ = Way::kTilesAndSeek;
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
        if (isWithin(shadow->volume, box)) return true;
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

/// The parts of an object that a ray meets from their front.
/// @param direction  dot(image_.w, direction) = 1
void ProofMemory::meet(const Frame& frame, uint32_t at, const glm::dvec3& direction, double far) {
    const Place& place = placeAt(frame, at);
    if (!place.hides) return;
    const VolumeParts& parts = *place.at.parts;
    const glm::dvec3 along = glm::transpose(place.at.covector) * direction;
    const auto meetFace = [&](uint32_t index) {
        const VolumeFace& face = parts.faces[index];
        const double over = glm::dot(face.normal, place.at.eye), fall = glm::dot(face.normal, along);
        const double height = fall < 0 ? over - face.high : face.low - over;
        if (!(height > 0 && std::abs(fall) * far > height) || (fall > 0 && !face.double_sided)) return;
        const double t = height / std::abs(fall);
        const glm::dvec3 q = place.at.eye + t * along;
        for (uint32_t k = 0; k < face.count; ++k) {
            const glm::dvec3& a = parts.corners[parts.outline[face.first + k]];
            const glm::dvec3& b = parts.corners[parts.outline[face.first + (k + 1 == face.count ? 0 : k + 1)]];
            if (!(glm::dot(glm::cross(face.normal, b - a), q - a) >= 0)) return;
        }
        if (hit_count_ < std::size(hits_)) hits_[hit_count_++] = {t, at, parts.partOf(index)};
    };
    const Bvh& faces = place.occluder->faces;
    const RayBoxes ray(along, far);
    faces_.assign(1, 0);
    while (!faces_.empty()) {
        const BvhNode& node = faces.nodes[faces_.back()];
        faces_.pop_back();
        forEachSlot(ray.meets(eyeBoxes(node, faces.origin - place.at.eye)) & usedSlots(node), [&](int slot) {
            const uint32_t child = node.child[slot];
            if (child & BvhNode::kLeaf) meetFace(faces.order[node.first[slot]]);
            else faces_.push_back(child);
        });
    }
}

/// Finds the parts along a ray, the nearest first.
void ProofMemory::shoot(const Frame& frame, const glm::dvec3& direction, double far) {
    ++rays;
    hit_count_ = 0;
    const SnapshotState& state = *frame.world;
    const RayBoxes ray(direction, far);
    nodes_.assign(1, 0);
    while (!nodes_.empty()) {
        const BvhNode& node = state.bvh.nodes[nodes_.back()];
        nodes_.pop_back();
        const EyeBoxes boxes = eyeBoxes(node, state.bvh.origin - frame.frustum.eye);
        forEachSlot(ray.meets(boxes) & usedSlots(node), [&](int slot) {
            const uint32_t child = node.child[slot];
            if (child & BvhNode::kLeaf) meet(frame, child & ~BvhNode::kLeaf, direction, far);
            else nodes_.push_back(child);
        });
    }
    std::sort(hits_, hits_ + hit_count_, [](const Hit& a, const Hit& b) {
        return a.t != b.t ? a.t < b.t : a.place != b.place ? a.place < b.place : a.part < b.part;
    });
}

/// Adds a part to a certificate, if it hides enough of what is left.
bool ProofMemory::take(const Frame& frame, const HidingPart& part, Certificate& certificate) {
    if (certificate.count == Certificate::kMost) return false;
    const uint32_t number = numberOf(part);
    const std::span<const uint32_t> all = certificate.all();
    if (std::find(all.begin(), all.end(), number) != all.end()) return false;
    const Shadow* shadow = shadowOf(frame, number);
    if (!shadow || !(rest_.remove(*shadow, kLeastTaken) > 0)) return false;
    certificate.hiders[certificate.count++] = number;
    return true;
}

/// Takes what a ray has met: a body, or else a face.
bool ProofMemory::takeHit(const Frame& frame, double enters, Certificate& certificate) {
    uint32_t tries = 0;
    for (uint32_t i = 0; i < hit_count_; ++i) {
        const Hit hit = hits_[i];
        if (hit.t > enters && ++tries > kMostTries) return false;
        const ObjectId id = idAt(frame, hit.place);
        const uint32_t body = placeAt(frame, hit.place).at.parts->part(hit.part).body;
        if (body != VolumePart::kNone && take(frame, {id, body, {}}, certificate)) return true;
        if (take(frame, {id, hit.part, {}}, certificate)) return true;
    }
    return false;
}

/// Closes a slit between two faces that meet.
bool ProofMemory::takeSeam(const Frame& frame, Certificate& certificate) {
    glm::dvec3 beside[2];
    if (!rest_.besideSlit(beside)) return false;
    Hit first[2][2];
    uint32_t counts[2];
    for (int i = 0; i < 2; ++i) {
        shoot(frame, beside[i], rest_.farthest());
        counts[i] = std::min(hit_count_, 2u);
        std::copy(hits_, hits_ + counts[i], first[i]);
    }
    for (uint32_t i = 0; i < counts[0]; ++i)
        for (uint32_t k = 0; k < counts[1]; ++k) {
            const Hit &a = first[0][i], &b = first[1][k];
            if (a.place == b.place && a.part == b.part) continue;
            if (take(frame, {idAt(frame, a.place), a.part, idAt(frame, b.place), b.part}, certificate)) return true;
        }
    return false;
}

bool ProofMemory::seek(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box) {
    ++sought;
    Certificate out;
    for (const uint32_t last : last_) {
        if (last == kNone) continue;
        const Shadow* shadow = shadowOf(frame, last);
        if (!shadow || !isWithin(shadow->volume, box)) continue;
        out.hiders[out.count++] = last;
        write(frame, kind, index, out);
        ++found;
        return true;
    }
    if (!takeUp(frame, kind, index, box)) return noteFailed(frame, kind, index);
    for (uint32_t i = 0; i < std::min(latest_.count, kLast) && !rest_.nothing(); ++i)
        take(frame, hiders_[latest_.hiders[i]].part, out);
    while (!rest_.nothing()) {
        const glm::dvec3 direction = rest_.direction();
        const double enters = std::min(entry(box, direction), rest_.farthest());
        shoot(frame, direction, enters);
        if (takeHit(frame, enters, out)) continue;
        if (kind == Pending::Kind::kObject && enters < rest_.farthest()) {
            shoot(frame, direction, rest_.farthest());
            if (takeHit(frame, enters, out)) continue;
        }
        if (!takeSeam(frame, out)) return noteFailed(frame, kind, index);
    }
    write(frame, kind, index, out);
    latest_ = out;
    if (out.count > 0) {
        std::copy_backward(last_, last_ + kLast - 1, last_ + kLast);
        last_[0] = out.hiders[0];
    }
    ++found;
    return true;
}

/// Nothing was found for a node or an object: while views are drawn nobody asks again for some answers.
bool ProofMemory::noteFailed(const Frame& frame, Pending::Kind kind, uint32_t index) {
    makeRoom(frame, kind, index);
    numbers(kind)[index] = kFailed | answer_;
    return false;
}

bool ProofMemory::hasFailed(Pending::Kind kind, uint32_t index) const {
    const Array<uint32_t>& of = numbers(kind);
    return index < of.size() && (of[index] & kFailed) && ((answer_ - of[index]) & ~kFailed) < kMostAnswers;
}

/// Looks for certificates for a node or an object that is hidden, or else for what is below it.
/// @returns how many objects are left without
uint32_t ProofMemory::seekBelow(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box) {
    if (cuts() >= kMostCuts) {
        spent_ = true;
        return 0;
    }
    if (holds(frame, kind, index, box)) return 0;
    if (!hasFailed(kind, index)) {
        if (sought >= kMostSought) {
            spent_ = true;
            return 0;
        }
        if (seek(frame, kind, index, box)) return 0;
    }
    if (kind == Pending::Kind::kObject) return 1;
    const PlacedBvh& bvh = frame.world->bvh;
    const BvhNode& node = bvh.nodes[index];
    const EyeBoxes boxes = eyeBoxes(node, bvh.origin - frame.frustum.eye);
    uint32_t slots = frame.candidateSlots(node) & usedSlots(node);
    if (frame.uses(Stage::kFrustum)) slots &= ~testFrustum(frame.frustum, boxes, allPlanes(frame) & 63).outside;
    uint32_t left = 0;
    forEachSlot(slots, [&](int slot) {
        const uint32_t child = node.child[slot];
        const bool leaf = child & BvhNode::kLeaf;
        if (leaf && (!frame.isInLayers(child & ~BvhNode::kLeaf) || frame.sizes.drops(child & ~BvhNode::kLeaf))) return;
        left += seekBelow(frame, leaf ? Pending::Kind::kObject : Pending::Kind::kNode, child & ~BvhNode::kLeaf,
                          boxOf(boxes, slot));
    });
    return left;
}

void ProofMemory::seekAll(const Frame& frame, size_t visible) {
    uint64_t loose = 0;
    spent_ = false;
    for (const Hidden& one : hidden) loose += seekBelow(frame, one.kind, one.index, one.box);
    if (spent_) {
        if (++drawn_ >= kMostDrawn) rest();
        return;
    }
    if (static_cast<double>(loose) <= kMostLoose * static_cast<double>(visible) + 1) next_by_proofs_ = true, drawn_ = 0;
    else rest();
}

/// Nobody seeks certificates for some answers, and for more if that did not do before.
void ProofMemory::rest() {
    next_by_proofs_ = false;
    drawn_ = 0;
    rest_for_ = std::clamp(2 * rest_for_, kShortRest, kLongRest);
    rest_until_ = answer_ + rest_for_;
}

void ProofMemory::noteAnswered(const QueryStats& stats) {
    const auto n = [](uint64_t count) { return static_cast<double>(count); };
    // What each unit took on several scenes, about. Time itself must not decide: answers would differ.
    if (way_ != Way::kProofs) {
        const double work =
            0.3 * n(stats.occluder_triangles) + 0.4 * n(stats.second_look_polygons) + 5 * n(stats.nodes_visited);
        drawn_work_ += (work - drawn_work_) / (drawn_work_ > 0 ? 4 : 1);
        drawn_visible_ = stats.visible;
        return;
    }
    const double work =
        0.7 * n(stats.proof_cuts) + 8 * n(stats.proof_rays) + n(stats.proved) + 3 * n(stats.nodes_visited);
    // More is kept: it is seen, or not proved to be hidden. Drawing tells.
    if (n(stats.visible) > (1 + kMostLoose) * n(drawn_visible_) + 3) next_by_proofs_ = false;
    proof_work_ += (work - proof_work_) / (answers_ > 0 ? 8 : 1);
    if (++answers_ == kShortRest) rest_for_ = 0;
    // The first of them have much to find.
    if (answers_ >= kFewAnswers && proof_work_ > (answers_ < 4 * kFewAnswers ? 3 : kMostWork) * drawn_work_) rest();
}

TurnAnswer cullProved(const Frame& frame, TraversalState& state, const Pending& entry) {
    ProofMemory& proofs = state.proofs;
    const bool proved = proofs.holds(frame, entry.kind, entry.index, entry.box);
    state.stats.proved += proved;
    if (!proved && proofs.sought >= kMostSought) {
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
