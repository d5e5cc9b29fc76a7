// Hiders that meet at corners: together they hide what none of them does alone.
// SPDX-License-Identifier: MIT
#include "sightline/bake/view_cells/hider_covers.h"

#include <algorithm>
#include <bit>

namespace sightline::bake {
namespace {

constexpr double kLeastSine = 0.05;    // of the angle between two planes that meet
constexpr size_t kMostNeighbours = 6;  // of an edge
constexpr size_t kMostCrossed = 32;    // looked at for these
constexpr uint32_t kMostTries = 24;    // hiders that are tried for one cover

double heightOver(const FlatHider& hider, const glm::dvec3& point) {
    return glm::dot(glm::dvec3(hider.plane), point - hider.corners[0]);
}

glm::dvec3 middleOf(const FlatHider& hider) {
    glm::dvec3 middle(0.0);
    for (const glm::dvec3& corner : hider.corners) middle += corner;
    return middle / static_cast<double>(hider.corners.size());
}

}  // namespace

HiderCovers::HiderCovers(std::span<const FlatHider> hiders, const HiderTree& tree, Jobs* jobs) : hiders_(hiders) {
    constexpr size_t kTask = 256;
    std::vector<std::vector<std::vector<uint32_t>>> found(hiders.size());
    const auto tasks = static_cast<uint32_t>((hiders.size() + kTask - 1) / kTask);
    runJobs(jobs, tasks, [&](uint32_t task) {
        for (size_t i = task * kTask; i < std::min((task + 1) * kTask, hiders.size()); ++i)
            findNeighbours(static_cast<uint32_t>(i), tree, found[i]);
    });
    first_.push_back(0);
    for (size_t i = 0; i < hiders.size(); ++i) {
        first_edge_.push_back(static_cast<uint32_t>(first_.size() - 1));
        for (const std::vector<uint32_t>& of_edge : found[i]) {
            neighbours_.insert(neighbours_.end(), of_edge.begin(), of_edge.end());
            first_.push_back(static_cast<uint32_t>(neighbours_.size()));
        }
    }
}

/// Looks from the middle of a hider to its edges, a little in front of it.
void HiderCovers::findNeighbours(uint32_t number, const HiderTree& tree,
                                 std::vector<std::vector<uint32_t>>& out) const {
    const FlatHider& hider = hiders_[number];
    const glm::dvec3 lift = 4 * hider.bend * glm::dvec3(hider.plane), middle = middleOf(hider);
    std::vector<Crossed> crossed;
    out.resize(hider.corners.size());
    for (size_t edge = 0; edge < hider.corners.size(); ++edge) {
        const glm::dvec3 to = 0.5 * (hider.corners[edge] + hider.corners[(edge + 1) % hider.corners.size()]);
        const double length = glm::distance(middle, to);
        if (!(length > 0)) continue;
        crossed.clear();
        tree.crossed(middle + lift, to + 8 * hider.bend / length * (to - middle) + lift, kMostCrossed, crossed);
        for (const Crossed& one : crossed)
            if (endsAt(hider, edge, hiders_[one.hider])) out[edge].push_back(one.hider);
        std::stable_sort(out[edge].begin(), out[edge].end(),
                         [&](uint32_t a, uint32_t b) { return hiders_[a].area > hiders_[b].area; });
        if (out[edge].size() > kMostNeighbours) out[edge].resize(kMostNeighbours);
    }
}

/// Whether an edge lies behind another hider's plane, but for what a hole may be.
bool HiderCovers::endsAt(const FlatHider& hider, size_t edge, const FlatHider& other) const {
    const double sine = glm::length(glm::cross(glm::dvec3(hider.plane), glm::dvec3(other.plane)));
    if (sine < kLeastSine) return false;
    const double most = std::min(hider.hole, other.hole) / 2 * sine;
    return heightOver(other, hider.corners[edge]) <= most &&
           heightOver(other, hider.corners[(edge + 1) % hider.corners.size()]) <= most;
}

/// Whether a part of a member's polygon is in front of the planes of all others.
bool HiderCovers::hasPlace(const HiderCover& cover, size_t member) const {
    std::vector<glm::dvec3> left = hiders_[cover[member].hider].corners, next;
    for (size_t j = 0; j < cover.size(); ++j) {
        if (j == member) continue;
        const FlatHider& other = hiders_[cover[j].hider];
        next.clear();
        for (size_t i = 0; i < left.size(); ++i) {
            const glm::dvec3 &a = left[i], &b = left[(i + 1) % left.size()];
            const double above_a = heightOver(other, a) - other.bend, above_b = heightOver(other, b) - other.bend;
            if (above_a >= 0) next.push_back(a);
            if ((above_a >= 0) != (above_b >= 0)) next.push_back(a + above_a / (above_a - above_b) * (b - a));
        }
        left.swap(next);
        if (left.size() < 3) return false;
    }
    return true;
}

bool HiderCovers::add(HiderCover& cover, uint32_t number) const {
    if (cover.size() == kMostMembers) return false;
    for (const CoverMember& member : cover)
        if (member.hider == number) return false;
    HiderCover grown = cover;
    grown.push_back({number, 0});
    const FlatHider& added = hiders_[number];
    for (size_t i = 0; i + 1 < grown.size(); ++i) {
        const FlatHider& member = hiders_[grown[i].hider];
        for (size_t edge = 0; edge < member.corners.size(); ++edge)
            grown[i].shared |= uint32_t{endsAt(member, edge, added)} << edge;
        for (size_t edge = 0; edge < added.corners.size(); ++edge)
            grown.back().shared |= uint32_t{endsAt(added, edge, member)} << edge;
    }
    for (size_t i = 0; i < grown.size(); ++i)
        if (!hasPlace(grown, i)) return false;
    cover = std::move(grown);
    return true;
}

RegionCovers::RegionCovers(const HiderCovers& of, const Box3d& region, double reach) : of_(of), reach_(reach) {
    for (int i = 0; i < 8; ++i)
        corners_[i] = {i & 1 ? region.max.x : region.min.x, i & 2 ? region.max.y : region.min.y,
                       i & 4 ? region.max.z : region.min.z};
}

const RegionShadow* RegionCovers::shadowOf(uint32_t hider) {
    const auto [found, fresh] = shadows_.try_emplace(hider);
    if (fresh) {
        const RegionShadow shadow(of_.hiders()[hider], corners_, reach_);
        if (shadow.any()) found->second = std::make_unique<RegionShadow>(shadow);
    }
    return found->second.get();
}

bool ReadyCover::hides(const Box3d& box) const {
    bool behind = false;
    for (size_t i = 0; i < cover.size(); ++i) {
        const RegionShadow& shadow = *shadows[i];
        behind = behind || shadow.isBehind(box);
        if ((shadow.beside(box) & ~cover[i].shared) != 0 && !shadow.isInFront(box)) return false;
    }
    return behind;
}

std::optional<ReadyCover> RegionCovers::take(const HiderCover& cover) {
    ReadyCover ready{cover, {}};
    for (const CoverMember& member : cover) {
        ready.shadows.push_back(shadowOf(member.hider));
        if (!ready.shadows.back()) return std::nullopt;
    }
    return ready;
}

std::optional<ReadyCover> RegionCovers::find(uint32_t first, const Box3d& box) {
    HiderCover cover;
    const RegionShadow* shadow = shadowOf(first);
    if (!shadow || !shadow->isBehind(box)) return std::nullopt;
    cover.push_back({first, 0});
    uint32_t tries = 0;
    for (size_t at = 0; at < cover.size();) {
        const CoverMember member = cover[at];
        shadow = shadowOf(member.hider);
        const uint32_t open = shadow->isInFront(box) ? 0 : shadow->beside(box) & ~member.shared;
        if (open == 0) {
            ++at;
            continue;
        }
        // The edge is closed by a hider that it ends at, one of those that have the region in front of them.
        const auto edge = static_cast<uint32_t>(std::countr_zero(open));
        bool closed = false;
        for (const uint32_t next : of_.neighbours(member.hider, edge)) {
            if (++tries > kMostTries) return std::nullopt;
            if (!shadowOf(next) || !of_.add(cover, next)) continue;
            closed = true;
            break;
        }
        if (!closed) return std::nullopt;
    }
    return take(cover);
}

}  // namespace sightline::bake
