// A view cut into bins, strips of the buffer side by side: a walk for each, by any thread, and one answer of them all.
// SPDX-License-Identifier: MIT
//
// The argument. The windows of the bins cover the buffer, and each bin's walk is sound by itself for what lies in its
// window: so an object that every bin passes over or hides has no visible point, and the answer is the union of theirs.
// Bins share nothing that is written. What each finds hangs on the view and on how many bins there are, and so does the
// answer, for they are put together in their order.
#pragma once

#include <span>

#include "sightline/run/cell_stages.h"
#include "sightline/run/walk.h"

namespace sightline::detail {

/// The walks of one view: a single one, or one for each of its bins. What they need stays from answer to answer.
class BinnedWalk {
public:
    explicit BinnedWalk(Memory* memory);

    /// Takes up a view. Then run(bin) once for each bin, by any threads, and finish().
    /// @param now    outlives the answer; null: there is none
    /// @param shown  SizeStages::shown; until all is run
    void begin(const Snapshot& now, const View& view, std::span<const uint32_t> shown = {});
    uint32_t bins() const { return count_; }
    void run(uint32_t bin);
    void finish();
    /// Notes how long the whole answer took.
    void timed(uint64_t nanoseconds);

    /// The answer. Of several bins nearest first, of equally near ones in the hierarchy's order.
    Array<Visible>& visible() { return count_ == 1 ? walks_[0]->visible : merged_; }
    const Array<Visible>& visible() const { return count_ == 1 ? walks_[0]->visible : merged_; }
    QueryStats stats;  ///< of bins the sums, but for the counts of objects that were kept and culled

    /// As Query::reasons(). What one bin hides and another passes over is hidden; the finer stage stands for both.
    void reasons(std::span<uint8_t> reasons) const;
    /// As Query::DepthImage has it.  [size: pixels of the buffer]
    void depthImage(Seams seams, std::span<float> nearness, std::span<uint8_t> covered);
    /// The buffer of a view in one bin.
    DepthTiles* tiles() { return &walks_[0]->tiles; }
    const Screen& screen() const { return walks_[0]->screen; }
    /// What the cells left to the walks.
    const CellStages& cells() const { return cells_; }
    const Admission* admission() const { return admission_; }
    uint32_t width() const { return walks_[0]->tiles.width; }
    uint32_t height() const { return walks_[0]->tiles.height; }

private:
    StageStats& of(Stage stage) { return stats.stages[static_cast<int>(stage)]; }
    void addWalk();
    void balance();
    void gatherWork();
    bool meet(uint32_t place);
    void mergeVisible();
    void countCulled();
    void addCells();

    Memory* const memory_;
    Array<Owned<Walk>> walks_;
    CellStages cells_;
    const Admission* admission_ = nullptr;
    uint64_t before_ = 0;  ///< what begin() took  [nanoseconds]
    uint32_t count_ = 1;
    Bin cuts_[kMostBins];  ///< of count_ bins, if there are several
    Array<double> work_;   ///< of the last answer of several bins, with View::balance_bins: per column
    const SnapshotState* now_ = nullptr;
    View view_;
    Array<Visible> merged_;
    Array<uint32_t> met_;  ///< per place: the last answer in which it was kept, or culled with those that follow it
    uint32_t answer_ = 0;
};

}  // namespace sightline::detail
