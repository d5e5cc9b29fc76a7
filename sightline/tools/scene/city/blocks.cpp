// Fills a block of the city: buildings wall to wall around its edge, and what stands on their roofs.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/city/blocks.h"

#include <cmath>

namespace sightline::tools::city {
namespace {

constexpr double kOldTown = 130;    // within this distance of the middle: whole blocks, high roofs  [metres]
constexpr double kPartyWall = 0.5;  // neighbours overlap by this                                    [metres]

/// Roofs sink from the middle outward: what a street's fronts hide in a small city, they hide in a large one.
struct Heights {
    int low, high;
    double towers;
    int tower_low, tower_high;
};

Heights heightsAt(double distance) {
    if (distance < kOldTown) return {6, 8, 0.08, 10, 20};
    if (distance < 500) return {5, 7, 0.03, 10, 12};
    if (distance < 3000) return {5, 7, 0.0, 0, 0};
    return {4, 6, 0.0, 0, 0};
}

/// Of the kind and the heights asked for, one of those nearest in width.
const Building& choose(const Library& library, Random& random, Kind kind, double width, int low, int high) {
    std::vector<const Building*> best;
    double best_difference = 0;
    for (const Building& building : library.buildings) {
        if (building.kind != kind || building.storeys < low || building.storeys > high) continue;
        const double difference = std::abs(building.width - width);
        if (!best.empty() && difference > best_difference) continue;
        if (difference < best_difference) best.clear();
        best_difference = difference;
        best.push_back(&building);
    }
    return *best[random.below(best.size())];
}

/// Chimneys on pitched roofs, tanks and coolers on flat ones, at (x, z) of the building's own axes.
void putOnRoof(Random& random, const Building& building, const Side& side, double s, double t, double stretch,
               double tall, Planter& planter) {
    const double height = building.roof * tall, reach = 0.25 * building.width * stretch;
    if (building.pitched) {
        const uint64_t count = 1 + random.below(2);
        for (uint64_t i = 0; i < count; ++i)
            planter.put(kChimney, side.at(s + (i ? reach : -reach), t), height, side.quarter);
        return;
    }
    const uint64_t choice = random.below(4);
    const double shift = random.uniform(-0.5, 0.5) * reach;
    if (choice == 0) planter.put(kTank, side.at(s + shift, t), height, side.quarter);
    else if (choice < 3) planter.put(kCooler, side.at(s + shift, t), height, side.quarter);
}

/// One building between party walls from s to s + width.
void putRow(const Library& library, Random& random, const Heights& heights, const Side& side, double s, double width,
            Planter& planter) {
    const double roll = random.uniform();
    const bool tower = roll < heights.towers;
    const Building& building = tower
                                   ? choose(library, random, Kind::kTower, width, heights.tower_low, heights.tower_high)
                                   : choose(library, random, Kind::kRow, width, heights.low, heights.high);
    const double middle = s + 0.5 * width, stretch = (width + kPartyWall) / building.width;
    const double tall = random.uniform(0.97, 1.03);
    const double setback = random.uniform(0, 0.375);
    const bool mirrored = random.below(4) == 0;
    planter.put(building.mesh, side.at(middle, -setback), 0, side.quarter, {mirrored ? -stretch : stretch, tall, 1});
    putOnRoof(random, building, side, middle, -setback - 0.5 * kRowDepth, stretch, tall, planter);
    if (random.below(5) < 2) planter.put(kAwning, side.at(middle, -setback), kPavement, side.quarter);
}

/// The row along one side of a plot, between the corners' legs.
void fillRow(const Library& library, Random& random, const Heights& heights, double distance, const Side& side,
             double leg, Planter& planter) {
    const double length = side.length - 2 * leg;
    const int least = static_cast<int>(std::ceil(length / 19));
    // Three or so, of 12 to 27 m; one in the short sides of a narrow plot.
    const int count = least + (length > 30 ? 1 - static_cast<int>(random.below(3)) : 0);
    std::vector<double> widths(static_cast<size_t>(count));
    double sum = 0;
    for (double& width : widths) {
        width = random.uniform(0.85, 1.15);
        sum += width;
    }
    double s = leg;
    for (double& width : widths) {
        width *= length / sum;
        // Now and then a garden between two fire walls; not in the old town, whose fronts close every view.
        if (distance > kOldTown && random.below(32) == 0) {
            const double middle = s + 0.5 * width;
            planter.put(kFence, side.at(middle, -0.25), kPavement, side.quarter, {width / 6, 1, 1});
            planter.put(kPoplar, side.at(middle, -6), kPavement, side.quarter);
        } else {
            putRow(library, random, heights, side, s, width, planter);
        }
        s += width;
    }
}

void fillPlot(const Library& library, Random& random, double distance, const Rectangle& plot, Planter& planter) {
    const Heights heights = heightsAt(distance);
    // Narrow plots get shorter legs, so that a narrow house fits between them.
    const bool narrow = plot.max.x - plot.min.x < 50 || plot.max.y - plot.min.y < 50;
    const double leg = narrow ? kCornerLeg - 2 : kCornerLeg, scale = leg / kCornerLeg;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Side side = sideOf(plot, quarter);
        const Building& corner = choose(library, random, Kind::kCorner, kCornerLeg, heights.low, heights.high);
        const double tall = random.uniform(0.97, 1.03);
        planter.put(corner.mesh, side.at(side.length, 0), 0, quarter, {scale, tall, scale});
        putOnRoof(random, corner, side, side.length - 0.5 * leg, -0.5 * kRowDepth * scale, 0.5, tall, planter);
        fillRow(library, random, heights, distance, side, leg - kPartyWall, planter);
    }
}

}  // namespace

void Planter::put(uint32_t mesh, const glm::dvec2& at, double height, int quarter, const glm::dvec3& scale) {
    const glm::dvec2 along = alongSide(quarter), outward = outwardOf(quarter);
    SceneObject& object = objects_->emplace_back();
    object.key = objects_->size() - 1;
    object.mesh = mesh;
    object.transform[0] = {along.x * scale.x, 0, along.y * scale.x, 0};
    object.transform[1] = {0, scale.y, 0, 0};
    object.transform[2] = {outward.x * scale.z, 0, outward.y * scale.z, 0};
    object.transform[3] = {at.x, height, at.y, 1};
}

std::vector<Rectangle> plotsOf(const Block& block, bool split, int turn) {
    const double reach = 0.5 * block.size() - kFrontage, lane = 0.5 * kAlley;
    const glm::dvec2 middle(block.x, block.z), corner(reach, reach);
    if (!split) return {{middle - corner, middle + corner}};
    const glm::dvec2 first_end = turn % 2 == 0 ? glm::dvec2(-lane, reach) : glm::dvec2(reach, -lane);
    return {{middle - corner, middle + first_end}, {middle - first_end, middle + corner}};
}

void fillBuildings(const Library& library, Random& random, const Block& block, bool split, int turn, Planter& planter) {
    const double distance = std::sqrt(static_cast<double>(block.distance2));
    if (!block.small) {
        for (const Rectangle& plot : plotsOf(block, split, turn)) fillPlot(library, random, distance, plot, planter);
        return;
    }
    const Heights heights = heightsAt(distance);
    const Building& island = choose(library, random, Kind::kIsland, kIslandSize, 5, heights.high);
    const double tall = random.uniform(0.97, 1.03);
    const bool mirrored = random.below(2) == 0;
    planter.put(island.mesh, {block.x, block.z}, 0, turn, {mirrored ? -1.0 : 1.0, tall, 1});
    const Side side{turn & 3, {block.x, block.z}, kIslandSize};
    putOnRoof(random, island, side, 0, island.pitched ? -8 : 0, 0.5, tall, planter);
}

void fillBlock(const Library& library, uint64_t seed, const Block& block, Planter& planter) {
    Random random(mixSeed(seed, block.place()));
    const int turn = static_cast<int>(random.below(4));
    const bool old_town = block.distance2 < static_cast<int64_t>(kOldTown * kOldTown);
    const bool split = !block.small && random.below(3) == 0 && !old_town;
    const bool market = block.distance2 == 0;
    const bool square = block.small && random.below(5) < 2;
    const Item ground = block.small ? kGroundSmall : split ? kGroundSplit : kGroundLarge;
    planter.put(ground, {block.x, block.z}, 0, split && turn % 2 == 1 ? 1 : 0);
    if (market) fillMarket(random, planter);
    else if (square) fillSquare(random, block, planter);
    else fillBuildings(library, random, block, split, turn, planter);
    fillStreets(random, block, split, turn, planter);
    if (!block.small && !market) fillYards(random, block, split, turn, old_town, planter);
}

}  // namespace sightline::tools::city
