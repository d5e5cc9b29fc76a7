// A value of a stranger's JSON and the way to it, so that what is wrong is told with its place.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <string>

#include <fmt/core.h>
#include <nlohmann/json.hpp>

namespace sightline::tools {

constexpr double kMostExact = 9007199254740992.0;  // whole numbers up to here are exact in JSON of any origin
constexpr double kMostMeasured = 1e15;             // [us, pixels]: 31 years; sums of a path stay finite

/// What is wrong, with its place; never leaves a reader.
struct JsonFault {
    std::string what;
};

/// A value and the way to it, for messages.
struct JsonAt {
    const nlohmann::json* value;
    std::string place;

    [[noreturn]] void fail(const std::string& what) const {
        throw JsonFault{place.empty() ? what : place + ": " + what};
    }
    JsonAt member(const char* name) const {
        if (!value->is_object()) fail("not an object");
        const auto found = value->find(name);
        const std::string there = place.empty() ? name : place + "." + name;
        if (found == value->end()) JsonAt{nullptr, there}.fail("missing");
        return {&*found, there};
    }
    std::optional<JsonAt> maybe(const char* name) const {
        if (!value->is_object()) fail("not an object");
        if (!value->contains(name) || (*value)[name].is_null()) return std::nullopt;
        return member(name);
    }
    size_t size() const {
        if (!value->is_array()) fail("not an array");
        return value->size();
    }
    JsonAt element(size_t index) const { return {&(*value)[index], fmt::format("{}[{}]", place, index)}; }

    double number() const {
        if (!value->is_number()) fail("not a number");
        const double out = value->get<double>();
        if (!std::isfinite(out)) fail("not finite");
        return out;
    }
    double positive() const {
        const double out = number();
        if (out < 0) fail("negative");
        if (out > kMostMeasured) fail("too large");
        return out;
    }
    uint64_t whole() const {
        if (value->is_number_unsigned()) return value->get<uint64_t>();
        const double out = value->is_number_float() ? value->get<double>() : -1;
        if (!(out >= 0 && out <= kMostExact && out == std::floor(out))) fail("not a whole number");
        return static_cast<uint64_t>(out);
    }
    uint64_t whole(uint64_t least, uint64_t most) const {
        const uint64_t out = whole();
        if (out < least || out > most) fail(fmt::format("not between {} and {}", least, most));
        return out;
    }
    bool flag() const {
        if (!value->is_boolean()) fail("not true or false");
        return value->get<bool>();
    }
    std::string text() const {
        if (!value->is_string()) fail("not a string");
        return value->get<std::string>();
    }
    void numbers(double* out, size_t count) const {
        if (size() != count) fail(fmt::format("not {} numbers", count));
        for (size_t i = 0; i < count; ++i) out[i] = element(i).number();
    }
};

/// The place within nlohmann's message, without its name and number.
inline std::string jsonFaultOf(const std::string& what) {
    const size_t end = what.find("] ");
    return end == std::string::npos ? what : what.substr(end + 2);
}

}  // namespace sightline::tools
