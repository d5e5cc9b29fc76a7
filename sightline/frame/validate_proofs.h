// Whether a query's certificates name what there is: in debug builds, after each answer.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/frame/proof_memory.h"

namespace sightline::detail {

#ifdef SIGHTLINE_DEBUG_ASSERTS
/// Asserts what the comments of ProofMemory state. O(certificates + hiders); takes no memory.
void validateProofs(const ProofMemory& proofs);
#else
inline void validateProofs(const ProofMemory&) {}
#endif

}  // namespace sightline::detail
