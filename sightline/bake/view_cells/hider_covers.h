// Hiders that meet at corners: together they hide what none of them does alone.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "sightline/bake/view_cells/flat_hiders.h"
#include "sightline/bake/view_cells/hider_tree.h"
#include "sightline/bake/view_cells/region_shadow.h"
#include "sightline/base/jobs.h"
#include "sightline/math/box.h"

namespace sightline::bake {

struct CoverMember {
    uint32_t hider = 0;
    uint32_t shared = 0;  ///< a bit for each edge that lies behind another member's plane
};

/// Hiders that bound one convex room from within, as the walls, the floor and the ceiling of a room do: no edge that is
/// shared lets anything pass.
///
/// The argument. Let an eye be in front of the planes of all members: then it is in the convex region K that is in
/// front of all. Let a point be behind one of the planes: the way there leaves K, at a point p of one member's plane,
/// which is in front of all other planes. If p is outside of that member's polygon, then walk from a point of the
/// polygon in K, which there must be, to p: all the way is in K, and it leaves the polygon at one of its edges. Shared
/// edges are not in K. So it is beside one that is not shared, and these are asked. Walls meet at corners to within
/// half of the smaller FlatHider::hole.
using HiderCover = std::vector<CoverMember>;

/// The hiders of a scene, and which of them meet.
class HiderCovers {
public:
    static constexpr size_t kMostMembers = 8;

    /// @param hiders  must outlive this, as `tree` must
    HiderCovers(std::span<const FlatHider> hiders, const HiderTree& tree, Jobs* jobs);

    std::span<const FlatHider> hiders() const { return hiders_; }
    /// Hiders that an edge ends at, those with the most area first.
    std::span<const uint32_t> neighbours(uint32_t hider, uint32_t edge) const {
        const uint32_t at = first_edge_[hider] + edge;
        return {neighbours_.data() + first_[at], first_[at + 1] - first_[at]};
    }
    /// Adds a hider to a cover.
    /// @returns false, and the cover stays as it is, if it does not bound a room with the others
    bool add(HiderCover& cover, uint32_t hider) const;

private:
    void findNeighbours(uint32_t hider, const HiderTree& tree, std::vector<std::vector<uint32_t>>& out) const;
    bool endsAt(const FlatHider& hider, size_t edge, const FlatHider& other) const;
    bool hasPlace(const HiderCover& cover, size_t member) const;

    std::span<const FlatHider> hiders_;
    std::vector<uint32_t> first_edge_, first_, neighbours_;
};

/// A cover and the shadows of its members.
struct ReadyCover {
    HiderCover cover;
    std::vector<const RegionShadow*> shadows;

    /// Whether each segment from the region to the box passes a member.
    bool hides(const Box3d& box) const;
};

/// The covers of one region.
class RegionCovers {
public:
    /// @param of     must outlive this
    /// @param reach  as for RegionShadow
    RegionCovers(const HiderCovers& of, const Box3d& region, double reach);

    /// Takes up a cover. None if the region is not in front of all members.
    std::optional<ReadyCover> take(const HiderCover& cover);
    /// A cover that begins with a hider and hides a box. None if none was found.
    std::optional<ReadyCover> find(uint32_t first, const Box3d& box);

private:
    const RegionShadow* shadowOf(uint32_t hider);

    const HiderCovers& of_;
    glm::dvec3 corners_[8];
    double reach_ = 0;
    std::unordered_map<uint32_t, std::unique_ptr<RegionShadow>> shadows_;  // null: the region is not in front
};

}  // namespace sightline::bake
