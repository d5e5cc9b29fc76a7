// Puts the tables and the buffer of a glTF into one file.
// SPDX-License-Identifier: MIT
#include "sightline/tools/export/glb.h"
#include "sightline/tools/scene/json_text.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include <fmt/core.h>

namespace sightline::tools {
namespace {

constexpr uint64_t kMostBytes = 0xffffffff;  // what a GLB's 32-bit lengths can say

size_t padded(size_t size) { return (size + 3) / 4 * 4; }

void put(std::string& out, size_t number) {
    const auto word = static_cast<uint32_t>(number);
    char bytes[4];
    std::memcpy(bytes, &word, sizeof bytes);  // little-endian, as all machines that this is built for
    out.append(bytes, sizeof bytes);
}

}  // namespace

uint32_t Glb::add(const char* table, Json element) {
    json[table].push_back(std::move(element));
    return static_cast<uint32_t>(json[table].size() - 1);
}

uint32_t Glb::addView(std::span<const unsigned char> bytes, Target target, uint32_t stride, Json view) {
    buffer_.resize(padded(buffer_.size()));
    view["buffer"] = 0;
    view["byteOffset"] = buffer_.size();
    view["byteLength"] = bytes.size();
    if (stride) view["byteStride"] = stride;
    if (target != Target::kNone) view["target"] = static_cast<uint32_t>(target);
    buffer_.insert(buffer_.end(), bytes.begin(), bytes.end());
    return add("bufferViews", std::move(view));
}

uint32_t Glb::addIndices(std::span<const uint32_t> indices) {
    constexpr uint32_t kRestart = 0xffff;  // a value that no index of 16 bits may have
    const bool narrow = std::all_of(indices.begin(), indices.end(), [](uint32_t index) { return index < kRestart; });
    uint32_t view = 0;
    if (narrow) {
        std::vector<uint16_t> words;
        for (const uint32_t index : indices) words.push_back(static_cast<uint16_t>(index));
        view = addView(bytesOf(words), Target::kIndices);
    } else {
        view =
            addView({reinterpret_cast<const unsigned char*>(indices.data()), indices.size_bytes()}, Target::kIndices);
    }
    return add(
        "accessors",
        {{"bufferView", view}, {"componentType", narrow ? 5123 : 5125}, {"count", indices.size()}, {"type", "SCALAR"}});
}

Result<std::string> Glb::bytes(const std::string& name) const {
    Json whole = json;
    if (!buffer_.empty()) whole["buffers"] = Json::array({{{"byteLength", buffer_.size()}}});
    std::string text = jsonText(whole);
    text.resize(padded(text.size()), ' ');
    const size_t body = padded(buffer_.size());
    const uint64_t length = 12 + 8 + text.size() + (body == 0 ? 0 : 8 + body);
    if (length > kMostBytes)
        return Error{Error::Kind::kOutput, fmt::format("{}: {} bytes are more than a GLB can hold", name, length)};
    std::string out;
    out.reserve(length);
    out += "glTF";
    put(out, 2);
    put(out, length);
    put(out, text.size());
    out += "JSON";
    out += text;
    if (body == 0) return out;
    put(out, body);
    out.append("BIN\0", 4);
    out.append(reinterpret_cast<const char*>(buffer_.data()), buffer_.size());
    out.resize(length, '\0');
    return out;
}

}  // namespace sightline::tools
