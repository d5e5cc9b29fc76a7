// The triangles of a sheet in the coordinates of its plane, so that those near a piece of it are found.
// SPDX-License-Identifier: MIT
#include "sightline/bake/soup/flat_sheet.h"

#include <algorithm>
#include <limits>
#include <utility>

namespace sightline::bake {

FlatSheet::FlatSheet(const SoupWalls& walls, const WallSheet& sheet)
    : frame_(-sheet.plane.w * glm::dvec3(sheet.plane), glm::dvec3(sheet.plane)) {
    for (const uint32_t t : sheet.triangles) {
        const WallTriangle& triangle = walls.triangles[t];
        SheetTriangle flat;
        FlatPiece piece = frame_.to(triangle.corners);
        const double area = areaOf(piece);
        if (area == 0) continue;
        flat.sides = triangle.both ? 3 : area > 0 ? 1 : 2;
        if (area < 0) std::swap(piece[1], piece[2]);
        flat.rounding = triangle.rounding;
        flat.piece = grownBy(piece, triangle.rounding / 3);
        if (flat.piece.empty()) continue;
        flat.min = flat.max = flat.piece[0];
        for (const glm::dvec2& point : flat.piece) {
            flat.min = glm::min(flat.min, point);
            flat.max = glm::max(flat.max, point);
        }
        flat.triangle = t;
        triangles_.push_back(std::move(flat));
    }
    std::stable_sort(triangles_.begin(), triangles_.end(),
                     [](const SheetTriangle& a, const SheetTriangle& b) { return a.min.x < b.min.x; });
    double farthest = -std::numeric_limits<double>::infinity();
    for (const SheetTriangle& triangle : triangles_) right_.push_back(farthest = std::max(farthest, triangle.max.x));
}

void FlatSheet::gather(const FlatPiece& piece, std::vector<const SheetTriangle*> near[2]) const {
    glm::dvec2 min = piece[0], max = piece[0];
    for (const glm::dvec2& point : piece) {
        min = glm::min(min, point);
        max = glm::max(max, point);
    }
    const auto first = std::lower_bound(right_.begin(), right_.end(), min.x) - right_.begin();
    for (auto i = static_cast<size_t>(first); i < triangles_.size(); ++i) {
        const SheetTriangle& triangle = triangles_[i];
        if (triangle.min.x > max.x) break;
        if (triangle.max.x < min.x || triangle.max.y < min.y || triangle.min.y > max.y) continue;
        if (sharedBy(triangle.piece, piece).empty()) continue;
        if ((triangle.sides & 1) != 0) near[0].push_back(&triangle);
        if ((triangle.sides & 2) != 0) near[1].push_back(&triangle);
    }
}

}  // namespace sightline::bake
