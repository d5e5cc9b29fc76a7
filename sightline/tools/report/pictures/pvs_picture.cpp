// Draws cells, portals and visibility.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/pvs_picture.h"

#include <algorithm>
#include <cmath>

namespace sightline::tools {
namespace {

glm::dvec3 middleOf(std::span<const glm::dvec3> outline) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& point : outline) sum += point - outline[0];
    return outline[0] + sum / static_cast<double>(outline.size());
}

Rgb colourOf(const BitMatrix& visible, const BitMatrix& witnessed, size_t row, size_t column) {
    return witnessed.at(row, column) ? kWitnessedColour : visible.at(row, column) ? kUnresolvedColour : kHiddenColour;
}

}  // namespace

PlanArea cellPlanArea(const CellGraph& graph) {
    Box3d box;
    for (const glm::dvec3& point : graph.points) box.grow(point);
    return planAreaAround(box);
}

CellPlan::CellPlan(const CellGraph& graph, const PlanArea& area, uint32_t width)
    : graph_(graph), area_(area), width_(std::max(width, 1u)), hulls_(graph.cells), middles_(graph.cells) {
    height_ = std::max(1u, static_cast<uint32_t>(std::lround(width_ * area.height / area.width)));
    std::vector<uint32_t> portals(graph.cells, 0);
    for (const CellPortal& portal : graph.portals)
        for (const uint32_t cell : portal.cells) {
            for (const glm::dvec3& point : graph.outline(portal)) hulls_[cell].push_back(at(point));
            middles_[cell] += at(middleOf(graph.outline(portal)));
            ++portals[cell];
        }
    for (uint32_t cell = 0; cell < graph.cells; ++cell) {
        hulls_[cell] = convexHull(std::move(hulls_[cell]));
        if (portals[cell] > 0) middles_[cell] /= portals[cell];
    }
}

glm::dvec2 CellPlan::at(const glm::dvec3& point) const { return area_.at(point, width_, height_); }

void CellPlan::drawPortal(Canvas& canvas, const CellPortal& portal, double width, Rgb colour, double opacity) const {
    const std::span<const glm::dvec3> outline = graph_.outline(portal);
    for (size_t i = 0; i < outline.size(); ++i)
        canvas.line(at(outline[i]), at(outline[(i + 1) % outline.size()]), width, colour, opacity);
}

void CellPlan::drawCells(Canvas& canvas, Rgb colour, double opacity) const {
    for (const std::vector<glm::dvec2>& hull : hulls_) canvas.fill(hull, colour, opacity);
}

Image<Rgb> CellPlan::graph() const {
    Canvas canvas = paper();
    drawCells(canvas, kHiddenColour, 0.5);
    for (const CellPortal& portal : graph_.portals) {
        const glm::dvec2 middle = at(middleOf(graph_.outline(portal)));
        for (const uint32_t cell : portal.cells) canvas.line(middles_[cell], middle, 0.7, kWitnessedColour, 0.6);
    }
    for (const CellPortal& portal : graph_.portals) drawPortal(canvas, portal, 1, kPortalColour, 0.8);
    for (uint32_t cell = 0; cell < graph_.cells; ++cell)
        if (!hulls_[cell].empty()) canvas.disc(middles_[cell], 1.6, kWitnessedColour);
    return canvas.image();
}

Image<Rgb> CellPlan::seenFrom(uint32_t cell, const BitMatrix& visible, const BitMatrix& witnessed) const {
    Canvas canvas = paper();
    drawCells(canvas, kHiddenColour, 0.6);
    for (const bool proved : {true, false})
        for (uint32_t other = 0; other < graph_.cells; ++other)
            if (other != cell && visible.at(cell, other) && witnessed.at(cell, other) == proved)
                canvas.fill(hulls_[other], proved ? kWitnessedColour : kUnresolvedColour, 0.75);
    for (const CellPortal& portal : graph_.portals) drawPortal(canvas, portal, 0.6, kPortalColour, 0.35);
    canvas.fill(hulls_[cell], kAskedCellColour);
    if (!hulls_[cell].empty()) {
        canvas.disc(middles_[cell], 5, kPaperColour);
        canvas.disc(middles_[cell], 3.5, kAskedCellColour);
    }
    return canvas.image();
}

Image<Rgb> CellPlan::sightline(std::span<const glm::dvec3> points, std::span<const uint32_t> portals) const {
    Canvas canvas = paper();
    drawCells(canvas, kHiddenColour, 0.6);
    for (const CellPortal& portal : graph_.portals) drawPortal(canvas, portal, 0.6, kPortalColour, 0.35);
    std::vector<uint32_t> passed;
    for (const uint32_t portal : portals)
        for (const uint32_t cell : graph_.portals[portal].cells) passed.push_back(cell);
    std::sort(passed.begin(), passed.end());
    passed.erase(std::unique(passed.begin(), passed.end()), passed.end());
    for (const uint32_t cell : passed) canvas.fill(hulls_[cell], kWitnessedColour, 0.35);
    for (const uint32_t portal : portals) drawPortal(canvas, graph_.portals[portal], 2, kAskedCellColour, 1);
    for (size_t i = 1; i < points.size(); ++i) canvas.line(at(points[i - 1]), at(points[i]), 2, kSightlineColour);
    if (!points.empty())
        for (const glm::dvec3& end : {points.front(), points.back()}) canvas.disc(at(end), 4, kSightlineColour);
    return canvas.image();
}

Image<Rgb> pvsMatrixPicture(const BitMatrix& visible, const BitMatrix& witnessed, std::span<const uint32_t> order,
                            uint32_t most) {
    const auto cells = static_cast<uint32_t>(visible.rows());
    const uint32_t side = std::min(cells, std::max(most, 1u));
    Image<Rgb> image(side, side);
    const auto cellAt = [&](uint32_t i) { return order.empty() ? i : order[i]; };
    const auto begin = [&](uint32_t pixel) { return static_cast<uint32_t>(uint64_t{pixel} * cells / side); };
    for (uint32_t y = 0; y < side; ++y)
        for (uint32_t x = 0; x < side; ++x) {
            glm::uvec3 sum(0);
            uint32_t pairs = 0;
            for (uint32_t i = begin(y); i < begin(y + 1); ++i)
                for (uint32_t k = begin(x); k < begin(x + 1); ++k, ++pairs)
                    sum += glm::uvec3(colourOf(visible, witnessed, cellAt(i), cellAt(k)));
            image.at(x, y) = Rgb((sum + pairs / 2) / pairs);
        }
    return image;
}

}  // namespace sightline::tools
