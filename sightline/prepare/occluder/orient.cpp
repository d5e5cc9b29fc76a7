// Turns double-sided triangles so that neighbours wind the same way.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/occluder/orient.h"

#include <algorithm>
#include <numeric>

namespace sightline {
namespace {

/// Sets of triangles, each with whether it has to be turned if the set's root is not.
class TurnedSets {
public:
    explicit TurnedSets(size_t count) : parent_(count), turned_(count, 0) {
        std::iota(parent_.begin(), parent_.end(), 0u);
    }

    struct Place {
        uint32_t root;
        bool turned;
    };

    Place find(uint32_t i) {
        // Twice along the way: first to the root, then to hang all that was passed under it.
        uint32_t root = i;
        bool turned = false;
        for (; parent_[root] != root; root = parent_[root]) turned ^= turned_[root] != 0;
        bool below = turned;
        for (uint32_t at = i; at != root;) {
            const uint32_t next = parent_[at];
            const bool rest = below ^ (turned_[at] != 0);
            parent_[at] = root;
            turned_[at] = below;
            below = rest;
            at = next;
        }
        return {root, turned};
    }

    /// The set's root is its least member, which is never turned.
    void join(uint32_t a, uint32_t b, bool differ) {
        Place p = find(a), q = find(b);
        if (p.root == q.root) return;
        if (p.root > q.root) std::swap(p, q);
        parent_[q.root] = p.root;
        turned_[q.root] = p.turned ^ q.turned ^ differ;
    }

private:
    std::vector<uint32_t> parent_;
    std::vector<uint8_t> turned_;  ///< against the parent
};

}  // namespace

void orientDoubleSided(Patchwork& patchwork) {
    std::vector<PatchPolygon>& triangles = patchwork.polygons;
    if (std::none_of(triangles.begin(), triangles.end(), [](const PatchPolygon& p) { return p.double_sided; })) return;
    TurnedSets sets(triangles.size());
    bool all_agree = true;
    const std::vector<PatchSide> sides = sortedSides(patchwork);
    forSharedSides(std::span(sides), [&](std::span<const PatchSide> shared) {
        if (shared.size() != 2) return;
        const PatchSide &a = shared[0], &b = shared[1];
        if (!triangles[a.polygon].double_sided || !triangles[b.polygon].double_sided) return;
        sets.join(a.polygon, b.polygon, a.forward == b.forward);
        all_agree &= a.forward != b.forward;
    });
    if (all_agree) return;
    for (uint32_t i = 0; i < triangles.size(); ++i)
        if (sets.find(i).turned) std::swap(triangles[i].vertex[1], triangles[i].vertex[2]);
}

}  // namespace sightline
