// The stage of contribution: culls what looks smaller than its limit. Not conservative, and off unless asked for.
// SPDX-License-Identifier: MIT
#include "sightline/stages/pipeline.h"

namespace sightline::detail {

uint32_t cullSmall(const Frame& frame, TraversalState&, Group& group, uint32_t live) {
    group.undecided = 0xff;
    return frame.sizes.small(group.index, group.boxes, live);
}

}  // namespace sightline::detail
