// One frame of an occlusion scene, step by step: what is in view, drawing front to back, asking the boxes.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_frame.h"

#include <algorithm>
#include <limits>
#include <numeric>

#include "sightline/math/curves.h"
#include "sightline/prepare/occluder/occluder.h"

namespace sightline::bench {
namespace {

std::vector<Box3d> inDouble(std::span<const Box3f> boxes) {
    std::vector<Box3d> out;
    out.reserve(boxes.size());
    for (const Box3f& box : boxes) {
        Box3d& wide = out.emplace_back();
        wide.min = box.min;
        wide.max = box.max;
    }
    return out;
}

std::vector<Box3f> batchBounds(const OcclusionScene& scene) {
    std::vector<Box3f> bounds;
    for (const OccluderBatch& batch : scene.batches) bounds.push_back(batch.bounds);
    return bounds;
}

std::vector<Box3d> inOrder(const OcclusionScene& scene, std::span<const uint32_t> order) {
    std::vector<Box3f> boxes;
    for (uint32_t box : order) boxes.push_back(scene.boxes[box]);
    return inDouble(boxes);
}

/// Boxes eight by eight; unused places stay inverted.
std::vector<BvhNode> inEights(std::span<const Box3f> boxes) {
    std::vector<BvhNode> nodes((boxes.size() + 7) / 8);
    for (BvhNode& node : nodes) {
        std::fill_n(&node.min[0][0], 24, std::numeric_limits<float>::infinity());
        std::fill_n(&node.max[0][0], 24, -std::numeric_limits<float>::infinity());
        std::fill_n(node.count, 8, 0u);
    }
    for (size_t i = 0; i < boxes.size(); ++i) {
        BvhNode& node = nodes[i / 8];
        node.count[i % 8] = 1;
        for (int axis = 0; axis < 3; ++axis) {
            node.min[axis][i % 8] = boxes[i].min[axis];
            node.max[axis][i % 8] = boxes[i].max[axis];
        }
    }
    return nodes;
}

}  // namespace

std::vector<uint32_t> mortonOrder(std::span<const Box3f> boxes) {
    Box3d all;
    for (const Box3f& box : boxes) all.grow({glm::dvec3(box.min), glm::dvec3(box.max)});
    const glm::dvec3 size = all.size();
    all.max = all.min + std::max({size.x, size.y, size.z});
    std::vector<uint64_t> codes;
    codes.reserve(boxes.size());
    for (const Box3f& box : boxes) codes.push_back(mortonCode(glm::dvec3(box.center()), all));
    std::vector<uint32_t> order(boxes.size());
    std::iota(order.begin(), order.end(), 0u);
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) { return codes[a] < codes[b]; });
    return order;
}

OcclusionFrame::OcclusionFrame(const OcclusionScene& scene)
    : scene_(scene),
      morton_(mortonOrder(scene.boxes)),
      flat_batches_(inDouble(batchBounds(scene))),
      flat_boxes_(inOrder(scene, morton_)) {
    std::vector<OccluderSource> sources;
    for (const OccluderBatch& batch : scene.batches) sources.push_back({batch.mesh(), {}, {}});
    OccluderSettings settings{.rings = scene.batches_are != BatchesAre::kApart};
    if (scene.batches_are == BatchesAre::kPanels) occluders_.push_back(prepareJoined(sources, settings));
    else if (scene.batches_are == BatchesAre::kOneSurface) occluders_ = prepareOccluders(sources, settings);
    else
        for (const OccluderSource& source : sources) occluders_.push_back(prepareOccluder(source.mesh));
    for (const Occluder& occluder : occluders_) {
        own_bounds_.emplace_back();
        for (const OccluderCluster& cluster : occluder.clusters) own_bounds_.back().grow(cluster.bounds);
    }
}

void OcclusionFrame::begin(const View& view, uint32_t occlusion_size) {
    screen_ = makeScreen(view, occlusion_size);
    const Frustum frustum = makeFrustum(view);
    const size_t batches = cullFrustum(frustum, flat_batches_.arrays, flat_batches_.kept);
    batches_.assign(flat_batches_.kept.begin(), flat_batches_.kept.begin() + static_cast<std::ptrdiff_t>(batches));
    const glm::dvec3 eye = eyePosition(view);
    std::vector<double> distance(scene_.batches.size());
    triangles_ = 0;
    for (uint32_t batch : batches_) {
        const Box3f& box = scene_.batches[batch].bounds;
        const glm::dvec3 nearest = glm::clamp(eye, glm::dvec3(box.min), glm::dvec3(box.max));
        distance[batch] = glm::length(nearest - eye);
        triangles_ += scene_.batches[batch].indices.size() / 3;
    }
    std::stable_sort(batches_.begin(), batches_.end(),
                     [&](uint32_t a, uint32_t b) { return distance[a] < distance[b]; });

    if (occluders_.size() < scene_.batches.size()) drawn_.assign(1, 0);
    else drawn_ = batches_;
    std::vector<Box3f> own;
    for (uint32_t occluder : drawn_) own.push_back(own_bounds_[occluder]);
    drawn_eights_ = inEights(own);

    const size_t boxes = cullFrustum(frustum, flat_boxes_.arrays, flat_boxes_.kept);
    boxes_.clear();
    std::vector<Box3f> members, groups;
    for (size_t i = 0; i < boxes; ++i) {
        boxes_.push_back(morton_[flat_boxes_.kept[i]]);
        members.push_back(scene_.boxes[boxes_.back()]);
        if (i % kGroup == 0) groups.emplace_back();
        groups.back().grow(members.back());
    }
    eights_ = inEights(members);
    groups_ = inEights(groups);
}

uint64_t OcclusionFrame::rasterize(DepthTiles& tiles, SelfTest self_test, OcclusionDetail detail) const {
    tiles.clear(screen_.width, screen_.height, detail);
    uint64_t offered = 0;
    const auto covered = [&](const BoxAnswer& box) {
        return self_test == SelfTest::kYes && !box.doubt && isHidden(tiles, box.rect, Seams::kLeave);
    };
    for (size_t i = 0; i < drawn_.size(); i += 8) {
        const ScreenAnswer own = projectBoxes(screen_, eyeBoxes(drawn_eights_[i / 8], -screen_.eye));
        for (size_t k = 0; k < 8 && i + k < drawn_.size(); ++k) {
            if (own.outside >> k & 1) continue;
            if (covered(BoxAnswer(own, static_cast<int>(k)))) continue;
            const Occluder& occluder = occluders_[drawn_[i + k]];
            const OccluderInstance instance = makeOccluderInstance(screen_, occluder, identity_);
            const uint32_t clusters = static_cast<uint32_t>(occluder.clusters.size());
            ScreenAnswer eight;
            for (uint32_t cluster = 0; cluster < clusters; ++cluster) {
                if (cluster % 8 == 0) eight = projectClusters(instance.screen, occluder, cluster);
                const BoxAnswer box(eight, static_cast<int>(cluster % 8));
                if (box.outside || (occluder.clusters.size() > 1 && covered(box))) continue;
                offered += drawOccluder(tiles, instance, cluster, box);
            }
        }
    }
    return offered;
}

void OcclusionFrame::testEight(DepthTiles& tiles, const BvhNode& boxes, size_t first, std::span<uint8_t> hidden) const {
    const ScreenAnswer answer = projectBoxes(screen_, eyeBoxes(boxes, -screen_.eye));
    for (size_t i = 0; i < 8 && first + i < hidden.size(); ++i) {
        if (answer.doubt >> i & 1) hidden[first + i] = 0;
        else hidden[first + i] = (answer.outside >> i & 1) || isHidden(tiles, answer.rects[i]);
    }
}

std::vector<BoxAnswer> OcclusionFrame::project() const {
    std::vector<BoxAnswer> out(boxes_.size());
    for (size_t i = 0; i < out.size(); i += 8) {
        const ScreenAnswer answer = projectBoxes(screen_, eyeBoxes(eights_[i / 8], -screen_.eye));
        for (size_t k = 0; k < 8 && i + k < out.size(); ++k) out[i + k] = BoxAnswer(answer, static_cast<int>(k));
    }
    return out;
}

void OcclusionFrame::testFlat(DepthTiles& tiles, std::span<uint8_t> hidden) const {
    for (size_t i = 0; i < eights_.size(); ++i) testEight(tiles, eights_[i], 8 * i, hidden);
}

void OcclusionFrame::testGrouped(DepthTiles& tiles, std::span<uint8_t> hidden) const {
    for (size_t i = 0; i < groups_.size(); ++i) {
        const ScreenAnswer answer = projectBoxes(screen_, eyeBoxes(groups_[i], -screen_.eye));
        for (size_t k = 0; k < 8; ++k) {
            const size_t first = (8 * i + k) * kGroup, last = std::min(first + kGroup, hidden.size());
            if (first >= hidden.size()) return;
            const bool all = !(answer.doubt >> k & 1) &&
                             ((answer.outside >> k & 1) || isHidden(tiles, answer.rects[k], Seams::kLeave));
            if (all) {
                std::fill(hidden.begin() + static_cast<std::ptrdiff_t>(first),
                          hidden.begin() + static_cast<std::ptrdiff_t>(last), uint8_t{1});
                continue;
            }
            for (size_t eight = first / 8; 8 * eight < last; ++eight)
                testEight(tiles, eights_[eight], 8 * eight, hidden);
        }
    }
}

}  // namespace sightline::bench
