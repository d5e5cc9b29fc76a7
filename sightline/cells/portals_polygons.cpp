// Windows as polygons: each way through portals cuts its own.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"
#include "sightline/cells/portals.h"

namespace sightline {
namespace {

constexpr uint32_t kNoPolygon = ~0u;
constexpr uint32_t kMostOfCell = 8;  // windows; further ones are joined
constexpr double kSame = 0x1p-46;    // outside by less is inside: of the slack of 2^-36 that each portal adds
constexpr double kConvex = 0x1p-30;  // share of the area that a hull may have more than both and still be their union

constexpr double kShared = 0x1p-20;  // corners so close may be the same: portals' margins move them apart

constexpr double kLines[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}};

bool touch(const WindowBounds& a, const WindowBounds& b) {
    for (int i = 0; i < 8; i += 2)
        if (a.most[i] + b.most[i + 1] < 0 || b.most[i] + a.most[i + 1] < 0) return false;
    return true;
}

}  // namespace

/// Lines of the image through the edges of corners_, moved out by the margins. Each has all corners on its inner side,
/// whatever the outline is like, so that the part between all lines holds the hull.
void PortalFlood::findLines(const Projection& projection) {
    lines_.clear();
    for (size_t i = 0; i < corners_.size(); ++i) {
        const glm::dvec3 &a = corners_[i], &b = corners_[i + 1 == corners_.size() ? 0 : i + 1];
        WindowLine line = glm::cross(a, b);  // the plane through the eye and the edge
        double least = INFINITY, most = -INFINITY;
        for (const glm::dvec3& corner : corners_) {
            const double height = glm::dot(line, corner) / corner.z;
            least = std::min(least, height);
            most = std::max(most, height);
        }
        if (!(most - least > 0) || !std::isfinite(most - least)) continue;
        if (most < -least) {
            line = -line;
            least = -most;
        }
        line.z +=
            std::max(0.0, -least) + std::abs(line.x) * projection.margins[0] + std::abs(line.y) * projection.margins[1];
        lines_.push_back(line);
    }
}

void PortalFlood::lookThroughPolygons(uint32_t cell, const DirectedPortal& portal) {
    ++stats_.portals;
    const Projection projection = project(portal);
    if (projection.kind == Projection::Kind::kNothing) return;
    bool lines_known = false;
    for (uint32_t i = states_[cell].polygon; i != kNoPolygon; i = polygons_[i].next) {
        if (!polygons_[i].waits) continue;
        Polygon next;
        next.cell = portal.to;
        next.depth = polygons_[i].depth + 1;
        next.from = i;
        next.portal = portal.portal;
        if (projection.kind == Projection::Kind::kWhole) {
            next.shape = polygons_[i].shape;
        } else {
            WindowBounds both = polygons_[i].shape.bounds;
            both.cut(projection.bounds);
            if (both.isEmpty(8)) continue;
            if (!lines_known) findLines(projection);
            lines_known = true;
            next.shape = polygons_[i].shape;
            for (size_t k = 0; k < lines_.size() && next.shape.count > 0; ++k) cutPolygon(next.shape, lines_[k]);
            if (next.shape.count == 0) continue;
            // Lines of a thin outline meet far from it.
            next.shape.findBounds();
            bool cut = false;
            for (int k = 0; k < 8 && next.shape.count > 0; ++k) {
                if (!(next.shape.bounds.most[k] > projection.bounds.most[k])) continue;
                cutPolygon(next.shape, {kLines[k][0], kLines[k][1], projection.bounds.most[k]});
                cut = true;
            }
            if (next.shape.count == 0) continue;
            if (cut) next.shape.findBounds();
        }
        if (settings_.depth != 0 && next.depth > settings_.depth) {
            ++stats_.too_deep;
            continue;
        }
        reach(portal.to, next, projection.w);
    }
}

void PortalFlood::reach(uint32_t cell, Polygon polygon, double key) {
    SIGHTLINE_DEBUG_ASSERT(cell < graph_->cells() && polygon.cell == cell && polygon.shape.count >= 3);
    CellState& state = states_[cell];
    if (state.view != view_) {
        state = {};
        state.view = view_;
        order_.push_back(cell);
    }
    const uint32_t self = static_cast<uint32_t>(polygons_.size());
    uint32_t count = 0;
    const auto drop = [&](uint32_t* link) {
        Polygon& gone = polygons_[*link];
        SIGHTLINE_DEBUG_ASSERT(!gone.gone && gone.cell == cell);
        gone.gone = true;
        gone.became = self;
        *link = gone.next;
    };
    for (uint32_t i = state.polygon; i != kNoPolygon; i = polygons_[i].next)
        if (polygon.shape.isWithin(polygons_[i].shape, kSame) &&
            (settings_.depth == 0 || polygons_[i].depth <= polygon.depth))
            return;
    // Windows that it holds, or that make a convex whole with it, are dropped. Their hull may hold more: start again.
    for (uint32_t* link = &state.polygon; *link != kNoPolygon;) {
        const Polygon& other = polygons_[*link];
        if (other.shape.isWithin(polygon.shape, kSame)) {
            polygon.depth = std::min(polygon.depth, other.depth);
            drop(link);
            continue;
        }
        if (touch(other.shape.bounds, polygon.shape.bounds) && shareEdge(other.shape, polygon.shape, kShared)) {
            const WindowPolygon hull = hullOf(other.shape, polygon.shape);
            if (hull.area() <= (1 + kConvex) * (other.shape.area() + polygon.shape.area())) {
                polygon.shape = hull;
                polygon.depth = std::min(polygon.depth, other.depth);
                drop(link);
                link = &state.polygon;
                count = 0;
                continue;
            }
        }
        ++count;
        link = &polygons_[*link].next;
    }
    if (count >= kMostOfCell) {
        // Join it with the window whose rectangle grows least.
        ++stats_.joined;
        uint32_t* best = nullptr;
        double least = INFINITY;
        for (uint32_t* link = &state.polygon; *link != kNoPolygon; link = &polygons_[*link].next) {
            const double* a = polygons_[*link].shape.bounds.most;
            const double* b = polygon.shape.bounds.most;
            const double width = std::max(a[0], b[0]) + std::max(a[1], b[1]);
            const double more = width * (std::max(a[2], b[2]) + std::max(a[3], b[3])) - (a[0] + a[1]) * (a[2] + a[3]);
            if (!(more < least)) continue;
            least = more;
            best = link;
        }
        if (best == nullptr) best = &state.polygon;
        polygon.shape = hullOf(polygons_[*best].shape, polygon.shape);
        polygon.depth = std::min(polygon.depth, polygons_[*best].depth);
        drop(best);
    }
    polygon.next = state.polygon;
    polygon.waits = true;
    state.polygon = self;
    polygons_.push_back(polygon);
    wait(cell, key);
}

void PortalFlood::writePolygons() {
    // The window that holds another one comes after it, so that indices are found from the end.
    uint32_t count = 0;
    for (const Polygon& polygon : polygons_) count += polygon.gone ? 0 : 1;
    for (size_t i = polygons_.size(); i-- > 0;) {
        Polygon& polygon = polygons_[i];
        SIGHTLINE_DEBUG_ASSERT(!polygon.gone || (polygon.became > i && polygon.became < polygons_.size()));
        polygon.became = polygon.gone ? polygons_[polygon.became].became : --count;
    }
    SIGHTLINE_DEBUG_ASSERT(count == 0);
    for (const Polygon& polygon : polygons_) {
        if (polygon.gone) continue;
        const WindowPolygon& shape = polygon.shape;
        const double* most = shape.bounds.most;
        SeenCell seen{polygon.cell,
                      static_cast<uint32_t>(planes_.size()),
                      0,
                      -most[1],
                      -most[3],
                      most[0],
                      most[2],
                      polygon.from == kNoPolygon ? kNoPolygon : polygons_[polygon.from].became,
                      polygon.portal};
        for (uint32_t i = 0; i < shape.count; ++i) {
            const glm::dvec2 &a = shape.points[i], &b = shape.points[i + 1 == shape.count ? 0 : i + 1];
            const glm::dvec2 edge = b - a;
            bool of_view = false;
            for (int k = 0; k < 4; ++k) {
                const double side = (k % 2 == 0 ? 1 : -1) * eye_.image.most[k];
                of_view |= k < 2 ? a.x == side && b.x == side : a.y == side && b.y == side;
            }
            if (of_view || !(std::abs(edge.x) + std::abs(edge.y) > 0x1p-30)) continue;
            WindowLine line(-edge.y, edge.x, 0);
            double least = INFINITY;
            for (uint32_t k = 0; k < shape.count; ++k)
                least = std::min(least, line.x * shape.points[k].x + line.y * shape.points[k].y);
            line.z = -least;
            addPlane(line / (std::abs(line.x) + std::abs(line.y)), seen);
        }
        cells_.push_back(seen);
    }
}

}  // namespace sightline
