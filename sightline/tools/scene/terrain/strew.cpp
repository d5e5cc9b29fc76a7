// Strews trees, rocks and farms over a procedural terrain.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/terrain/strew.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "sightline/base/random.h"
#include "sightline/tools/scene/terrain/library.h"

namespace sightline::tools::terrain {
namespace {

constexpr double kCell = 16;       // one stream of random numbers for each square  [metres]
constexpr double kFarmCell = 224;  // at most one farm in each
constexpr double kFarmReach = 34;  // from its middle to beyond its fence
constexpr double kShore = 1.25;    // nothing stands lower over the water
constexpr int kMostInCell = 3;     // trees

/// Where a square of the plan has its random numbers.
uint64_t placeOf(int64_t x, int64_t z) {
    return (static_cast<uint64_t>(static_cast<uint32_t>(x)) << 32) | static_cast<uint32_t>(z);
}

/// A direction of the plan, uniform enough, and the same on every machine.
glm::dvec2 anyDirection(Random& random) {
    for (;;) {
        const glm::dvec2 d{random.uniform(-1, 1), random.uniform(-1, 1)};  // braces keep the order
        const double length2 = glm::dot(d, d);
        if (length2 > 0.01 && length2 <= 1) return d / std::sqrt(length2);
    }
}

class Strewer {
public:
    Strewer(const HeightField& field, uint64_t seed, Scene& scene)
        : field_(field),
          seed_(seed),

          scene_(scene),
          trees_(node("Trees", SceneNode::kNone)),
          rocks_(node("Rocks", SceneNode::kNone)) {
        const double side = (field.high() - field.low()) / kCell;
        const double expected = side * side * (kMostInCell + 1);
        keep_ = std::min(1.0, kMostObjects / (1.05 * expected));
    }

    void strew() {
        const uint32_t farms = node("Farms", SceneNode::kNone);
        eachCell(kFarmCell, [&](int64_t x, int64_t z) { addFarm(x, z, farms); });
        eachCell(kCell, [&](int64_t x, int64_t z) { fillCell(x, z); });
    }

private:
    uint32_t node(std::string name, uint32_t parent) {
        scene_.nodes.push_back({std::move(name), parent});
        return static_cast<uint32_t>(scene_.nodes.size() - 1);
    }

    /// All squares that touch the terrain, by their number from the origin.
    template <class Visit>
    void eachCell(double cell, const Visit& visit) {
        const auto first = static_cast<int64_t>(std::floor(field_.low() / cell));
        const auto last = static_cast<int64_t>(std::floor(field_.high() / cell));
        for (int64_t z = first; z <= last; ++z)
            for (int64_t x = first; x <= last; ++x) visit(x, z);
    }

    bool inside(const glm::dvec2& at, double margin) const {
        return std::min(at.x, at.y) >= field_.low() + margin && std::max(at.x, at.y) <= field_.high() - margin;
    }

    void put(Item item, const glm::dvec2& at, const glm::dvec2& front, const glm::dvec3& scale, uint32_t node,
             double sunk = 0) {
        if (standing_ == kMostObjects) return;
        ++standing_;
        SceneObject& object = scene_.objects.emplace_back();
        object.key = scene_.objects.size() - 1;
        object.mesh = item;
        object.node = node;
        object.name = scene_.meshes[item].name + " " + std::to_string(++counts_[item]);
        object.transform[0] = {front.y * scale.x, 0, -front.x * scale.x, 0};
        object.transform[1] = {0, scale.y, 0, 0};
        object.transform[2] = {front.x * scale.z, 0, front.y * scale.z, 0};
        object.transform[3] = {at.x, field_.ground(at) - sunk, at.y, 1};
    }

    /// Difference between the highest and the lowest ground under a square.
    double relief(const glm::dvec2& at, double reach) const {
        double low = field_.ground(at), high = low;
        for (double x = -reach; x <= reach; x += 0.25 * reach)
            for (double z = -reach; z <= reach; z += 0.25 * reach) {
                const double height = field_.ground(at + glm::dvec2(x, z));
                low = std::min(low, height);
                high = std::max(high, height);
            }
        return high - low;
    }

    bool onFarm(const glm::dvec2& at) const {
        const auto x = static_cast<int64_t>(std::floor(at.x / kFarmCell)),
                   z = static_cast<int64_t>(std::floor(at.y / kFarmCell));
        const auto farm = farms_.find({x, z});  // a farm keeps within its own square
        return farm != farms_.end() && glm::dot(at - farm->second, at - farm->second) < kFarmReach * kFarmReach;
    }

    void addFarm(int64_t x, int64_t z, uint32_t parent) {
        Random random(mixSeed(seed_ ^ 0x6661726dull, placeOf(x, z)));
        for (int tries = 0; tries < 12; ++tries) {
            const double share = kFarmReach / kFarmCell;
            const glm::dvec2 at =
                (glm::dvec2(x, z) + glm::dvec2{random.uniform(share, 1 - share), random.uniform(share, 1 - share)}) *
                kFarmCell;
            const glm::dvec2 front = anyDirection(random);
            if (!inside(at, kFarmReach + 4) || relief(at, 22) > 9 || field_.ground(at) < kLakeLevel + 4) continue;
            if (relief(at, 6) > 2.5 || field_.ground(at) > 110) continue;
            farms_[{x, z}] = at;
            const uint32_t farm = node("Farm " + std::to_string(farms_.size()), parent);
            const glm::dvec2 right(front.y, -front.x);
            const double size = random.uniform(0.9, 1.1);
            put(random.below(4) ? kHouse : kHut, at, front, glm::dvec3(size), farm);
            const glm::dvec2 barn = at - front * 2.0 + right * (random.below(2) ? 17.0 : -17.0);
            if (relief(barn, 8) < 3) put(kBarn, barn, random.below(2) ? right : front, glm::dvec3(1), farm);
            put(kWell, at + front * 9.0 - right * 4.0, front, glm::dvec3(1), farm);
            addFence(at, front, 6 + static_cast<int>(random.below(2)), 5, farm);
            for (int i = 0; i < 4; ++i) {
                const double back = random.uniform(10, 15), aside = random.uniform(-16, 16);
                const glm::dvec2 tree = at - front * back + right * aside;
                const double tall = random.uniform(0.4, 0.7);
                put(kOak, tree, anyDirection(random), glm::dvec3(tall), farm);
            }
            return;
        }
    }

    /// Around a yard of 2 half[0] by 2 half[1] lengths, with a gate in front; each length follows the ground.
    void addFence(const glm::dvec2& middle, const glm::dvec2& front, int half_wide, int half_deep, uint32_t farm) {
        const glm::dvec2 right(front.y, -front.x);
        for (int side = 0; side < 4; ++side) {
            const glm::dvec2 out = side == 0 ? front : side == 1 ? right : side == 2 ? -front : -right;
            const glm::dvec2 along(out.y, -out.x);
            const int reach = side % 2 == 0 ? half_wide : half_deep, away = side % 2 == 0 ? half_deep : half_wide;
            for (int i = -reach; i < reach; ++i) {
                if (side == 0 && i == 0) continue;
                const glm::dvec2 from = middle + out * (kFenceLength * away) + along * (kFenceLength * i);
                const glm::dvec2 to = from + along * kFenceLength;
                if (field_.ground(from) < kLakeLevel + kShore || field_.ground(to) < kLakeLevel + kShore) continue;
                if (standing_ == kMostObjects) return;
                put(kFence, from, out, glm::dvec3(1), farm);
                scene_.objects.back().transform[0].y = (field_.ground(to) - field_.ground(from)) / kFenceLength;
            }
        }
    }

    void fillCell(int64_t x, int64_t z) {
        Random random(mixSeed(seed_ ^ 0x747265ull, placeOf(x, z)));
        for (int i = 0; i <= kMostInCell; ++i) {
            const glm::dvec2 at = (glm::dvec2(x, z) + glm::dvec2{random.uniform(), random.uniform()}) * kCell;
            const glm::dvec2 front = anyDirection(random);
            const double kept = random.uniform(), chance = random.uniform(), size = random.uniform(0.7, 1.2),
                         kind = random.uniform();
            if (kept >= keep_ || !inside(at, 2) || onFarm(at)) continue;
            const double height = field_.ground(at);
            if (height < kLakeLevel + kShore) continue;
            const glm::dvec2 slope = field_.slope(at);
            const double steep = glm::dot(slope, slope);
            if (i == kMostInCell) {
                if (chance < (steep > 0.3 ? 0.5 : 0.06)) addRock(at, front, size, kind);
            } else if (steep < 0.8 && height < 170) {
                addPlant(at, front, height, chance, size, kind);
            }
        }
    }

    void addRock(const glm::dvec2& at, const glm::dvec2& front, double size, double kind) {
        const Item item = kind < 0.35 ? kBoulder : kind < 0.6 ? kSlabRock : kStones;
        put(item, at, front, glm::dvec3(size * (kind < 0.1 ? 2 : 1)), rocks_);
    }

    void addPlant(const glm::dvec2& at, const glm::dvec2& front, double height, double chance, double size,
                  double kind) {
        const double wood = noise(seed_ + 71, at / 150.0).value + 0.5 * noise(seed_ + 72, at / 47.0).value;
        const double thick = std::clamp(0.25 + 1.5 * wood, 0.015, 0.8);
        if (chance >= thick) return;
        const double cold = height / 90 + 0.6 * noise(seed_ + 73, at / 230.0).value + 0.5 * (kind - 0.5);
        const Item item = kind > 0.9    ? kBush
                          : cold > 0.25 ? (kind < 0.2 ? kPine : kSpruce)
                                        : (kind < 0.3 ? kBirch : kOak);
        put(item, at, front, {size, size * (0.85 + 0.3 * kind), size}, trees_);
    }

    const HeightField& field_;
    uint64_t seed_;
    Scene& scene_;
    uint32_t trees_, rocks_;
    double keep_ = 1;
    uint32_t standing_ = 0;
    std::array<uint32_t, kItemCount> counts_{};
    std::map<std::pair<int64_t, int64_t>, glm::dvec2> farms_;  ///< by square
};

}  // namespace

void strew(const HeightField& field, uint64_t seed, Scene& scene) { Strewer(field, seed, scene).strew(); }

}  // namespace sightline::tools::terrain
