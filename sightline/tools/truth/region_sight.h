// What rays from all of a box see: a lower bound of what may be seen from it.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/jobs.h"
#include "sightline/base/random.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/math/box.h"
#include "sightline/tools/truth/rays.h"
#include "sightline/tools/truth/scene_facts.h"

namespace sightline::tools {

/// How many rays one region is looked from with.
struct RegionRays {
    uint32_t around = 0;     ///< anywhere
    uint32_t at_object = 0;  ///< at points of the triangles of each object that is asked for, until one of them sees it
};

/// In float: where two meshes touch, a ray may slip through between them.
class RegionSight {
public:
    /// @param scene  must outlive this
    explicit RegionSight(const Scene& scene) : scene_(scene), facts_(scene), rays_(facts_) {}

    /// Looks from random points of a box. Several threads may, each with its own `seen` and `random`.
    /// @param objects  that are asked for  [Scene::objects]
    /// @param seen     per object of the scene: set to 1 if it is seen, whether it is asked for or not  [size: objects]
    void look(const Box3d& box, std::span<const uint32_t> objects, const RegionRays& rays, Random& random,
              std::vector<uint8_t>& seen) const;

private:
    const Scene& scene_;
    const SceneFacts facts_;
    const RayScene rays_;
};

struct RowRaysSettings {
    uint32_t rays = 20000;  ///< from each cell: half of them anywhere, half at the objects of its row
    uint64_t seed = 1;
    Jobs* jobs = nullptr;        ///< threads to share the cells out to; the answer is the same with any
    std::function<bool()> stop;  ///< asked between pieces of work; true: nothing more is looked for; may be empty
    std::function<void(double)> progress;  ///< called with the share that is done; may be empty
};

/// Of rows of view cells, the pairs that a ray has seen. A cell that is no box, as all that is outside, sees nothing here.
/// @param tree       a leaf is a row
/// @param object_of  per column the scene's object
/// @returns [leaves x columns], within `rows`
BitMatrix seenOfRows(const Scene& scene, const LeafTree& tree, std::span<const uint32_t> object_of,
                     const BitMatrix& rows, const RowRaysSettings& settings);

}  // namespace sightline::tools
