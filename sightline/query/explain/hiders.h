// Which occluders hide an object: a minimal set that does so in a world of its own, and what each contributes.
// SPDX-License-Identifier: MIT
//
// Andreas Zeller, Ralf Hildebrandt. Simplifying and Isolating Failure-Inducing Input. 2002.
#pragma once

#include <cstdint>

#include "sightline/query/explain/asked_pixels.h"
#include "sightline/query/explain/attribution.h"
#include "sightline/query/explain/hider.h"
#include "sightline/query/explain/trial.h"

namespace sightline::detail {

/// Finds the hiders of one object after another. Keeps its scratch memory.
struct HiderSearch {
    explicit HiderSearch(Memory* from) : memory(from), trial(from), owners(from), candidates(from), set(from) {}

    /// An occluder that was drawn before the object was decided, over its rectangle.
    struct Candidate {
        uint32_t item = 0;
        uint64_t pixels = 0;    ///< of the rectangle that it owns
        uint32_t instance = 0;  ///< its place among those that were drawn
    };

    Memory* const memory;
    Trial trial;
    Attribution owners;
    AskedPixels asked{memory};
    /// The candidates of the state that is asked about; null: every object. Set before run().
    const Candidates* cells = nullptr;
    Candidates some{memory};      ///< of a world of some of its objects
    Array<Candidate> candidates;  ///< those that own most first
    Array<uint32_t> set;          ///< items

    /// @param decided  the trial in which the object was occluded, on `state`
    /// @param rect     of the object
    /// @param hiders   receives the set
    /// @returns OcclusionReason::sufficient
    bool run(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
             const Trial& decided, const PixelRect& rect, Array<Hider>& hiders);

    /// The occluders that own pixels of the rectangle that was culled.
    void own(const SnapshotState& state, uint32_t item, const Trial& decided, Array<Hider>& hiders);

private:
    const PixelRect& ask(const Trial& decided, const PixelRect& rect);
    void reportOwners(const SnapshotState& state, Array<Hider>& hiders) const;
    void collect(const SnapshotState& state, uint32_t item, const Trial& decided, const PixelRect& rect, bool anywhere);
    bool hides(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
               std::span<const uint32_t> with);
    bool hidesFirst(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
                    size_t count);
    void narrowTo(std::span<const uint32_t> items, const SnapshotState& world);
    bool shrink(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item);
    void share(const SnapshotState& state, const View& view, const QuerySettings& settings, uint32_t item,
               Array<Hider>& hiders);
};

}  // namespace sightline::detail
