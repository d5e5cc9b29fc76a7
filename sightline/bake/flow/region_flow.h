// What light takes from a region through portals into cells: a bound from above, for a region that is no cell itself.
// SPDX-License-Identifier: MIT
//
// Seth Teller, Carlo Sequin. Visibility Preprocessing for Interactive Walkthroughs. 1991.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <unordered_map>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/cells/cell_space.h"
#include "sightline/math/box.h"

namespace sightline::bake {

/// What segments from a box through a window can reach beyond it: a few planes.
///
/// The argument. Let a plane have the box on its one side and the window, with all that lies within 1.25 `slack` of it, on the
/// other. A segment from the box through the window has crossed the plane by then, and does not come back. So does any
/// plane that is found, whatever it was made of: each is held against the corners of both, and left out if it does not
/// divide them. Rounding is far below `slack`, of which an eighth is kept for it. What holds of a segment behind one window
/// holds of it behind the next one, too; of what comes to a window by several ways a plane is true if each part of it has passed
/// the plane, or crosses it from the box to the window.
class Penumbra {
public:
    /// @param region  finite, not empty
    /// @param window  convex, 3 corners or more
    /// @param beyond  the window's plane; its unit normal points away from the region's side
    /// @param slack   how far a segment may pass beside the window or its plane; at least 1e-9 of the coordinates
    ///                [world units]
    /// @param passed  planes of other penumbras that all segments have come through before; the first kMostPassed
    Penumbra(const Box3d& region, std::span<const glm::dvec3> window, const glm::dvec4& beyond, double slack,
             std::span<const glm::dvec4> passed = {});

    /// Whether something of a box may be reached.
    bool touches(const Box3d& box) const {
        for (uint32_t i = 0; i < count_; ++i) {
            const glm::dvec3 normal(planes_[i]);
            const double highest = glm::dot(normal, box.center()) + 0.5 * glm::dot(glm::abs(normal), box.size());
            if (highest + planes_[i].w < 0) return false;
        }
        return true;
    }
    /// Cuts off of a polygon what no segment comes near to, as close as the slack.
    /// @param polygon  convex; it is empty if nothing is left
    /// @param scratch  is written over
    /// @param by       bits of the planes to cut by
    void clip(std::vector<glm::dvec3>& polygon, std::vector<glm::dvec3>& scratch, uint64_t by = ~uint64_t{0}) const;
    /// Bits of the planes that may cut off something of a ball; none if nothing of it may be reached.
    std::optional<uint64_t> cutting(const glm::dvec3& center, double radius) const {
        uint64_t bits = 0;
        for (uint32_t i = 0; i < count_; ++i) {
            const double height = glm::dot(glm::dvec3(planes_[i]), center) + planes_[i].w;
            if (height + radius < 0) return std::nullopt;
            bits |= uint64_t{height < radius} << i;
        }
        return bits;
    }

    std::span<const glm::dvec4> planes() const { return {planes_.data(), count_}; }
    /// Those of the window's edges.
    std::span<const glm::dvec4> edges() const { return planes().subspan(1, edges_); }
    /// Whether a plane of edges() is crossed by all segments from its region to another window, too.
    static bool divides(const glm::dvec4& plane, std::span<const glm::dvec3> window, double slack);

    static constexpr size_t kMostPassed = 12;  ///< that are handed on; more hardly cut more

private:
    static constexpr size_t kMost = 16;

    // dot(plane, (p, 1)) >= 0 where something may be reached; the first is the window's own
    std::array<glm::dvec4, kMost + kMostPassed> planes_;
    uint32_t count_ = 0, edges_ = 0;
};

struct RegionFlowSettings {
    /// That a portal may have, each with a wider window, before it counts as open from edge to edge.
    uint32_t turns = 20;
    uint64_t budget = uint64_t{1} << 22;  ///< portals that are clipped for one region
};

/// Follows light from boxes through the portals of a tree's cells. Of each portal the part that light comes to is kept as one
/// convex window; the portals that are nearest to the region come first, so that most have their turn once.
class RegionFlow {
public:
    /// @param space  of a tree, each leaf a cell of its own; must outlive this
    explicit RegionFlow(const CellSpace& space, const RegionFlowSettings& settings = {});

    /// How a flow ended. If it was not done, anything may be seen from the region.
    enum class End : uint8_t {
        kDone,
        kOverBudget,   ///< the work limit was met
        kOutOfBounds,  ///< the region reaches out of the tree's bounds, where there are no portals
        kStopped,      ///< reach() said so
    };
    /// Told of a way into a cell, within a penumbra, or anywhere in the cell if that is null. False ends the flow.
    using Reach = std::function<bool(uint32_t cell, const Penumbra* through)>;

    /// Calls reach() for ways into cells: where a segment from the region is on before it meets a wall, it is in a cell that
    /// is reached, within one of the penumbras. Doors count as open.
    End from(const Box3d& region, const Reach& reach);

    uint64_t clipped() const { return clipped_; }  ///< portals so far, of all regions

private:
    using Polygon = std::vector<glm::dvec3>;

    /// A portal as it is seen from one of its cells.
    struct Way {
        uint32_t portal, from, to;
        bool reversed;
        glm::dvec3 center;  // of a ball around the portal
        double radius;
    };
    /// What has come to a way from the region.
    struct Arrived {
        Polygon window;                // empty: nothing has
        std::vector<uint32_t> passed;  // numbers of planes that all of it has passed, falling
        uint32_t turns = 0;
        bool waits = false;
    };

    End flow(const Box3d& region, const Reach& reach);
    void findStarts(const Box3d& region);
    void arrive(uint32_t way, const Polygon& part, std::span<const uint32_t> passed);
    void passOn(const Penumbra& penumbra, std::span<const uint32_t> passed);
    uint32_t numberOf(const glm::dvec4& plane);
    Polygon outlineOf(uint32_t way) const;
    glm::dvec4 planeOf(const Way& way) const;
    bool isBeyond(const Box3d& region, const Way& way) const;

    const CellSpace& space_;
    const RegionFlowSettings settings_;
    double reach_ = 0;  // the largest coordinate of the tree and its portals
    double slack_ = 0;
    std::vector<Way> ways_;                           // by the cell that they lead from
    std::vector<uint32_t> first_way_;                 // per cell, and the end
    std::vector<Arrived> arrived_;                    // per way
    std::vector<uint32_t> touched_;                   // ways that something came to
    std::vector<glm::dvec4> planes_;                  // of edges of penumbras, nearly equal ones once
    std::unordered_map<uint64_t, uint32_t> numbers_;  // of them, by their rounded coordinates
    std::vector<glm::dvec4> before_;                  // planes that were passed before a window
    std::vector<uint32_t> onward_;                    // numbers of those that are passed behind it, falling
    std::vector<uint32_t> starts_;                    // cells that the region reaches into
    std::vector<std::pair<double, uint32_t>> queue_;  // a heap: how far ways are from the region, negative
    glm::dvec3 middle_{0.0};                          // of the region
    uint64_t clipped_ = 0;
};

}  // namespace sightline::bake
