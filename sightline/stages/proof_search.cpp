// Finds certificates: by the parts that hid something just now, then by rays through what is left of the outline.
// SPDX-License-Identifier: MIT
#include "sightline/frame/proof_memory.h"

#include <algorithm>
#include <cmath>

#include "sightline/tree/descend.h"

namespace sightline::detail {
namespace {

constexpr uint32_t kMostTries = 2;    // of parts along a ray that are not before the occludee's box
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
        if (!shadow || !shadow->holds(box)) continue;
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

}  // namespace sightline::detail
