// The stage of occluder volumes in a walk: chooses the few that hide most from a view, and asks them on the way down.
// SPDX-License-Identifier: MIT
#include "sightline/run/volumes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/run/occluder_form.h"

namespace sightline::detail {
namespace {

constexpr double kLeastShare = 1.0 / 256.0;  // of the buffer
constexpr double kLeastObjects = 0.5;        // that a volume holds, about

/// How large a box looks from the eye, at most about.  [pixels]
double boxPixels(const EyeBoxes& boxes, int slot, const VolumeView& view) {
    double size = 0, away = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double low = boxes.min[axis][slot], high = boxes.max[axis][slot];
        size += (high - low) * (high - low);
        const double gap = std::max(0.0, std::max(low, -high));
        away += gap * gap;
    }
    if (!view.screen.perspective) return size * view.pixels_at_one;
    return away > 0 ? size / away * view.pixels_at_one : std::numeric_limits<double>::infinity();
}

/// The square of the distance from a point to a box.
double squaredDistance(const Box3f& box, const glm::dvec3& p) {
    double sum = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const double gap = std::max(0.0, std::max(box.min[axis] - p[axis], p[axis] - box.max[axis]));
        sum += gap * gap;
    }
    return sum;
}

}  // namespace

void VolumeStage::clear() {
    volumes_.clear();
    owners_.clear();
    open_.clear();
}

void VolumeStage::choose(const SnapshotState& state, const View& view, const Frustum& frustum, const Screen& screen,
                         uint32_t most) {
    clear();
    if (state.bvh.nodes.empty() || most == 0) return;
    const VolumeView shared = makeVolumeView(view, screen, state.bvh.origin - frustum.eye);
    if (!shared.usable) return;
    least_ = kLeastShare * screen.width * screen.height;
    gather(state, view, frustum, shared);
    take(shared, std::min(most, kMostVolumes));
    for (uint32_t i = 0; i < volumes_.size(); ++i) open_.push_back({i, volumes_[i].allPlanes()});
}

void VolumeStage::gather(const SnapshotState& state, const View& view, const Frustum& frustum,
                         const VolumeView& shared) {
    heap_.clear();
    places_.clear();
    candidates_.clear();
    serial_ = 0;
    top_count_ = 0;
    uint32_t nodes = 0, objects = 0;
    Met top;
    top.planes = (1u << frustum.count) - 1;
    heap_.push_back(top);
    while (!heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end());
        const Met met = heap_.back();
        heap_.pop_back();
        if (met.leaf) {
            if (++objects > kMostObjects) return;
            lookAt(state, view, shared, met.index);
        } else {
            if (++nodes > kMostNodes) continue;
            openNode(state, frustum, shared, met);
        }
    }
}

void VolumeStage::openNode(const SnapshotState& state, const Frustum& frustum, const VolumeView& shared,
                           const Met& from) {
    const BvhNode& node = state.bvh.nodes[from.index];
    const EyeBoxes boxes = eyeBoxes(node, state.bvh.origin - frustum.eye);
    const FrustumAnswer answer = testFrustum(frustum, boxes, from.planes);
    Top* const top = from.depth < 2 && top_count_ < std::size(top_) ? &top_[top_count_++] : nullptr;
    if (top) top->boxes = boxes;
    for (int slot = 0; slot < 8; ++slot) {
        const bool counts = node.count[slot] > 0 && !(answer.outside >> slot & 1);
        const bool opened = from.depth == 0 && !(node.child[slot] & BvhNode::kLeaf);
        if (top) top->objects[slot] = counts && !opened ? static_cast<float>(node.count[slot]) : 0.0f;
        if (node.count[slot] == 0 || (answer.outside >> slot & 1)) continue;
        Met met;
        met.pixels = boxPixels(boxes, slot, shared);
        if (!(met.pixels >= least_)) continue;
        met.leaf = node.child[slot] & BvhNode::kLeaf;
        met.index = node.child[slot] & ~BvhNode::kLeaf;
        met.planes = answer.planes[slot];
        met.serial = ++serial_;
        met.depth = static_cast<uint8_t>(from.depth + (from.depth < 2));
        if (met.leaf && state.placed[met.index].occluder.index == 0) continue;
        if (met.leaf && admission && !admission->admits(met.index)) continue;
        if (met.leaf && sizes && sizes->drops(met.index)) continue;
        heap_.push_back(met);
        std::push_heap(heap_.begin(), heap_.end());
    }
}

void VolumeStage::lookAt(const SnapshotState& state, const View& view, const VolumeView& shared, uint32_t place) {
    const PlacedObject& placed = state.placed[place];
    if (!(placed.layers & view.layers)) return;
    const HeldOccluder& occluder = *state.occluders[placed.occluder.index];
    const VolumeParts& parts = occluder.parts;
    if (parts.parts.empty()) return;
    const ObjectRecord& record = state.objectAt(place);
    if (limits && !isWhole(*limits, occluder, record.transform)) return;
    if (limits && !reachesWindow(*limits, record.bounds, record.transform)) return;
    const VolumePlace object = placeParts(shared, parts, occluder.bounds, record.transform);
    if (!object.usable) return;
    const uint32_t owner = static_cast<uint32_t>(places_.size());
    const double away = shared.screen.perspective ? squaredDistance(occluder.bounds, object.eye) : 0.0;
    uint64_t seen_bodies = 0;
    uint32_t asked = 0;
    bool any = false;
    for (uint32_t i = 0; i < parts.parts.size() && asked < kMostOfObject; ++i) {
        const VolumePart& part = parts.parts[i];
        const bool single = part.face_count == 1;
        if (single && part.body != VolumePart::kNone && (seen_bodies >> part.body & 1)) continue;
        // Faces lie by falling area: none that follows can look larger than this.
        if (single && away > 0 && part.area * shared.pixels_at_one < least_ * away) break;
        ++asked;
        const double pixels = roughPixels(shared, object, i);
        if (!single && pixels > 0) seen_bodies |= uint64_t{1} << i;
        if (!(pixels >= least_)) continue;
        candidates_.push_back({pixels, owner, i, place});
        any = true;
    }
    if (any) places_.push_back(object);
}

/// Makes volumes of the best candidates and takes those that hold most, none that lies in another.
void VolumeStage::take(const VolumeView& shared, uint32_t most) {
    const size_t tries = std::min<size_t>(candidates_.size(), 3 * size_t{most} + 4);
    std::partial_sort(candidates_.begin(), candidates_.begin() + static_cast<ptrdiff_t>(tries), candidates_.end(),
                      [](const Candidate& a, const Candidate& b) {
                          if (a.pixels != b.pixels) return a.pixels > b.pixels;
                          return a.owner != b.owner ? a.owner < b.owner : a.part < b.part;
                      });
    made_.resize(std::max(made_.size(), tries));
    size_t count = 0;
    struct Rank {
        double objects;
        uint32_t made;
    } rank[3 * kMostVolumes + 4];
    for (size_t i = 0; i < tries; ++i) {
        Made& made = made_[count];
        if (!makeVolume(shared, places_[candidates_[i].owner], candidates_[i].part, made.volume, made.outline))
            continue;
        const double objects = heldObjects(made.volume);
        if (!(objects >= kLeastObjects) || !(visiblePixels(shared, made.outline) >= least_)) continue;
        made.object = candidates_[i].object;
        rank[count] = {objects, static_cast<uint32_t>(count)};
        ++count;
    }
    std::sort(rank, rank + count, [](const Rank& a, const Rank& b) {
        return a.objects != b.objects ? a.objects > b.objects : a.made < b.made;
    });
    for (size_t i = 0; i < count && volumes_.size() < most; ++i) {
        const Made& made = made_[rank[i].made];
        const auto covers = [&](const OccluderVolume& volume) { return holds(volume, made.outline); };
        if (std::any_of(volumes_.begin(), volumes_.end(), covers)) continue;
        volumes_.push_back(made.volume);
        owners_.push_back(made.object);
    }
}

/// About how many objects in view a volume holds.
double VolumeStage::heldObjects(const OccluderVolume& volume) const {
    double sum = 0;
    alignas(64) float share[8];
    for (uint32_t i = 0; i < top_count_; ++i) {
        shadowShares(volume, top_[i].boxes, share);
        for (int slot = 0; slot < 8; ++slot)
            if (top_[i].objects[slot] > 0) sum += static_cast<double>(share[slot]) * top_[i].objects[slot];
    }
    return sum;
}

VolumesAnswer VolumeStage::test(const EyeBoxes& boxes, VolumeRange range, uint32_t left) {
    VolumesAnswer answer;
    uint32_t counts[8] = {};
    Open crossing[8][kMostVolumes];
    for (uint32_t i = range.first; i < range.first + range.count && left; ++i) {
        const Open open = open_[i];
        const VolumeAnswer one = testVolume(volumes_[open.volume], boxes, open.planes, left);
        for (uint32_t bits = left & ~one.outside; bits; bits &= bits - 1) {
            const int slot = std::countr_zero(bits);
            if (one.hidden >> slot & 1) answer.volume[slot] = static_cast<uint8_t>(open.volume);
            else crossing[slot][counts[slot]++] = {open.volume, one.planes[slot]};
        }
        answer.hidden |= one.hidden;
        left &= ~one.hidden;
    }
    for (uint32_t bits = left; bits; bits &= bits - 1) {
        const int slot = std::countr_zero(bits);
        answer.range[slot] = {static_cast<uint32_t>(open_.size()), counts[slot]};
        open_.insert(open_.end(), crossing[slot], crossing[slot] + counts[slot]);
    }
    return answer;
}

}  // namespace sightline::detail
