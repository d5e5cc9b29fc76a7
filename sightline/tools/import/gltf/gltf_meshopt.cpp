// Decompresses buffer views of EXT_meshopt_compression.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_meshopt.h"

#include <meshoptimizer.h>

namespace sightline::tools::gltf {
namespace {

// The densest that each codec packs; a triangle or an index takes a byte.
bool canHold(const Compression& c) {
    switch (c.mode) {
        case Compression::Mode::kAttributes:
            // Version 1 of the codec says in two bits that a byte of 256 elements is always zero.
            return c.decodedSize() / 1024 <= c.length;
        case Compression::Mode::kTriangles:
            return c.count / 3 <= c.length;
        case Compression::Mode::kIndices:
            return c.count <= c.length;
    }
    return false;
}

// The decoder asserts these instead of reporting them.
void checkShape(const Compression& c, const std::string& place) {
    using Mode = Compression::Mode;
    using Filter = Compression::Filter;
    bool right = false;
    if (c.mode == Mode::kAttributes) right = c.stride >= 4 && c.stride <= 256 && c.stride % 4 == 0;
    else right = c.stride == 2 || c.stride == 4;
    if (c.mode != Mode::kAttributes && c.filter != Filter::kNone) fail(place, "meshopt filters indices");
    if (c.filter == Filter::kOctahedral || c.filter == Filter::kColor) right = c.stride == 4 || c.stride == 8;
    if (c.filter == Filter::kQuaternion) right = c.stride == 8;
    if (!right) fail(place, "meshopt byteStride {} does not suit its mode and filter", c.stride);
    if (c.mode == Mode::kTriangles && c.count % 3 != 0)
        fail(place, "meshopt count {} is not a number of triangles", c.count);
}

Compression::Mode readMode(const Json& json, const std::string& place) {
    const std::string mode = text(json, "mode", place);
    if (mode == "ATTRIBUTES") return Compression::Mode::kAttributes;
    if (mode == "TRIANGLES") return Compression::Mode::kTriangles;
    if (mode == "INDICES") return Compression::Mode::kIndices;
    fail(place, "meshopt mode '{}' is not known", printable(mode));
}

Compression::Filter readFilter(const Json& json, const std::string& place) {
    const std::string filter = text(json, "filter", place);
    if (filter.empty() || filter == "NONE") return Compression::Filter::kNone;
    if (filter == "OCTAHEDRAL") return Compression::Filter::kOctahedral;
    if (filter == "QUATERNION") return Compression::Filter::kQuaternion;
    if (filter == "EXPONENTIAL") return Compression::Filter::kExponential;
    if (filter == "COLOR") return Compression::Filter::kColor;
    fail(place, "meshopt filter '{}' is not known", printable(filter));
}

// A library that knows only the first version would call the second damaged.
void checkVersion(const Compression& c, Bytes source, const std::string& place) {
    constexpr unsigned kVertices = 0xa0;
    constexpr unsigned kNewest = MESHOPTIMIZER_VERSION >= 230 ? 1 : 0;
    if (c.mode != Compression::Mode::kAttributes || source.empty() || (source[0] & 0xf0u) != kVertices) return;
    if (const unsigned version = source[0] & 0x0fu; version > kNewest)
        fail(place, "is packed by version {} of meshopt's vertex codec, which meshoptimizer {}.{} cannot read", version,
             MESHOPTIMIZER_VERSION / 1000, MESHOPTIMIZER_VERSION / 10 % 100);
}

}  // namespace

const Json* findMeshopt(const Json& json, const std::string& place) {
    const Json* found = extension(json, "KHR_meshopt_compression", place);
    return found ? found : extension(json, "EXT_meshopt_compression", place);
}

Compression readCompression(const Json& json, size_t buffers, const std::string& place) {
    Compression c;
    c.buffer = requiredIndex(json, "buffer", buffers, place);
    c.offset = whole(json, "byteOffset", place).value_or(0);
    c.length = requiredWhole(json, "byteLength", place);
    const uint64_t stride = requiredWhole(json, "byteStride", place);
    if (stride > 256) fail(place, "meshopt byteStride {} does not suit its mode and filter", stride);
    c.stride = static_cast<uint32_t>(stride);
    c.count = requiredWhole(json, "count", place);
    c.mode = readMode(json, place);
    c.filter = readFilter(json, place);
    checkShape(c, place);
    if (!canHold(c)) fail(place, "{} meshopt bytes cannot hold {} elements", c.length, c.count);
    return c;
}

std::vector<unsigned char> decompress(const Compression& c, Bytes source, const std::string& place) {
    std::vector<unsigned char> out(c.decodedSize());
    if (out.empty()) return out;
    if (c.filter == Compression::Filter::kColor) fail(place, "meshopt filter 'COLOR' is for colours alone");
    checkVersion(c, source, place);
    int failed = 0;
    switch (c.mode) {
        case Compression::Mode::kAttributes:
            failed = meshopt_decodeVertexBuffer(out.data(), c.count, c.stride, source.data(), source.size());
            break;
        case Compression::Mode::kTriangles:
            failed = meshopt_decodeIndexBuffer(out.data(), c.count, c.stride, source.data(), source.size());
            break;
        case Compression::Mode::kIndices:
            failed = meshopt_decodeIndexSequence(out.data(), c.count, c.stride, source.data(), source.size());
            break;
    }
    if (failed) fail(place, "meshopt data is damaged");
    switch (c.filter) {
        case Compression::Filter::kNone:
            break;
        case Compression::Filter::kOctahedral:
            meshopt_decodeFilterOct(out.data(), c.count, c.stride);
            break;
        case Compression::Filter::kQuaternion:
            meshopt_decodeFilterQuat(out.data(), c.count, c.stride);
            break;
        case Compression::Filter::kExponential:
            meshopt_decodeFilterExp(out.data(), c.count, c.stride);
            break;
        case Compression::Filter::kColor:
            break;
    }
    return out;
}

}  // namespace sightline::tools::gltf
