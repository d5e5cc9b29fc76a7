// How the glTF importer gives up: one line and its place, thrown inside the importer only.
// SPDX-License-Identifier: MIT
#pragma once

#include <exception>
#include <new>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

#include <fmt/core.h>

#include "sightline/base/result.h"

namespace sightline::tools::gltf {

/// Caught by guarded(), which puts the file's name in front.
struct Fault {
    std::string message;
};

/// Throws a Fault.
/// @param place  where in the JSON, as in `accessors[3]`; empty: the file as a whole
template <class... Values>
[[noreturn]] void fail(const std::string& place, fmt::format_string<Values...> text, Values&&... values) {
    const std::string what = fmt::format(text, std::forward<Values>(values)...);
    throw Fault{place.empty() ? what : place + ": " + what};
}

/// The place of an element of a table, as in `accessors[3]`.
inline std::string at(std::string_view table, uint64_t index) { return fmt::format("{}[{}]", table, index); }

/// Text from a file, made fit for one line: control characters become '?', and the tail of a long
/// text becomes "...".
inline std::string printable(std::string_view text, size_t most = 80) {
    std::string out(text.substr(0, most));
    for (char& c : out)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
    if (text.size() > most) out += "...";
    return out;
}

/// What `read` gives; whatever it throws becomes one line.
/// @param name  of the file
/// @param read  returns a Result
template <class Read>
auto guarded(const std::string& name, Read&& read) -> decltype(read()) {
    std::string what;
    try {
        return read();
    } catch (const Fault& fault) { what = fault.message; } catch (const std::bad_alloc&) {
        what = "needs more memory than there is";
    } catch (const std::length_error&) {
        what = "needs more memory than there is";
    } catch (const std::exception& error) { what = std::string("cannot be read: ") + error.what(); }
    return Error{Error::Kind::kInput, printable(name + ": " + what, std::string::npos)};
}

}  // namespace sightline::tools::gltf
