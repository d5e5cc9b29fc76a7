// The most useful levels of detail that a frame has time for.
// SPDX-License-Identifier: MIT
//
// Thomas Funkhouser, Carlo Sequin. Adaptive Display Algorithm for Interactive Frame Rates During Visualization of
// Complex Virtual Environments. 1993.
// Hugh Everett. Generalized Lagrange Multiplier Method for Solving Problems of Optimum Allocation of Resources. 1963.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/array.h"
#include "sightline/geom/lod.h"

namespace sightline {

/// An object that wants to be drawn.
struct LodItem {
    static constexpr uint8_t kNone = 0xff;

    std::span<const LodLevel> levels;  ///< finest first; empty: it costs its draw call, and has no choice of levels
    double pixels_of_unit = 0;         ///< of the object's own space: how large its errors look
    double pixels = 0;                 ///< that it may cover
    double importance = 1;             ///< times as much as others
    uint8_t finest = 0;                ///< nothing finer is of use  [limit: < levels]
    uint8_t last = kNone;              ///< the level that the last answer had
    bool always = false;               ///< it is drawn whatever the budget is
};

struct LodBudgetSettings {
    double nanoseconds = 0;  ///< that drawing may cost
    /// The cost is kept below the budget whatever it takes: objects are left out. Else each object is drawn, by its
    /// coarsest level if need be, and only what goes beyond that is held to the budget.
    bool hard = false;
    double error = 1;         ///< the error that halves what an object is worth  [pixels]
    double hysteresis = 0.1;  ///< the level of the last answer is worth so much more
    DrawCost cost;
};

struct LodBudgetResult {
    double cost = 0;     ///< of what was chosen  [ns]
    double benefit = 0;  ///< of the same, hysteresis included
    uint32_t left_out = 0;
    bool exceeded = false;  ///< what must be drawn costs more than the budget
};

/// Chooses levels under a budget. Its arrays stay from frame to frame: it allocates only when there are more objects.
///
/// An object is worth its pixels times its importance times the accuracy of its level, e / (e + error), with e from the
/// settings. Of each object's levels those count that lie on the upper hull of benefit over cost. The steps from hull
/// point to hull point, of all objects together, are taken by benefit per cost, the best first, until one does not fit;
/// then what still fits of those that are nearly as good. That is the greedy method for the multiple-choice knapsack: it
/// loses less than one step against the best choice of all. Where one object alone is worth more than all of that, it
/// comes first; so the choice is worth at least half of the best.
///
/// The steps are not looked at one by one. What all steps above a price lead to is, for each object, the level of the
/// largest benefit less price times cost. So two prices are tried, near the one at which the last answer's money ran
/// out: where that happens between the two, only objects that choose differently at both have steps to be sorted. The
/// choice does not depend on where the search began. Costs are counted in whole picoseconds, so that sums are exact.
/// O(levels of all objects), a few times over where the price has moved.
class LodBudget {
public:
    static constexpr uint8_t kLeftOut = LodItem::kNone;

    explicit LodBudget(Memory* memory = defaultMemory());

    /// @param chosen  receives a level per item, or kLeftOut  [size: items]
    LodBudgetResult choose(std::span<const LodItem> items, const LodBudgetSettings& settings,
                           std::span<uint8_t> chosen);

private:
    /// What an item may be drawn as.
    struct Point {
        double cost = 0;  ///< [ps], a whole number
        double benefit = 0;
        uint8_t level = 0;
    };
    /// From one point of an item's hull to the next.
    struct Step {
        double slope = 0;  ///< benefit per picosecond
        double cost = 0;   ///< [ps]
        double benefit = 0;
        uint32_t item = 0;
        uint8_t level = 0;
        uint8_t serial = 0;  ///< among the item's steps
    };
    /// What is chosen, all together.
    struct Sum {
        uint64_t cost = 0;  ///< [ps]
        double benefit = 0;

        void add(const Point& point) {
            cost += static_cast<uint64_t>(point.cost);
            benefit += point.benefit;
        }
    };

    class Terms;

    Point pointOf(uint32_t index, uint8_t level) const;
    template <class Visit>
    void forEachPoint(uint32_t index, Visit&& visit) const;
    static size_t addToHull(Point* hull, size_t count, const Point& point);
    void buy(double high, double low);
    void addSteps(uint32_t index);
    double spend(std::span<uint8_t> chosen);
    void takeWhatFits(uint32_t index, std::span<uint8_t> chosen);
    bool search(std::span<uint8_t> chosen);
    void takeOneFirst(std::span<uint8_t> chosen);

    std::span<const LodItem> items_;  ///< of the call
    LodBudgetSettings settings_;
    uint64_t budget_ = 0;   ///< [ps]
    double reach_ = 1;      ///< steps are tried down to this part of the slope of the first that does not fit
    double price_ = 0;      ///< where the last search ended; 0: all that is of use fitted
    Array<uint8_t> dear_;   ///< per item: the level at the higher price
    Array<uint8_t> cheap_;  ///< per item: the level at the lower price
    Sum dear_sum_, cheap_sum_;
    Array<Step> steps_;       ///< between the two prices
    Array<uint8_t> blocked_;  ///< per item: a step of it did not fit
    Sum sum_;                 ///< of what is chosen so far
    Point most_;              ///< of all points of blocked items the one that is worth most
    uint32_t most_item_ = 0;
    bool has_fixed_ = false;  ///< one item has no choice
    uint32_t fixed_item_ = 0;
    Point fixed_;
};

}  // namespace sightline
