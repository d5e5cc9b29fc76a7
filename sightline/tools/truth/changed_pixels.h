// What leaving objects out costs: the pixels of a frame that show another object without them.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/geom/view.h"
#include "sightline/tools/truth/scene_facts.h"

namespace sightline::tools {

/// What becomes of an object in the two images that are compared.
enum class Drawn : uint8_t {
    kNever,    ///< in neither: it is hidden or out of view
    kAlways,   ///< in both
    kFullOnly  ///< it is left out of one
};

/// Draws the frame twice by the reference renderer, a sample in the middle of each pixel, with and without what is left
/// out, and counts the pixels whose object differs. Surfaces that hide nothing are looked at twice: as they are, which
/// shows what changes behind them, and as if they hid, which shows them.
/// @param view   isUsable(view)
/// @param drawn  [size: objects of the scene]
/// @param lods   per object the level of detail that it is drawn by where something is left out: 0, or 1 + an index
///               into Mesh::lods. Empty: all by their finest  [size: objects of the scene, or 0]
/// @param shown  receives per object how many of these pixels show it where nothing is left out; may be empty
///               [size: objects of the scene, or 0]
uint64_t countChangedPixels(const SceneFacts& facts, const View& view, std::span<const Drawn> drawn,
                            std::span<const uint8_t> lods = {}, std::span<uint64_t> shown = {});

}  // namespace sightline::tools
