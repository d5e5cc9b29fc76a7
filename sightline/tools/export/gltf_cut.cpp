// Writes a glTF again with its meshes cut: materials, textures, animations and all else as they were.
// SPDX-License-Identifier: MIT
#include "sightline/tools/export/gltf_cut.h"

#include <algorithm>
#include <cstring>
#include <limits>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include <fmt/core.h>

#include "sightline/tools/export/glb.h"
#include "sightline/tools/import/gltf/gltf_draco.h"
#include "sightline/tools/import/gltf/gltf_features.h"
#include "sightline/tools/import/gltf/gltf_meshes.h"
#include "sightline/tools/import/gltf/gltf_open.h"

namespace sightline::tools {
namespace {

using namespace gltf;

constexpr uint32_t kAbsent = ~0u;
constexpr const char* kDraco = "KHR_draco_mesh_compression";
constexpr const char* kInstancing = "EXT_mesh_gpu_instancing";

template <class T>
double readAs(const unsigned char* from) {
    T value;
    std::memcpy(&value, from, sizeof value);
    return static_cast<double>(value);
}

/// One component of an element, as the file has it.
double readComponent(const unsigned char* from, Component component) {
    switch (component) {
        case Component::kByte:
            return readAs<int8_t>(from);
        case Component::kUnsignedByte:
            return readAs<uint8_t>(from);
        case Component::kShort:
            return readAs<int16_t>(from);
        case Component::kUnsignedShort:
            return readAs<uint16_t>(from);
        case Component::kUnsignedInt:
            return readAs<uint32_t>(from);
        case Component::kFloat:
            break;
    }
    return readAs<float>(from);
}

/// Takes the named extension out of an object's `extensions`, and those if they are empty then.
void dropExtension(Json& object, const std::string& name) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object()) return;
    extensions->erase(name);
    if (extensions->empty()) object.erase(extensions);
}

/// What the pixels of an image are packed by, from their first bytes; empty: not known.
std::string mimeOf(const std::string& bytes) {
    if (bytes.starts_with("\x89PNG")) return "image/png";
    if (bytes.starts_with("\xff\xd8\xff")) return "image/jpeg";
    if (bytes.starts_with("\xabKTX 20")) return "image/ktx2";
    if (bytes.starts_with("DDS ")) return "image/vnd-ms.dds";
    if (bytes.starts_with("RIFF") && bytes.size() > 12 && bytes.compare(8, 4, "WEBP") == 0) return "image/webp";
    return {};
}

class GltfCutter {
public:
    GltfCutter(Document document, const std::string& file, const CutScene& cut)
        : file_(file),
          cut_(cut),
          document_(std::move(document)),
          in_(document_.json.all()),
          accessor_at_(document_.accessors.size(), kAbsent),
          view_at_(document_.views.size(), kAbsent),
          mesh_at_(table(in_, "meshes").size(), kAbsent) {
        Materials materials = readMaterials(document_);
        sources_ = readMeshes(document_, materials);
    }

    Result<WrittenGltf> write() {
        dropUnknown();
        out_.json = in_;
        for (const char* key : {"buffers", "bufferViews", "accessors", "meshes", "nodes", "images"})
            out_.json.erase(key);
        out_.json["asset"]["generator"] = "Sightline";
        writeImages();
        writeSkins();
        writeAnimations();
        writeMetadata();
        writeNodes();
        movePointers();
        nameExtensions();
        Result<std::string> bytes = out_.bytes(file_);
        if (!bytes) return bytes.error();
        return WrittenGltf{std::move(*bytes), std::move(notes_)};
    }

private:
    using Triangles = std::vector<uint32_t>;

    /// The mesh of a cut scene that a node draws, and how the pieces of it are called.
    struct Piece {
        uint32_t mesh = 0;  ///< in the cut scene
        std::string name;
    };

    // What is not known may refer to buffers, which are all new.
    void dropUnknown() {
        std::set<std::string> unknown;
        dropUnknownIn(in_, unknown);
        for (const std::string& name : unknown)
            notes_.push_back(fmt::format("an extension that is not known is left out: {}", printable(name)));
    }

    void dropUnknownIn(Json& value, std::set<std::string>& unknown) {
        if (value.is_array() || value.is_object())
            for (Json& inner : value) dropUnknownIn(inner, unknown);
        if (!value.is_object()) return;
        const auto extensions = value.find("extensions");
        if (extensions == value.end() || !extensions->is_object()) return;
        std::vector<std::string> names;
        for (const auto& [name, inner] : extensions->items())
            if (!featureOf(name).understood) names.push_back(name);
        for (const std::string& name : names) dropExtension(value, name);
        unknown.insert(names.begin(), names.end());
    }

    /// A buffer view of the file, unpacked, in the new one.
    uint32_t viewAt(uint32_t view) {
        if (view_at_[view] != kAbsent) return view_at_[view];
        Json json = table(in_, "bufferViews")[view];
        for (const char* name : {"EXT_meshopt_compression", "KHR_meshopt_compression"}) dropExtension(json, name);
        return view_at_[view] = out_.addView(viewBytes(document_, view), Glb::Target::kNone, 0, std::move(json));
    }

    void moveView(Json& owner, const char* key) {
        if (const auto found = owner.find(key); found != owner.end())
            *found = viewAt(requiredIndex(owner, key, view_at_.size(), key));
    }

    /// An accessor of the file in the new one, with its view.
    uint32_t accessorAt(uint32_t accessor) {
        if (accessor_at_[accessor] != kAbsent) return accessor_at_[accessor];
        Json json = table(in_, "accessors")[accessor];
        moveView(json, "bufferView");
        if (json.contains("sparse"))
            for (const char* part : {"indices", "values"}) moveView(json["sparse"][part], "bufferView");
        return accessor_at_[accessor] = out_.add("accessors", std::move(json));
    }

    void moveAccessor(Json& owner, const char* key, const std::string& place) {
        if (const auto found = owner.find(key); found != owner.end())
            *found = accessorAt(requiredIndex(owner, key, accessor_at_.size(), place));
    }

    /// All members of an object, which are accessors of the file.
    NamedAccessors namesIn(const Json& object, const std::string& place) const {
        NamedAccessors out;
        for (const auto& [name, value] : object.items())
            out.emplace_back(name, requiredIndex(object, name.c_str(), accessor_at_.size(), place));
        return out;
    }

    void moveAccessors(Json& object, const std::string& place) {
        for (const auto& [name, accessor] : namesIn(object, place)) object[name] = accessorAt(accessor);
    }

    // The folder is the file's own; what is not found there stays outside.
    void writeImages() {
        Json images = table(in_, "images");
        for (size_t i = 0; i < images.size(); ++i) {
            Json& image = images[i];
            if (!image.is_object()) fail(at("images", i), "is not an object");
            if (image.contains("bufferView")) {
                image["bufferView"] = viewAt(requiredIndex(image, "bufferView", view_at_.size(), at("images", i)));
                continue;
            }
            const std::string uri = text(image, "uri", at("images", i));
            if (uri.empty() || isDataUri(uri)) continue;
            if (!embed(image, uri, at("images", i)))
                notes_.push_back(fmt::format("an image stays outside: {}", printable(uri)));
        }
        if (!images.empty()) out_.json["images"] = std::move(images);
    }

    bool embed(Json& image, const std::string& uri, const std::string& place) {
        constexpr uint64_t kMost = uint64_t(1) << 30;
        if (!document_.directory) return false;
        std::string bytes;
        try {
            ByteSource source = ByteSource::open(uriPath(uri, *document_.directory, place), place, kMost + 1);
            if (source.size() > kMost) return false;
            const Bytes all = source.read({0, source.size()});
            bytes.assign(all.begin(), all.end());
        } catch (const Fault&) { return false; }
        const std::string mime = mimeOf(bytes);
        if (mime.empty()) return false;
        image.erase("uri");
        image["mimeType"] = mime;
        image["bufferView"] = out_.addView({reinterpret_cast<const unsigned char*>(bytes.data()), bytes.size()});
        return true;
    }

    void writeSkins() {
        if (!out_.json.contains("skins")) return;
        Json& skins = out_.json["skins"];
        for (size_t i = 0; i < skins.size(); ++i) moveAccessor(skins[i], "inverseBindMatrices", at("skins", i));
    }

    void writeAnimations() {
        if (!out_.json.contains("animations")) return;
        Json& animations = out_.json["animations"];
        for (size_t i = 0; i < animations.size(); ++i) {
            const std::string place = at("animations", i);
            if (!table(animations[i], "samplers", place).empty())
                for (Json& sampler : animations[i]["samplers"])
                    for (const char* key : {"input", "output"}) moveAccessor(sampler, key, place);
        }
    }

    /// Meshes are numbered anew, and animations may aim at their numbers. What has weights is never cut.
    void movePointers() {
        constexpr std::string_view kMeshes = "/meshes/";
        if (!out_.json.contains("animations")) return;
        Json& animations = out_.json["animations"];
        for (size_t i = 0; i < animations.size(); ++i) {
            if (table(animations[i], "channels", at("animations", i)).empty()) continue;
            for (Json& channel : animations[i]["channels"]) {
                const Json* target = find(channel, "target");
                const Json* aim = target ? extension(*target, "KHR_animation_pointer", "") : nullptr;
                const std::string pointer = aim ? text(*aim, "pointer", "") : "";
                if (!pointer.starts_with(kMeshes)) continue;
                const size_t number = std::strtoul(pointer.c_str() + kMeshes.size(), nullptr, 10);
                const size_t rest = std::min(pointer.find('/', kMeshes.size()), pointer.size());
                if (number >= mesh_at_.size()) fail("", "pointer '{}' aims at no mesh", printable(pointer));
                channel["target"]["extensions"]["KHR_animation_pointer"]["pointer"] =
                    fmt::format("{}{}{}", kMeshes, wholeMesh(static_cast<uint32_t>(number)), pointer.substr(rest));
            }
        }
    }

    void writeMetadata() {
        const std::string place = "extensions.EXT_structural_metadata";
        if (!extension(out_.json, "EXT_structural_metadata", "")) return;
        Json& metadata = out_.json["extensions"]["EXT_structural_metadata"];
        if (table(metadata, "propertyTables", place).empty()) return;
        for (Json& properties : metadata["propertyTables"]) {
            if (!findObject(properties, "properties", place)) continue;
            for (Json& property : properties["properties"])
                for (const char* key : {"values", "arrayOffsets", "stringOffsets"})
                    if (property.is_object()) moveView(property, key);
        }
    }

    void writeNodes() {
        Json nodes = table(in_, "nodes");
        const size_t count = nodes.size();
        std::vector<std::vector<uint32_t>> before(count), after(count);  // objects of a node, and of the cut scene
        for (uint32_t i = 0; i < cut_.keys.size(); ++i) {
            if (cut_.keys[i] >= count) fail("", "has changed since it was read");
            before[cut_.keys[i]].push_back(i);
        }
        for (uint32_t i = 0; i < cut_.object_of.size(); ++i) after[cut_.keys[cut_.object_of[i]]].push_back(i);
        for (size_t i = 0; i < count; ++i) {
            const std::string place = at("nodes", i);
            const auto mesh = index(nodes[i], "mesh", mesh_at_.size(), place);
            if (Json* instancing = instancesOf(nodes[i], place); instancing && instancing->contains("attributes"))
                moveAccessors((*instancing)["attributes"], place);
            if (!mesh) continue;
            const std::vector<Piece> pieces = piecesOf(after[i]);
            const bool whole = before[i].empty() || (pieces.size() == 1 && isWhole(pieces.front()));
            if (whole) nodes[i]["mesh"] = wholeMesh(*mesh);
            else cutNode(nodes, i, *mesh, pieces);
        }
        if (!nodes.empty()) out_.json["nodes"] = std::move(nodes);
    }

    Json* instancesOf(Json& node, const std::string& place) {
        return extension(node, kInstancing, place) ? &node["extensions"][kInstancing] : nullptr;
    }

    bool isWhole(const Piece& piece) const { return cut_.triangles_of[piece.mesh].empty(); }

    /// Each mesh that these objects draw, once.
    std::vector<Piece> piecesOf(const std::vector<uint32_t>& objects) const {
        std::vector<Piece> pieces;
        std::set<uint32_t> known;
        for (const uint32_t i : objects) {
            const SceneObject& object = cut_.scene.objects[i];
            if (known.insert(object.mesh).second) pieces.push_back({object.mesh, object.name});
        }
        return pieces;
    }

    /// Gives the pieces of a node's mesh to the node, or to children of it.
    void cutNode(Json& nodes, size_t index, uint32_t mesh, const std::vector<Piece>& pieces) {
        Json shared = Json::object();  // what goes with a mesh
        for (const char* key : {"mesh", "skin", "weights"}) {
            if (nodes[index].contains(key)) shared[key] = nodes[index][key];
            nodes[index].erase(key);
        }
        for (const char* name : {kInstancing, "EXT_instance_features"}) {
            if (const Json* found = extension(nodes[index], name, at("nodes", index)))
                shared["extensions"][name] = *found;
            dropExtension(nodes[index], name);
        }
        std::vector<Json> drawn;
        for (const Piece& piece : pieces) {
            shared["mesh"] = cutMesh(mesh, piece);
            drawn.push_back(shared);
            drawn.back()["name"] = unmarkedName(piece.name);
        }
        if (const std::optional<uint32_t> rest = pointsAndLines(mesh)) {
            shared["mesh"] = *rest;
            drawn.push_back(shared);
            drawn.back()["name"] = "points and lines";
        }
        if (drawn.size() == 1) {
            drawn.front().erase("name");
            nodes[index].update(drawn.front(), true);
            return;
        }
        for (Json& child : drawn) {
            nodes[index]["children"].push_back(nodes.size());
            nodes.push_back(std::move(child));
        }
    }

    void moveMorphs(Json& primitive, const std::string& place) {
        if (!primitive.contains("targets")) return;
        for (Json& target : primitive["targets"]) moveAccessors(target, place);
    }

    /// A primitive as it is.
    Json wholePrimitive(Json primitive, const std::string& place) {
        if (findObject(primitive, "attributes", place)) moveAccessors(primitive["attributes"], place);
        moveAccessor(primitive, "indices", place);
        moveMorphs(primitive, place);
        if (extension(primitive, kDraco, place)) {
            Json& draco = primitive["extensions"][kDraco];
            moveView(draco, "bufferView");
            packed_ = true;
        }
        return primitive;
    }

    uint32_t wholeMesh(uint32_t mesh) {
        if (mesh_at_[mesh] != kAbsent) return mesh_at_[mesh];
        Json json = table(in_, "meshes")[mesh];
        Json primitives = Json::array();
        for (const Json& primitive : table(json, "primitives"))
            primitives.push_back(wholePrimitive(primitive, at("meshes", mesh)));
        json["primitives"] = std::move(primitives);
        return mesh_at_[mesh] = out_.add("meshes", std::move(json));
    }

    /// The primitives that draw no triangles, as a mesh; none if there are none.
    std::optional<uint32_t> pointsAndLines(uint32_t mesh) {
        const auto [known, fresh] = rest_at_.try_emplace(mesh);
        if (!fresh) return known->second;
        Json json = table(in_, "meshes")[mesh];
        Json rest = Json::array();
        const Json& primitives = table(json, "primitives");
        for (size_t p = 0; p < primitives.size(); ++p) {
            const bool drawn = std::any_of(sources_[mesh].primitives.begin(), sources_[mesh].primitives.end(),
                                           [&](const PrimitiveSource& source) { return source.number == p; });
            if (!drawn) rest.push_back(wholePrimitive(primitives[p], at("meshes", mesh)));
        }
        if (rest.empty()) return known->second;
        json["primitives"] = std::move(rest);
        return known->second = out_.add("meshes", std::move(json));
    }

    /// The corners of all primitives of a mesh, by triangle.
    const std::vector<std::vector<uint32_t>>& cornersOf(uint32_t mesh) {
        const auto [known, fresh] = corners_.try_emplace(mesh);
        if (!fresh) return known->second;
        for (const PrimitiveSource& source : sources_[mesh].primitives) {
            if (source.stream) unpackDraco(document_, *source.stream);
            const auto vertices = static_cast<uint32_t>(document_.accessors[source.positions].count);
            known->second.push_back(triangleCorners(document_, source, vertices));
        }
        return known->second;
    }

    uint32_t cutMesh(uint32_t mesh, const Piece& piece) {
        if (isWhole(piece)) return wholeMesh(mesh);
        const auto [known, fresh] = piece_at_.try_emplace(piece.mesh);
        if (!fresh) return known->second;
        const Triangles& triangles = cut_.triangles_of[piece.mesh];
        const std::vector<std::vector<uint32_t>>& corners = cornersOf(mesh);
        Json json = table(in_, "meshes")[mesh];
        Json primitives = Json::array();
        uint32_t first = 0;
        auto next = triangles.begin();
        for (size_t p = 0; p < corners.size(); ++p) {
            const auto end = static_cast<uint32_t>(first + corners[p].size() / 3);
            std::vector<uint32_t> some;
            for (; next != triangles.end() && *next < end; ++next)
                for (uint32_t k = 0; k < 3; ++k) some.push_back(corners[p][3 * size_t{*next - first} + k]);
            if (!some.empty()) primitives.push_back(cutPrimitive(mesh, sources_[mesh].primitives[p], some));
            first = end;
        }
        if (next != triangles.end()) fail(at("meshes", mesh), "has changed since it was read");
        json["primitives"] = std::move(primitives);
        json["name"] = cut_.scene.meshes[piece.mesh].name;
        return known->second = out_.add("meshes", std::move(json));
    }

    /// Some triangles of a primitive, with vertices of their own.
    /// @param corners  in the primitive's vertices
    Json cutPrimitive(uint32_t mesh, const PrimitiveSource& source, const std::vector<uint32_t>& corners) {
        Json json = table(in_, "meshes")[mesh]["primitives"][source.number];
        std::vector<uint32_t> vertices, indices;
        std::unordered_map<uint32_t, uint32_t> numbers;
        for (const uint32_t corner : corners) {
            const auto [known, fresh] = numbers.try_emplace(corner, static_cast<uint32_t>(vertices.size()));
            if (fresh) vertices.push_back(corner);
            indices.push_back(known->second);
        }
        for (const auto& [name, accessor] : attributesOf(json, source)) {
            const uint32_t declared =
                requiredIndex(json["attributes"], name.c_str(), accessor_at_.size(), source.place);
            json["attributes"][name] = someElements(accessor, declared, vertices, name == "POSITION");
        }
        if (json.contains("targets"))
            for (Json& target : json["targets"])
                for (const auto& [name, accessor] : namesIn(target, source.place))
                    target[name] = someElements(accessor, accessor, vertices, name == "POSITION");
        json["indices"] = out_.addIndices(indices);
        json.erase("mode");
        dropExtension(json, kDraco);
        return json;
    }

    /// Where the attributes of a primitive are: accessors of the document, those of a Draco stream included.
    NamedAccessors attributesOf(const Json& json, const PrimitiveSource& source) {
        const Json* attributes = findObject(json, "attributes", source.place);
        if (!attributes) fail(source.place, "attributes are missing");
        NamedAccessors out = namesIn(*attributes, source.place);
        if (!source.stream) return out;
        std::optional<uint32_t> indices = index(json, "indices", accessor_at_.size(), source.place);
        const bool is_list = whole(json, "mode", source.place).value_or(4) == 4;
        const uint32_t stream =
            useDraco(document_, *extension(json, kDraco, source.place), out, indices, is_list, source.place);
        unpackDraco(document_, stream);
        return out;
    }

    /// Elements of an accessor, bit for bit, as an accessor of the new file.
    /// @param accessor  that holds them
    /// @param declared  that the file names for them
    uint32_t someElements(uint32_t accessor, uint32_t declared, const std::vector<uint32_t>& which, bool bounds) {
        const Accessor from = document_.accessors[accessor];
        const std::string place = at("accessors", declared);
        const uint32_t component = componentSize(from.elements.component), size = from.components * component;
        const uint32_t stride = (size + 3) / 4 * 4;
        document_.budget.charge(which.size(), stride, place);
        std::vector<unsigned char> bytes(which.size() * stride);
        for (const uint32_t i : which)
            if (i >= from.count) fail(place, "has {} elements, of which {} is asked for", from.count, i);
        if (from.elements.view && from.count > 0) {
            const Bytes view = viewBytes(document_, *from.elements.view);
            const uint32_t step = document_.views[*from.elements.view].stride;
            for (size_t k = 0; k < which.size(); ++k)
                std::memcpy(&bytes[k * stride],
                            view.data() + from.elements.offset + uint64_t{which[k]} * (step ? step : size), size);
        }
        if (from.sparse) replace(*from.sparse, size, which, stride, bytes);

        Json json = table(in_, "accessors")[declared];
        for (const char* key : {"sparse", "byteOffset", "min", "max"}) json.erase(key);
        json["count"] = which.size();
        json["bufferView"] = out_.addView(bytes, Glb::Target::kVertices, stride == size ? 0 : stride);
        for (uint32_t c = 0; bounds && c < from.components; ++c) {
            double least = std::numeric_limits<double>::infinity(), most = -least;
            for (size_t k = 0; k < which.size(); ++k) {
                const double value = readComponent(&bytes[k * stride + c * component], from.elements.component);
                least = std::min(least, value);
                most = std::max(most, value);
            }
            json["min"].push_back(least);
            json["max"].push_back(most);
        }
        return out_.add("accessors", std::move(json));
    }

    /// Puts the replacements of a sparse accessor over the elements.
    void replace(const Sparse& sparse, uint32_t size, const std::vector<uint32_t>& which, uint32_t stride,
                 std::vector<unsigned char>& bytes) {
        if (sparse.count == 0) return;
        std::unordered_map<uint32_t, size_t> places;
        for (size_t k = 0; k < which.size(); ++k) places.emplace(which[k], k);
        const uint32_t width = componentSize(sparse.indices.component);
        const auto stepOf = [&](const Elements& elements, uint32_t packed) {
            const uint32_t step = document_.views[*elements.view].stride;
            return step ? step : packed;
        };
        const unsigned char* indices = viewBytes(document_, *sparse.indices.view).data() + sparse.indices.offset;
        const unsigned char* values = viewBytes(document_, *sparse.values.view).data() + sparse.values.offset;
        for (uint64_t i = 0; i < sparse.count; ++i) {
            const double index = readComponent(indices + i * stepOf(sparse.indices, width), sparse.indices.component);
            const auto found = places.find(static_cast<uint32_t>(index));
            if (found != places.end())
                std::memcpy(&bytes[found->second * stride], values + i * stepOf(sparse.values, size), size);
        }
    }

    /// Names the extensions that are left, and no others.
    void nameExtensions() {
        std::set<std::string> gone = {"EXT_meshopt_compression", "KHR_meshopt_compression"};
        if (!packed_) gone.insert(kDraco);
        for (const char* key : {"extensionsUsed", "extensionsRequired"}) {
            Json left = Json::array();
            for (const Json& name : table(in_, key))
                if (name.is_string() && featureOf(name.get<std::string>()).understood &&
                    !gone.count(name.get<std::string>()))
                    left.push_back(name);
            out_.json.erase(key);
            if (!left.empty()) out_.json[key] = std::move(left);
        }
    }

    std::string file_;
    const CutScene& cut_;
    Document document_;
    Json in_;
    Glb out_;
    std::vector<MeshSource> sources_;
    std::vector<uint32_t> accessor_at_, view_at_, mesh_at_;  // of the file, where they are in the new one
    std::map<uint32_t, std::optional<uint32_t>> rest_at_;    // by the file's mesh
    std::map<uint32_t, uint32_t> piece_at_;                  // by the cut scene's
    std::map<uint32_t, std::vector<std::vector<uint32_t>>> corners_;
    std::vector<std::string> notes_;
    bool packed_ = false;  // something is still packed by Draco
};

}  // namespace

Result<WrittenGltf> cutGltf(const std::string& file, const CutScene& cut) {
    return guarded(file, [&]() -> Result<WrittenGltf> { return GltfCutter(openGltf(file), file, cut).write(); });
}

Result<WrittenGltf> cutGltf(std::span<const unsigned char> bytes, const std::string& name, const CutScene& cut) {
    return guarded(name, [&]() -> Result<WrittenGltf> {
        return GltfCutter(openDocument(ByteSource(bytes), std::nullopt), name, cut).write();
    });
}

}  // namespace sightline::tools
