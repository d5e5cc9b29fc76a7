// Corners into the image some at a time, then bounds eight at a time.
// SPDX-License-Identifier: MIT
#include "sightline/cells/portal_bounds.h"

#include <algorithm>
#include <limits>

#include "sightline/base/assert.h"

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/cells/portal_bounds.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace sightline {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

// No operation here is fused or summed in an order that depends on the number of lanes: least and most do not round.
uint32_t lookKernel(const PortalEye& eye, const PortalCorners& corners, std::span<const DirectedPortal> portals,
                    const WindowBounds& window, int sides, PortalLook* looks, uint64_t& faced) {
    constexpr uint32_t kMostCorners = 64;
    const hn::CappedTag<double, 4> d4;
    const hn::CappedTag<double, 8> d8;
    HWY_ALIGN double xs[kMostCorners], ys[kMostCorners], least[4];
    HWY_ALIGN static constexpr double kOfX[8] = {1, -1, 0, 0, 1, -1, 1, -1}, kOfY[8] = {0, 0, 1, -1, 1, -1, -1, 1};
    const auto origin_x = hn::Set(d4, eye.origin.x), origin_y = hn::Set(d4, eye.origin.y),
               origin_z = hn::Set(d4, eye.origin.z), one = hn::Set(d4, 1.0);
    const double speeds[2] = {eye.lengths[0] + eye.wide[0] * eye.lengths[2],
                              eye.lengths[1] + eye.wide[1] * eye.lengths[2]};
    uint32_t count = 0;
    for (uint32_t i = 0; i < portals.size(); ++i) {
        const DirectedPortal& portal = portals[i];
        if (!eye.passes(portal.plane, portal.thickness)) continue;
        ++faced;
        SIGHTLINE_DEBUG_ASSERT(count <= i && portal.count >= 3);
        PortalLook& look = looks[count];
        look.portal = i;
        look.near = true;
        if (portal.count > kMostCorners) {
            ++count;
            continue;
        }
        auto w_least = hn::Set(d4, std::numeric_limits<double>::infinity());
        for (uint32_t k = 0; k < portal.count; k += static_cast<uint32_t>(hn::Lanes(d4))) {
            const auto x = hn::Sub(hn::LoadU(d4, corners.x + portal.first + k), origin_x);
            const auto y = hn::Sub(hn::LoadU(d4, corners.y + portal.first + k), origin_y);
            const auto z = hn::Sub(hn::LoadU(d4, corners.z + portal.first + k), origin_z);
            const auto image = [&](int r) {
                const auto sum =
                    hn::Add(hn::Mul(hn::Set(d4, eye.rows[r].x), x), hn::Mul(hn::Set(d4, eye.rows[r].y), y));
                return hn::Add(hn::Add(sum, hn::Mul(hn::Set(d4, eye.rows[r].z), z)), hn::Set(d4, eye.shift[r]));
            };
            const auto w = image(2);
            const auto inverse = hn::Div(one, w);
            w_least = hn::Min(w_least, w);
            hn::Store(hn::Mul(image(0), inverse), d4, xs + k);
            hn::Store(hn::Mul(image(1), inverse), d4, ys + k);
        }
        hn::Store(w_least, d4, least);
        double w = least[0];
        for (size_t k = 1; k < hn::Lanes(d4); ++k) w = std::min(w, least[k]);
        const double position = eye.position + portal.thickness, w_error = eye.lengths[2] * position;
        if (!(w >= eye.near_w - w_error && w > 4 * w_error)) {
            ++count;
            continue;
        }
        look.near = false;
        look.w = w;
        const double margin_x = speeds[0] * (position / w) + eye.slack[0];
        const double margin_y = speeds[1] * (position / w) + eye.slack[1];
        const double both = margin_x + margin_y;
        HWY_ALIGN const double margins[8] = {margin_x, margin_x, margin_y, margin_y, both, both, both, both};
        for (int k = 0; k < sides; k += static_cast<int>(hn::Lanes(d8))) {
            const auto of_x = hn::Load(d8, kOfX + k), of_y = hn::Load(d8, kOfY + k);
            auto most = hn::Set(d8, -std::numeric_limits<double>::infinity());
            for (uint32_t c = 0; c < portal.count; ++c)
                most = hn::Max(most, hn::Add(hn::Mul(hn::Set(d8, xs[c]), of_x), hn::Mul(hn::Set(d8, ys[c]), of_y)));
            most = hn::Min(hn::Add(most, hn::Load(d8, margins + k)), hn::LoadU(d8, window.most + k));
            hn::StoreU(most, d8, look.window.most + k);
        }
        if (!look.window.isEmpty(sides)) ++count;
    }
    return count;
}

}  // namespace HWY_NAMESPACE
}  // namespace sightline
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline {

HWY_EXPORT(lookKernel);

uint32_t lookThroughPortals(const PortalEye& eye, const PortalCorners& corners, std::span<const DirectedPortal> portals,
                            const WindowBounds& window, int sides, PortalLook* looks, uint64_t& faced) {
    SIGHTLINE_DEBUG_ASSERT(sides == 4 || sides == 8);
    SIGHTLINE_DEBUG_ASSERT(looks != nullptr || portals.empty());
    return HWY_DYNAMIC_DISPATCH(lookKernel)(eye, corners, portals, window, sides, looks, faced);
}

}  // namespace sightline
#endif  // HWY_ONCE
