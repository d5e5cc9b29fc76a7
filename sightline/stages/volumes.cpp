// The stage of occluder volumes: chooses the few that hide most from a view, and culls what lies in one of them.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/stages/stage_memory.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/stages/occluder_form.h"
#include "sightline/stages/pipeline.h"
#include "sightline/tree/descend.h"

namespace sightline::detail {
namespace {

constexpr double kLeastShare = 1.0 / 256.0;  // of the buffer
constexpr double kLeastObjects = 0.5;        // that a volume holds, about

/// How large a box looks from the eye, at most about.  [pixels]
double boxPixels(const EyeBoxes& boxes, int slot, const VolumeView& view) {
    SIGHTLINE_DEBUG_ASSERT(slot >= 0 && slot < 8);
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

void VolumeChooser::choose(Frame& frame) {
    SIGHTLINE_DEBUG_ASSERT(frame.world && frame.usable);
    volumes_.clear();
    owners_.clear();
    const uint32_t most = std::min(frame.settings.occluder_volumes, kMostVolumes);
    if (frame.world->bvh.nodes.empty() || most == 0) return;
    const Screen& screen = frame.screen;
    const VolumeView shared = makeVolumeView(frame.view, screen, frame.world->bvh.origin - frame.frustum.eye);
    if (!shared.usable) return;
    least_ = kLeastShare * screen.width * screen.height;
    gather(frame, shared);
    take(shared, most);
    frame.volumes = volumes_;
    frame.volume_owners = owners_;
}

void VolumeChooser::gather(const Frame& frame, const VolumeView& shared) {
    heap_.clear();
    places_.clear();
    candidates_.clear();
    serial_ = 0;
    top_count_ = 0;
    uint32_t nodes = 0, objects = 0;
    Met top;
    top.planes = (1u << frame.frustum.count) - 1;
    heap_.push_back(top);
    // Nodes and objects in one queue; beyond the limits they are passed over.
    struct Queue {
        Array<Met>& heap;
        Met pop() {
            std::pop_heap(heap.begin(), heap.end());
            const Met met = heap.back();
            heap.pop_back();
            return met;
        }
    } queue{heap_};
    descendInOrder(
        queue, [&] { return !heap_.empty() && objects <= kMostObjects; },
        [&](const Met& met) {
            if (met.leaf) {
                if (++objects <= kMostObjects) lookAt(frame, shared, met.index);
            } else if (++nodes <= kMostNodes) {
                openNode(frame, shared, met);
            }
        });
}

void VolumeChooser::openNode(const Frame& frame, const VolumeView& shared, const Met& from) {
    const SnapshotState& state = *frame.world;
    const Frustum& frustum = frame.frustum;
    SIGHTLINE_DEBUG_ASSERT(!from.leaf && from.index < state.bvh.nodes.size());
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
        if (met.leaf && (!frame.isCandidate(met.index) || frame.sizes.drops(met.index))) continue;
        heap_.push_back(met);
        std::push_heap(heap_.begin(), heap_.end());
    }
}

void VolumeChooser::lookAt(const Frame& frame, const VolumeView& shared, uint32_t place) {
    const SnapshotState& state = *frame.world;
    SIGHTLINE_DEBUG_ASSERT(place < state.placed.size());
    const PlacedObject& placed = state.placed[place];
    if (!frame.isInLayers(place) || frame.mayBeCoarse(place)) return;
    const HeldOccluder& occluder = *state.occluders[placed.occluder.index];
    const VolumeParts& parts = occluder.parts;
    if (parts.parts.empty()) return;
    SIGHTLINE_DEBUG_ASSERT(parts.parts.size() <= VolumeParts::kMaxParts && VolumeParts::kMaxParts <= 64);
    const ObjectRecord& record = state.objectAt(place);
    if (!isWhole(frame.limits, occluder, record.transform)) return;
    if (!reachesWindow(frame.limits, record.bounds, record.transform)) return;
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
        SIGHTLINE_DEBUG_ASSERT(part.face_count > 0 &&
                               (part.body == VolumePart::kNone || part.body < parts.parts.size()));
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

/// Makes volumes of the best candidates, and takes those that hold most objects. A volume within another one is left
/// out.
void VolumeChooser::take(const VolumeView& shared, uint32_t most) {
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
        SIGHTLINE_DEBUG_ASSERT(candidates_[i].owner < places_.size() && count < std::size(rank));
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
double VolumeChooser::heldObjects(const OccluderVolume& volume) const {
    double sum = 0;
    alignas(64) float share[8];
    for (uint32_t i = 0; i < top_count_; ++i) {
        shadowShares(volume, top_[i].boxes, share);
        for (int slot = 0; slot < 8; ++slot)
            if (top_[i].objects[slot] > 0) sum += static_cast<double>(share[slot]) * top_[i].objects[slot];
    }
    return sum;
}

void chooseVolumes(Frame& frame, StageMemory& memory) {
    if (frame.world && frame.usable && frame.uses(Stage::kVolumes)) memory.volumes.choose(frame);
}

/// The volumes that may hide a node's children: the test of its parent found that they cross the node.
OpenVolumes::Run runOf(const Frame& frame, OpenVolumes& open, uint32_t node) {
    if (open.of_node.size() < frame.world->bvh.nodes.size()) open.of_node.resize(frame.world->bvh.nodes.size());
    SIGHTLINE_DEBUG_ASSERT(node < open.of_node.size() && frame.volumes.size() <= VolumeChooser::kMostVolumes);
    const OpenVolumes::Run& noted = open.of_node[node];
    if (noted.answer == open.answer) return noted;
    if (open.crossing.empty())
        for (uint32_t i = 0; i < frame.volumes.size(); ++i) open.crossing.push_back({i, frame.volumes[i].allPlanes()});
    return {0, static_cast<uint32_t>(frame.volumes.size()), open.answer};
}

uint32_t cullInVolumes(const Frame& frame, TraversalState& state, Group& group, uint32_t live) {
    OpenVolumes& open = state.volumes;
    const OpenVolumes::Run run = runOf(frame, open, group.index);
    SIGHTLINE_DEBUG_ASSERT(live <= 0xff && size_t{run.first} + run.count <= open.crossing.size());
    SIGHTLINE_DEBUG_ASSERT(frame.volumes.size() == frame.volume_owners.size());
    uint32_t counts[8] = {}, gone = 0;
    OpenVolumes::One crossing[8][VolumeChooser::kMostVolumes];
    for (uint32_t i = run.first; i < run.first + run.count && live; ++i) {
        const OpenVolumes::One one = open.crossing[i];
        SIGHTLINE_DEBUG_ASSERT(one.volume < frame.volumes.size());
        const VolumeAnswer answer = testVolume(frame.volumes[one.volume], group.boxes, one.planes, live);
        for (uint32_t bits = live & ~answer.outside; bits; bits &= bits - 1) {
            const int slot = std::countr_zero(bits);
            if (answer.hidden >> slot & 1) group.hider[slot] = frame.volume_owners[one.volume];
            else crossing[slot][counts[slot]++] = {one.volume, answer.planes[slot]};
        }
        gone |= answer.hidden;
        live &= ~answer.hidden;
    }
    for (uint32_t bits = live; bits; bits &= bits - 1) {
        const int slot = std::countr_zero(bits);
        if (counts[slot] > 0) group.undecided |= 1u << slot;
        if (group.node.child[slot] & BvhNode::kLeaf) continue;
        open.of_node[group.node.child[slot]] = {static_cast<uint32_t>(open.crossing.size()), counts[slot], open.answer};
        open.crossing.insert(open.crossing.end(), crossing[slot], crossing[slot] + counts[slot]);
    }
    return gone;
}

}  // namespace sightline::detail
