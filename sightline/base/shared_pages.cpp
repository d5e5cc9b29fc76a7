// The pages of an array in pages: made, replaced where a copy has them, and shared.
// SPDX-License-Identifier: MIT
#include "sightline/base/shared_pages.h"

#include <cstdint>
#include <utility>

namespace sightline::detail {

struct SharedPages::Copy {
    const std::shared_ptr<PagePool> pool;
    const uint64_t time;

    explicit Copy(std::shared_ptr<PagePool> from) : pool(std::move(from)), time(pool->beginCopy()) {}
    Copy(const Copy&) = delete;
    Copy& operator=(const Copy&) = delete;
    ~Copy() { pool->endCopy(time); }
};

SharedPages::SharedPages(const PageKind& kind, Memory* memory) : kind_(&kind), pages_(memory) {}

SharedPages::SharedPages(SharedPages&& from) noexcept
    : kind_(from.kind_), pages_(std::move(from.pages_)), pool_(std::move(from.pool_)), copy_(std::move(from.copy_)) {}

SharedPages& SharedPages::operator=(SharedPages&& from) {
    if (this == &from) return *this;
    leave();
    kind_ = from.kind_;
    pages_ = std::move(from.pages_);
    from.pages_.clear();
    pool_ = std::move(from.pool_);
    copy_ = std::move(from.copy_);
    return *this;
}

SharedPages::~SharedPages() { leave(); }

void SharedPages::add() {
    SIGHTLINE_ASSERT(!copy_);
    if (!pool_) pool_ = makeShared<PagePool>(memory(), *kind_, memory());
    pages_.push_back(pool_->make());
}

void SharedPages::shrink(size_t pages) {
    if (!pool_) {
        if (pages < pages_.size()) pages_.resize(pages);  // a copy's, which the pool keeps
        return;
    }
    for (; pages_.size() > pages; pages_.pop_back()) pool_->giveBack(pages_.back());
}

SharedPages SharedPages::share() {
    SIGHTLINE_ASSERT(!copy_);
    SharedPages copy(*kind_, memory());
    if (pages_.empty()) return copy;
    copy.pages_ = pages_;
    copy.copy_ = makeShared<Copy>(memory(), pool_);
    return copy;
}

SharedPages SharedPages::copy() const {
    SIGHTLINE_ASSERT(!pool_);
    SharedPages copy(*kind_, memory());
    copy.pages_ = pages_;
    copy.copy_ = copy_;
    return copy;
}

void* SharedPages::replace(size_t page) {
    void* const before = pages_[page];
    pages_[page] = pool_->make(before);
    pool_->giveBack(before);
    return pages_[page];
}

Memory* SharedPages::memory() const { return pages_.memory(); }

void SharedPages::leave() {
    shrink(0);
    if (pool_) pool_->end();
}

}  // namespace sightline::detail
