// Whether two images of the same polygons agree, and what explains the samples where they do not.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <vector>

#include "sightline/studies/hidden/render.h"

namespace sightline::studies {

struct Agreement {
    uint64_t samples = 0;              ///< of the image
    uint64_t differing = 0;            ///< = at_edges + ties + wrong
    uint64_t at_edges = 0;             ///< an outline of one of the two surfaces passes within the band
    uint64_t ties = 0;                 ///< both surfaces are there, equally near
    uint64_t wrong = 0;                ///< nothing explains it
    uint32_t row = 0, sample = 0;      ///< of the first wrong one
    uint32_t expected = 0, found = 0;  ///< the surfaces there

    bool agrees() const { return wrong == 0; }
};

struct AgreementBands {
    double edge = 1e-6;           ///< distance from an outline [samples]
    double tie = 1e-9;            ///< difference in nearness, relative to the nearer
    bool by_id = false;           ///< compare DrawItem::id, not surfaces
    ProjectorSettings projector;  ///< that both images were drawn with
};

/// @param expected, found  of the same list and view
Agreement compareImages(const DrawList& list, const View& view, const HiddenImage& expected, const HiddenImage& found,
                        const AgreementBands& bands = {});

}  // namespace sightline::studies
