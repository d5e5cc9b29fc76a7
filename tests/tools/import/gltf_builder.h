// Builds small glTF files for tests: tables that grow as things are added, then a GLB or a text.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstring>
#include <initializer_list>
#include <string>
#include <type_traits>
#include <vector>

#include <nlohmann/json.hpp>

namespace sightline::test {

using Json = nlohmann::json;

/// Of bytes 5120, of shorts 5122, of whole words 5124, each one more if unsigned; of floats 5126.
template <class T>
constexpr int kComponentType = std::is_same_v<T, float> ? 5126
                                                        : 5120 + int(sizeof(T) & ~size_t{1}) + std::is_unsigned_v<T>;

/// Number of components of "SCALAR", "VEC3", "MAT4" and so on.
inline size_t componentsOf(const std::string& type) {
    return type == "SCALAR" ? 1 : type == "VEC2" ? 2 : type == "VEC3" ? 3 : type == "VEC4" ? 4 : 16;
}

/// Everything lies in one buffer; `json` may be changed at will before it is written.
struct GltfBuilder {
    Json json = {{"asset", {{"version", "2.0"}}}};
    std::string bytes;

    /// Appends an element to a table of the JSON and returns its index.
    uint32_t add(const char* table, Json element) {
        json[table].push_back(std::move(element));
        return static_cast<uint32_t>(json[table].size() - 1);
    }

    /// A buffer view of raw bytes. @param stride  [bytes]; 0: packed
    uint32_t view(const std::string& data, size_t stride = 0) {
        bytes.resize((bytes.size() + 3) / 4 * 4);
        Json view = {{"buffer", 0}, {"byteOffset", bytes.size()}, {"byteLength", data.size()}};
        if (stride) view["byteStride"] = stride;
        bytes += data;
        return add("bufferViews", view);
    }

    template <class T>
    static std::string raw(const std::vector<T>& values) {
        std::string out(values.size() * sizeof(T), '\0');
        if (!values.empty()) std::memcpy(out.data(), values.data(), out.size());
        return out;
    }

    template <class T>
    uint32_t accessor(const std::string& type, const std::vector<T>& values, bool normalized = false) {
        Json accessor = {{"bufferView", view(raw(values))},
                         {"componentType", kComponentType<T>},
                         {"count", values.size() / componentsOf(type)},
                         {"type", type}};
        if (normalized) accessor["normalized"] = true;
        return add("accessors", accessor);
    }

    /// A mesh of one primitive. @param indices  an accessor, or -1
    uint32_t mesh(uint32_t positions, int indices = -1, Json more = Json::object()) {
        Json primitive = {{"attributes", {{"POSITION", positions}}}};
        if (indices >= 0) primitive["indices"] = indices;
        primitive.update(more);
        return add("meshes", {{"primitives", Json::array({primitive})}});
    }

    /// With a triangle in its only node.
    static GltfBuilder triangle() {
        GltfBuilder b;
        b.node({{"mesh", b.triangleMesh()}});
        return b;
    }

    uint32_t node(Json node) { return add("nodes", std::move(node)); }

    /// A triangle in the plane z = 0: (0,0) (1,0) (0,1). Returns its mesh.
    uint32_t triangleMesh() {
        const uint32_t positions = accessor<float>("VEC3", {0, 0, 0, 1, 0, 0, 0, 1, 0});
        const uint32_t indices = accessor<uint16_t>("SCALAR", {0, 1, 2});
        return mesh(positions, int(indices));
    }

    Json withBuffer() const {
        Json out = json;
        if (!bytes.empty() && !out.contains("buffers")) out["buffers"] = {{{"byteLength", bytes.size()}}};
        return out;
    }

    std::string glb() const { return glb(withBuffer().dump(), bytes); }

    /// A GLB of any text and any bytes; no BIN chunk if there are none.
    static std::string glb(std::string text, std::string binary) {
        text.resize((text.size() + 3) / 4 * 4, ' ');
        binary.resize((binary.size() + 3) / 4 * 4, '\0');
        const auto u32 = [](size_t value) {
            const uint32_t number = static_cast<uint32_t>(value);
            return std::string(reinterpret_cast<const char*>(&number), 4);
        };
        const size_t length = 12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size());
        std::string out = "glTF" + u32(2) + u32(length) + u32(text.size()) + "JSON" + text;
        if (!binary.empty()) out += u32(binary.size()) + std::string("BIN\0", 4) + binary;
        return out;
    }

    /// A .gltf whose buffer is the file or data that `uri` names.
    std::string gltf(const std::string& uri) const {
        Json out = withBuffer();
        out["buffers"][0]["uri"] = uri;
        return out.dump();
    }

    /// A .gltf with its buffer inside.
    std::string gltf() const { return gltf("data:application/octet-stream;base64," + base64(bytes)); }

    static std::string base64(const std::string& data) {
        const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
        std::string out;
        for (size_t i = 0; i < data.size(); i += 3) {
            uint32_t bits = 0;
            for (size_t k = 0; k < 3; ++k) bits = bits << 8 | (i + k < data.size() ? uint8_t(data[i + k]) : 0u);
            for (size_t k = 0; k < 4; ++k) out += i + k > data.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
        }
        return out;
    }
};

}  // namespace sightline::test
