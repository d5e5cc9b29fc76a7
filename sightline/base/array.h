// Arrays in a memory that is given, as std::pmr::vector, whose headers and functions are slow to compile.
// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstring>
#include <initializer_list>
#include <iterator>
#include <type_traits>
#include <utility>

#include "sightline/base/memory.h"

namespace sightline {

/// A growing array in a memory. Copying elements into it leaves it in its memory; a copy is in the default memory unless
/// another one is given. Elements that are arrays take its memory. Its interface is std::vector's.
template <class T>
class Array {
public:
    using value_type = T;
    using size_type = size_t;
    using difference_type = ptrdiff_t;
    using reference = T&;
    using const_reference = const T&;
    using iterator = T*;
    using const_iterator = const T*;
    using InMemory = void;  ///< its last constructor argument is a memory

    Array() = default;
    explicit Array(Memory* memory) : memory_(memory) {}
    explicit Array(size_t size, Memory* memory = defaultMemory()) : memory_(memory) { resize(size); }
    Array(size_t size, const T& value, Memory* memory = defaultMemory()) : memory_(memory) { assign(size, value); }
    template <std::input_iterator It>
    Array(It first, It last, Memory* memory = defaultMemory()) : memory_(memory) {
        assign(first, last);
    }
    Array(std::initializer_list<T> from, Memory* memory = defaultMemory()) : memory_(memory) {
        assign(from.begin(), from.end());
    }
    Array(const Array& from, Memory* memory = defaultMemory()) : memory_(memory) { assign(from.begin(), from.end()); }
    Array(Array&& from) noexcept
        : memory_(from.memory_),
          data_(std::exchange(from.data_, nullptr)),
          size_(std::exchange(from.size_, 0)),
          capacity_(std::exchange(from.capacity_, 0)) {}
    Array(Array&& from, Memory* memory) : memory_(memory) { *this = std::move(from); }
    ~Array() {
        destroy(data_, size_);
        giveBack(data_, capacity_);
    }
    Array& operator=(const Array& from) {
        if (this != &from) assign(from.begin(), from.end());
        return *this;
    }
    /// Takes what `from` has, or, of another memory, moves its elements.
    Array& operator=(Array&& from) {
        if (this == &from) return *this;
        clear();
        if (memory_ == from.memory_) {
            std::swap(data_, from.data_);
            std::swap(size_, from.size_);
            std::swap(capacity_, from.capacity_);
            return *this;
        }
        reserve(from.size_);
        for (T& element : from) push_back(std::move(element));
        from.clear();
        return *this;
    }
    Array& operator=(std::initializer_list<T> from) {
        assign(from.begin(), from.end());
        return *this;
    }

    Memory* memory() const { return memory_; }
    size_t size() const { return size_; }
    size_t capacity() const { return capacity_; }
    bool empty() const { return size_ == 0; }
    T* data() { return data_; }
    const T* data() const { return data_; }
    T* begin() { return data_; }
    const T* begin() const { return data_; }
    const T* cbegin() const { return data_; }
    T* end() { return data_ + size_; }
    const T* end() const { return data_ + size_; }
    const T* cend() const { return data_ + size_; }
    auto rbegin() { return std::make_reverse_iterator(end()); }
    auto rbegin() const { return std::make_reverse_iterator(end()); }
    auto rend() { return std::make_reverse_iterator(begin()); }
    auto rend() const { return std::make_reverse_iterator(begin()); }
    T& operator[](size_t i) { return data_[i]; }
    const T& operator[](size_t i) const { return data_[i]; }
    T& front() { return data_[0]; }
    const T& front() const { return data_[0]; }
    T& back() { return data_[size_ - 1]; }
    const T& back() const { return data_[size_ - 1]; }

    void reserve(size_t capacity) {
        if (capacity > capacity_) relocate(capacity);
    }
    void shrink_to_fit() {
        if (capacity_ > size_) relocate(size_);
    }
    void clear() {
        destroy(data_, size_);
        size_ = 0;
    }
    /// What is new is T().
    void resize(size_t size) {
        resizeWith(size, [this](T* at) { make(at); });
    }
    void resize(size_t size, const T& value) {
        if (size <= capacity_) return resizeWith(size, [&](T* at) { make(at, value); });
        const T kept = value;  // it may be one of the elements
        resizeWith(size, [&](T* at) { make(at, kept); });
    }
    void assign(size_t size, const T& value) {
        const T kept = value;
        clear();
        resizeWith(size, [&](T* at) { make(at, kept); });
    }
    template <std::input_iterator It>
    void assign(It first, It last) {
        clear();
        append(first, last);
    }
    void push_back(const T& value) { emplace_back(value); }
    void push_back(T&& value) { emplace_back(std::move(value)); }
    template <class... Arguments>
    T& emplace_back(Arguments&&... arguments) {
        if (size_ == capacity_) return growWith(std::forward<Arguments>(arguments)...);
        make(data_ + size_, std::forward<Arguments>(arguments)...);
        return data_[size_++];
    }
    void pop_back() { destroy(data_ + --size_, 1); }

    T* insert(const T* at, const T& value) {
        const size_t place = static_cast<size_t>(at - data_);
        push_back(value);
        std::rotate(data_ + place, data_ + size_ - 1, data_ + size_);
        return data_ + place;
    }
    /// @param first, last  not of this array
    template <std::input_iterator It>
    T* insert(const T* at, It first, It last) {
        const size_t place = static_cast<size_t>(at - data_), before = size_;
        append(first, last);
        if (place != before) std::rotate(data_ + place, data_ + before, data_ + size_);
        return data_ + place;
    }
    T* insert(const T* at, size_t count, const T& value) {
        const size_t place = static_cast<size_t>(at - data_), before = size_;
        resize(size_ + count, value);
        std::rotate(data_ + place, data_ + before, data_ + size_);
        return data_ + place;
    }
    T* erase(const T* at) { return erase(at, at + 1); }
    T* erase(const T* first, const T* last) {
        T* const to = data_ + (first - data_);
        if (first == last) return to;
        T* const behind = std::move(data_ + (last - data_), data_ + size_, to);
        destroy(behind, static_cast<size_t>(data_ + size_ - behind));
        size_ = static_cast<size_t>(behind - data_);
        return to;
    }
    /// Exchanges the memories, too.
    void swap(Array& other) {
        std::swap(memory_, other.memory_);
        std::swap(data_, other.data_);
        std::swap(size_, other.size_);
        std::swap(capacity_, other.capacity_);
    }
    friend void swap(Array& a, Array& b) { a.swap(b); }
    friend bool operator==(const Array& a, const Array& b) {
        return a.size_ == b.size_ && std::equal(a.begin(), a.end(), b.begin());
    }
    template <class Predicate>
    friend size_t erase_if(Array& array, Predicate predicate) {
        const size_t before = array.size();
        array.erase(std::remove_if(array.begin(), array.end(), predicate), array.end());
        return before - array.size();
    }

    friend size_t erase(Array& array, const T& value) {
        return erase_if(array, [&value](const T& element) { return element == value; });
    }

private:
    template <class... Arguments>
    void make(T* at, Arguments&&... arguments) {
        if constexpr (requires { typename T::InMemory; } && std::is_constructible_v<T, Arguments..., Memory*>)
            new (at) T(std::forward<Arguments>(arguments)..., memory_);
        else new (at) T(std::forward<Arguments>(arguments)...);
    }
    static void destroy(T* first, size_t count) {
        if constexpr (!std::is_trivially_destructible_v<T>)
            for (size_t i = 0; i < count; ++i) first[i].~T();
    }
    void giveBack(T* place, size_t capacity) {
        if (capacity != 0) memory_->deallocate(place, capacity * sizeof(T), alignof(T));
    }
    T* take(size_t capacity) {
        return capacity == 0 ? nullptr : static_cast<T*>(memory_->allocate(capacity * sizeof(T), alignof(T)));
    }
    size_t grown(size_t more) const { return size_ + std::max(size_, more); }
    void reserveMore(size_t more) {
        if (capacity_ - size_ < more) relocate(grown(more));
    }
    template <class Make>
    void resizeWith(size_t size, Make make_one) {
        if (size < size_) {
            destroy(data_ + size, size_ - size);
        } else {
            reserveMore(size - size_);
            T* const to = data_;
            for (size_t i = size_; i < size; ++i) make_one(to + i);
        }
        size_ = size;
    }
    template <class It>
    void append(It first, It last) {
        if constexpr (!std::forward_iterator<It>) {
            for (; first != last; ++first) emplace_back(*first);
        } else {
            const size_t count = static_cast<size_t>(std::distance(first, last));
            reserveMore(count);
            T* const to = data_ + size_;
            if constexpr (std::contiguous_iterator<It> && std::is_same_v<std::iter_value_t<It>, T> &&
                          std::is_trivially_copyable_v<T>) {
                if (count != 0) std::memcpy(static_cast<void*>(to), std::to_address(first), count * sizeof(T));
            } else {
                for (size_t i = 0; i < count; ++i, ++first) make(to + i, *first);
            }
            size_ += count;
        }
    }
    void moveTo(T* to, size_t capacity) {
        if constexpr (std::is_trivially_copyable_v<T>) {
            if (size_ != 0) std::memcpy(static_cast<void*>(to), data_, size_ * sizeof(T));
        } else {
            for (size_t i = 0; i < size_; ++i) {
                new (to + i) T(std::move(data_[i]));
                data_[i].~T();
            }
        }
        giveBack(data_, capacity_);
        data_ = to;
        capacity_ = capacity;
    }
    void relocate(size_t capacity) { moveTo(take(capacity), capacity); }
    // The new element is made before the others move: its arguments may be among them.
    template <class... Arguments>
    __attribute__((noinline)) T& growWith(Arguments&&... arguments) {
        const size_t capacity = grown(1);
        T* const to = take(capacity);
        make(to + size_, std::forward<Arguments>(arguments)...);
        moveTo(to, capacity);
        return data_[size_++];
    }

    Memory* memory_ = defaultMemory();
    T* data_ = nullptr;
    size_t size_ = 0, capacity_ = 0;
};

}  // namespace sightline
