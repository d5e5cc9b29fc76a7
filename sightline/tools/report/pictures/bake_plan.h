// Plans of a bake of any scene: its cells, portals and gaps, and how many objects may be seen from where.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/cells/cell_space.h"
#include "sightline/geom/leaf_tree.h"
#include "sightline/math/box.h"
#include "sightline/tools/report/pictures/canvas.h"
#include "sightline/tools/report/pictures/plan.h"
#include "sightline/tools/report/pictures/plan_section.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// What of a bake is drawn.
struct DrawnBake {
    const Scene* scene = nullptr;
    const CellSpace* space = nullptr;     ///< of a tree
    std::vector<PlanLine> gaps;           ///< between walls
    const LeafTree* views = nullptr;      ///< its leaves are view cells; null: there are none
    const BitMatrix* rows = nullptr;      ///< [leaves of `views` x objects in the file]
    const BitMatrix* seen = nullptr;      ///< of the rows, what rays have seen, alike; null: none looked
    std::span<const uint32_t> object_of;  ///< per column of these the scene's object
    glm::dvec3 eye{0.0};                  ///< whose storey the plans show, and at whose height they cut
};

/// The plans, computed once.
class BakePlan {
public:
    static constexpr uint32_t kSide = 1400;  ///< the longer one of the pictures  [pixels]

    /// @param bake  what it names must outlive this
    explicit BakePlan(const DrawnBake& bake);

    uint32_t width() const { return width_; }  ///< of the pictures  [pixels]
    uint32_t height() const { return height_; }
    glm::dvec2 at(const glm::dvec3& point) const { return area_.at(point, width_, height_); }

    /// The walls as they are cut, the borders of the cells, the portals between them, and all gaps.
    Image<Rgb> cells() const;
    /// Each view cell in the colour of how many objects may be seen from it, as a heat map, and the walls.
    Image<Rgb> rows() const;
    /// Each view cell in the colour of which share of its row no ray has seen, and the walls.
    Image<Rgb> open() const;
    /// The walls alone.
    Image<Rgb> walls() const;

    /// The view cells at the height, in pixels.
    const std::vector<LeafAt>& views() const { return views_; }
    /// Objects that may be seen from a view cell.
    uint32_t heldBy(uint32_t leaf) const { return held_[leaf]; }
    /// Those of them that a ray has seen.
    uint32_t witnessedBy(uint32_t leaf) const { return witnessed_.empty() ? 0 : witnessed_[leaf]; }
    Rgb colourOf(uint32_t leaf) const;
    /// The storey of the eye.
    const PlanBand& band() const { return band_; }
    const std::vector<Box3d>& bounds() const { return bounds_; }  ///< of Scene::objects

private:
    void drawWalls(Canvas& canvas) const;
    Image<Rgb> views(const std::function<Rgb(uint32_t leaf)>& colour) const;

    const DrawnBake& bake_;
    std::vector<Box3d> bounds_;
    PlanArea area_;
    PlanBand band_;
    uint32_t width_ = 1, height_ = 1;
    std::vector<PlanLine> walls_;
    std::vector<LeafAt> views_;
    std::vector<uint32_t> held_, witnessed_;  ///< per leaf of the view cells
};

}  // namespace sightline::tools
