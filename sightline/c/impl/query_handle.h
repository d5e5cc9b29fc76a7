// The handle of a query, and what it keeps of its last answer.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/c/impl/handles.h"
#include "sightline/query/query.h"

struct slQuery {
    sightline::c::SharedHooks hooks;
    sightline::c::AskedHooks asked{};
    sightline::Query query{hooks->memory(), hooks->jobs()};
    sightline::VisibleSet last{};  ///< the last answer; of two eyes, what either sees
    uint32_t objects = 0;          ///< of the last answer's snapshot
    sightline::ViewProblem problem = sightline::ViewProblem::kNone;
    mutable sightline::Array<uint8_t> reasons{hooks->memory()};
    sightline::Array<char> recorded{hooks->memory()};

    const slLog& log() const { return hooks->log(); }
};
