// Writes a scene as a stream of bytes.
// SPDX-License-Identifier: MIT
#include <algorithm>
#include <utility>

#include "sightline/tools/import/foreign/scene_stream.h"

namespace sightline::tools {

using namespace scene_stream;

SceneStreamWriter::SceneStreamWriter(Sink sink) : sink_(std::move(sink)) { sink_(kMagic, sizeof kMagic); }

template <class T>
void SceneStreamWriter::put(const T& value) {
    static_assert(kRaw<T>);
    sink_(&value, sizeof value);
}

void SceneStreamWriter::put(const std::string& text) {
    const size_t size = std::min<size_t>(text.size(), kLongestText);
    put(static_cast<uint32_t>(size));
    if (size > 0) sink_(text.data(), size);
}

template <class T>
void SceneStreamWriter::putAll(const std::vector<T>& values) {
    static_assert(kRaw<T>);
    if (!values.empty()) sink_(values.data(), values.size() * sizeof(T));
}

void SceneStreamWriter::head(uint32_t kind, uint64_t size) {
    put(kind);
    put(size);
}

namespace {

uint64_t textSize(const std::string& text) { return sizeof(uint32_t) + std::min<uint64_t>(text.size(), kLongestText); }

}  // namespace

void SceneStreamWriter::progress(uint64_t done, uint64_t total) {
    head(kProgress, 16);
    put(done);
    put(total);
    sink_(kMagic, 0);
}

void SceneStreamWriter::note(const std::string& text) {
    head(kNote, textSize(text));
    put(text);
}

void SceneStreamWriter::fault(const std::string& text) {
    head(kFault, textSize(text));
    put(text);
}

void SceneStreamWriter::material(const Material& material) {
    head(kMaterial, 16 + 4 + 3 + textSize(material.name));
    put(material.base_color);
    put(material.alpha_cutoff);
    put(material.alpha_mode);
    put(static_cast<uint8_t>(material.double_sided));
    put(static_cast<uint8_t>(material.transmissive));
    put(material.name);
    ++counts_[kMaterials];
}

void SceneStreamWriter::node(const SceneNode& node) {
    head(kNode, 4 + textSize(node.name));
    put(node.parent);
    put(node.name);
    ++counts_[kNodes];
}

void SceneStreamWriter::mesh(const Mesh& mesh) {
    const uint64_t positions = mesh.positions.size(), triangles = mesh.triangles(), parts = mesh.primitives.size();
    head(kMesh, 3 * 8 + 1 + 48 + textSize(mesh.name) + parts * sizeof(Primitive) + positions * 12 + triangles * 12);
    put(positions);
    put(triangles);
    put(parts);
    put(static_cast<uint8_t>(mesh.deforms));
    put(mesh.bounds.min);
    put(mesh.bounds.max);
    put(mesh.name);
    putAll(mesh.primitives);
    putAll(mesh.positions);
    putAll(mesh.indices);
    ++counts_[kMeshes];
}

void SceneStreamWriter::object(const SceneObject& object) {
    head(kObject, 9 + 128 + textSize(object.name));
    put(object.mesh);
    put(object.node);
    put(object.changes);
    put(object.transform);
    put(object.name);
    ++counts_[kObjects];
}

void SceneStreamWriter::camera(const SceneCamera& camera) {
    head(kCamera, 128 + 4 * 8 + textSize(camera.name));
    put(camera.transform);
    put(camera.fov_y);
    put(camera.orthographic_height);
    put(camera.z_near);
    put(camera.z_far.value_or(0.0));
    put(camera.name);
    ++counts_[kCameras];
}

void SceneStreamWriter::room(const SceneRoom& room) {
    head(kRoom, 4 + 48);
    put(room.node);
    put(room.bounds.min);
    put(room.bounds.max);
    ++counts_[kRooms];
}

void SceneStreamWriter::part(const std::string& text) {
    head(kPart, textSize(text));
    put(text);
    sink_(kMagic, 0);
}

void SceneStreamWriter::end() {
    head(kEnd, sizeof counts_);
    put(counts_);
}

}  // namespace sightline::tools
