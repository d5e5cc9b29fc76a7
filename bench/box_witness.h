// The second witness of the occlusion scenes: rays aimed at boxes, through whatever may show them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "bench/occlusion_scenes.h"

namespace sightline::bench {

struct BoxRays {
    uint32_t at_boxes = 8;  ///< rays per box at its own corners, edges and faces
    uint32_t through_edges =
        8;                     ///< rays per box through the outlines and seams of what lies before it, just beside them
    uint32_t places = 200000;  ///< on outlines and seams, that the latter are chosen from, about
    uint64_t seed = 1;
    uint32_t threads = 1;  ///< [>= 1]; the verdict is the same for any number
};

struct BoxVerdict {
    struct Row {
        bool seen = false;
        glm::dvec2 pixel{0.0};  ///< where [pixels from the left and the top]
    };
    std::vector<Row> boxes;    ///< for each that was asked
    uint64_t rays = 0;         ///< cast at boxes
    uint64_t edge_rays = 0;    ///< of these, through outlines and seams
    uint64_t unconfirmed = 0;  ///< rays of Embree's that reached a box, which exact arithmetic did not bear out
};

/// Sees by what the scenes' own witnesses see by: Embree finds candidates, and a box counts as seen only if the sighting
/// holds in double against all triangles (tools/truth/exact.h). All batches hide, whether they are in view or not.
class BoxWitness {
public:
    /// @param scene  outlives the witness
    explicit BoxWitness(const OcclusionScene& scene);
    ~BoxWitness();

    /// @param boxes  by the scene's numbers
    BoxVerdict judge(const View& view, std::span<const uint32_t> boxes, const BoxRays& settings = {}) const;

    struct Parts;  ///< what all views share

private:
    std::unique_ptr<const Parts> parts_;
};

}  // namespace sightline::bench
