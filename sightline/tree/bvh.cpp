// A bounding volume hierarchy of eight-wide nodes over boxes that stay where they are.
// SPDX-License-Identifier: MIT
//
// Ingo Wald. On fast Construction of SAH-based Bounding Volume Hierarchies. 2007.
#include "sightline/tree/bvh.h"

#include "sightline/base/assert.h"
#include "sightline/math/round_outward.h"
#include "sightline/tree/bvh_node.h"
#include "sightline/tree/bvh_split.h"

namespace sightline {
namespace {

constexpr int kWidth = BvhSplitter::kWidth;

}  // namespace

Box3f roundOutward(const Box3d& box, const glm::dvec3& origin) { return relativeBox(box, origin); }

Bvh buildBvh(std::span<const Box3d> boxes, Memory* memory) {
    Bvh bvh(memory);
    const uint32_t count = static_cast<uint32_t>(boxes.size());
    if (count == 0) return bvh;
    Box3d world;
    for (const Box3d& box : boxes) {
        SIGHTLINE_DEBUG_ASSERT(box.finite() && !box.empty());
        world.grow(box);
    }
    bvh.origin = world.center();
    bvh.order.resize(count);
    BvhSplitter builder(bvh.order, memory);
    builder.boxes.resize(count);
    builder.centers.resize(count);
    for (uint32_t i = 0; i < count; ++i) {
        bvh.order[i] = i;
        builder.boxes[i] = roundOutward(boxes[i], bvh.origin);
        builder.centers[i] = splitCenter(builder.boxes[i]);
    }
    struct Job {
        BvhRange range;
        uint32_t parent;
    };
    Array<Job> jobs({{{0, count, builder.boundsOf(0, count)}, ~0u}}, memory);
    bvh.nodes.reserve(count / 4 + 1);
    while (!jobs.empty()) {
        const Job job = jobs.back();
        jobs.pop_back();
        const uint32_t index = static_cast<uint32_t>(bvh.nodes.size());
        bvh.nodes.push_back(emptyNode());
        if (job.parent != ~0u) bvh.nodes[job.parent / kWidth].child[job.parent % kWidth] = index;
        BvhRange parts[kWidth];
        const int used = builder.splitToEight(job.range, parts);
        SIGHTLINE_DEBUG_ASSERT(used > 0 && used <= kWidth);
        for (int slot = used - 1; slot >= 0; --slot) {
            BvhNode& node = bvh.nodes[index];
            setSlot(node, slot, parts[slot].bounds);
            node.first[slot] = parts[slot].first;
            node.count[slot] = parts[slot].count();
            SIGHTLINE_DEBUG_ASSERT(node.count[slot] > 0);
            if (parts[slot].count() == 1) node.child[slot] = BvhNode::kLeaf | parts[slot].first;
            else jobs.push_back({parts[slot], index * kWidth + static_cast<uint32_t>(slot)});
        }
    }
    return bvh;
}

}  // namespace sightline
