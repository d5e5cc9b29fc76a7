// A world drawn by a graphics interface's own occlusion queries, where it has some and a frame may wait for them.
// SPDX-License-Identifier: MIT
//
// Oliver Mattausch, Jiri Bittner, Michael Wimmer. CHC++: Coherent Hierarchical Culling Revisited. 2008.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/cull/queries/occlusion_queries.h"
#include "sightline/world/world.h"

namespace sightline {

/// The caller's graphics interface, for objects.
class ObjectDevice : public QuestionDevice {
public:
    /// Draws objects as they look, with the depth test and with their depths written; what writes no depth may be drawn
    /// when all else is.
    /// @param objects  good until the call returns
    virtual void draw(std::span<const Visible> objects) = 0;

protected:
    ~ObjectDevice() = default;
};

/// One view's memory from frame to frame, as OcclusionQueries. It has the same promise, which is weaker than that of Query:
/// what is not drawn shows in none of this image's samples. It needs neither occluders nor a second thread, and it sees all
/// that is drawn: deforming, alpha-tested and cut objects hide as they look.
class ObjectQueries {
public:
    explicit ObjectQueries(Memory* memory = defaultMemory());

    /// Draws a frame: the objects of the view's layers. Those without finite bounds come first, and unasked.
    /// @returns the objects that were drawn, in order; good until the next call
    std::span<const Visible> draw(const Snapshot& now, const View& view, ObjectDevice& device,
                                  const OcclusionQuerySettings& settings = {});

    /// Items are objects, those of other layers among them.
    const OcclusionQueryStats& stats() const { return queries_.stats(); }

private:
    OcclusionQueries queries_;
    Array<Visible> drawn_;
};

}  // namespace sightline
