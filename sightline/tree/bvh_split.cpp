// How items are shared out among the eight children of a node, for all that build such nodes.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
#include "sightline/tree/bvh_split.h"

#include <algorithm>
#include <limits>

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
    Box3f box;
    for (uint32_t i = first; i < last; ++i) box.grow(boxes[order[i]]);
    return box;
}

/// Splits small ranges so that the nodes below are full: a multiple of eight goes to the left.
uint32_t BvhSplitter::middleOf(const BvhRange& range) const {
    const uint32_t half = range.count() / 2;
    return range.first + (range.count() > kWidth ? std::max(8u, (half + 4) / 8 * 8) : half);
}

void BvhSplitter::split(const BvhRange& range, BvhRange& left, BvhRange& right) {
    Box3f extent;
    for (uint32_t i = range.first; i < range.last; ++i) extent.grow(centers[order[i]]);
    const uint32_t middle = range.count() <= 64 ? splitAtMedian(range, extent) : splitByBins(range, extent);
    left = {range.first, middle, boundsOf(range.first, middle)};
    right = {middle, range.last, boundsOf(middle, range.last)};
}

uint32_t BvhSplitter::splitAtMedian(const BvhRange& range, const Box3f& extent) {
    const glm::vec3 size = extent.size();
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = middleOf(range);
    std::nth_element(order.begin() + range.first, order.begin() + middle, order.begin() + range.last,
                     [&](uint32_t a, uint32_t b) {
                         const float ca = centers[a][axis], cb = centers[b][axis];
                         return ca != cb ? ca < cb : a < b;
                     });
    return middle;
}

uint32_t BvhSplitter::splitByBins(const BvhRange& range, const Box3f& extent) {
    float best_cost = std::numeric_limits<float>::infinity();
    int best_axis = -1, best_bin = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float low = extent.min[axis], width = extent.max[axis] - low;
        if (!(width > 0.0f)) continue;
        const float scale = kBins / width;
        Box3f bins[kBins];
        uint32_t counts[kBins] = {};
        for (uint32_t i = range.first; i < range.last; ++i) {
            const int bin = binOf(centers[order[i]][axis], low, scale);
            bins[bin].grow(boxes[order[i]]);
            ++counts[bin];
        }
        float right_cost[kBins];
        Box3f box;
        uint32_t count = 0;
        for (int bin = kBins - 1; bin > 0; --bin) {
            box.grow(bins[bin]);
            count += counts[bin];
            right_cost[bin] = halfArea(box) * static_cast<float>(count);
        }
        box = Box3f();
        count = 0;
        for (int bin = 0; bin + 1 < kBins; ++bin) {
            box.grow(bins[bin]);
            count += counts[bin];
            const float cost = halfArea(box) * static_cast<float>(count) + right_cost[bin + 1];
            if (count > 0 && count < range.count() && cost < best_cost) {
                best_cost = cost;
                best_axis = axis;
                best_bin = bin;
            }
        }
    }
    if (best_axis < 0) return splitAtMedian(range, extent);
    const float low = extent.min[best_axis], scale = kBins / (extent.max[best_axis] - low);
    const auto middle = std::partition(order.begin() + range.first, order.begin() + range.last, [&](uint32_t i) {
        return binOf(centers[i][best_axis], low, scale) <= best_bin;
    });
    return static_cast<uint32_t>(middle - order.begin());
}

int BvhSplitter::splitToEight(const BvhRange& range, BvhRange (&parts)[kWidth]) {
    const uint32_t whole = full_nodes && range.count() > kWidth ? kWidth : 1;
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

}  // namespace sightline
