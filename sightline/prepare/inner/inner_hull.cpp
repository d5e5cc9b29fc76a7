// Makes the surface of a solid simpler so that what it holds only shrinks: sides collapse inward, by exact predicates.
// SPDX-License-Identifier: MIT
#include "sightline/prepare/inner/inner_hull.h"

#include <algorithm>
#include <cmath>

#include "sightline/prepare/inner/separation.h"
#include "sightline/prepare/occluder/exact.h"

namespace sightline {
namespace {

constexpr size_t kMostInStar = 48;    // triangles around a side: beyond that it stays
constexpr uint32_t kMostNear = 3000;  // triangles near a tetrahedron: beyond that the step is not taken
constexpr double kLeastTurn = 0.1;    // cosine by which a triangle may turn in a step

bool touches(const Box3f& a, const Box3f& b) {
    for (int axis = 0; axis < 3; ++axis)
        if (a.min[axis] > b.max[axis] || a.max[axis] < b.min[axis]) return false;
    return true;
}

}  // namespace

InnerHull::InnerHull(std::span<const glm::vec3> positions, std::span<const SolidTriangle> triangles,
                     const Solid& solid) {
    std::vector<uint32_t> number(positions.size(), ~uint32_t{0});
    triangles_.reserve(solid.triangles.size());
    float largest = 0;
    for (uint32_t t : solid.triangles) {
        SolidTriangle triangle;
        for (int k = 0; k < 3; ++k) {
            uint32_t& at = number[triangles[t].vertex[k]];
            if (at == ~uint32_t{0}) {
                at = static_cast<uint32_t>(positions_.size());
                positions_.push_back(positions[triangles[t].vertex[k]]);
                for (int axis = 0; axis < 3; ++axis) largest = std::max(largest, std::abs(positions_.back()[axis]));
            }
            triangle.vertex[k] = at;
        }
        triangles_.push_back(triangle);
    }
    rounding_ = largest * 0x1p-22f;
    living_ = static_cast<uint32_t>(triangles_.size());
    alive_.assign(triangles_.size(), 1);
    met_.assign(triangles_.size(), 0);
    around_.resize(positions_.size());
    version_.assign(positions_.size(), 0);
    errors_.assign(positions_.size(), 0.0f);
    marked_.assign(positions_.size(), 0);
    for (uint32_t t = 0; t < triangles_.size(); ++t)
        for (uint32_t vertex : triangles_[t].vertex) around_[vertex].push_back(t);
    rebuildGrid();
    for (const SolidTriangle& triangle : triangles_)
        for (int k = 0; k < 3; ++k) {
            const uint32_t a = triangle.vertex[k], b = triangle.vertex[(k + 1) % 3];
            if (a < b) offer(a, b);
        }
}

Box3f InnerHull::boxOf(uint32_t triangle) const {
    Box3f box;
    for (int k = 0; k < 3; ++k) box.grow(corner(triangle, k));
    return box;
}

void InnerHull::rebuildGrid() {
    Box3f region;
    for (uint32_t t = 0; t < triangles_.size(); ++t)
        if (alive_[t]) region.grow(boxOf(t));
    grid_ = std::make_unique<TriangleGrid>(region, living_);
    for (uint32_t t = 0; t < triangles_.size(); ++t)
        if (alive_[t]) grid_->add(t, boxOf(t));
    grid_living_ = living_;
}

/// The triangles that have a or b as a corner, each once, and their planes.
void InnerHull::gatherStar(uint32_t a, uint32_t b) {
    star_ = around_[a];
    if (b != a)
        for (uint32_t t : around_[b]) {
            const auto& v = triangles_[t].vertex;
            if (v[0] != a && v[1] != a && v[2] != a) star_.push_back(t);
        }
    planes_.clear();
    areas_.clear();
    for (uint32_t t : star_) {
        const glm::dvec3 p(corner(t, 0));
        const glm::dvec3 n = glm::cross(glm::dvec3(corner(t, 1)) - p, glm::dvec3(corner(t, 2)) - p);
        const double length = glm::length(n);
        const glm::dvec3 unit = length > 0 ? n / length : glm::dvec3(0.0);
        planes_.emplace_back(unit, -glm::dot(unit, p));
        areas_.push_back(length);
    }
}

/// Whether the ends of a side have just two neighbours in common: else what is left would touch itself.
bool InnerHull::isLinked(uint32_t a, uint32_t b) {
    ++mark_;
    for (uint32_t t : around_[a])
        for (uint32_t vertex : triangles_[t].vertex) marked_[vertex] = mark_;
    marked_[a] = marked_[b] = 0;
    int common = 0;
    for (uint32_t t : around_[b])
        for (uint32_t vertex : triangles_[t].vertex) {
            common += marked_[vertex] == mark_;
            if (marked_[vertex] == mark_) marked_[vertex] = 0;
        }
    return common == 2;
}

/// Takes up a place if it lies on or behind all of the star, and the surface moves less than it does with the best so
/// far.
bool InnerHull::tryPlace(uint32_t a, uint32_t b, const glm::vec3& to, Step& best) const {
    double depth = 0;
    for (const glm::dvec4& plane : planes_) depth = std::max(depth, -(glm::dot(plane, glm::dvec4(to, 1.0))));
    if (!(depth < best.depth)) return false;
    for (size_t i = 0; i < star_.size(); ++i) {
        const Side side = sideOf(to, corner(star_[i], 0), corner(star_[i], 1), corner(star_[i], 2));
        if (side != Side::kBehind && side != Side::kOn) return false;
        glm::vec3 moved[3];
        int changed = 0;
        for (int k = 0; k < 3; ++k) {
            const uint32_t vertex = triangles_[star_[i]].vertex[k];
            const bool moves = vertex == a || vertex == b;
            moved[k] = moves ? to : positions_[vertex];
            changed += moves;
        }
        if (changed > 1) continue;
        const glm::dvec3 p(moved[0]);
        const glm::dvec3 n = glm::cross(glm::dvec3(moved[1]) - p, glm::dvec3(moved[2]) - p);
        if (!(glm::dot(n, glm::dvec3(planes_[i])) > kLeastTurn * glm::length(n))) return false;
        if (areCollinear(moved[0], moved[1], moved[2])) return false;
    }
    best.to = to;
    best.depth = static_cast<float>(depth);
    return true;
}

/// A place behind all of the star's planes near the given one, if one is found: each step goes straight behind the
/// plane that the place is farthest in front of.
glm::dvec3 InnerHull::pushInside(glm::dvec3 place) const {
    for (int round = 0; round < 40; ++round) {
        double worst = -rounding_;
        const glm::dvec4* before = nullptr;
        for (const glm::dvec4& plane : planes_) {
            const double height = glm::dot(plane, glm::dvec4(place, 1.0));
            if (height > worst) {
                worst = height;
                before = &plane;
            }
        }
        if (!before) break;
        place -= (worst + 2.0 * rounding_) * glm::dvec3(*before);
    }
    return place;
}

/// The place behind all of the star's planes with the smallest tetrahedra: a corner of what the planes leave.
bool InnerHull::leastLoss(glm::dvec3& place) const {
    constexpr size_t kMost = 18;  // planes: the work grows with their fourth power
    constexpr double kLeastVolume = 1e-3;
    const size_t count = planes_.size();
    if (count > kMost) return false;
    double best = std::numeric_limits<double>::max();
    const auto normal = [&](size_t i) { return glm::dvec3(planes_[i]); };
    for (size_t i = 0; i < count; ++i)
        for (size_t j = i + 1; j < count; ++j) {
            const glm::dvec3 along = glm::cross(normal(i), normal(j));
            for (size_t k = j + 1; k < count; ++k) {
                const double volume = glm::dot(along, normal(k));
                if (std::abs(volume) < kLeastVolume) continue;
                const glm::dvec3 at = -(planes_[k].w * along + planes_[i].w * glm::cross(normal(j), normal(k)) +
                                        planes_[j].w * glm::cross(normal(k), normal(i))) /
                                      volume;
                double loss = 0;
                for (size_t m = 0; m < count && loss < best; ++m) {
                    const double height = glm::dot(planes_[m], glm::dvec4(at, 1.0));
                    loss = height > rounding_ ? best : loss - areas_[m] * height;
                }
                if (!(loss < best)) continue;
                best = loss;
                place = at;
            }
        }
    return best < std::numeric_limits<double>::max();
}

bool InnerHull::plan(uint32_t a, uint32_t b, Step& step) {
    gatherStar(a, b);
    if (star_.size() > kMostInStar || !isLinked(a, b)) return false;
    step.depth = std::numeric_limits<float>::max();
    bool found = tryPlace(a, b, positions_[a], step);
    found |= tryPlace(a, b, positions_[b], step);
    const glm::dvec3 middle = 0.5 * (glm::dvec3(positions_[a]) + glm::dvec3(positions_[b]));
    found |= tryPlace(a, b, glm::vec3(pushInside(middle)), step);
    glm::dvec3 corner(0.0);
    if (leastLoss(corner)) found |= tryPlace(a, b, glm::vec3(pushInside(corner)), step);
    return found;
}

/// Whether no triangle of the surface meets the inside of a tetrahedron between the star and the place.
bool InnerHull::isClear(const glm::vec3& to) {
    for (uint32_t base : star_) {
        const glm::vec3 tetrahedron[4] = {corner(base, 0), corner(base, 1), corner(base, 2), to};
        if (sideOf(to, tetrahedron[0], tetrahedron[1], tetrahedron[2]) == Side::kOn) continue;
        Box3f box = boxOf(base);
        box.grow(to);
        ++test_;
        uint32_t met = 0;
        bool clear = true;
        grid_->near(box, [&](uint32_t other) {
            if (!alive_[other] || other == base || met_[other] == test_) return true;
            met_[other] = test_;
            if (!touches(boxOf(other), box)) return true;
            const glm::vec3 triangle[3] = {corner(other, 0), corner(other, 1), corner(other, 2)};
            clear = ++met < kMostNear && areParted(tetrahedron, triangle);
            return clear;
        });
        if (!clear) return false;
    }
    return true;
}

/// Moves a and b, whose star is gathered, to one place: b's triangles become a's.
void InnerHull::apply(uint32_t a, uint32_t b, const Step& step) {
    const float error = std::max(errors_[a], errors_[b]) + step.depth;
    ++mark_;
    for (uint32_t t : star_) {
        int ends = 0;
        for (uint32_t vertex : triangles_[t].vertex) {
            ends += vertex == a || vertex == b;
            marked_[vertex] = mark_;
        }
        if (a == b || ends == 1) continue;
        alive_[t] = 0;
        --living_;
    }
    positions_[a] = step.to;
    errors_[a] = error;
    error_ = std::max(error_, error);
    for (uint32_t t : star_) {
        for (uint32_t& vertex : triangles_[t].vertex) {
            if (marked_[vertex] == mark_ && vertex != a && vertex != b) {
                marked_[vertex] = 0;
                ++version_[vertex];
                if (a != b) std::erase_if(around_[vertex], [&](uint32_t i) { return !alive_[i]; });
            }
            if (alive_[t] && vertex == b) vertex = a;
        }
        if (alive_[t]) grid_->add(t, boxOf(t));
    }
    ++version_[a];
    if (a == b) return;
    ++version_[b];
    around_[b].clear();
    std::erase_if(star_, [&](uint32_t t) { return !alive_[t]; });
    around_[a] = star_;
}

void InnerHull::offer(uint32_t a, uint32_t b) {
    Step step;
    if (!plan(a, b, step)) return;
    heap_.push_back({std::max(errors_[a], errors_[b]) + step.depth, a, b, version_[a] + version_[b]});
    std::push_heap(heap_.begin(), heap_.end());
}

void InnerHull::offerAround(uint32_t vertex) {
    std::vector<uint32_t> neighbours;
    for (uint32_t t : around_[vertex])
        for (uint32_t other : triangles_[t].vertex)
            if (other != vertex) neighbours.push_back(other);
    std::sort(neighbours.begin(), neighbours.end());
    neighbours.erase(std::unique(neighbours.begin(), neighbours.end()), neighbours.end());
    for (uint32_t other : neighbours) offer(std::min(vertex, other), std::max(vertex, other));
}

void InnerHull::simplify(uint32_t most_triangles, float worst) {
    while (living_ > most_triangles && !heap_.empty() && heap_.front().cost <= worst) {
        std::pop_heap(heap_.begin(), heap_.end());
        const Candidate next = heap_.back();
        heap_.pop_back();
        if (around_[next.a].empty() || around_[next.b].empty()) continue;
        if (version_[next.a] + version_[next.b] != next.version) {
            offer(next.a, next.b);
            continue;
        }
        Step step;
        if (!plan(next.a, next.b, step) || !isClear(step.to)) continue;
        apply(next.a, next.b, step);
        if (2 * living_ < grid_living_) rebuildGrid();
        offerAround(next.a);
    }
}

std::vector<SolidTriangle> InnerHull::triangles() const {
    std::vector<SolidTriangle> out;
    out.reserve(living_);
    for (uint32_t t = 0; t < triangles_.size(); ++t)
        if (alive_[t]) out.push_back(triangles_[t]);
    return out;
}

}  // namespace sightline
