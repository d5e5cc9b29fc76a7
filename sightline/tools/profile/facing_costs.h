// What clusters are merged by, measured on this machine: the cost of a cluster's test, and of a triangle that it spares.
// SPDX-License-Identifier: MIT
//
// Andreas Johannsen, Michael Carter. Clustered Backface Culling. 1998 (t and r).
#pragma once

#include <cstdint>
#include <string>

namespace sightline::tools {

/// The processor, the best instruction set in use, and how many cores: "..., AVX2, 2 cores".
std::string machineName();

/// Whether shading is cheap beside what comes before it.
enum class ShadingCost : uint8_t {
    kCheap,  ///< a back face costs its corners' transformation and the pipeline's own test, which drops it
    kDear,   ///< it is drawn and shaded, as by a pipeline that shows both sides
};

/// Medians  [nanoseconds].
struct FacingCosts {
    double test = 0;     ///< t: of a cluster, by volume, turned volume and cone, many at once
    double dropped = 0;  ///< r: of a back face that the reference renderer's z-buffer drops by its own test
    double drawn = 0;    ///< r: of one that it draws

    /// t / r, for FacingCost::test: triangles that a cluster's test is worth.
    double testInTriangles(ShadingCost shading) const {
        return test / (shading == ShadingCost::kCheap ? dropped : drawn);
    }
};

struct FacingCostSettings {
    uint32_t rings = 96;   ///< of the ball that is drawn: about 4 rings² triangles  [limit: >= 8]
    uint32_t size = 512;   ///< of the image  [pixels]
    uint32_t rounds = 15;  ///< medians of so many
};

/// Measures on one thread; takes a second or so. All are above 0.
FacingCosts measureFacingCosts(const FacingCostSettings& settings = {});

}  // namespace sightline::tools
