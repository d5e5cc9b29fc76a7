// Dijkstra's search from hole to hole; the way that it finds is then pulled tight.
// SPDX-License-Identifier: MIT
#include "sightline/query/connectivity.h"

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/cells/passages.h"
#include "sightline/math/finite.h"
#include "sightline/world/world_state.h"

namespace sightline {
namespace {

constexpr uint32_t kNone = ~0u;

double lengthOf(std::span<const glm::dvec3> points) {
    double length = 0;
    for (size_t i = 1; i < points.size(); ++i) length += glm::length(points[i] - points[i - 1]);
    return length;
}

/// How a passage, or the place asked for, is reached.
struct Reached {
    glm::dvec3 point{0.0};     // the nearest of it to the bend
    glm::dvec3 bend{0.0};      // from where the way is straight
    double distance = 0;       // to the point
    double bend_distance = 0;  // to the bend
    uint32_t before = kNone;   // the passage before; kNone: it begins here
    uint32_t straight = 1;     // passages since the bend, this one too
};

}  // namespace

struct ConnectivityQuery::Impl {
    /// What a search knows of a passage.
    struct Found : Reached {
        uint32_t into = 0;     // the cell that it leads into
        uint32_t search = 0;   // that found it
        bool settled = false;  // nothing shorter comes
    };
    using Waiting = std::pair<double, uint32_t>;  // how far it is, negative; the first number wins

    Memory* const memory;
    std::shared_ptr<const detail::AttachedCells> cells;
    std::shared_ptr<const Array<DoorState>> doors;
    std::optional<Passages> passages;
    Array<Found> found;  // per passage
    Array<Waiting> queue;
    Array<uint32_t> starts, ends, chain, crossed;
    Array<glm::dvec3> points;
    glm::dvec3 place{0.0};
    WaySettings settings;
    uint32_t search = 0;
    bool known = false;

    explicit Impl(Memory* from)
        : memory(from), found(from), queue(from), starts(from), ends(from), chain(from), crossed(from), points(from) {}

    bool isOpen(uint32_t passage) const {
        const Passage& at = (*passages)[passage];
        SIGHTLINE_DEBUG_ASSERT(at.door == CellPortal::kNone || !doors || at.door < doors->size());
        if (at.width < settings.narrowest) return false;
        return at.door == CellPortal::kNone || !doors || (*doors)[at.door].open > 0;
    }
    bool passAll(const glm::dvec3& from, const glm::dvec3& to, uint32_t last, uint32_t count) const;
    template <class Nearest>
    Reached after(uint32_t passage, const Nearest& nearest, double enough) const;
    void arrive(uint32_t passage, uint32_t into, const Reached& reached);
    uint32_t settleNext();
    void layWay(const glm::dvec3& to, const Reached& last);
    void pull();
    void keepBends();
};

ConnectivityQuery::ConnectivityQuery(Memory* memory) : impl_(makeOwned<Impl>(memory, memory)) {}
ConnectivityQuery::~ConnectivityQuery() = default;
ConnectivityQuery::ConnectivityQuery(ConnectivityQuery&&) noexcept = default;
ConnectivityQuery& ConnectivityQuery::operator=(ConnectivityQuery&&) noexcept = default;

/// Whether a segment comes through so many passages, of which one is the last.
bool ConnectivityQuery::Impl::passAll(const glm::dvec3& from, const glm::dvec3& to, uint32_t last,
                                      uint32_t count) const {
    glm::dvec3 at;
    for (; count > 0; --count, last = found[last].before) {
        SIGHTLINE_DEBUG_ASSERT(last < found.size());
        if (!passages->passes(last, from, to, at)) return false;
    }
    return true;
}

/// The way on from a passage to what is next.
/// @param nearest  gives its nearest point to another point
/// @param enough   a way that is as long is not wanted: then one of any length that is not shorter
template <class Nearest>
Reached ConnectivityQuery::Impl::after(uint32_t passage, const Nearest& nearest, double enough) const {
    constexpr uint32_t kMostStraight = 16;  // passages that are looked at again
    SIGHTLINE_DEBUG_ASSERT(passage < found.size() && found[passage].search == search && found[passage].straight > 0);
    const Found& at = found[passage];
    Reached out;
    out.before = passage;
    out.point = nearest(at.bend);
    out.distance = at.bend_distance + glm::length(out.point - at.bend);
    if (out.distance >= enough) return out;
    if (at.straight < kMostStraight && passAll(at.bend, out.point, passage, at.straight)) {
        out.bend = at.bend;
        out.bend_distance = at.bend_distance;
        out.straight = at.straight + 1;
    } else {
        // It bends in this passage: where the way round is short, if it is straight up to there.
        out.bend = at.point;
        out.point = nearest(out.bend);
        const glm::dvec3 shorter = passages->between(passage, at.bend, out.point);
        if (passAll(at.bend, shorter, at.before, at.straight - 1)) {
            out.bend = shorter;
            out.point = nearest(out.bend);
        }
        out.bend_distance = at.bend_distance + glm::length(out.bend - at.bend);
        out.distance = out.bend_distance + glm::length(out.point - out.bend);
    }
    return out;
}

void ConnectivityQuery::Impl::arrive(uint32_t passage, uint32_t into, const Reached& reached) {
    SIGHTLINE_DEBUG_ASSERT(passage < found.size() && found.size() == passages->size());
    Found& at = found[passage];
    if (at.search == search && (at.settled || at.distance <= reached.distance)) return;
    if (!(reached.distance <= settings.farthest)) return;
    static_cast<Reached&>(at) = reached;
    at.into = into;
    at.search = search;
    at.settled = false;
    queue.push_back({-reached.distance, ~passage});
    std::push_heap(queue.begin(), queue.end());
}

/// Takes the nearest passage that waits, and goes on from it; kNone: it had been taken before.
uint32_t ConnectivityQuery::Impl::settleNext() {
    SIGHTLINE_DEBUG_ASSERT(!queue.empty());
    const auto [negative, inverse] = queue.front();
    std::pop_heap(queue.begin(), queue.end());
    queue.pop_back();
    const uint32_t passage = ~inverse;
    if (found[passage].settled || found[passage].distance != -negative) return kNone;
    found[passage].settled = true;
    const uint32_t cell = found[passage].into;
    for (const uint32_t next : passages->of(cell)) {
        const bool is_found = found[next].search == search;
        if (next == passage || (is_found && found[next].settled) || !isOpen(next)) continue;
        const auto nearest = [&](const glm::dvec3& from) { return passages->nearestTo(next, from); };
        arrive(next, (*passages)[next].beyond(cell),
               after(passage, nearest, is_found ? found[next].distance : INFINITY));
    }
    return passage;
}

bool ConnectivityQuery::begin(const Snapshot& now, const glm::dvec3& place, const WaySettings& settings) {
    Impl& impl = *impl_;
    impl.known = false;
    impl.queue.clear();
    if (!now) return false;
    const detail::CellState& state = now.state().cell_state;
    const bool others = impl.cells != state.cells;
    impl.cells = state.cells;  // or none: what is kept of another world goes, whose memory may
    impl.doors = state.doors;
    if (others) impl.passages.reset();
    if (!state.cells || !state.walls_stand || !isFinite(place)) return false;
    if (!impl.passages) {
        impl.passages.emplace(state.cells->graph, impl.memory);
        impl.found.assign(impl.passages->size(), {});
        impl.search = 0;
    }
    impl.settings = settings;
    impl.place = place;
    if (!state.cells->graph.cellsAround({&place, 1}, 0, impl.starts)) return false;
    impl.known = true;
    if (++impl.search == 0) {
        impl.found.assign(impl.found.size(), {});
        impl.search = 1;
    }
    for (const uint32_t cell : impl.starts)
        for (const uint32_t passage : impl.passages->of(cell)) {
            const uint32_t beyond = (*impl.passages)[passage].beyond(cell);
            if (!impl.isOpen(passage) || std::binary_search(impl.starts.begin(), impl.starts.end(), beyond)) continue;
            Reached reached;
            reached.bend = place;
            reached.point = impl.passages->nearestTo(passage, place);
            reached.distance = glm::length(reached.point - place);
            impl.arrive(passage, beyond, reached);
        }
    return true;
}

Way ConnectivityQuery::to(const glm::dvec3& place) {
    Impl& impl = *impl_;
    impl.points.clear();
    impl.crossed.clear();
    Way way;
    if (!impl.known || !isFinite(place) || !impl.cells->graph.cellsAround({&place, 1}, 0, impl.ends)) return way;
    way.known = true;
    const auto isEnd = [&](uint32_t cell) { return std::binary_search(impl.ends.begin(), impl.ends.end(), cell); };
    Reached best;
    best.bend = impl.place;
    best.distance = INFINITY;
    const auto shared = std::find_if(impl.starts.begin(), impl.starts.end(), isEnd);
    const auto offer = [&](uint32_t passage) {
        const Reached reached = impl.after(
            passage, [&](const glm::dvec3&) { return place; }, best.distance);
        if (reached.distance < best.distance) best = reached;
    };
    if (shared != impl.starts.end()) {
        best.distance = glm::length(place - impl.place);
        impl.crossed.push_back(*shared);
    } else {
        for (const uint32_t cell : impl.ends)
            for (const uint32_t passage : impl.passages->of(cell)) {
                const Impl::Found& at = impl.found[passage];
                if (at.search == impl.search && at.settled && at.into == cell) offer(passage);
            }
        while (!impl.queue.empty() && -impl.queue.front().first < best.distance) {
            const uint32_t passage = impl.settleNext();
            if (passage != kNone && isEnd(impl.found[passage].into)) offer(passage);
        }
    }
    way.connected = best.distance < INFINITY && best.distance <= impl.settings.farthest;
    if (!way.connected) return way;
    impl.layWay(place, best);
    impl.keepBends();
    way.distance = lengthOf(impl.points);
    for (const uint32_t passage : impl.chain) way.narrowest = std::min(way.narrowest, (*impl.passages)[passage].width);
    way.points = impl.points;
    way.cells = impl.crossed;
    return way;
}

/// Writes the passages of a way, its cells, and a point of each passage.
void ConnectivityQuery::Impl::layWay(const glm::dvec3& to, const Reached& last) {
    chain.clear();
    for (uint32_t passage = last.before; passage != kNone; passage = found[passage].before) chain.push_back(passage);
    std::reverse(chain.begin(), chain.end());
    if (!chain.empty()) crossed.push_back((*passages)[chain[0]].beyond(found[chain[0]].into));
    for (const uint32_t passage : chain) crossed.push_back(found[passage].into);
    points.assign(chain.size() + 2, place);
    points.back() = to;
    // From bend to bend, the last one first.
    Reached part = last;
    for (size_t end = points.size() - 1; end > 0;) {
        const size_t begin = end - std::min<size_t>(end, part.straight);
        if (begin > 0) points[begin] = part.bend;
        for (size_t i = begin + 1; i < end; ++i) {
            glm::dvec3 at;
            const bool passes = passages->passes(chain[i - 1], points[begin], points[end], at);
            points[i] = passes ? at : passages->between(chain[i - 1], points[begin], points[end]);
        }
        if (begin > 0) part = found[chain[begin - 1]];
        end = begin;
    }
    pull();
}

/// Moves each point to where the way is the shortest between its neighbours, until all rest.
void ConnectivityQuery::Impl::pull() {
    constexpr int kMostSweeps = 64;
    SIGHTLINE_DEBUG_ASSERT(points.size() == chain.size() + 2);
    const double enough = 1e-9 * lengthOf(points);
    for (int sweep = 0; sweep < kMostSweeps; ++sweep) {
        double moved = 0;
        for (size_t k = 0; k < chain.size(); ++k) {
            const size_t i = sweep % 2 ? chain.size() - k : k + 1;
            const glm::dvec3 at = passages->between(chain[i - 1], points[i - 1], points[i + 1]);
            moved = std::max(moved, glm::length(at - points[i]));
            points[i] = at;
        }
        if (moved <= enough) break;
    }
}

/// Leaves the ends and the bends of a way.
void ConnectivityQuery::Impl::keepBends() {
    SIGHTLINE_DEBUG_ASSERT(points.size() >= 2);
    const double straight = 1e-6 * lengthOf(points);
    size_t kept = 1;
    for (size_t i = 1; i + 1 < points.size(); ++i) {
        const glm::dvec3 way = points[i + 1] - points[kept - 1], to = points[i] - points[kept - 1];
        const double squared = glm::dot(way, way);
        const double at = squared > 0 ? std::clamp(glm::dot(to, way) / squared, 0.0, 1.0) : 0;
        if (glm::length(to - at * way) > straight) points[kept++] = points[i];
    }
    points[kept++] = points.back();
    points.resize(kept);
}

}  // namespace sightline
