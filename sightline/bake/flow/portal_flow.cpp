// The search: each portal is clipped by planes that separate the two before it, until no target is left.
// SPDX-License-Identifier: MIT
#include "sightline/bake/flow/portal_flow.h"

#include <algorithm>
#include <bit>

#define HWY_COMPILE_ALL_ATTAINABLE  // the scalar target is tested like the others
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "sightline/bake/flow/portal_flow.cpp"
#include <hwy/foreach_target.h>
#include <hwy/highway.h>

#include "sightline/bake/flow/window-inl.h"

#ifndef SIGHTLINE_BAKE_FLOW_PORTAL_FLOW_ONCE
#define SIGHTLINE_BAKE_FLOW_PORTAL_FLOW_ONCE
namespace sightline::bake {

/// Up to this many targets are clipped by all planes together. More are only tested against each plane by itself.
constexpr uint32_t kFewTargets = 4;

/// The costs of FlowLimits::work, in looks at a target.
constexpr uint64_t kClipWork = 64, kRayClipWork = 16;
constexpr uint64_t kAskedEvery = 1 << 16;

constexpr double kTowardsEdge = 0.9;  // a ray aims this far from a window's middle towards its outline
constexpr int kPasses = 3;

struct PortalFlow::State {
    uint32_t portal = 0;
    Window source, window;   ///< what clipping left of the first portal and of this one
    Separators onward;       ///< the planes that separate these two
    uint32_t next_word = 0;  ///< the word of the row whose portals are tried next
    uint64_t next = 0;       ///< its bits that were not tried yet
    /// The targets: portals that may follow every portal of the chain and lead into a cell that is asked for and not
    /// reached yet. Only the words of the row that are not zero are kept.
    uint32_t words = 0;
    std::vector<uint32_t> word;
    std::vector<uint64_t> targets;
};

struct PortalFlow::Scratch {
    Scratch(const FlowPlaces& flow_places, const WitnessRays& witness_rays, const BitMatrix& matrix)
        : places(flow_places), rays(witness_rays), may(matrix), asked(matrix.wordsPerRow()) {}

    State& at(uint32_t depth) {
        while (states.size() <= depth) {
            State& state = *states.emplace_back(std::make_unique<State>());
            state.word.resize(may.wordsPerRow());
            state.targets.resize(may.wordsPerRow());
        }
        return *states[depth];
    }
    bool isAsked(uint32_t portal) const { return asked[portal / 64] >> (portal % 64) & 1; }

    const FlowPlaces& places;
    const WitnessRays& rays;
    const BitMatrix& may;
    std::vector<std::unique_ptr<State>> states;
    StabbingChain chain;
    std::vector<glm::dvec3> corners;
    std::vector<uint32_t> run;         ///< the cells that the last ray passed
    std::vector<uint64_t> asked;       ///< portals into cells that are asked for and not yet reached
    const FlowBoxes* boxes = nullptr;  ///< what is looked for; null: cells
    std::vector<Box3d> left;           ///< per cell: around its boxes that were not found when the flow began
    FlowAnswer* answer = nullptr;
    FlowLimits limits;
    uint64_t ask_at = 0;  ///< the work at which it is asked whether to stop
};

}  // namespace sightline::bake
#endif

HWY_BEFORE_NAMESPACE();
namespace sightline::bake::HWY_NAMESPACE {

class Chase {
public:
    explicit Chase(PortalFlow::Scratch& scratch)
        : s_(scratch),
          directed_(scratch.places.directed),
          precision_{directed_.precision, directed_.rounding, 4 * directed_.extent} {}

    /// The whole search, from the first state. It keeps its own stack, for chains may be long.
    void run() {
        uint32_t depth = 0;
        open(depth);
        for (;;) {
            const uint32_t next = nextOf(depth);
            if (next == kNoPortal) {
                if (depth-- == 0) return;
            } else if (enter(depth, next)) {
                open(++depth);
            }
            if (s_.answer->spent) return;
        }
    }

private:
    using State = PortalFlow::State;

    /// The height above a portal that another one must reach to be passed after it. Two portals that face much the same
    /// way may touch in the first one's plane, where the cell between them is thin: there the limit is lower.
    double aboveOf(const FlowPortal& portal, const FlowPortal& other) const {
        return glm::dot(portal.normal, other.normal) > 0.5 ? lowest(portal) : portal.above;
    }
    double lowest(const FlowPortal& portal) const { return -std::max(portal.bend, precision_.points); }
    static glm::dvec4 planeOf(const FlowPortal& portal) { return glm::dvec4(portal.normal, portal.offset); }

    static constexpr uint32_t kNoPortal = ~0u;

    /// Starts on the portals that leave a state's cell.
    void open(uint32_t depth) {
        s_.at(depth + 1);
        State& now = *s_.states[depth];
        now.next_word = directed_.first_of_cell[directed_.portals[now.portal].to] / 64;
        now.next = mayFollow(depth, now.next_word);
    }

    /// The next of these portals; kNoPortal: there are no more.
    uint32_t nextOf(uint32_t depth) {
        State& now = *s_.states[depth];
        const uint32_t end = directed_.first_of_cell[directed_.portals[now.portal].to + 1];
        while (now.next == 0) {
            if (++now.next_word * 64 >= end) return kNoPortal;
            now.next = mayFollow(depth, now.next_word);
        }
        const uint32_t q = now.next_word * 64 + static_cast<uint32_t>(std::countr_zero(now.next));
        now.next &= now.next - 1;
        return q;
    }

    /// The portals of a word of the row that leave the cell and may follow every portal of the chain.
    uint64_t mayFollow(uint32_t depth, uint32_t w) const {
        s_.answer->work += depth + 1;
        const uint32_t cell = directed_.portals[s_.states[depth]->portal].to;
        const uint32_t first = directed_.first_of_cell[cell], end = directed_.first_of_cell[cell + 1];
        uint64_t may = ~uint64_t(0);
        if (w == first / 64) may &= ~uint64_t(0) << (first % 64);
        if (w == end / 64) may &= ~(~uint64_t(0) << (end % 64));
        if (w * 64 >= end) may = 0;
        for (uint32_t i = depth + 1; i-- > 0 && may;) may &= s_.may.row(s_.states[i]->portal)[w];
        return may;
    }

    /// Clips the next portal. @return whether targets are left beyond it
    bool enter(uint32_t depth, uint32_t next) {
        const State& now = *s_.states[depth];
        State& then = *s_.states[depth + 1];
        const std::span<const uint64_t> row = s_.may.row(next);
        const bool asked = s_.isAsked(next);
        uint32_t words = 0;
        for (uint32_t i = 0; i < now.words; ++i) {
            const uint32_t w = now.word[i];
            then.word[words] = w;
            then.targets[words] = now.targets[i] & row[w] & s_.asked[w];
            words += then.targets[words] != 0;
        }
        then.words = words;
        s_.answer->work += now.words;
        if (words == 0 && !asked) return false;
        if (isSpent()) {
            s_.answer->spent = true;
            return false;
        }
        ++s_.answer->steps;
        s_.answer->work += kClipWork;
        then.portal = next;
        if (!then.window.assign(directed_.outline(next), directed_.portals[next].straight)) {
            s_.answer->spent =
                true;  // more corners than a window has room for: all that is asked for counts as reached
            return false;
        }
        if (!clipBoth(now, then)) return false;
        if (s_.boxes) return enterForBoxes(then, asked);
        if (asked) {
            if (!mayPass(depth, then)) {
                ++s_.answer->empty_chains;
                return false;
            }
            reach(then);
            for (uint32_t i = 0; i < then.words; ++i) then.targets[i] &= s_.asked[then.word[i]];
        }
        if (words == 0) return false;
        separate(then.source, planeOf(directed_.portals[s_.states[0]->portal]), then.window,
                 planeOf(directed_.portals[next]), 1, precision_, then.onward);
        return keepTargets(then);
    }

    bool isSpent() {
        const FlowLimits& limits = s_.limits;
        const FlowAnswer& answer = *s_.answer;
        if ((limits.steps && answer.steps >= limits.steps) || (limits.work && answer.work >= limits.work)) return true;
        if (answer.work < s_.ask_at) return false;
        s_.ask_at = answer.work + kAskedEvery;
        return limits.stop && limits.stop->asks();
    }

    /// The rest of enter(), where the search is for boxes.
    bool enterForBoxes(State& then, bool asked) {
        separate(then.source, planeOf(directed_.portals[s_.states[0]->portal]), then.window,
                 planeOf(directed_.portals[then.portal]), 1, precision_, then.onward);
        if (asked) {
            const uint32_t cell = directed_.portals[then.portal].to;
            bool all = true;
            for (uint32_t i = s_.boxes->first[cell]; i < s_.boxes->first[cell + 1]; ++i) {
                const uint32_t box = s_.boxes->inside[i];
                uint8_t& found = s_.boxes->found[box];
                found = found || reachesAbove(s_.boxes->boxes[box], then.onward, directed_.portals[then.portal]);
                all = all && found;
            }
            if (all) settle(cell);
            for (uint32_t i = 0; i < then.words; ++i) then.targets[i] &= s_.asked[then.word[i]];
        }
        return then.words != 0 && keepTargets(then) && keepBoxes(then);
    }

    /// Clears the targets whose cells' boxes lie wholly below one of the planes.
    bool keepBoxes(State& state) const {
        uint32_t words = 0;
        for (uint32_t i = 0; i < state.words; ++i) {
            uint64_t word = state.targets[i];
            for (uint64_t bits = word; bits; bits &= bits - 1) {
                const uint32_t cell = directed_.portals[targetOf(state.word[i], bits)].to;
                if (!reachesAbove(s_.left[cell], state.onward, directed_.portals[state.portal]))
                    word &= ~(bits & -bits);
            }
            state.word[words] = state.word[i];
            state.targets[words] = word;
            words += word != 0;
        }
        state.words = words;
        return words != 0;
    }

    bool reachesAbove(const Box3d& box, const Separators& planes, const FlowPortal& portal) const {
        const glm::dvec3 center = box.center(), half = 0.5 * box.size();
        // Rounding of the center and the size is far below the precision.
        const auto isBelow = [&](const glm::dvec3& normal, double offset) {
            return glm::dot(normal, center) + glm::dot(glm::abs(normal), half) + offset < -2 * precision_.points;
        };
        if (isBelow(portal.normal, portal.offset)) return false;
        for (uint32_t i = 0; i < planes.count; ++i)
            if (isBelow({planes.x[i], planes.y[i], planes.z[i]}, planes.w[i])) return false;
        return true;
    }

    /// Ends the search for a cell: no portal into it is a target any more.
    void settle(uint32_t cell) {
        for (uint32_t i = s_.places.entering_first[cell]; i < s_.places.entering_first[cell + 1]; ++i) {
            const uint32_t p = s_.places.entering[i];
            s_.asked[p / 64] &= ~(uint64_t(1) << (p % 64));
        }
    }

    /// Clips the portal to what the window before it lets through, and the source to what lights the portal.
    bool clipBoth(const State& now, State& then) const {
        const FlowPortal &first = directed_.portals[s_.states[0]->portal], &last = directed_.portals[now.portal],
                         &portal = directed_.portals[then.portal];
        const double points = precision_.points;
        // A line leaves a portal upwards: it crosses the next portal above the first one's plane, not in it.
        if (clip(then.window, planeOf(first), lowest(first), aboveOf(first, portal)) == Clipped::kGone) return false;
        const bool far = now.portal != s_.states[0]->portal;
        if (far && clip(then.window, planeOf(last), lowest(last), aboveOf(last, portal)) == Clipped::kGone)
            return false;
        then.source.assign(now.source);
        if (clip(then.source, -planeOf(portal), lowest(portal), aboveOf(portal, first)) == Clipped::kGone) return false;
        if (!far) return true;
        // What only touches a plane stays: a line that grazes an edge still sees.
        if (clip(then.window, now.onward, -points, -points) == Clipped::kGone) return false;
        Separators backward;
        separate(then.window, -planeOf(portal), now.window, -planeOf(last), -1, precision_, backward);
        return clip(then.source, backward, -points, -points) != Clipped::kGone;
    }

    /// Clears the targets that lie wholly below one of the planes. Where few are left, it also clears those of which
    /// all planes together leave nothing.
    /// @return whether targets are left
    bool keepTargets(State& state) const {
        uint32_t left = 0, words = 0;
        for (uint32_t i = 0; i < state.words; ++i) {
            uint64_t word = state.targets[i];
            s_.answer->work += static_cast<uint64_t>(std::popcount(word));
            for (uint64_t bits = word; bits; bits &= bits - 1)
                if (isBelow(targetOf(state.word[i], bits), state.onward)) word &= ~(bits & -bits);
            state.word[words] = state.word[i];
            state.targets[words] = word;
            words += word != 0;
            left += static_cast<uint32_t>(std::popcount(word));
        }
        state.words = words;
        if (left == 0 || left > kFewTargets) return left != 0;
        for (uint32_t i = 0; i < words; ++i)
            for (uint64_t bits = state.targets[i]; bits; bits &= bits - 1) {
                Window part;
                if (!part.assign(directed_.outline(targetOf(state.word[i], bits)))) continue;
                if (clip(part, state.onward, -precision_.points, -precision_.points) != Clipped::kGone) continue;
                state.targets[i] &= ~(bits & -bits);
                --left;
            }
        return left != 0;
    }

    static uint32_t targetOf(uint32_t word, uint64_t bits) {
        return word * 64 + static_cast<uint32_t>(std::countr_zero(bits));
    }

    bool isBelow(uint32_t q, const Separators& planes) const {
        const Doubles d;
        const glm::dvec4& sphere = s_.places.spheres[q];
        const auto touching = hn::Set(d, -precision_.points);
        for (size_t i = 0; i < planes.count; i += hn::Lanes(d)) {
            const auto x = hn::LoadU(d, planes.x + i), y = hn::LoadU(d, planes.y + i), z = hn::LoadU(d, planes.z + i),
                       w = hn::LoadU(d, planes.w + i);
            const auto heightOf = [&](const glm::dvec3& p) {
                return hn::Add(hn::Add(hn::Add(hn::Mul(x, hn::Set(d, p.x)), hn::Mul(y, hn::Set(d, p.y))),
                                       hn::Mul(z, hn::Set(d, p.z))),
                               w);
            };
            const auto inside = hn::FirstN(d, planes.count - i);
            const auto height = heightOf(glm::dvec3(sphere));
            const auto radius = hn::Set(d, sphere.w);
            if (!hn::AllFalse(d, hn::And(inside, hn::Lt(hn::Add(height, radius), touching)))) return true;
            if (hn::AllFalse(d, hn::And(inside, hn::Lt(hn::Sub(height, radius), touching)))) continue;
            auto high = hn::Set(d, -1e300);
            for (const glm::dvec3& point : directed_.outline(q)) high = hn::Max(high, heightOf(point));
            if (!hn::AllFalse(d, hn::And(inside, hn::Lt(high, touching)))) return true;
        }
        return false;
    }

    void reach(const State& state) {
        FlowAnswer& answer = *s_.answer;
        const uint32_t cell = directed_.portals[state.portal].to;
        answer.reached[cell / 64] |= uint64_t(1) << (cell % 64);
        settle(cell);
    }

    /// Looks for a line that passes the whole chain with room to spare. If none is found at once, it looks for a proof
    /// that there is none.
    /// @return false if there is such a proof
    bool mayPass(uint32_t depth, const State& state) {
        const glm::dvec3 middle = state.source.center();
        if (shoot(middle, state.window.center(), state) || improve(depth, state, middle)) return true;
        if (isEmpty(depth, state)) return false;
        const uint32_t corners = state.source.count;
        for (uint32_t i = 0; i < corners; ++i) {
            const glm::dvec3 corner = state.source.corner(i), next = state.source.corner(i + 1 == corners ? 0 : i + 1);
            if (improve(depth, state, middle + kTowardsEdge * (corner - middle))) break;
            if (improve(depth, state, middle + kTowardsEdge * (0.5 * (corner + next) - middle))) break;
        }
        return true;
    }

    /// Whether it is proved that no line passes the whole chain. Asked last, where clipping left something and no ray
    /// was found.
    bool isEmpty(uint32_t depth, const State& state) {
        const FlowPortal& first = directed_.portals[s_.states[0]->portal];
        double rise = 1e300;
        for (uint32_t i = 0; i < state.window.count; ++i) rise = std::min(rise, first.height(state.window.corner(i)));
        rise -= first.bend;
        if (depth < 2 || !(rise > 0)) return false;  // for three windows clipping alone is exact
        const auto add = [&](const Window& window) {
            s_.corners.clear();
            for (uint32_t i = 0; i < window.count; ++i) s_.corners.push_back(window.corner(i));
            s_.chain.add(s_.corners);
        };
        s_.answer->work += kClipWork * depth;
        s_.chain.begin(first.normal, directed_.extent, precision_.points);
        add(state.source);
        for (uint32_t i = 1; i <= depth; ++i) s_.chain.add(directed_.outline(s_.states[i]->portal));
        add(state.window);
        return s_.chain.isProvedEmpty(rise, 4 * directed_.extent);
    }

    /// Improves a ray's two ends in turn: a point of the source sees a part of the window; the middle of this part sees
    /// a part of the source; and so on.
    bool improve(uint32_t depth, const State& state, glm::dvec3 u) {
        for (int pass = 0; pass < kPasses; ++pass) {
            Window there;
            there.assign(state.window);
            if (!narrow(depth, u, 1, there)) return false;
            const glm::dvec3 v = there.center();
            if (shoot(u, v, state)) return true;
            Window here;
            here.assign(state.source);
            if (!narrow(depth, v, -1, here)) return false;
            u = here.center();
            if (shoot(u, v, state)) return true;
        }
        return false;
    }

    /// The part of a window that a point sees through the portals between.
    bool narrow(uint32_t depth, const glm::dvec3& from, double sign, Window& window) const {
        s_.answer->work += kRayClipWork * depth;
        for (uint32_t i = 1; i <= depth; ++i) {
            const std::span<const glm::dvec3> outline = directed_.outline(s_.states[i]->portal);
            for (size_t k = 0; k < outline.size(); ++k) {
                const glm::dvec3 normal =
                    sign * glm::cross(outline[k] - from, outline[k + 1 == outline.size() ? 0 : k + 1] - from);
                if (clip(window, glm::dvec4(normal, -glm::dot(normal, from)), 0, 0) == Clipped::kGone) return false;
            }
        }
        return true;
    }

    /// Follows one ray, and notes the cells that it passes even if it does not arrive.
    bool shoot(const glm::dvec3& from, const glm::dvec3& to, const State& state) {
        s_.rays.through(state.portal, to, to - from, s_.run);
        if (s_.run.size() < 2) return false;
        FlowAnswer& answer = *s_.answer;
        answer.seen.insert(answer.seen.end(), s_.run.begin(), s_.run.end());
        answer.seen_first.push_back(static_cast<uint32_t>(answer.seen.size()));
        const uint32_t first = directed_.portals[s_.states[0]->portal].from, last = directed_.portals[state.portal].to;
        return std::find(s_.run.begin(), s_.run.end(), first) != s_.run.end() &&
               std::find(s_.run.begin(), s_.run.end(), last) != s_.run.end();
    }

    PortalFlow::Scratch& s_;
    const FlowPortals& directed_;
    const Precision precision_;
};

void chase(PortalFlow::Scratch& scratch) { Chase(scratch).run(); }

}  // namespace sightline::bake::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace sightline::bake {

HWY_EXPORT(chase);

FlowPlaces::FlowPlaces(const FlowPortals& all) : directed(all), entering_first(all.cells() + 1, 0) {
    for (const FlowPortal& portal : all.portals) {
        spheres.emplace_back(portal.center, portal.radius);
        ++entering_first[portal.to + 1];
    }
    for (uint32_t c = 0; c < all.cells(); ++c) entering_first[c + 1] += entering_first[c];
    std::vector<uint32_t> next(entering_first.begin(), entering_first.end() - 1);
    entering.resize(all.size());
    for (uint32_t p = 0; p < all.size(); ++p) entering[next[all.portals[p].to]++] = p;
}

PortalFlow::PortalFlow(const FlowPlaces& places, const WitnessRays& rays, const BitMatrix& may)
    : scratch_(std::make_unique<Scratch>(places, rays, may)) {}
PortalFlow::~PortalFlow() = default;

void PortalFlow::begin(uint32_t portal, const FlowLimits& limits, FlowAnswer& answer) {
    answer.reached.clear();
    answer.seen.clear();
    answer.seen_first.assign(1, 0);
    answer.steps = 0;
    answer.work = 0;
    answer.spent = false;
    answer.empty_chains = 0;
    scratch_->answer = &answer;
    scratch_->limits = limits;
    scratch_->ask_at = 0;
    scratch_->at(0).portal = portal;
}

/// @return false if there is nothing to look for
template <class IsAsked>
bool PortalFlow::chaseFrom(uint32_t portal, IsAsked&& is_asked) {
    Scratch& s = *scratch_;
    State& first = s.at(0);
    const FlowPortals& directed = s.places.directed;
    const std::span<const uint64_t> row = s.may.row(portal);
    first.words = 0;
    for (uint32_t w = 0; w < row.size(); ++w) {
        uint64_t targets = 0;
        for (uint64_t left = row[w]; left; left &= left - 1) {
            const auto q = w * 64 + static_cast<uint32_t>(std::countr_zero(left));
            if (is_asked(directed.portals[q].to)) targets |= left & -left;
        }
        s.asked[w] = first.targets[first.words] = targets;
        first.word[first.words] = w;
        first.words += targets != 0;
    }
    if (first.words == 0) return false;
    if (first.source.assign(directed.outline(portal), directed.portals[portal].straight)) {
        first.window.assign(first.source);
        first.onward.count = 0;
        HWY_DYNAMIC_DISPATCH(chase)(s);
    } else {
        s.answer->spent = true;
    }
    return true;
}

void PortalFlow::from(uint32_t portal, std::span<const uint64_t> asked, const FlowLimits& limits, FlowAnswer& answer) {
    begin(portal, limits, answer);
    answer.reached.assign(asked.size(), 0);
    scratch_->boxes = nullptr;
    chaseFrom(portal, [&](uint32_t cell) { return asked[cell / 64] >> (cell % 64) & 1; });
    if (!answer.spent) return;
    const FlowPortals& directed = scratch_->places.directed;
    const std::span<const uint64_t> row = scratch_->may.row(portal);
    const auto reach = [&](uint32_t cell) {
        answer.reached[cell / 64] |= asked[cell / 64] & uint64_t(1) << (cell % 64);
    };
    reach(directed.portals[portal].to);
    for (uint32_t w = 0; w < row.size(); ++w)
        for (uint64_t left = row[w]; left; left &= left - 1)
            reach(directed.portals[w * 64 + static_cast<uint32_t>(std::countr_zero(left))].to);
}

void PortalFlow::find(uint32_t portal, const FlowBoxes& boxes, const FlowLimits& limits, FlowAnswer& answer) {
    begin(portal, limits, answer);
    scratch_->boxes = &boxes;
    const auto forBoxesOf = [&](uint32_t cell, auto&& visit) {
        for (uint32_t i = boxes.first[cell]; i < boxes.first[cell + 1]; ++i) visit(boxes.inside[i]);
    };
    // Through the portal all of the cell behind it may be seen.
    const FlowPortals& directed = scratch_->places.directed;
    forBoxesOf(directed.portals[portal].to, [&](uint32_t box) { boxes.found[box] = 1; });
    scratch_->left.assign(directed.cells(), Box3d());
    for (uint32_t cell = 0; cell < directed.cells(); ++cell)
        forBoxesOf(cell, [&](uint32_t box) {
            if (!boxes.found[box]) scratch_->left[cell].grow(boxes.boxes[box]);
        });
    chaseFrom(portal, [&](uint32_t cell) { return !scratch_->left[cell].empty(); });
    if (!answer.spent) return;
    const std::span<const uint64_t> row = scratch_->may.row(portal);
    for (uint32_t q = 0; q < directed.size(); ++q)
        if (row[q / 64] >> (q % 64) & 1)
            forBoxesOf(directed.portals[q].to, [&](uint32_t box) { boxes.found[box] = 1; });
}

}  // namespace sightline::bake
#endif  // HWY_ONCE
