// A rectangle of the viewport.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline {

/// A rectangle of the viewport. What a query looks at is the viewport widened by the jitter, in the whole pixels of its
/// occlusion buffer, so that the rectangle may reach beyond the viewport.
struct ImageRect {
    double left = 0, top = 0, right = 0, bottom = 0;  ///< [viewport pixels from the left and the top]
};

}  // namespace sightline
