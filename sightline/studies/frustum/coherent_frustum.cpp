// View frustum culling over a hierarchy: eight children at once, or one by one with all that two frames have in common.
// SPDX-License-Identifier: MIT
//
// Ulf Assarsson, Tomas Moller. Optimized View Frustum Culling Algorithms for Bounding Boxes. 2000.
#include "sightline/studies/frustum/coherent_frustum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/studies/frustum/walk_planes.h"

namespace sightline::studies {

using detail::WalkPlane;
using detail::WalkPlanes;

/// Two planes that face each other: normal[second] + turn * normal[first] = along * normal[base], and for the
/// distances the same but for `apart`. So the first and the base tell how far inside the second a box is at least.
struct OppositePair {
    uint8_t first = 0, second = 0;
    uint8_t base = 255;  ///< none is needed: they are parallel
    double turn = 0, along = 0, apart = 0;
};

namespace {

/// True if the pair is one, with or without the base's help.
bool solvePair(const glm::dvec4* planes, uint8_t first, uint8_t second, uint8_t base, OppositePair& pair) {
    const glm::dvec3 a(planes[first]), b(planes[second]);
    pair = {first, second, 255, 1.0, 0.0, planes[first].w + planes[second].w};
    if (glm::length(a + b) < 1e-12) return true;
    if (base == first || base == second) return false;
    const glm::dvec3 n(planes[base]);
    const double an = glm::dot(a, n), bn = glm::dot(b, n), rest = 1.0 - an * an;
    if (rest < 1e-6) return false;
    pair.base = base;
    pair.turn = -(glm::dot(a, b) - an * bn) / rest;  // what is left of b across n, along that of a
    pair.along = bn + pair.turn * an;
    pair.apart = planes[second].w + pair.turn * planes[first].w - pair.along * planes[base].w;
    return pair.turn > 0.0 && pair.along >= 0.0 && glm::length(b + pair.turn * a - pair.along * n) < 1e-12;
}

WalkPlanes makePlanes(const RefinedVolume& refined, const PlacedBvh& tree, const HierarchyCulling& how) {
    const ViewVolume& volume = refined.volume;
    const double reach = tree.reach();
    const glm::dvec3 shift = tree.origin - volume.eye;
    WalkPlanes planes;
    planes.count = std::min(volume.count, WalkPlanes::kMost);
    for (uint32_t k = 0; k < planes.count; ++k) planes.planes[k] = detail::walkPlane(volume.planes[k], shift, reach);
    const auto refine = [&](const glm::dvec4* from, uint32_t count) {
        for (uint32_t k = 0; k < count; ++k)
            planes.refining[planes.refining_count++] = detail::walkPlane(from[k], shift, reach);
    };
    if (how.refinement != Refinement::kNone) refine(refined.axes, refined.axis_count);
    if (how.refinement == Refinement::kSeparatingAxes) refine(refined.crossed, refined.crossed_count);
    return planes;
}

}  // namespace

/// The walk that asks one child after the other.
struct OneByOne {
    HierarchyCuller& culler;
    const WalkPlanes& planes;
    const PlacedBvh& tree;
    const HierarchyCulling& how;
    uint32_t* kept;
    OppositePair pairs[3] = {};
    uint32_t pair_count = 0;

    /// A child while it is asked.
    struct Child {
        const BvhNode& node;
        size_t place;  ///< in what the culler remembers
        int slot;
        uint32_t left;                                             // planes still to be asked
        uint32_t crossed = 0;                                      // asked, and not inside
        double most[WalkPlanes::kMost], least[WalkPlanes::kMost];  // of those that were asked; else as planes say
    };

    static float sum(const WalkPlane& p, const uint8_t* rows, const BvhNode& node, int slot) {
        return (p.n[0] * detail::rowOf(node, rows[0])[slot] + p.n[1] * detail::rowOf(node, rows[1])[slot]) +
               p.n[2] * detail::rowOf(node, rows[2])[slot];
    }

    /// Asks one plane; true if the child is outside.
    bool outside(Child& child, uint32_t k) {
        const WalkPlane& p = planes.planes[k];
        ++culler.stats_.plane_tests;
        child.left &= ~(1u << k);
        const float most = sum(p, p.most, child.node, child.slot) + p.outer;
        if (most < 0.0f) return remember(child, k, most), true;
        const float least = sum(p, p.least, child.node, child.slot) + p.inner;
        if (!(least >= 0.0f)) child.crossed |= 1u << k;
        child.most[k] = most;
        child.least[k] = least;
        return false;
    }

    void remember(const Child& child, uint32_t k, float most) {
        if (!how.coherent()) return;
        culler.last_plane_[child.place] = static_cast<uint8_t>(k);
        if (!how.translation && !how.rotation) return;
        HierarchyCuller::Memo* memo = &culler.memos_[child.place];
        const HierarchyCuller::Motion& motion = culler.motion_;
        double squared = 0.0;
        for (int axis = 0; axis < 3; ++axis) {
            const double shift = tree.origin[axis] - motion.last.eye[axis];
            const double far = std::max(std::abs(child.node.min[axis][child.slot] + shift),
                                        std::abs(child.node.max[axis][child.slot] + shift));
            squared += far * far;
        }
        // Each is rounded to the side that makes the memo hold for less long.
        const auto up = [](double value) { return static_cast<float>(value + std::abs(value) * 0x1p-22); };
        memo->inside = up(most - motion.way[k]);
        memo->reach = up(std::sqrt(squared));
        memo->turned = -up(-motion.turned[k]);
        memo->travelled = static_cast<float>(motion.travelled);
    }

    /// True if what culled the child still does, for how little the camera has moved.
    bool stillOutside(const Child& child) {
        const uint8_t plane = culler.last_plane_[child.place];
        if (plane >= planes.count) return false;
        const HierarchyCuller::Memo* memo = &culler.memos_[child.place];
        const HierarchyCuller::Motion& motion = culler.motion_;
        const double turned = motion.turned[plane] - memo->turned;
        const double travelled = motion.travelled - memo->travelled;
        if (!how.rotation && turned > 0x1p-20 * motion.turned[plane]) return false;
        if (!how.translation && travelled > 0x1p-20 * motion.travelled) return false;
        const double way = motion.way[plane];
        const double inside =
            memo->inside + way +
            turned * (memo->reach + std::max(travelled, 0.0) * (1.0 + 0x1p-20) + 0x1p-20 * motion.travelled);
        // Below this the plane's own test says so, too, whatever it rounds.
        return inside < -4.0 * planes.planes[plane].margin - 0x1p-20 * (std::abs(memo->inside) + std::abs(way));
    }

    /// The octant test: the planes on the centre's side are asked, and those across that their answers vouch for are not.
    bool outsideByOctant(Child& child) {
        for (uint32_t i = 0; i < pair_count; ++i) {
            const OppositePair& pair = pairs[i];
            const uint32_t both = 1u << pair.first | 1u << pair.second;
            if ((child.left & both) != both) continue;
            const WalkPlane &a = planes.planes[pair.first], &b = planes.planes[pair.second];
            float side = a.outer - b.outer;  // of the centre, from the plane between the two
            for (int axis = 0; axis < 3; ++axis)
                side += (a.n[axis] - b.n[axis]) * 0.5f *
                        (child.node.min[axis][child.slot] + child.node.max[axis][child.slot]);
            OppositePair turned = pair;
            if (!(side <= 0.0f)) {  // the second is nearer: solve for the first
                turned.first = pair.second, turned.second = pair.first;
                turned.turn = 1.0 / pair.turn, turned.along = pair.along / pair.turn,
                turned.apart = pair.apart / pair.turn;
            }
            if (outside(child, turned.first)) return true;
            double base = 0.0;
            if (pair.base != 255) {
                if (child.left >> pair.base & 1)
                    if (outside(child, pair.base)) return true;
                base = child.least[pair.base];
            }
            const double most = child.most[turned.first];
            const double least = turned.along * base + turned.apart - turned.turn * most;
            const double slack =
                0x1p-20 * (turned.along * std::abs(base) + std::abs(turned.apart) + turned.turn * std::abs(most)) +
                2.0 * planes.planes[turned.second].margin;
            if (!(least > slack)) continue;
            child.left &= ~(1u << turned.second);
            child.least[turned.second] = least;
        }
        return false;
    }

    /// Planes that the child crosses, or ~0 if it is outside.
    uint32_t ask(uint32_t index, const BvhNode& node, int slot, uint32_t active) {
        Child child{node, size_t{8} * index + static_cast<size_t>(slot), slot, active, 0, {}, {}};
        std::fill_n(child.least, WalkPlanes::kMost, 0.0);  // a plane that is not active holds the parent
        ++culler.stats_.boxes;
        if ((how.translation || how.rotation) && stillOutside(child)) return ++culler.stats_.unmoved, ~0u;
        if (how.plane_coherency) {
            const uint8_t plane = culler.last_plane_[child.place];
            if (plane < planes.count && active >> plane & 1 && outside(child, plane)) return ~0u;
        }
        if (how.octant && outsideByOctant(child)) return ~0u;
        for (uint32_t k = 0; k < planes.count; ++k)
            if (child.left >> k & 1)
                if (outside(child, k)) return ~0u;
        if (child.crossed && planes.refining_count && sideOf(node, slot) >= how.large)
            for (uint32_t k = 0; k < planes.refining_count; ++k) {
                const WalkPlane& p = planes.refining[k];
                if (sum(p, p.most, node, slot) + p.outer < 0.0f) return ++culler.stats_.refined, ~0u;
            }
        return child.crossed;
    }

    static float sideOf(const BvhNode& node, int slot) {
        return std::max({node.max[0][slot] - node.min[0][slot], node.max[1][slot] - node.min[1][slot],
                         node.max[2][slot] - node.min[2][slot]});
    }

    size_t walk() {
        size_t found = 0;
        const uint32_t all = (1u << planes.count) - 1;
        culler.stack_.clear();
        culler.stack_.push_back({0, all});
        while (!culler.stack_.empty()) {
            const HierarchyScratch::Visit visit = culler.stack_.back();
            culler.stack_.pop_back();
            const BvhNode& node = tree.nodes[visit.node];
            ++culler.stats_.nodes;
            for (int slot = 0; slot < 8; ++slot) {
                if (!node.count[slot]) continue;
                const uint32_t crossed = ask(visit.node, node, slot, visit.planes);
                if (crossed == ~0u) continue;
                const bool leaf = (node.child[slot] & BvhNode::kLeaf) != 0;
                if (leaf || (how.inside && crossed == 0))
                    for (uint32_t i = 0; i < node.count[slot]; ++i) {
                        kept[found] = tree.order[node.first[slot] + i];
                        found += kept[found] != PlacedBvh::kNone;
                    }
                else culler.stack_.push_back({node.child[slot], how.masking ? crossed : all});
            }
        }
        return found;
    }
};

HierarchyCulling everyCoherency() {
    HierarchyCulling how;
    how.eight_at_once = false;
    how.octant = how.plane_coherency = how.translation = how.rotation = true;
    return how;
}

HierarchyCuller::HierarchyCuller(Memory* memory) : stack_(memory), last_plane_(memory), memos_(memory) {}

void HierarchyCuller::forget() {
    motion_ = {};
    last_plane_.clear();
    memos_.clear();
}

void HierarchyCuller::follow(const ViewVolume& volume, size_t nodes) {
    const uint32_t count = std::min(volume.count, WalkPlanes::kMost);
    if (last_plane_.size() != nodes * 8 || !motion_.begun || motion_.last.count != volume.count) {
        last_plane_.assign(nodes * 8, kNever);
        memos_.assign(nodes * 8, Memo{});
        motion_ = {};
    } else {
        const glm::dvec3 travel = volume.eye - motion_.last.eye;
        motion_.travelled += glm::length(travel);
        for (uint32_t k = 0; k < count; ++k) {
            const glm::dvec4 &now = volume.planes[k], &then = motion_.last.planes[k];
            motion_.way[k] += now.w - then.w - glm::dot(glm::dvec3(now), travel);
            motion_.turned[k] += glm::length(glm::dvec3(now) - glm::dvec3(then));
        }
    }
    motion_.last = volume;
    motion_.begun = true;
}

size_t HierarchyCuller::cull(const RefinedVolume& refined, const PlacedBvh& tree, const HierarchyCulling& how,
                             std::span<uint32_t> kept) {
    SIGHTLINE_ASSERT(kept.size() >= size_t{tree.size()} + 8);
    stats_ = {};
    if (how.coherent() && !how.eight_at_once) {
        follow(refined.volume, tree.nodes.size());
        const bool follows_motion = how.translation || how.rotation;
        // Without them the planes change, and not what is known of them.
        if (follows_motion && !followed_motion_) std::fill(memos_.begin(), memos_.end(), Memo{});
        followed_motion_ = follows_motion;
    }
    if (tree.nodes.empty() || refined.volume.empty) return 0;
    const WalkPlanes planes = makePlanes(refined, tree, how);
    if (how.eight_at_once) return detail::walkEight({planes, how, stats_}, tree, stack_, kept);
    OneByOne walk{*this, planes, tree, how, kept.data()};
    const auto addPair = [&](uint8_t first, uint8_t second, uint8_t base) {
        if (std::max(first, second) < planes.count && walk.pair_count < 3 &&
            solvePair(refined.volume.planes, first, second, base < planes.count ? base : first,
                      walk.pairs[walk.pair_count]))
            ++walk.pair_count;
    };
    if (how.octant) {  // planes in a frustum's order; where they are not, no pair comes of it
        addPair(4, 5, 255);
        addPair(0, 1, 4);
        addPair(2, 3, 4);
    }
    return walk.walk();
}

}  // namespace sightline::studies
