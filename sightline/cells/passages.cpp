// Passages of a graph, and the points of them that a short way takes.
// SPDX-License-Identifier: MIT
#include "sightline/cells/passages.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cells/window_polygon.h"

namespace sightline {
namespace {

double heightOver(const glm::dvec4& plane, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(plane), point) + plane.w;
}

/// The least of the distances that the corners of a convex outline spread from the lines of its sides.
double widthOf(std::span<const glm::dvec3> outline) {
    double least = INFINITY;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 from = outline[i], edge = outline[(i + 1) % outline.size()] - from;
        const double length = glm::length(edge);
        if (!(length > 0)) continue;
        double most = 0;
        for (const glm::dvec3& corner : outline)
            most = std::max(most, glm::length(glm::cross(edge, corner - from)) / length);
        least = std::min(least, most);
    }
    return std::isfinite(least) ? least : 0;
}

/// The outline of a directed portal; corners that are repeated stay.
Array<glm::dvec3> cornersOf(const PortalGraph& graph, const DirectedPortal& portal, Memory* memory) {
    const PortalCorners corners = graph.corners();
    Array<glm::dvec3> outline(memory);
    for (uint32_t i = portal.first; i < portal.first + portal.count; ++i)
        outline.push_back({corners.x[i], corners.y[i], corners.z[i]});
    return outline;
}

/// How points of a plane are told by two numbers.
class PlaneFrame {
public:
    PlaneFrame(const glm::dvec3& origin, const glm::dvec3& normal) : origin_(origin) {
        const glm::dvec3 size = glm::abs(normal);
        const int axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
        glm::dvec3 along(0.0);
        along[axis] = 1;
        u_ = glm::normalize(glm::cross(along, normal));
        v_ = glm::cross(normal, u_);
    }
    glm::dvec2 to(const glm::dvec3& point) const {
        return {glm::dot(u_, point - origin_), glm::dot(v_, point - origin_)};
    }
    glm::dvec3 from(const glm::dvec2& point) const { return origin_ + point.x * u_ + point.y * v_; }

private:
    glm::dvec3 origin_, u_, v_;
};

}  // namespace

Passages::Passages(const PortalGraph& graph, Memory* memory)
    : slack_(4 * graph.tolerance()), all_(memory), points_(memory), first_(memory), of_cell_(memory) {
    // Each portal that is seen through from both sides is in the lists of both cells.
    Array<uint32_t> ways(graph.portals(), 0, memory);
    for (uint32_t cell = 0; cell < graph.cells(); ++cell)
        for (const DirectedPortal& portal : graph.portalsFrom(cell)) ++ways[portal.portal];
    for (uint32_t cell = 0; cell < graph.cells(); ++cell)
        for (const DirectedPortal& there : graph.portalsFrom(cell)) {
            if (there.to < cell) continue;
            if (ways[there.portal] == 2) {
                add(there, cell, cornersOf(graph, there, memory));
                continue;
            }
            for (const DirectedPortal& back : graph.portalsFrom(there.to))
                if (back.to == cell && ways[back.portal] == 1) addShared(graph, cell, there, back);
        }
    first_.assign(graph.cells() + 1, 0);
    for (const Passage& passage : all_)
        for (const uint32_t cell : passage.cells) ++first_[cell + 1];
    for (uint32_t cell = 0; cell < graph.cells(); ++cell) first_[cell + 1] += first_[cell];
    of_cell_.resize(first_.back());
    Array<uint32_t> next(first_.begin(), first_.end() - 1, memory);
    for (uint32_t i = 0; i < all_.size(); ++i)
        for (const uint32_t cell : all_[i].cells) of_cell_[next[cell]++] = i;
}

void Passages::add(const DirectedPortal& portal, uint32_t from, std::span<const glm::dvec3> outline) {
    SIGHTLINE_DEBUG_ASSERT(outline.size() >= 3 && from != portal.to);
    Passage passage;
    passage.cells[0] = from;
    passage.cells[1] = portal.to;
    passage.first = static_cast<uint32_t>(points_.size());
    passage.count = static_cast<uint32_t>(outline.size());
    passage.door = portal.door;
    passage.width = widthOf(outline);
    glm::dvec3 turn(0.0);
    for (size_t i = 2; i < outline.size(); ++i)
        turn += glm::cross(outline[i - 1] - outline[0], outline[i] - outline[0]);
    const glm::dvec3 normal =
        glm::dot(turn, glm::dvec3(portal.plane)) < 0 ? -glm::dvec3(portal.plane) : glm::dvec3(portal.plane);
    passage.plane = glm::dvec4(normal, -glm::dot(normal, outline[0]));
    points_.insert(points_.end(), outline.begin(), outline.end());
    all_.push_back(passage);
}

void Passages::addShared(const PortalGraph& graph, uint32_t from, const DirectedPortal& there,
                         const DirectedPortal& back) {
    Memory* const memory = all_.memory();
    const Array<glm::dvec3> outlines[2] = {cornersOf(graph, there, memory), cornersOf(graph, back, memory)};
    const double apart = slack_ + there.thickness + back.thickness;
    for (const glm::dvec3& corner : outlines[1])
        if (std::abs(heightOver(there.plane, corner)) > apart) return;
    const PlaneFrame frame(outlines[0][0], glm::dvec3(there.plane));
    WindowPolygon polygons[2];
    for (int i = 0; i < 2; ++i) {
        WindowPolygon& polygon = polygons[i];
        // What has more corners is not cut, and cuts nothing: a passage may be too large.
        if (outlines[i].size() > WindowPolygon::kMost) continue;
        for (const glm::dvec3& corner : outlines[i]) polygon.points[polygon.count++] = frame.to(corner);
        if (polygon.area() < 0) std::reverse(polygon.points, polygon.points + polygon.count);
    }
    if (polygons[0].count == 0 || polygons[1].count == 0)
        return add(there, from, outlines[polygons[0].count == 0 ? 1 : 0]);
    for (uint32_t i = 0; i < polygons[1].count; ++i) {
        const glm::dvec2 a = polygons[1].points[i], b = polygons[1].points[(i + 1) % polygons[1].count];
        const double length = glm::length(b - a);
        if (!(length > 0)) continue;
        const glm::dvec2 inward = glm::dvec2(a.y - b.y, b.x - a.x) / length;
        cutPolygon(polygons[0], {inward.x, inward.y, slack_ - glm::dot(inward, a)});
    }
    if (polygons[0].count < 3) return;
    Array<glm::dvec3> shared(memory);
    for (uint32_t i = 0; i < polygons[0].count; ++i) shared.push_back(frame.from(polygons[0].points[i]));
    add(there, from, shared);
}

bool Passages::isInside(const Passage& passage, const glm::dvec3& foot) const {
    SIGHTLINE_DEBUG_ASSERT(passage.count >= 3 && size_t{passage.first} + passage.count <= points_.size());
    const auto outline = outlineOf(passage);
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i];
        const double height = glm::dot(glm::cross(edge, foot - outline[i]), glm::dvec3(passage.plane));
        if (height < -slack_ * glm::length(edge)) return false;
    }
    return true;
}

glm::dvec3 Passages::nearestTo(uint32_t number, const glm::dvec3& point) const {
    SIGHTLINE_DEBUG_ASSERT(number < all_.size());
    const Passage& passage = all_[number];
    const glm::dvec3 foot = point - heightOver(passage.plane, point) * glm::dvec3(passage.plane);
    if (isInside(passage, foot)) return foot;
    const auto outline = outlineOf(passage);
    glm::dvec3 best = outline[0];
    double least = INFINITY;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i];
        const double squared = glm::dot(edge, edge);
        const double at = squared > 0 ? std::clamp(glm::dot(point - outline[i], edge) / squared, 0.0, 1.0) : 0;
        const glm::dvec3 on = outline[i] + at * edge, away = point - on;
        if (glm::dot(away, away) < least) {
            least = glm::dot(away, away);
            best = on;
        }
    }
    return best;
}

glm::dvec3 Passages::between(uint32_t number, const glm::dvec3& from, const glm::dvec3& to) const {
    SIGHTLINE_DEBUG_ASSERT(number < all_.size());
    const Passage& passage = all_[number];
    const double heights[2] = {heightOver(passage.plane, from), heightOver(passage.plane, to)};
    const glm::dvec3 feet[2] = {from - heights[0] * glm::dvec3(passage.plane),
                                to - heights[1] * glm::dvec3(passage.plane)};
    // In the plane the way round does not ask on which side its ends are: if they are on one, one of them may be mirrored.
    const double far = std::abs(heights[0]) + std::abs(heights[1]);
    if (far > 0) {
        const glm::dvec3 straight = feet[0] + std::abs(heights[0]) / far * (feet[1] - feet[0]);
        if (isInside(passage, straight)) return straight;
    }
    // The sum of two distances is convex, so that it is least on the outline.
    const auto outline = outlineOf(passage);
    glm::dvec3 best = outline[0];
    double least = INFINITY;
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 edge = outline[i + 1 == outline.size() ? 0 : i + 1] - outline[i];
        const double length = glm::length(edge);
        if (!(length > 0)) continue;
        // Both ends turned about the side's line into one plane with it.
        const glm::dvec3 along = edge / length;
        double at[2], off[2];
        for (int k = 0; k < 2; ++k) {
            const glm::dvec3 end = (k == 0 ? from : to) - outline[i];
            at[k] = glm::dot(end, along);
            off[k] = glm::length(end - at[k] * along);
        }
        const double both = off[0] + off[1];
        const double crossing = both > 0 ? (at[0] * off[1] + at[1] * off[0]) / both : at[0];
        const glm::dvec3 on = outline[i] + std::clamp(crossing, 0.0, length) * along;
        const double around = glm::length(on - from) + glm::length(on - to);
        if (around < least) {
            least = around;
            best = on;
        }
    }
    return best;
}

bool Passages::passes(uint32_t number, const glm::dvec3& from, const glm::dvec3& to, glm::dvec3& at) const {
    SIGHTLINE_DEBUG_ASSERT(number < all_.size());
    const Passage& passage = all_[number];
    const double a = heightOver(passage.plane, from), b = heightOver(passage.plane, to);
    if ((a > slack_ && b > slack_) || (a < -slack_ && b < -slack_)) return false;
    const double far = std::abs(a) + std::abs(b);
    at = far > 0 ? from + std::abs(a) / far * (to - from) : from;
    at -= heightOver(passage.plane, at) * glm::dvec3(passage.plane);
    return isInside(passage, at);
}

}  // namespace sightline
