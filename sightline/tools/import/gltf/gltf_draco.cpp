// Puts the data of Draco streams in the place of a primitive's accessors.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_draco.h"

#include <algorithm>
#include <cstring>
#include <utility>

namespace sightline::tools::gltf {
namespace {

// A packed view without a buffer, filled when its stream is unpacked, and an accessor to it.
uint32_t addAccessor(Document& document, Accessor accessor, uint32_t stream) {
    BufferView view;
    view.stream = stream;
    accessor.elements.view = static_cast<uint32_t>(document.views.size());
    accessor.elements.offset = 0;
    accessor.sparse.reset();
    document.views.push_back(std::move(view));
    document.accessors.push_back(std::move(accessor));
    return static_cast<uint32_t>(document.accessors.size() - 1);
}

// The accessors of the attributes that the stream holds, one after another, each with its id there.
DracoStream readStream(const Document& document, const Json& json, const NamedAccessors& attributes,
                       const std::optional<uint32_t>& indices, bool triangles, const std::string& place) {
    DracoStream stream;
    stream.place = place;
    stream.view = requiredIndex(json, "bufferView", document.views.size(), place);
    stream.counts_triangles = triangles && indices;
    const Json* ids = findObject(json, "attributes", place);
    if (!ids) fail(place, "its Draco data is without attributes");
    for (const auto& [name, accessor] : attributes) {
        const std::optional<uint64_t> id = whole(*ids, name.c_str(), place);
        if (!id) continue;
        if (*id > 0xffffffff) fail(place, "{} {} is no id of a Draco attribute", name, *id);
        stream.attributes.push_back({name, static_cast<uint32_t>(*id), accessor});
    }
    if (indices) stream.indices = *indices;
    return stream;
}

// What makes two primitives share a stream.
std::vector<uint64_t> keyOf(const DracoStream& stream) {
    std::vector<uint64_t> key = {stream.view, stream.indices ? *stream.indices + uint64_t(1) : 0,
                                 stream.counts_triangles};
    for (const DracoStream::Attribute& attribute : stream.attributes) {
        key.push_back(attribute.id);
        key.push_back(attribute.accessor);
    }
    return key;
}

void addAccessors(Document& document, DracoStream& stream, uint32_t index) {
    for (DracoStream::Attribute& attribute : stream.attributes) {
        const Accessor& declared = document.accessors[attribute.accessor];
        stream.vertices = stream.vertices.value_or(declared.count);
        if (*stream.vertices != declared.count)
            fail(stream.place, "its Draco attributes have {} and {} elements", *stream.vertices, declared.count);
        attribute.accessor = addAccessor(document, declared, index);
    }
    Accessor corners;
    if (stream.indices) corners = document.accessors[*stream.indices];
    if (corners.components != 1) fail(stream.place, "its indices have {} components", corners.components);
    if (stream.counts_triangles) stream.triangles = corners.count / 3;
    corners.elements.component = Component::kUnsignedInt;
    corners.normalized = false;
    stream.indices = addAccessor(document, corners, index);
}

void fill(Document& document, uint32_t accessor, std::vector<unsigned char> data, uint64_t count) {
    BufferView& view = document.views[*document.accessors[accessor].elements.view];
    document.accessors[accessor].count = count;
    view.length = data.size();
    view.data = std::move(data);
    view.decoded = true;
}

}  // namespace

uint32_t useDraco(Document& document, const Json& json, NamedAccessors& attributes, std::optional<uint32_t>& indices,
                  bool triangles, const std::string& place) {
    DracoStream stream = readStream(document, json, attributes, indices, triangles, place);
    const auto [known, fresh] =
        document.known_streams.try_emplace(keyOf(stream), static_cast<uint32_t>(document.streams.size()));
    if (fresh) {
        addAccessors(document, stream, known->second);
        document.streams.push_back(std::move(stream));
    }
    const DracoStream& shared = document.streams[known->second];
    for (const DracoStream::Attribute& attribute : shared.attributes)
        for (auto& [name, accessor] : attributes)
            if (name == attribute.name) accessor = attribute.accessor;
    indices = shared.indices;
    return known->second;
}

void unpackDraco(Document& document, uint32_t index) {
    if (document.streams[index].held > 0) return;
    const Bytes bytes = viewBytes(document, document.streams[index].view);
    DracoStream& stream = document.streams[index];
    if (!std::exchange(stream.granted, true)) document.budget.grantPacked(bytes.size());
    std::vector<DracoAttribute> wanted;
    for (const DracoStream::Attribute& attribute : stream.attributes) {
        const Accessor& accessor = document.accessors[attribute.accessor];
        wanted.push_back({attribute.name, attribute.id, accessor.elements.component, accessor.components});
    }
    DracoMesh mesh = decodeDraco(bytes, wanted, {stream.triangles, stream.vertices}, document.budget, stream.place);
    uint64_t held = mesh.indices.size() * sizeof(uint32_t);
    for (const std::vector<unsigned char>& data : mesh.attributes) held += data.size();
    document.budget.charge(held, 1, stream.place);
    stream.held = held;
    std::vector<unsigned char> corners(mesh.indices.size() * sizeof(uint32_t));
    if (!corners.empty()) std::memcpy(corners.data(), mesh.indices.data(), corners.size());
    fill(document, *stream.indices, std::move(corners), mesh.indices.size());
    for (size_t i = 0; i < wanted.size(); ++i)
        fill(document, stream.attributes[i].accessor, std::move(mesh.attributes[i]), mesh.vertices);
}

void retainDraco(Document& document, uint32_t stream) { ++document.streams[stream].uses; }

void releaseDraco(Document& document, uint32_t index) {
    DracoStream& stream = document.streams[index];
    if (--stream.uses > 0) return;
    document.budget.giveBack(stream.held);
    stream.held = 0;
    const auto drop = [&](uint32_t accessor) {
        BufferView& view = document.views[*document.accessors[accessor].elements.view];
        view.data = {};
        view.decoded = false;
    };
    drop(*stream.indices);
    for (const DracoStream::Attribute& attribute : stream.attributes) drop(attribute.accessor);
}

}  // namespace sightline::tools::gltf
