// Arrays in pages that copies share, so that a copy costs no more than its pages' addresses.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <utility>

#include "sightline/base/assert.h"
#include "sightline/base/memory.h"
#include "sightline/base/page_pool.h"

namespace sightline {

/// An array of which share() makes copies that stay as they are: what is changed afterwards is changed in pages of its
/// own. Copies are for reading, by any thread and for as long as they live; only the array that they come from is changed.
///
/// Where references are taken, growing the array leaves them good; change() of another element of the same page may not.
///
/// @tparam kPage  elements that are copied together when one of them changes
template <class T, uint32_t kPage>
class Paged {
public:
    explicit Paged(Memory* memory = defaultMemory()) : pages_(memory) {}
    Paged(Paged&& from) noexcept
        : pages_(std::move(from.pages_)),
          size_(std::exchange(from.size_, 0)),
          pool_(std::move(from.pool_)),
          copy_(std::move(from.copy_)) {}
    Paged& operator=(Paged&& from) {
        if (this == &from) return *this;
        leave();
        pages_ = std::move(from.pages_);
        from.pages_.clear();
        size_ = std::exchange(from.size_, 0);
        pool_ = std::move(from.pool_);
        copy_ = std::move(from.copy_);
        return *this;
    }
    ~Paged() { leave(); }

    uint32_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const T& operator[](size_t i) const { return pages_[i / kPage]->items[i % kPage]; }
    /// Elements from i on that stand side by side: `most`, or those to the end of the page.
    std::span<const T> run(uint32_t i, uint32_t most) const { return {&(*this)[i], std::min(most, kPage - i % kPage)}; }
    /// Asks the processor for an element that will be read soon.
    void prefetch(size_t i) const {
        const char* from = reinterpret_cast<const char*>(&(*this)[i]);
        for (size_t byte = 0; byte < sizeof(T); byte += 64) __builtin_prefetch(from + byte);
    }
    const T& back() const { return (*this)[size_ - 1]; }

    /// For writing: makes the page this array's own first.
    T& change(size_t i) { return ownPage(i / kPage).items[i % kPage]; }
    void set(size_t i, const T& value) { change(i) = value; }
    void push_back(const T& value) {
        if (size_ == pages_.size() * kPage) addPage();
        change(size_++) = value;
    }
    /// What is new is T().
    void resize(uint32_t size) {
        const uint32_t kept = std::min(size, size_);
        const size_t pages = (size_t{size} + kPage - 1) / kPage;
        for (; pages_.size() > pages; pages_.pop_back()) pool_->giveBack(pages_.back());
        while (pages_.size() < pages) addPage();
        size_ = size;
        for (uint32_t i = kept; i < size; ++i) change(i) = T();
    }
    void clear() {
        if (pool_)
            for (Page* page : pages_) pool_->giveBack(page);
        pages_.clear();
        size_ = 0;
    }

    /// As it is now. O(pages).
    Paged share() {
        SIGHTLINE_ASSERT(!copy_);
        Paged copy(memory());
        if (empty()) return copy;
        copy.pages_ = pages_;
        copy.size_ = size_;
        copy.copy_ = makeShared<Copy>(memory(), pool_);
        return copy;
    }

    /// Of a copy: another one. O(pages).
    Paged copy() const {
        SIGHTLINE_ASSERT(!pool_);
        Paged copy(memory());
        copy.pages_ = pages_;
        copy.size_ = size_;
        copy.copy_ = copy_;
        return copy;
    }

private:
    using Pool = PagePool<T, kPage>;
    using Page = typename Pool::Page;
    /// Keeps the pages of a copy.
    struct Copy {
        const std::shared_ptr<Pool> pool;
        const uint64_t time;

        explicit Copy(std::shared_ptr<Pool> from) : pool(std::move(from)), time(pool->beginCopy()) {}
        Copy(const Copy&) = delete;
        Copy& operator=(const Copy&) = delete;
        ~Copy() { pool->endCopy(time); }
    };

    void leave() {
        clear();
        if (pool_) pool_->end();
    }
    Memory* memory() const { return pages_.get_allocator().resource(); }
    void addPage() {
        SIGHTLINE_ASSERT(!copy_);
        if (!pool_) pool_ = makeShared<Pool>(memory(), memory());
        pages_.push_back(pool_->make());
    }
    Page& ownPage(size_t index) {
        SIGHTLINE_ASSERT(!copy_);
        Page*& page = pages_[index];
        if (!pool_->isNew(*page)) {
            Page* own = pool_->make(*page);
            pool_->giveBack(page);
            page = own;
        }
        return *page;
    }

    Array<Page*> pages_;
    uint32_t size_ = 0;
    std::shared_ptr<Pool> pool_;        ///< null in copies, and where there never was a page
    std::shared_ptr<const Copy> copy_;  ///< of a copy
};

}  // namespace sightline
