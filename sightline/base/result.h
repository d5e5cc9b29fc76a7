// A value, or the one line that says why there is none.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <utility>
#include <variant>

#include "sightline/base/assert.h"

namespace sightline {

/// Why a call failed. The command line tool turns the kind into its exit code.
struct Error {
    enum class Kind {
        kInput,   ///< an input cannot be read or is malformed       [exit code 3]
        kOutput,  ///< an output cannot be written                   [exit code 4]
        kUsage,   ///< the arguments do not make sense together      [exit code 2]
    };
    Kind kind = Kind::kInput;
    std::string message;  ///< one line, no newline: the file, what is wrong, and where
};

/// Holds a T or an Error; never neither. Reading the wrong one stops the program.
template <class T>
class [[nodiscard]] Result {
public:
    Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}
    Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}

    bool ok() const { return state_.index() == 0; }
    explicit operator bool() const { return ok(); }

    T& value() {
        SIGHTLINE_ASSERT(ok());
        return *std::get_if<0>(&state_);
    }
    const T& value() const {
        SIGHTLINE_ASSERT(ok());
        return *std::get_if<0>(&state_);
    }
    T& operator*() { return value(); }
    const T& operator*() const { return value(); }
    T* operator->() { return &value(); }
    const T* operator->() const { return &value(); }

    const Error& error() const {
        SIGHTLINE_ASSERT(!ok());
        return *std::get_if<1>(&state_);
    }

private:
    std::variant<T, Error> state_;
};

/// The result of a call that returns nothing but may fail.
using Status = Result<std::monostate>;
inline Status success() { return std::monostate{}; }

}  // namespace sightline
