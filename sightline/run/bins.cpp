// A view cut into bins, strips of the buffer side by side: a walk for each, by any thread, and one answer of them all.
// SPDX-License-Identifier: MIT
#include "sightline/run/bins.h"

#include <algorithm>
#include <bit>
#include <chrono>
#include <limits>

#include "sightline/base/assert.h"
#include "sightline/geom/depth_order.h"
#include "sightline/raster/depth_image.h"

namespace sightline::detail {
namespace {

/// Adds what another bin did.
void addWork(const QueryStats& from, QueryStats& to) {
    for (int stage = 0; stage < kStageCount; ++stage) to.stages[stage].nanoseconds += from.stages[stage].nanoseconds;
    for (auto count :
         {&QueryStats::nodes_visited, &QueryStats::occluder_triangles, &QueryStats::seam_pixels,
          &QueryStats::closed_gaps, &QueryStats::faces_tested, &QueryStats::faces_culled, &QueryStats::second_looks,
          &QueryStats::second_look_culled, &QueryStats::second_look_polygons, &QueryStats::nanoseconds})
        to.*count += from.*count;
    to.budget_spent |= from.budget_spent;
    to.second_look_spent |= from.second_look_spent;
}

}  // namespace

uint32_t binCount(const View& view) {
    const uint32_t both = stageBit(Stage::kFrustum) | stageBit(Stage::kOcclusion);
    if (view.bins < 2 || (stagesInUse(view) & both) != both || !isUsable(view) || !runsOutward(view)) return 1;
    return std::clamp(makeScreen(view, view.occlusion_size).width / 8, 1u, std::min(view.bins, kMostBins));
}

Bin binOf(uint32_t index, uint32_t count, uint32_t columns) {
    const auto border = [&](uint64_t i) { return static_cast<uint32_t>(columns * i / count); };
    return {index, count, border(index), border(index + 1)};
}

/// Spreads work evenly over the columns of a rectangle; of what has none, over all that are walked.
void Walk::countWork(PixelRect rect, bool on_screen, double cost) {
    if (!on_screen) rect = {0, 0, static_cast<int32_t>(8 * tiles.columns) - 1, 0, 0};
    if (!tiles.clip(rect)) return;
    const uint32_t first = static_cast<uint32_t>(rect.x0) / 8, end = static_cast<uint32_t>(rect.x1) / 8 + 1;
    work[first] += cost / (end - first);
    work[end] -= cost / (end - first);
}

/// Of a bin: whether a box surely lies beside it. The outermost bins reach beyond the buffer.
bool Walk::liesBeside(const Screen& from, const Box3f& box) const {
    const double left = 8.0 * tiles.first_column, right = 8.0 * tiles.end_column;
    return (bin.index > 0 && isLeftOf(from, box, left)) || (bin.index + 1 < bin.count && isRightOf(from, box, right));
}

bool Walk::isBeside(const BoxAnswer& on_screen, const Screen& from, const Box3f& box) const {
    if (on_screen.doubt) return liesBeside(from, box);
    PixelRect rect = on_screen.rect;
    return !tiles.clip(rect);
}

/// Of a bin: the children of a node that lie beside it.
uint32_t Walk::findBeside(const ScreenAnswer& on_screen, const EyeBoxes& boxes, uint32_t of) const {
    uint32_t beside = 0;
    for (of &= ~on_screen.outside; of; of &= of - 1) {
        const int slot = std::countr_zero(of);
        Box3f box;
        for (int axis = 0; axis < 3; ++axis) {
            box.min[axis] = boxes.min[axis][slot];
            box.max[axis] = boxes.max[axis][slot];
        }
        beside |= uint32_t{isBeside(BoxAnswer(on_screen, slot), screen, box)} << slot;
    }
    return beside;
}

BinnedWalk::BinnedWalk(Memory* memory)
    : memory_(memory), walks_(memory), cells_(memory), work_(memory), merged_(memory), met_(memory) {
    addWalk();
}

void BinnedWalk::addWalk() {
    walks_.push_back(makeOwned<Walk>(memory_, memory_));
    walks_.back()->remembers = true;
}

void BinnedWalk::begin(const Snapshot& now, const View& view, std::span<const uint32_t> shown) {
    const auto start = std::chrono::steady_clock::now();
    now_ = now ? &now.state() : nullptr;
    view_ = view;
    count_ = now ? binCount(view) : 1;
    while (walks_.size() < count_) addWalk();
    admission_ = cells_.run(now, view);
    for (auto& walk : walks_) {
        walk->sizes.shown = shown;
        walk->admission = admission_;
    }
    before_ = static_cast<uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start).count());
    merged_.clear();
    if (count_ == 1) return;
    const uint32_t columns = makeScreen(view, view.occlusion_size).width / 8;
    for (uint32_t bin = 0; bin < count_; ++bin) cuts_[bin] = binOf(bin, count_, columns);
    if (view.balance_bins && work_.size() == columns) balance();
}

/// Cuts where the work so far is in equal shares. No bin is less than a column wide, or much wider than it would be.
void BinnedWalk::balance() {
    double all = 0, sum = 0;
    for (const double work : work_) all += work;
    const uint32_t columns = static_cast<uint32_t>(work_.size());
    if (!(all > 0)) return;
    for (uint32_t column = 0, bin = 0; column < columns && bin + 1 < count_; ++column) {
        sum += work_[column];
        const uint32_t left = columns - (column + 1);  // beyond the cut, at least one for each further bin
        const bool full = sum * count_ >= all * (bin + 1) - 0.5 * work_[column] * count_;
        if (!full && left >= count_ - bin) continue;
        cuts_[bin].end_column = cuts_[bin + 1].first_column = column + 1;
        ++bin;
    }
}

/// Adds up what the bins did, column by column.
void BinnedWalk::gatherWork() {
    const Walk& first = *walks_[0];
    work_.assign(first.tiles.columns, 0.0);
    for (uint32_t bin = 0; bin < count_; ++bin) {
        double here = 0;
        for (uint32_t column = 0; column < first.tiles.columns; ++column) {
            here += walks_[bin]->work[column];
            work_[column] += std::max(here, 0.0);
        }
    }
}

void BinnedWalk::run(uint32_t bin) {
    const auto start = std::chrono::steady_clock::now();
    walks_[bin]->run(now_, view_, count_ == 1 ? Bin() : cuts_[bin]);
    walks_[bin]->stats.nanoseconds = static_cast<uint64_t>(
        std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::steady_clock::now() - start).count());
}

/// Notes a place; false if it has been in this answer.
bool BinnedWalk::meet(uint32_t place) {
    if (met_[place] == answer_) return false;
    met_[place] = answer_;
    return true;
}

/// Each object that a bin keeps, once.
void BinnedWalk::mergeVisible() {
    uint32_t at[kMostBins] = {};
    for (;;) {
        uint32_t best = count_;
        for (uint32_t bin = 0; bin < count_; ++bin) {
            if (at[bin] == walks_[bin]->kept.size()) continue;
            if (best == count_) {
                best = bin;
                continue;
            }
            const KeptObject &here = walks_[bin]->kept[at[bin]], &there = walks_[best]->kept[at[best]];
            if (here.nearness != there.nearness ? here.nearness > there.nearness : here.place < there.place) best = bin;
        }
        if (best == count_) return;
        const Walk& walk = *walks_[best];
        const uint32_t next = at[best]++;
        if (!meet(walk.kept[next].place)) continue;
        merged_.push_back(walk.visible[next]);
        of(Stage::kOcclusion).doubt += walk.kept[next].nearness == std::numeric_limits<float>::infinity();
    }
}

/// The nodes and objects that the stages before occlusion cull are the same for all bins that meet them; the rest of
/// what is not kept is occluded.
void BinnedWalk::countCulled() {
    for (uint32_t bin = 0; bin < count_; ++bin)
        for (const CulledRange& range : walks_[bin]->culled)
            if (range.stage != Stage::kOcclusion && meet(range.places.first))
                of(range.stage).culled += walks_[bin]->inLayers(range.places);
    if (admission_)
        for (const Stage stage : {Stage::kPvs, Stage::kPortals}) of(stage).culled += admission_->culled(stage);
    uint64_t left = stats.objects;
    for (int i = 0; i < kStageCount; ++i) {
        const Stage stage = static_cast<Stage>(i);
        if (stage == Stage::kOcclusion) of(stage).culled = left - stats.visible;
        of(stage).tested = walks_[0]->uses(stage) ? left : 0;
        left -= of(stage).culled;
    }
}

/// What the stages of cells did.
void BinnedWalk::addCells() {
    for (const Stage stage : {Stage::kPvs, Stage::kPortals}) {
        of(stage).doubt = cells_.doubt(stage);
        if (view_.time_stages) of(stage).nanoseconds = cells_.nanoseconds(stage);
    }
    stats.nanoseconds += before_;
}

void BinnedWalk::finish() {
    stats = walks_[0]->stats;
    if (count_ == 1) return addCells();
    if (view_.balance_bins) gatherWork();
    of(Stage::kOcclusion).doubt = 0;
    for (StageStats& stage : stats.stages) stage.culled = 0;
    for (uint32_t bin = 1; bin < count_; ++bin) addWork(walks_[bin]->stats, stats);
    if (met_.size() < now_->placed.size()) met_.resize(now_->placed.size(), 0);
    if (++answer_ == 0) {
        std::fill(met_.begin(), met_.end(), 0);
        answer_ = 1;
    }
    for (const uint32_t row : now_->unbounded) {
        const ObjectRecord& object = now_->objects[row];
        if (!(object.layers & view_.layers)) continue;
        merged_.push_back({object.key, object.id});
        ++of(Stage::kFrustum).doubt;
    }
    mergeVisible();
    stats.visible = merged_.size();
    countCulled();
    addCells();
}

void BinnedWalk::timed(uint64_t nanoseconds) {
    if (view_.time_stages && walks_[0]->uses(Stage::kOcclusion)) {
        uint64_t others = 0;
        for (int stage = 0; stage < static_cast<int>(Stage::kOcclusion); ++stage)
            others += stats.stages[stage].nanoseconds;
        of(Stage::kOcclusion).nanoseconds = stats.nanoseconds - others;
    }
    stats.nanoseconds = nanoseconds;
}

void BinnedWalk::reasons(std::span<uint8_t> reasons) const {
    if (count_ == 1) return walks_[0]->reasons(reasons);
    SIGHTLINE_ASSERT(reasons.size() >= now_->count);
    std::fill(reasons.begin(), reasons.end(), uint8_t{0});
    if (admission_) notAdmitted(*now_, *admission_, reasons);
    const auto at = [&](uint32_t place) -> uint8_t& { return reasons[now_->itemAt(place)]; };
    for (uint32_t bin = 0; bin < count_; ++bin)
        for (const CulledRange& range : walks_[bin]->culled)
            for (uint32_t place = range.places.first; place < range.places.first + range.places.count; ++place)
                if (now_->bvh.order[place] != PlacedBvh::kNone && (!admission_ || admission_->admits(place)))
                    at(place) = std::max(at(place), static_cast<uint8_t>(1 + static_cast<int>(range.stage)));
    for (uint32_t bin = 0; bin < count_; ++bin)
        for (const KeptObject& object : walks_[bin]->kept) at(object.place) = 0;
    for (uint32_t item = 0; item < now_->count; ++item)
        if (!(now_->object(item).layers & view_.layers)) reasons[item] = 255;
}

void BinnedWalk::depthImage(Seams seams, std::span<float> nearness, std::span<uint8_t> covered) {
    for (uint32_t bin = 0; bin < count_; ++bin) readDepthImage(walks_[bin]->tiles, seams, nearness, covered, 0.0f);
}

}  // namespace sightline::detail
