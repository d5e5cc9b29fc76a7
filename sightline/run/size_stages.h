// The stages of distance and contribution in a walk: what is too far or too small, with memory and objects' own limits.
// SPDX-License-Identifier: MIT
//
// What these stages cull is not drawn, and so it hides nothing: neither the occluders that a walk begins with nor the
// volumes are taken from it. Each object's fate hangs on its own box, its limits and whether the last answer showed it,
// not on the node that held it: a node is culled only where all below it would be.
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sightline/cull/contribution.h"
#include "sightline/cull/distance.h"
#include "sightline/run/explain.h"
#include "sightline/run/world_state.h"

namespace sightline::detail {

/// Children of a node that a stage culls: bit per slot.
struct SizeAnswer {
    uint32_t far = 0, small = 0;
};

class SizeStages {
public:
    /// Generations by ObjectId::index of what the last answer showed, 0 where nothing was; empty: no memory.
    std::span<const uint32_t> shown;

    /// Takes up a usable view.
    void begin(const SnapshotState& state, const View& view, const glm::dvec3& eye);
    /// No stage is in use.
    void clear() { state_ = nullptr, by_distance_ = by_contribution_ = false; }
    bool inUse() const { return by_distance_ || by_contribution_; }

    /// @param left  bit per child that is asked about
    uint32_t far(uint32_t node, const EyeBoxes& boxes, uint32_t left) const;
    uint32_t small(uint32_t node, const EyeBoxes& boxes, uint32_t left) const;

    /// Whether a stage culls the object at a place of the hierarchy, by itself.
    bool drops(uint32_t place) const;
    SizeReason reasonFor(uint32_t place) const;

private:
    bool wasShown(uint32_t place) const;
    double farthest(uint32_t place) const;
    double smallest(uint32_t place) const;
    double farthestBelow(uint32_t node, int slot) const;
    double smallestBelow(uint32_t node, int slot) const;

    const SnapshotState* state_ = nullptr;  ///< outlives the walk
    bool by_distance_ = false, by_contribution_ = false;
    glm::dvec3 offset_{0.0};  ///< the hierarchy's origin from the eye
    DistanceMeasure distance_;
    ContributionMeasure contribution_;
    double zoom_ = 1, max_distance_ = 0, least_radius_ = 0;
    double stays_ = 0;  ///< View::hysteresis, if there is a memory
};

/// What a query remembers from answer to answer for SizeStages::shown.
class LastShown {
public:
    explicit LastShown(Memory* memory) : generation_(memory) {}

    /// Marks the objects of the last answer. O(objects of the answer).
    void mark(std::span<const Visible> last);
    /// Takes the marks away again, of the same answer.
    void unmark(std::span<const Visible> last);
    std::span<const uint32_t> generations() const { return generation_; }

private:
    Array<uint32_t> generation_;
};

/// Whether the answer for a view hangs on the one before it through these stages.
bool remembersShown(const View& view);

}  // namespace sightline::detail
