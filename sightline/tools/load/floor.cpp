// Where one can walk in a scene: starts are searched in columns, and a floor grows from one place to the next.
// SPDX-License-Identifier: MIT
#include "sightline/tools/load/floor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <unordered_map>
#include <utility>

#include "sightline/base/random.h"
#include "sightline/tools/scene/scene_core.h"

namespace sightline::tools {
namespace {

constexpr double kNoHit = std::numeric_limits<double>::infinity();

// Of a grown person  [metres].
constexpr double kKnee = 0.4, kEye = 1.6, kHead = 1.75, kClimb = 0.45, kNarrow = 0.2;
constexpr double kLeastLevel = 0.75;  // of a floor: the height of its unit normal

constexpr double kHall = 12;           // no ceiling of a usual room is higher
constexpr double kRooms = 5;           // so many times as high as the low ones are high rooms
constexpr size_t kFewestCeilings = 8;  // that tell what a metre is

constexpr int kColumns = 256;        // where starts are searched
constexpr int kLevels = 24;          // of a column
constexpr int kAround = 16;          // directions in which a start looks
constexpr double kRise = 0.27;       // of those that look upwards: 15 degrees
constexpr double kEnclosed = 1;      // worth of a start that needs no floor
constexpr double kSmall = 60;        // across: a scene that is looked at from outside  [metres],
constexpr double kSmallWorth = 0.6;  // unless a start in it is worth this
constexpr uint32_t kMostPlaces = 2500;
constexpr uint32_t kEnough = 800;     // places: no better start is looked for
constexpr uint32_t kFewest = 24;      // places: with fewer there is nothing to walk on
constexpr uint32_t kMostStarts = 12;  // from which a floor is grown

/// One of kAround directions: a quarter of a quarter turn from one to the next.
glm::dvec3 directionOf(int which) {
    // Cosine and sine: those of the standard library differ between machines.
    constexpr double kTurns[4][2] = {{1, 0}, {0.92388, 0.38268}, {0.70711, 0.70711}, {0.38268, 0.92388}};
    const auto& [c, s] = kTurns[which % 4];
    switch (which / 4) {
        case 0:
            return {c, 0, s};
        case 1:
            return {-s, 0, c};
        case 2:
            return {-c, 0, -s};
        default:
            return {s, 0, -c};
    }
}

/// Somebody could begin here.
struct Start {
    glm::dvec3 foot;
    bool on_ground = false;   ///< on no surface
    double ceiling = kNoHit;  ///< height above the foot
    double worth = 0;         ///< 0 to 1.5: how much is seen around, above all at and over the height of the eye
    double wide = 0;          ///< how far one sees
};

class FloorFinder {
public:
    FloorFinder(const Scene& scene, const RayProbe& probe, uint64_t seed)
        : probe_(probe), bounds_(coreOf(scene).bounds), random_(mixSeed(seed, 0x666c6f6f)) {
        std::vector<double> bottoms;
        for (const SceneObject& object : scene.objects)
            bottoms.push_back(transformBox(scene.meshes[object.mesh].bounds, object.transform).min.y);
        if (bottoms.empty()) return;
        const auto low = bottoms.begin() + static_cast<ptrdiff_t>(bottoms.size() / 4);
        std::nth_element(bottoms.begin(), low, bottoms.end());
        ground_ = *low;
    }

    WalkFloor find() {
        WalkFloor best;
        if (!bounds_.finite() || bounds_.empty()) return best;
        std::vector<Start> starts = findStarts();
        unit_ = tellUnit(starts);
        if (!(unit_ > 0)) return best;
        chooseStarts(starts);
        for (uint32_t i = 0; i < std::min<size_t>(starts.size(), kMostStarts); ++i) {
            WalkFloor floor = growFrom(starts[i]);
            if (floor.places.size() > best.places.size()) best = std::move(floor);
            if (best.places.size() >= kEnough) break;
        }
        if (best.places.size() < kFewest) best.places.clear();
        return best;
    }

private:
    bool hits(const glm::dvec3& from, const glm::dvec3& to) const {
        const auto hit = probe_.nearest({from, to - from});
        return hit && hit->t < 1;
    }

    glm::dvec3 above(const glm::dvec3& foot, double metres) const { return foot + glm::dvec3(0, metres * unit_, 0); }

    double ceilingOver(const glm::dvec3& foot) const {
        const double lift = 0.05 * unit_;
        const auto hit = probe_.nearest({foot + glm::dvec3(0, lift, 0), {0, 1, 0}});
        return hit ? hit->t + lift : kNoHit;
    }

    /// All floors in columns, the same for all seeds, and the ground where there is none.
    std::vector<Start> findStarts() {
        std::vector<Start> starts;
        Random random(mixSeed(0, 0x636f6c73));
        const double top = bounds_.max.y + 0.01 * bounds_.size().y + 1, skip = 1e-6 * (bounds_.size().y + 1);
        for (int i = 0; i < kColumns; ++i) {
            const double z = random.uniform(bounds_.min.z, bounds_.max.z);
            const glm::dvec3 from(random.uniform(bounds_.min.x, bounds_.max.x), top, z);
            double t = 0;
            const size_t before = starts.size();
            for (int level = 0; level < kLevels; ++level) {
                const auto hit = probe_.nearest({from, {0, -1, 0}}, t);
                if (!hit) break;
                t = hit->t + skip;
                if (!hit->front || std::abs(probe_.normal(*hit).y) < kLeastLevel) continue;
                Start start{.foot = from - glm::dvec3(0, hit->t, 0)};
                start.ceiling = ceilingOver(start.foot);
                starts.push_back(start);
            }
            if (std::any_of(starts.begin() + static_cast<ptrdiff_t>(before), starts.end(),
                            [&](const Start& floor) { return floor.foot.y < ground_ + kHead; }))
                continue;
            Start start{.foot = {from.x, ground_, from.z}, .on_ground = true};
            start.ceiling = ceilingOver(start.foot);
            starts.push_back(start);
        }
        return starts;
    }

    /// What a metre is. It is the unit, unless rooms are too high for people; none at all, and then 0, where heights are
    /// so different that these are no rooms.
    double tellUnit(const std::vector<Start>& starts) const {
        std::vector<double> ceilings;
        for (const Start& start : starts)
            if (start.ceiling != kNoHit && !start.on_ground) ceilings.push_back(start.ceiling);
        if (ceilings.size() < kFewestCeilings) return 1;
        std::sort(ceilings.begin(), ceilings.end());
        const double low = ceilings[ceilings.size() / 4], high = ceilings[3 * ceilings.size() / 4];
        if (high < kHall) return 1;
        return high < kRooms * low ? std::max(1.0, low / 4) : 0;
    }

    /// A place with its surroundings as far as `far`. What is too narrow is not measured to the end.
    WalkFloor::Place placeAt(const glm::dvec3& foot, double far) const {
        WalkFloor::Place place{.foot = foot, .room = far, .next = {}};
        for (int i = 0; i < kAround; i += 2) {
            const auto hit = probe_.nearest({above(foot, kEye), directionOf(i)});
            const double free = hit ? std::min(hit->t, far) : far;
            place.view += free * 2 / kAround;
            place.room = std::min(place.room, free);
            if (place.room < kNarrow * unit_) break;
        }
        return place;
    }

    /// Looks around: how much is seen, how far, and whether it is the inside of a solid.
    void judge(Start& start) const {
        start.worth = 0;
        if (start.ceiling < kHead * unit_) return;
        const glm::dvec3 eye = above(start.foot, kEye);
        if (placeAt(start.foot, unit_).room < 2 * kNarrow * unit_) return;
        int level = 0, over = 0, back = 0;
        std::array<double, kAround> far;
        for (int i = 0; i < kAround; ++i) {
            const glm::dvec3 direction = directionOf(i);
            const auto ahead = probe_.nearest({eye, direction});
            const auto higher = probe_.nearest({eye, glm::normalize(direction + glm::dvec3(0, kRise, 0))});
            far[i] = ahead ? ahead->t : glm::length(bounds_.size());
            level += ahead ? 1 : 0;
            over += higher ? 1 : 0;
            back += ahead && !ahead->front ? 1 : 0;
        }
        if (back > kAround / 3 || level < kAround / 4) return;
        std::nth_element(far.begin(), far.begin() + kAround / 2, far.end());
        start.wide = far[kAround / 2];
        start.worth = (0.5 * level + over) / kAround;
        const double least = start.on_ground                                ? kEnclosed
                             : glm::length(bounds_.size()) < kSmall * unit_ ? kSmallWorth
                                                                            : 0;
        if (start.worth < least) start.worth = 0;
    }

    /// Starts that are worth four fifths of the best, at least twelve, in the seed's order.
    void chooseStarts(std::vector<Start>& starts) {
        for (Start& start : starts) judge(start);
        std::erase_if(starts, [](const Start& start) { return !(start.worth > 0); });
        if (starts.empty()) return;
        std::stable_sort(starts.begin(), starts.end(),
                         [](const Start& a, const Start& b) { return a.worth > b.worth; });
        const double least = 0.8 * starts.front().worth;
        size_t kept = std::min<size_t>(starts.size(), kMostStarts);
        while (kept < starts.size() && starts[kept].worth >= least) ++kept;
        starts.resize(kept);
        for (size_t i = starts.size(); i > 1; --i) std::swap(starts[i - 1], starts[random_.below(i)]);
    }

    /// A foot near a height in a column, or none: a floor, or the ground where a start on it has none below, and room for
    /// a head over it.
    bool footAt(const WalkFloor& floor, double x, double z, double height, glm::dvec3& foot) const {
        const double lift = std::max(floor.climb, 0.9 * unit_);
        const auto hit = probe_.nearest({{x, height + lift, z}, {0, -1, 0}});
        foot = {x, hit ? height + lift - hit->t : floor.ground.value_or(-kNoHit), z};
        if (!(std::abs(foot.y - height) <= floor.climb)) return false;
        if (hit && std::abs(probe_.normal(*hit).y) < kLeastLevel) return false;
        return ceilingOver(foot) >= kHead * unit_;
    }

    bool inBounds(double x, double z) const {
        return x >= bounds_.min.x && x <= bounds_.max.x && z >= bounds_.min.z && z <= bounds_.max.z;
    }

    bool canWalk(const glm::dvec3& a, const glm::dvec3& b) const {
        return !hits(above(a, kKnee), above(b, kKnee)) && !hits(above(a, kEye), above(b, kEye));
    }

    /// All that can be reached from a start, nearest first.
    WalkFloor growFrom(const Start& start) const {
        WalkFloor floor;
        floor.unit = unit_;
        const double wide = std::clamp(start.wide / (6 * unit_), 1.0, 12.0);
        floor.spacing = 0.4 * unit_ * wide;
        floor.climb = std::max(kClimb * unit_, 0.7 * floor.spacing);
        if (start.on_ground) floor.ground = ground_;
        const double far = 8 * unit_ * wide;
        std::unordered_map<uint64_t, std::vector<uint32_t>> columns;
        std::vector<std::pair<int32_t, int32_t>> cells;  // of places
        const auto add = [&](int32_t column, int32_t row, const WalkFloor::Place& place) {
            columns[keyOf(column, row)].push_back(static_cast<uint32_t>(floor.places.size()));
            cells.emplace_back(column, row);
            floor.places.push_back(place);
        };
        add(0, 0, placeAt(start.foot, far));
        for (uint32_t here = 0; here < floor.places.size(); ++here)
            for (int32_t side = 0; side < 9; ++side) {
                const int32_t dx = side % 3 - 1, dz = side / 3 - 1;
                if (dx == 0 && dz == 0) continue;
                const int32_t column = cells[here].first + dx, row = cells[here].second + dz;
                const glm::dvec3 foot = floor.places[here].foot;
                const auto lead = [&](uint32_t there) {
                    if (!canWalk(foot, floor.places[there].foot)) return;
                    floor.places[here].next.push_back(there);
                    floor.places[there].next.push_back(here);
                };
                bool known = false;
                for (const uint32_t there : columns[keyOf(column, row)]) {
                    if (std::abs(floor.places[there].foot.y - foot.y) > floor.climb) continue;
                    known = true;
                    if (!leads(floor.places[here], there)) lead(there);
                }
                if (known || (dx != 0 && dz != 0) || floor.places.size() >= kMostPlaces) continue;
                const double x = start.foot.x + column * floor.spacing, z = start.foot.z + row * floor.spacing;
                glm::dvec3 next;
                if (!inBounds(x, z) || !footAt(floor, x, z, foot.y, next) || !canWalk(foot, next)) continue;
                const WalkFloor::Place place = placeAt(next, far);
                if (place.room < kNarrow * unit_) continue;
                const auto there = static_cast<uint32_t>(floor.places.size());
                add(column, row, place);
                floor.places[here].next.push_back(there);
                floor.places[there].next.push_back(here);
            }
        return floor;
    }

    static uint64_t keyOf(int32_t column, int32_t row) {
        return uint64_t{static_cast<uint32_t>(column)} << 32 | static_cast<uint32_t>(row);
    }
    static bool leads(const WalkFloor::Place& place, uint32_t there) {
        return std::find(place.next.begin(), place.next.end(), there) != place.next.end();
    }

    const RayProbe& probe_;
    const Box3d bounds_;
    Random random_;
    double unit_ = 1;
    double ground_ = 0;  ///< a quarter of the objects begin at or below this height
};

}  // namespace

WalkFloor findFloor(const Scene& scene, const RayProbe& probe, uint64_t seed) {
    return FloorFinder(scene, probe, seed).find();
}

}  // namespace sightline::tools
