// The first bound: which portal may be passed after which, as far as half-spaces alone can tell.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/bake/flow/flow_portals.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"

namespace sightline::bake {

/// Per directed portal p the directed portals that a line may pass after p: each reached from p through such portals,
/// each in front of all that p is behind, and the other way round.
/// @return [size: portals x portals]
BitMatrix baseVisibility(const FlowPortals& directed, Jobs* jobs);

/// Makes a matrix of what may follow what smaller where it contradicts itself: q follows p only if p's reverse
/// follows q's, and only by steps that are left.
void tightenBase(const FlowPortals& directed, BitMatrix& may, Jobs* jobs);

}  // namespace sightline::bake
