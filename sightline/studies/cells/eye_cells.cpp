// Portals as lines of the image, chains of them as linear programs.
// SPDX-License-Identifier: MIT
#include "sightline/studies/cells/eye_cells.h"

#include <algorithm>
#include <cmath>

#include "sightline/studies/cells/linear_program.h"

namespace sightline::studies {
namespace {

constexpr double kRounding = 0x1p-48;  // of a sum of few products, as a share of the sum of their sizes

const DirectedPortal* firstPortal(const PortalGraph& graph) { return graph.portalsFrom(0).data(); }

/// How much |dot(d x v, p)| can be for a point p of the image, d no larger than `doubt`.
double tripleBound(const glm::dvec3& doubt, const glm::dvec3& v, const glm::dvec3& most) {
    const glm::dvec3 a = glm::abs(v);
    return doubt.x * (a.y * most.z + a.z * most.y) + doubt.y * (a.x * most.z + a.z * most.x) +
           doubt.z * (a.x * most.y + a.y * most.x);
}

}  // namespace

EyeCells::EyeCells(Memory* memory)
    : seen_(memory),
      newest_in_(memory),
      cells_(memory),
      start_(memory),
      portals_(memory),
      images_(memory),
      lines_(memory),
      kept_(memory),
      windows_(memory),
      chosen_(memory),
      program_(memory) {}

bool EyeCells::run(const PortalGraph& graph, const View& view, const EyeCellSettings& settings,
                   std::span<const uint64_t> rows) {
    graph_ = &graph;
    rows_ = rows;
    // From the outside all cells are seen, and chains of portals do not tell which.
    level_ = graph.outside() == PortalGraph::kNoCell ? settings.level : EyeLevel::kRow;
    ++round_;
    seen_.resize(graph.cells(), 0);
    newest_in_.resize(graph.cells(), kNone);
    portals_.resize(2 * size_t{graph.portals()});
    cells_.clear();
    images_.clear();
    lines_.clear();
    kept_.clear();
    windows_.clear();
    stats_ = {};
    all_ = !findStart(view);
    if (all_) return false;
    for (const uint32_t cell : start_) addCell(cell);
    if (level_ == EyeLevel::kRow) {
        for (uint32_t cell = 0; cell < graph.cells(); ++cell)
            if (isInRows(cell)) addCell(cell);
    }
    if (level_ == EyeLevel::kVolume) findInVolume();
    if (level_ == EyeLevel::kSightLine) followLines(settings);
    if (level_ == EyeLevel::kChain) followChains();  // or where the work was spent
    return true;
}

bool EyeCells::findStart(const View& view) {
    if (!makePortalEye(view, graph_->tolerance(), graph_->reach(), eye_)) return false;
    frustum_ = makeFrustum(view);
    if (view.through.count >= 3)
        return graph_->cellsAround({view.through.points, view.through.count}, eye_.position, start_);
    glm::dvec3 points[5] = {eye_.near_corners[0], eye_.near_corners[1], eye_.near_corners[2], eye_.near_corners[3],
                            eye_.center};
    return graph_->cellsAround({points, eye_.parallel() ? size_t{4} : size_t{5}}, eye_.position, start_);
}

bool EyeCells::isInRows(uint32_t cell) const {
    const uint32_t row = rows_.empty() ? PortalGraph::kNoCell : graph_->rowOf(cell);
    return row == PortalGraph::kNoCell || (rows_[row / 64] >> (row % 64) & 1) != 0;
}

void EyeCells::addCell(uint32_t cell) {
    if (seen_[cell] == round_) return;
    seen_[cell] = round_;
    newest_in_[cell] = kNone;
    cells_.push_back(cell);
}

bool EyeCells::meets(const DirectedPortal& portal) const {
    const PortalCorners corners = graph_->corners();
    const double slack = eye_.position + portal.thickness;
    for (uint32_t i = 0; i < frustum_.count; ++i) {
        const glm::dvec4& plane = frustum_.planes[i];
        bool outside = true;
        for (uint32_t k = portal.first; k < portal.first + portal.count && outside; ++k) {
            const glm::dvec3 p = glm::dvec3(corners.x[k], corners.y[k], corners.z[k]) - frustum_.eye;
            outside = glm::dot(glm::dvec3(plane), p) + plane.w < -slack;
        }
        if (outside) return false;
    }
    return true;
}

void EyeCells::findInVolume() {
    for (uint32_t cell = 0; cell < graph_->cells(); ++cell) {
        if (seen_[cell] == round_ || !isInRows(cell)) continue;
        for (const DirectedPortal& portal : graph_->portalsFrom(cell)) {
            ++stats_.portals;
            if (!meets(portal)) continue;
            addCell(cell);
            break;
        }
    }
}

void EyeCells::followChains() {
    for (size_t i = 0; i < cells_.size(); ++i)
        for (const DirectedPortal& portal : graph_->portalsFrom(cells_[i])) {
            ++stats_.portals;
            if (seen_[portal.to] == round_ || !isInRows(portal.to)) continue;
            if (eye_.passes(portal.plane, portal.thickness) && meets(portal)) addCell(portal.to);
        }
}

EyeCells::Seen& EyeCells::look(uint32_t index) {
    Seen& seen = portals_[index];
    if (seen.round == round_) return seen;
    seen = Seen{};
    seen.round = round_;
    const DirectedPortal& portal = firstPortal(*graph_)[index];
    seen.open = eye_.passes(portal.plane, portal.thickness) && meets(portal);
    if (!seen.open) return seen;
    // Seen from behind, no further than it may be off: then the eye may be in its plane.
    const glm::dvec4 reverse = -portal.plane;
    seen.near = eye_.passes(reverse, portal.thickness);
    if (seen.near) return seen;
    seen.first = static_cast<uint32_t>(images_.size());
    const PortalCorners corners = graph_->corners();
    const double off = eye_.position + portal.thickness;
    glm::dvec3 largest(0.0);
    for (uint32_t k = portal.first; k < portal.first + portal.count; ++k) {
        images_.push_back(eye_.toImage({corners.x[k], corners.y[k], corners.z[k]}));
        largest = glm::max(largest, glm::abs(images_.back()));
    }
    for (int i = 0; i < 3; ++i) seen.doubt[i] = eye_.lengths[i] * off + kRounding * largest[i];
    // Sight lines leave the portal's front by its back, and so see it counter-clockwise; the image may be a mirror's.
    const glm::dvec3 across = glm::cross(eye_.rows[0], eye_.rows[1]);
    const double turn = glm::dot(across, eye_.parallel() ? eye_.direction : eye_.rows[2]) < 0 ? 1.0 : -1.0;
    const glm::dvec3 most(eye_.wide[0], eye_.wide[1], 1.0);
    const double squared = tripleBound(seen.doubt, seen.doubt, most);
    // The graph's outlines turn counter-clockwise as seen from the first of the two cells.
    const glm::dvec3* image = images_.data() + seen.first;
    const uint32_t count = portal.count;
    double area = 0;  // as the eye sees it: its sign is that of the turn
    glm::dvec3 normal(0.0);
    const auto corner = [&](uint32_t k) {
        return glm::dvec3(corners.x[portal.first + k], corners.y[portal.first + k], corners.z[portal.first + k]);
    };
    for (uint32_t k = 1; k + 1 < count; ++k) normal += glm::cross(corner(k) - corner(0), corner(k + 1) - corner(0));
    area = glm::dot(normal, glm::dvec3(portal.plane)) < 0 ? -turn : turn;
    for (uint32_t k = 0; k < count; ++k) {
        const glm::dvec3 &a = image[k], &b = image[k + 1 < count ? k + 1 : 0];
        glm::dvec3 line = area * glm::cross(a, b);
        line.z += tripleBound(seen.doubt, a, most) + tripleBound(seen.doubt, b, most) + squared;
        lines_.push_back(line);
    }
    return seen;
}

bool EyeCells::isKnown(const Seen& seen, std::span<const uint32_t> lines) const {
    for (uint32_t i = seen.newest; i != kNone; i = windows_[i].through) {
        const uint32_t* first = kept_.data() + windows_[i].first;
        if (std::includes(lines.begin(), lines.end(), first, first + windows_[i].count)) return true;
    }
    return false;
}

void EyeCells::followLines(const EyeCellSettings& settings) {
    ways_ = settings.ways;
    for (const uint32_t cell : start_) {
        Window whole;
        whole.cell = cell;
        newest_in_[cell] = static_cast<uint32_t>(windows_.size());
        windows_.push_back(whole);
    }
    for (uint32_t i = 0; i < windows_.size(); ++i) {
        if (windows_.size() > settings.work) {
            stats_.work_spent = true;
            level_ = EyeLevel::kChain;
            return;
        }
        const std::span<const DirectedPortal> portals = graph_->portalsFrom(windows_[i].cell);
        const auto first = static_cast<uint32_t>(portals.data() - firstPortal(*graph_));
        for (uint32_t k = 0; k < portals.size(); ++k)
            if (isInRows(portals[k].to)) pass(i, first + k);
    }
}

void EyeCells::pass(uint32_t from, uint32_t index) {
    ++stats_.portals;
    Seen& seen = look(index);
    if (!seen.open) return;
    const DirectedPortal& portal = firstPortal(*graph_)[index];
    const Window& before = windows_[from];
    chosen_.clear();
    for (uint32_t k = before.first; k < before.first + before.count; ++k) {
        const glm::dvec3& line = lines_[kept_[k]];
        if (!seen.near) {
            bool in = true, out = true;
            const double doubt = glm::dot(glm::abs(line), seen.doubt);
            for (uint32_t c = seen.first; c < seen.first + portal.count; ++c) {
                const double height = glm::dot(line, images_[c]);
                in &= height >= 0;
                out &= height < -doubt;
            }
            if (out) return;   // all of the portal is outside
            if (in) continue;  // all of it is inside: the line asks nothing that its own edges do not
        }
        chosen_.push_back(kept_[k]);
    }
    if (!seen.near) {
        const size_t old = chosen_.size();
        for (uint32_t k = 0; k < portal.count; ++k) chosen_.push_back(seen.first + k);
        std::inplace_merge(chosen_.begin(), chosen_.begin() + static_cast<std::ptrdiff_t>(old), chosen_.end());
        chosen_.erase(std::unique(chosen_.begin(), chosen_.end()), chosen_.end());
    }
    if (isKnown(seen, chosen_)) {
        ++stats_.known;
        return;
    }
    program_.clear();
    for (const uint32_t line : chosen_) program_.push_back(lines_[line]);
    glm::dvec2 point = before.point;
    if (!seen.near) {
        glm::dvec3 middle(0.0);
        for (uint32_t c = seen.first; c < seen.first + portal.count; ++c) middle += images_[c];
        if (middle.z > 0) point = glm::dvec2(middle) / middle.z;
    }
    const glm::dvec2 wide(eye_.wide[0], eye_.wide[1]);
    ++stats_.programs;
    if (!commonPoint(program_, -wide, wide, point)) return;
    ++stats_.chains;
    if (ways_ > 0 && seen.ways++ >= ways_) {
        const uint32_t* first = kept_.data() + windows_[seen.newest].first;
        const uint32_t* last = first + windows_[seen.newest].count;
        stats_.joined += erase_if(chosen_, [&](uint32_t line) { return !std::binary_search(first, last, line); }) > 0;
    }
    Window window;
    window.cell = portal.to;
    window.portal = index;
    window.first = static_cast<uint32_t>(kept_.size());
    window.count = static_cast<uint32_t>(chosen_.size());
    window.through = seen.newest;
    window.point = point;
    kept_.insert(kept_.end(), chosen_.begin(), chosen_.end());
    addCell(portal.to);
    window.into = newest_in_[portal.to];
    newest_in_[portal.to] = seen.newest = static_cast<uint32_t>(windows_.size());
    windows_.push_back(window);
}

bool EyeCells::sees(uint32_t cell, const Box3d& box) const {
    if (all_) return true;
    if (seen_[cell] != round_) return false;
    if (level_ == EyeLevel::kRow) return true;
    // The box's corners are as exact as points are; the planes round as they do.
    const Box3d relative{box.min - frustum_.eye - eye_.position, box.max - frustum_.eye + eye_.position};
    for (uint32_t i = 0; i < frustum_.count; ++i) {
        const glm::dvec3 n(frustum_.planes[i]);
        const glm::dvec3 far(n.x > 0 ? relative.max.x : relative.min.x, n.y > 0 ? relative.max.y : relative.min.y,
                             n.z > 0 ? relative.max.z : relative.min.z);
        if (glm::dot(n, far) + frustum_.planes[i].w < 0) return false;
    }
    if (level_ != EyeLevel::kSightLine) return true;
    for (uint32_t i = newest_in_[cell]; i != kNone; i = windows_[i].into)
        if (mayMeet(windows_[i], relative)) return true;
    return false;
}

bool EyeCells::mayMeet(const Window& window, const Box3d& relative) const {
    constexpr size_t kMost = 96;
    glm::dvec4 planes[kMost];
    size_t count = 0;
    const auto add = [&](glm::dvec4 plane, double slack) {
        plane.w += slack;
        if (count < kMost) planes[count++] = plane;
    };
    for (uint32_t i = 0; i < frustum_.count; ++i) add(frustum_.planes[i], eye_.position);
    if (window.portal != kNone) {
        const DirectedPortal& portal = firstPortal(*graph_)[window.portal];
        const glm::dvec3 n(portal.plane);
        add({-n, -glm::dot(n, frustum_.eye) - portal.plane.w}, eye_.position + portal.thickness);
    }
    const glm::dvec3 far = glm::max(glm::abs(relative.min), glm::abs(relative.max));
    for (uint32_t k = window.first; k < window.first + window.count; ++k) {
        // The line's height at the image of a point is a plane's height at the point; both round.
        const glm::dvec3& line = lines_[kept_[k]];
        const glm::dvec3 n = line.x * eye_.rows[0] + line.y * eye_.rows[1] + line.z * eye_.rows[2];
        const double d = glm::dot(line, eye_.shift);
        double size = glm::dot(glm::abs(line), glm::abs(eye_.shift));
        for (int i = 0; i < 3; ++i) size += std::abs(line[i]) * glm::dot(glm::abs(eye_.rows[i]), far);
        add({n, d}, kRounding * size);
    }
    glm::dvec3 point = relative.center();
    return commonPoint({planes, count}, relative.min, relative.max, point);
}

}  // namespace sightline::studies
