// The occlusion buffer alone: clusters in, sights out.
// SPDX-License-Identifier: MIT
#include "sightline/cull/occlusion_buffer.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/buffer/ask/occludee_box.h"
#include "sightline/buffer/depth_image.h"
#include "sightline/cull/frustum.h"
#include "sightline/cull/occludee_place.h"
#include "sightline/cull/occlusion.h"

namespace sightline {
namespace {

constexpr double kFloatRounding = 0x1p-23;  // of coordinates that are held in float

Sight sightOf(DepthTiles& tiles, const BoxAnswer& answer, const OccludeeBox& box) {
    if (answer.outside) return Sight::kOutside;
    if (answer.doubt) return Sight::kVisible;
    return isHidden(tiles, answer.rect, Seams::kResolve, &box) ? Sight::kOccluded : Sight::kVisible;
}

}  // namespace

OcclusionBuffer::OcclusionBuffer(uint32_t size, Memory* memory)
    : size_(std::clamp(size, 1u, 8192u)), tiles_(memory), transforms_(memory) {}

ViewProblem OcclusionBuffer::begin(const View& view) {
    const ViewProblem problem = problemOf(view);
    usable_ = problem == ViewProblem::kNone;
    transforms_used_ = 0;
    if (!usable_) {
        // What was drawn may be gone by now, and seams would look at it.
        tiles_.clear(0, 0);
        return problem;
    }
    screen_ = makeScreen(view, size_);
    tiles_.clear(screen_.width, screen_.height);
    return problem;
}

const glm::dmat4& OcclusionBuffer::keep(const glm::dmat4& transform) {
    SIGHTLINE_DEBUG_ASSERT(transforms_used_ <= transforms_.size());
    if (transforms_used_ == transforms_.size()) transforms_.emplace_back();
    return transforms_[transforms_used_++] = transform;
}

uint32_t OcclusionBuffer::draw(const Occluder& occluder, const glm::dmat4& transform) {
    if (!usable_) return 0;
    const OccluderInstance instance = makeOccluderInstance(screen_, occluder, keep(transform));
    const auto clusters = static_cast<uint32_t>(occluder.clusters.size());
    uint32_t triangles = 0;
    for (uint32_t first = 0; first < clusters; first += 8) {
        const ScreenAnswer boxes = projectClusters(instance.screen, occluder, first);
        for (uint32_t i = 0; i < std::min(8u, clusters - first); ++i) {
            const BoxAnswer box(boxes, static_cast<int>(i));
            if (box.outside || (!box.doubt && isHidden(tiles_, box.rect, Seams::kLeave))) continue;
            triangles += drawOccluder(tiles_, instance, first + i, box);
        }
    }
    return triangles;
}

Sight OcclusionBuffer::ask(const Box3d& box) {
    Sight sight = Sight::kVisible;
    ask({&box, 1}, {&sight, 1});
    return sight;
}

void OcclusionBuffer::ask(std::span<const Box3d> boxes, std::span<Sight> answers) {
    SIGHTLINE_ASSERT(answers.size() == boxes.size());
    if (!usable_) {
        std::ranges::fill(answers, Sight::kVisible);
        return;
    }
    for (size_t first = 0; first < boxes.size(); first += 8) {
        const auto count = static_cast<int>(std::min<size_t>(8, boxes.size() - first));
        EyeBoxes near;
        for (int i = 0; i < 8; ++i) {
            const Box3d& box = boxes[first + static_cast<size_t>(std::min(i, count - 1))];
            for (int axis = 0; axis < 3; ++axis) {
                const double eye = screen_.eye[axis], low = box.min[axis], high = box.max[axis];
                const double slack = 0x1p-52 * (std::max(std::abs(low), std::abs(high)) + std::abs(eye));
                near.min[axis][i] = static_cast<float>(low - eye - slack);
                near.max[axis][i] = static_cast<float>(high - eye + slack);
            }
        }
        const ScreenAnswer on_screen = projectBoxes(screen_, near);
        for (int i = 0; i < count; ++i) {
            const Box3f at = boxOf(near, i);
            const OccludeeBox box(screen_, {glm::dvec3(at.min), glm::dvec3(at.max)}, {.rounding = kFloatRounding});
            answers[first + static_cast<size_t>(i)] = sightOf(tiles_, BoxAnswer(on_screen, i), box);
        }
    }
}

Sight OcclusionBuffer::ask(const Box3f& box, const glm::dmat4& transform) {
    if (!usable_) return Sight::kVisible;
    const Box3d bounds{glm::dvec3(box.min), glm::dvec3(box.max)};
    const OccludeePlace place = makeOccludeePlace(screen_, transform, bounds);
    return sightOf(tiles_, projectBox(place.screen, box), boxAt(place, bounds));
}

void OcclusionBuffer::depthImage(std::span<float> nearness, std::span<uint8_t> covered) {
    SIGHTLINE_ASSERT(nearness.size() == size_t{tiles_.width} * tiles_.height);
    readDepthImage(tiles_, Seams::kResolve, nearness, covered);
}

}  // namespace sightline
