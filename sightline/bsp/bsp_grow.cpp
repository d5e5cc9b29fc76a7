// Grows a BSP tree from a set of polygons, in a tree's own arrays or in an overlay's.
// SPDX-License-Identifier: MIT
#include "sightline/bsp/bsp_grow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {

BspGrower::BspGrower(BspArrays& arrays, const BspPolygons& input, const BspSettings& settings, double thickness,
                     double rounding)
    : arrays_(arrays),
      input_(input),
      settings_(settings),
      thickness_(thickness),
      rounding_(rounding),
      points_(input.points),
      random_(mixSeed(settings.seed, input.size())) {
    lines_.reserve(points_.size());
    line_of_point_.reserve(points_.size());
    for (uint32_t i = 0; i < input.size(); ++i)
        for (uint32_t p = input.first[i]; p < input.first[i + 1]; ++p) {
            line_of_point_.push_back(p);
            lines_.push_back({points_[p], points_[p + 1 < input.first[i + 1] ? p + 1 : input.first[i]]});
        }
}

std::vector<BspFalling> BspGrower::takeAll() {
    std::vector<BspFalling> pieces;
    pieces.reserve(input_.size());
    planes_.resize(input_.size());
    for (uint32_t i = 0; i < input_.size(); ++i) {
        const std::optional<glm::dvec4> plane = planeOf(input_.outline(i));
        if (!plane) {
            ++arrays_.degenerate;
            continue;
        }
        planes_[i] = *plane;
        pieces.push_back({i, input_.first[i], input_.first[i + 1] - input_.first[i], BspNode::kNone, 0});
    }
    return pieces;
}

void BspGrower::part(const std::vector<BspFalling>& pieces, uint32_t node, const glm::dvec4& plane,
                     std::vector<BspFalling> sides[2], std::vector<BspFalling>& in_plane) {
    for (const BspFalling& piece : pieces) {
        const BspReach reach = reachOf(outline(piece), plane, thickness_);
        if (!reach.back && !reach.front) {
            in_plane.push_back(piece);
        } else if (reach.back != reach.front) {
            sides[reach.front].push_back(piece);
        } else {
            const std::span<const uint32_t> lines(line_of_point_.data() + piece.first_point, piece.count);
            const double uncertainty = splitPolygon(outline(piece), lines, lines_, plane, thickness_, rounding_,
                                                    parts_[kBspBack], parts_[kBspFront]);
            ++arrays_.splits;
            for (const BspSide side : {kBspBack, kBspFront}) {
                BspFalling rest = piece;
                rest.first_point = static_cast<uint32_t>(points_.size());
                rest.count = static_cast<uint32_t>(parts_[side].points.size());
                rest.cut = static_cast<uint32_t>(arrays_.cuts.size());
                rest.uncertainty = std::max(piece.uncertainty, uncertainty);
                const BspOutline& part = parts_[side];
                points_.insert(points_.end(), part.points.begin(), part.points.end());
                line_of_point_.insert(line_of_point_.end(), part.lines.begin(), part.lines.end());
                arrays_.cuts.push_back({node, side, piece.cut});
                sides[side].push_back(rest);
            }
        }
    }
}

/// Evenly spread over the set if that is larger than what candidates are tried on.
const BspFalling& BspGrower::scored(const std::vector<BspFalling>& pieces, uint32_t i) const {
    const size_t limit = settings_.scored;
    return pieces.size() <= limit ? pieces[i] : pieces[i * pieces.size() / limit];
}

double BspGrower::costOf(const std::vector<BspFalling>& pieces, const Candidate& candidate) const {
    const uint32_t count = static_cast<uint32_t>(std::min<size_t>(pieces.size(), settings_.scored));
    double splits = 0, balance = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const BspReach reach = reachOf(outline(scored(pieces, i)), candidate.plane, thickness_);
        splits += reach.back && reach.front;
        balance += int{reach.front} - int{reach.back};
    }
    return settings_.split_weight * splits + settings_.balance_weight * std::abs(balance);
}

/// The median of the pieces' corners on one axis.
BspGrower::Candidate BspGrower::medianPlane(const std::vector<BspFalling>& pieces, int axis) const {
    const uint32_t count = static_cast<uint32_t>(std::min<size_t>(pieces.size(), settings_.scored));
    std::vector<double> places;
    places.reserve(count);
    for (uint32_t i = 0; i < count; ++i) places.push_back(outline(scored(pieces, i))[0][axis]);
    std::nth_element(places.begin(), places.begin() + count / 2, places.end());
    Candidate candidate;
    candidate.plane[axis] = 1;
    candidate.plane.w = -places[count / 2];
    return candidate;
}

/// Whether each side, split pieces and all, is left with fewer than there are: otherwise growing would not end.
bool BspGrower::divides(const std::vector<BspFalling>& pieces, const glm::dvec4& plane) const {
    size_t back = 0, front = 0;
    for (const BspFalling& piece : pieces) {
        const BspReach reach = reachOf(outline(piece), plane, thickness_);
        back += reach.back;
        front += reach.front;
    }
    return back < pieces.size() && front < pieces.size();
}

BspGrower::Candidate BspGrower::choose(const std::vector<BspFalling>& pieces) {
    const auto ofPiece = [&](uint64_t i) { return Candidate{planes_[pieces[i].polygon], static_cast<uint32_t>(i)}; };
    const bool all = pieces.size() <= settings_.candidates;
    if (settings_.candidates == 1) return ofPiece(random_.below(pieces.size()));
    const uint64_t count = all ? pieces.size() : settings_.candidates;
    Candidate best;
    double least = std::numeric_limits<double>::infinity();
    for (uint64_t i = 0; i < count; ++i) {
        const Candidate candidate = ofPiece(all ? i : random_.below(pieces.size()));
        const double cost = costOf(pieces, candidate);
        if (cost >= least) continue;
        least = cost;
        best = candidate;
    }
    // A few pieces are not worth a plane that takes none of them away.
    if (!settings_.axis_planes || all) return best;
    Candidate best_axis;
    double least_axis = least;
    for (int axis = 0; axis < 3; ++axis) {
        const Candidate candidate = medianPlane(pieces, axis);
        const double cost = costOf(pieces, candidate);
        if (cost >= least_axis) continue;
        least_axis = cost;
        best_axis = candidate;
    }
    return least_axis < least && divides(pieces, best_axis.plane) ? best_axis : best;
}

uint32_t BspGrower::makeLeaf(uint32_t slot) {
    uint32_t number = free_leaf_;
    free_leaf_ = BspNode::kNone;
    if (number == BspNode::kNone) {
        number = arrays_.first_leaf + static_cast<uint32_t>(arrays_.leaf.size());
        arrays_.leaf.push_back(slot);
    } else {
        arrays_.leaf[number - arrays_.first_leaf] = slot;
    }
    return BspNode::kLeaf | number;
}

Box3d BspGrower::boundsOf(const std::vector<BspFalling>& pieces) const {
    Box3d box;
    for (const BspFalling& piece : pieces) {
        // Corners may be off, and what is drawn ends where its own cuts end.
        const double room = piece.uncertainty + rounding_;
        for (const glm::dvec3& p : outline(piece)) {
            box.grow(p - room);
            box.grow(p + room);
        }
    }
    return box;
}

void BspGrower::place(const std::vector<BspFalling>& in_plane, const glm::dvec4& plane, std::vector<BspPiece> already,
                      uint32_t& first, uint32_t& count) {
    for (const BspFalling& piece : in_plane) {
        const std::span<const glm::dvec3> points = outline(piece);
        const bool opposite = glm::dot(glm::dvec3(planes_[piece.polygon]), glm::dvec3(plane)) < 0;
        already.push_back({input_.number[piece.polygon], static_cast<uint32_t>(arrays_.points.size()), piece.count,
                           piece.cut, opposite});
        arrays_.points.insert(arrays_.points.end(), points.begin(), points.end());
    }
    std::stable_sort(already.begin(), already.end(),
                     [](const BspPiece& a, const BspPiece& b) { return a.number < b.number; });
    first = static_cast<uint32_t>(arrays_.pieces.size());
    count = static_cast<uint32_t>(already.size());
    arrays_.pieces.insert(arrays_.pieces.end(), already.begin(), already.end());
}

uint32_t BspGrower::grow(std::vector<BspFalling> pieces, uint32_t slot, uint32_t leaf) {
    struct Task {
        std::vector<BspFalling> pieces;
        uint32_t slot;
    };
    free_leaf_ = leaf;
    if (pieces.empty()) return makeLeaf(slot);
    const uint32_t base = arrays_.first_node;
    const size_t start = arrays_.nodes.size();
    std::vector<Task> tasks;
    tasks.push_back({std::move(pieces), slot});
    while (!tasks.empty()) {
        const Task task = std::move(tasks.back());
        tasks.pop_back();
        const uint32_t number = base + static_cast<uint32_t>(arrays_.nodes.size());
        SIGHTLINE_ASSERT(number < BspNode::kLeaf);
        Candidate splitter = choose(task.pieces);
        std::vector<BspFalling> sides[2], in_plane, others;
        if (splitter.piece == BspNode::kNone) {
            part(task.pieces, number, splitter.plane, sides, in_plane);
        } else {
            // The splitter lies in its own plane by decree, so that each node takes away one piece at least.
            in_plane.push_back(task.pieces[splitter.piece]);
            others = task.pieces;
            others.erase(others.begin() + splitter.piece);
            part(others, number, splitter.plane, sides, in_plane);
        }
        BspNode node;
        node.plane = splitter.plane;
        place(in_plane, node.plane, {}, node.first, node.count);
        arrays_.nodes.push_back(node);
        arrays_.parent.push_back(task.slot);
        arrays_.bounds.push_back(boundsOf(in_plane));
        arrays_.below.push_back(node.count);
        if (arrays_.nodes.size() - 1 > start) arrays_.nodes[(task.slot >> 1) - base].child[task.slot & 1] = number;
        for (const BspSide side : {kBspBack, kBspFront}) {
            const uint32_t below = number << 1 | side;
            if (sides[side].empty()) arrays_.nodes.back().child[side] = makeLeaf(below);
            else tasks.push_back({std::move(sides[side]), below});
        }
    }
    for (size_t i = arrays_.nodes.size() - 1; i > start; --i) {
        const uint32_t parent = (arrays_.parent[i] >> 1) - base;
        arrays_.bounds[parent].grow(arrays_.bounds[i]);
        arrays_.below[parent] += arrays_.below[i];
    }
    return base + static_cast<uint32_t>(start);
}

}  // namespace sightline
