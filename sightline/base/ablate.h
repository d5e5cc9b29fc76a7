// Says which mechanisms of the occlusion buffer are compiled out: none, except in the measurements of bench/ablate.
// SPDX-License-Identifier: MIT
#pragma once

namespace sightline::detail {

// A macro that is defined becomes "1" here; one that is not stays its own name.
#define SIGHTLINE_ABLATE_TEXT(text) #text
#define SIGHTLINE_IS_ABLATED(macro) (SIGHTLINE_ABLATE_TEXT(macro)[0] == '1')

/// One flag per mechanism; -DSIGHTLINE_ABLATE_SEAMS sets `seams`, and so on. Every answer stays sound without a mechanism.
struct Ablate {
    bool seams = SIGHTLINE_IS_ABLATED(SIGHTLINE_ABLATE_SEAMS);    ///< pixels that several polygons cover together
    bool unite = SIGHTLINE_IS_ABLATED(SIGHTLINE_ABLATE_UNITE);    ///< of these, by the union of the polygons
    bool joiner = SIGHTLINE_IS_ABLATED(SIGHTLINE_ABLATE_JOINER);  ///< of these, by identical edges
    bool masks = SIGHTLINE_IS_ABLATED(SIGHTLINE_ABLATE_MASKS);    ///< refutation of shared pixels by masks
    bool planes = SIGHTLINE_IS_ABLATED(SIGHTLINE_ABLATE_PLANES);  ///< covers and the planes of occluders
};

constexpr Ablate kAblate;  // not inline: it differs between the files of an ablated program

#undef SIGHTLINE_IS_ABLATED
#undef SIGHTLINE_ABLATE_TEXT

}  // namespace sightline::detail
