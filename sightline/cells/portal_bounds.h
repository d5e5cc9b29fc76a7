// All portals of a cell in the image at once, as bounds within the window that the cell is seen through.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>

#include "sightline/cells/portal_eye.h"
#include "sightline/cells/portal_graph.h"
#include "sightline/cells/portal_window.h"

namespace sightline {

/// A portal that sight lines may go through.
struct PortalLook {
    uint32_t portal = 0;  ///< index into what was asked
    bool near = false;    ///< it is too near to the eye to be bounded without a cut: the rest is not set
    double w = 0;         ///< the least of its corners
    WindowBounds window;  ///< the part of the cell's window that it may cover, not tightened
};

/// Leaves out portals that face the other way, and those that miss the window. The same bits with each instruction set.
/// @param sides  4 or 8: those of the window that are looked at
/// @param looks  [size: portals]
/// @param faced  counts the portals that face the right way
/// @returns how many looks there are
uint32_t lookThroughPortals(const PortalEye& eye, const PortalCorners& corners, std::span<const DirectedPortal> portals,
                            const WindowBounds& window, int sides, PortalLook* looks, uint64_t& faced);

}  // namespace sightline
