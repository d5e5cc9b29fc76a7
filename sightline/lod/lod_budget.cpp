// The most useful levels of detail that a frame has time for.
// SPDX-License-Identifier: MIT
#include "sightline/lod/lod_budget.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

/// Costs beyond this stand for themselves: sums of 2^32 of them fit.
constexpr double kMostPicoseconds = 0x1p31;
constexpr double kMostWorth = 1e30;  // nothing is worth more
constexpr double kDearest = 4e30;    // at this price only what must be drawn is bought
/// So much above the expected price the search begins.
constexpr double kMargin = 1.06;
constexpr int kMostSearches = 100;

/// A whole number; what is none is the most.
double picoseconds(double nanoseconds) {
    return static_cast<double>(static_cast<int64_t>(std::min(kMostPicoseconds, 1e3 * nanoseconds + 0.5)));
}

/// Within [0, most]; what is no number is `otherwise`.
double within(double value, double most, double otherwise) {
    return value >= 0.0 ? std::min(value, most) : value < 0.0 ? 0.0 : otherwise;
}

}  // namespace

LodBudget::LodBudget(Memory* memory) : dear_(memory), cheap_(memory), steps_(memory), blocked_(memory) {}

/// What the points of an item are computed from. Without branches: which of them would be taken nobody can predict.
class LodBudget::Terms {
public:
    Terms(const LodItem& item, const LodBudgetSettings& settings)
        : item_(item),
          settings_(settings),
          worth_(within(item.importance * item.pixels, kMostWorth, 0.0)),
          unit_(within(item.pixels_of_unit, kMostWorth, kMostWorth)),
          kept_{1.0, 1.0 + settings.hysteresis} {}

    Point at(uint8_t level) const {
        if (level == kLeftOut) return {0, 0.0, kLeftOut};
        if (item_.levels.empty()) return {picoseconds(settings_.cost.object), worth_, 0};
        const LodLevel& of = item_.levels[level];
        const double accuracy = settings_.error / (settings_.error + of.error * unit_) * kept_[level == item_.last];
        // The other way round, what is no number would stay one.
        return {picoseconds(settings_.cost.of(of, item_.pixels)), worth_ * std::max(0.0, accuracy), level};
    }

    /// Visits all that the item may be drawn as, the coarsest first.
    template <class Visit>
    void forEach(Visit&& visit) const {
        const size_t levels = std::min<size_t>(item_.levels.size(), kMostLods);
        if (levels == 0) return visit(at(0));
        if (settings_.hard && !item_.always) visit(at(kLeftOut));
        for (size_t level = levels; level-- > std::min<size_t>(item_.finest, levels - 1);)
            visit(at(static_cast<uint8_t>(level)));
    }

private:
    const LodItem& item_;
    const LodBudgetSettings& settings_;
    double worth_, unit_;
    double kept_[2];
};

LodBudget::Point LodBudget::pointOf(uint32_t index, uint8_t level) const {
    if (has_fixed_ && index == fixed_item_) return fixed_;
    return Terms(items_[index], settings_).at(level);
}

template <class Visit>
void LodBudget::forEachPoint(uint32_t index, Visit&& visit) const {
    if (has_fixed_ && index == fixed_item_) return visit(fixed_);
    Terms(items_[index], settings_).forEach(visit);
}

/// What each item takes at two prices: the point that is worth most, less what it costs there. Of points that are worth
/// the same the first is taken.
void LodBudget::buy(double high, double low) {
    dear_sum_ = cheap_sum_ = {};
    for (uint32_t i = 0; i < items_.size(); ++i) {
        Point points[kMostLods + 1];
        size_t count = 0, dear = 0, cheap = 0;
        double dear_value = -std::numeric_limits<double>::infinity(), cheap_value = dear_value;
        forEachPoint(i, [&](const Point& point) {
            const double at_high = point.benefit - high * point.cost, at_low = point.benefit - low * point.cost;
            dear = at_high > dear_value ? count : dear;
            dear_value = std::max(dear_value, at_high);
            cheap = at_low > cheap_value ? count : cheap;
            cheap_value = std::max(cheap_value, at_low);
            points[count++] = point;
        });
        dear_[i] = points[dear].level;
        cheap_[i] = points[cheap].level;
        dear_sum_.add(points[dear]);
        cheap_sum_.add(points[cheap]);
    }
}

/// Puts a point behind the others of an upper hull; costs come in rising order.
/// @returns the number of points that are left
size_t LodBudget::addToHull(Point* hull, size_t count, const Point& point) {
    if (count > 0 && !(point.benefit > hull[count - 1].benefit)) return count;
    // A point that costs the same and is worth less, or lies below the line over it, is in the way.
    while (count > 0) {
        const Point& top = hull[count - 1];
        const double run = point.cost - top.cost;
        if (run > 0 && count == 1) break;
        if (run > 0) {
            const Point& below = hull[count - 2];
            const double steep = (top.benefit - below.benefit) * run;
            if (steep > (point.benefit - top.benefit) * (top.cost - below.cost)) break;
        }
        --count;
    }
    hull[count] = point;
    return count + 1;
}

/// Adds an item's steps from what it takes at the higher price to what it takes at the lower.
void LodBudget::addSteps(uint32_t index) {
    const Point from = pointOf(index, dear_[index]), to = pointOf(index, cheap_[index]);
    Point points[kMostLods + 1];
    size_t made = 0;
    forEachPoint(index, [&](const Point& point) {
        if (point.cost < from.cost || point.cost > to.cost) return;
        size_t at = made++;  // finer levels cost more, as a rule
        for (; at > 0 && points[at - 1].cost > point.cost; --at) points[at] = points[at - 1];
        points[at] = point;
    });
    Point hull[kMostLods + 1] = {from};
    size_t count = 1;
    for (size_t i = 0; i < made; ++i) count = addToHull(hull, count, points[i]);
    for (size_t i = 1; i < count; ++i) {
        Step step;
        step.item = index;
        step.level = hull[i].level;
        step.serial = static_cast<uint8_t>(i);
        step.cost = hull[i].cost - hull[i - 1].cost;
        step.benefit = hull[i].benefit - hull[i - 1].benefit;
        step.slope = std::min(step.benefit / step.cost, kMostWorth);
        steps_.push_back(step);
    }
}

/// A step of an item does not fit: of what lies below the hull the best that does is taken instead. Also notes what of
/// the item would fit if it came first.
void LodBudget::takeWhatFits(uint32_t index, std::span<uint8_t> chosen) {
    blocked_[index] = 1;
    const Point now = pointOf(index, chosen[index]);
    const uint64_t others = sum_.cost - static_cast<uint64_t>(now.cost);
    Point best = now;
    forEachPoint(index, [&](const Point& point) {
        const auto cost = static_cast<uint64_t>(point.cost);
        if (point.benefit > best.benefit && others + cost <= budget_) best = point;
        if (point.benefit > most_.benefit && cost <= budget_) {
            most_ = point;
            most_item_ = index;
        }
    });
    sum_.cost = others + static_cast<uint64_t>(best.cost);
    sum_.benefit += best.benefit - now.benefit;
    chosen[index] = best.level;
}

/// Takes what all take at the higher price, and then the steps that fit.
/// @returns the slope of the first step that does not fit; 0: all steps fit
double LodBudget::spend(std::span<uint8_t> chosen) {
    std::copy(dear_.begin(), dear_.end(), chosen.begin());
    sum_ = dear_sum_;
    steps_.clear();
    for (uint32_t i = 0; i < items_.size(); ++i)
        if (dear_[i] != cheap_[i]) addSteps(i);
    std::sort(steps_.begin(), steps_.end(), [](const Step& a, const Step& b) {
        if (a.slope != b.slope) return a.slope > b.slope;
        return a.item != b.item ? a.item < b.item : a.serial < b.serial;
    });
    std::fill(blocked_.begin(), blocked_.end(), uint8_t{0});
    most_ = {};
    double first = 0;
    for (const Step& step : steps_) {
        if (step.slope < reach_ * first) break;
        if (blocked_[step.item]) continue;
        if (sum_.cost + static_cast<uint64_t>(step.cost) <= budget_) {
            chosen[step.item] = step.level;
            sum_.cost += static_cast<uint64_t>(step.cost);
            sum_.benefit += step.benefit;
        } else {
            if (first == 0) first = step.slope;
            takeWhatFits(step.item, chosen);
        }
    }
    return first;
}

/// Finds two prices between which the money runs out, and spends it.
/// @returns whether what must be drawn fits
bool LodBudget::search(std::span<uint8_t> chosen) {
    double too_low = 0, too_high = 0, factor = 1.5;  // what is known of the price, and how far the next guess goes
    const auto next = [&] {
        if (too_low > 0 && too_high > 0) return std::sqrt(too_low) * std::sqrt(too_high);
        factor *= factor;
        if (too_high > 0) return factor < 1e6 ? too_high / factor : 0.0;
        return std::min(too_low * factor, kDearest);
    };
    double price = price_;
    for (int searches = 0;; ++searches) {
        const bool is_last = searches == kMostSearches;
        const double high = is_last ? kDearest : std::min(kMargin * price, kDearest);
        const double low = is_last ? 0.0 : reach_ * price / kMargin;
        buy(high, low);
        if (dear_sum_.cost > budget_) {
            if (high >= kDearest) {
                std::copy(dear_.begin(), dear_.end(), chosen.begin());
                sum_ = dear_sum_;
                return false;
            }
            too_low = high;
            // Where all that is of use is too much, its mean worth is a first guess.
            if (high > 0) price = next();
            else price = std::max(dear_sum_.benefit / static_cast<double>(dear_sum_.cost), 1e-30);
            continue;
        }
        // Where all of it fits, there is nothing to sort.
        const double first = low > 0 && cheap_sum_.cost <= budget_ ? 0.0 : spend(chosen);
        if (first > 0 && reach_ * first >= low) {
            price_ = first;
            return true;
        }
        if (first == 0 && low == 0) {
            price_ = 0;
            return true;
        }
        if (first > 0) {
            price = first;
        } else {
            too_high = low;
            price = next();
        }
    }
}

/// One object may be worth more than all others together, and not fit behind them.
void LodBudget::takeOneFirst(std::span<uint8_t> chosen) {
    const double before = sum_.benefit;
    if (most_.benefit <= 0.5 * before) return;
    const Point most = most_;
    fixed_item_ = most_item_;
    fixed_ = most;
    has_fixed_ = true;
    if (search(chosen) && sum_.benefit > before) {
        has_fixed_ = false;
        return;
    }
    has_fixed_ = false;
    search(chosen);
}

LodBudgetResult LodBudget::choose(std::span<const LodItem> items, const LodBudgetSettings& settings,
                                  std::span<uint8_t> chosen) {
    SIGHTLINE_ASSERT(chosen.size() >= items.size());
    items_ = items;
    settings_ = settings;
    for (Array<uint8_t>* list : {&dear_, &cheap_, &blocked_}) list->resize(items.size());
    const double limit = 1e3 * settings.nanoseconds;
    budget_ = limit < 0x1p62 ? static_cast<uint64_t>(std::max(limit, 0.0)) : uint64_t{1} << 62;
    // The fewer there are, the more a step that does not fit leaves, and the less it takes to try others.
    reach_ = 1.0 / (1.1 + 64.0 / static_cast<double>(items.size() + 1));
    LodBudgetResult result;
    result.exceeded = !search(chosen);
    if (!result.exceeded) takeOneFirst(chosen);
    result.cost = 1e-3 * static_cast<double>(sum_.cost);
    result.benefit = sum_.benefit;
    for (size_t i = 0; i < items.size(); ++i) result.left_out += chosen[i] == kLeftOut;
    return result;
}

}  // namespace sightline
