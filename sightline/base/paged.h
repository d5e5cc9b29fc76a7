// Arrays in pages that copies share, so that a copy costs no more than its pages' addresses.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

#include "sightline/base/assert.h"
#include "sightline/base/memory.h"

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
    Paged(Paged&&) noexcept = default;
    Paged& operator=(Paged&&) = default;

    uint32_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const T& operator[](size_t i) const { return pages_[i / kPage]->items[i % kPage]; }
    /// Elements from i on that stand side by side: `most`, or those to the end of the page.
    std::span<const T> run(uint32_t i, uint32_t most) const { return {&(*this)[i], std::min(most, kPage - i % kPage)}; }
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
        const uint32_t kept = size < size_ ? size : size_;
        pages_.resize((size + kPage - 1) / kPage);
        for (auto& page : pages_)
            if (!page) page = newPage();
        size_ = size;
        for (uint32_t i = kept; i < size; ++i) change(i) = T();
    }
    void clear() {
        pages_.clear();
        size_ = 0;
    }

    /// As it is now. O(pages).
    Paged share() {
        ++era_;
        return reading();
    }

    /// Of a copy: another one. O(pages).
    Paged copy() const {
        SIGHTLINE_ASSERT(era_ == kReading);
        return reading();
    }

private:
    static constexpr uint64_t kReading = 0;
    struct Page {
        uint64_t era = 0;
        T items[kPage];
    };

    Paged reading() const {
        Paged copy(memory());
        copy.pages_ = pages_;
        copy.size_ = size_;
        copy.era_ = kReading;
        return copy;
    }
    Memory* memory() const { return pages_.get_allocator().resource(); }
    std::shared_ptr<Page> newPage() const {
        auto page = makeShared<Page>(memory());
        page->era = era_;
        return page;
    }
    void addPage() { pages_.push_back(newPage()); }
    Page& ownPage(size_t index) {
        SIGHTLINE_ASSERT(era_ != kReading);
        std::shared_ptr<Page>& page = pages_[index];
        if (page->era != era_) {
            page = makeShared<Page>(memory(), *page);
            page->era = era_;
        }
        return *page;
    }

    Array<std::shared_ptr<Page>> pages_;
    uint32_t size_ = 0;
    uint64_t era_ = 1;  ///< a page of this one is in no copy
};

}  // namespace sightline
