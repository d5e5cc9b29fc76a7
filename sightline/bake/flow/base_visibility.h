// The first bound: which portal may be passed after which, as far as half-spaces alone can tell.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>

#include "sightline/bake/flow/flow_portals.h"
#include "sightline/bake/flow/stop_asker.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"

namespace sightline::bake {

/// Who shares the work of the first bound, and who follows it.
struct BaseSettings {
    Jobs* jobs = nullptr;
    StopAsker* stop = nullptr;                                   ///< asked between portals; may be null
    std::function<void(uint32_t done, uint32_t all)> tell = {};  ///< portals; may be empty
};

/// Per directed portal p the directed portals that a line may pass after p: each reached from p through such portals,
/// each in front of all that p is behind, and the other way round.
/// @return [size: portals x portals]; if it was stopped, of no use
BitMatrix baseVisibility(const FlowPortals& directed, const BaseSettings& settings = {});

/// Makes a matrix of what may follow what smaller where it contradicts itself: q follows p only if p's reverse
/// follows q's, and only by steps that are left. If it is stopped, less is removed. Needs as much memory again.
void tightenBase(const FlowPortals& directed, BitMatrix& may, const BaseSettings& settings = {});

}  // namespace sightline::bake
