// Finds certificates: by the parts that hid something just now, then by rays through what is left of the outline.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/frame/proof_memory.h"

#include <algorithm>
#include <cmath>

#include "sightline/stages/proof_bodies.h"
#include "sightline/tree/descend.h"

namespace sightline::detail {
namespace {

constexpr uint32_t kMostTries = 2;    // of parts along a ray that are not before the occludee's box
constexpr uint32_t kTrusts = 3;       // times that a ray is believed, in 2 bits
constexpr double kEnough = 0.999;     // of what is left: nobody hides more
constexpr double kLeastTaken = 0.02;  // of what is left: less is not worth a place in a certificate

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

/// The parts of an object that a ray meets from their front.
/// @param direction  dot(image_.w, direction) = 1
void ProofMemory::meet(const Frame& frame, uint32_t at, const glm::dvec3& direction, double far) {
    const Place& place = placeAt(frame, at);
    if (!place.hides) return;
    SIGHTLINE_DEBUG_ASSERT(place.at.parts && place.occluder && place.at.parts == &place.occluder->parts);
    const VolumeParts& parts = *place.at.parts;
    const glm::dvec3 along = glm::transpose(place.at.covector) * direction;
    const auto meetFace = [&](uint32_t index) {
        SIGHTLINE_DEBUG_ASSERT(index < parts.faces.size());
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
    SIGHTLINE_DEBUG_ASSERT(possible_ && far >= 0);
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

/// What of the rest a part hides; 0: nothing, or it cannot be in a certificate with the others.
double ProofMemory::shareOf(const Frame& frame, uint32_t hider, const Certificate& certificate) {
    if (certificate.count == Certificate::kMost) return 0;
    const std::span<const uint32_t> all = certificate.all();
    if (std::find(all.begin(), all.end(), hider) != all.end()) return 0;
    const Shadow* const shadow = shadowOf(frame, hider);
    return shadow ? rest_.share(*shadow) : 0;
}

/// Adds a part to a certificate, if it hides enough of what is left.
bool ProofMemory::take(const Frame& frame, const HidingPart& part, Certificate& certificate) {
    const uint32_t hider = numberOf(part);
    if (!(shareOf(frame, hider, certificate) > kLeastTaken)) return false;
    SIGHTLINE_DEBUG_ASSERT(certificate.count < Certificate::kMost);
    rest_.remove(*shadowOf(frame, hider));
    certificate.hiders[certificate.count++] = hider;
    return true;
}

/// Takes that of what a ray has met that hides most: a body or a face.
bool ProofMemory::takeHit(const Frame& frame, double enters, Certificate& certificate) {
    uint32_t tries = 0;
    HidingPart best;
    double most = kLeastTaken;
    for (uint32_t i = 0; i < hit_count_; ++i) {
        const Hit hit = hits_[i];
        SIGHTLINE_DEBUG_ASSERT(i == 0 || hits_[i - 1].t <= hit.t);
        if (hit.t > enters && ++tries > kMostTries) break;
        const ObjectId id = idAt(frame, hit.place);
        const uint32_t body = placeAt(frame, hit.place).at.parts->part(hit.part).body;
        for (const uint32_t part : {body, hit.part}) {
            if (part == VolumePart::kNone) continue;
            const double share = shareOf(frame, numberOf({id, part, {}}), certificate);
            if (share > most) most = share, best = {id, part, {}};
            if (part == body && share > 0) break;
        }
        if (most > kEnough) break;
    }
    return most > kLeastTaken && take(frame, best, certificate);
}

/// Closes a slit between two faces that meet, or a corner of it: where it meets others, or crosses one behind it.
bool ProofMemory::takeSeam(const Frame& frame, Certificate& certificate) {
    for (const bool around : {false, true}) {
        glm::dvec3 beside[8];
        const uint32_t rays_beside = rest_.besideSlit(around, beside);
        HidingPart found[16];
        uint32_t count = 0;
        for (uint32_t ray = 0; ray < rays_beside; ++ray) {
            shoot(frame, beside[ray], rest_.farthest());
            for (uint32_t i = 0; i < std::min(hit_count_, 2u); ++i) {
                const HidingPart part{idAt(frame, hits_[i].place), hits_[i].part, {}};
                if (std::find(found, found + count, part) == found + count) found[count++] = part;
            }
        }
        for (uint32_t i = 0; i < count; ++i)
            for (uint32_t k = i + 1; k < count; ++k)
                if (take(frame, {found[i].object, found[i].part, found[k].object, found[k].part}, certificate))
                    return true;
    }
    return false;
}

/// Whether one of the parts that hid something just now hides the body at hand; it is added to a certificate.
bool ProofMemory::hiddenByLast(const Frame& frame, Certificate& out) {
    for (const uint32_t last : last_) {
        if (last == kNone || out.count == Certificate::kMost) continue;
        const Shadow* const shadow = shadowOf(frame, last);
        if (!shadow || !shadow->holds(corners_.at, corners_.count, corners_.error)) continue;
        SIGHTLINE_DEBUG_ASSERT(out.count < Certificate::kMost);
        out.hiders[out.count++] = last;
        return true;
    }
    return false;
}

/// Adds to a certificate whom a body needs.
bool ProofMemory::seekBody(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, const Body& body,
                           Certificate& out) {
    last_ray_ = glm::dvec3(0.0);
    takeUp(frame, kind, index, box, body);
    if (hiddenBy(frame, out, body) || hiddenByLast(frame, out)) return true;
    if (rest_.nothing()) return false;
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
        if (takeSeam(frame, out)) continue;
        last_ray_ = enters * direction;
        return false;
    }
    return true;
}

bool ProofMemory::seek(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, bool closely) {
    SIGHTLINE_DEBUG_ASSERT(possible_ && kind != Pending::Kind::kCluster);
    ++sought;
    Certificate out;
    looks_away_ = false;
    last_ray_ = glm::dvec3(0.0);
    if (!closely && isStillSeen(frame, kind, index, box)) return noteFailed(frame, kind, index, box, closely);
    if (!forEachBody(frame, kind, index, closely, [&](const Body& body) {
            out.closely |= body.form == Body::kPolygon;
            return seekBody(frame, kind, index, box, body, out);
        }))
        return noteFailed(frame, kind, index, box, closely);
    makeRoom(frame, kind, index);
    write(kind, index, out);
    latest_ = out;
    if (out.count > 0) {
        std::copy_backward(last_, last_ + kLast - 1, last_ + kLast);
        last_[0] = out.hiders[0];
    }
    ++found;
    return true;
}

/// Nothing was found for a node or an object: while views are drawn nobody asks again for some answers.
bool ProofMemory::noteFailed(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box, bool closely) {
    makeRoom(frame, kind, index);
    SIGHTLINE_DEBUG_ASSERT(index < numbers(kind).size());
    forget(kind, index);
    numbers(kind)[index] = kFailed | (closely ? kClosely : 0) | (answer_ & (kClosely - 1));
    if (last_ray_ == glm::dvec3(0.0)) return false;
    uint32_t at = kTrusts;
    for (int axis = 0; axis < 3; ++axis) {
        const double size = static_cast<double>(box.max[axis]) - box.min[axis];
        const double part = size > 0 ? (last_ray_[axis] - box.min[axis]) / size : 0.5;
        at = at << 10 | static_cast<uint32_t>((part > 0 ? std::min(part, 1.0) : 0.0) * 1023.0);
    }
    seen(kind)[index] = at;
    last_ray_ = glm::dvec3(0.0);
    return false;
}

/// Whether a ray to where a node or an object was seen last meets nobody before it. It is believed a few times; then what
/// is left of it is looked at again.
bool ProofMemory::isStillSeen(const Frame& frame, Pending::Kind kind, uint32_t index, const Box3f& box) {
    if (index >= seen(kind).size() || seen(kind)[index] >> 30 == 0) return false;
    uint32_t& at = seen(kind)[index];
    glm::dvec3 q;
    for (int axis = 0; axis < 3; ++axis) {
        const double part = (at >> (20 - 10 * axis) & 1023) / 1023.0;
        q[axis] = box.min[axis] + part * (static_cast<double>(box.max[axis]) - box.min[axis]);
    }
    SIGHTLINE_DEBUG_ASSERT(at >> 30 > 0);
    at -= 1u << 30;
    const double far = glm::dot(image_.w, q);
    if (!(far > 0)) return false;
    const glm::dvec3 direction = q / far;
    if (std::max(std::abs(glm::dot(image_.x, direction)), std::abs(glm::dot(image_.y, direction))) > 1) return false;
    shoot(frame, direction, std::min(entry(box, direction), far));
    return hit_count_ == 0;
}

}  // namespace sightline::detail
