// Ray casting: a ray through each sample, the nearest triangle that it meets.
// SPDX-License-Identifier: MIT
//
// Arthur Appel. Some Techniques for Shading Machine Renderings of Solids. 1968.
#pragma once

#include "sightline/studies/hidden/method_input.h"

namespace sightline::studies {

/// Rays begin at the near plane and end at the far plane, or behind all there is; single-sided back faces are passed
/// through. By RayTracer::kBvh in double, of equally near triangles the first; by RayTracer::kEmbree in float, where the
/// library was built with Embree (hasEmbree()), else by the other.
///
/// Nothing is clipped or projected, so HiddenCounters::geometry stays 0. Rays cannot follow the rule by which a sample
/// on an edge belongs to one of the triangles there: along edges the image may differ from other methods'. O(log n) a
/// ray on common scenes; building the hierarchy, O(n log n), counts as preparation. Rows are
/// shared among RenderSettings::threads.
void drawRaycast(const HiddenInput& input, HiddenImage& image);

/// Whether RayTracer::kEmbree is there.
bool hasEmbree();

}  // namespace sightline::studies
