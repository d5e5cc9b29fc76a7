// A bounding volume hierarchy of eight-wide nodes over boxes that move now and then.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
#include "sightline/space/bvh.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr int kBins = 16;
constexpr int kWidth = 8;
constexpr float kFarthest = std::numeric_limits<float>::max() / 4;

/// Kept where differences are finite and an order holds: boxes may reach beyond float.
glm::vec3 centerOf(const Box3f& box) {
    glm::vec3 center = box.center();
    for (int axis = 0; axis < 3; ++axis) {
        float& c = center[axis];
        if (!(c >= -kFarthest)) c = -kFarthest;
        if (c > kFarthest) c = kFarthest;
    }
    return center;
}

float area(const Box3f& box) {
    if (box.empty()) return 0.0f;
    const glm::vec3 s = box.size();
    return s.x * s.y + s.y * s.z + s.z * s.x;
}

float roundDown(double value) {
    const float f = static_cast<float>(value);
    return f > value ? std::nextafter(f, -std::numeric_limits<float>::infinity()) : f;
}

float roundUp(double value) {
    const float f = static_cast<float>(value);
    return f < value ? std::nextafter(f, std::numeric_limits<float>::infinity()) : f;
}

struct Range {
    uint32_t first = 0, last = 0;
    Box3f bounds;
    uint32_t count() const { return last - first; }
};

struct Builder {
    Array<Box3f> boxes;
    Array<glm::vec3> centers;
    Array<uint32_t>& order;

    Box3f boundsOf(uint32_t first, uint32_t last) const {
        Box3f box;
        for (uint32_t i = first; i < last; ++i) box.grow(boxes[order[i]]);
        return box;
    }

    /// Splits small ranges so that the nodes below are full: a multiple of eight goes to the left.
    uint32_t middleOf(const Range& range) const {
        const uint32_t half = range.count() / 2;
        return range.first + (range.count() > kWidth ? std::max(8u, (half + 4) / 8 * 8) : half);
    }

    void split(const Range& range, Range& left, Range& right) {
        Box3f extent;
        for (uint32_t i = range.first; i < range.last; ++i) extent.grow(centers[order[i]]);
        const uint32_t middle = range.count() <= 64 ? splitAtMedian(range, extent) : splitByBins(range, extent);
        left = {range.first, middle, boundsOf(range.first, middle)};
        right = {middle, range.last, boundsOf(middle, range.last)};
    }

    uint32_t splitAtMedian(const Range& range, const Box3f& extent) {
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

    uint32_t splitByBins(const Range& range, const Box3f& extent) {
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
                right_cost[bin] = area(box) * static_cast<float>(count);
            }
            box = Box3f();
            count = 0;
            for (int bin = 0; bin + 1 < kBins; ++bin) {
                box.grow(bins[bin]);
                count += counts[bin];
                const float cost = area(box) * static_cast<float>(count) + right_cost[bin + 1];
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

    /// The scale of a width near the smallest float is infinite, and nothing times that is no number.
    static int binOf(float center, float low, float scale) {
        const float bin = (center - low) * scale;
        if (bin >= kBins - 1) return kBins - 1;
        return bin > 0 ? static_cast<int>(bin) : 0;
    }
};

void setSlot(BvhNode& node, int slot, const Box3f& box) {
    for (int axis = 0; axis < 3; ++axis) {
        node.min[axis][slot] = box.min[axis];
        node.max[axis][slot] = box.max[axis];
    }
}

BvhNode emptyNode() {
    BvhNode node{};
    for (int slot = 0; slot < kWidth; ++slot) setSlot(node, slot, Box3f());
    return node;
}

Box3f boundsOf(const BvhNode& node) {
    Box3f box;
    for (int slot = 0; slot < kWidth; ++slot)
        if (node.count[slot])
            for (int axis = 0; axis < 3; ++axis) {
                box.min[axis] = std::min(box.min[axis], node.min[axis][slot]);
                box.max[axis] = std::max(box.max[axis], node.max[axis][slot]);
            }
    return box;
}

/// Splits a range into at most eight, the one of largest surface times count first.
int splitToEight(Builder& builder, const Range& range, Range (&parts)[kWidth]) {
    int count = 1;
    parts[0] = range;
    while (count < kWidth) {
        int widest = -1;
        float widest_cost = -1.0f;
        for (int i = 0; i < count; ++i) {
            const float cost = area(parts[i].bounds) * static_cast<float>(parts[i].count());
            // Where areas overflow to no number, too, something must be split.
            if (parts[i].count() > 1 && !(cost <= widest_cost)) {
                widest = i;
                widest_cost = cost;
            }
        }
        if (widest < 0) break;
        Range left, right;
        builder.split(parts[widest], left, right);
        parts[widest] = left;
        parts[count++] = right;
    }
    return count;
}

}  // namespace

Box3f roundOutward(const Box3d& box, const glm::dvec3& origin) {
    Box3f out;
    for (int axis = 0; axis < 3; ++axis) {
        // The subtraction itself rounds: step past it in double before rounding to float.
        const double low = box.min[axis] - origin[axis], high = box.max[axis] - origin[axis];
        out.min[axis] = roundDown(low - std::abs(low) * 0x1p-52);
        out.max[axis] = roundUp(high + std::abs(high) * 0x1p-52);
    }
    return out;
}

Bvh buildBvh(std::span<const Box3d> boxes, Memory* memory) {
    Bvh bvh(memory);
    const uint32_t count = static_cast<uint32_t>(boxes.size());
    if (count == 0) return bvh;
    Box3d world;
    for (const Box3d& box : boxes) world.grow(box);
    bvh.origin = world.center();
    bvh.order.resize(count);
    bvh.slot.resize(count);
    Builder builder{Array<Box3f>(memory), Array<glm::vec3>(memory), bvh.order};
    builder.boxes.resize(count);
    builder.centers.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
        bvh.order[i] = i;
        builder.boxes[i] = roundOutward(boxes[i], bvh.origin);
        builder.centers[i] = centerOf(builder.boxes[i]);
    }
    struct Job {
        Range range;
        uint32_t parent;
    };
    Array<Job> jobs({{{0, count, builder.boundsOf(0, count)}, ~0u}}, memory);
    bvh.nodes.reserve(count / 4 + 1);
    while (!jobs.empty()) {
        const Job job = jobs.back();
        jobs.pop_back();
        const uint32_t index = static_cast<uint32_t>(bvh.nodes.size());
        bvh.nodes.push_back(emptyNode());
        bvh.parent.push_back(job.parent);
        if (job.parent != ~0u) bvh.nodes[job.parent / kWidth].child[job.parent % kWidth] = index;
        Range parts[kWidth];
        const int used = splitToEight(builder, job.range, parts);
        for (int slot = used - 1; slot >= 0; --slot) {
            BvhNode& node = bvh.nodes[index];
            setSlot(node, slot, parts[slot].bounds);
            node.first[slot] = parts[slot].first;
            node.count[slot] = parts[slot].count();
            const uint32_t place = index * kWidth + static_cast<uint32_t>(slot);
            if (parts[slot].count() == 1) {
                node.child[slot] = BvhNode::kLeaf | parts[slot].first;
                bvh.slot[bvh.order[parts[slot].first]] = place;
            } else {
                jobs.push_back({parts[slot], place});
            }
        }
    }
    bvh.built_cost = surfaceCost(bvh);
    return bvh;
}

void refit(Bvh& bvh, uint32_t item, const Box3d& box) {
    uint32_t place = bvh.slot[item];
    Box3f bounds = roundOutward(box, bvh.origin);
    while (place != ~0u) {
        BvhNode& node = bvh.nodes[place / kWidth];
        setSlot(node, static_cast<int>(place % kWidth), bounds);
        bounds = boundsOf(node);
        place = bvh.parent[place / kWidth];
    }
}

double surfaceCost(const Bvh& bvh) {
    if (bvh.nodes.empty()) return 0.0;
    double sum = 0.0;
    for (const BvhNode& node : bvh.nodes) sum += area(boundsOf(node));
    const double root = area(boundsOf(bvh.nodes[0]));
    return root > 0.0 ? sum / root : static_cast<double>(bvh.nodes.size());
}

}  // namespace sightline
