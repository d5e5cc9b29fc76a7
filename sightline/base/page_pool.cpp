// The pages of an array and of its copies: births, replacements, and what ends with a copy.
// SPDX-License-Identifier: MIT
#include "sightline/base/page_pool.h"

#include <algorithm>
#include <utility>

namespace sightline {

PagePool::PagePool(const PageKind& kind, Memory* memory)
    : kind_(kind),
      memory_(memory),
      replaced_now_(memory),
      spare_(memory),
      copies_(memory),
      replaced_(memory),
      freed_(memory) {}

PagePool::~PagePool() {
    end();
    for (Replaced& replaced : replaced_) letGo(replaced, 0);
}

void* PagePool::make() {
    void* page = place();
    kind_.begin(page);
    return isMade(page);
}

void* PagePool::make(const void* like) {
    void* page = place();
    kind_.copy(page, like);
    return isMade(page);
}

void PagePool::giveBack(void* page) {
    if (!isNew(page)) return replaced_now_.push_back({page, born(page)});
    kind_.end(page);
    spare_.push_back(page);
}

uint64_t PagePool::beginCopy() {
    // Room for as many pages as were made since the last copy.
    freeAll(spare_, made_);
    const std::lock_guard lock(mutex_);
    most_freed_ = std::exchange(made_, 0);
    keepReplaced();
    copies_.push_back(now_);
    return now_++;
}

void PagePool::end() {
    freeAll(spare_, 0);
    const std::lock_guard lock(mutex_);
    most_freed_ = 0;
    keepReplaced();
    freeAll(freed_, 0);
}

void PagePool::endCopy(uint64_t time) {
    const std::lock_guard lock(mutex_);
    const auto copy = copies_.erase(std::lower_bound(copies_.begin(), copies_.end(), time));
    // Of what was replaced between this copy and the next, the one before is now the last that may have it.
    const uint64_t before = copy == copies_.begin() ? 0 : copy[-1], next = copy == copies_.end() ? now_ : *copy;
    const auto first = std::upper_bound(replaced_.begin(), replaced_.end(), time,
                                        [](uint64_t at, const Replaced& replaced) { return at < replaced.at; });
    auto end = first;
    for (; end != replaced_.end() && end->at <= next; ++end) letGo(*end, before);
    replaced_.erase(std::remove_if(first, end, [](const Replaced& replaced) { return replaced.pages.empty(); }), end);
}

void* PagePool::isMade(void* page) {
    *reinterpret_cast<uint64_t*>(static_cast<char*>(page) + kind_.born_at) = now_;
    ++made_;
    return page;
}

void* PagePool::place() {
    if (spare_.empty()) {
        const std::lock_guard lock(mutex_);
        spare_.swap(freed_);
    }
    if (spare_.empty()) return memory_->allocate(kind_.bytes, kind_.alignment);
    void* place = spare_.back();
    spare_.pop_back();
    return place;
}

// Puts what was replaced since the last copy where copies find it.
void PagePool::keepReplaced() {
    replaced_.push_back({now_, std::move(replaced_now_)});
    replaced_now_.clear();
    letGo(replaced_.back(), copies_.empty() ? 0 : copies_.back());
    if (replaced_.back().pages.empty()) replaced_.pop_back();
}

// Ends the pages that no copy has; `newest` is the last copy before they were replaced.
void PagePool::letGo(Replaced& replaced, uint64_t newest) {
    erase_if(replaced.pages, [&](const Waiting& waiting) {
        if (waiting.born <= newest) return false;
        kind_.end(waiting.page);
        freed_.push_back(waiting.page);
        return true;
    });
    if (replaced.pages.size() < replaced.pages.capacity() / 4) replaced.pages.shrink_to_fit();
    freeAll(freed_, most_freed_);
}

void PagePool::freeAll(Array<void*>& places, size_t but) {
    for (; places.size() > but; places.pop_back()) memory_->deallocate(places.back(), kind_.bytes, kind_.alignment);
}

}  // namespace sightline
