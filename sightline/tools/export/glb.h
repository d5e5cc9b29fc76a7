// A glTF file that is being written: its tables, and the one buffer that holds its data.
// SPDX-License-Identifier: MIT
//
// Khronos Group. glTF 2.0 Specification, sections 3.6 and 4. 2021.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "sightline/base/result.h"

namespace sightline::tools {

/// Numbers as the file holds them, one after another.
template <class T>
std::span<const unsigned char> bytesOf(const std::vector<T>& values) {
    return {reinterpret_cast<const unsigned char*>(values.data()), values.size() * sizeof(T)};
}

class Glb {
public:
    using Json = nlohmann::json;

    /// What a buffer view is for.
    enum class Target : uint16_t { kNone = 0, kVertices = 34962, kIndices = 34963 };

    Json json = {{"asset", {{"version", "2.0"}, {"generator", "Sightline"}}}};

    /// Appends an element to a table of `json`.
    /// @return its index
    uint32_t add(const char* table, Json element);

    /// Appends bytes to the buffer.
    /// @param view    what the view says besides
    /// @param stride  from element to element  [bytes]; 0: they are packed
    /// @return        the view's index
    uint32_t addView(std::span<const unsigned char> bytes, Target target = Target::kNone, uint32_t stride = 0,
                     Json view = Json::object());

    /// Appends indices: 16 bits each if they are below 65535, else 32.
    /// @return the accessor's index
    uint32_t addIndices(std::span<const uint32_t> indices);

    /// The whole file; what is no UTF-8 in names becomes a replacement character. Errors (kOutput): it would be larger
    /// than 4 GiB.
    /// @param name  of the file, for the error
    Result<std::string> bytes(const std::string& name) const;

private:
    std::vector<unsigned char> buffer_;
};

}  // namespace sightline::tools
