// Draws the cells, portals and gaps of a bake, and its view cells as a heat map.
// SPDX-License-Identifier: MIT
#include "sightline/tools/report/pictures/bake_plan.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/tools/report/pictures/picture.h"
#include "sightline/tools/report/pictures/pvs_picture.h"

namespace sightline::tools {
namespace {

std::vector<uint32_t> onesOf(const BitMatrix& rows) {
    std::vector<uint32_t> out;
    for (size_t row = 0; row < rows.rows(); ++row) {
        uint32_t ones = 0;
        for (const uint64_t word : rows.row(row)) ones += static_cast<uint32_t>(std::popcount(word));
        out.push_back(ones);
    }
    return out;
}

constexpr Rgb kWallInk{20, 24, 31}, kCellInk{150, 160, 175}, kGapInk{213, 40, 0};

}  // namespace

BakePlan::BakePlan(const DrawnBake& bake) : bake_(bake) {
    for (const SceneObject& object : bake.scene->objects)
        bounds_.push_back(transformBox(bake.scene->meshes[object.mesh].bounds, object.transform));
    Box3d world;
    for (const Box3d& box : bounds_)
        if (box.finite()) world.grow(box);
    area_ = planAreaAround(world);
    band_ = storeyOf(bounds_, bake.eye);
    const double scale = kSide / std::max(area_.width, area_.height);
    width_ = std::max(1u, static_cast<uint32_t>(std::lround(scale * area_.width)));
    height_ = std::max(1u, static_cast<uint32_t>(std::lround(scale * area_.height)));
    walls_ = wallsAt(*bake.scene, bounds_, area_, bake.eye.y);
    if (!bake.views) return;
    held_ = onesOf(*bake.rows);
    if (bake.seen) witnessed_ = onesOf(*bake.seen);
    views_ = leavesAt(*bake.views, area_, bake.eye.y);
    for (LeafAt& view : views_)
        for (glm::dvec2& point : view.outline) point = at({point.x, bake.eye.y, point.y});
}

Rgb BakePlan::colourOf(uint32_t leaf) const {
    const double all = std::max<double>(1, static_cast<double>(bake_.rows->columns()));
    return heatColour(std::sqrt(held_[leaf] / all));
}

void BakePlan::drawWalls(Canvas& canvas) const {
    for (const PlanLine& line : walls_) canvas.line(at(line.from), at(line.to), 1.4, kWallInk);
}

Image<Rgb> BakePlan::walls() const {
    Canvas canvas(width_, height_, kPaperColour);
    drawWalls(canvas);
    return canvas.image();
}

Image<Rgb> BakePlan::cells() const {
    Canvas canvas(width_, height_, kPaperColour);
    for (const LeafAt& leaf : leavesAt(bake_.space->tree, area_, bake_.eye.y))
        for (size_t i = 0; i < leaf.outline.size(); ++i) {
            const glm::dvec2 &a = leaf.outline[i], &b = leaf.outline[(i + 1) % leaf.outline.size()];
            canvas.line(at({a.x, 0, a.y}), at({b.x, 0, b.y}), 0.7, kCellInk, 0.8);
        }
    for (const PlanLine& line : portalsAt(planCells(*bake_.space), bake_.eye.y))
        canvas.line(at(line.from), at(line.to), 1.2, kWitnessedColour, 0.5);
    drawWalls(canvas);  // above portals that are seen through from the backs of walls alone
    for (const PlanLine& gap : bake_.gaps) {
        canvas.line(at(gap.from), at(gap.to), 3, kGapInk);
        for (const glm::dvec3& end : {gap.from, gap.to}) canvas.disc(at(end), 3, kGapInk);
    }
    return canvas.image();
}

Image<Rgb> BakePlan::rows() const {
    return views([&](uint32_t leaf) { return colourOf(leaf); });
}

Image<Rgb> BakePlan::open() const {
    return views([&](uint32_t leaf) {
        const double held = std::max(1u, heldBy(leaf));
        return heatColour((held - witnessedBy(leaf)) / held);
    });
}

Image<Rgb> BakePlan::views(const std::function<Rgb(uint32_t leaf)>& colour) const {
    Canvas canvas(width_, height_, kPaperColour);
    for (const LeafAt& view : views_) canvas.fill(view.outline, colour(view.leaf));
    for (const LeafAt& view : views_)
        for (size_t i = 0; i < view.outline.size(); ++i)
            canvas.line(view.outline[i], view.outline[(i + 1) % view.outline.size()], 0.6, kPaperColour, 0.5);
    for (const PlanLine& line : walls_) canvas.line(at(line.from), at(line.to), 1.4, kPaperColour, 0.9);
    return canvas.image();
}

}  // namespace sightline::tools
