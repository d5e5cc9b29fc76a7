// Whose shadows hide an object: the parts of others, as the eye sees them, behind which all of it lies.
// SPDX-License-Identifier: MIT
//
// Satyan Coorg, Seth Teller. Real-Time Occlusion Culling for Models with Large Occluders. 1997.
#pragma once

#include <glm/glm.hpp>

#include "sightline/base/array.h"
#include "sightline/geom/query_settings.h"
#include "sightline/geom/view.h"
#include "sightline/query/explain/hider.h"
#include "sightline/world/world.h"

namespace sightline {

namespace detail {
struct Certificate;
struct Frame;
class ProofMemory;

/// Adds the parts that a certificate names and that hide something in the view at hand.
void addOutlines(const ProofMemory& proofs, const Frame& frame, const Certificate& certificate,
                 Array<HiderOutline>& outlines, Array<glm::dvec3>& corners);
}  // namespace detail

/// Looks for parts of other objects whose shadows together hold all of an object that lies in a view and shows its front:
/// a certificate, as QuerySettings::proofs finds it, for one object and without drawing. What it finds is a proof in
/// object space; that it finds none says nothing. For pictures and tools. Takes up the view anew in each call.
/// @param settings  what is culled as too far or too small hides nothing
/// @param outlines  receives these parts; none: the object lies outside of the view, or shows no front
/// @param corners   and their corners  [world units]
/// @returns false if none is found; for ids of no object and for views that allow none: parallel ones, and those that
///          cannot be used
bool findShadows(const Snapshot& now, const View& view, ObjectId id, const QuerySettings& settings,
                 Array<HiderOutline>& outlines, Array<glm::dvec3>& corners, Memory* memory = defaultMemory());

}  // namespace sightline
