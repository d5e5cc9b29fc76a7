// IFC4's faces by index, written as the faces of IFC2x3, which Assimp reads.
// SPDX-License-Identifier: MIT
//
// buildingSMART. IFC 4.0.2.1 and IFC 2x3 TC1, IfcTessellatedFaceSet and IfcFaceBasedSurfaceModel.
#pragma once

#include <string>

namespace sightline::import {

/// Replaces each IfcTriangulatedFaceSet and IfcPolygonalFaceSet by an IfcFaceBasedSurfaceModel of the same number, and
/// each IfcIndexedPolyCurve of straight segments by an IfcPolyline; new entities have numbers beyond the largest. All
/// else stays as it is. Throws a Fault for what Assimp would crash on and cannot be replaced (curves with arcs, advanced
/// boundaries), and for indices and references that lead nowhere.
/// @param text  a whole file; comes back as it was if there is nothing to replace
std::string rewriteIfc(std::string text);

}  // namespace sightline::import
