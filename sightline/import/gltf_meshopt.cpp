// Decompresses buffer views of EXT_meshopt_compression.
// SPDX-License-Identifier: MIT
#include "sightline/import/gltf_meshopt.h"

#include <meshoptimizer.h>

namespace sightline::gltf {
namespace {

// The densest that each codec packs: blocks of 16 equal bytes take two bits, a triangle or an index a byte.
bool canHold(const Compression& c) {
    switch (c.mode) {
        case Compression::Mode::kAttributes:
            return c.decodedSize() / 64 <= c.length;
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
    if (c.filter == Filter::kOctahedral) right = c.stride == 4 || c.stride == 8;
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
    fail(place, "meshopt filter '{}' is not known", printable(filter));
}

}  // namespace

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
    }
    return out;
}

}  // namespace sightline::gltf
