// Walks: a way over a floor or through free space, rounded corners, and glances to where one sees far.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/walk.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/load/floor_way.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
namespace {

constexpr uint32_t kGoals = 64;        // seeded cameras
constexpr int kDirections = 32;        // tried where no goal can be reached
constexpr double kLongestWalkLeg = 4;  // of these  [s]
constexpr int kRoundings = 8;          // pieces of a corner
constexpr double kHalfTurn = 3.14159265358979323846;
constexpr double kTurn = kHalfTurn / 3;  // [radians / s]
constexpr double kGlance = 2;            // between two glances  [s]
constexpr double kGlanceWay = 1.5;       // or so far  [metres]
// Glances of which one is taken, 0.35 radians apart, as tangents of half their angles: no cosine of the standard
// library, which differ between machines.
constexpr double kGlances[] = {0, 0.17683, 0.36503, 0.57927, 0.84229, 1.19742, 1.74332, 2.77792};
constexpr double kAhead = 2;  // so far ahead on the way one looks  [metres]

glm::dvec3 anyRight(const glm::dvec3& direction) {
    const glm::dvec3 flat(-direction.z, 0, direction.x);
    const double length = glm::length(flat);
    return length > 1e-6 ? flat / length : glm::dvec3(1, 0, 0);
}

/// Turns a direction towards another one, by at most an angle of which `tangent` is no more than half; aside rather than
/// over head or feet.
glm::dvec3 turned(const glm::dvec3& from, const glm::dvec3& wanted, double tangent) {
    if (2 * tangent >= kHalfTurn) return wanted;
    glm::dvec3 to = wanted;
    const glm::dvec3 right = anyRight(from), ahead = glm::cross(glm::dvec3(0, 1, 0), right);
    if (glm::dot(wanted, ahead) < 0) {
        const double flat = std::sqrt(std::max(0.0, 1 - wanted.y * wanted.y));
        to = (glm::dot(wanted, right) < 0 ? -flat : flat) * right + glm::dvec3(0, wanted.y, 0);
    }
    const double scale = 1 / (1 + tangent * tangent);
    const double cosine = (1 - tangent * tangent) * scale, sine = 2 * tangent * scale;
    if (glm::dot(from, to) >= cosine) return to;
    const glm::dvec3 across = to - glm::dot(from, to) * from;
    if (!(glm::length(across) > 1e-9)) return from;
    return glm::normalize(cosine * from + sine * glm::normalize(across));
}

/// @param half_tangent  of the angle
double cosineOf(double half_tangent) { return (1 - half_tangent * half_tangent) / (1 + half_tangent * half_tangent); }

glm::dvec3 turnedAside(const glm::dvec3& direction, double half_tangent) {
    const double c = cosineOf(half_tangent), s = 2 * half_tangent / (1 + half_tangent * half_tangent);
    return {c * direction.x - s * direction.z, direction.y, s * direction.x + c * direction.z};
}

class Walker {
public:
    Walker(const Scene& scene, const RayProbe& probe, const WalkFloor& floor, const WalkSettings& settings)
        : scene_(scene),
          probe_(probe),
          floor_(floor),
          settings_(settings),
          random_(mixSeed(settings.seed, 0x77616c6b)) {
        diagonal_ = coreOf(scene).diagonal();
        margin_ = diagonal_ > 0 ? std::min(0.25, 0.01 * diagonal_) : 0;
    }

    CameraPath path() {
        const double needed = 1.2 * settings_.speed * settings_.frames / settings_.fps;  // rounded corners are shorter
        if (floor_.places.size() > 1) walkFar(needed);
        else flyFar(needed);
        roundCorners();
        return alongWay();
    }

private:
    /// How far one can go from a point in a direction of unit length, no farther than `far`.
    double freeWay(const glm::dvec3& from, const glm::dvec3& direction, double far, double margin) const {
        const glm::dvec3 right = anyRight(direction), up = glm::cross(right, direction);
        double free = far;
        for (const glm::dvec3& aside : {glm::dvec3(0), right, -right, up, -up})
            if (const auto hit = probe_.nearest({from + margin * aside, direction}))
                free = std::min(free, hit->t - margin);
        return free;
    }

    /// Over the floor; to and fro where it is small.
    void walkFar(double needed) {
        way_ = wayOver(floor_, probe_, needed);
        if (way_.size() < 2) way_ = {floor_.eye(0), floor_.eye(floor_.places[0].next[0])};
        first_.eye = way_[0];
        first_.target = way_[0] + glm::normalize(way_[1] - way_[0]);
        if (diagonal_ > 0) first_.z_near = std::min(0.0005 * diagonal_, 0.1);
        double length = 0;
        for (size_t i = 1; i < way_.size(); ++i) length += glm::length(way_[i] - way_[i - 1]);
        const std::vector<glm::dvec3> once = way_;
        for (double left = needed - length; length > 0 && left > 0; left -= length)
            if (way_.back() == once.back()) way_.insert(way_.end(), once.rbegin() + 1, once.rend());
            else way_.insert(way_.end(), once.begin() + 1, once.end());
    }

    /// Through free space.
    void flyFar(double needed) {
        starts_ = seededCameras(scene_, kGoals, settings_.seed).frames;
        first_ = starts_[0];
        way_ = {first_.eye};
        std::vector<bool> was_at(starts_.size());
        was_at[0] = true;
        for (double left = needed; left > 0;) {
            const glm::dvec3 here = way_.back();
            glm::dvec3 next = here;
            if (!findGoal(here, was_at, left, next)) next = anyPlace(here);
            const double length = glm::length(next - here);
            if (!(length > 0)) break;
            way_.push_back(next);
            left -= length;
        }
    }

    /// The nearest seeded camera where the way has not been yet, in a straight line.
    bool findGoal(const glm::dvec3& here, std::vector<bool>& was_at, double far, glm::dvec3& next) const {
        std::vector<std::pair<double, uint32_t>> goals;
        for (uint32_t i = 0; i < starts_.size(); ++i) {
            const double away = glm::length(starts_[i].eye - here);
            if (!was_at[i] && away > margin_) goals.emplace_back(away, i);
        }
        std::sort(goals.begin(), goals.end());
        for (const auto& [away, goal] : goals) {
            const glm::dvec3 direction = (starts_[goal].eye - here) / away;
            const double needed = std::min(away, far);
            if (freeWay(here, direction, needed, margin_) < needed) continue;
            was_at[goal] = true;
            next = needed < away ? here + needed * direction : starts_[goal].eye;
            return true;
        }
        return false;
    }

    /// A place with room; where it is narrow, with less of a margin; the place itself if there is none.
    glm::dvec3 anyPlace(const glm::dvec3& here) {
        glm::dvec3 next = here;
        for (double margin = margin_; next == here && margin > margin_ / 32; margin /= 2)
            next = openPlace(here, margin);
        return next;
    }

    /// Where there is most room, rather ahead than back; the place itself if there is none.
    glm::dvec3 openPlace(const glm::dvec3& here, double margin) {
        const glm::dvec3 ahead =
            way_.size() > 1 ? glm::normalize(here - way_[way_.size() - 2]) : first_.target - first_.eye;
        const double far = kLongestWalkLeg * settings_.speed;
        double most = 0;
        glm::dvec3 best = here;
        for (int i = 0; i < kDirections; ++i) {
            const double z = random_.uniform(-1, 1), y = random_.uniform(-0.2, 0.2), x = random_.uniform(-1, 1);
            const glm::dvec3 drawn(x, y, z);
            const double length = glm::length(drawn);
            if (!(length > 0.1 && length <= 1)) continue;
            const glm::dvec3 direction = drawn / length;
            const double free = 0.9 * freeWay(here, direction, far, margin);
            const double worth = free * (1.5 + glm::dot(direction, ahead) / glm::length(ahead));
            if (!(free > margin) || !(worth > most)) continue;
            most = worth;
            best = here + free * direction;
        }
        return best;
    }

    bool isFree(const glm::dvec3& a, const glm::dvec3& b) const {
        const auto hit = probe_.nearest({a, b - a});
        return !hit || hit->t > 1;
    }

    /// Corners become arcs of parabolas where these are free.
    void roundCorners() {
        std::vector<glm::dvec3> round = {way_[0]};
        for (size_t i = 1; i + 1 < way_.size(); ++i) {
            const glm::dvec3 corner = way_[i];
            const double before = glm::length(corner - way_[i - 1]), after = glm::length(way_[i + 1] - corner);
            const double reach = std::min({0.4 * before, 0.4 * after, settings_.speed});
            const glm::dvec3 a = corner + (way_[i - 1] - corner) * (reach / before),
                             b = corner + (way_[i + 1] - corner) * (reach / after);
            std::vector<glm::dvec3> arc;
            bool free = true;
            for (int k = 0; k <= kRoundings; ++k) {
                const double t = static_cast<double>(k) / kRoundings;
                arc.push_back((1 - t) * (1 - t) * a + 2 * t * (1 - t) * corner + t * t * b);
                free = free && (k == 0 || isFree(arc[k - 1], arc[k]));
            }
            if (free) round.insert(round.end(), arc.begin(), arc.end());
            else round.push_back(corner);
        }
        if (way_.size() > 1) round.push_back(way_.back());
        way_ = std::move(round);
    }

    /// Frames at even distances along the way.
    CameraPath alongWay() {
        CameraPath out;
        const double step = settings_.speed / settings_.fps, tangent = 0.5 * kTurn / settings_.fps;
        // A glance takes some hundreds of rays: where frames are close together, it lasts for several.
        const double unit = floor_.places.empty() ? 1 : floor_.unit;
        const auto glance = static_cast<uint32_t>(
            std::max({1.0, kGlance * settings_.fps, step > 0 ? std::min(kGlanceWay * unit / step, 1e6) : 1.0}));
        CameraFrame frame = first_;
        glm::dvec3 look = glm::normalize(frame.target - frame.eye), forward = look;
        const double distance = glm::length(frame.target - frame.eye);
        double aside = 0, up = 0;
        Place place;
        for (uint32_t i = 0; i < settings_.frames; ++i) {
            if (i > 0) goOn(place, step);
            frame.eye = at(place);
            forward = aheadOf(place, forward);
            if (i % glance == 0) {
                aside = farGlance(frame.eye, forward);
                up = random_.uniform(-0.15, 0.03);
            }
            glm::dvec3 wanted = turnedAside(forward, aside);
            wanted.y = 0.3 * wanted.y + up;
            wanted = glm::normalize(wanted);
            look = i > 0 || floor_.places.empty() ? turned(look, wanted, tangent) : wanted;
            frame.target = frame.eye + look * distance;
            out.frames.push_back(frame);
        }
        return out;
    }

    /// A number of an object's side that was hit: other sides of it have others.
    uint64_t sideOf(const ProbeHit& hit) const {
        const glm::dvec3 normal = probe_.normal(hit);
        uint64_t side = uint64_t{hit.object} + 1;
        for (int axis = 0; axis < 3; ++axis)
            side = side << 4 | static_cast<uint64_t>(std::lround(4 * normal[axis]) + 4);
        return side;
    }

    /// A glance to where one sees farther and more than elsewhere, rather ahead than aside: its half tangent.
    double farGlance(const glm::dvec3& eye, const glm::dvec3& forward) {
        double most = 0, best = 0;
        for (const double angle : kGlances)
            for (const double side : {angle, -angle}) {
                const glm::dvec3 direction = turnedAside(forward, side);
                const double worth = worthOf(eye, direction) * (2.5 + cosineOf(side)) * random_.uniform(0.8, 1);
                if (!(worth > most)) continue;
                most = worth;
                best = side;
            }
        return best;
    }

    /// What a look is worth: how far one sees, and how many sides of things.
    double worthOf(const glm::dvec3& eye, const glm::dvec3& look) const {
        const double far = (floor_.places.empty() ? 0.1 * diagonal_ : 25 * floor_.spacing) + margin_;
        double sum = 0, least = far;
        std::vector<uint64_t> seen;
        for (const double beside : {-kGlances[2], -kGlances[1], 0.0, kGlances[1], kGlances[2]})
            for (const double rise : {-0.3, 0.0, 0.3}) {
                glm::dvec3 direction = turnedAside(look, beside);
                direction.y = 0.3 * direction.y + rise;
                const auto hit = probe_.nearest({eye, glm::normalize(direction)});
                seen.push_back(hit ? sideOf(*hit) : 0);
                if (rise != 0) continue;
                const double free = hit ? std::min(hit->t, far) : 0.7 * far;  // rather a view than the sky
                sum += free;
                least = std::min(least, free);
            }
        std::sort(seen.begin(), seen.end());
        const auto sides = static_cast<double>(std::unique(seen.begin(), seen.end()) - seen.begin());
        return (sum + 2 * least) * (1 + sides / 4);
    }

    /// On the way: a leg, and how far along it.
    struct Place {
        size_t leg = 0;
        double done = 0;
    };

    double lengthOf(size_t leg) const { return glm::length(way_[leg + 1] - way_[leg]); }
    glm::dvec3 directionAt(const Place& place, const glm::dvec3& otherwise) const {
        if (place.leg + 1 >= way_.size() || !(lengthOf(place.leg) > 0)) return otherwise;
        return (way_[place.leg + 1] - way_[place.leg]) / lengthOf(place.leg);
    }
    /// Where one looks who looks ahead on the way.
    glm::dvec3 aheadOf(const Place& place, const glm::dvec3& otherwise) const {
        Place there = place;
        there.done += kAhead * (floor_.places.empty() ? 1 : floor_.unit);
        while (there.leg + 1 < way_.size() && there.done >= lengthOf(there.leg)) there.done -= lengthOf(there.leg++);
        if (there.leg + 1 >= way_.size()) return directionAt(place, otherwise);
        const glm::dvec3 way = at(there) - at(place);  // short where the way turns back
        return glm::length(way) > 0.5 * kAhead * (floor_.places.empty() ? 1 : floor_.unit)
                   ? glm::normalize(way)
                   : directionAt(place, otherwise);
    }
    glm::dvec3 at(const Place& place) const { return way_[place.leg] + place.done * directionAt(place, glm::dvec3(0)); }

    /// A step along the way, or as much of it as can be seen from where one is; at least to the next corner.
    void goOn(Place& place, double step) const {
        if (!(step > 0) || place.leg + 1 >= way_.size()) return;
        for (double part = step; part > step / 64; part /= 2) {
            Place next = place;
            next.done += part;
            while (next.leg + 1 < way_.size() && next.done >= lengthOf(next.leg)) next.done -= lengthOf(next.leg++);
            if (next.leg + 1 >= way_.size()) next.done = 0;
            if (next.leg > place.leg && !isFree(at(place), at(next))) continue;
            place = next;
            return;
        }
        place = {place.leg + 1, 0};
    }

    const Scene& scene_;
    const RayProbe& probe_;
    const WalkFloor& floor_;
    const WalkSettings settings_;
    Random random_;
    CameraFrame first_;                ///< where the walk begins
    std::vector<CameraFrame> starts_;  ///< seeded cameras, between which one flies
    double diagonal_ = 0;              ///< of the core; 0 if it has none  [world units]
    double margin_ = 0;                ///< [world units]
    std::vector<glm::dvec3> way_;
};

}  // namespace

CameraPath walkThrough(const Scene& scene, const WalkSettings& settings) {
    const RayProbe probe(scene);
    return walkOver(scene, probe, findFloor(scene, probe, settings.seed), settings);
}

CameraPath walkOver(const Scene& scene, const RayProbe& probe, const WalkFloor& floor, const WalkSettings& settings) {
    return Walker(scene, probe, floor, settings).path();
}

}  // namespace sightline::tools
