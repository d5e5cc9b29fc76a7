// Cells and portals that a file's maker marked: from shapes, and which belongs to which.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/marked_cells.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "sightline/geom/convex_region.h"
#include "sightline/geom/outline_hull.h"

namespace sightline::tools {
namespace {

constexpr size_t kMostPlanes = 128;
constexpr uint32_t kNone = ScenePortal::kNone;

double heightOf(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

SceneCell noCell(std::string name, const Box3d& bounds) {
    return {std::move(name), {}, bounds, std::numeric_limits<double>::infinity()};
}

/// Keeps the planes if they close a region.
SceneCell finished(SceneCell cell) {
    const ConvexRegion region = convexRegion(cell.planes);
    if (region.kind != ConvexRegion::Kind::kSolid) return noCell(std::move(cell.name), cell.bounds);
    cell.bounds = region.bounds;
    return cell;
}

glm::dvec3 areaOf(std::span<const glm::dvec3> outline) {
    glm::dvec3 area(0);
    for (size_t i = 1; i + 1 < outline.size(); ++i)
        area += glm::cross(outline[i] - outline[0], outline[i + 1] - outline[0]);
    return area;
}

glm::dvec3 middleOf(std::span<const glm::dvec3> points) {
    glm::dvec3 sum(0);
    for (const glm::dvec3& point : points) sum += (point - points[0]) / static_cast<double>(points.size());
    return points[0] + sum;
}

/// How far a cell is from having a face in which a portal lies, as seen from the side that its normal points to;
/// infinite: too far.
double distanceTo(const SceneCell& cell, const glm::dvec3& middle, const glm::dvec3& normal) {
    constexpr double kFar = std::numeric_limits<double>::infinity();
    if (cell.planes.empty() || cell.bounds.empty()) return kFar;
    const double limit = glm::length(cell.bounds.size()) / 20;
    for (int axis = 0; axis < 3; ++axis)
        if (middle[axis] < cell.bounds.min[axis] - limit || middle[axis] > cell.bounds.max[axis] + limit) return kFar;
    double best = kFar;
    for (size_t i = 0; i < cell.planes.size(); ++i) {
        if (glm::dot(glm::dvec3(cell.planes[i]), normal) < 0.9) continue;
        double distance = std::abs(heightOf(cell.planes[i], middle));
        for (size_t k = 0; k < cell.planes.size(); ++k)
            if (k != i) distance = std::max(distance, -heightOf(cell.planes[k], middle));
        if (distance <= limit) best = std::min(best, distance);
    }
    return best;
}

uint32_t nearestCell(const Scene& scene, const glm::dvec3& middle, const glm::dvec3& normal, uint32_t except) {
    uint32_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t i = 0; i < scene.cells.size(); ++i) {
        const double distance = i == except ? least : distanceTo(scene.cells[i], middle, normal);
        if (distance < least) best = i, least = distance;
    }
    return best;
}

/// Of cells with one name, the one that is nearest.
uint32_t cellNamed(const Scene& scene, const std::string& name, const glm::dvec3& middle) {
    uint32_t best = kNone;
    double least = std::numeric_limits<double>::infinity();
    for (uint32_t i = 0; i < scene.cells.size(); ++i) {
        if (scene.cells[i].name != name) continue;
        double outside = 0;
        for (const glm::dvec4& plane : scene.cells[i].planes) outside = std::max(outside, -heightOf(plane, middle));
        if (best == kNone || outside < least) best = i, least = outside;
    }
    return best;
}

/// Doors by the names of objects, and of nodes above them.
class Doors {
public:
    explicit Doors(const Scene& scene) : scene_(scene) {}

    uint32_t named(const std::string& name) {
        if (by_name_.empty())
            for (uint32_t i = 0; i < scene_.objects.size(); ++i) add(i);
        const auto found = by_name_.find(name);
        return found == by_name_.end() ? kNone : found->second;
    }

private:
    void add(uint32_t object) {
        by_name_.try_emplace(scene_.objects[object].name, object);
        uint32_t node = scene_.objects[object].node;
        for (int up = 0; up < 4 && node < scene_.nodes.size(); ++up) {
            by_name_.try_emplace(scene_.nodes[node].name, object);
            node = scene_.nodes[node].parent;
        }
    }

    const Scene& scene_;
    std::map<std::string, uint32_t> by_name_;
};

void findCells(const Scene& scene, ScenePortal& portal) {
    if (portal.cells[0] != kNone && portal.cells[1] != kNone) return;
    if (portal.polygon.size() < 3 || scene.cells.empty()) return;
    const glm::dvec3 area = areaOf(portal.polygon), middle = middleOf(portal.polygon);
    if (!(glm::length(area) > 0)) return;
    const glm::dvec3 normal = glm::normalize(area);
    bool named = false;
    for (int side = 0; side < 2; ++side) {
        const std::string& name = portal.cell_names[side];
        named |= !name.empty();
        if (portal.cells[side] == kNone && !name.empty()) portal.cells[side] = cellNamed(scene, name, middle);
    }
    if (!named) {
        for (int side = 0; side < 2; ++side)
            if (portal.cells[side] == kNone)
                portal.cells[side] = nearestCell(scene, middle, side == 0 ? normal : -normal, portal.cells[1 - side]);
        return;
    }
    const auto ahead = [&](uint32_t cell) { return glm::dot(normal, scene.cells[cell].bounds.center() - middle); };
    for (int side = 0; side < 2; ++side) {
        const uint32_t other = portal.cells[1 - side];
        if (portal.cells[side] != kNone || !portal.cell_names[side].empty() || other == kNone) continue;
        portal.cells[side] = nearestCell(scene, middle, ahead(other) > 0 ? -normal : normal, other);
    }
    if (portal.cells[0] == kNone || portal.cells[1] == kNone) return;
    if (ahead(portal.cells[0]) < ahead(portal.cells[1])) std::reverse(portal.polygon.begin(), portal.polygon.end());
}

}  // namespace

SceneCell cellOfShape(std::string name, std::span<const glm::dvec3> points, std::span<const uint32_t> corners) {
    SceneCell cell;
    cell.name = std::move(name);
    for (const uint32_t corner : corners) cell.bounds.grow(points[corner]);
    if (!cell.bounds.finite()) return noCell(std::move(cell.name), {});
    const glm::dvec3 center = cell.bounds.center();
    const double extent = glm::length(cell.bounds.size());
    const double same = extent * 0x1p-20;  // positions are known no better
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        const glm::dvec3 a = points[corners[i]] - center;
        const glm::dvec3 area =
            glm::cross(points[corners[i + 1]] - points[corners[i]], points[corners[i + 2]] - points[corners[i]]);
        const double length = glm::length(area);
        if (!(length > 0)) continue;
        const glm::dvec3 normal = area / length;
        const bool known = std::any_of(cell.planes.begin(), cell.planes.end(), [&](const glm::dvec4& plane) {
            double off = 0;
            for (int k = 0; k < 3; ++k) off = std::max(off, std::abs(heightOf(plane, points[corners[i + k]] - center)));
            return off <= same;
        });
        if (known) continue;
        if (cell.planes.size() >= kMostPlanes) return noCell(std::move(cell.name), cell.bounds);
        cell.planes.emplace_back(normal, -glm::dot(normal, a));
    }
    for (glm::dvec4& plane : cell.planes) {
        double low = 0, high = 0;
        for (const uint32_t corner : corners) {
            const double height = heightOf(plane, points[corner] - center);
            low = std::min(low, height);
            high = std::max(high, height);
        }
        if (-low > high) {
            plane = -plane;
            std::swap(low, high);
            low = -low;
        }
        cell.overhang = std::max(cell.overhang, std::abs(low));
        plane.w -= glm::dot(glm::dvec3(plane), center);
    }
    const double overhang = cell.overhang;
    cell = finished(std::move(cell));
    cell.overhang = std::max(cell.overhang, overhang);
    return cell;
}

SceneCell cellOfBox(std::string name, const Box3d& box, const glm::dmat4& transform) {
    SceneCell cell;
    cell.name = std::move(name);
    cell.bounds = transformBox(box, transform);
    const glm::dvec3 size = box.size();
    const glm::dmat3 linear(transform);
    if (!cell.bounds.finite() || !(std::min({size.x, size.y, size.z}) > 0) || !(glm::determinant(linear) != 0))
        return noCell(std::move(cell.name), cell.bounds);
    const glm::dmat3 normals = glm::transpose(glm::inverse(linear));
    for (const glm::dvec4& plane : planesOfBox(box)) {
        const glm::dvec3 normal = glm::normalize(normals * glm::dvec3(plane));
        const glm::dvec3 on(transform * glm::dvec4(-plane.w * glm::dvec3(plane), 1));
        if (!std::isfinite(normal.x) || !std::isfinite(normal.y) || !std::isfinite(normal.z))
            return noCell(std::move(cell.name), cell.bounds);
        cell.planes.emplace_back(normal, -glm::dot(normal, on));
    }
    return finished(std::move(cell));
}

std::vector<glm::dvec3> outlineOfShape(std::span<const glm::dvec3> points, std::span<const uint32_t> corners) {
    glm::dvec3 sum(0), largest(0);
    double all = 0;
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        const glm::dvec3 area =
            glm::cross(points[corners[i + 1]] - points[corners[i]], points[corners[i + 2]] - points[corners[i]]);
        sum += area;
        all += glm::length(area);
        if (glm::length(area) > glm::length(largest)) largest = area;
    }
    if (corners.empty()) sum = largest = points.size() < 3 ? glm::dvec3(0) : areaOf(points);
    // A closed shape, or one whose triangles wind either way, has no sum: its largest triangle tells.
    const glm::dvec3 normal = glm::length(sum) > all / 2 ? sum : largest;
    if (!(glm::length(normal) > 0) || !std::isfinite(glm::length(normal))) return {};
    std::vector<glm::dvec3> outline = outlineHull(points, normal);
    if (outline.size() < 3) outline.clear();
    return outline;
}

void resolvePortals(Scene& scene) {
    Doors doors(scene);
    for (ScenePortal& portal : scene.portals) {
        findCells(scene, portal);
        if (portal.door == kNone && !portal.door_name.empty()) portal.door = doors.named(portal.door_name);
    }
}

}  // namespace sightline::tools
