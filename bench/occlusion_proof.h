// The proof of the occlusion scenes: every box that the buffer hides is looked for by two witnesses.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "bench/bench.h"
#include "bench/box_witness.h"
#include "bench/occlusion_frame.h"
#include "bench/occlusion_truth.h"
#include "bench/table.h"

namespace sightline::bench {

/// What a frame answers of the boxes in view: 1 where one is hidden, whether asked by itself or in its group.
struct HiddenBoxes {
    std::vector<uint8_t> full, masked;  ///< per box in view
    uint64_t hash = 0;                  ///< of both, and of the depth that each pixel claims after it was asked
};

/// Draws and asks a view with both details. The frame is at the view.
HiddenBoxes hiddenBoxes(const OcclusionFrame& frame, DepthTiles& tiles);

struct ProofSettings {
    size_t most_cameras = ~size_t{0};
    BoxTruthSettings pictures{.supersampling = 4, .jitters = 16};  ///< no jitters: no pictures are drawn
    BoxRays rays;
    uint32_t occlusion_size = 8192;  ///< QuerySettings::occlusion_size
    bool every_target = true;        ///< ask also with every other instruction set, and compare the hashes
};

/// A box that was hidden and seen.
struct FalseBox {
    size_t camera = 0;
    uint32_t box = 0;  ///< by the scene's number
    bool full = false, masked = false;
    const char* witness = "";
    glm::dvec2 pixel{0.0};  ///< [pixels from the left and the top]
};

struct OcclusionProof {
    struct Target {
        std::string name;
        std::vector<uint64_t> hashes;  ///< of each camera's answers
        uint64_t hash() const;         ///< of all of them
    };
    size_t cameras = 0;
    uint64_t boxes = 0, hidden_full = 0, hidden_masked = 0;  ///< summed over the cameras
    uint64_t false_full = 0, false_masked = 0;
    uint64_t samples = 0, rays = 0, edge_rays = 0, unconfirmed = 0;
    std::vector<FalseBox> false_boxes;
    std::vector<Target> targets;  ///< the one in use first

    /// Cameras for which an instruction set answers otherwise than the one in use.
    size_t differing(const Target& target) const;
};

/// @param frame    of the scene
/// @param witness  of the scene
OcclusionProof proveOcclusion(const OcclusionScene& scene, OcclusionFrame& frame, const BoxWitness& witness,
                              uint32_t width, uint32_t height, const ProofSettings& settings);

/// All scenes that the options ask for, in all sizes: rows, and in Table::faults a line for each false box and for each
/// instruction set that answers otherwise.
void addProofs(const Options& options, Table& table);

}  // namespace sightline::bench
