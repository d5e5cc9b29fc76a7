// What cannot be ruled out by half-spaces alone: which portals may be passed after which.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/bake/directed_portals.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"

namespace sightline {

/// Per directed portal p the directed portals that a line may pass after p: each reached from p through such portals,
/// each in front of all that p is behind, and the other way round.
/// @return [size: portals x portals]
BitMatrix baseVisibility(const DirectedPortals& directed, Jobs* jobs);

/// Makes a matrix of what may follow what smaller where it contradicts itself: q follows p only if p's reverse
/// follows q's, and only by steps that are left.
void tightenBase(const DirectedPortals& directed, BitMatrix& may, Jobs* jobs);

}  // namespace sightline
