// What an exact z-buffer shows of an occlusion scene: which boxes have a sample in sight, and the plain box test on it.
// SPDX-License-Identifier: MIT
#include "bench/occlusion_truth.h"

#include <algorithm>

#include "sightline/base/random.h"

namespace sightline::bench {
namespace {

constexpr uint32_t kCorners[36] = {0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4,
                                   2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5};
constexpr uint8_t kNeverWrites[12] = {};

std::vector<DrawItem> batchItems(const OcclusionScene& scene, std::span<const uint32_t> batches) {
    std::vector<DrawItem> items;
    items.reserve(batches.size());
    for (uint32_t batch : batches) items.emplace_back().mesh = scene.batches[batch].mesh();
    return items;
}

}  // namespace

std::vector<uint8_t> boxesInSight(const OcclusionScene& scene, std::span<const uint32_t> batches,
                                  std::span<const uint32_t> boxes, const View& view, const BoxTruthSettings& settings) {
    std::vector<glm::vec3> corners;
    corners.reserve(8 * boxes.size());
    for (uint32_t number : boxes) {
        const Box3f& box = scene.boxes[number];
        for (int k = 0; k < 8; ++k)
            corners.emplace_back(k & 1 ? box.max.x : box.min.x, k & 2 ? box.max.y : box.min.y,
                                 k & 4 ? box.max.z : box.min.z);
    }
    std::vector<DrawItem> items = batchItems(scene, batches);  // id 0: what hides
    for (size_t i = 0; i < boxes.size(); ++i) {
        DrawItem& item = items.emplace_back();
        item.mesh = {std::span(corners).subspan(8 * i, 8), kCorners};
        item.writes_depth = kNeverWrites;
        item.id = static_cast<uint32_t>(i) + 1;
    }
    std::vector<uint8_t> in_sight(boxes.size(), 0);
    Random random(settings.seed);
    const uint64_t width = uint64_t{view.width} * settings.supersampling;
    const uint64_t height = uint64_t{view.height} * settings.supersampling;
    for (uint32_t picture = 0; picture < settings.jitters; ++picture) {
        ZBufferSettings pass;
        pass.samples = settings.supersampling;
        pass.want_generated = false;
        pass.offset.x = random.uniform(-0.5, 0.5) / settings.supersampling;
        pass.offset.y = random.uniform(-0.5, 0.5) / settings.supersampling;
        pass.row_count = static_cast<uint32_t>(std::clamp<uint64_t>(settings.band_samples / width, 1, height));
        for (uint64_t row = 0; row < height; row += pass.row_count) {
            pass.first_row = static_cast<uint32_t>(row);
            const ZBufferImage image = renderZBuffer(items, view, pass);
            for (size_t i = 0; i < boxes.size(); ++i) in_sight[i] |= image.seen[i + 1];
        }
    }
    return in_sight;
}

ZBufferImage drawBatches(const OcclusionScene& scene, std::span<const uint32_t> batches, const View& view) {
    ZBufferSettings settings;
    settings.want_generated = false;
    return renderZBuffer(batchItems(scene, batches), view, settings);
}

bool isBehind(const ZBufferImage& image, const PixelRect& rect) {
    for (int32_t y = rect.y0; y <= rect.y1; ++y)
        for (int32_t x = rect.x0; x <= rect.x1; ++x)
            if (!(image.depth[static_cast<size_t>(y) * image.width + static_cast<size_t>(x)] > rect.nearness))
                return false;
    return true;
}

}  // namespace sightline::bench
