// Pictures of cells, portals and what they see: plans from above, and the matrix of who sees whom.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "sightline/base/bit_matrix.h"
#include "sightline/cells/cells.h"
#include "sightline/tools/report/pictures/canvas.h"
#include "sightline/tools/report/pictures/plan.h"
#include "sightline/tools/report/pictures/png.h"

namespace sightline::tools {

/// What the colours mean: a pair of cells that a ray proved, one that is visible as far as one knows, and one that is proved hidden.
inline constexpr Rgb kWitnessedColour{0, 114, 178}, kUnresolvedColour{230, 126, 0}, kHiddenColour{223, 227, 233};
/// The cell that is asked about, a sight line and what it passes through; portals; paper.
inline constexpr Rgb kAskedCellColour{20, 24, 31}, kSightlineColour{196, 18, 110}, kPortalColour{84, 96, 115},
    kPaperColour{255, 255, 255};

/// Around all portals, with some air: as wide as they need, at most four times as high as wide or as wide as high.
PlanArea cellPlanArea(const CellGraph& graph);

/// A cell graph seen from above, computed once. The graph must outlive it. A cell is drawn as the hull of its portals: as far as
/// the graph knows it reaches so far and perhaps farther. Cells above one another cover one another.
class CellPlan {
public:
    /// @param width  of the pictures  [pixels]
    CellPlan(const CellGraph& graph, const PlanArea& area, uint32_t width);

    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }
    /// Of each cell what it is drawn as; empty without portals.  [pixels]
    const std::vector<std::vector<glm::dvec2>>& outlines() const { return hulls_; }

    /// The graph over the plan: cells pale, portals dark, and a thin line from the middle of each cell to the middle of
    /// each of its portals.
    Image<Rgb> graph() const;

    /// What a cell sees: hidden cells pale, then those that rays proved, those that none did, and on top the cell itself.
    /// @param visible, witnessed  [cells x cells]
    /// @pre cell < graph.cells
    Image<Rgb> seenFrom(uint32_t cell, const BitMatrix& visible, const BitMatrix& witnessed) const;

    /// A sight line over the plan, with the portals that it passes through.
    /// @param points   from its first place to its last, corners between allowed
    /// @param portals  indices into the graph's portals
    Image<Rgb> sightline(std::span<const glm::dvec3> points, std::span<const uint32_t> portals) const;

private:
    Canvas paper() const { return Canvas(width_, height_, kPaperColour); }
    glm::dvec2 at(const glm::dvec3& point) const;
    void drawPortal(Canvas& canvas, const CellPortal& portal, double width, Rgb colour, double opacity) const;
    void drawCells(Canvas& canvas, Rgb colour, double opacity) const;

    const CellGraph& graph_;
    PlanArea area_;
    uint32_t width_ = 1, height_ = 1;
    std::vector<std::vector<glm::dvec2>> hulls_;  ///< per cell  [pixels]
    std::vector<glm::dvec2> middles_;             ///< per cell: the mean of its portals' middles  [pixels]
};

/// The matrix as a picture, a pixel a pair where it fits, else each pixel the mean of its pairs: row and column i are cell
/// order[i].
/// @param visible, witnessed  [cells x cells]
/// @param order  each cell once; empty: by their numbers
/// @param most   of pixels in a row
Image<Rgb> pvsMatrixPicture(const BitMatrix& visible, const BitMatrix& witnessed, std::span<const uint32_t> order = {},
                            uint32_t most = 1200);

}  // namespace sightline::tools
