// Decodes Draco streams that are not trusted with Draco's library.
// SPDX-License-Identifier: MIT
//
// Frank Galligan. Draco Bitstream Specification, version 2.2. 2017.
//
// A stream of a few bytes may claim billions of triangles, and the library allocates for them before it looks for them.
// So its decoders are stopped at the two places where such claims stand: before the connectivity, and before the
// attributes.
#include <algorithm>
#include <cstring>
#include <memory>

#include <draco/compression/mesh/mesh_edgebreaker_decoder.h>
#include <draco/compression/mesh/mesh_sequential_decoder.h>
#include <draco/core/varint_decoding.h>
#include <draco/mesh/mesh.h>

#include "sightline/tools/import/gltf/gltf_draco.h"

namespace sightline::tools::gltf {
namespace {

// What the library holds while it decodes, generously. [bytes]
constexpr uint64_t kPerTriangle = 192;  // corner tables, seams, points of corners, the stack of the traversal
constexpr uint64_t kPerTriangleAndAttribute = 128;  // a corner table with seams of its own
constexpr uint64_t kPerVertex = 64;
constexpr uint64_t kPerVertexAndAttribute = 16;
constexpr uint64_t kPerComponent = 16;  // the value, its portable form, what predicts it

// Returns to the budget what was charged while it lives.
class Loan {
public:
    Loan(Budget& budget, const std::string& place) : budget_(budget), place_(place) {}
    ~Loan() { budget_.giveBack(charged_); }
    Loan(const Loan&) = delete;
    Loan& operator=(const Loan&) = delete;

    void charge(uint64_t count, uint64_t bytes_each) {
        budget_.charge(count, bytes_each, place_);
        charged_ += count * bytes_each;
    }
    const std::string& place() const { return place_; }

private:
    Budget& budget_;
    std::string place_;
    uint64_t charged_ = 0;
};

struct Claims {
    uint32_t triangles = 0, vertices = 0;
    uint8_t attribute_tables = 0;
};

// The head of the connectivity, read from a copy of the buffer.
bool readClaims(draco::DecoderBuffer buffer, bool edgebreaker, Claims& out) {
    if (!edgebreaker)
        return draco::DecodeVarint(&out.triangles, &buffer) && draco::DecodeVarint(&out.vertices, &buffer);
    return draco::DecodeVarint(&out.vertices, &buffer) && draco::DecodeVarint(&out.triangles, &buffer) &&
           buffer.Decode(&out.attribute_tables);
}

/// One of the library's decoders, which stops at claims that do not fit. A Fault waits outside of the library's frames.
template <class Base>
class Watched : public Base {
public:
    Watched(Loan& loan, const DracoCounts& counts, bool edgebreaker)
        : loan_(loan), counts_(counts), edgebreaker_(edgebreaker) {}

    std::optional<Fault> fault;

protected:
    bool DecodeConnectivity() override {
        const bool fits = watched([&] {
            Claims claims;
            if (!readClaims(*this->buffer(), edgebreaker_, claims)) fail(loan_.place(), "its Draco data is truncated");
            if (counts_.triangles && claims.triangles != *counts_.triangles)
                fail(loan_.place(), "its Draco data has {} triangles, its indices {}", claims.triangles,
                     *counts_.triangles);
            loan_.charge(claims.triangles, kPerTriangle + claims.attribute_tables * kPerTriangleAndAttribute);
            loan_.charge(claims.vertices, kPerVertex);
        });
        return fits && Base::DecodeConnectivity();
    }

    bool DecodeAllAttributes() override {
        const bool fits = watched([&] {
            const draco::PointCloud& points = *this->point_cloud();
            if (counts_.vertices && points.num_points() != *counts_.vertices)
                fail(loan_.place(), "its Draco data has {} vertices, its accessors {}", points.num_points(),
                     *counts_.vertices);
            uint64_t bytes = 0;
            for (int32_t i = 0; i < points.num_attributes(); ++i)
                bytes += kPerVertexAndAttribute + uint64_t(points.attribute(i)->num_components()) * kPerComponent;
            loan_.charge(points.num_points(), bytes);
        });
        return fits && Base::DecodeAllAttributes();
    }

private:
    template <class Check>
    bool watched(Check&& check) {
        try {
            check();
            return true;
        } catch (const Fault& caught) {
            fault = caught;
            return false;
        }
    }

    Loan& loan_;
    DracoCounts counts_;
    bool edgebreaker_;
};

template <class Base>
void decodeWith(Bytes stream, const DracoCounts& counts, bool edgebreaker, Loan& loan, draco::Mesh& mesh) {
    draco::DecoderBuffer buffer;
    buffer.Init(reinterpret_cast<const char*>(stream.data()), stream.size());
    const draco::DecoderOptions options;
    Watched<Base> decoder(loan, counts, edgebreaker);
    const draco::Status status = decoder.Decode(options, &buffer, &mesh);
    if (decoder.fault) throw *decoder.fault;
    if (!status.ok()) fail(loan.place(), "its Draco data is damaged");
}

void decodeMesh(Bytes stream, const DracoCounts& counts, Loan& loan, draco::Mesh& mesh) {
    const std::string& place = loan.place();
    constexpr size_t kHeader = 11;  // "DRACO", version, kind, method, flags
    if (stream.size() < kHeader || std::memcmp(stream.data(), "DRACO", 5) != 0) fail(place, "its data is not Draco's");
    const unsigned major = stream[5], minor = stream[6], kind = stream[7], method = stream[8];
    if (kind == draco::POINT_CLOUD) fail(place, "its Draco data is a point cloud, not triangles");
    if (kind != draco::TRIANGULAR_MESH) fail(place, "its Draco data is of unknown kind {}", kind);
    if (major != 2 || minor != 2) fail(place, "its Draco data is of version {}.{}, not 2.2", major, minor);
    if (method == draco::MESH_SEQUENTIAL_ENCODING)
        decodeWith<draco::MeshSequentialDecoder>(stream, counts, false, loan, mesh);
    else if (method == draco::MESH_EDGEBREAKER_ENCODING)
        decodeWith<draco::MeshEdgebreakerDecoder>(stream, counts, true, loan, mesh);
    else fail(place, "its Draco data is encoded by unknown method {}", method);
}

// The library also has 64-bit types, and a bool that it reads from any byte. glTF has none of them.
bool isComponent(draco::DataType type) {
    return (type >= draco::DT_INT8 && type <= draco::DT_UINT32) || type == draco::DT_FLOAT32;
}

template <class To>
bool convert(const draco::PointAttribute& attribute, uint32_t vertices, uint32_t components, unsigned char* out) {
    To element[16];
    for (uint32_t i = 0; i < vertices; ++i, out += components * sizeof(To)) {
        const draco::AttributeValueIndex value = attribute.mapped_index(draco::PointIndex(i));
        if (value.value() >= attribute.size()) return false;
        if (!attribute.ConvertValue<To>(value, static_cast<int8_t>(components), element)) return false;
        std::memcpy(out, element, components * sizeof(To));
    }
    return true;
}

bool convertAs(Component component, const draco::PointAttribute& attribute, uint32_t vertices, uint32_t components,
               unsigned char* out) {
    switch (component) {
        case Component::kByte:
            return convert<int8_t>(attribute, vertices, components, out);
        case Component::kUnsignedByte:
            return convert<uint8_t>(attribute, vertices, components, out);
        case Component::kShort:
            return convert<int16_t>(attribute, vertices, components, out);
        case Component::kUnsignedShort:
            return convert<uint16_t>(attribute, vertices, components, out);
        case Component::kUnsignedInt:
            return convert<uint32_t>(attribute, vertices, components, out);
        case Component::kFloat:
            return convert<float>(attribute, vertices, components, out);
    }
    return false;
}

std::vector<unsigned char> readAttribute(const draco::Mesh& mesh, const DracoAttribute& wanted, Loan& loan) {
    const draco::PointAttribute* attribute = mesh.GetAttributeByUniqueId(wanted.id);
    if (!attribute) fail(loan.place(), "its Draco data has no attribute {} for {}", wanted.id, wanted.name);
    if (attribute->num_components() != wanted.components)
        fail(loan.place(), "its Draco data has {} components a {}, its accessor {}", int(attribute->num_components()),
             wanted.name, wanted.components);
    if (!isComponent(attribute->data_type()))
        fail(loan.place(), "its Draco data has a {} of a type that glTF has not", wanted.name);
    const uint64_t stride = uint64_t(wanted.components) * componentSize(wanted.component);
    loan.charge(mesh.num_points(), stride);
    std::vector<unsigned char> out(mesh.num_points() * stride);
    // The values of a damaged stream may be fewer than what its points are mapped to.
    const bool whole = attribute->is_mapping_identity() ? attribute->size() >= mesh.num_points()
                                                        : attribute->indices_map_size() >= mesh.num_points();
    if (!whole || !attribute->buffer() ||
        attribute->size() * uint64_t(attribute->byte_stride()) > attribute->buffer()->data_size() ||
        !convertAs(wanted.component, *attribute, mesh.num_points(), wanted.components, out.data()))
        fail(loan.place(), "its Draco data is damaged: {}", wanted.name);
    return out;
}

}  // namespace

bool dracoSupported() { return true; }

DracoMesh decodeDraco(Bytes stream, const std::vector<DracoAttribute>& attributes, const DracoCounts& counts,
                      Budget& budget, const std::string& place) {
    Loan loan(budget, place);
    draco::Mesh mesh;
    decodeMesh(stream, counts, loan, mesh);
    DracoMesh out;
    out.vertices = mesh.num_points();
    loan.charge(mesh.num_faces(), 3 * sizeof(uint32_t));
    out.indices.reserve(size_t(mesh.num_faces()) * 3);
    for (uint32_t face = 0; face < mesh.num_faces(); ++face)
        for (const draco::PointIndex& corner : mesh.face(draco::FaceIndex(face))) {
            if (corner.value() >= out.vertices)
                fail(place, "its Draco data has vertex {} of {}", corner.value(), out.vertices);
            out.indices.push_back(corner.value());
        }
    if (counts.triangles && mesh.num_faces() != *counts.triangles)
        fail(place, "its Draco data has {} triangles, its indices {}", mesh.num_faces(), *counts.triangles);
    for (const DracoAttribute& attribute : attributes) out.attributes.push_back(readAttribute(mesh, attribute, loan));
    return out;
}

}  // namespace sightline::tools::gltf
