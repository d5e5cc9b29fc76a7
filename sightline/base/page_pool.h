// The pages of an array and of the copies that were made of it: who still has which.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <utility>

#include "sightline/base/memory.h"

namespace sightline {

/// The pages of one array and of its copies. Time is counted in copies: a page is in those that were made since its birth
/// and before it was replaced, and goes when none of them is left. So no copy counts references to pages.
///
/// One thread changes the array; copies may end on any thread.
template <class T, uint32_t kPage>
class PagePool {
public:
    struct Page {
        T items[kPage];
        uint64_t born = 0;  ///< the time
    };

    explicit PagePool(Memory* memory)
        : memory_(memory), replaced_now_(memory), spare_(memory), copies_(memory), replaced_(memory), freed_(memory) {}
    PagePool(const PagePool&) = delete;
    PagePool& operator=(const PagePool&) = delete;
    ~PagePool() {
        end();
        for (Replaced& replaced : replaced_) letGo(replaced, 0);
    }

    /// No copy has the page.
    bool isNew(const Page& page) const { return page.born == now_; }

    /// A page of T(), or like another one.
    Page* make() { return isMade(new (place()) Page()); }
    Page* make(const Page& like) { return isMade(new (place()) Page(like)); }

    /// Takes a page that the array no longer has.
    void giveBack(Page* page) {
        if (!isNew(*page)) return replaced_now_.push_back({page, page->born});
        page->~Page();
        spare_.push_back(page);
    }

    /// Notes a copy of the array as it is.
    /// @returns its time
    uint64_t beginCopy() {
        // Room for as many pages as were made since the last copy.
        freeAll(spare_, made_);
        const std::lock_guard lock(mutex_);
        most_freed_ = std::exchange(made_, 0);
        keepReplaced();
        copies_.push_back(now_);
        return now_++;
    }

    /// There is no array any more, and there will be no further copy.
    void end() {
        freeAll(spare_, 0);
        const std::lock_guard lock(mutex_);
        most_freed_ = 0;
        keepReplaced();
        freeAll(freed_, 0);
    }

    void endCopy(uint64_t time) {
        const std::lock_guard lock(mutex_);
        const auto copy = copies_.erase(std::lower_bound(copies_.begin(), copies_.end(), time));
        // Of what was replaced between this copy and the next, the one before is now the last that may have it.
        const uint64_t before = copy == copies_.begin() ? 0 : copy[-1], next = copy == copies_.end() ? now_ : *copy;
        const auto first = std::upper_bound(replaced_.begin(), replaced_.end(), time,
                                            [](uint64_t at, const Replaced& replaced) { return at < replaced.at; });
        auto end = first;
        for (; end != replaced_.end() && end->at <= next; ++end) letGo(*end, before);
        replaced_.erase(std::remove_if(first, end, [](const Replaced& replaced) { return replaced.pages.empty(); }),
                        end);
    }

private:
    struct Waiting {
        Page* page;
        uint64_t born;
    };
    struct Replaced {
        uint64_t at;  ///< the time
        Array<Waiting> pages;
    };

    Page* isMade(Page* page) {
        page->born = now_;
        ++made_;
        return page;
    }
    void* place() {
        if (spare_.empty()) {
            const std::lock_guard lock(mutex_);
            spare_.swap(freed_);
        }
        if (spare_.empty()) return memory_->allocate(sizeof(Page), alignof(Page));
        void* place = spare_.back();
        spare_.pop_back();
        return place;
    }
    /// Puts what was replaced since the last copy where copies find it.
    void keepReplaced() {
        replaced_.push_back({now_, std::move(replaced_now_)});
        replaced_now_.clear();
        letGo(replaced_.back(), copies_.empty() ? 0 : copies_.back());
        if (replaced_.back().pages.empty()) replaced_.pop_back();
    }
    /// Ends the pages that no copy has.
    /// @param newest  the last copy before they were replaced
    void letGo(Replaced& replaced, uint64_t newest) {
        std::erase_if(replaced.pages, [&](const Waiting& waiting) {
            if (waiting.born <= newest) return false;
            waiting.page->~Page();
            freed_.push_back(waiting.page);
            return true;
        });
        if (replaced.pages.size() < replaced.pages.capacity() / 4) replaced.pages.shrink_to_fit();
        freeAll(freed_, most_freed_);
    }
    void freeAll(Array<void*>& places, size_t but) {
        for (; places.size() > but; places.pop_back()) memory_->deallocate(places.back(), sizeof(Page), alignof(Page));
    }

    Memory* const memory_;
    // Of the thread that changes the array:
    size_t made_ = 0;              ///< pages, since the last copy
    Array<Waiting> replaced_now_;  ///< since the last copy
    Array<void*> spare_;           ///< room for pages
    // Of all threads:
    std::mutex mutex_;
    uint64_t now_ = 1;
    Array<uint64_t> copies_;    ///< times of those that have not ended, rising
    Array<Replaced> replaced_;  ///< pages that copies may have, rising
    Array<void*> freed_;        ///< room for pages
    size_t most_freed_ = 0;
};

}  // namespace sightline
