// The most useful levels of detail that a frame has time for.
// SPDX-License-Identifier: MIT
#include "sightline/lod/lod_budget.h"

#include <algorithm>
#include <bit>
#include <cmath>

#include "sightline/base/assert.h"

namespace sightline {
namespace {

/// Bits of a positive float rise with it: bins by the exponent and the first bits behind it.
constexpr uint32_t kBinShift = 20;
constexpr uint32_t kBins = 0x7f800000u >> kBinShift;

/// The bin of a slope; the steepest come first.
uint32_t binOf(float slope) { return kBins - 1 - std::min(std::bit_cast<uint32_t>(slope) >> kBinShift, kBins - 1); }

/// So many steps, and the rest of their bin, are tried once not all fit.
constexpr size_t kMostTried = 256;

/// Costs beyond this stand for themselves: sums of 2^32 of them fit.
constexpr double kMostPicoseconds = 0x1p31;

uint64_t picoseconds(double nanoseconds) {
    const double picoseconds = 1e3 * nanoseconds + 0.5;
    return picoseconds < kMostPicoseconds ? static_cast<uint64_t>(std::max(picoseconds, 0.0))
                                          : static_cast<uint64_t>(kMostPicoseconds);
}

}  // namespace

LodBudget::LodBudget(Memory* memory) : steps_(memory), rest_(memory), bins_(memory), blocked_(memory), base_(memory) {}

LodBudget::Point LodBudget::pointOf(const LodItem& item, uint8_t level, const LodBudgetSettings& settings) {
    const double worth = item.importance * item.pixels;
    if (level == kLeftOut) return {0, 0.0, kLeftOut};
    if (item.levels.empty()) return {picoseconds(settings.cost.object), worth, 0};
    const LodLevel& of = item.levels[level];
    const double error = of.error * item.pixels_of_unit;
    double accuracy = of.error > 0.0 ? settings.error / (settings.error + error) : 1.0;
    if (!(accuracy > 0.0)) accuracy = 0.0;  // not a number, or hopeless
    if (level == item.last) accuracy *= 1.0 + settings.hysteresis;
    return {picoseconds(settings.cost.of(of, item.pixels)), worth * accuracy, level};
}

/// Puts a point behind the others of an upper hull; costs come in rising order.
/// @returns the number of points that are left
size_t LodBudget::addToHull(Point* hull, size_t count, const Point& point) {
    if (count > 0 && !(point.benefit > hull[count - 1].benefit)) return count;
    // A point that costs the same and is worth less, or lies below the line over it, is in the way.
    while (count > 0) {
        const Point& top = hull[count - 1];
        const auto run = static_cast<double>(point.cost - top.cost);
        if (run > 0 && count == 1) break;
        if (run > 0) {
            const Point& below = hull[count - 2];
            const double steep = (top.benefit - below.benefit) * run;
            if (steep > (point.benefit - top.benefit) * static_cast<double>(top.cost - below.cost)) break;
        }
        --count;
    }
    hull[count] = point;
    return count + 1;
}

/// Takes what must be drawn of an item, and notes the steps to what is better.
void LodBudget::addItem(const LodItem& item, uint32_t index, const LodBudgetSettings& settings) {
    Point hull[kMostLods + 1];
    size_t count = 0;
    const size_t levels = std::min<size_t>(item.levels.size(), kMostLods);
    if (settings.hard && !item.always && levels > 0) hull[count++] = pointOf(item, kLeftOut, settings);
    if (levels == 0) {
        hull[count++] = pointOf(item, 0, settings);
    } else {
        Point points[kMostLods];
        size_t made = 0;
        for (size_t level = levels; level-- > std::min<size_t>(item.finest, levels - 1);) {
            const Point point = pointOf(item, static_cast<uint8_t>(level), settings);
            size_t at = made++;  // finer levels cost more, as a rule
            for (; at > 0 && points[at - 1].cost > point.cost; --at) points[at] = points[at - 1];
            points[at] = point;
        }
        for (size_t i = 0; i < made; ++i) count = addToHull(hull, count, points[i]);
        if (count == 0) hull[count++] = points[0];
    }
    base_[index] = hull[0];
    addSteps({hull, count}, index);
}

void LodBudget::addSteps(std::span<const Point> hull, uint32_t index) {
    for (size_t i = 1; i < hull.size(); ++i) {
        Step step;
        step.item = index;
        step.level = hull[i].level;
        step.serial = static_cast<uint8_t>(i);
        step.cost = hull[i].cost - hull[i - 1].cost;
        const double gain = hull[i].benefit - hull[i - 1].benefit;
        step.slope = static_cast<float>(std::min(gain / static_cast<double>(step.cost), 1e38));
        steps_.push_back(step);
        Bin& bin = bins_[binOf(step.slope)];
        bin.cost += step.cost;
        ++bin.steps;
    }
}

/// A step of an item does not fit: of what lies below the hull the best that does is taken instead. Also notes what the
/// item would be worth if it came before all others.
void LodBudget::takeWhatFits(uint32_t index, std::span<uint8_t> chosen) {
    blocked_[index] = 1;
    const LodItem& item = items_[index];
    const Point now = pointOf(item, chosen[index], settings_);
    Point best = now;
    const uint64_t base = sum_of_base_ - base_[index].cost;
    for (size_t level = item.finest; level < std::min<size_t>(item.levels.size(), kMostLods); ++level) {
        const Point point = pointOf(item, static_cast<uint8_t>(level), settings_);
        if (point.benefit > best.benefit && cost_ - now.cost + point.cost <= budget_) best = point;
        if (point.benefit - base_[index].benefit > best_gain_ && base + point.cost <= budget_) {
            best_gain_ = point.benefit - base_[index].benefit;
            best_item_ = index;
            best_ = point;
        }
    }
    cost_ += best.cost - now.cost;
    chosen[index] = best.level;
}

/// Takes all steps of the bins before the first that does not fit as a whole, then what fits of the rest.
void LodBudget::spend(std::span<uint8_t> chosen) {
    uint32_t whole = 0;
    for (uint64_t sum = cost_; whole < kBins && sum + bins_[whole].cost <= budget_; ++whole) sum += bins_[whole].cost;
    uint32_t end = whole;
    for (size_t tried = 0; end < kBins && tried < kMostTried; ++end) tried += bins_[end].steps;
    rest_.clear();
    for (const Step& step : steps_) {
        const uint32_t bin = binOf(step.slope);
        if (bin < whole && !blocked_[step.item]) {
            chosen[step.item] = step.level;
            cost_ += step.cost;
        } else if (bin >= whole && bin < end) {
            rest_.push_back(step);
        }
    }
    spendRest(chosen);
}

void LodBudget::spendRest(std::span<uint8_t> chosen) {
    std::sort(rest_.begin(), rest_.end(), [](const Step& a, const Step& b) {
        if (a.slope != b.slope) return a.slope > b.slope;
        return a.item != b.item ? a.item < b.item : a.serial < b.serial;
    });
    for (const Step& step : rest_) {
        if (blocked_[step.item]) continue;
        if (cost_ + step.cost <= budget_) {
            chosen[step.item] = step.level;
            cost_ += step.cost;
        } else {
            takeWhatFits(step.item, chosen);
        }
    }
}

void LodBudget::startAgain(std::span<uint8_t> chosen) {
    cost_ = sum_of_base_;
    for (size_t i = 0; i < base_.size(); ++i) chosen[i] = base_[i].level;
    std::fill(blocked_.begin(), blocked_.end(), uint8_t{0});
}

double LodBudget::benefitOf(std::span<const uint8_t> chosen) const {
    double sum = 0;
    for (size_t i = 0; i < items_.size(); ++i) sum += pointOf(items_[i], chosen[i], settings_).benefit;
    return sum;
}

LodBudgetResult LodBudget::choose(std::span<const LodItem> items, const LodBudgetSettings& settings,
                                  std::span<uint8_t> chosen) {
    SIGHTLINE_ASSERT(chosen.size() >= items.size());
    items_ = items;
    settings_ = settings;
    steps_.clear();
    bins_.assign(kBins, {});
    base_.resize(items.size());
    blocked_.resize(items.size());
    sum_of_base_ = 0;
    double worth_of_base = 0;
    for (uint32_t i = 0; i < items.size(); ++i) {
        addItem(items[i], i, settings);
        sum_of_base_ += base_[i].cost;
        worth_of_base += base_[i].benefit;
    }
    const double limit = 1e3 * settings.nanoseconds;
    budget_ = limit < 0x1p62 ? static_cast<uint64_t>(std::max(limit, 0.0)) : uint64_t{1} << 62;
    startAgain(chosen);
    LodBudgetResult result;
    result.exceeded = cost_ > budget_;
    best_gain_ = 0;
    spend(chosen);
    result.benefit = benefitOf(chosen);
    if (worth_of_base + best_gain_ > result.benefit) {
        startAgain(chosen);
        blocked_[best_item_] = 1;
        chosen[best_item_] = best_.level;
        cost_ += best_.cost - base_[best_item_].cost;
        spend(chosen);
        result.benefit = benefitOf(chosen);
    }
    result.cost = 1e-3 * static_cast<double>(cost_);
    for (size_t i = 0; i < items.size(); ++i) result.left_out += chosen[i] == kLeftOut;
    return result;
}

}  // namespace sightline
