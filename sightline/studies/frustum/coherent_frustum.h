// View frustum culling over a hierarchy: eight children at once, or one by one with all that two frames have in common.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

#include "sightline/cull/bounds.h"
#include "sightline/cull/hierarchy_scratch.h"
#include "sightline/studies/frustum/coherency.h"
#include "sightline/tree/world_bvh.h"

namespace sightline::studies {

/// The default with everything that one child at a time can use.
HierarchyCulling everyCoherency();

/// Walks hierarchies. Keeps what a walk needs, and what the next frame's walk may know: one per camera.
class HierarchyCuller {
public:
    explicit HierarchyCuller(Memory* memory = defaultMemory());

    /// Writes the items whose boxes may touch the volume, in an order that hangs on the tree and the options alone, and returns how many.
    /// Conservative as cullFrustum(): the margin grows with the tree's size and the eye's distance from its origin.
    /// Allocates only where the tree has grown.
    /// @param refined  refineVolume(), or a RefinedVolume of which only `volume` is set  [limit: 8 planes; further ones
    ///                 are left out]
    /// @param kept     [size: >= tree.size() + 8]
    size_t cull(const RefinedVolume& refined, const PlacedBvh& tree, const HierarchyCulling& how,
                std::span<uint32_t> kept);

    /// To be called when boxes of the tree have changed, or another tree comes: what was remembered does not hold.
    void forget();

    const CoherentStats& stats() const { return stats_; }

private:
    friend struct OneByOne;

    /// Why a child was culled, with all that tells whether that still holds.
    struct Memo {
        static constexpr float kNothing = 1e30f;
        float inside = kNothing;  ///< of the corner farthest inside, at most; less the plane's way until then
        float reach = 0.0f;       ///< how far the box's points are from the eye at most
        float turned = 0.0f, travelled = 0.0f;  ///< the plane and the eye, until then
    };
    /// The planes' motion since the beginning.
    struct Motion {
        ViewVolume last;
        double way[8] = {};     ///< how much farther inside what stands still has come, by the eye's translation
        double turned[8] = {};  ///< length of the normal's path
        double travelled = 0.0;
        bool begun = false;
    };
    static constexpr uint8_t kNever = 255;

    void follow(const ViewVolume& volume, size_t nodes);

    Array<HierarchyScratch::Visit> stack_;
    Array<uint8_t> last_plane_;  ///< eight per node: the plane that culled the child last, or kNever
    Array<Memo> memos_;          ///< eight per node; apart, so that plane coherency alone touches little memory
    Motion motion_;
    bool followed_motion_ = false;  ///< at the last call
    CoherentStats stats_;
};

}  // namespace sightline::studies
