// Which winding is the front of a triangle.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sightline {

/// Which winding the front of a triangle has, as it is seen from there.
enum class FrontFace : uint8_t { kCounterClockwise, kClockwise };

}  // namespace sightline
