// Walks through a scene's free space: legs between seeded cameras, rounded corners, and a glance here and there.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/walk.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "sightline/base/random.h"
#include "sightline/tools/load/seeded_cameras.h"

namespace sightline::tools {
namespace {

constexpr uint32_t kGoals = 64;           // seeded cameras
constexpr int kDirections = 32;           // tried where no goal can be reached
constexpr double kLongestLeg = 4;         // of these  [s]
constexpr int kRoundings = 8;             // pieces of a corner
constexpr double kTurn = 1.0471975512;    // pi / 3  [radians / s]
constexpr double kGlance = 2;             // between two glances  [s]
constexpr double kAside = 0.7, kUp = .2;  // how far a glance goes, as tangents

glm::dvec3 anyRight(const glm::dvec3& direction) {
    const glm::dvec3 flat(-direction.z, 0, direction.x);
    const double length = glm::length(flat);
    return length > 1e-6 ? flat / length : glm::dvec3(1, 0, 0);
}

/// Turns a direction towards another one, by at most an angle of which `tangent` is no more than half.
glm::dvec3 turned(const glm::dvec3& from, const glm::dvec3& to, double tangent) {
    const double scale = 1 / (1 + tangent * tangent);
    const double cosine = (1 - tangent * tangent) * scale, sine = 2 * tangent * scale;
    if (glm::dot(from, to) >= cosine) return to;
    glm::dvec3 across = to - glm::dot(from, to) * from;
    if (!(glm::length(across) > 1e-9)) across = anyRight(from);
    return glm::normalize(cosine * from + sine * glm::normalize(across));
}

class Walker {
public:
    Walker(const Scene& scene, const WalkSettings& settings)
        : probe_(scene),
          settings_(settings),
          random_(mixSeed(settings.seed, 0x77616c6b)),
          starts_(seededCameras(scene, kGoals, settings.seed).frames) {
        const Box3d bounds = worldBounds(scene);
        const double diagonal = bounds.finite() ? glm::length(bounds.size()) : 0;
        margin_ = std::isfinite(diagonal) ? std::min(0.25, 0.01 * diagonal) : 0.25;
    }

    CameraPath path() {
        findWay();
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

    /// The legs of the way, as long as all frames need.
    void findWay() {
        way_ = {starts_[0].eye};
        std::vector<bool> was_at(starts_.size());
        was_at[0] = true;
        double left = 1.2 * settings_.speed * settings_.frames / settings_.fps;  // rounded corners are shorter
        while (left > 0) {
            const glm::dvec3 here = way_.back();
            glm::dvec3 next = here;
            if (!findGoal(here, was_at, left, next)) next = anyPlace(here);
            const double length = glm::length(next - here);
            if (!(length > 0)) break;
            way_.push_back(next);
            left -= length;
        }
        roundCorners();
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
            way_.size() > 1 ? glm::normalize(here - way_[way_.size() - 2]) : starts_[0].target - starts_[0].eye;
        const double far = kLongestLeg * settings_.speed;
        double most = 0;
        glm::dvec3 best = here;
        for (int i = 0; i < kDirections; ++i) {
            const glm::dvec3 drawn(random_.uniform(-1, 1), random_.uniform(-0.2, 0.2), random_.uniform(-1, 1));
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
        const auto glance = static_cast<uint32_t>(std::max(1.0, kGlance * settings_.fps));
        CameraFrame frame = starts_[0];
        glm::dvec3 look = glm::normalize(frame.target - frame.eye), forward = look;
        const double distance = glm::length(frame.target - frame.eye);
        double aside = 0, up = 0;
        Place place;
        for (uint32_t i = 0; i < settings_.frames; ++i) {
            if (i > 0) goOn(place, step);
            frame.eye = at(place);
            forward = directionAt(place, forward);
            if (i % glance == 0) {
                aside = random_.uniform(-kAside, kAside);
                up = random_.uniform(-kUp, kUp);
            }
            glm::dvec3 wanted = forward + aside * anyRight(forward);
            wanted.y = 0.3 * wanted.y + up;
            if (i > 0) look = turned(look, glm::normalize(wanted), tangent);
            frame.target = frame.eye + look * distance;
            out.frames.push_back(frame);
        }
        return out;
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
    glm::dvec3 at(const Place& place) const { return way_[place.leg] + place.done * directionAt(place, glm::dvec3(0)); }

    /// A step along the way, or to the next corner where the corner cannot be cut.
    void goOn(Place& place, double step) const {
        Place next = place;
        next.done += step;
        while (next.leg + 1 < way_.size() && next.done >= lengthOf(next.leg)) {
            next.done -= lengthOf(next.leg);
            ++next.leg;
        }
        if (next.leg + 1 >= way_.size()) next.done = 0;
        if (next.leg > place.leg && !isFree(at(place), at(next))) next = {place.leg + 1, 0};
        place = next;
    }

    const RayProbe probe_;
    const WalkSettings settings_;
    Random random_;
    const std::vector<CameraFrame> starts_;  ///< seeded cameras: the first is where the walk begins
    double margin_ = 0;                      ///< [world units]
    std::vector<glm::dvec3> way_;
};

}  // namespace

CameraPath walkThrough(const Scene& scene, const WalkSettings& settings) { return Walker(scene, settings).path(); }

}  // namespace sightline::tools
