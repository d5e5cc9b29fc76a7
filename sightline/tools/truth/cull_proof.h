// Proves that culled objects are hidden: every point of them, by exact arithmetic on the triangles of the scene.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include "sightline/geom/view.h"
#include "sightline/tools/truth/scene_facts.h"

namespace sightline::tools {

enum class ProofResult : uint8_t {
    kProved,     ///< no point of it is visible
    kSeen,       ///< a point of it is visible beyond rounding
    kOpen,       ///< something is left that no triangle hides, but rounding might: CullProof::width
    kUndecided,  ///< the proof would be more work than was allowed, or was stopped; the object lies nowhere (SceneFacts); or the view is one of
    ///< which nothing is proved: reversed depth, an eye that the projection moves, planes too large for a double
};

struct CullProof {
    ProofResult result = ProofResult::kProved;
    double x = 0, y = 0;  ///< of kSeen and kOpen: where  [pixels from the left and the top]
    double width = 0;     ///< of kOpen: of the widest place that is left  [pixels]
    uint64_t cuts = 0;    ///< shadows that were held against pieces
    /// Of kProved: the objects that hide it, rising; those whose triangles were taken. Of equal ones the first.
    std::vector<uint32_t> hiders;
};

/// The third witness, and the only complete one. What can be seen of an object is where a triangle of it faces the eye, within the view
/// widened by the jitter. That is a flat part. From it the shadows of triangles that hide are taken, until nothing is
/// left; what is left where no triangle hides is seen. A box around many triangles is tried first: what hides the
/// faces that its front shows hides all in it.
///
/// All that is decided is decided by the sign of a number, which is exact: of the triangles' corners where the
/// transforms put them, of the eye as a double, of the view's planes as doubles relative to the eye. Double arithmetic only guesses which
/// triangle to take next. Surfaces at equal depth are both visible. A triangle that the eye sees from its edge is not
/// drawn. Deforming meshes are proved in their rest pose, and hide nothing.
///
/// Objects that are equal (SceneFacts::firstEqual) have one proof, and hide as one.
///
/// Not thread-safe: each thread has its own.
class CullProver {
public:
    /// @param facts  outlive it
    /// @param view   isUsable(view); its eye_radius is ignored
    /// @param work   the most shadows that are held against the pieces of one object
    /// @param stop   asked between shadows; true: what is not proved yet is kUndecided. May be empty
    CullProver(const SceneFacts& facts, const View& view, uint64_t work = 1000000, std::function<bool()> stop = {});
    ~CullProver();

    CullProof prove(uint32_t object);

    /// Which objects are hidden as many at a time: all in a box of the scene's tree. It says nothing of the others, and costs
    /// less than to prove each.
    /// @returns per object of the scene 1 if it is proved to be hidden
    std::vector<uint8_t> hiddenTogether();

    /// The same with these objects alone as hiders: what a certificate says, checked by somebody who trusts nobody.
    /// kSeen is what the whole scene leaves; what only these leave is kOpen.
    /// @param hiders  rising
    CullProof proveBy(uint32_t object, const std::vector<uint32_t>& hiders);

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::tools
