// A pool of flows: one for each thread that works at the moment.
// SPDX-License-Identifier: MIT
#pragma once

#include <atomic>
#include <memory>

#include "sightline/bake/flow/portal_flow.h"

namespace sightline::bake {

/// Lends a flow that no other thread uses, without waiting. The answer of a flow does not depend on its earlier work.
class FlowPool {
public:
    FlowPool(const FlowPlaces& places, const WitnessRays& rays, const BitMatrix& may)
        : places_(places), rays_(rays), may_(may) {}

    void from(uint32_t portal, std::span<const uint64_t> asked, const FlowLimits& limits, FlowAnswer& answer) {
        withFlow([&](PortalFlow& flow) { flow.from(portal, asked, limits, answer); });
    }
    void find(uint32_t portal, const FlowBoxes& boxes, const FlowLimits& limits, FlowAnswer& answer) {
        withFlow([&](PortalFlow& flow) { flow.find(portal, boxes, limits, answer); });
    }

private:
    template <class Work>
    void withFlow(Work&& work) {
        for (Place& place : held_) {
            if (place.busy.exchange(true, std::memory_order_acquire)) continue;
            if (!place.flow) place.flow = std::make_unique<PortalFlow>(places_, rays_, may_);
            work(*place.flow);
            place.busy.store(false, std::memory_order_release);
            return;
        }
        PortalFlow flow(places_, rays_, may_);
        work(flow);
    }

    struct Place {
        std::atomic<bool> busy{false};
        std::unique_ptr<PortalFlow> flow;
    };

    const FlowPlaces& places_;
    const WitnessRays& rays_;
    const BitMatrix& may_;
    Place held_[256];
};

}  // namespace sightline::bake
