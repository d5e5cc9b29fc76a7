// One way of telling what of a scene may be visible, so that several answer the same cameras in one run.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>

#include "sightline/geom/view.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::bench {

class Contestant {
public:
    virtual ~Contestant() = default;

    virtual const char* name() const = 0;
    /// Forgets the cameras before: another round begins.
    virtual void begin() {}
    /// How many objects it keeps.
    virtual size_t answer(const View& view) = 0;
};

#ifdef SIGHTLINE_PEER
/// MaskedOcclusionCulling, of the folder that CMake was told by SIGHTLINE_PEER, in a buffer of 640 x 360. A flat
/// list gives the objects in the frustum. They are taken the nearest first. An object whose box is not hidden is drawn
/// whole. All drawn ones are asked again at the end.
/// @param scene  must outlive it
std::unique_ptr<Contestant> makeMaskedContestant(const tools::Scene& scene);
#endif

}  // namespace sightline::bench
