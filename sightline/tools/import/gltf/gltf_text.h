// A glTF's JSON, kept as text: only one element of a table at a time becomes values.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sightline/tools/import/gltf/gltf_json.h"

namespace sightline::tools::gltf {

/// True only if the text is JSON for sure: one value, at most 256 deep, well-formed UTF-8, every number finite in double.
/// False says nothing: the caller asks a full parser, which also knows the place of a mistake. Surrogate escapes and
/// very long numbers are among what is left to it.
bool plainJson(std::span<const unsigned char> text);

/// A top-level array of the JSON, such as `nodes`. Points into the JsonText that it came from.
class JsonTable {
public:
    using Text = std::span<const unsigned char>;

    JsonTable() = default;
    /// @param starts  where each element begins, and where the array ends
    JsonTable(Text text, std::span<const uint64_t> starts) : text_(text), starts_(starts) {}

    size_t size() const { return starts_.empty() ? 0 : starts_.size() - 1; }
    bool empty() const { return size() == 0; }

    /// The element as values.
    Json operator[](size_t index) const;

    /// The same; it must be an object.
    Json object(size_t index, const std::string& place) const;

private:
    Text text_;
    std::span<const uint64_t> starts_;
};

/// The values of a large JSON take several times the memory of its text, which a scene with a million nodes is
/// not to cost.
class JsonText {
public:
    JsonText() = default;

    /// A Fault unless the whole text is one JSON object whose nesting is at most 256 deep.
    /// @param text  must outlive this
    explicit JsonText(JsonTable::Text text);

    /// A top-level array; empty if there is none. A Fault if the member is no array.
    JsonTable table(const char* key) const;

    /// An object with those top-level members that are no arrays and bear one of these names.
    Json members(std::initializer_list<const char*> keys) const;

    /// All of it as values: several times the memory of its text.
    Json all() const;

private:
    struct Member {
        uint64_t begin = 0, end = 0;
        bool array = false;
        std::vector<uint64_t> starts;  // of the array's elements, and its end
    };

    void index();
    size_t addMember(size_t at);

    JsonTable::Text text_;
    std::map<std::string, Member> members_;  // of equal names the last
};

}  // namespace sightline::tools::gltf
