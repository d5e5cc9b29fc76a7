// Arrays in pages that copies share, so that a copy costs no more than its pages' addresses.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <new>
#include <span>
#include <utility>

#include "sightline/base/memory.h"
#include "sightline/base/shared_pages.h"

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
    explicit Paged(Memory* memory = defaultMemory()) : pages_(kKind, memory) {}
    Paged(Paged&& from) noexcept : pages_(std::move(from.pages_)), size_(std::exchange(from.size_, 0)) {}
    Paged& operator=(Paged&& from) {
        if (this == &from) return *this;
        pages_ = std::move(from.pages_);
        size_ = std::exchange(from.size_, 0);
        return *this;
    }

    uint32_t size() const { return size_; }
    bool empty() const { return size_ == 0; }
    const T& operator[](size_t i) const { return static_cast<const Page*>(pages_[i / kPage])->items[i % kPage]; }
    /// Elements from i on that stand side by side: `most`, or those to the end of the page.
    std::span<const T> run(uint32_t i, uint32_t most) const { return {&(*this)[i], std::min(most, kPage - i % kPage)}; }
    /// Asks the processor for an element that will be read soon.
    void prefetch(size_t i) const {
        const char* from = reinterpret_cast<const char*>(&(*this)[i]);
        for (size_t byte = 0; byte < sizeof(T); byte += 64) __builtin_prefetch(from + byte);
    }
    const T& back() const { return (*this)[size_ - 1]; }

    /// For writing: makes the page this array's own first.
    T& change(size_t i) { return static_cast<Page*>(pages_.own(i / kPage))->items[i % kPage]; }
    void set(size_t i, const T& value) { change(i) = value; }
    void push_back(const T& value) {
        if (size_ == pages_.size() * kPage) pages_.add();
        change(size_++) = value;
    }
    /// What is new is T().
    void resize(uint32_t size) {
        const uint32_t kept = std::min(size, size_);
        const size_t pages = (size_t{size} + kPage - 1) / kPage;
        pages_.shrink(pages);
        while (pages_.size() < pages) pages_.add();
        size_ = size;
        for (uint32_t i = kept; i < size; ++i) change(i) = T();
    }
    void clear() {
        pages_.shrink(0);
        size_ = 0;
    }

    /// As it is now. O(pages).
    Paged share() { return Paged(pages_.share(), size_); }

    /// Of a copy: another one. O(pages).
    Paged copy() const { return Paged(pages_.copy(), size_); }

private:
    struct Page {
        T items[kPage];
        uint64_t born = 0;
    };
    static void begin(void* place) { new (place) Page(); }
    static void copyPage(void* place, const void* like) { new (place) Page(*static_cast<const Page*>(like)); }
    static void end(void* page) { static_cast<Page*>(page)->~Page(); }
    static constexpr size_t bornAt() {
        return (sizeof(T) * kPage + alignof(uint64_t) - 1) / alignof(uint64_t) * alignof(uint64_t);
    }
    static constexpr PageKind kKind = {sizeof(Page), alignof(Page), bornAt(), begin, copyPage, end};

    Paged(detail::SharedPages&& pages, uint32_t size) : pages_(std::move(pages)), size_(size) {}

    detail::SharedPages pages_;
    uint32_t size_ = 0;
};

}  // namespace sightline
