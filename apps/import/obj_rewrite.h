// An OBJ's faces by their positions alone: Assimp drops faces, and whole objects, whose other indices lead nowhere.
// SPDX-License-Identifier: MIT
//
// Wavefront Technologies. Object Files (.obj), The Advanced Visualizer Manual, appendix B1. 1990s.
#pragma once

#include <string>

namespace sightline::import {

/// Takes the indices of texture coordinates and of normals out of all faces: what is seen depends on neither. All else stays
/// as it is.
/// @param text  a whole file
std::string rewriteObj(std::string text);

}  // namespace sightline::import
