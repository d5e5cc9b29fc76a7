// Compresses meshes of tests with Draco's own encoder.
// SPDX-License-Identifier: MIT
#include "gltf_draco_packer.h"

#include <memory>
#include <stdexcept>

#include <draco/compression/encode.h>
#include <draco/compression/expert_encode.h>
#include <draco/mesh/mesh.h>

namespace sightline::test {
namespace {

template <class T>
int addAttribute(draco::PointCloud& points, draco::GeometryAttribute::Type type, draco::DataType data, int components,
                 const std::vector<T>& values) {
    draco::GeometryAttribute attribute;
    attribute.Init(type, nullptr, static_cast<int8_t>(components), data, false, int64_t(sizeof(T)) * components, 0);
    const int id = points.AddAttribute(attribute, true, points.num_points());
    for (uint32_t i = 0; i < points.num_points(); ++i)
        points.attribute(id)->SetAttributeValue(draco::AttributeValueIndex(i), &values[size_t(i) * size_t(components)]);
    return id;
}

void addAttributes(draco::PointCloud& points, const PackedSource& source) {
    using Attribute = draco::GeometryAttribute;
    points.set_num_points(static_cast<uint32_t>(source.vertices()));
    addAttribute(points, Attribute::POSITION, draco::DT_FLOAT32, 3, source.positions);
    if (!source.normals.empty()) addAttribute(points, Attribute::NORMAL, draco::DT_FLOAT32, 3, source.normals);
    if (!source.joints.empty()) addAttribute(points, Attribute::GENERIC, draco::DT_UINT16, 4, source.joints);
    if (!source.weights.empty()) addAttribute(points, Attribute::GENERIC, draco::DT_FLOAT32, 4, source.weights);
}

std::string textOf(const draco::EncoderBuffer& buffer) { return {buffer.data(), buffer.size()}; }

}  // namespace

PackedStream packDraco(const PackedSource& source, const PackedSettings& settings) {
    draco::Mesh mesh;
    addAttributes(mesh, source);
    for (size_t i = 0; i < source.indices.size(); i += 3)
        mesh.AddFace({draco::PointIndex(source.indices[i]), draco::PointIndex(source.indices[i + 1]),
                      draco::PointIndex(source.indices[i + 2])});
    draco::ExpertEncoder encoder(mesh);
    encoder.SetEncodingMethod(settings.edgebreaker ? draco::MESH_EDGEBREAKER_ENCODING
                                                   : draco::MESH_SEQUENTIAL_ENCODING);
    encoder.SetSpeedOptions(settings.speed, settings.speed);
    if (settings.edgebreaker)
        encoder.SetEncodingSubmethod(settings.valence ? draco::MESH_EDGEBREAKER_VALENCE_ENCODING
                                                      : draco::MESH_EDGEBREAKER_STANDARD_ENCODING);
    if (settings.quantization) encoder.SetAttributeQuantization(0, settings.quantization);
    encoder.SetTrackEncodedProperties(true);
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodeToBuffer(&buffer); !status.ok())
        throw std::runtime_error(status.error_msg());
    return {textOf(buffer), encoder.num_encoded_points(), encoder.num_encoded_faces()};
}

std::string packDracoPoints(const PackedSource& source) {
    draco::PointCloud points;
    addAttributes(points, source);
    draco::Encoder encoder;
    draco::EncoderBuffer buffer;
    if (const draco::Status status = encoder.EncodePointCloudToBuffer(points, &buffer); !status.ok())
        throw std::runtime_error(status.error_msg());
    return textOf(buffer);
}

uint32_t addDracoMesh(GltfBuilder& b, const PackedSource& source, const PackedSettings& settings) {
    return addDracoMesh(b, source, packDraco(source, settings));
}

uint32_t addDracoMesh(GltfBuilder& b, const PackedSource& source, const PackedStream& stream) {
    b.json["extensionsUsed"] = b.json["extensionsRequired"] = {"KHR_draco_mesh_compression"};
    Json attributes = Json::object(), ids = Json::object();
    const auto add = [&](const char* name, int component, const char* type) {
        ids[name] = ids.size();
        attributes[name] =
            b.add("accessors", {{"componentType", component}, {"count", stream.vertices}, {"type", type}});
    };
    add("POSITION", 5126, "VEC3");
    if (!source.normals.empty()) add("NORMAL", 5126, "VEC3");
    if (!source.joints.empty()) add("JOINTS_0", 5123, "VEC4");
    if (!source.weights.empty()) add("WEIGHTS_0", 5126, "VEC4");
    const uint32_t indices =
        b.add("accessors", {{"componentType", 5125}, {"count", stream.triangles * 3}, {"type", "SCALAR"}});
    const Json extension = {{"bufferView", b.view(stream.bytes)}, {"attributes", ids}};
    return b.mesh(0, int(indices),
                  {{"attributes", attributes}, {"extensions", {{"KHR_draco_mesh_compression", extension}}}});
}

}  // namespace sightline::test
