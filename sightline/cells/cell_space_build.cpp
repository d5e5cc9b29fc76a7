// Cells and portals from code become a CellSpace, piece by piece.
// SPDX-License-Identifier: MIT
#include "sightline/cells/cell_space_build.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sightline/base/assert.h"
#include "sightline/geom/convex_region.h"
#include "sightline/math/finite.h"

namespace sightline {
namespace {

Error fault(std::string_view kind, std::string_view name, std::string_view what) {
    std::string message(kind);
    message += " '";
    for (const char c : name.substr(0, 80)) message += static_cast<unsigned char>(c) < 0x20 ? '?' : c;
    message += "': ";
    message += what;
    return Error{Error::Kind::kUsage, std::move(message)};
}

}  // namespace

Result<uint32_t> CellSpaceBuilder::addCell(std::string name, std::span<const glm::dvec4> planes) {
    std::vector<glm::dvec4> unit(planes.begin(), planes.end());
    for (glm::dvec4& plane : unit) {
        const double length = glm::length(glm::dvec3(plane));
        if (!isFinite(plane) || !std::isfinite(plane.w) || !(length > 0) || !std::isfinite(length))
            return fault("cell", name, "a plane is not finite or has no normal");
        plane /= length;
    }
    const ConvexRegion region = convexRegion(unit);
    if (region.kind == ConvexRegion::Kind::kUnbounded) return fault("cell", name, "its planes do not close it");
    if (region.kind == ConvexRegion::Kind::kEmpty) return fault("cell", name, "its planes leave nothing");
    CellRegion cell;
    cell.first_plane = static_cast<uint32_t>(space_.planes.size());
    cell.plane_count = static_cast<uint32_t>(unit.size());
    cell.bounds = region.bounds;
    glm::dvec3 sum(0.0);
    double corners = 0;
    for (const RegionFace& face : region.faces) {
        for (const glm::dvec3& corner : face.outline) sum += corner;
        corners += static_cast<double>(face.outline.size());
    }
    middles_.push_back(sum / corners);
    space_.planes.insert(space_.planes.end(), unit.begin(), unit.end());
    space_.regions.push_back(cell);
    space_.names.push_back(std::move(name));
    return space_.graph.cells++;
}

Result<uint32_t> CellSpaceBuilder::addCell(std::string name, const Box3d& box) {
    if (!box.finite()) return fault("cell", name, "its box is not finite");
    const glm::dvec3 size = box.size();
    if (!(size.x > 0 && size.y > 0 && size.z > 0)) return fault("cell", name, "its box is flat or inside out");
    return addCell(std::move(name), planesOfBox(box));
}

Result<uint32_t> CellSpaceBuilder::addHull(std::string name, std::span<const glm::dvec3> points) {
    if (points.size() < 4 || points.size() > 64) return fault("cell", name, "needs 4 to 64 points");
    for (const glm::dvec3& point : points)
        if (!isFinite(point)) return fault("cell", name, "a point is not finite");
    const std::vector<glm::dvec4> planes = planesAround(points);
    if (planes.empty()) return fault("cell", name, "its points lie in one plane");
    return addCell(std::move(name), planes);
}

uint32_t CellSpaceBuilder::outside() {
    if (space_.outside != CellGraph::kNoCell) return space_.outside;
    space_.regions.push_back({static_cast<uint32_t>(space_.planes.size()), 0, {}});
    space_.names.push_back("outside");
    middles_.emplace_back(0.0);
    return space_.outside = space_.graph.cells++;
}

Result<uint32_t> CellSpaceBuilder::addDoor(std::string name, uint64_t key, const glm::dvec3& slide) {
    if (!isFinite(slide)) return fault("door", name, "its slide is not finite");
    space_.doors.push_back({std::move(name), key, slide});
    return static_cast<uint32_t>(space_.doors.size() - 1);
}

Status CellSpaceBuilder::addPortal(std::string_view name, uint32_t a, uint32_t b, std::span<const glm::dvec3> outline,
                                   uint32_t door) {
    if (a >= space_.graph.cells || b >= space_.graph.cells) return fault("portal", name, "there is no such cell");
    if (a == b) return fault("portal", name, "leads from a cell into the same");
    if (door != CellPortal::kNone && door >= space_.doors.size()) return fault("portal", name, "there is no such door");
    if (outline.size() < 3) return fault("portal", name, "has fewer than 3 points");
    for (const glm::dvec3& point : outline)
        if (!isFinite(point)) return fault("portal", name, "a point is not finite");
    const size_t before = space_.graph.portals.size();
    if (!space_.graph.addPortal(a, b, outline, door)) return fault("portal", name, "has no area");
    // An outline that runs the other way round is the same hole seen from b.
    for (size_t i = before; i < space_.graph.portals.size(); ++i) {
        CellPortal& portal = space_.graph.portals[i];
        if (rise(portal.cells[0], portal.cells[1], portal.plane) < 0) std::swap(portal.cells[0], portal.cells[1]);
    }
    return success();
}

/// How much higher above a plane the middle of a is than that of b; where one is the outside, than the plane.
double CellSpaceBuilder::rise(uint32_t a, uint32_t b, const glm::dvec4& plane) const {
    SIGHTLINE_DEBUG_ASSERT(middles_.size() == space_.graph.cells && a < middles_.size() && b < middles_.size());
    const auto height = [&](uint32_t cell) {
        return cell == space_.outside ? 0.0 : glm::dot(plane, glm::dvec4(middles_[cell], 1.0));
    };
    return height(a) - height(b);
}

CellSpace CellSpaceBuilder::take(double tolerance) {
    double largest = 0;
    for (const CellRegion& region : space_.regions)
        for (int axis = 0; axis < 3 && !region.bounds.empty(); ++axis)
            largest = std::max({largest, std::abs(region.bounds.min[axis]), std::abs(region.bounds.max[axis])});
    for (const glm::dvec3& point : space_.graph.points)
        largest = std::max({largest, std::abs(point.x), std::abs(point.y), std::abs(point.z)});
    space_.tolerance = tolerance >= 0 ? tolerance : largest * 0x1p-30;
    middles_.clear();
    return std::exchange(space_, {});
}

}  // namespace sightline
