// What exact proofs say of a frame's objects, counted.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

namespace sightline::tools {

struct ProofCounts {
    uint64_t culled_hidden = 0;     ///< culled objects of which no point is visible: proved
    uint64_t culled_undecided = 0;  ///< culled objects that are neither proved to be hidden nor seen
    uint64_t kept_hidden = 0;       ///< kept objects of which no point is visible
    uint64_t kept_undecided = 0;

    ProofCounts& operator+=(const ProofCounts& more) {
        culled_hidden += more.culled_hidden;
        culled_undecided += more.culled_undecided;
        kept_hidden += more.kept_hidden;
        kept_undecided += more.kept_undecided;
        return *this;
    }
};

}  // namespace sightline::tools
