// What of a scene graph hides: the state that its drawables inherit, and their triangles.
// SPDX-License-Identifier: MIT
#pragma once

#include <vector>

#include <osg/Drawable>
#include <osg/StateSet>

#include <sightline/c/sightline.h>

namespace sightline_osg {

/// How what is below a node is drawn.
struct Style {
    bool opaque = true;       ///< no state keeps its triangles from covering what is behind them
    bool keeps_depth = true;  ///< it is drawn where it is and hidden by what is nearer: it may be left out
    bool both_sides = true;   ///< no face is culled

    /// With a node's own state; null: it has none. State that overrides what is below, or is protected from what is above, is
    /// not followed: it makes all below hide nothing.
    /// @param whole  it is the state of a node above all that is culled, as the camera's
    Style with(const osg::StateSet* state, bool whole = false) const;
};

/// Of all nodes above one: what they say together.
Style styleAbove(const osg::Node& node);

/// An occluder of a drawable's triangles; null if it hides nothing: it is no geometry, or moves its vertices, or is not opaque.
slOccluder* occluderOf(osg::Drawable& drawable, const Style& style);

slBox boxOf(const osg::BoundingBox& box);

}  // namespace sightline_osg
