// A world's boxes as flat arrays: what a renderer without a hierarchy culls.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

#include "sightline/cull/frustum.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tree/world_bvh.h"

namespace sightline::bench {
using namespace tools;

struct FlatBoxes {
    std::vector<float> bounds[6];  ///< min x, y, z, max x, y, z, each padded to 16
    std::vector<uint32_t> kept;    ///< room for an answer
    BoxArrays arrays;

    explicit FlatBoxes(const std::vector<Box3d>& boxes) {
        const size_t padded = (boxes.size() + 15) / 16 * 16;
        Box3d world;
        for (const Box3d& box : boxes) world.grow(box);
        arrays.origin = boxes.empty() ? glm::dvec3(0.0) : world.center();
        arrays.count = boxes.size();
        for (auto& bound : bounds) bound.assign(padded, 0.0f);
        kept.resize(padded);
        for (size_t i = 0; i < boxes.size(); ++i) {
            const Box3f box = roundOutward(boxes[i], arrays.origin);
            for (int axis = 0; axis < 3; ++axis) {
                bounds[axis][i] = box.min[axis];
                bounds[3 + axis][i] = box.max[axis];
                arrays.reach = std::max(arrays.reach, std::max(std::abs(box.min[axis]), std::abs(box.max[axis])));
            }
        }
        for (int axis = 0; axis < 3; ++axis) {
            arrays.min[axis] = bounds[axis].data();
            arrays.max[axis] = bounds[3 + axis].data();
        }
    }
    FlatBoxes(const FlatBoxes&) = delete;  // the arrays point into this object
};

/// A world's tree over boxes, by their places in the list.
inline WorldBvh treeOver(const std::vector<Box3d>& boxes) {
    std::vector<uint32_t> items(boxes.size());
    std::iota(items.begin(), items.end(), 0u);
    WorldBvh tree;
    tree.build(boxes, items);
    return tree;
}

inline std::vector<Box3d> objectBoxes(const Scene& scene) {
    std::vector<Box3d> boxes;
    boxes.reserve(scene.objects.size());
    for (const SceneObject& object : scene.objects)
        boxes.push_back(transformBox(scene.meshes[object.mesh].bounds, object.transform));
    return boxes;
}

}  // namespace sightline::bench
