// Windows from cell to cell, in an order in which each cell is entered once where the cells have one.
// SPDX-License-Identifier: MIT
//
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#include "sightline/cells/portals.h"

#include <algorithm>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

constexpr uint32_t kLeaf = PortalGraph::Node::kLeaf;
constexpr uint32_t kNone = ~0u;

/// Cuts an outline where `height` is below 0.
template <class Height>
void cutOutline(Array<glm::dvec3>& outline, Array<glm::dvec3>& out, Height height) {
    out.clear();
    for (size_t i = 0; i < outline.size(); ++i) {
        const glm::dvec3 &a = outline[i], &b = outline[i + 1 == outline.size() ? 0 : i + 1];
        const double at_a = height(a), at_b = height(b);
        if (at_a >= 0) out.push_back(a);
        if ((at_a >= 0) != (at_b >= 0)) out.push_back(a + at_a / (at_a - at_b) * (b - a));
    }
    outline.swap(out);
}

}  // namespace

PortalFlood::PortalFlood(Memory* memory)
    : states_(memory),
      order_(memory),
      flagged_(memory),
      steps_(memory),
      heap_(memory),
      start_(memory),
      looks_(memory),
      corners_(memory),
      clipped_(memory),
      lines_(memory),
      polygons_(memory),
      cells_(memory),
      planes_(memory) {}

bool PortalFlood::run(const PortalGraph& graph, const View& view, const PortalSettings& settings,
                      std::span<const DoorState> doors, std::span<const uint64_t> rows) {
    SIGHTLINE_DEBUG_ASSERT(isUsable(view));
    SIGHTLINE_DEBUG_ASSERT(doors.empty() || doors.size() == graph.doors());
    graph_ = &graph;
    settings_ = settings;
    doors_ = doors;
    rows_ = rows;
    stats_ = {};
    cells_.clear();
    planes_.clear();
    order_.clear();
    heap_.clear();
    polygons_.clear();
    ++view_;
    if (states_.size() < graph.cells()) states_.resize(graph.cells());
    if (flagged_.size() < graph.nodes().size()) flagged_.resize(graph.nodes().size());
    if (!start(graph, view)) return false;
    if (!(graph.nodes().empty() ? floodByDistance() : floodTree())) {
        stats_.work_spent = true;
        return false;
    }
    if (settings.windows == PortalWindows::kPolygons) writePolygons();
    else writeBounds();
    return true;
}

bool PortalFlood::start(const PortalGraph& graph, const View& view) {
    if (!makePortalEye(view, graph.tolerance(), graph.reach(), eye_)) return false;
    const ViewOutline& through = view.through;
    if (through.count >= 3) {
        // Sight lines begin on the outline, and not before it.
        if (!graph.cellsAround({through.points, through.count}, eye_.position, start_)) return false;
        double w = INFINITY;
        for (uint32_t i = 0; i < through.count; ++i) w = std::min(w, eye_.toImage(through.points[i]).z);
        eye_.near_w = std::max(w - eye_.lengths[2] * eye_.position, 0.0);
    } else {
        glm::dvec3 body[5];
        std::copy(eye_.near_corners, eye_.near_corners + 4, body);
        body[4] = eye_.center;
        if (!graph.cellsAround({body, eye_.parallel() ? 4u : 5u}, 0, start_)) return false;
    }
    for (const uint32_t cell : start_)
        if (settings_.windows == PortalWindows::kPolygons)
            reach(cell, {.shape = polygonOf(eye_.image), .cell = cell}, 0);
        else reach(cell, eye_.image, ~0u, ~0u, 0, 0);
    return true;
}

void PortalFlood::reach(uint32_t cell, const WindowBounds& window, uint32_t from, uint32_t portal, uint32_t depth,
                        double key) {
    SIGHTLINE_DEBUG_ASSERT(cell < graph_->cells() && settings_.windows != PortalWindows::kPolygons);
    CellState& state = states_[cell];
    if (state.view != view_) {
        state = {window, view_, static_cast<uint32_t>(order_.size()), depth, from, portal};
        order_.push_back(cell);
    } else {
        const bool nearer = settings_.depth != 0 && depth < state.depth;
        if (!nearer && window.isWithin(state.window, sides())) return;
        state.window.grow(window);
        state.depth = std::min(state.depth, depth);
    }
    wait(cell, key);
}

void PortalFlood::wait(uint32_t cell, double key) {
    CellState& state = states_[cell];
    SIGHTLINE_DEBUG_ASSERT(state.view == view_);
    if (state.waits) return;
    state.waits = true;
    if (graph_->nodes().empty()) {
        heap_.push_back({key, cell});
        std::push_heap(heap_.begin(), heap_.end(), [](const Waiting& a, const Waiting& b) {
            return a.key != b.key ? a.key > b.key : a.cell > b.cell;
        });
        return;
    }
    for (uint32_t node = graph_->parentOf(cell); node != PortalGraph::kNoCell && flagged_[node] != view_;
         node = graph_->nodes()[node].parent)
        flagged_[node] = view_;
}

/// From the outside walls hide nothing, because they may be drawn from within alone: all cells are seen through its
/// windows.
void PortalFlood::lookBackIn(uint32_t outside) {
    SIGHTLINE_DEBUG_ASSERT(outside == graph_->outside());
    const uint32_t depth = settings_.depth;
    const auto isTooDeep = [&](uint32_t of) {
        stats_.too_deep += depth != 0 && of >= depth;
        return depth != 0 && of >= depth;
    };
    if (settings_.windows != PortalWindows::kPolygons) {
        const CellState state = states_[outside];
        if (isTooDeep(state.depth)) return;
        for (uint32_t cell = 0; cell < graph_->cells(); ++cell)
            if (cell != outside) reach(cell, state.window, state.index, kNone, state.depth + 1, 0);
        return;
    }
    for (uint32_t i = states_[outside].polygon; i != kNone; i = polygons_[i].next) {
        if (!polygons_[i].waits) continue;
        polygons_[i].waits = false;
        if (isTooDeep(polygons_[i].depth)) continue;
        Polygon in;
        in.shape = polygons_[i].shape;
        in.depth = polygons_[i].depth + 1;
        in.from = i;
        for (in.cell = 0; in.cell < graph_->cells(); ++in.cell)
            if (in.cell != outside) reach(in.cell, in, 0);
    }
}

bool PortalFlood::enter(uint32_t cell) {
    SIGHTLINE_DEBUG_ASSERT(cell < graph_->cells() && states_[cell].view == view_ && states_[cell].waits);
    if (++stats_.cells > settings_.work) return false;
    states_[cell].waits = false;
    if (cell == graph_->outside()) {
        lookBackIn(cell);
        return true;
    }
    if (settings_.windows != PortalWindows::kPolygons) {
        lookThroughAll(cell);
        return true;
    }
    for (const DirectedPortal& portal : graph_->portalsFrom(cell))
        if (mayEnter(portal.to) && eye_.passes(portal.plane, portal.thickness)) lookThroughPolygons(cell, portal);
    for (uint32_t i = states_[cell].polygon; i != ~0u; i = polygons_[i].next) polygons_[i].waits = false;
    return true;
}

bool PortalFlood::floodTree() {
    const auto nodes = graph_->nodes();
    SIGHTLINE_DEBUG_ASSERT(!nodes.empty());
    // Front to back: what is seen from a cell comes after it. Only for cells within the tolerance of the eye's own
    // planes is that not certain: a cell that is reached too late is left for another round.
    while (flagged_[0] == view_) {
        steps_.clear();
        steps_.push_back({0, 0});
        while (!steps_.empty()) {
            Step& step = steps_.back();
            const PortalGraph::Node& node = nodes[step.node];
            if (step.sides == 2) {
                // What waits again, or still, is below.
                bool waits = false;
                for (const uint32_t child : node.child)
                    if (child != PortalGraph::Node::kSolid)
                        waits |= (child & kLeaf) == 0
                                     ? flagged_[child] == view_
                                     : states_[child & ~kLeaf].view == view_ && states_[child & ~kLeaf].waits;
                if (!waits) flagged_[step.node] = 0;
                steps_.pop_back();
                continue;
            }
            const uint32_t child = node.child[eye_.frontFirst(node.plane) != (step.sides == 1) ? 1 : 0];
            ++step.sides;
            if (child == PortalGraph::Node::kSolid) continue;
            if ((child & kLeaf) == 0) {
                if (flagged_[child] == view_) steps_.push_back({child, 0});
                continue;
            }
            const CellState& state = states_[child & ~kLeaf];
            if (state.view == view_ && state.waits && !enter(child & ~kLeaf)) return false;
        }
    }
    return true;
}

bool PortalFlood::floodByDistance() {
    while (!heap_.empty()) {
        std::pop_heap(heap_.begin(), heap_.end(), [](const Waiting& a, const Waiting& b) {
            return a.key != b.key ? a.key > b.key : a.cell > b.cell;
        });
        const uint32_t cell = heap_.back().cell;
        heap_.pop_back();
        if (!enter(cell)) return false;
    }
    return true;
}

bool PortalFlood::mayEnter(uint32_t cell) const {
    if (rows_.empty()) return true;
    const uint32_t row = graph_->rowOf(cell);
    return row == PortalGraph::kNoCell || (row / 64 < rows_.size() && (rows_[row / 64] >> row % 64 & 1) != 0);
}

float PortalFlood::openOf(const DirectedPortal& portal) const {
    return portal.door < doors_.size() ? doors_[portal.door].open : 1;
}

void PortalFlood::lookThroughAll(uint32_t cell) {
    const auto portals = graph_->portalsFrom(cell);
    if (looks_.size() < portals.size()) looks_.resize(portals.size());
    const uint32_t count = lookThroughPortals(eye_, graph_->corners(), portals, states_[cell].window, sides(),
                                              looks_.data(), stats_.portals);
    SIGHTLINE_DEBUG_ASSERT(count <= portals.size());
    for (uint32_t i = 0; i < count; ++i) {
        PortalLook& look = looks_[i];
        const DirectedPortal& portal = portals[look.portal];
        if (!mayEnter(portal.to)) continue;
        if (look.near || openOf(portal) < 1) lookThrough(cell, portal);
        else pass(cell, portal, look.window, look.w);
    }
}

PortalFlood::Projection PortalFlood::project(const DirectedPortal& portal) {
    Projection projection;
    const float open = openOf(portal);
    if (open <= 0) return projection;

    SIGHTLINE_DEBUG_ASSERT(portal.count >= 3);
    const PortalCorners& corners = graph_->corners();
    const auto cornerAt = [&](uint32_t i) { return glm::dvec3(corners.x[i], corners.y[i], corners.z[i]); };
    const double position = eye_.position + portal.thickness;
    corners_.clear();
    const glm::dvec3 slide = open < 1 ? graph_->slideOf(portal.door) : glm::dvec3(0.0);
    if (const double length = glm::length(slide); length > 0) {
        // The leaf has come from the side where the slide begins.
        const glm::dvec3 along = slide / length;
        double low = INFINITY, high = -INFINITY;
        for (uint32_t i = portal.first; i < portal.first + portal.count; ++i) {
            const double at = glm::dot(along, cornerAt(i));
            low = std::min(low, at);
            high = std::max(high, at);
            corners_.push_back(cornerAt(i));
        }
        const double least = high - open * (high - low) - position;
        cutOutline(corners_, clipped_, [&](const glm::dvec3& p) { return glm::dot(along, p) - least; });
        for (glm::dvec3& corner : corners_) corner = eye_.toImage(corner);
    } else {
        for (uint32_t i = portal.first; i < portal.first + portal.count; ++i)
            corners_.push_back(eye_.toImage(cornerAt(i)));
    }

    // A sight line passes within `position` of the outline, at w >= near_w: of the outline itself, that is where w is
    // not less than this.
    const double w_error = eye_.lengths[2] * position;
    const double least_w = eye_.near_w - w_error;
    double w = INFINITY;
    for (const glm::dvec3& corner : corners_) w = std::min(w, corner.z);
    if (w < least_w) {
        cutOutline(corners_, clipped_, [&](const glm::dvec3& p) { return p.z - least_w; });
        w = least_w;
        for (glm::dvec3& corner : corners_) corner.z = std::max(corner.z, least_w);
    }
    if (corners_.empty()) return projection;
    projection.w = w;
    if (w <= 4 * w_error) {
        ++stats_.whole;
        projection.kind = Projection::Kind::kWhole;
        return projection;
    }
    // A point that is off by (dx, dy, dw) is in the image off by (dx - x/w dw) / w, at a place x/w of the view.
    projection.kind = Projection::Kind::kPart;
    projection.bounds = WindowBounds::nothing();
    for (const glm::dvec3& corner : corners_) {
        const double inverse = 1 / corner.z;
        projection.bounds.grow(corner.x * inverse, corner.y * inverse);
    }
    for (int i = 0; i < 2; ++i)
        projection.margins[i] = (eye_.lengths[i] + eye_.wide[i] * eye_.lengths[2]) * (position / w) + eye_.slack[i];
    projection.bounds.widen(projection.margins[0], projection.margins[1]);
    return projection;
}

void PortalFlood::lookThrough(uint32_t cell, const DirectedPortal& portal) {
    const Projection projection = project(portal);
    if (projection.kind == Projection::Kind::kNothing) return;
    const CellState& state = states_[cell];
    WindowBounds window = state.window;
    if (projection.kind == Projection::Kind::kPart) window.cut(projection.bounds);
    pass(cell, portal, window, projection.w);
}

void PortalFlood::pass(uint32_t cell, const DirectedPortal& portal, WindowBounds& window, double key) {
    SIGHTLINE_DEBUG_ASSERT(portal.to != cell && states_[cell].view == view_);
    if (window.isEmpty(sides())) return;
    if (sides() == 8) {
        window.tighten();
        if (window.isEmpty(8)) return;
    }
    const CellState& state = states_[cell];
    if (settings_.depth != 0 && state.depth >= settings_.depth) {
        ++stats_.too_deep;
        return;
    }
    reach(portal.to, window, state.index, portal.portal, state.depth + 1, key);
}

/// The planes through the eye and a line of the image: dot(line, (x / w, y / w, 1)) >= 0.
void PortalFlood::addPlane(const glm::dvec3& line, SeenCell& seen) {
    const glm::dvec3 normal = line.x * eye_.rows[0] + line.y * eye_.rows[1] + line.z * eye_.rows[2];
    const double length = glm::length(normal);
    if (!(length > 0)) return;
    planes_.push_back(glm::dvec4(normal, glm::dot(line, eye_.shift)) / length);
    ++seen.plane_count;
}

void PortalFlood::writeBounds() {
    constexpr double kLines[8][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}, {-1, -1}, {1, 1}, {-1, 1}, {1, -1}};
    for (const uint32_t cell : order_) {
        const CellState& state = states_[cell];
        const double* most = state.window.most;
        SeenCell seen{
            cell,        static_cast<uint32_t>(planes_.size()), 0, -most[1], -most[3], most[0], most[2], state.from,
            state.portal};
        for (int i = 0; i < sides(); ++i)
            if (most[i] < eye_.image.most[i]) addPlane({kLines[i][0], kLines[i][1], most[i]}, seen);
        cells_.push_back(seen);
    }
}

}  // namespace sightline
