// Boxes that are asked about: as an image plane sees them, and where they are in the image.
// SPDX-License-Identifier: MIT
#pragma once

#include "bench/onepass/blocks.h"

namespace sightline::bench {

/// A box as an image plane sees it: the largest a x + b y + c w of its corners is one of each summand.
struct AskedBox {
    float x[4], y[4], w[4];  ///< rows over its three half axes and its centre
    float half[3];
};

/// A box in the image.
struct BoxImage {
    float x0, y0, x1, y1, nearness;
};

}  // namespace sightline::bench
