// The objects whose occluders one answer drew, so that the next one may draw them first.
// SPDX-License-Identifier: MIT
//
// Ned Greene, Michael Kass, Gavin Miller. Hierarchical Z-Buffer Visibility. 1993 (temporal coherence).
#pragma once

#include <cstdint>
#include <memory>
#include <span>

#include "sightline/run/world_state.h"

namespace sightline::detail {

/// What a query remembers from answer to answer. Any object of the world may hide in any frame, whether it is seen or
/// not: what lies behind it lies behind what hides it, too. So a memory that is out of date costs time and tightness,
/// and never more.
class LastDrawn {
public:
    explicit LastDrawn(Memory* memory) : noted_(memory), places_(memory), stamp_(memory) {}

    /// A new answer begins. What the last one noted becomes places(), if it is wanted: objects that are no more are left
    /// out. O(noted).
    /// @param now  null: all is forgotten
    void begin(const SnapshotState* now, bool wanted);
    /// The answer keeps this object, and it is large enough to hide something.
    void note(uint32_t place, ObjectId id) { noted_.push_back({place, id}); }

    /// Of the last answer, nearest first as it was then.
    std::span<const uint32_t> places() const { return places_; }
    bool has(uint32_t place) const { return !places_.empty() && stamp_[place] == answer_; }

private:
    struct Noted {
        uint32_t place = 0;  ///< as it was then
        ObjectId id;
    };
    Array<Noted> noted_;
    Array<uint32_t> places_;
    Array<uint32_t> stamp_;  ///< per place: the last answer that had it in places()
    uint32_t answer_ = 0;
};

}  // namespace sightline::detail
