// Lays marked portals into the faces of their cells, and adds cells for the thickness of walls.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "sightline/bake/marked/checked_cells.h"
#include "sightline/geom/outline_hull.h"

namespace sightline::bake {
using namespace tools;
namespace {

constexpr uint32_t kNoDoor = ScenePortal::kNone;

double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

/// The outline, carried along a direction onto a plane.
std::vector<glm::dvec3> carried(const std::vector<glm::dvec3>& outline, const glm::dvec3& along,
                                const glm::dvec4& plane) {
    std::vector<glm::dvec3> out;
    for (const glm::dvec3& point : outline)
        out.push_back(point - (heightOf(plane, point) / glm::dot(glm::dvec3(plane), along)) * along);
    return out;
}

/// Counter-clockwise, whatever the outline's sense is in the frame.
FlatPiece pieceOf(const FlatFrame& frame, const std::vector<glm::dvec3>& outline) {
    return hullOf(frame.to(std::span<const glm::dvec3>(outline)));
}

}  // namespace

void CheckedCells::moveFaces() {
    for (uint32_t i = 0; i < cells_.size(); ++i) {
        CheckedCell& cell = cells_[i];
        if (!cell.solid()) continue;
        // Where a marked portal lies, a wall is not expected.
        for (const ScenePortal& portal : scene_.portals) {
            if ((portal.cells[0] != i && portal.cells[1] != i) || portal.polygon.size() < 3) continue;
            const glm::dvec3 area = areaVector(portal.polygon);
            for (CheckedFace& face : cell.faces) {
                const double along = glm::dot(area, glm::dvec3(cell.planes[face.plane]));
                if (std::abs(along) < 0.9 * glm::length(area)) continue;
                if (std::abs(face.frame.heightOf(portal.polygon[0])) > 2 * settings_.wall_tolerance) continue;
                FlatPiece gate = sharedBy(pieceOf(face.frame, portal.polygon), face.outline);
                if (!gate.empty()) face.gates.push_back(std::move(gate));
            }
        }
        moveFaces(cell, cell.planes.size(), settings_.wall_tolerance);
    }
}

void CheckedCells::moveFaces(CheckedCell& cell, size_t planes, double reach) {
    if (!(reach > 0)) return;
    Box3d near_by = cell.bounds;
    near_by.min -= glm::dvec3(reach + cell.tolerance.thick());
    near_by.max += glm::dvec3(reach + cell.tolerance.thick());
    std::vector<WallTriangle> triangles;
    walls_.gather(near_by, triangles);
    CheckedCell moved = cell;
    uint64_t count = 0;
    for (CheckedFace& face : cell.faces) {
        if (face.plane >= planes) continue;
        const std::vector<glm::dvec3> outline = face.frame.from(face.outline);
        const auto sheet =
            sheetNear(outline, cell.planes[face.plane], face.frame, face.gates, triangles, reach, cell.tolerance.bend);
        face.gates.clear();
        if (!sheet) continue;
        double off = 0;
        for (const glm::dvec3& corner : outline) off = std::max(off, std::abs(heightOf(*sheet, corner)));
        if (off <= cell.tolerance.bend / 2) continue;
        moved.planes[face.plane] = *sheet;
        ++count;
    }
    for (CheckedFace& face : moved.faces) face.gates.clear();
    if (count == 0) return;
    layFaces(moved);
    if (!moved.solid()) return;
    cell = std::move(moved);
    report_.moved_faces += count;
}

int CheckedCells::faceNear(const CheckedCell& cell, const Lying& lying, double side) const {
    int best = -1;
    double least = 2 * settings_.wall_tolerance + cell.tolerance.thick();
    for (size_t i = 0; i < cell.faces.size(); ++i) {
        const CheckedFace& face = cell.faces[i];
        const glm::dvec4& plane = cell.planes[face.plane];
        if (side * glm::dot(glm::dvec3(plane), lying.normal) < 0.9) continue;
        double off = 0;
        for (const glm::dvec3& corner : lying.outline) off = std::max(off, std::abs(face.frame.heightOf(corner)));
        if (off > least) continue;
        if (sharedBy(pieceOf(face.frame, carried(lying.outline, lying.normal, plane)), face.outline).empty()) continue;
        best = static_cast<int>(i);
        least = off;
    }
    return best;
}

bool CheckedCells::lies(uint32_t index, Lying& lying) {
    const ScenePortal& portal = scene_.portals[index];
    CellFinding finding;
    finding.portal = index;
    finding.kind = CellFindingKind::kStrayPortal;
    for (int side = 0; side < 2; ++side)
        finding.cells[side] = portal.cells[side] < cells_.size() ? portal.cells[side] : kOutside;
    if (!portal.polygon.empty()) finding.place = portal.polygon[0];
    const auto stray = [&] {
        report(finding);
        return false;
    };
    if (portal.polygon.size() < 3) return stray();
    const glm::dvec3 area = areaVector(portal.polygon);
    if (!(glm::length(area) > 0) || !std::isfinite(glm::length(area))) return stray();
    lying.normal = glm::normalize(area);
    glm::dvec3 middle(0);
    for (const glm::dvec3& point : portal.polygon)
        middle += (point - portal.polygon[0]) / static_cast<double>(portal.polygon.size());
    finding.place = lying.middle = portal.polygon[0] + middle;
    lying.outline = outlineHull(portal.polygon, lying.normal);
    if (lying.outline.size() < 3) return stray();
    double bend = 0;
    for (glm::dvec3& point : lying.outline) {
        const double off = glm::dot(lying.normal, point - lying.middle);
        bend = std::max(bend, std::abs(off));
        point -= off * lying.normal;
    }
    if (bend > std::max(toleranceOf(portal.cells[0], portal.cells[1]).thick(), 1e-3 * std::sqrt(glm::length(area)))) {
        CellFinding bent = finding;
        bent.kind = CellFindingKind::kBentPortal;
        bent.size = bend;
        report(std::move(bent));
    }
    if (portal.cells[0] >= cells_.size() || portal.cells[1] >= cells_.size() || portal.cells[0] == portal.cells[1])
        return stray();
    for (int side = 0; side < 2; ++side) {
        const CheckedCell& cell = cells_[portal.cells[side]];
        if (!cell.solid()) return false;  // reported already; the portal leads outside
        lying.face[side] = faceNear(cell, lying, side == 0 ? 1 : -1);
        if (lying.face[side] < 0) return stray();
    }
    return true;
}

uint32_t CheckedCells::doorOf(uint32_t index, const Lying& lying) {
    const ScenePortal& portal = scene_.portals[index];
    if (portal.door == kNoDoor && portal.door_name.empty()) return kNoDoor;
    if (portal.door < scene_.objects.size()) {
        const SceneObject& leaf = scene_.objects[portal.door];
        const Box3d box = transformBox(scene_.meshes[leaf.mesh].bounds, leaf.transform);
        Box3d around;
        for (const glm::dvec3& point : lying.outline) around.grow(point);
        const double reach = std::max(settings_.wall_tolerance, toleranceOf(portal.cells[0], portal.cells[1]).thick());
        bool near_by = box.finite();
        for (int axis = 0; axis < 3; ++axis)
            near_by &= box.min[axis] <= around.max[axis] + reach && box.max[axis] >= around.min[axis] - reach;
        if (near_by) return portal.door;
    }
    CellFinding finding;
    finding.kind = CellFindingKind::kStrayDoor;
    finding.portal = index;
    finding.cells[0] = portal.cells[0];
    finding.cells[1] = portal.cells[1];
    finding.place = lying.middle;
    report(std::move(finding));
    return kNoDoor;
}

FlatPiece CheckedCells::addGate(uint32_t a, int face, uint32_t b, const FlatPiece& piece) {
    CheckedFace& from = cells_[a].faces[static_cast<size_t>(face)];
    const FlatPiece shared = sharedBy(piece, from.outline);
    if (shared.empty()) return {};
    FlatPiece gate = pieceOf(from.frame, clippedTo(cells_[b], from.frame.from(shared), toleranceOf(a, b).thick()));
    if (gate.size() < 3) return {};
    from.gates.push_back(gate);
    return gate;
}

void CheckedCells::join(uint32_t portal, const Lying& lying, uint32_t a, int face_a, uint32_t b, int face_b,
                        uint32_t door) {
    const uint32_t cell[2] = {a, b};
    const int face[2] = {face_a, face_b};
    const double thick = toleranceOf(a, b).thick();
    FlatPiece gate[2];
    const auto faceOf = [&](int side) -> const CheckedFace& {
        return cells_[cell[side]].faces[static_cast<size_t>(face[side])];
    };
    for (int side = 0; side < 2; ++side) {
        const CheckedFace& onto = faceOf(side);
        const auto outline = carried(lying.outline, lying.normal, cells_[cell[side]].planes[onto.plane]);
        gate[side] = addGate(cell[side], face[side], cell[1 - side], pieceOf(onto.frame, outline));
    }
    // One portal is enough where both faces are in one plane.
    if (!gate[0].empty() && !gate[1].empty()) {
        const std::vector<glm::dvec3> other = faceOf(1).frame.from(gate[1]);
        double off = 0;
        for (const glm::dvec3& point : other) off = std::max(off, std::abs(faceOf(0).frame.heightOf(point)));
        if (off <= thick) {
            const FlatPiece more = pieceOf(faceOf(0).frame, other);
            gate[0].insert(gate[0].end(), more.begin(), more.end());
            gate[0] = hullOf(std::move(gate[0]));
            gate[1].clear();
        }
    }
    for (int side = 0; side < 2; ++side)
        if (!gate[side].empty())
            portals_.push_back(
                {cell[side], cell[1 - side], faceOf(side).frame.from(widened(gate[side], thick)), portal, door});
}

uint32_t CheckedCells::addPassage(uint32_t portal, const Lying& lying, const glm::dvec4& plane_a,
                                  const glm::dvec4& plane_b) {
    CheckedCell passage;
    passage.name = "passage " + scene_.portals[portal].name;
    passage.tolerance = toleranceOf(scene_.portals[portal].cells[0], scene_.portals[portal].cells[1]);
    const std::vector<glm::dvec3>& outline = lying.outline;
    double width = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[(i + 1) % outline.size()] - outline[i];
        if (!(glm::length(edge) > passage.tolerance.thick())) continue;
        const glm::dvec3 normal = glm::normalize(glm::cross(lying.normal, edge));
        passage.planes.emplace_back(normal, -glm::dot(normal, outline[i]));
        double across = 0;
        for (const glm::dvec3& point : outline) across = std::max(across, glm::dot(normal, point - outline[i]));
        width = std::min(width, across);
    }
    const size_t sides = passage.planes.size();
    passage.planes.push_back(-plane_a);
    passage.planes.push_back(-plane_b);
    layFaces(passage);
    if (!passage.solid()) return kOutside;
    moveFaces(passage, sides, std::min(settings_.wall_tolerance, width / 4));
    cells_.push_back(std::move(passage));
    ++report_.passages;
    return static_cast<uint32_t>(cells_.size() - 1);
}

bool CheckedCells::placePortal(uint32_t index, const Lying& lying) {
    const ScenePortal& portal = scene_.portals[index];
    const uint32_t a = portal.cells[0], b = portal.cells[1];
    const auto planeOf = [&](uint32_t cell, int face) {
        return cells_[cell].planes[cells_[cell].faces[static_cast<size_t>(face)].plane];
    };
    const glm::dvec4 plane_a = planeOf(a, lying.face[0]), plane_b = planeOf(b, lying.face[1]);
    // Along its normal: how far the portal's plane lies before the faces, and how far these are apart.
    double out_a = -std::numeric_limits<double>::infinity(), out_b = out_a, gap = out_a;
    double least_a = -out_a, least_b = -out_a;
    for (const glm::dvec3& corner : lying.outline) {
        const double from_a = -heightOf(plane_a, corner) / glm::dot(glm::dvec3(plane_a), lying.normal);
        const double from_b = heightOf(plane_b, corner) / glm::dot(glm::dvec3(plane_b), lying.normal);
        out_a = std::max(out_a, from_a);
        out_b = std::max(out_b, from_b);
        least_a = std::min(least_a, from_a);
        least_b = std::min(least_b, from_b);
        gap = std::max(gap, from_a + from_b);
    }
    const uint32_t door = doorOf(index, lying);
    const double thick = toleranceOf(a, b).thick();
    if (gap <= thick) {
        join(index, lying, a, lying.face[0], b, lying.face[1], door);
        return true;
    }
    const auto faceOf = [&](uint32_t cell, size_t from_end) {
        const CheckedCell& passage = cells_[cell];
        for (size_t i = 0; i < passage.faces.size(); ++i)
            if (passage.faces[i].plane + from_end == passage.planes.size()) return static_cast<int>(i);
        return -1;
    };
    // A passage's own ends may be wider than the portal: as wide as the passage.
    const auto joinEnd = [&](uint32_t cell, int face, uint32_t passage, int end, uint32_t shut_by) {
        if (end < 0) return;
        const CheckedFace& own = cells_[passage].faces[static_cast<size_t>(end)];
        Lying whole = lying;
        whole.outline = own.frame.from(own.outline);
        join(index, whole, cell, face, passage, end, shut_by);
    };
    if (door != kNoDoor && least_a > thick && least_b > thick) {
        // The leaf stands within the wall: it is seen from both sides when it is shut.
        const glm::dvec4 middle(lying.normal, -glm::dot(lying.normal, lying.middle));
        const uint32_t first = addPassage(index, lying, plane_a, -middle);
        const uint32_t second = addPassage(index, lying, middle, plane_b);
        if (first == kOutside || second == kOutside) return false;
        joinEnd(a, lying.face[0], first, faceOf(first, 2), kNoDoor);
        joinEnd(b, lying.face[1], second, faceOf(second, 1), kNoDoor);
        const int near_end = faceOf(first, 1), far_end = faceOf(second, 2);
        if (near_end < 0 || far_end < 0) return false;
        const CheckedFace& own = cells_[first].faces[static_cast<size_t>(near_end)];
        Lying whole = lying;
        whole.outline = own.frame.from(own.outline);
        join(index, whole, first, near_end, second, far_end, door);
        return true;
    }
    const uint32_t passage = addPassage(index, lying, plane_a, plane_b);
    if (passage == kOutside) return false;
    const bool at_a = std::abs(out_a) <= std::abs(out_b);
    joinEnd(a, lying.face[0], passage, faceOf(passage, 2), at_a ? door : kNoDoor);
    joinEnd(b, lying.face[1], passage, faceOf(passage, 1), at_a ? kNoDoor : door);
    return true;
}

void CheckedCells::placePortals() {
    for (uint32_t i = 0; i < scene_.portals.size(); ++i) {
        Lying lying;
        if (!lies(i, lying) || placePortal(i, lying)) continue;
        CellFinding finding;
        finding.kind = CellFindingKind::kStrayPortal;
        finding.portal = i;
        finding.place = lying.middle;
        report(std::move(finding));
    }
}

void CheckedCells::trustPortals() {
    for (uint32_t i = 0; i < scene_.portals.size(); ++i) {
        const ScenePortal& portal = scene_.portals[i];
        Lying lying;
        (void)lies(i, lying);
        if (portal.cells[0] >= cells_.size() || portal.cells[1] >= cells_.size()) continue;
        if (portal.cells[0] == portal.cells[1] || portal.polygon.size() < 3) continue;
        const bool solid[2] = {cells_[portal.cells[0]].solid(), cells_[portal.cells[1]].solid()};
        if (!solid[0] && !solid[1]) continue;
        std::vector<glm::dvec3> outline = portal.polygon;
        if (!solid[0]) std::reverse(outline.begin(), outline.end());
        const uint32_t a = portal.cells[solid[0] ? 0 : 1];
        const uint32_t b = solid[0] && solid[1] ? portal.cells[1] : kOutside;
        portals_.push_back({a, b, std::move(outline), i, doorOf(i, lying)});
    }
}

}  // namespace sightline::bake
