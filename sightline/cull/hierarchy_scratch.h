// What a walk over a hierarchy counts, and what it needs from walk to walk.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include "sightline/base/array.h"

namespace sightline {

/// What a query of a hierarchy did.
struct HierarchyStats {
    uint64_t nodes = 0;         ///< nodes whose children were tested
    uint64_t plane_tests = 0;   ///< of eight children against one plane
    uint64_t inside_nodes = 0;  ///< nodes whose items were all copied without a test
};

/// Frusta that one walk asks at most.
inline constexpr uint32_t kMostFrusta = 32;

/// The scratch memory of queries; each thread has its own. It allocates only when a hierarchy needs more than those
/// before.
struct HierarchyScratch {
    struct Visit {
        uint32_t node = 0;
        uint32_t planes = 0;  ///< bit per plane that the node is not inside of
    };
    /// The same of several frusta.
    struct ManyVisit {
        uint32_t node = 0;
        uint32_t live = 0;            ///< bit per frustum that the node may touch
        uint32_t crossing = 0;        ///< of these: it is not inside of the frustum
        uint8_t planes[kMostFrusta];  ///< of each that it crosses
    };
    Array<Visit> visits;
    Array<ManyVisit> many_visits;
    explicit HierarchyScratch(Memory* memory = defaultMemory()) : visits(memory), many_visits(memory) {}
};

}  // namespace sightline
