// How far and how small an object may be in a view: the settings' limits, objects' own, and the memory of what was shown.
// SPDX-License-Identifier: MIT
#include "sightline/frame/size_limits.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline::detail {
namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();

uint32_t leavesOf(const BvhNode& node) {
    uint32_t leaves = 0;
    for (int slot = 0; slot < 8; ++slot) leaves |= uint32_t{(node.child[slot] & BvhNode::kLeaf) != 0} << slot;
    return leaves;
}

/// Beyond this squares in float end: what lies there is not too far.
constexpr double kFarthest = 1e18;

bool isFarther(float square, double limit) { return limit<kFarthest&& static_cast<double>(square)> limit * limit; }

double squareOf(double value) { return value * value; }

}  // namespace

bool remembersShown(const View& view, const QuerySettings& settings) {
    return settings.hysteresis > 0.0 && (stagesInUse(view, settings) & kLossyStages) != 0;
}

void SizeLimits::begin(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t stages,
                       const glm::dvec3& eye, std::span<const uint32_t> shown_last) {
    clear();
    by_distance_ = stages & stageBit(Stage::kDistance);
    by_contribution_ = stages & stageBit(Stage::kContribution);
    if (!inUse()) return;
    shown = shown_last;
    state_ = &state;
    offset_ = state.bvh.origin - eye;
    distance_ = makeDistanceMeasure(view);
    contribution_ = makeContributionMeasure(view);
    zoom_ = distanceZoom(view, settings.max_distance_fov);
    max_distance_ = zoom_ * settings.max_distance;
    eye_radius_ = view.eye_radius;
    least_radius_ = settings.contribution;
    SIGHTLINE_DEBUG_ASSERT(state.limits.empty() || state.limits.objects.size() == state.placed.size());
    stays_ = !shown.empty() && settings.hysteresis > 0.0 ? std::min(settings.hysteresis, 1.0) : 0.0;
}

bool SizeLimits::wasShown(uint32_t place) const {
    if (shown.empty()) return false;
    const ObjectId id = state_->placed[place].visible.id;
    return id.index < shown.size() && shown[id.index] == id.generation;
}

double SizeLimits::farthest(uint32_t place) const {
    SIGHTLINE_DEBUG_ASSERT(place < state_->placed.size());
    double limit = max_distance_;
    if (!state_->limits.empty()) {
        const PlacedLimits::One& one = state_->limits.objects[place];
        if (one.factor == kInfinity) return kInfinity;
        limit = one.max_distance > 0.0 ? zoom_ * one.max_distance : limit * one.factor;
    }
    return stays_ > 0.0 && wasShown(place) ? limit * (1.0 + stays_) : limit;
}

double SizeLimits::smallest(uint32_t place) const {
    SIGHTLINE_DEBUG_ASSERT(place < state_->placed.size());
    double limit = least_radius_;
    if (!state_->limits.empty()) limit /= state_->limits.objects[place].factor;
    return stays_ > 0.0 && wasShown(place) ? limit * (1.0 - stays_) : limit;
}

double SizeLimits::farthestBelow(uint32_t node, int slot) const {
    SIGHTLINE_DEBUG_ASSERT(node < state_->bvh.nodes.size() && slot >= 0 && slot < 8);
    double limit = max_distance_;
    if (!state_->limits.empty()) {
        const PlacedLimits::Below& below = state_->limits.nodes[node].below[slot];
        if (below.factor == kInfinity) return kInfinity;
        limit = std::max(zoom_ * below.max_distance, below.views ? limit * below.factor : 0.0);
    }
    return limit * (1.0 + stays_);
}

double SizeLimits::smallestBelow(uint32_t node, int slot) const {
    SIGHTLINE_DEBUG_ASSERT(node < state_->bvh.nodes.size() && slot >= 0 && slot < 8);
    double limit = least_radius_;
    if (!state_->limits.empty()) limit /= state_->limits.nodes[node].below[slot].factor;
    return limit * (1.0 - stays_);
}

uint32_t SizeLimits::far(uint32_t node, const EyeBoxes& boxes, uint32_t left) const {
    if (!by_distance_) return 0;
    SIGHTLINE_DEBUG_ASSERT(left <= 0xff);
    const BvhNode& from = state_->bvh.nodes[node];
    alignas(64) float squares[8];
    squaredDistances(distance_, boxes, squares);
    uint32_t answer = 0;
    for (uint32_t bits = left; bits; bits &= bits - 1) {
        const int slot = std::countr_zero(bits);
        const bool leaf = from.child[slot] & BvhNode::kLeaf;
        const double limit = leaf ? farthest(from.first[slot]) : farthestBelow(node, slot);
        answer |= uint32_t{isFarther(squares[slot], limit + eye_radius_)} << slot;
    }
    return answer;
}

uint32_t SizeLimits::small(uint32_t node, const EyeBoxes& boxes, uint32_t left) const {
    if (!by_contribution_) return 0;
    SIGHTLINE_DEBUG_ASSERT(left <= 0xff);
    const BvhNode& from = state_->bvh.nodes[node];
    alignas(64) float squares[8];
    squaredRadii(contribution_, boxes, leavesOf(from), squares);
    uint32_t answer = 0;
    for (uint32_t bits = left; bits; bits &= bits - 1) {
        const int slot = std::countr_zero(bits);
        const bool leaf = from.child[slot] & BvhNode::kLeaf;
        const double limit = leaf ? smallest(from.first[slot]) : smallestBelow(node, slot);
        answer |= uint32_t{static_cast<double>(squares[slot]) < squareOf(limit)} << slot;
    }
    return answer;
}

SizeReason SizeLimits::reasonFor(uint32_t place) const {
    SizeReason reason{0, kInfinity, kInfinity, 0};
    if (!inUse()) return reason;
    SIGHTLINE_DEBUG_ASSERT(place < state_->placed.size() && state_->bvh.order[place] != PlacedBvh::kNone);
    const uint32_t at = state_->bvh.slot[state_->bvh.order[place]];
    const EyeBoxes boxes = eyeBoxes(state_->bvh.nodes[at / 8], offset_);
    alignas(64) float squares[8];
    squaredDistances(distance_, boxes, squares);
    reason.distance = std::sqrt(static_cast<double>(squares[at % 8]));
    squaredRadii(contribution_, boxes, 0xff, squares);
    reason.radius = std::sqrt(static_cast<double>(squares[at % 8]));
    if (by_distance_) reason.distance_limit = farthest(place) + eye_radius_;
    if (by_contribution_) reason.radius_limit = smallest(place);
    return reason;
}

bool SizeLimits::drops(uint32_t place) const {
    if (!inUse()) return false;
    SIGHTLINE_DEBUG_ASSERT(place < state_->placed.size() && state_->bvh.order[place] != PlacedBvh::kNone);
    const uint32_t at = state_->bvh.slot[state_->bvh.order[place]];
    const EyeBoxes boxes = eyeBoxes(state_->bvh.nodes[at / 8], offset_);
    const uint32_t bit = 1u << at % 8;
    return (far(at / 8, boxes, bit) | small(at / 8, boxes, bit)) != 0;
}

void LastShown::mark(std::span<const Visible> last, bool wanted) {
    SIGHTLINE_DEBUG_ASSERT(!marked_);
    marked_ = wanted;
    if (!wanted) return;
    uint32_t end = 1;  // not empty, even where nothing was shown
    for (const Visible& object : last) end = std::max(end, object.id.index + 1);
    if (generation_.size() < end) generation_.resize(end, 0);
    for (const Visible& object : last) generation_[object.id.index] = object.id.generation;
}

void LastShown::unmark(std::span<const Visible> last) {
    if (!marked_) return;
    marked_ = false;
    for (const Visible& object : last) {
        SIGHTLINE_DEBUG_ASSERT(generation_[object.id.index] == object.id.generation);
        generation_[object.id.index] = 0;
    }
}

}  // namespace sightline::detail
