// The frustum stage: culls what lies outside of the view's planes, its sections and its window, and what misses the buffer.
// SPDX-License-Identifier: MIT
#include "sightline/base/assert.h"
#include "sightline/cull/frustum.h"

#include "sightline/stages/pipeline.h"

namespace sightline::detail {

uint32_t cullOutside(const Frame& frame, TraversalState&, Group& group, uint32_t live) {
    SIGHTLINE_DEBUG_ASSERT(frame.usable && live <= 0xff);
    SIGHTLINE_DEBUG_ASSERT((group.inherited & ~allPlanes(frame)) == 0);
    FrustumAnswer answer = testFrustum(frame.frustum, group.boxes, group.inherited);
    if (group.inherited >> kLimitBit != 0) {
        const FrustumAnswer beside = testViewVolume(frame.limits.volume, group.boxes, group.inherited >> kLimitBit);
        answer.outside |= beside.outside;
        for (int slot = 0; slot < 8; ++slot) answer.planes[slot] |= beside.planes[slot] << kLimitBit;
    }
    for (int slot = 0; slot < 8; ++slot) {
        group.planes[slot] = answer.planes[slot];
        group.undecided |= uint32_t{answer.planes[slot] != 0} << slot;
    }
    return answer.outside & live;
}

uint32_t cullOffScreen(const Frame&, TraversalState&, Group& group, uint32_t live) {
    SIGHTLINE_DEBUG_ASSERT(live <= 0xff && (group.on_screen.outside & group.on_screen.doubt) == 0);
    return group.on_screen.outside & live;
}

}  // namespace sightline::detail
