// One view's answer: its frame, a traversal for each part of its image, and the union of what these keep.
// SPDX-License-Identifier: MIT
//
// The argument. The strips of the image cover the buffer, and each strip's traversal is sound by itself for what lies in
// the strip: so an object that every strip passes over or hides has no visible point, and the answer is the union of
// theirs. Strips share nothing that is written. What each finds depends on the view and on how many strips there are, and
// so does the answer, for they are put together in their order.
#pragma once

#include <algorithm>
#include <span>

#include "sightline/frame/frame.h"
#include "sightline/frame/traversal_state.h"
#include "sightline/query/explain/hider.h"
#include "sightline/stages/pipeline.h"

namespace sightline::detail {

/// Of two reasons of Query::reasons() for one object, by two strips or two eyes, the one to tell: that of a stage that
/// culls what may be visible, for it may be; else the finer one.
inline uint8_t finerReason(uint8_t a, uint8_t b) {
    const auto isLossy = [](uint8_t reason) { return reason > 0 && (kLossyStages >> (reason - 1) & 1) != 0; };
    return isLossy(a) != isLossy(b) ? (isLossy(a) ? a : b) : std::max(a, b);
}

/// Keeps its scratch memory from answer to answer.
class Answer {
public:
    explicit Answer(Memory* memory);

    /// Takes up a view. Then run(part) once for each part, by any threads, and finish().
    /// @param shown     SizeLimits::shown; until all is run
    /// @param proposed  as Query::propose()
    void begin(const Snapshot& now, const View& view, const QuerySettings& settings,
               std::span<const uint32_t> shown = {}, std::span<const ObjectId> proposed = {});
    uint32_t parts() const { return count_; }
    /// As Query::learn().
    void learn(Answer& teacher) { parts_[0]->proofs.learn(teacher.parts_[0]->proofs); }
    /// Lets go of the snapshot that was asked last.
    void forget() {
        frame_.snapshot = {};
        frame_.world = nullptr;
        memory_of_stages_.cells.forget();
    }
    void run(uint32_t part);
    void finish();
    /// Lets the stages work that look at the whole answer, up to and with one of them.
    void refine(Stage last = Stage::kClusters);
    /// Notes how long the whole answer took.
    void timed(uint64_t nanoseconds);

    /// The answer. If there are several parts: nearest first, equally near objects in the hierarchy's order.
    Array<Visible>& visible() { return count_ == 1 ? parts_[0]->visible : merged_; }
    const Array<Visible>& visible() const { return count_ == 1 ? parts_[0]->visible : merged_; }
    QueryStats stats;

    const Frame& frame() const { return frame_; }
    const CellMemory& cells() const { return memory_of_stages_.cells; }
    ClusterMemory& clusters() { return memory_of_stages_.clusters; }
    const ClusterMemory& clusters() const { return memory_of_stages_.clusters; }
    LodMemory& lods() { return memory_of_stages_.lods; }
    const LodMemory& lods() const { return memory_of_stages_.lods; }
    AnswerView view() { return {visible(), stats, tiles_}; }

    /// As Query::reasons(). An object that one part hides and another part does not meet is hidden: finerReason().
    void reasons(std::span<uint8_t> reasons) const;
    /// The stage that culled an object in the first part of the image; kFrustum if none did.
    Stage reasonOf(ObjectId id) const;
    /// As Query::DepthImage has it.  [size: pixels of the buffer]
    void depthImage(Seams seams, std::span<float> nearness, std::span<uint8_t> covered);
    /// Whether a certificate culled an object in this answer, and the objects that it names.
    bool certificateOf(ObjectId id, Array<Visible>& out) const;
    bool certificateOf(ObjectId id, Array<HiderOutline>& outlines, Array<glm::dvec3>& corners) const;
    /// Whether an object of the answer was kept without a question by a part that kept it.
    bool wasUnasked(ObjectId id) const;
    uint32_t width() const { return parts_[0]->tiles.width; }
    uint32_t height() const { return parts_[0]->tiles.height; }

private:
    const Certificate* certificateFor(ObjectId id) const;
    bool countOnce(uint32_t place);
    void mergeVisible();
    void addStages();
    void learnFrom(QueryStats& from, size_t visible);
    void noteOff();
    void gatherHidden();
    void addHidden(const ProofMemory::Hidden& one);
    bool keepsAny(const PlaceRange& places) const;

    Memory* const memory_;
    Frame frame_;
    StageMemory memory_of_stages_;
    Array<Owned<TraversalState>> parts_;
    uint32_t count_ = 1;
    uint64_t choosing_ = 0;  ///< what begin() took  [nanoseconds]
    uint64_t choose_nanoseconds_[kStageCount] = {};
    Array<DepthTiles*> tiles_;  ///< of each part, if the view is usable
    Array<Visible> merged_;
    Array<uint32_t> counted_;  ///< per place: the last answer in which it was kept, or culled with those that follow it
    uint32_t answer_ = 0;
};

}  // namespace sightline::detail
