// Windows from cell to cell, in an order in which each cell is entered once where the cells have one.
// SPDX-License-Identifier: MIT
//
// Henry Fuchs, Zvi Kedem, Bruce Naylor. On Visible Surface Generation by A Priori Tree Structures. 1980.
#include "sightline/cull/portals.h"

#include <algorithm>
#include <cmath>

namespace sightline {
namespace {

constexpr uint32_t kLeaf = PortalGraph::Node::kLeaf;

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
      corners_(memory),
      clipped_(memory),
      cells_(memory),
      planes_(memory) {}

bool PortalFlood::run(const PortalGraph& graph, const View& view, const PortalSettings& settings,
                      std::span<const DoorState> doors, std::span<const uint64_t> rows) {
    graph_ = &graph;
    settings_ = settings;
    doors_ = doors;
    rows_ = rows;
    stats_ = {};
    cells_.clear();
    planes_.clear();
    order_.clear();
    heap_.clear();
    ++view_;
    if (states_.size() < graph.cells()) states_.resize(graph.cells());
    if (flagged_.size() < graph.nodes().size()) flagged_.resize(graph.nodes().size());
    if (!start(graph, view)) return false;
    if (!(graph.nodes().empty() ? floodByDistance() : floodTree())) {
        stats_.work_spent = true;
        return false;
    }
    writeCells();
    return true;
}

bool PortalFlood::start(const PortalGraph& graph, const View& view) {
    if (!makePortalEye(view, graph.tolerance(), graph.reach(), eye_)) return false;
    glm::dvec3 body[5];
    std::copy(eye_.near_corners, eye_.near_corners + 4, body);
    body[4] = eye_.center;
    if (!graph.cellsAround({body, eye_.parallel() ? 4u : 5u}, 0, start_)) return false;
    for (const uint32_t cell : start_) reach(cell, eye_.image, ~0u, ~0u, 0, 0);
    return true;
}

void PortalFlood::reach(uint32_t cell, const WindowBounds& window, uint32_t from, uint32_t portal, uint32_t depth,
                        double key) {
    CellState& state = states_[cell];
    if (state.view != view_) {
        state = {window, view_, static_cast<uint32_t>(order_.size()), depth, from, portal, false};
        order_.push_back(cell);
    } else {
        const bool nearer = settings_.depth != 0 && depth < state.depth;
        const int sides = settings_.windows == PortalWindows::kBoxes ? 4 : 8;
        if (!nearer && window.isWithin(state.window, sides)) return;
        state.window.grow(window);
        state.depth = std::min(state.depth, depth);
    }
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

bool PortalFlood::enter(uint32_t cell) {
    if (++stats_.cells > settings_.work) return false;
    states_[cell].waits = false;
    for (const DirectedPortal& portal : graph_->portalsFrom(cell)) lookThrough(cell, portal);
    return true;
}

bool PortalFlood::floodTree() {
    const auto nodes = graph_->nodes();
    // Front to back: what is seen from a cell comes after it. Only for cells within the tolerance of the eye's own planes
    // is that not certain: a cell that is reached too late is left for another round.
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

void PortalFlood::lookThrough(uint32_t from, const DirectedPortal& portal) {
    if (!rows_.empty()) {
        const uint32_t row = graph_->rowOf(portal.to);
        if (row != PortalGraph::kNoCell && (row / 64 >= rows_.size() || (rows_[row / 64] >> row % 64 & 1) == 0)) return;
    }
    if (!eye_.passes(portal.plane, portal.thickness)) return;
    ++stats_.portals;
    float open = 1;
    if (portal.door != CellPortal::kNone && portal.door < doors_.size()) open = doors_[portal.door].open;
    if (open <= 0) return;

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
    }
    if (corners_.empty()) return;

    WindowBounds window = states_[from].window;
    if (w <= 4 * w_error) {
        ++stats_.whole;
    } else {
        // A point that is off by (dx, dy, dw) is in the image off by (dx - x/w dw) / w, at a place x/w of the view.
        WindowBounds bounds = WindowBounds::nothing();
        for (const glm::dvec3& corner : corners_) {
            const double inverse = 1 / corner.z;
            bounds.grow(corner.x * inverse, corner.y * inverse);
        }
        const double per_w = position / w;
        bounds.widen((eye_.lengths[0] + eye_.wide[0] * eye_.lengths[2]) * per_w + eye_.slack[0],
                     (eye_.lengths[1] + eye_.wide[1] * eye_.lengths[2]) * per_w + eye_.slack[1]);
        window.cut(bounds);
        if (settings_.windows == PortalWindows::kBoxes) {
            if (window.isEmpty(4)) return;
        } else {
            if (window.isEmpty(8)) return;
            window.tighten();
            if (window.isEmpty(8)) return;
        }
    }
    const CellState& state = states_[from];
    if (settings_.depth != 0 && state.depth >= settings_.depth) {
        ++stats_.too_deep;
        return;
    }
    reach(portal.to, window, state.index, portal.portal, state.depth + 1, w);
}

void PortalFlood::writeCells() {
    const bool boxes = settings_.windows == PortalWindows::kBoxes;
    const glm::dvec3 &x = eye_.rows[0], &y = eye_.rows[1];
    const glm::dvec3 rows[4] = {x, y, x + y, x - y};
    const glm::dvec3& shift = eye_.shift;
    const double shifts[4] = {shift.x, shift.y, shift.x + shift.y, shift.x - shift.y};
    for (const uint32_t cell : order_) {
        const CellState& state = states_[cell];
        const double* most = state.window.most;
        SeenCell seen{
            cell,        static_cast<uint32_t>(planes_.size()), 0, -most[1], -most[3], most[0], most[2], state.from,
            state.portal};
        for (int i = 0; i < (boxes ? 4 : 8); ++i) {
            if (!(most[i] < eye_.image.most[i])) continue;
            // x / w <= most: most * w - x >= 0.
            const double sign = i % 2 == 0 ? 1 : -1;
            const glm::dvec3 normal = most[i] * eye_.rows[2] - sign * rows[i / 2];
            const double length = glm::length(normal);
            if (!(length > 0)) continue;
            planes_.push_back(glm::dvec4(normal, most[i] * shift.z - sign * shifts[i / 2]) / length);
            ++seen.plane_count;
        }
        cells_.push_back(seen);
    }
}

}  // namespace sightline
