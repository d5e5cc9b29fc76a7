// How far boxes lie from a view's eye: the measure behind distance culling, eight children of a tree node at once.
// SPDX-License-Identifier: MIT
#include "sightline/cull/distance.h"

#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cull/contribution.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cull/distance.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using F8 = hn::CappedTag<float, 8>;

// Every step below rounds monotonically and in one order: a box inside another one gets no smaller a distance.
void squaredDistancesKernel(const DistanceMeasure& measure, const EyeBoxes& boxes, float* squares) {
    const F8 d;
    const auto zero = hn::Zero(d);
    for (size_t i = 0; i < 8; i += hn::Lanes(d)) {
        auto sum = zero;
        for (int axis = 0; axis < 3; ++axis) {
            const auto low = hn::Load(d, boxes.min[axis] + i), high = hn::Load(d, boxes.max[axis] + i);
            if (measure.perspective) {
                const auto gap = hn::Max(zero, hn::Max(low, hn::Neg(high)));
                sum = hn::Add(sum, hn::Mul(gap, gap));
            } else {
                const auto n = hn::Set(d, measure.toward[axis]);
                sum = hn::Add(sum, hn::Min(hn::Mul(n, low), hn::Mul(n, high)));
            }
        }
        if (!measure.perspective) {
            sum = hn::Max(zero, sum);
            sum = hn::Mul(sum, sum);
        }
        hn::StoreU(sum, d, squares + i);
    }
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(squaredDistancesKernel);

DistanceMeasure makeDistanceMeasure(const View& view) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    DistanceMeasure measure;
    measure.perspective = !isOrthographic(view);
    if (!measure.perspective) measure.toward = makeContributionMeasure(view).toward;
    return measure;
}

double distanceZoom(const View& view, double fov) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    if (!(fov > 0.0) || isOrthographic(view)) return 1.0;
    // A thing looks as large as it would at the same share of the limit under the angle that the limit is meant for. The
    // height alone counts: a wider image does not enlarge. Of y only the part across w moves things in the image.
    const glm::dmat4 m = view.projection * glm::dmat4(glm::dmat3(view.view));
    const glm::dvec3 y(m[0][1], m[1][1], m[2][1]), w(m[0][3], m[1][3], m[2][3]);
    return glm::length(glm::cross(y, w)) / glm::dot(w, w) * std::tan(0.5 * fov);
}

void squaredDistances(const DistanceMeasure& measure, const EyeBoxes& boxes, float* squares) {
    HWY_DYNAMIC_DISPATCH(squaredDistancesKernel)(measure, boxes, squares);
}

}  // namespace sightline
#endif  // HWY_ONCE
