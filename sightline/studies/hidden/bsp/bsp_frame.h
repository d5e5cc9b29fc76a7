// One frame of a BSP scene: which samples a piece of a triangle has, and which part of the screen a subtree may touch.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include "sightline/bsp/bsp.h"
#include "sightline/bsp/bsp_walk.h"
#include "sightline/studies/hidden/draw_item.h"
#include "sightline/studies/hidden/method_input.h"
#include "sightline/studies/hidden/project/cut.h"
#include "sightline/studies/hidden/project/scan.h"

namespace sightline::studies {

/// Pieces are numbered by their surfaces.
struct BspScene {
    BspTree tree;
    BspOverlay overlay;
    std::vector<uint8_t> moves;  ///< per item of the list: 1 if it is in the overlay [size: items, or empty]
};

/// All triangles that write depth, of the items that do not move, as they are placed now.
/// @param moves  per item: not 0 if moveItems() shall place it  [size: items, or empty for none]
BspScene buildBspScene(const DrawList& list, std::span<const uint8_t> moves = {}, const BspSettings& settings = {});

/// Places the items that move as their transforms say now; the tree stays as it is.
void moveItems(BspScene& scene, const DrawList& list);

/// Rows and samples, half open.
struct ScreenWindow {
    int32_t row_begin = 0, row_end = 0, begin = 0, end = 0;
    bool empty() const { return row_begin >= row_end || begin >= end; }
};

/// A piece as it is drawn: its triangle's polygon, the cuts that its samples keep to, and a window that holds them.
///
/// The outline of a piece is never scanned itself: each sample of a triangle belongs to exactly one of its pieces, and
/// there are no cracks between them.
struct BspFragment {
    const ScreenPolygon* polygon = nullptr;
    std::vector<ScreenCut> cuts;
    ScreenWindow window;
};

/// Calls fill(row, begin, end) for the samples of a fragment in some rows of its window.
template <class Fill>
void scanFragment(const BspFragment& fragment, int32_t row_begin, int32_t row_end, int32_t width, Fill&& fill) {
    scanPolygon(fragment.polygon->outline(), row_begin, row_end, width, [&](int32_t row, int32_t begin, int32_t end) {
        for (const ScreenCut& cut : fragment.cuts) cut.narrow(row, begin, end);
        if (begin < end) fill(row, begin, end);
    });
}

class BspFrame {
public:
    /// Projects all triangles once. Counts into the image.
    BspFrame(const BspScene& scene, const HiddenInput& input, HiddenImage& image);

    /// @returns false if nothing of the piece can be seen, whatever is in front of it
    bool makeFragment(const BspPiece& piece, const BspArrays& arrays, BspFragment& out);

    /// The triangle that a piece is of, or null if that is not drawn.
    const ScreenPolygon* polygonOf(const BspPiece& piece) const {
        const uint32_t polygon = polygon_of_[piece.number];
        return polygon == HiddenImage::kNone ? nullptr : &polygons_[polygon];
    }

    /// Holds all samples at which anything in a box can be seen: the whole screen, if the box comes before the near plane.
    ScreenWindow windowOf(const Box3d& box) const;
    /// Holds all samples of the triangle that a piece is of: none, if that is not drawn.
    ScreenWindow windowOf(const BspPiece& piece) const {
        const uint32_t polygon = polygon_of_[piece.number];
        return polygon == HiddenImage::kNone ? ScreenWindow{} : windows_[polygon];
    }

    const glm::dvec4& eye() const { return eye_; }
    const BspScene& scene() const { return scene_; }
    Box3d boundsOf(uint32_t node) const;
    uint32_t piecesBelow(uint32_t node) const;

    /// Calls draw(piece, arrays) for what lies in a node's plane, by number.
    template <class Draw>
    void forPieces(uint32_t node, bool descending, Draw&& draw) const;

    /// The static tree's node, or the overlay's.
    const BspNode& node(uint32_t i) const {
        return i < scene_.tree.nodes.size() ? scene_.tree.nodes[i]
                                            : scene_.overlay.nodes[i - scene_.overlay.first_node];
    }

private:
    const glm::dvec4& planeOver(uint32_t node);
    bool narrow(const ScreenCut& cut, const glm::dvec2& reach, std::vector<ScreenCut>& active);

    const BspScene& scene_;
    Projector projector_;
    std::vector<ScreenPolygon> polygons_;
    std::vector<ScreenWindow> windows_;  ///< per polygon
    std::vector<uint32_t> polygon_of_;   ///< per surface, or kNone
    std::vector<uint32_t> seen_plane_;   ///< per node: its plane over the samples, or kNone
    std::vector<glm::dvec4> planes_;
    glm::dvec4 eye_{0.0};
    glm::dmat4 to_samples_{1.0};  ///< world, relative to the eye, to (i w, j w, near plane's distance, w)
    glm::dvec3 origin_{0.0};
    int32_t width_, height_;
    std::vector<glm::dvec2> outline_, clipped_;
};

/// The tree itself, or the tree with what moves in it.
template <class Walk>
void withTree(const BspScene& scene, Walk&& walk) {
    if (scene.overlay.entries.empty() && scene.overlay.touched_leaves.empty()) walk(BspStatic{scene.tree});
    else walk(BspOverlaid{scene.tree, scene.overlay});
}

template <class Draw>
void BspFrame::forPieces(uint32_t i, bool descending, Draw&& draw) const {
    const BspTree& tree = scene_.tree;
    const BspOverlay& overlay = scene_.overlay;
    std::span<const BspPiece> pieces[2];
    const BspArrays* arrays[2] = {&tree, &overlay};
    if (i < tree.nodes.size()) {
        pieces[0] = tree.piecesOf(tree.nodes[i]);
        if (const BspOverlay::Entry* entry = overlay.entryOf(i)) pieces[1] = overlay.piecesOf(*entry);
    } else {
        pieces[1] = overlay.piecesOf(node(i));
    }
    while (!pieces[0].empty() || !pieces[1].empty()) {
        int of = pieces[0].empty() ? 1 : 0;
        const auto next = [&](int k) -> const BspPiece& { return descending ? pieces[k].back() : pieces[k].front(); };
        if (!pieces[0].empty() && !pieces[1].empty()) of = (next(1).number < next(0).number) != descending ? 1 : 0;
        draw(next(of), *arrays[of]);
        pieces[of] = descending ? pieces[of].first(pieces[of].size() - 1) : pieces[of].subspan(1);
    }
}

}  // namespace sightline::studies
