// How items are shared out among the eight children of a node, for all that build such nodes.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
// Ibrahim Kamel, Christos Faloutsos. On Packing R-trees. 1993.
#include "sightline/tree/bvh_split.h"

#include <algorithm>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/math/curves.h"
#include "sightline/tree/bvh_node.h"

namespace sightline {
namespace {

constexpr int kBins = 16;
constexpr float kFarthest = std::numeric_limits<float>::max() / 4;

/// The scale of a width near the smallest float is infinite, and nothing times that is no number.
int binOf(float center, float low, float scale) {
    const float bin = (center - low) * scale;
    if (bin >= kBins - 1) return kBins - 1;
    return bin > 0 ? static_cast<int>(bin) : 0;
}

}  // namespace

glm::vec3 splitCenter(const Box3f& box) {
    glm::vec3 center = box.center();
    for (int axis = 0; axis < 3; ++axis) {
        float& c = center[axis];
        if (!(c >= -kFarthest)) c = -kFarthest;
        if (c > kFarthest) c = kFarthest;
    }
    return center;
}

Box3f BvhSplitter::boundsOf(uint32_t first, uint32_t last) const {
    SIGHTLINE_DEBUG_ASSERT(first <= last && last <= order.size());
    Box3f box;
    for (uint32_t i = first; i < last; ++i) box.grow(boxes[order[i]]);
    return box;
}

/// Splits small ranges so that the nodes below are full: a multiple of eight goes to the left.
uint32_t BvhSplitter::middleOf(const BvhRange& range) const {
    SIGHTLINE_DEBUG_ASSERT(range.count() > 1);
    const uint32_t half = range.count() / 2;
    return range.first + (range.count() > kWidth ? std::max(8u, (half + 4) / 8 * 8) : half);
}

void BvhSplitter::split(const BvhRange& range, BvhRange& left, BvhRange& right) {
    SIGHTLINE_DEBUG_ASSERT(range.last <= order.size() && range.count() > 1);
    SIGHTLINE_DEBUG_ASSERT(boxes.size() == centers.size());
    Box3f extent;
    for (uint32_t i = range.first; i < range.last; ++i) extent.grow(centers[order[i]]);
    if (range.count() > 64 && splitByBins(range, extent, left, right)) return;
    const uint32_t middle = splitAtMedian(range, extent);
    left = {range.first, middle, boundsOf(range.first, middle)};
    right = {middle, range.last, boundsOf(middle, range.last)};
}

uint32_t BvhSplitter::splitAtMedian(const BvhRange& range, const Box3f& extent) {
    const glm::vec3 size = extent.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = middleOf(range);
    SIGHTLINE_DEBUG_ASSERT(range.first < middle && middle < range.last);
    std::nth_element(order.begin() + range.first, order.begin() + middle, order.begin() + range.last,
                     [&](uint32_t a, uint32_t b) {
                         const float ca = centers[a][axis], cb = centers[b][axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    return middle;
}

/// False: no bins divide the range.
bool BvhSplitter::splitByBins(const BvhRange& range, const Box3f& extent, BvhRange& left, BvhRange& right) {
    struct Bins {
        Box3f boxes[kBins];
        uint32_t counts[kBins] = {};
    };
    Bins bins[3];
    const glm::vec3 size = extent.size();
    const glm::vec3 scale(kBins / size.x, kBins / size.y, kBins / size.z);
    for (uint32_t i = range.first; i < range.last; ++i) {
        const Box3f& box = boxes[order[i]];
        const glm::vec3& center = centers[order[i]];
        for (int axis = 0; axis < 3; ++axis) {
            if (!(size[axis] > 0.0f)) continue;
            const int bin = binOf(center[axis], extent.min[axis], scale[axis]);
            bins[axis].boxes[bin].grow(box);
            ++bins[axis].counts[bin];
        }
    }
    float best_cost = std::numeric_limits<float>::infinity();
    int best_axis = -1, best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        if (!(size[axis] > 0.0f)) continue;
        Box3f behind[kBins], box;  // of the bins from one on
        float right_cost[kBins];
        uint32_t count = 0;
        for (int bin = kBins - 1; bin > 0; --bin) {
            box.grow(bins[axis].boxes[bin]);
            behind[bin] = box;
            count += bins[axis].counts[bin];
            right_cost[bin] = halfArea(box) * static_cast<float>(count);
        }
        box = Box3f();
        count = 0;
        for (int bin = 0; bin + 1 < kBins; ++bin) {
            box.grow(bins[axis].boxes[bin]);
            count += bins[axis].counts[bin];
            const float cost = halfArea(box) * static_cast<float>(count) + right_cost[bin + 1];
            if (count == 0 || count == range.count() || !(cost < best_cost)) continue;
            best_cost = cost;
            best_axis = axis;
            best_bin = bin;
            left.bounds = box;
            right.bounds = behind[bin + 1];
        }
    }
    if (best_axis < 0) return false;
    const auto middle = std::partition(order.begin() + range.first, order.begin() + range.last, [&](uint32_t i) {
        return binOf(centers[i][best_axis], extent.min[best_axis], scale[best_axis]) <= best_bin;
    });
    left.first = range.first;
    left.last = right.first = static_cast<uint32_t>(middle - order.begin());
    right.last = range.last;
    SIGHTLINE_DEBUG_ASSERT(left.first < left.last && right.first < right.last);
    return true;
}

int BvhSplitter::splitToEight(const BvhRange& range, BvhRange (&parts)[kWidth]) {
    SIGHTLINE_DEBUG_ASSERT(range.first < range.last && range.last <= order.size());
    const uint32_t whole = range.count() > kWidth ? kWidth : 1;
    int count = 1;
    parts[0] = range;
    while (count < kWidth) {
        int widest = -1;
        float widest_cost = -1.0f;
        for (int i = 0; i < count; ++i) {
            const float cost = halfArea(parts[i].bounds) * static_cast<float>(parts[i].count());
            // Where areas overflow to no number, too, something must be split.
            if (parts[i].count() > whole && !(cost <= widest_cost)) {
                widest = i;
                widest_cost = cost;
            }
        }
        if (widest < 0) break;
        BvhRange left, right;
        split(parts[widest], left, right);
        parts[widest] = left;
        parts[count++] = right;
    }
    return count;
}

void BvhSplitter::sortAlongCurve() {
    SIGHTLINE_DEBUG_ASSERT(centers.size() >= order.size());
    Box3f around;
    for (const uint32_t item : order) around.grow(centers[item]);
    const glm::vec3 size = around.size();
    const float side = std::max({size.x, size.y, size.z}), scale = side > 0 ? 1023.0f / side : 0.0f;
    Array<uint64_t> coded(order.memory());
    coded.reserve(order.size());
    const auto cell = [](float at) { return static_cast<uint32_t>(std::clamp(at, 0.0f, 1023.0f)); };
    for (const uint32_t item : order) {
        const glm::vec3 at = (centers[item] - around.min) * scale;
        coded.push_back(uint64_t{hilbertCode(cell(at.x), cell(at.y), cell(at.z))} << 32 | item);
    }
    std::sort(coded.begin(), coded.end());
    for (size_t i = 0; i < coded.size(); ++i) order[i] = static_cast<uint32_t>(coded[i]);
}

int BvhSplitter::cutToEight(const BvhRange& range, BvhRange (&parts)[kWidth]) const {
    SIGHTLINE_DEBUG_ASSERT(range.first < range.last && range.last <= order.size());
    constexpr uint32_t kFill = 6;
    uint32_t size = range.count() <= kFill ? 1 : kFill;
    while (range.count() > kWidth * uint64_t{size}) size *= kWidth;
    int count = 0;
    for (uint32_t first = range.first; first < range.last; ++count) {
        SIGHTLINE_DEBUG_ASSERT(count < kWidth);
        const uint32_t last = first + std::min(size, range.last - first);
        parts[count] = {first, last, boundsOf(first, last)};
        first = last;
    }
    return count;
}

}  // namespace sightline
