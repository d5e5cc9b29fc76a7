// Takes cells as they are marked, reports what is odd about them, and lays out what was found.
// SPDX-License-Identifier: MIT
#include "sightline/bake/marked/checked_cells.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

namespace sightline::bake {
using namespace tools;
namespace {

constexpr uint32_t kNone = ScenePortal::kNone;

std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.4g", value);
    return text;
}

std::vector<uint32_t> unmoved(const Scene& scene, const SceneCellSettings& settings) {
    std::vector<uint32_t> movable = settings.movable;
    for (const ScenePortal& portal : scene.portals)
        if (portal.door < scene.objects.size()) movable.push_back(portal.door);
    return movable;
}

/// Doors of one name get the keys of their leaves behind it: "Door 412".
void tellApart(std::vector<CellDoor>& doors) {
    std::map<std::string, int> times;
    for (const CellDoor& door : doors) ++times[door.name];
    for (CellDoor& door : doors)
        if (times[door.name] > 1) (door.name += ' ') += std::to_string(door.key);
}

/// The planes of a region that holds nothing, for what is no cell.
std::vector<glm::dvec4> nowhere(double far) { return {{1, 0, 0, -far}, {-1, 0, 0, -far}}; }

}  // namespace

std::vector<glm::dvec3> clippedTo(const CheckedCell& cell, std::vector<glm::dvec3> outline, double room) {
    for (glm::dvec4 plane : cell.planes) {
        plane.w += room;
        if (!outline.empty()) outline = clipOutline(outline, plane);
    }
    return outline;
}

glm::dvec3 areaVector(const std::vector<glm::dvec3>& outline) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += 0.5 * glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return area;
}

CheckedCells::CheckedCells(const Scene& scene, const SceneCellSettings& settings)
    : scene_(scene), settings_(settings), walls_(scene, unmoved(scene, settings)) {}

CellTolerance CheckedCells::toleranceIn(const Box3d& bounds) const {
    double size = 0, far = 0;
    if (bounds.finite()) {
        size = glm::length(bounds.size());
        const glm::dvec3 reach = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
        far = std::max({reach.x, reach.y, reach.z});
    }
    // The least distance that doubles can tell this far from the origin.
    const double least = (size + far) * 0x1p-36, wall = settings_.wall_tolerance;
    return {std::max(settings_.slit >= 0 ? settings_.slit : wall * 0x1p-13, least),
            std::max(settings_.bend >= 0 ? settings_.bend : wall * 0x1p-11, least)};
}

CellTolerance CheckedCells::toleranceOf(uint32_t a, uint32_t b) const {
    CellTolerance out;
    for (const uint32_t cell : {a, b})
        if (cell < cells_.size()) out.grow(cells_[cell].tolerance);
    return out;
}

void CheckedCells::report(CellFinding finding) {
    const auto nameOf = [&](uint32_t cell) -> std::string {
        return cell < cells_.size() ? "'" + cells_[cell].name + "'" : "outside";
    };
    const auto portalName = [&] { return "'" + scene_.portals[finding.portal].name + "'"; };
    std::string text;
    switch (finding.kind) {
        case CellFindingKind::kHole:
            text = "hole of " + number(finding.size) + " from " + nameOf(finding.cells[0]) + " to " +
                   nameOf(finding.cells[1]);
            ++report_.holes;
            report_.hole_area += finding.size;
            break;
        case CellFindingKind::kNoCell:
            text = nameOf(finding.cells[0]) + " is no convex solid";
            if (std::isfinite(finding.size)) text += ": it reaches " + number(finding.size) + " beyond its faces";
            ++report_.no_cells;
            break;
        case CellFindingKind::kOverlap:
            text = nameOf(finding.cells[0]) + " and " + nameOf(finding.cells[1]) + " overlap";
            ++report_.overlaps;
            break;
        case CellFindingKind::kStrayPortal:
            text = "portal " + portalName() + " does not lie between two cells";
            ++report_.stray_portals;
            break;
        case CellFindingKind::kBentPortal:
            text = "portal " + portalName() + " is not flat by " + number(finding.size);
            ++report_.bent_portals;
            break;
        case CellFindingKind::kStrayDoor:
            text = "the door of portal " + portalName() + " does not stand in it, or is not there";
            ++report_.stray_doors;
            break;
    }
    finding.text = text + ", near (" + number(finding.place.x) + ", " + number(finding.place.y) + ", " +
                   number(finding.place.z) + ")";
    report_.findings.push_back(std::move(finding));
}

void CheckedCells::layFaces(CheckedCell& cell) const {
    cell.faces.clear();
    const ConvexRegion region = convexRegion(cell.planes);
    if (region.kind != ConvexRegion::Kind::kSolid) {
        cell.planes.clear();
        return;
    }
    cell.bounds = region.bounds;
    for (const RegionFace& face : region.faces) {
        const FlatFrame frame(face.outline[0], glm::dvec3(cell.planes[face.plane]));
        cell.faces.push_back({face.plane, frame, frame.to(face.outline), {}});
    }
}

void CheckedCells::takeCells() {
    for (const SceneCell& marked : scene_.cells) {
        CheckedCell cell;
        cell.name = marked.name;
        cell.planes = marked.planes;
        cell.bounds = marked.bounds;
        if (!marked.planes.empty()) cell.tolerance = toleranceIn(marked.bounds);
        widest_.grow(cell.tolerance);
        const double allowed = std::max(cell.tolerance.thick(), 1e-3 * glm::length(marked.bounds.size()));
        bool finite = true;
        for (const glm::dvec4& plane : marked.planes) finite &= std::isfinite(glm::length(plane));
        if (!(marked.overhang <= allowed) || !finite) cell.planes.clear();
        if (cell.solid()) layFaces(cell);
        const bool solid = cell.solid();
        cells_.push_back(std::move(cell));
        if (solid) continue;
        CellFinding finding{CellFindingKind::kNoCell, {}, kNone, {}, marked.overhang, {}};
        finding.cells[0] = static_cast<uint32_t>(cells_.size() - 1);
        finding.cells[1] = kOutside;
        if (marked.bounds.finite()) finding.place = marked.bounds.center();
        report(std::move(finding));
    }
}

void CheckedCells::findOverlaps() {
    // Cells that are drawn by hand overlap a little by accident.
    const double room = settings_.trusted ? widest_.thick() : std::max(widest_.thick(), settings_.wall_tolerance);
    std::vector<uint32_t> order;
    for (uint32_t i = 0; i < cells_.size(); ++i)
        if (cells_[i].solid()) order.push_back(i);
    std::sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
        const double at_a = cells_[a].bounds.min.x, at_b = cells_[b].bounds.min.x;
        return at_a != at_b ? at_a < at_b : a < b;
    });
    for (size_t i = 0; i < order.size(); ++i)
        for (size_t k = i + 1; k < order.size(); ++k) {
            const CheckedCell &p = cells_[order[i]], &q = cells_[order[k]];
            if (q.bounds.min.x + room >= p.bounds.max.x) break;
            if (p.bounds.max.y - room <= q.bounds.min.y || q.bounds.max.y - room <= p.bounds.min.y) continue;
            if (p.bounds.max.z - room <= q.bounds.min.z || q.bounds.max.z - room <= p.bounds.min.z) continue;
            std::vector<glm::dvec4> planes = p.planes;
            planes.insert(planes.end(), q.planes.begin(), q.planes.end());
            for (glm::dvec4& plane : planes) plane.w -= room / 2;
            const ConvexRegion both = convexRegion(planes);
            if (both.kind != ConvexRegion::Kind::kSolid) continue;
            CellFinding finding;
            finding.kind = CellFindingKind::kOverlap;
            finding.cells[0] = std::min(order[i], order[k]);
            finding.cells[1] = std::max(order[i], order[k]);
            finding.place = both.bounds.center();
            const glm::dvec3 size = both.bounds.size();
            finding.size = size.x * size.y * size.z;
            report(std::move(finding));
        }
}

SceneCells CheckedCells::finish() {
    double far = 1;
    for (const CheckedCell& cell : cells_) {
        if (!cell.solid()) continue;
        const glm::dvec3 reach = glm::max(glm::abs(cell.bounds.min), glm::abs(cell.bounds.max));
        far = std::max({far, reach.x, reach.y, reach.z});
    }
    CellSpace space;
    for (const CheckedCell& cell : cells_) {
        const std::vector<glm::dvec4> own = cell.solid() ? cell.planes : nowhere(4 * far);
        CellRegion region;
        region.first_plane = static_cast<uint32_t>(space.planes.size());
        region.plane_count = static_cast<uint32_t>(own.size());
        const glm::dvec3 place = cell.bounds.finite() ? cell.bounds.center() : glm::dvec3(0);
        region.bounds = cell.solid() ? cell.bounds : Box3d{place, place};
        space.planes.insert(space.planes.end(), own.begin(), own.end());
        space.regions.push_back(region);
        space.names.push_back(cell.name);
    }
    space.graph.cells = static_cast<uint32_t>(cells_.size());
    for (const FoundPortal& portal : portals_) report_.outside |= portal.b == kOutside;
    if (report_.outside) {
        space.outside = space.graph.cells++;
        space.regions.push_back({static_cast<uint32_t>(space.planes.size()), 0, {}});
        space.names.push_back("outside");
    }
    std::map<uint32_t, uint32_t> doors;
    for (const FoundPortal& portal : portals_) {
        uint32_t door = CellPortal::kNone;
        if (portal.door != kNone) {
            const auto [known, fresh] = doors.try_emplace(portal.door, static_cast<uint32_t>(space.doors.size()));
            const SceneObject& leaf = scene_.objects[portal.door];
            if (fresh) space.doors.push_back({leaf.name, leaf.key, {}});
            door = known->second;
            if (space.doors[door].slide == glm::dvec3(0)) space.doors[door].slide = scene_.portals[portal.marked].slide;
        }
        space.graph.addPortal(portal.a, portal.b == kOutside ? space.outside : portal.b, portal.outline, door);
    }
    tellApart(space.doors);
    space.tolerance = 2 * widest_.thick();
    report_.slit = widest_.slit;
    report_.bend = widest_.bend;
    report_.walls.assign(used_.begin(), used_.end());
    return {std::move(space), std::move(report_)};
}

}  // namespace sightline::bake
