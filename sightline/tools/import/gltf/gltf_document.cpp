// The tables of a glTF: buffers, buffer views and accessors, checked against the bytes that exist.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_document.h"

#include <algorithm>
#include <array>
#include <utility>

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

constexpr uint64_t kBytesPerInputByte = 512;
constexpr uint64_t kBytesPerPackedByte = 4096;

void readBuffers(Document& document) {
    const JsonTable array = document.json.table("buffers");
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("buffers", i);
        const Json json = array.object(i, place);
        Buffer buffer;
        buffer.length = requiredWhole(json, "byteLength", place);
        const Json* meshopt = findMeshopt(json, place);
        const bool fallback = meshopt && flag(*meshopt, "fallback", place);
        if (const Json* uri = find(json, "uri")) {
            if (!uri->is_string()) fail(place, "uri is not a string");
            buffer.source = Buffer::Source::kUri;
        } else if (i == 0 && document.chunk && !fallback) {
            buffer.source = Buffer::Source::kChunk;
            if (buffer.length > document.chunk->length)
                fail(place, "byteLength {} is more than the {} bytes of the GLB's BIN chunk", buffer.length,
                     document.chunk->length);
        }
        document.buffers.push_back(std::move(buffer));
    }
}

void checkRange(uint64_t offset, uint64_t length, const Buffer& buffer, const std::string& place) {
    if (offset > buffer.length || length > buffer.length - offset)
        fail(place, "{} bytes at {} reach beyond the {} bytes of its buffer", length, offset, buffer.length);
}

void readViews(Document& document) {
    const JsonTable array = document.json.table("bufferViews");
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("bufferViews", i);
        const Json json = array.object(i, place);
        BufferView view;
        view.buffer = requiredIndex(json, "buffer", document.buffers.size(), place);
        view.offset = whole(json, "byteOffset", place).value_or(0);
        view.length = requiredWhole(json, "byteLength", place);
        const uint64_t stride = whole(json, "byteStride", place).value_or(0);
        if (stride > 65536) fail(place, "byteStride {} is too large", stride);
        view.stride = static_cast<uint32_t>(stride);
        if (const Json* meshopt = findMeshopt(json, place)) {
            view.compression = readCompression(*meshopt, document.buffers.size(), place);
            checkRange(view.compression->offset, view.compression->length, document.buffers[view.compression->buffer],
                       place);
            view.length = view.compression->decodedSize();
        } else {
            checkRange(view.offset, view.length, document.buffers[view.buffer], place);
        }
        document.views.push_back(std::move(view));
    }
}

Component readComponent(const Json& json, const std::string& place) {
    const uint64_t value = requiredWhole(json, "componentType", place);
    if (value < 5120 || value > 5126 || value == 5124) fail(place, "componentType {} is not known", value);
    return static_cast<Component>(value);
}

uint32_t readComponents(const Json& json, const std::string& place) {
    constexpr std::array<std::pair<const char*, uint32_t>, 7> kTypes{
        {{"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}}};
    const std::string type = text(json, "type", place);
    for (const auto& [name, components] : kTypes)
        if (type == name) return components;
    fail(place, "type '{}' is not known", printable(type));
}

void checkElements(const Document& document, const Elements& elements, uint64_t count, uint32_t components,
                   const std::string& place) {
    if (!elements.view || count == 0) return;
    const BufferView& view = document.views[*elements.view];
    const uint32_t size = components * componentSize(elements.component);
    const uint32_t stride = view.stride ? view.stride : size;
    if (stride < size) fail(place, "elements of {} bytes overlap: byteStride is {}", size, stride);
    const bool fits = elements.offset <= view.length && size <= view.length - elements.offset &&
                      count - 1 <= (view.length - elements.offset - size) / stride;
    if (!fits)
        fail(place, "{} elements of {} bytes at {} reach beyond the {} bytes of bufferViews[{}]", count, size,
             elements.offset, view.length, *elements.view);
}

Sparse readSparse(const Document& document, const Json& json, const Accessor& accessor, const std::string& place) {
    Sparse sparse;
    sparse.count = requiredWhole(json, "count", place);
    if (sparse.count > accessor.count) fail(place, "replaces {} elements of {}", sparse.count, accessor.count);
    const auto part = [&](const char* key, Elements& out) {
        const Json* member = findObject(json, key, place);
        if (!member) fail(place, "{} is missing", key);
        out.view = requiredIndex(*member, "bufferView", document.views.size(), place);
        out.offset = whole(*member, "byteOffset", place).value_or(0);
        return member;
    };
    sparse.indices.component = readComponent(*part("indices", sparse.indices), place);
    part("values", sparse.values);
    sparse.values.component = accessor.elements.component;
    const Component kind = sparse.indices.component;
    if (kind != Component::kUnsignedByte && kind != Component::kUnsignedShort && kind != Component::kUnsignedInt)
        fail(place, "indices are not unsigned integers");
    checkElements(document, sparse.indices, sparse.count, 1, place);
    checkElements(document, sparse.values, sparse.count, accessor.components, place);
    return sparse;
}

void readAccessors(Document& document) {
    const JsonTable array = document.json.table("accessors");
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("accessors", i);
        const Json json = array.object(i, place);
        Accessor accessor;
        accessor.number = static_cast<uint32_t>(i);
        accessor.elements.view = index(json, "bufferView", document.views.size(), place);
        accessor.elements.offset = whole(json, "byteOffset", place).value_or(0);
        accessor.elements.component = readComponent(json, place);
        accessor.components = readComponents(json, place);
        accessor.count = requiredWhole(json, "count", place);
        accessor.normalized = flag(json, "normalized", place);
        checkElements(document, accessor.elements, accessor.count, accessor.components, place);
        if (accessor.count > 0xffffffff) fail(place, "count {} is too large", accessor.count);
        if (const Json* sparse = findObject(json, "sparse", place))
            accessor.sparse = readSparse(document, *sparse, accessor, place + ".sparse");
        document.accessors.push_back(std::move(accessor));
    }
}

void openFile(Document& document, Buffer& buffer, const std::string& uri, const std::string& place) {
    if (!document.directory) fail(place, "file '{}' is not opened: the glTF came from memory", printable(uri));
    const std::string path = uriPath(uri, *document.directory, place);
    buffer.file = ByteSource::open(path, place + ": '" + printable(uri) + "'", buffer.length);
    if (buffer.file.size() < buffer.length)
        fail(place, "'{}' holds {} of {} bytes", printable(uri), buffer.file.size(), buffer.length);
    document.budget.grant(buffer.file.size());
}

void openBuffer(Document& document, uint32_t index, const std::string& place) {
    Buffer& buffer = document.buffers[index];
    if (buffer.source == Buffer::Source::kUri) {
        const std::string uri = text(document.json.table("buffers")[index], "uri", place);
        if (isDataUri(uri)) {
            buffer.owned = decodeDataUri(uri, place);
            if (buffer.owned.size() < buffer.length)
                fail(place, "data URI holds {} of {} bytes", buffer.owned.size(), buffer.length);
            buffer.file = ByteSource(buffer.owned);
        } else {
            openFile(document, buffer, uri, place);
        }
    }
    buffer.opened = true;
}

// Bytes of a buffer that are known to lie in it.
Bytes bufferBytes(Document& document, uint32_t index, uint64_t offset, uint64_t length) {
    Buffer& buffer = document.buffers[index];
    const std::string place = at("buffers", index);
    if (buffer.source == Buffer::Source::kNone) fail(place, "has no data");
    if (!buffer.opened) openBuffer(document, index, place);
    if (buffer.source == Buffer::Source::kChunk) return document.bytes.read({document.chunk->offset + offset, length});
    return buffer.file.read({offset, length});
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

uint32_t componentSize(Component component) {
    switch (component) {
        case Component::kByte:
        case Component::kUnsignedByte:
            return 1;
        case Component::kShort:
        case Component::kUnsignedShort:
            return 2;
        case Component::kUnsignedInt:
        case Component::kFloat:
            return 4;
    }
    return 4;
}

void Budget::grant(uint64_t input_bytes) { left_ += input_bytes * kBytesPerInputByte; }

void Budget::grantPacked(uint64_t input_bytes) {
    const uint64_t more = std::min(packed_left_, input_bytes * (kBytesPerPackedByte - kBytesPerInputByte));
    packed_left_ -= more;
    left_ += more;
}

void Budget::charge(uint64_t count, uint64_t bytes_each, const std::string& place) {
    if (bytes_each != 0 && count > left_ / bytes_each)
        fail(place, "asks for more than {} times the memory of the bytes that it holds", kBytesPerInputByte);
    left_ -= count * bytes_each;
}

void Progress::reach(size_t from, size_t to, double part) {
    const size_t done = from + static_cast<size_t>(static_cast<double>(to - from) * std::clamp(part, 0.0, 1.0));
    if (!report_ || done <= told_) return;
    told_ = done;
    report_(done, kTotal);
}

void readTables(Document& document) {
    readBuffers(document);
    readViews(document);
    readAccessors(document);
}

std::string accessorPlace(const Document& document, uint32_t index) {
    const Accessor& accessor = document.accessors[index];
    if (accessor.number != Accessor::kNone) return at("accessors", accessor.number);
    return document.streams[*document.views[*accessor.elements.view].stream].place;
}

Bytes viewBytes(Document& document, uint32_t index) {
    BufferView& view = document.views[index];
    if (view.stream) return view.data;
    if (!view.compression) return bufferBytes(document, view.buffer, view.offset, view.length);
    if (!view.decoded) {
        const std::string place = at("bufferViews", index);
        const Bytes source =
            bufferBytes(document, view.compression->buffer, view.compression->offset, view.compression->length);
        document.budget.charge(view.length, 1, place);
        view.data = decompress(*view.compression, source, place);
        view.decoded = true;
    }
    return view.data;
}

}  // namespace sightline::tools::gltf
