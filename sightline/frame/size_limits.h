// How far and how small an object may be in a view: the settings' limits, objects' own, and the memory of what was shown.
// SPDX-License-Identifier: MIT
//
// What the stages of distance and contribution cull is not drawn, and so it hides nothing: volumes are not taken from
// it. Each object's fate depends on its own box, its limits and whether the last answer showed it, not on the node that
// held it: a node is culled only where all below it would be.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/cull/contribution.h"
#include "sightline/cull/distance.h"
#include "sightline/frame/size_reason.h"
#include "sightline/geom/view.h"
#include "sightline/world/world_state.h"

namespace sightline::detail {

class SizeLimits {
public:
    /// Generations by ObjectId::index of what the last answer showed, 0 where nothing was; empty: no memory.
    std::span<const uint32_t> shown;

    /// Takes up a usable view.
    /// @param stages     in use
    /// @param shown_last the new `shown`
    void begin(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t stages,
               const glm::dvec3& eye, std::span<const uint32_t> shown_last);
    /// No stage is in use.
    void clear() { *this = SizeLimits(); }
    bool inUse() const { return by_distance_ || by_contribution_; }

    /// The children of a node that are too far away, and those that are too small: bit per slot.
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

    const SnapshotState* state_ = nullptr;  ///< outlives the answer
    bool by_distance_ = false, by_contribution_ = false;
    glm::dvec3 offset_{0.0};  ///< the hierarchy's origin from the eye
    DistanceMeasure distance_;
    ContributionMeasure contribution_;
    double zoom_ = 1, max_distance_ = 0, least_radius_ = 0;
    double eye_radius_ = 0;  ///< View::eye_radius: how much nearer another eye may be
    double stays_ = 0;       ///< QuerySettings::hysteresis, if there is a memory
};

/// What a query remembers from answer to answer for SizeLimits::shown.
class LastShown {
public:
    explicit LastShown(Memory* memory) : generation_(memory) {}

    /// Marks the objects of the last answer, if the memory is wanted. O(objects of the answer).
    void mark(std::span<const Visible> last, bool wanted = true);
    /// Takes the marks away again, of the same answer.
    void unmark(std::span<const Visible> last);
    /// Good between mark() and unmark(); empty: there is no memory.
    std::span<const uint32_t> generations() const { return marked_ ? generation_ : std::span<const uint32_t>(); }

private:
    Array<uint32_t> generation_;
    bool marked_ = false;
};

/// Whether these stages make the answer for a view depend on the answer before.
bool remembersShown(const View& view, const QuerySettings& settings);

}  // namespace sightline::detail
