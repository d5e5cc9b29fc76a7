// Judges visible sets by witnesses that share no code with what they judge.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/tools/scene/scene.h"
#include "sightline/tools/truth/proof_counts.h"

namespace sightline::tools {

/// One object that was culled although a witness saw it.
struct FalseCull {
    uint32_t object = 0;       ///< index into Scene::objects
    double x = 0, y = 0;       ///< a place where it is seen [pixels from the left and the top]
    const char* witness = "";  ///< "rays", "id-buffer" or "proof"
};

struct FrameVerdict {
    std::vector<FalseCull> false_culls;  ///< at most one per object, in rising order
    uint64_t rays = 0;                   ///< cast for this frame, aimed ones included
    uint64_t aimed_rays = 0;             ///< of these, aimed at culled objects
    uint64_t id_samples = 0;             ///< samples of the supersampled id-buffer
    uint32_t supersampling = 0;          ///< samples per pixel and axis that it had; 0: none was drawn
    uint64_t unconfirmed = 0;            ///< sightings of culled objects that exact arithmetic did not bear out:
                                         ///< grazing edges and surfaces that float cannot tell apart
    std::optional<ProofCounts> proofs;   ///< if they were asked for
    std::vector<uint8_t> seen;           ///< per object of the scene: 1 if any witness saw it
    uint64_t exactly_visible = 0;        ///< objects with seen = 1
    bool stopped = false;                ///< by the settings' stop: what is seen is seen, but not all was looked for
};

struct WitnessSettings {
    uint64_t rays = 1000000;       ///< per frame: stratified and jittered over the viewport
    uint64_t aimed_rays = 200000;  ///< of these, at most so many are aimed at triangles of culled objects in the
                                   ///< frustum: corners, edges and insides, largest objects in the image first
    uint32_t supersampling = 4;    ///< per axis; 0: no id-buffer
    uint64_t id_sample_limit = 1ull << 26;  ///< larger frames are drawn with fewer samples per axis, and say so
    uint64_t seed = 1;
    /// Prove of each object that it is hidden, or find where it is seen: cull_proof.h. `seen` is then what is seen, and no
    /// lower bound, but for what is undecided.
    bool prove = false;
    /// Asked within the frame; true: end at once. FrameVerdict::stopped then says so. May be empty.
    std::function<bool()> stop = {};
    /// With proofs: where a culled object touches another one in a line, at equal depth, it is seen by rays; a proof says that
    /// no area of it is. True: the proof counts. Our own answers are held to the rays.
    bool lines_are_hidden = false;
};

/// Holds the scene in the form that the witnesses need (an Embree scene and draw lists). The scene must
/// outlive it. judge() is const and thread-safe; it uses one thread and, for the id-buffer, up to 200 MB.
///
/// Neither rays nor samples convict alone: a culled object counts as seen only if the sighting holds in double, relative to
/// the eye, against all triangles of the scene (exact.h). Surfaces at equal depth, up to 1e-9 of the distance, are
/// both visible. Deforming meshes are seen in their rest pose and hide nothing.
class Witness {
public:
    explicit Witness(const Scene& scene);
    ~Witness();

    /// The same verdict for the same view, culled objects and settings. A view that is not usable has no verdict:
    /// nothing is seen, no rays are cast.
    /// @param culled  per object of the scene: non-zero if it was reported hidden [size: objects]
    /// Sections cut the scene that is judged. A culled object is seen only at a point in the window (the id-buffer looks at
    /// one point of each); one that is kept, anywhere.
    /// A ray passes single-sided back faces; surfaces that do not hide are counted as seen and passed;
    /// it begins at the near plane and ends at the far plane.
    FrameVerdict judge(const View& view, std::span<const uint8_t> culled, const WitnessSettings& settings = {}) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::tools
