// Back faces by the cluster: many clusters' volumes and cones at once, trees of them, and masks of single triangles.
// SPDX-License-Identifier: MIT
#include "sightline/cull/facing_clusters.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cull/answer_bits.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/facing_clusters.cpp"
#include <hwy/foreach_target.h>
#include "sightline/cull/mask_bits-inl.h"

#ifndef SIGHTLINE_CULL_FACING_CLUSTERS_ONCE
#define SIGHTLINE_CULL_FACING_CLUSTERS_ONCE
namespace sightline::detail {

/// The eye relative to the clusters' origin, and what a sum must be away from 0 by to be trusted.
struct ClusterEye {
    float point[3], w, margin;
    bool turned;  ///< clockwise is front: what is seen from the front is seen from the back
};

}  // namespace sightline::detail
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using FloatVec = hn::Vec<FaceLanes>;

struct RowReader {
    const float* numbers;
    size_t stride;

    HWY_INLINE FloatVec operator()(FaceLanes d, int row, size_t i) const {
        return hn::LoadU(d, numbers + static_cast<size_t>(row) * stride + i);
    }
};

/// The eye from the clusters' own origins.
HWY_INLINE void placeEye(FaceLanes d, const RowReader& volume, const detail::ClusterEye& eye, size_t i,
                         FloatVec (&q)[3]) {
    for (int axis = 0; axis < 3; ++axis)
        q[axis] = hn::Sub(hn::Set(d, eye.point[axis]),
                          hn::Mul(hn::Set(d, eye.w), volume(d, FacingClusters::kOrigin + axis, i)));
}

/// The largest and the least n * q of normals in a box.
HWY_INLINE FloatVec mostAlong(FaceLanes d, const RowReader& box, int most, int least, size_t i,
                              const FloatVec (&q)[3]) {
    FloatVec sum = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis)
        sum =
            hn::Add(sum, hn::Max(hn::Mul(box(d, most + axis, i), q[axis]), hn::Mul(box(d, least + axis, i), q[axis])));
    return sum;
}

HWY_INLINE FloatVec leastAlong(FaceLanes d, const RowReader& box, int most, int least, size_t i,
                               const FloatVec (&q)[3]) {
    FloatVec sum = hn::Zero(d);
    for (int axis = 0; axis < 3; ++axis)
        sum =
            hn::Add(sum, hn::Min(hn::Mul(box(d, most + axis, i), q[axis]), hn::Mul(box(d, least + axis, i), q[axis])));
    return sum;
}

void backVolumesKernel(const FacingClusters& clusters, const detail::ClusterEye& eye, uint8_t* back) {
    const FaceLanes d;
    const RowReader volume{clusters.volumes.data(), clusters.stride};
    const auto margin = hn::Set(d, eye.margin), w = hn::Set(d, eye.w);
    storeAnswers(d, clusters.count(), back, [&](size_t i) HWY_ATTR {
        FloatVec q[3];
        placeEye(d, volume, eye, i, q);
        const auto most = mostAlong(d, volume, FacingClusters::kMost, FacingClusters::kLeast, i, q);
        return hn::Lt(hn::Add(most, margin), hn::Mul(w, volume(d, FacingClusters::kBack, i)));
    });
}

void frontVolumesKernel(const FacingClusters& clusters, const detail::ClusterEye& eye, uint8_t* front) {
    const FaceLanes d;
    const RowReader volume{clusters.volumes.data(), clusters.stride};
    const auto margin = hn::Set(d, eye.margin), w = hn::Set(d, eye.w);
    storeAnswers(d, clusters.count(), front, [&](size_t i) HWY_ATTR {
        FloatVec q[3];
        placeEye(d, volume, eye, i, q);
        const auto least = leastAlong(d, volume, FacingClusters::kMost, FacingClusters::kLeast, i, q);
        return hn::Gt(hn::Sub(least, margin), hn::Mul(w, volume(d, FacingClusters::kFront, i)));
    });
}

/// This one and the next add to what others have found.
void turnedKernel(const FacingClusters& clusters, const detail::ClusterEye& eye, uint8_t* back) {
    const FaceLanes d;
    const RowReader volume{clusters.volumes.data(), clusters.stride}, turned{clusters.turned.data(), clusters.stride};
    const auto margin = hn::Set(d, eye.margin), w = hn::Set(d, eye.w);
    storeAnswers<true>(d, clusters.count(), back, [&](size_t i) HWY_ATTR {
        FloatVec q[3], along[3];
        placeEye(d, volume, eye, i, q);
        for (int k = 0; k < 3; ++k) {
            const int row = FacingClusters::kAxes + 3 * k;
            along[k] = hn::Add(hn::Add(hn::Mul(turned(d, row, i), q[0]), hn::Mul(turned(d, row + 1, i), q[1])),
                               hn::Mul(turned(d, row + 2, i), q[2]));
        }
        const auto most = mostAlong(d, turned, FacingClusters::kTurnedMost, FacingClusters::kTurnedLeast, i, along);
        return hn::Lt(hn::Add(most, margin), hn::Mul(w, volume(d, FacingClusters::kBack, i)));
    });
}

void conesKernel(const FacingClusters& clusters, const detail::ClusterEye& eye, uint8_t* back) {
    const FaceLanes d;
    const RowReader cone{clusters.cones.data(), clusters.stride};
    const auto margin = hn::Set(d, eye.margin), w = hn::Set(d, eye.w);
    storeAnswers<true>(d, clusters.count(), back, [&](size_t i) HWY_ATTR {
        auto along = hn::Zero(d), square = hn::Zero(d);
        for (int axis = 0; axis < 3; ++axis) {
            const auto v = hn::Sub(hn::Mul(w, cone(d, FacingClusters::kApex + axis, i)), hn::Set(d, eye.point[axis]));
            along = hn::Add(along, hn::Mul(v, cone(d, FacingClusters::kAxis + axis, i)));
            square = hn::Add(square, hn::Mul(v, v));
        }
        const auto limit = hn::Mul(cone(d, FacingClusters::kCutoff, i), hn::Sqrt(square));
        return hn::Gt(along, hn::Add(limit, margin));
    });
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {
namespace {

HWY_EXPORT(backVolumesKernel);
HWY_EXPORT(frontVolumesKernel);
HWY_EXPORT(turnedKernel);
HWY_EXPORT(conesKernel);

/// False if nothing can be said.
bool placeEye(const FacingClusters& clusters, const FacingEye& eye, detail::ClusterEye& out) {
    SIGHTLINE_DEBUG_ASSERT(clusters.stride % FacingClusters::kPadding == 0 && clusters.stride >= clusters.count());
    SIGHTLINE_DEBUG_ASSERT(clusters.volumes.size() == FacingClusters::kVolumeRows * clusters.stride);
    SIGHTLINE_DEBUG_ASSERT(clusters.turned.empty() ||
                           clusters.turned.size() == FacingClusters::kTurnedRows * clusters.stride);
    SIGHTLINE_DEBUG_ASSERT(clusters.cones.empty() ||
                           clusters.cones.size() == FacingClusters::kConeRows * clusters.stride);
    const glm::dvec3 q = eye.point - eye.w * clusters.origin;
    const double size = std::abs(q.x) + std::abs(q.y) + std::abs(q.z) + eye.w * 8.0 * clusters.reach;
    const double far_away = glm::length(eye.point) + eye.w * glm::length(clusters.origin);
    // Less than twenty roundings by 2^-24 of at most that size; squares and axes that are a little too long count twice.
    const double margin = 0x1p-18 * size + 4.0 * eye.error + 0x1p-50 * far_away + 0x1p-60;
    if (!eye.known() || !(size < 0x1p50) || !(margin < 0x1p50)) return false;
    for (int axis = 0; axis < 3; ++axis) out.point[axis] = static_cast<float>(q[axis]);
    out.w = static_cast<float>(eye.w);
    out.margin = static_cast<float>(margin);
    out.turned = eye.front == FrontFace::kClockwise;
    return true;
}

/// What one volume says: positive, all are front faces; negative, all are back faces; 0, neither is known. The arithmetic
/// is that of the kernels.
int sideOf(const CullingVolume& volume, const detail::ClusterEye& eye) {
    float most = 0, least = 0;
    for (int axis = 0; axis < 3; ++axis) {
        const float q = eye.point[axis] - eye.w * volume.origin[axis];
        const float a = volume.most[axis] * q, b = volume.least[axis] * q;
        most += std::max(a, b);
        least += std::min(a, b);
    }
    if (most + eye.margin < eye.w * volume.back) return eye.turned ? 1 : -1;
    if (least - eye.margin > eye.w * volume.front) return eye.turned ? -1 : 1;
    return 0;
}

void setBits(std::span<uint8_t> bits, uint32_t first, uint32_t count) {
    SIGHTLINE_DEBUG_ASSERT(size_t{first} + count <= 8 * bits.size());
    for (uint32_t i = first; i < first + count; ++i) bits[i / 8] |= static_cast<uint8_t>(1u << i % 8);
}

}  // namespace

size_t findBackClusters(const FacingClusters& clusters, const FacingEye& eye, uint32_t tests, std::span<uint8_t> back) {
    SIGHTLINE_DEBUG_ASSERT((tests & ~uint32_t{kAllFacingTests}) == 0);
    const size_t bytes = detail::answerBytes(clusters.count());
    SIGHTLINE_ASSERT(back.size() >= bytes);
    detail::ClusterEye placed;
    if (!placeEye(clusters, eye, placed)) {
        std::fill_n(back.begin(), bytes, uint8_t{0});
        return 0;
    }
    if (!(tests & kVolumeTest)) std::fill_n(back.begin(), bytes, uint8_t{0});
    else if (placed.turned) HWY_DYNAMIC_DISPATCH(frontVolumesKernel)(clusters, placed, back.data());
    else HWY_DYNAMIC_DISPATCH(backVolumesKernel)(clusters, placed, back.data());
    if (!placed.turned && tests & kTurnedTest && !clusters.turned.empty())
        HWY_DYNAMIC_DISPATCH(turnedKernel)(clusters, placed, back.data());
    if (!placed.turned && tests & kConeTest && !clusters.cones.empty())
        HWY_DYNAMIC_DISPATCH(conesKernel)(clusters, placed, back.data());
    return detail::finishAnswers(clusters.count(), back);
}

size_t findFrontClusters(const FacingClusters& clusters, const FacingEye& eye, std::span<uint8_t> front) {
    const size_t bytes = detail::answerBytes(clusters.count());
    SIGHTLINE_ASSERT(front.size() >= bytes);
    detail::ClusterEye placed;
    if (!placeEye(clusters, eye, placed)) {
        std::fill_n(front.begin(), bytes, uint8_t{0});
        return 0;
    }
    if (placed.turned) HWY_DYNAMIC_DISPATCH(backVolumesKernel)(clusters, placed, front.data());
    else HWY_DYNAMIC_DISPATCH(frontVolumesKernel)(clusters, placed, front.data());
    return detail::finishAnswers(clusters.count(), front);
}

size_t walkFacingTree(const FacingTree& tree, const FacingClusters& clusters, const FacingEye& eye,
                      std::span<uint8_t> back) {
    const size_t bytes = detail::answerBytes(clusters.count());
    SIGHTLINE_ASSERT(back.size() >= bytes);
    std::fill_n(back.begin(), bytes, uint8_t{0});
    detail::ClusterEye placed;
    if (!placeEye(clusters, eye, placed)) return 0;
    size_t tested = 0;
    uint32_t done = 0;  // clusters before this one are settled
    const auto askUpTo = [&](uint32_t end) {
        for (; done < end; ++done, ++tested)
            if (sideOf(clusters.volume(done), placed) < 0) setBits(back, done, 1);
    };
    const size_t nodes = tree.nodes.size();
    for (size_t i = 0; i < nodes;) {
        const FacingNode& node = tree.nodes[i];
        SIGHTLINE_DEBUG_ASSERT(node.next > i && node.next <= nodes &&
                               size_t{node.first} + node.count <= clusters.count());
        askUpTo(node.first);
        const int side = sideOf(node.volume, placed);
        ++tested;
        if (side < 0) setBits(back, node.first, node.count);
        if (side != 0) done = node.first + node.count;
        i = side != 0 ? node.next : i + 1;
    }
    askUpTo(static_cast<uint32_t>(clusters.count()));
    return tested;
}

size_t remainingRanges(const FacingClusters& clusters, std::span<const uint8_t> back, uint32_t gap,
                       std::span<TriangleRange> ranges) {
    SIGHTLINE_DEBUG_ASSERT(8 * back.size() >= clusters.count());
    size_t count = 0;
    for (size_t i = 0; i < clusters.count(); ++i) {
        if (back[i / 8] >> (i % 8) & 1 || clusters.size(i) == 0) continue;
        const uint32_t first = clusters.first[i], end = clusters.first[i + 1];
        if (count && first - (ranges[count - 1].first + ranges[count - 1].count) <= gap) {
            ranges[count - 1].count = end - ranges[count - 1].first;
        } else {
            SIGHTLINE_ASSERT(count < ranges.size());
            ranges[count++] = {first, end - first};
        }
    }
    return count;
}

const uint64_t* backTriangles(const FacingClusters& clusters, size_t cluster, const FacingEye& eye) {
    if (clusters.mask_steps == 0 || !eye.known() || eye.front == FrontFace::kClockwise) return nullptr;
    SIGHTLINE_DEBUG_ASSERT(cluster < clusters.count() && clusters.masks.size() == clusters.count());
    const TriangleMasks& masks = clusters.masks[cluster];
    const glm::dvec3 shape = clusters.mask_shape;
    const glm::dvec3 q = (eye.point - eye.w * (clusters.origin + glm::dvec3(masks.center))) / shape;
    const glm::dvec3 size = glm::abs(q);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const double far_away = glm::length(eye.point) + eye.w * (glm::length(clusters.origin) + clusters.reach);
    const double doubt = (0x1p-50 * far_away + eye.error) / std::min({shape.x, shape.y, shape.z});
    if (masks.half < 0 || !(size[axis] - doubt > eye.w * masks.half)) return nullptr;
    // The sectors' masks hold for this much more than the sectors themselves.
    if (!(doubt < 0x1p-18 * size[axis])) return nullptr;
    const uint32_t steps = clusters.mask_steps;
    const auto step = [&](int other) {
        const double at = 0.5 * (q[other % 3] / size[axis] + 1.0) * steps;
        return std::min(static_cast<uint32_t>(std::max(at, 0.0)), steps - 1);
    };
    const uint32_t face = static_cast<uint32_t>(2 * axis) + (q[axis] < 0 ? 1 : 0);
    const uint32_t sector = (face * steps + step(axis + 2)) * steps + step(axis + 1);
    SIGHTLINE_DEBUG_ASSERT(sector < clusters.sectors());
    return clusters.mask_words.data() + masks.first_word + sector * ((clusters.size(cluster) + 63) / 64);
}

}  // namespace sightline
#endif  // HWY_ONCE
