// The pages of an array and of the copies that were made of it: who still has which.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>

#include "sightline/base/array.h"

namespace sightline {

/// How pages of one type are laid out, begun, copied and ended. One function for each keeps the pool out of templates,
/// which every file that includes a world would compile again.
struct PageKind {
    size_t bytes = 0, alignment = 0;
    size_t born_at = 0;  ///< where in a page its time of birth stands, an uint64_t
    void (*begin)(void* place) = nullptr;
    void (*copy)(void* place, const void* like) = nullptr;
    void (*end)(void* page) = nullptr;
};

/// The pages of one array and of its copies. Time is counted in copies: a page is in those that were made since its birth
/// and before it was replaced, and goes when none of them is left. So no copy counts references to pages.
///
/// One thread changes the array; copies may end on any thread.
class PagePool {
public:
    PagePool(const PageKind& kind, Memory* memory);
    PagePool(const PagePool&) = delete;
    PagePool& operator=(const PagePool&) = delete;
    ~PagePool();

    /// No copy has the page.
    bool isNew(const void* page) const { return born(page) == now_; }

    /// A page of new elements, or like another one.
    void* make();
    void* make(const void* like);

    /// Takes a page that the array no longer has.
    void giveBack(void* page);

    /// Notes a copy of the array as it is.
    /// @returns its time
    uint64_t beginCopy();

    /// There is no array any more, and there will be no further copy.
    void end();

    void endCopy(uint64_t time);

private:
    struct Waiting {
        void* page;
        uint64_t born;
    };
    struct Replaced {
        uint64_t at;  ///< the time
        Array<Waiting> pages;
    };

    uint64_t born(const void* page) const {
        return *reinterpret_cast<const uint64_t*>(static_cast<const char*>(page) + kind_.born_at);
    }
    void* isMade(void* page);
    void* place();
    void keepReplaced();
    void letGo(Replaced& replaced, uint64_t newest);
    void freeAll(Array<void*>& places, size_t but);

    const PageKind& kind_;
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
