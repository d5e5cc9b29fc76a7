// The objects whose occluders one answer drew, so that the next one may draw them first.
// SPDX-License-Identifier: MIT
#include "sightline/run/last_drawn.h"

#include <algorithm>

namespace sightline::detail {

void LastDrawn::begin(const SnapshotState* now, bool wanted) {
    places_.clear();
    if (wanted && now) {
        for (const Noted& object : noted_) {
            const bool stays = object.place < now->placed.size() && now->placed[object.place].visible.id == object.id;
            const uint32_t place = stays ? object.place : now->placeOf(object.id);
            if (place != PlacedBvh::kNone) places_.push_back(place);
        }
    }
    noted_.clear();
    if (places_.empty()) return;
    if (++answer_ == 0) {
        std::fill(stamp_.begin(), stamp_.end(), 0);
        answer_ = 1;
    }
    if (stamp_.size() < now->placed.size()) stamp_.resize(now->placed.size(), 0);
    for (const uint32_t place : places_) stamp_[place] = answer_;
}

}  // namespace sightline::detail
