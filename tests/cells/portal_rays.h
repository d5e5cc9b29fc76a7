// Sight lines of a view followed through a graph of cells: what an answer of portals must hold.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/base/random.h"
#include "sightline/cells/cell_space.h"
#include "sightline/cells/portals.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/tools/truth/graph_rays.h"

namespace sightline::test {
using namespace tools;

/// A view of which the eye is known beforehand.
struct KnownView {
    View view;
    glm::dvec3 eye{0.0};
    bool parallel = false;
};

inline KnownView makeView(const glm::dvec3& eye, const glm::dvec3& direction, const glm::dmat4& projection) {
    KnownView known;
    known.eye = eye;
    known.view.view = lookAt(eye, eye + direction, {0.1, 1, 0.05});
    known.view.projection = projection;
    known.parallel = isOrthographic(known.view);
    return known;
}

/// Perspective or parallel, off-centre one time in four, with near planes from very near to a third of `size`.
inline KnownView randomView(Random& random, const glm::dvec3& eye, double size) {
    const double z_near = size * std::pow(10.0, random.uniform(-4, -0.5)) * 0.3;
    const double z_far = random.below(2) ? INFINITY : 100 * size;
    const bool parallel = random.below(6) == 0;
    glm::dmat4 projection =
        parallel ? orthographic(size * random.uniform(0.05, 1), random.uniform(0.5, 2), z_near, 100 * size)
                 : perspective(random.uniform(0.1, 2.6), random.uniform(0.5, 2), z_near, z_far);
    if (random.below(4) == 0 && !parallel) {
        projection[2][0] = random.uniform(-0.8, 0.8);
        projection[2][1] = random.uniform(-0.8, 0.8);
    }
    glm::dvec3 direction = randomDirection(random);
    if (random.below(4) == 0) {
        direction = glm::dvec3(0.0);
        direction[static_cast<int>(random.below(3))] = random.below(2) ? 1 : -1;
    }
    KnownView known = makeView(eye, direction, projection);
    known.view.jitter = random.below(3) == 0 ? 0 : random.uniform(0, 4);
    return known;
}

/// A sight line from the near rectangle.
struct SightLine {
    glm::dvec3 from, direction;
};

/// Through a place of the image, in clip x and y over w.
inline SightLine sightLineAt(const KnownView& known, double x, double y) {
    const glm::dmat4 inverse = glm::inverse(known.view.projection);
    const glm::dmat3 back = glm::transpose(glm::dmat3(known.view.view));
    const glm::dvec4 at = inverse * glm::dvec4(x, y, -1, 1);
    const glm::dvec3 near = glm::dvec3(at) / at.w;
    glm::dvec3 direction = near;
    if (known.parallel) {
        const glm::dvec4 far = inverse * glm::dvec4(x, y, 1, 1);
        direction = glm::dvec3(far) / far.w - near;
    }
    return {known.eye + back * near, glm::normalize(back * direction)};
}

/// Where in the image a point is, if it is before the eye.
inline std::optional<glm::dvec2> imageOf(const KnownView& known, const glm::dvec3& point) {
    const glm::dvec4 clip = known.view.projection * glm::dvec4(glm::dmat3(known.view.view) * (point - known.eye), 1.0);
    if (!(clip.w > 0)) return std::nullopt;
    return glm::dvec2(clip) / clip.w;
}

/// The cell that a point is in by more than a margin; kNoCell: none, or it is too close to tell.
inline uint32_t cellAt(const CellSpace& space, const glm::dvec3& point, double margin, bool& solid) {
    solid = false;
    if (space.ofTree()) {
        uint32_t child = space.tree.nodes.empty() ? LeafTreeNode::kLeaf : 0;
        while ((child & LeafTreeNode::kLeaf) == 0) {
            const LeafTreeNode& node = space.tree.nodes[child];
            const double height = glm::dot(glm::dvec3(node.plane), point) + node.plane.w;
            if (std::abs(height) <= margin) return CellGraph::kNoCell;
            child = node.child[height > 0];
        }
        const uint32_t cell = space.graph.cell_of_leaf[child & ~LeafTreeNode::kLeaf];
        solid = cell == CellGraph::kNoCell;
        return cell;
    }
    bool close = false;
    for (uint32_t i = 0; i < space.regions.size(); ++i) {
        if (i == space.outside) continue;
        double least = INFINITY;
        for (const glm::dvec4& plane : space.planesOf(space.regions[i]))
            least = std::min(least, glm::dot(glm::dvec3(plane), point) + plane.w);
        if (least > margin) return i;
        close |= least > -margin;
    }
    solid = !close && space.outside == CellGraph::kNoCell;
    return close ? CellGraph::kNoCell : space.outside;
}

struct RayTally {
    uint64_t rays = 0, steps = 0, solid = 0;
    uint64_t missed = 0;  ///< steps into cells, or at places of the image, that the answer does not have
    std::string example;
};

/// Follows sight lines of a view for which the flood gave an answer.
/// @param keeps  whether a line may go on from the first step to the second: shut doors
class PortalJudge {
public:
    PortalJudge(const CellSpace& space, const GraphRays& rays) : space_(space), rays_(rays), seen_(space.graph.cells) {}

    template <class Blocks>
    void judge(const KnownView& known, const PortalFlood& flood, Random& random, int count, RayTally& tally,
               Blocks blocks) {
        for (auto& windows : seen_) windows.clear();
        for (const SeenCell& cell : flood.cells()) seen_[cell.cell].push_back(cell);
        const double wide_x = 1 + 2 * known.view.jitter / known.view.width;
        const double wide_y = 1 + 2 * known.view.jitter / known.view.height;
        for (int i = 0; i < count; ++i) {
            glm::dvec2 at(random.uniform(-wide_x, wide_x), random.uniform(-wide_y, wide_y));
            if (i % 4 != 0) {
                // At a hole of a cell that is seen, or of one behind it, or close by its edge.
                if (flood.cells().empty()) break;
                const uint32_t cell = flood.cells()[random.below(flood.cells().size())].cell;
                aim(cell, known, random, at);
            }
            if (std::abs(at.x) > wide_x || std::abs(at.y) > wide_y) continue;
            const SightLine line = sightLineAt(known, at.x, at.y);
            bool solid = false;
            const uint32_t first = cellAt(space_, line.from, 4 * margin(), solid);
            tally.solid += solid;
            if (first == CellGraph::kNoCell) continue;
            ++tally.rays;
            rays_.follow(first, line.from, line.direction, steps_);
            for (GraphStep& step : steps_) {
                if (step.before != GraphStep::kStart) {
                    const GraphStep& before = steps_[step.before];
                    if (before.at < 0 || blocks(before.cell, step.cell, line.from + step.at * line.direction)) {
                        step.at = -1;  // nor anything that follows
                        continue;
                    }
                }
                ++tally.steps;
                if (!isSeen(step.cell, flood, known.eye, line.from + step.at * line.direction)) {
                    if (tally.missed++ == 0)
                        tally.example = "cell " + std::to_string(step.cell) + " at (" + std::to_string(at.x) + ", " +
                                        std::to_string(at.y) + ")" +
                                        (seen_[step.cell].empty() ? ", not in the answer" : ", outside its windows");
                }
            }
        }
    }
    void judge(const KnownView& known, const PortalFlood& flood, Random& random, int count, RayTally& tally) {
        judge(known, flood, random, count, tally, [](uint32_t, uint32_t, const glm::dvec3&) { return false; });
    }

private:
    double margin() const { return rays_.margin().most; }

    void aim(uint32_t cell, const KnownView& known, Random& random, glm::dvec2& at) {
        if (of_cell_.empty()) {
            of_cell_.resize(space_.graph.cells);
            for (uint32_t i = 0; i < space_.graph.portals.size(); ++i)
                for (const uint32_t side : space_.graph.portals[i].cells) of_cell_[side].push_back(i);
        }
        if (of_cell_[cell].empty()) return;
        const CellPortal& portal = space_.graph.portals[of_cell_[cell][random.below(of_cell_[cell].size())]];
        const auto outline = space_.graph.outline(portal);
        glm::dvec3 point = pointInHole(random, outline);
        if (random.below(2) == 0) {
            // Just inside of an edge, or of a corner.
            const size_t k = random.below(outline.size());
            const double along = random.below(3) == 0 ? 0 : random.uniform();
            const glm::dvec3 edge = outline[k] + along * (outline[(k + 1) % outline.size()] - outline[k]);
            point = edge + std::pow(10.0, random.uniform(-8, -1)) * (point - edge);
        }
        if (const auto image = imageOf(known, point)) at = *image;
    }

    bool isSeen(uint32_t cell, const PortalFlood& flood, const glm::dvec3& eye, const glm::dvec3& point) const {
        for (const SeenCell& seen : seen_[cell]) {
            bool inside = true;
            for (const glm::dvec4& plane : flood.planes().subspan(seen.first_plane, seen.plane_count))
                inside &= glm::dot(glm::dvec3(plane), point - eye) + plane.w >= 0;
            if (inside) return true;
        }
        return false;
    }

    const CellSpace& space_;
    const GraphRays& rays_;
    std::vector<std::vector<SeenCell>> seen_;
    std::vector<std::vector<uint32_t>> of_cell_;
    std::vector<GraphStep> steps_;
};

}  // namespace sightline::test
