// How large boxes look in an image: the measure behind contribution culling, eight children of a tree node at once.
// SPDX-License-Identifier: MIT
#include "sightline/cull/contribution.h"

#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/contribution.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;

// Sums that the measure is made of. Of a node, bounds for all boxes inside: their half diagonals are no longer, their
// centres are in the box. Each rounds monotonically, in the same order as what it bounds.
// radius: squared half diagonal. depth: of the centre along the direction of view; least of a node. distance: squared, of
// the centre to the eye; largest of a node.
template <class V, class M>
HWY_INLINE void addSums(const ContributionMeasure& measure, const EyeBoxes& boxes, size_t i, M leaf, V& radius,
                        V& depth, V& distance) {
    const F8 d;
    const auto half = hn::Set(d, 0.5f);
    for (int axis = 0; axis < 3; ++axis) {
        const auto low = hn::Load(d, boxes.min[axis] + i), high = hn::Load(d, boxes.max[axis] + i);
        const auto centre = hn::Mul(half, hn::Add(low, high));
        const auto extent = hn::Mul(half, hn::Sub(high, low));
        const auto n = hn::Set(d, measure.toward[axis]);
        const auto nearest = hn::Min(hn::Mul(n, low), hn::Mul(n, high));
        const auto farthest = hn::Max(hn::Abs(low), hn::Abs(high));
        const auto away = hn::IfThenElse(leaf, hn::Abs(centre), farthest);
        radius = hn::Add(radius, hn::Mul(extent, extent));
        depth = hn::Add(depth, hn::IfThenElse(leaf, hn::Mul(n, centre), nearest));
        distance = hn::Add(distance, hn::Mul(away, away));
    }
}

void squaredRadiiKernel(const ContributionMeasure& measure, const EyeBoxes& boxes, uint32_t leaves, float* squares) {
    const F8 d;
    const auto one = hn::Set(d, 1.0f), scale = hn::Set(d, measure.scale);
    // A node's bound is above what it bounds in exact arithmetic; the steps below round by far less than this.
    const auto margin = hn::Set(d, 1.0f + 0x1p-10f);
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        const uint8_t bits[8] = {static_cast<uint8_t>(leaves >> i)};
        const auto leaf = hn::LoadMaskBits(d, bits);
        auto radius = hn::Zero(d), depth = hn::Zero(d), distance = hn::Zero(d);
        addSums(measure, boxes, i, leaf, radius, depth, distance);
        auto square = hn::Mul(scale, radius);
        auto good = hn::Lt(radius, hn::Set(d, 1e30f));  // no overflow, and a number
        if (measure.perspective) {
            const auto z2 = hn::Mul(depth, depth);
            const auto u = hn::Div(radius, z2), v = hn::Div(distance, z2);
            const auto rest = hn::Sub(one, u);
            // a b = u sqrt(v - u) / (1 - u)^(3/2), with u = r^2 / z^2 and v = d^2 / z^2; rises with u and with v.
            const auto stretch = hn::Sqrt(hn::Max(hn::Div(hn::Sub(v, u), rest), hn::Zero(d)));
            square = hn::Mul(hn::Mul(scale, u), hn::Div(stretch, rest));
            good = hn::And(good, hn::And(hn::Gt(depth, hn::Set(d, 1e-12f)), hn::Lt(z2, hn::Set(d, 1e36f))));
            good = hn::And(good, hn::Lt(u, hn::Set(d, 0.5f)));
        }
        square = hn::IfThenElse(leaf, square, hn::Mul(square, margin));
        hn::StoreU(hn::IfThenElse(good, square, hn::Set(d, std::numeric_limits<float>::infinity())), d, squares + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(squaredRadiiKernel);

ContributionMeasure makeContributionMeasure(const View& view) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
    const auto row = [&](int r) { return glm::dvec3(m[0][r], m[1][r], m[2][r]); };
    const glm::dvec3 across = glm::cross(row(0), row(1));
    const double pixels = 0.25 * view.width * view.height;  // of the square from -1 to 1
    ContributionMeasure measure;
    measure.perspective = !isOrthographic(view);
    glm::dvec3 toward;
    double scale = 0;
    if (measure.perspective) {
        // x/w and y/w at depth z are linear in what lies across the direction of w, over z: their determinant is that of
        // the gradients, over the square of w's.
        const double length = glm::length(row(3));
        toward = row(3) / length;
        scale = pixels * std::abs(glm::dot(toward, across)) / (length * length);
    } else {
        // A parallel view looks along the one direction that moves neither x nor y; z rises with depth.
        const double length = glm::length(across), w = view.projection[3][3];
        toward = (glm::dot(across, row(2)) * w >= 0 ? 1.0 : -1.0) * across / length;
        scale = pixels * length / (w * w);
    }
    measure.toward = glm::vec3(toward);
    measure.scale = static_cast<float>(scale);
    return measure;
}

void squaredRadii(const ContributionMeasure& measure, const EyeBoxes& boxes, uint32_t leaves, float* squares) {
    SIGHTLINE_DEBUG_ASSERT(leaves <= 0xff && squares != nullptr);
    HWY_DYNAMIC_DISPATCH(squaredRadiiKernel)(measure, boxes, leaves, squares);
}

}  // namespace sightline
#endif  // HWY_ONCE
