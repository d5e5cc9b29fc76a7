// A way over a floor: shortest paths to the farthest places, drawn straight where one can go straight.
// SPDX-License-Identifier: MIT
//
// Edsger W. Dijkstra. A Note on Two Problems in Connexion with Graphs. 1959.
#include "sightline/tools/load/floor_way.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>
#include <utility>

namespace sightline::tools {
namespace {

constexpr double kToKnee = 1.2;      // below the eye  [metres]
constexpr double kBeen = 1.5;        // this near to the way one has been  [metres], more where the view is wide
constexpr double kAlongWall = 4;     // a step along a wall costs so many more in the open
constexpr double kLeastView = 0.35;  // of the widest: where a leg may end
constexpr size_t kLongestLeg = 24;   // places that one leg passes

class WayFinder {
public:
    WayFinder(const WalkFloor& floor, const RayProbe& probe) : floor_(floor), probe_(probe) {
        for (const WalkFloor::Place& place : floor.places) view_ = std::max(view_, place.view);
        open_ = std::max(0.9 * floor.unit, 2 * floor.spacing);
    }

    std::vector<glm::dvec3> find(double length) {
        std::vector<uint32_t> route = {0};
        std::vector<bool> been(floor_.places.size());
        double done = 0;
        do {
            const std::vector<uint32_t> leg = legFrom(route.back(), been);
            if (leg.empty()) break;
            for (const uint32_t place : leg) {
                done += apart(route.back(), place);
                route.push_back(place);
                markAround(place, been);
            }
        } while (done < length);
        return straightened(route);
    }

private:
    double apart(uint32_t a, uint32_t b) const { return glm::length(floor_.eye(a) - floor_.eye(b)); }

    /// What a step costs: its length, and more of it where there is little room.
    double cost(uint32_t a, uint32_t b) const {
        const double room = std::min({1.0, floor_.places[a].room / open_, floor_.places[b].room / open_});
        return apart(a, b) * (1 + kAlongWall * (1 - room) * (1 - room));
    }

    /// Places within reach of one, by steps of the floor.
    void markAround(uint32_t place, std::vector<bool>& been) const {
        const double reach = std::max(kBeen * floor_.unit, 3 * floor_.spacing);
        std::vector<uint32_t> queue = {place};
        std::vector<uint32_t> seen = {place};
        for (size_t i = 0; i < queue.size(); ++i) {
            been[queue[i]] = true;
            for (const uint32_t next : floor_.places[queue[i]].next) {
                if (apart(place, next) > reach || std::find(seen.begin(), seen.end(), next) != seen.end()) continue;
                seen.push_back(next);
                queue.push_back(next);
            }
        }
    }

    /// The cheapest way to the place that is farthest away, rather one with a view, of those where one has not been,
    /// without its start; empty if there is none.
    std::vector<uint32_t> legFrom(uint32_t start, const std::vector<bool>& been) const {
        constexpr uint32_t kNobody = ~0u;
        std::vector<double> costs(floor_.places.size(), std::numeric_limits<double>::infinity());
        std::vector<uint32_t> before(floor_.places.size(), kNobody);
        std::priority_queue<std::pair<double, uint32_t>, std::vector<std::pair<double, uint32_t>>, std::greater<>> open;
        costs[start] = 0;
        open.emplace(0, start);
        uint32_t goal = kNobody;
        double most = 0;
        while (!open.empty()) {
            const auto [so_far, here] = open.top();
            open.pop();
            if (so_far > costs[here]) continue;
            const double view = floor_.places[here].view / view_, worth = so_far * view * view;
            if (!been[here] && view > kLeastView && worth > most) {
                most = worth;
                goal = here;
            }
            for (const uint32_t next : floor_.places[here].next) {
                const double reached = so_far + cost(here, next);
                if (reached >= costs[next]) continue;
                costs[next] = reached;
                before[next] = here;
                open.emplace(reached, next);
            }
        }
        std::vector<uint32_t> leg;
        if (goal == kNobody) return leg;
        for (uint32_t place = goal; place != start; place = before[place]) leg.push_back(place);
        std::reverse(leg.begin(), leg.end());
        return leg;
    }

    bool blocked(const glm::dvec3& from, const glm::dvec3& to) const {
        const auto hit = probe_.nearest({from, to - from});
        return hit && hit->t < 1;
    }

    /// Whether one can go from the eye of one place to that of another: nothing is in the way of eye, shoulders and
    /// knees, and the floor goes on below.
    bool straight(const std::vector<uint32_t>& route, size_t a, size_t b) const {
        const glm::dvec3 from = floor_.eye(route[a]), to = floor_.eye(route[b]), along = to - from;
        double room = 0.5 * floor_.unit;
        for (size_t i = a; i <= b; ++i) room = std::min(room, floor_.places[route[i]].room);
        const glm::dvec3 flat(along.x, 0, along.z), down(0, -kToKnee * floor_.unit, 0);
        const double length = glm::length(flat);
        if (!(length > 0)) return false;
        const glm::dvec3 aside = glm::dvec3(-flat.z, 0, flat.x) * (0.9 * room / length);
        for (const glm::dvec3& shift : {glm::dvec3(0), aside, -aside, down})
            if (blocked(from + shift, to + shift)) return false;
        const auto steps = static_cast<int>(std::ceil(length / floor_.spacing));
        const double eye = floor_.eye(0).y - floor_.places[0].foot.y;
        for (int i = 1; i < steps; ++i) {
            const glm::dvec3 at = from + along * (static_cast<double>(i) / steps);
            const auto hit = probe_.nearest({at, {0, -1, 0}});
            const bool on_ground = floor_.ground && std::abs(at.y - eye - *floor_.ground) <= floor_.climb;
            if (hit && hit->t < eye + floor_.climb ? hit->t < eye - floor_.climb : !on_ground) return false;
        }
        return true;
    }

    /// The route's eyes, without those that straight legs can pass by.
    std::vector<glm::dvec3> straightened(const std::vector<uint32_t>& route) const {
        std::vector<glm::dvec3> way;
        if (route.size() < 2) return way;
        way.push_back(floor_.eye(route[0]));
        for (size_t at = 0; at + 1 < route.size();) {
            size_t next = std::min(at + kLongestLeg, route.size() - 1);
            while (next > at + 1 && !straight(route, at, next)) --next;
            way.push_back(floor_.eye(route[next]));
            at = next;
        }
        return way;
    }

    const WalkFloor& floor_;
    const RayProbe& probe_;
    double view_ = 1e-9;  ///< the widest of any place  [world units]
    double open_ = 0;     ///< with so much room one is in the open  [world units]
};

}  // namespace

std::vector<glm::dvec3> wayOver(const WalkFloor& floor, const RayProbe& probe, double length) {
    if (floor.places.size() < 2) return {};
    return WayFinder(floor, probe).find(length);
}

}  // namespace sightline::tools
