// Finds the holes: parts of a face that are neither opaque wall nor portal become portals to what lies behind.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <utility>

#include "sightline/bake/marked/checked_cells.h"

namespace sightline::bake {
using namespace tools;
namespace {

/// The centre of its area; of its corners if it has none.
glm::dvec2 middleOf(const FlatPiece& piece) {
    glm::dvec2 corners(0), moment(0);
    double twice = 0;
    for (const glm::dvec2& point : piece) corners += point / static_cast<double>(piece.size());
    for (size_t i = 0; i < piece.size(); ++i) {
        const glm::dvec2 a = piece[i] - corners, b = piece[(i + 1) % piece.size()] - corners;
        const double area = a.x * b.y - a.y * b.x;
        twice += area;
        moment += area / 3 * (a + b);
    }
    return twice > 0 ? corners + moment / twice : corners;
}

}  // namespace

FlatPiece widened(const FlatPiece& piece, double by) {
    // Corners that are nearly straight go, and the piece is widened a little more to hold what they held.
    const double dull = by / 64;
    FlatPiece corners;
    for (const glm::dvec2& point : piece)
        if (corners.empty() || glm::length(point - corners.back()) > dull) corners.push_back(point);
    while (corners.size() > 1 && glm::length(corners.front() - corners.back()) <= dull) corners.pop_back();
    for (size_t i = 0; i < corners.size() && corners.size() > 3;) {
        const glm::dvec2 &before = corners[(i + corners.size() - 1) % corners.size()],
                         &after = corners[(i + 1) % corners.size()];
        const glm::dvec2 along = after - before, to = corners[i] - before;
        const bool straight = std::abs(along.x * to.y - along.y * to.x) <= dull / 8 * glm::length(along);
        if (straight) corners.erase(corners.begin() + static_cast<std::ptrdiff_t>(i));
        else ++i;
    }
    const size_t count = corners.size();
    if (count < 3) return grownBy(piece, by);
    const double out = by + 4 * dull;
    FlatPiece wide;
    for (size_t i = 0; i < count; ++i) {
        const glm::dvec2 in = glm::normalize(corners[i] - corners[(i + count - 1) % count]);
        const glm::dvec2 on = glm::normalize(corners[(i + 1) % count] - corners[i]);
        const glm::dvec2 right_in(in.y, -in.x), right_on(on.y, -on.x);
        const double open = 1 + glm::dot(right_in, right_on);
        if (!(open > 0.1)) return grownBy(piece, by);  // the corner is so sharp that its tip would reach far
        wide.push_back(corners[i] + (out / open) * (right_in + right_on));
    }
    return wide;
}

bool CheckedCells::isKnown(uint32_t a, uint32_t b, const std::vector<glm::dvec3>& outline) const {
    const auto known = holes_between_.find({std::min(a, b), std::max(a, b)});
    if (known == holes_between_.end()) return false;
    const double room = 2 * toleranceOf(a, b).thick();
    for (const uint32_t index : known->second) {
        const std::vector<glm::dvec3>& other = portals_[index].outline;
        const glm::dvec3 normal = glm::normalize(areaVector(other));
        const auto holds = [&](const glm::dvec3& point) {
            if (std::abs(glm::dot(normal, point - other[0])) > room) return false;
            for (size_t i = 0; i < other.size(); ++i) {
                const glm::dvec3 edge = other[(i + 1) % other.size()] - other[i];
                if (glm::dot(glm::cross(normal, edge), point - other[i]) < -room * glm::length(edge)) return false;
            }
            return true;
        };
        if (std::all_of(outline.begin(), outline.end(), holds)) return true;
    }
    return false;
}

bool CheckedCells::addHolePortal(uint32_t a, uint32_t b, const CheckedFace& face, const FlatPiece& piece) {
    std::vector<glm::dvec3> outline = face.frame.from(piece);
    if (b != kOutside && isKnown(a, b, outline)) return false;
    holes_between_[{std::min(a, b), std::max(a, b)}].push_back(static_cast<uint32_t>(portals_.size()));
    portals_.push_back(
        {a, b, face.frame.from(widened(piece, toleranceOf(a, b).thick())), ScenePortal::kNone, ScenePortal::kNone});
    return true;
}

void CheckedCells::addHole(uint32_t cell, const CheckedFace& face, const FlatHole& hole) {
    struct Way {
        double area = 0;
        glm::dvec2 moment{0};
        bool fresh = false;
    };
    std::map<uint32_t, Way> ways;
    const auto lead = [&](uint32_t to, const FlatPiece& piece, double area) {
        Way& way = ways[to];
        way.area += area;
        way.moment += area * middleOf(piece);
        way.fresh |= addHolePortal(cell, to, face, piece);
    };
    for (const FlatPiece& piece : hole.pieces) {
        FlatRest rest(piece);
        // It leads to the cells that begin right behind it, and to the outside where it only grazes a cell.
        Box3d box;
        for (const glm::dvec3& point : face.frame.from(piece)) box.grow(point);
        for (uint32_t other = 0; other < cells_.size(); ++other) {
            const CheckedCell& candidate = cells_[other];
            if (other == cell || !candidate.solid()) continue;
            const double thick = toleranceOf(cell, other).thick();
            bool apart = false;
            for (int axis = 0; axis < 3; ++axis)
                apart |= candidate.bounds.max[axis] < box.min[axis] - 4 * thick ||
                         box.max[axis] + 4 * thick < candidate.bounds.min[axis];
            if (apart) continue;
            const std::vector<glm::dvec3> behind = face.frame.from(piece, -2 * thick);
            if (clippedTo(candidate, behind, -thick).empty()) continue;
            const FlatPiece shared = hullOf(face.frame.to(clippedTo(candidate, behind, thick)));
            if (shared.empty()) continue;
            lead(other, shared, areaOf(shared));
            // What is left begins a little before the cell ends: whichever portal leads into that, no seam is between.
            const FlatPiece within = hullOf(face.frame.to(clippedTo(candidate, behind, 0)));
            if (!within.empty()) rest.take(grownBy(within, thick / 3));
        }
        if (rest.empty()) continue;
        for (const FlatHole& left : holesOf(rest.pieces(), cells_[cell].tolerance.slit, settings_.most_holes))
            for (const FlatPiece& part : left.pieces) lead(kOutside, part, areaOf(part));
    }
    double all = 0;  // area of the pieces; a hull makes it larger
    for (const FlatPiece& piece : hole.pieces) all += areaOf(piece);
    for (const auto& [to, way] : ways) {
        if (!way.fresh) continue;
        CellFinding finding;
        finding.cells[0] = cell;
        finding.cells[1] = to;
        finding.size = all > 0 ? way.area * std::min(1.0, hole.area / all) : 0;
        finding.place = face.frame.from(way.area > 0 ? way.moment / way.area : middleOf(hole.pieces[0]));
        report(std::move(finding));
    }
}

void CheckedCells::findHoles(uint32_t cell, CheckedFace& face, const std::vector<WallTriangle>& triangles) {
    const auto [slit, bend] = cells_[cell].tolerance;
    const double grow = slit / 3;
    struct Cover {
        FlatPiece piece;
        double at;
        uint32_t object;
    };
    std::vector<Cover> covers;
    for (const WallTriangle& triangle : triangles) {
        bool within = true;
        for (const glm::dvec3& corner : triangle.corners) within &= std::abs(face.frame.heightOf(corner)) <= bend;
        if (!within) continue;
        const FlatPiece front = frontOf(face.frame, triangle);
        if (front.empty() || sharedBy(front, face.outline).empty()) continue;
        covers.push_back({grownBy(front, grow), 0, triangle.object});
        covers.back().at = std::min({front[0].x, front[1].x, front[2].x});
    }
    // From one side to the other: pieces in the midst of nothing would be many.
    std::stable_sort(covers.begin(), covers.end(), [](const Cover& a, const Cover& b) { return a.at < b.at; });
    // A strip within the bend of another face may belong to the wall of that face.
    FlatPiece inner = face.outline;
    for (size_t i = 0; i < face.outline.size(); ++i) {
        const glm::dvec2 along = face.outline[(i + 1) % face.outline.size()] - face.outline[i];
        const double length = glm::length(along);
        if (!(length > 0)) continue;
        const glm::dvec2 normal(-along.y / length, along.x / length);
        if (!inner.empty()) inner = clipPiece(inner, {normal, -glm::dot(normal, face.outline[i]) - bend});
    }
    if (inner.empty()) return;
    FlatRest rest(inner);
    for (const FlatPiece& gate : face.gates) rest.take(grownBy(gate, grow));
    for (const Cover& cover : covers) {
        if (rest.empty()) break;
        rest.take(cover.piece);
        used_.insert(cover.object);
    }
    if (rest.empty()) return;
    for (const FlatHole& hole : holesOf(rest.pieces(), slit, settings_.most_holes)) {
        report_.merged_faces += hole.merged;
        addHole(cell, face, hole);
    }
}

void CheckedCells::findHoles() {
    std::vector<WallTriangle> triangles;
    for (uint32_t i = 0; i < cells_.size(); ++i) {
        if (!cells_[i].solid()) continue;
        Box3d near_by = cells_[i].bounds;
        near_by.min -= glm::dvec3(2 * cells_[i].tolerance.thick());
        near_by.max += glm::dvec3(2 * cells_[i].tolerance.thick());
        triangles.clear();
        walls_.gather(near_by, triangles);
        report_.faces += cells_[i].faces.size();
        for (CheckedFace& face : cells_[i].faces) findHoles(i, face, triangles);
    }
}

}  // namespace sightline::bake
