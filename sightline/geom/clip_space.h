// How a program's matrices project: conventions of clip space by their names, and views made from matrices of any of them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

#include "sightline/geom/view.h"

namespace sightline {

/// Which depths a projection keeps, after division by w.
enum class ClipDepth : uint8_t {
    kMinusOneToOne,  ///< OpenGL
    kZeroToOne,      ///< Vulkan, Direct3D, Metal, WebGPU
};

/// How a pair of matrices, world to eye and eye to clip, projects.
struct ClipSpace {
    ClipDepth depth = ClipDepth::kMinusOneToOne;
    bool reversed = false;     ///< near is at the greatest depth, far at the least
    bool y_down = false;       ///< y grows towards the lower edge of the image
    bool left_handed = false;  ///< the eye looks along its positive z

    bool operator==(const ClipSpace&) const = default;
};

/// The conventions that are in use, by the names that camera files have for them.
struct NamedClipSpace {
    const char* name;
    ClipSpace space;
};
inline constexpr NamedClipSpace kClipSpaces[] = {
    {"opengl", {}},
    {"direct3d", {ClipDepth::kZeroToOne}},
    {"vulkan", {ClipDepth::kZeroToOne, false, true}},
    {"direct3d-reversed", {ClipDepth::kZeroToOne, true}},
    {"vulkan-reversed", {ClipDepth::kZeroToOne, true, true}},
    {"direct3d-left-handed", {ClipDepth::kZeroToOne, false, false, true}},
    {"direct3d-left-handed-reversed", {ClipDepth::kZeroToOne, true, false, true}},
};

/// Gives a view the matrices of a program with its own convention, so that it sees what the program draws. Infinite far
/// planes stay infinite. The world stays as it is: right-handed, counter-clockwise faces in front.
/// @param view        world to eye
/// @param projection  eye to clip, column-major
void setMatrices(View& to, const glm::dmat4& view, const glm::dmat4& projection, const ClipSpace& space);

/// What a pair of matrices tells of its own convention: its hand, where y goes, whether depth is reversed, and of
/// reversed depth its range. The range of depth that is not reversed cannot be told: OpenGL's is taken, which the caller
/// must know to be right. The matrices are finite and can be inverted.
ClipSpace tellClipSpace(const glm::dmat4& view, const glm::dmat4& projection);

}  // namespace sightline
