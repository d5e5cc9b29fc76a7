// Embree beside our own hierarchy; compiled only where Embree is there.
// SPDX-License-Identifier: MIT
//
// Ingo Wald, Sven Woop, Carsten Benthin, Gregory Johnson, Manfred Ernst. Embree: A Kernel Framework for Efficient CPU
// Ray Tracing. 2014.
#pragma once

#include <memory>

#include "sightline/studies/hidden/rays/raycast_tree.h"

namespace sightline::studies {

/// Positions and rays are in float, relative to the triangles' origin; facing is decided in double.
class EmbreeTree {
public:
    explicit EmbreeTree(RayTriangles triangles);
    ~EmbreeTree();

    /// The nearest within the ray's ends; of equally near ones any.
    /// @param ray  both ends finite
    RayHit nearest(const SampleRays& rays, const SampleRay& ray) const;

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace sightline::studies
