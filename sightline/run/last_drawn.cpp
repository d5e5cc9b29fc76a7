// The objects whose occluders one answer drew, so that the next one may draw them first.
// SPDX-License-Identifier: MIT
#include "sightline/run/last_drawn.h"

#include <algorithm>
#include <utility>

namespace sightline::detail {

void LastDrawn::begin(const SnapshotState* now, bool wanted) {
    const Placed before = std::exchange(noted_in_, now ? now->placed : nullptr);
    std::swap(noted_, places_);
    noted_.clear();
    if (!wanted || !now || !before) return places_.clear();
    if (before != noted_in_) translate(*before, *noted_in_);
    if (++answer_ == 0) {
        std::fill(stamp_.begin(), stamp_.end(), 0);
        answer_ = 1;
    }
    if (stamp_.size() < noted_in_->size()) stamp_.resize(noted_in_->size(), 0);
    for (const uint32_t place : places_) stamp_[place] = answer_;
}

void LastDrawn::translate(const Array<PlacedObject>& from, const Array<PlacedObject>& to) {
    uint32_t last = 0;
    for (const PlacedObject& object : to) last = std::max(last, object.visible.id.index);
    place_of_.assign(last + 1, 0);
    for (uint32_t place = 0; place < to.size(); ++place) place_of_[to[place].visible.id.index] = place + 1;
    size_t kept = 0;
    for (const uint32_t place : places_) {
        const ObjectId id = from[place].visible.id;
        const uint32_t now = id.index <= last ? place_of_[id.index] : 0;
        if (now > 0 && to[now - 1].visible.id == id) places_[kept++] = now - 1;
    }
    places_.resize(kept);
}

}  // namespace sightline::detail
