// The stage of levels of detail: a level for each kept object, by its error and by what the budget has time for.
// SPDX-License-Identifier: MIT
//
// What a hard budget leaves out may be visible, and so it is counted apart. What it would have hidden stays culled: the
// image lacks the object, and shows nothing in its place that lies behind it.
#include <algorithm>
#include <cmath>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/math/stretch.h"
#include "sightline/stages/pipeline.h"
#include "sightline/stages/stage_memory.h"

namespace sightline::detail {
namespace {

LodRule ruleOf(const QuerySettings& settings) {
    LodRule rule;
    rule.error = std::max(settings.lod_error, 0.0);
    rule.hysteresis = std::clamp(settings.hysteresis, 0.0, 1.0);
    rule.fade = settings.lod_fade;
    return rule;
}

/// Under a budget levels may err by more than the rule says; they are faded all the same.
LodRule ruleOfFades(const QuerySettings& settings) {
    LodRule rule = ruleOf(settings);
    if (settings.budget > 0.0) rule.error = std::numeric_limits<double>::infinity();
    return rule;
}

/// The middle of the image counts in full, what lies at right angles to it half.
double focusOf(const LodMeasure& measure, const Box3d& box) {
    const glm::dvec3 centre = 0.5 * (box.min + box.max) - measure.eye;
    const double away = glm::length(centre);
    if (!measure.perspective || !(away > 0.0)) return 1.0;
    const double cosine = std::max(glm::dot(centre, measure.toward) / away, 0.0);
    return 0.5 + 0.5 * cosine * cosine;
}

}  // namespace

std::span<const LodLevel> LodMemory::levelsOf(const SnapshotState& world, uint32_t row) const {
    SIGHTLINE_DEBUG_ASSERT(row < world.objects.size() && world.objects[row].lods.index < world.lods.size());
    const HeldLods* held = world.lods[world.objects[row].lods.index].get();
    return held ? std::span<const LodLevel>(held->levels) : std::span<const LodLevel>();
}

/// Notes an object of the answer: how large its errors look, and what the rule asks of it.
void LodMemory::ask(std::span<const Frame* const> frames, const Visible& object) {
    const Frame& frame = *frames[0];
    const SnapshotState& world = *frame.world;
    Asked asked;
    asked.row = world.find(object.id);
    SIGHTLINE_DEBUG_ASSERT(asked.row != IdSlot::kNowhere);
    const ObjectRecord& record = world.objects[asked.row];
    const uint32_t place = world.bvh.placeOf(asked.row);
    LodItem item;
    item.levels = levelsOf(world, asked.row);
    item.importance = record.limits.factor > 0.0 ? record.limits.factor : 1.0;
    item.always = record.limits.always || place == PlacedBvh::kNone;
    asked.unit = std::numeric_limits<double>::infinity();
    if (place != PlacedBvh::kNone) {
        const Box3d box = frame.boundsAt(place);
        double unit = 0.0, focus = 0.0;
        for (const Frame* eye : frames) {
            unit = std::max(unit, pixelsOfUnit(eye->lods, box));
            if (!(frame.settings.budget > 0.0)) continue;
            item.pixels = std::max(item.pixels, pixelsOfBox(eye->lods, box));
            focus = std::max(focus, focusOf(eye->lods, box));
        }
        if (!item.levels.empty()) asked.unit = largestStretch(record.transform) * unit;
        item.importance *= focus;
    } else {
        item.pixels = frame.lods.viewport;
    }
    if (object.id.index < remembered_.size() && !frame.settings.stateless) {
        const Remembered& last = remembered_[object.id.index];
        asked.known = last.generation == object.id.generation && last.answer + 1 == answer_ &&
                      last.state.level < std::max<size_t>(item.levels.size(), 1);
        if (asked.known) asked.last = last.state;
    }
    asked.range = lodRange(item.levels, asked.unit, ruleOf(frame.settings), asked.known);
    item.pixels_of_unit = asked.unit;
    item.finest = levelIn(asked.range, asked.last.level);
    if (!asked.known) item.finest = asked.range.coarsest;
    item.last = asked.known ? asked.last.level : LodItem::kNone;
    SIGHTLINE_DEBUG_ASSERT(item.finest < std::max<size_t>(item.levels.size(), 1));
    asked_.push_back(asked);
    items_.push_back(item);
    chosen_.push_back(item.finest);
}

void LodMemory::spendBudget(const QuerySettings& settings, bool may_leave_out, QueryStats& stats) {
    LodBudgetSettings budget;
    budget.nanoseconds = 1e6 * settings.budget;
    budget.hard = settings.hard_budget && may_leave_out;
    budget.error = settings.lod_error > 0.0 ? settings.lod_error : 1.0;
    budget.hysteresis = std::clamp(settings.hysteresis, 0.0, 1.0);
    budget.cost = drawCost(settings);
    const LodBudgetResult result = budget_.choose(items_, budget, chosen_);
    stats.lod_cost = static_cast<uint64_t>(std::llround(std::min(result.cost, 1e18)));
    stats.lod_exceeded = result.exceeded;
}

/// Lets one more answer pass for each object, and takes those away that there is no time for.
void LodMemory::settle(const Frame& frame, Array<Visible>& visible, QueryStats& stats) {
    const LodRule rule = ruleOfFades(frame.settings);
    SIGHTLINE_DEBUG_ASSERT(asked_.size() == visible.size() && items_.size() == visible.size() &&
                           chosen_.size() == visible.size());
    SIGHTLINE_DEBUG_ASSERT(lods_.empty() && culled_.empty());
    size_t left = 0;
    for (size_t i = 0; i < visible.size(); ++i) {
        const Asked& asked = asked_[i];
        if (chosen_[i] == LodBudget::kLeftOut) {
            culled_.push_back(asked.row);
            continue;
        }
        const std::span<const LodLevel> levels = items_[i].levels;
        SIGHTLINE_DEBUG_ASSERT(chosen_[i] < std::max<size_t>(levels.size(), 1));
        LodState state{chosen_[i], chosen_[i], 0};
        if (asked.known) state = nextState(asked.last, chosen_[i], levels, asked.unit, rule);
        const ObjectId id = visible[i].id;
        if (id.index >= remembered_.size()) remembered_.resize(id.index + 1);
        remembered_[id.index] = {id.generation, answer_, state};
        lods_.push_back(visibleLod(state, levels, asked.unit, ruleOf(frame.settings)));
        if (levels.size() > 1) {
            stats.lod_finest += levels[0].triangles;
            stats.lod_triangles += levels[state.level].triangles;
            if (state.left > 0) {
                stats.lod_triangles += levels[state.from].triangles;
                ++stats.lod_fading;
            }
        }
        visible[left++] = visible[i];
    }
    visible.resize(left);
    stats.of(Stage::kLod).culled = culled_.size();
    SIGHTLINE_DEBUG_ASSERT(stats.visible >= culled_.size() && lods_.size() == visible.size());
    stats.visible -= culled_.size();
}

void LodMemory::run(std::span<const Frame* const> frames, Array<Visible>& visible, QueryStats& stats) {
    SIGHTLINE_DEBUG_ASSERT(frames.size() == 1 || frames.size() == 2);
    const Frame& frame = *frames[0];
    SIGHTLINE_DEBUG_ASSERT(frame.world && frame.usable);
    ++answer_;
    items_.clear();
    asked_.clear();
    chosen_.clear();
    for (const Visible& object : visible) ask(frames, object);
    if (frame.settings.budget > 0.0) spendBudget(frame.settings, frames.size() == 1, stats);
    settle(frame, visible, stats);
}

void LodMemory::clear() {
    lods_.clear();
    culled_.clear();
}

void LodMemory::reasons(const SnapshotState& now, std::span<uint8_t> reasons) const {
    for (const uint32_t row : culled_) reasons[now.itemOf(row)] = 1 + static_cast<uint8_t>(Stage::kLod);
}

bool LodMemory::leftOut(uint32_t row) const { return std::find(culled_.begin(), culled_.end(), row) != culled_.end(); }

void chooseLods(const Frame& frame, StageMemory& memory, AnswerView& answer) {
    const Frame* const frames[] = {&frame};
    memory.lods.run(frames, answer.visible, answer.stats);
    answer.lods = memory.lods.lods();
}

}  // namespace sightline::detail
