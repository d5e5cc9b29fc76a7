// The pages of one array in pages, whatever its elements are: sharing them with copies, and a page of one's own to write to.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <memory>

#include "sightline/base/assert.h"
#include "sightline/base/array.h"
#include "sightline/base/page_pool.h"

namespace sightline::detail {

/// The pages of a Paged array, or of a copy of one.
class SharedPages {
public:
    /// @param kind  must outlive the pages
    SharedPages(const PageKind& kind, Memory* memory);
    SharedPages(SharedPages&& from) noexcept;
    SharedPages& operator=(SharedPages&& from);
    ~SharedPages();

    size_t size() const { return pages_.size(); }
    const void* operator[](size_t page) const { return pages_[page]; }

    /// A page for writing: makes it the array's own first.
    void* own(size_t page) {
        SIGHTLINE_ASSERT(!copy_);
        void* const now = pages_[page];
        return pool_->isNew(now) ? now : replace(page);
    }
    void add();
    void shrink(size_t pages);

    /// A copy of the array as it is now.
    SharedPages share();
    /// Of a copy: another one.
    SharedPages copy() const;

private:
    /// Keeps the pages of a copy.
    struct Copy;

    void* replace(size_t page);
    Memory* memory() const;
    void leave();

    const PageKind* kind_;
    Array<void*> pages_;
    std::shared_ptr<PagePool> pool_;    ///< null in copies, and where there never was a page
    std::shared_ptr<const Copy> copy_;  ///< of a copy
};

}  // namespace sightline::detail
