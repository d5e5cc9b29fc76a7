// The most useful levels of detail that a frame has time for.
// SPDX-License-Identifier: MIT
//
// Thomas Funkhouser, Carlo Sequin. Adaptive Display Algorithm for Interactive Frame Rates During Visualization of
// Complex Virtual Environments. 1993.
#pragma once

#include <cstdint>
#include <span>

#include "sightline/base/memory.h"
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
/// then what still fits is taken in the same order, within a limit of work. That is the greedy method for the
/// multiple-choice knapsack: it loses less than one step against the best choice of all. Where one step alone is worth
/// more than all others together, that one is taken first; so the choice is worth at least half of the best. Costs are
/// counted in whole picoseconds, so that sums are exact and the choice is the same everywhere. O(levels of all objects).
class LodBudget {
public:
    static constexpr uint8_t kLeftOut = LodItem::kNone;

    explicit LodBudget(Memory* memory = defaultMemory());

    /// @param chosen  receives a level per item, or kLeftOut  [size: items]
    LodBudgetResult choose(std::span<const LodItem> items, const LodBudgetSettings& settings,
                           std::span<uint8_t> chosen);

private:
    struct Step {
        float slope = 0;  ///< benefit per picosecond
        uint32_t item = 0;
        uint64_t cost = 0;  ///< [ps]
        uint8_t level = 0;
        uint8_t serial = 0;  ///< among the item's steps
    };
    /// The steps whose slopes are nearly the same.
    struct Bin {
        uint64_t cost = 0;  ///< [ps]
        uint32_t steps = 0;
    };

    /// What an item may be drawn as.
    struct Point {
        uint64_t cost = 0;  ///< [ps]
        double benefit = 0;
        uint8_t level = 0;
    };

    static Point pointOf(const LodItem& item, uint8_t level, const LodBudgetSettings& settings);
    static size_t addToHull(Point* hull, size_t count, const Point& point);
    void addItem(const LodItem& item, uint32_t index, const LodBudgetSettings& settings);
    void addSteps(std::span<const Point> hull, uint32_t index);
    void spend(std::span<uint8_t> chosen);
    void spendRest(std::span<uint8_t> chosen);
    void takeWhatFits(uint32_t index, std::span<uint8_t> chosen);
    void startAgain(std::span<uint8_t> chosen);
    double benefitOf(std::span<const uint8_t> chosen) const;

    std::span<const LodItem> items_;  ///< of the call
    LodBudgetSettings settings_;
    uint64_t budget_ = 0, sum_of_base_ = 0;  ///< [ps]
    Array<Step> steps_;
    Array<Step> rest_;        ///< from the bin on of which not all steps fit
    Array<Bin> bins_;         ///< the steepest first
    Array<uint8_t> blocked_;  ///< per item: a step of it did not fit
    Array<Point> base_;       ///< per item: what must be drawn of it
    uint64_t cost_ = 0;       ///< of what is chosen so far  [ps]
    double best_gain_ = 0;    ///< of one blocked item alone
    uint32_t best_item_ = 0;
    Point best_;
};

}  // namespace sightline
