// Furnishes a block of the city: streets, squares and yards.
// SPDX-License-Identifier: MIT
#include "sightline/tools/scene/city/blocks.h"

namespace sightline::tools::city {
namespace {

constexpr double kKerbLine = -kKerb - 0.75;  // where trees and lamps stand, from the middle of the street  [metres]
constexpr double kParking = -2.9375;         // the middle of a parked car
constexpr double kTreeStep = 13;

Item carOf(Random& random) { return static_cast<Item>(kRedCar + random.below(4)); }

/// True where a lane opens into this side.
bool laneAt(const Side& side, bool opens, double s, double margin) {
    return opens && s > 0.5 * side.length - margin && s < 0.5 * side.length + margin;
}

void parkCars(Random& random, const Side& side, bool opens, Planter& planter) {
    for (double s = 12.5; s <= side.length - 12; s += 6.5) {
        const bool parked = random.below(100) < 55;
        const Item car = carOf(random);
        const int turned = random.below(4) == 0 ? 2 : 0;
        const double shift = random.uniform(-0.5, 0.5);
        if (!parked || laneAt(side, opens, s, 7)) continue;
        planter.put(car, side.at(s + shift, kParking), 0, side.quarter + turned);
    }
}

/// What stands between two trees.
void putBetween(Random& random, const Side& side, double s, bool lit, Planter& planter) {
    const double t = kKerbLine;
    const int inward = side.quarter + 2;
    const uint64_t near = random.below(10), middle = random.below(12), far = random.below(10);
    if (near < 2) planter.put(kBench, side.at(s + 3.25, t), kPavement, inward);
    else if (near < 3) planter.put(kPlanter, side.at(s + 3.25, t), kPavement, side.quarter);
    else if (near < 4) planter.put(kBicycleStand, side.at(s + 3.25, t), kPavement, side.quarter);
    if (lit) planter.put(kLamp, side.at(s + 6.5, t), kPavement, side.quarter);
    else if (middle == 0) planter.put(kKiosk, side.at(s + 6.5, -5.625), kPavement, inward);
    else if (middle == 1) planter.put(kShelter, side.at(s + 6.5, -5.25), kPavement, side.quarter);
    if (far < 2) planter.put(kBin, side.at(s + 9.75, t), kPavement, side.quarter);
    else if (far < 3) planter.put(kHydrant, side.at(s + 9.75, t), kPavement, side.quarter);
    else if (far < 4) planter.put(kSign, side.at(s + 9.75, t), kPavement, side.quarter + 1);
}

void fillStreet(Random& random, const Side& side, Item tree, bool opens, Planter& planter) {
    int step = 0;
    for (double s = kTreeStep; s <= side.length - 10; s += kTreeStep, ++step) {
        const bool grown = random.below(4) != 0;
        const double scale = random.uniform(0.8, 1.1);
        const int turn = static_cast<int>(random.below(4));
        if (laneAt(side, opens, s, 10)) continue;
        if (grown) planter.put(tree, side.at(s, kKerbLine), kPavement, turn, {scale, scale, scale});
        if (s + kTreeStep <= side.length - 10) putBetween(random, side, s, step % 2 == 0, planter);
    }
    parkCars(random, side, opens, planter);
    for (const double s : {5.5, 7.0, side.length - 5.5})
        planter.put(kBollard, side.at(s, -kKerb - 0.375), kPavement, 0);
    if (random.below(3) == 0) planter.put(kCrossing, side.at(9, 0), 0, side.quarter + 1);
    if (random.below(2) == 0) planter.put(kSign, side.at(side.length - 8, kKerbLine), kPavement, side.quarter + 1);
}

}  // namespace

void fillStreets(Random& random, const Block& block, bool split, int turn, Planter& planter) {
    const double reach = 0.5 * block.size();
    const glm::dvec2 middle(block.x, block.z), corner(reach, reach);
    const Item tree = random.below(2) ? kPlaneTree : kLimeTree;
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Side side = sideOf({middle - corner, middle + corner}, quarter);
        fillStreet(random, side, tree, split && quarter % 2 == turn % 2, planter);
    }
    if (!split) return;
    // The lane: bollards at its mouths, bins and planters along its walls.
    for (const int quarter : {turn % 2, turn % 2 + 2}) {
        const Side side = sideOf({middle - corner, middle + corner}, quarter);
        for (const double s : {-1.5, 0.0, 1.5}) planter.put(kBollard, side.at(reach + s, -kFrontage), 0, 0);
        for (double t = 14; t < reach; t += 9) {
            const Item item = random.below(2) ? kBin : kPlanter;
            planter.put(item, side.at(reach + 0.5 * kAlley - 0.625, -t), kPavement, quarter + 3);
        }
    }
}

void fillSquare(Random& random, const Block& block, Planter& planter) {
    const glm::dvec2 middle(block.x, block.z);
    const bool monument = random.below(2) == 0;
    planter.put(kLawn, middle, kPavement, 0, {18, 1, 18});
    planter.put(monument ? kMonument : kKiosk, middle, kPavement, static_cast<int>(random.below(4)));
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Side side = sideOf({middle - 10.0, middle + 10.0}, quarter);
        planter.put(kPlaneTree, side.at(2, -2), kPavement, quarter);
        planter.put(kBench, side.at(10, 0.5), kPavement, quarter);
        planter.put(kHedge, side.at(6, 0), kPavement, quarter);
        planter.put(kHedge, side.at(14, 0), kPavement, quarter, {-1, 1, 1});
        if (random.below(2)) planter.put(kPlanter, side.at(10, -6), kPavement, quarter);
    }
}

void fillMarket(Random& random, Planter& planter) {
    planter.put(kMonument, {0, 0}, kPavement, 0, glm::dvec3(1.5));
    for (int quarter = 0; quarter < 4; ++quarter) {
        const Side side = sideOf({glm::dvec2(-40.0), glm::dvec2(40.0)}, quarter);
        planter.put(kLawn, side.at(21, -21), kPavement, quarter, {30, 1, 30});
        planter.put(kKiosk, side.at(40, -8), kPavement, quarter);
        for (int i = 0; i < 6; ++i) {  // an avenue of trees around the market, and a path to its middle
            const double scale = random.uniform(0.9, 1.1);
            const int turn = static_cast<int>(random.below(4));
            planter.put(kPlaneTree, side.at(4 + 13 * i + (i > 2 ? 7 : 0), 0), kPavement, turn, {scale, scale, scale});
        }
        for (int i = 0; i < 4; ++i) {
            const Item tree = random.below(3) == 0 ? kPoplar : kLimeTree;
            const double x = random.uniform(-4, 4), z = random.uniform(-4, 4);
            planter.put(tree, side.at(13.0 + 16 * (i % 2) + x, -13.0 - 16 * (i / 2) + z), kPavement, i);
        }
        for (int i = 0; i < 4; ++i) {
            planter.put(kHedge, side.at(8 + 8.0 * i, -4.5), kPavement, quarter, {i % 2 ? -1.0 : 1.0, 1, 1});
            planter.put(kBench, side.at(12 + 8.0 * i, -3.5), kPavement, quarter);
        }
        for (int i = 0; i < 3; ++i) {
            planter.put(kLamp, side.at(37.5, -14.0 - 8 * i), kPavement, quarter + 3);
            planter.put(kPlanter, side.at(42.5, -12.0 - 8 * i), kPavement, quarter + 1);
            planter.put(i == 1 ? kBicycleStand : kBin, side.at(48 + 9.0 * i, -3.5), kPavement, quarter);
        }
    }
}

void fillYards(Random& random, const Block& block, bool split, int turn, bool bare, Planter& planter) {
    for (const Rectangle& plot : plotsOf(block, split, turn)) {
        const glm::dvec2 middle = 0.5 * (plot.min + plot.max), size = plot.max - plot.min - 2 * (kRowDepth + 1);
        planter.put(kLawn, middle, kPavement, 0, {size.x - 2, 1, size.y - 2});
        const int trees = bare ? 3 : split ? 5 : 9;
        for (int i = 0; i < trees; ++i) {
            const double x = random.uniform(-0.45, 0.45), z = random.uniform(-0.45, 0.45);
            const double scale = random.uniform(0.7, 1.1);
            const Item tree = static_cast<Item>(kPlaneTree + random.below(3));
            planter.put(tree, middle + glm::dvec2(x * size.x, z * size.y), kPavement, i % 4, {scale, scale, scale});
        }
        const int others = bare ? 2 : split ? 4 : 8;
        for (int i = 0; i < others; ++i) {
            constexpr Item kChoice[] = {kShed, kFence, kHedge, kBench, kBin, kFence};
            const Item item = kChoice[random.below(6)];
            const double x = random.uniform(-0.4, 0.4), z = random.uniform(-0.4, 0.4);
            const int quarter = static_cast<int>(random.below(4));
            const bool mirrored = random.below(4) == 0;
            planter.put(item, middle + glm::dvec2(x * size.x, z * size.y), kPavement, quarter,
                        {mirrored ? -1.0 : 1.0, 1, 1});
        }
    }
}

}  // namespace sightline::tools::city
