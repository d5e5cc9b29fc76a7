// One frame of a BSP scene: which samples a piece of a triangle has, and which part of the screen a subtree may touch.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/bsp/bsp_frame.h"

#include <cmath>

namespace sightline::studies {
namespace {

/// The triangles of those items that move, or of the others.
BspPolygons polygonsOf(const DrawList& list, const std::vector<uint8_t>& moves, bool moving) {
    BspPolygons polygons;
    std::vector<glm::dvec3> placed;
    for (size_t i = 0; i < list.items().size(); ++i) {
        if ((!moves.empty() && moves[i] != 0) != moving) continue;
        const DrawItem& item = list.items()[i];
        placed.clear();
        for (const glm::vec3& p : item.mesh.positions)
            placed.push_back(glm::dvec3(item.transform * glm::dvec4(glm::dvec3(p), 1.0)));
        for (size_t t = 0; t < item.mesh.triangles(); ++t) {
            if (!item.writes_depth.empty() && item.writes_depth[t] == 0) continue;
            const uint32_t* index = item.mesh.indices.data() + 3 * t;
            const glm::dvec3 corners[3] = {placed[index[0]], placed[index[1]], placed[index[2]]};
            polygons.add(corners, list.firstSurface(i) + static_cast<uint32_t>(t));
        }
    }
    return polygons;
}

/// Where a parallel view's eye lies, at infinity: against the direction that its projection does not see.
glm::dvec4 eyeAtInfinity(const View& view) {
    const glm::dmat4 rows = glm::transpose(view.projection);
    glm::dvec3 toward = glm::cross(glm::dvec3(rows[0]), glm::dvec3(rows[1]));
    if (toward.z < 0) toward = -toward;
    return bspParallelEye(-(glm::transpose(glm::dmat3(view.view)) * toward));
}

/// Grid places to samples of a row or to rows, within the screen.
int32_t clampTo(double value, int32_t limit) {
    return value > 0 ? (value < limit ? static_cast<int32_t>(value) : limit) : 0;
}

/// Holds the samples of an outline: sample i lies at i + 0.5.
/// @param room  to each side, for the rounding of the outline [samples, < 0.5]
ScreenWindow windowAround(std::span<const glm::dvec2> outline, double room, int32_t width, int32_t height) {
    glm::dvec2 low = outline[0], high = low;
    for (const glm::dvec2& p : outline) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    return {clampTo(std::floor(low.y - room), height), clampTo(std::ceil(high.y + room), height),
            clampTo(std::floor(low.x - room), width), clampTo(std::ceil(high.x + room), width)};
}

}  // namespace

BspScene buildBspScene(const DrawList& list, std::span<const uint8_t> moves, const BspSettings& settings) {
    BspScene scene;
    scene.moves.assign(moves.begin(), moves.end());
    scene.tree = buildBsp(polygonsOf(list, scene.moves, false), settings);
    if (!scene.moves.empty()) moveItems(scene, list);
    return scene;
}

void moveItems(BspScene& scene, const DrawList& list) {
    locatePolygons(scene.tree, polygonsOf(list, scene.moves, true), scene.overlay);
}

BspFrame::BspFrame(const BspScene& scene, const HiddenInput& input, HiddenImage& image)
    : scene_(scene),
      projector_(input.projector()),
      polygons_(projectAll(input.list, projector_)),
      polygon_of_(input.list.surfaces(), HiddenImage::kNone),
      seen_plane_(scene.tree.nodes.size() + scene.overlay.nodes.size(), HiddenImage::kNone),
      eye_(projector_.orthographic() ? eyeAtInfinity(input.view) : bspEye(projector_.eye())),
      origin_(projector_.eye()),
      width_(static_cast<int32_t>(input.view.width)),
      height_(static_cast<int32_t>(input.view.height)) {
    image.counters.geometry = projector_.counters();
    windows_.reserve(polygons_.size());
    for (uint32_t i = 0; i < polygons_.size(); ++i) {
        polygon_of_[polygons_[i].surface] = i;
        windows_.push_back(windowAround(polygons_[i].outline(), 0, width_, height_));
    }
    // x / w in [-1, 1] becomes [0, width]: places on the grid, as of ScreenPolygon.
    glm::dmat4 grid(0.0);
    grid[0][0] = 0.5 * width_;
    grid[3][0] = 0.5 * width_;
    grid[1][1] = 0.5 * height_;
    grid[3][1] = 0.5 * height_;
    grid[2][2] = grid[3][2] = grid[3][3] = 1;
    to_samples_ = grid * input.view.projection * glm::dmat4(glm::dmat3(input.view.view));
}

const glm::dvec4& BspFrame::planeOver(uint32_t i) {
    uint32_t& seen = seen_plane_[i];
    if (seen == HiddenImage::kNone) {
        seen = static_cast<uint32_t>(planes_.size());
        planes_.push_back(projector_.overSamples(node(i).plane));
    }
    return planes_[seen];
}

Box3d BspFrame::boundsOf(uint32_t i) const {
    const BspTree& tree = scene_.tree;
    if (i >= tree.nodes.size()) return scene_.overlay.bounds[i - scene_.overlay.first_node];
    Box3d box = tree.bounds[i];
    if (const BspOverlay::Entry* entry = scene_.overlay.entryOf(i)) box.grow(entry->bounds);
    return box;
}

uint32_t BspFrame::piecesBelow(uint32_t i) const {
    const BspTree& tree = scene_.tree;
    return i < tree.nodes.size() ? tree.below[i] : scene_.overlay.below[i - scene_.overlay.first_node];
}

ScreenWindow BspFrame::windowOf(const Box3d& box) const {
    const ScreenWindow all{0, height_, 0, width_};
    const glm::dvec4 base = to_samples_ * glm::dvec4(box.min - origin_, 1.0);
    const glm::dvec3 size = box.size();
    const glm::dvec4 x = to_samples_[0] * size.x, y = to_samples_[1] * size.y, z = to_samples_[2] * size.z;
    const glm::dvec4 corners[8] = {base,     base + x,     base + y,     base + x + y,
                                   base + z, base + x + z, base + y + z, base + x + y + z};
    glm::dvec2 low(1e300), high(-1e300);
    for (const glm::dvec4& corner : corners) {
        // Too near for a bound on rounding, before the near plane, or not a number.
        if (!(corner.z > 0 && corner.w > 1e-9 * (std::abs(base.w) + std::abs(x.w) + std::abs(y.w) + std::abs(z.w))))
            return all;
        const glm::dvec2 at = glm::dvec2(corner) / corner.w;
        low = glm::min(low, at);
        high = glm::max(high, at);
    }
    // A sample to each side is room for all rounding.
    return {clampTo(std::floor(low.y) - 1, height_), clampTo(std::ceil(high.y) + 1, height_),
            clampTo(std::floor(low.x) - 1, width_), clampTo(std::ceil(high.x) + 1, width_)};
}

/// Narrows the outline to what a cut may keep, rounding and all, and takes the cut up unless it keeps everything.
/// @param reach  beyond the outline and the screen, from the origin
/// @returns false if nothing is left
bool BspFrame::narrow(const ScreenCut& cut, const glm::dvec2& reach, std::vector<ScreenCut>& active) {
    const double size = std::abs(cut.a) * reach.x + std::abs(cut.b) * reach.y + std::abs(cut.c);
    if (!std::isfinite(size)) {
        active.push_back(cut);
        return true;
    }
    // ScreenCut's own sum is off by less than 4 * 2^-53 of this size, as are the values and crossings here.
    const double slack = 0x1p-46 * size;
    const double sign = cut.negative ? -1 : 1;
    const double a = sign * cut.a, b = sign * cut.b, c = sign * (cut.c - 0.5 * (cut.a + cut.b));
    const auto valueAt = [&](const glm::dvec2& p) { return a * p.x + (b * p.y + c); };
    double low = valueAt(outline_[0]), high = low;
    for (const glm::dvec2& p : outline_) {
        const double value = valueAt(p);
        low = value < low ? value : low;
        high = value > high ? value : high;
    }
    if (low > slack) return true;
    if (high < -slack) return false;
    active.push_back(cut);
    clipped_.clear();
    glm::dvec2 last = outline_.back();
    double from = valueAt(last) + slack;
    for (const glm::dvec2& p : outline_) {
        const double to = valueAt(p) + slack;
        if ((from >= 0) != (to >= 0)) clipped_.push_back(last + from / (from - to) * (p - last));
        if (to >= 0) clipped_.push_back(p);
        last = p;
        from = to;
    }
    outline_.swap(clipped_);
    return outline_.size() >= 3;
}

bool BspFrame::makeFragment(const BspPiece& piece, const BspArrays& arrays, BspFragment& out) {
    out.polygon = polygonOf(piece);
    if (!out.polygon) return false;
    out.cuts.clear();
    if (piece.cut == BspNode::kNone) {
        out.window = windowOf(piece);
        return !out.window.empty();
    }
    outline_.assign(out.polygon->outline().begin(), out.polygon->outline().end());
    glm::dvec2 reach(width_, height_);
    for (const glm::dvec2& p : outline_) reach = glm::max(reach, glm::abs(p));
    // The last cuts first: next to them, most of those before keep everything that is left.
    for (uint32_t i = piece.cut; i != BspNode::kNone; i = arrays.cuts[i].before) {
        const BspCut& at = arrays.cuts[i];
        const ScreenCut cut = cutOf(planeOver(at.node), out.polygon->depth);
        if (!narrow(at.side == kBspFront ? cut : cut.otherSide(), reach, out.cuts)) return false;
    }
    out.window = windowAround(outline_, 1e-3, width_, height_);
    return !out.window.empty();
}

}  // namespace sightline::studies
