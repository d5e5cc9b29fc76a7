// Builds meshes: triangle lists, strips and fans over shared vertices.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_meshes.h"

#include <algorithm>
#include <utility>

#include "sightline/tools/import/gltf/gltf_accessor.h"
#include "sightline/tools/import/gltf/gltf_draco.h"
#include "sightline/tools/import/gltf/gltf_features.h"

namespace sightline::tools::gltf {
namespace {

bool needsDefault(const JsonText& json) {
    const JsonTable meshes = json.table("meshes");
    for (size_t i = 0; i < meshes.size(); ++i) {
        const Json mesh = meshes[i];
        const Json* primitives = find(mesh, "primitives");
        if (!primitives || !primitives->is_array()) continue;
        for (const Json& primitive : *primitives)
            if (!find(primitive, "material")) return true;
    }
    return false;
}

AlphaMode readAlphaMode(const Json& json, const std::string& place) {
    const std::string mode = text(json, "alphaMode", place);
    if (mode.empty() || mode == "OPAQUE") return AlphaMode::kOpaque;
    if (mode == "MASK") return AlphaMode::kMask;
    if (mode == "BLEND") return AlphaMode::kBlend;
    fail(place, "alphaMode '{}' is not known", printable(mode));
}

void readColor(const Json* owner, const char* key, Material& material, const std::string& place) {
    double color[4];
    if (owner && numbers(*owner, key, color, place))
        material.base_color = {static_cast<float>(color[0]), static_cast<float>(color[1]), static_cast<float>(color[2]),
                               static_cast<float>(color[3])};
}

Material readMaterial(Document& document, const Json& json, const std::string& place) {
    Material material;
    material.name = text(json, "name", place);
    material.alpha_mode = readAlphaMode(json, place);
    material.alpha_cutoff = static_cast<float>(number(json, "alphaCutoff", place).value_or(0.5));
    material.double_sided = flag(json, "doubleSided", place);
    // Whatever its factor, which a texture, an animation or the application may change.
    material.transmissive = effectOfExtensions(json, document.unknown) != Effect::kNone;
    if (const Json* glossiness = extension(json, "KHR_materials_pbrSpecularGlossiness", place))
        readColor(glossiness, "diffuseFactor", material, place);
    readColor(findObject(json, "pbrMetallicRoughness", place), "baseColorFactor", material, place);
    return material;
}

enum Mode : uint32_t { kTriangles = 4, kTriangleStrip = 5, kTriangleFan = 6 };

void readInfluences(const Json& attributes, size_t accessors, PrimitiveSource& out) {
    for (int set = 0;; ++set) {
        const std::string joints = fmt::format("JOINTS_{}", set), weights = fmt::format("WEIGHTS_{}", set);
        const auto joint = index(attributes, joints.c_str(), accessors, out.place);
        const auto weight = index(attributes, weights.c_str(), accessors, out.place);
        if (!joint && !weight) return;
        if (!joint || !weight) fail(out.place, "has one of {} and {}, not both", joints, weights);
        out.influences.emplace_back(*joint, *weight);
    }
}

void readTargets(const Json& json, size_t accessors, PrimitiveSource& out) {
    const Json& targets = table(json, "targets", out.place);
    for (size_t i = 0; i < targets.size(); ++i) {
        const std::string place = out.place + at(".targets", i);
        out.targets.push_back(index(objectAt(targets, i, place), "POSITION", accessors, place));
    }
}

// Whether there is other data than the compressed, which then serves a build with and without Draco alike.
bool hasFallback(const Document& document, const PrimitiveSource& source) {
    const auto filled = [&](uint32_t accessor) {
        return document.accessors[accessor].elements.view || document.accessors[accessor].sparse;
    };
    bool all = filled(source.positions) && (!source.indices || filled(*source.indices));
    for (const auto& [joints, weights] : source.influences) all = all && filled(joints) && filled(weights);
    return all && !document.draco_required;
}

// Lets the primitive read from its Draco stream.
void readDraco(Document& document, const Json& json, PrimitiveSource& out) {
    if (hasFallback(document, out)) return;
    if (out.mode == kTriangleFan) fail(out.place, "is a fan, which Draco data cannot be");
    NamedAccessors attributes = {{"POSITION", out.positions}};
    for (size_t set = 0; set < out.influences.size(); ++set) {
        attributes.emplace_back(fmt::format("JOINTS_{}", set), out.influences[set].first);
        attributes.emplace_back(fmt::format("WEIGHTS_{}", set), out.influences[set].second);
    }
    out.stream = useDraco(document, json, attributes, out.indices, out.mode == kTriangles, out.place);
    out.mode = kTriangles;  // of a strip, too, the stream holds triangles
    out.positions = attributes[0].second;
    for (size_t set = 0; set < out.influences.size(); ++set)
        out.influences[set] = {attributes[2 * set + 1].second, attributes[2 * set + 2].second};
}

/// In a set of materials: one that lets light pass.
constexpr uint32_t kClearMaterial = ~0u;

// One material for all that may be drawn; the first of them is the file's default. Returns its number.
uint32_t materialOf(std::vector<uint32_t> all, Materials& materials) {
    const uint32_t first = all.front();
    std::sort(all.begin() + 1, all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    const Material& usual = materials.list[first];
    bool hides = all.back() != kClearMaterial, alike = true, double_sided = false;
    for (const uint32_t number : all) {
        if (number == kClearMaterial) continue;
        const Material& material = materials.list[number];
        hides = hides && material.hides();
        alike = alike && material.double_sided == usual.double_sided;
        double_sided = double_sided || material.double_sided;
    }
    if (alike && hides == usual.hides()) return first;
    const auto [known, fresh] = materials.of_variants.emplace(all, static_cast<uint32_t>(materials.list.size()));
    if (fresh) {
        Material made = usual;
        made.double_sided = double_sided;
        if (made.hides()) made.alpha_mode = AlphaMode::kMask;
        materials.list.push_back(std::move(made));
    }
    return known->second;
}

/// @param clear  light may pass whatever the material says
uint32_t readMaterialNumber(const Json& json, bool clear, Materials& materials, const std::string& place) {
    const auto usual = index(json, "material", materials.count, place);
    std::vector<uint32_t> all{usual ? *usual + materials.first : 0};
    if (clear) all.push_back(kClearMaterial);
    if (const Json* variants = extension(json, "KHR_materials_variants", place)) {
        const Json& mappings = table(*variants, "mappings", place);
        for (size_t i = 0; i < mappings.size(); ++i) {
            const std::string mapping = place + at(".mappings", i);
            if (const auto other = index(objectAt(mappings, i, mapping), "material", materials.count, mapping))
                all.push_back(*other + materials.first);
        }
    }
    for (size_t i = all.size(); i-- > 0;)
        if (const auto levels = materials.levels.find(all[i]); levels != materials.levels.end())
            all.insert(all.end(), levels->second.begin(), levels->second.end());
    return materialOf(std::move(all), materials);
}

// None if it draws no triangles.
/// @param clear  as of readMaterialNumber()
std::optional<PrimitiveSource> readPrimitive(Document& document, const Json& json, bool clear, Materials& materials,
                                             const std::string& place) {
    PrimitiveSource out;
    out.place = place;
    out.mode = static_cast<uint32_t>(std::min<uint64_t>(whole(json, "mode", place).value_or(kTriangles), 7));
    if (out.mode > kTriangleFan) fail(place, "mode is not known");
    const Json* attributes = findObject(json, "attributes", place);
    if (!attributes) fail(place, "attributes are missing");
    const size_t accessors = document.accessors.size();
    const std::optional<uint32_t> positions = index(*attributes, "POSITION", accessors, place);
    if (out.mode < kTriangles || !positions) return std::nullopt;
    out.positions = *positions;
    out.indices = index(json, "indices", accessors, place);
    clear |= effectOfExtensions(json, document.unknown) == Effect::kUnknown;
    out.material = readMaterialNumber(json, clear, materials, place);
    readInfluences(*attributes, accessors, out);
    readTargets(json, accessors, out);
    if (const Json* draco = extension(json, "KHR_draco_mesh_compression", place)) readDraco(document, *draco, out);
    return out;
}

// Corners of triangles from the corners of a list, strip or fan. Every second triangle of a strip is
// turned round, so that all face the same way.
std::vector<uint32_t> unrolled(std::vector<uint32_t> corners, uint32_t mode) {
    if (mode == kTriangles) {
        corners.resize(corners.size() / 3 * 3);
        return corners;
    }
    std::vector<uint32_t> out;
    if (corners.size() < 3) return out;
    out.reserve((corners.size() - 2) * 3);
    for (size_t i = 0; i + 2 < corners.size(); ++i) {
        const size_t odd = i % 2;
        if (mode == kTriangleStrip) out.insert(out.end(), {corners[i], corners[i + 1 + odd], corners[i + 2 - odd]});
        else out.insert(out.end(), {corners[i + 1], corners[i + 2], corners[0]});
    }
    return out;
}

std::vector<uint32_t> readCorners(Document& document, const PrimitiveSource& source, uint32_t vertices) {
    std::vector<uint32_t> corners;
    if (!source.indices) {
        document.budget.charge(vertices, sizeof(uint32_t), source.place);
        corners.resize(vertices);
        for (uint32_t i = 0; i < vertices; ++i) corners[i] = i;
        return corners;
    }
    corners = decodeIntegers(document, *source.indices, 1, "indices");
    const auto largest = std::max_element(corners.begin(), corners.end());
    if (largest != corners.end() && *largest >= vertices)
        fail(accessorPlace(document, *source.indices), "index {} is out of range of {} vertices", *largest, vertices);
    return corners;
}

}  // namespace

std::vector<uint32_t> triangleCorners(Document& document, const PrimitiveSource& source, uint32_t vertices) {
    return unrolled(readCorners(document, source, vertices), source.mode);
}

Materials readMaterials(Document& document) {
    Materials out;
    const JsonTable array = document.json.table("materials");
    out.count = array.size();
    if (array.empty() || needsDefault(document.json)) {
        out.list.push_back({});
        out.first = 1;
    }
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("materials", i);
        const Json json = array.object(i, place);
        out.list.push_back(readMaterial(document, json, place));
        const Json* lod = extension(json, "MSFT_lod", place);
        if (!lod) continue;
        const Json& ids = table(*lod, "ids", place);
        for (size_t k = 0; k < ids.size(); ++k)
            out.levels[static_cast<uint32_t>(i) + out.first].push_back(indexAt(ids, k, "ids", array.size(), place) +
                                                                       out.first);
    }
    return out;
}

std::vector<MeshSource> readMeshes(Document& document, Materials& materials) {
    const JsonTable array = document.json.table("meshes");
    std::vector<MeshSource> out(array.size());
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("meshes", i);
        const Json json = array.object(i, place);
        MeshSource& mesh = out[i];
        mesh.name = text(json, "name", place);
        mesh.weights = floats(json, "weights", place);
        const bool clear = effectOfExtensions(json, document.unknown) == Effect::kUnknown;
        const Json& primitives = table(json, "primitives", place);
        for (size_t p = 0; p < primitives.size(); ++p) {
            const std::string primitive_place = place + at(".primitives", p);
            auto primitive =
                readPrimitive(document, objectAt(primitives, p, primitive_place), clear, materials, primitive_place);
            if (!primitive) continue;
            primitive->number = static_cast<uint32_t>(p);
            mesh.targets = std::max(mesh.targets, primitive->targets.size());
            mesh.skinnable |= !primitive->influences.empty();
            for (const auto& target : primitive->targets) mesh.morphs |= target.has_value();
            mesh.primitives.push_back(std::move(*primitive));
        }
    }
    return out;
}

void MeshBuilder::expect(const MeshSource& source) {
    for (const PrimitiveSource& primitive : source.primitives) {
        ++positions_[primitive.positions].uses;
        if (primitive.stream) retainDraco(document_, *primitive.stream);
    }
}

void MeshBuilder::release(const MeshSource& source) {
    for (const PrimitiveSource& primitive : source.primitives)
        if (primitive.stream) releaseDraco(document_, *primitive.stream);
}

BuiltMesh MeshBuilder::build(const MeshSource& source, bool keep_runs) {
    BuiltMesh out;
    out.mesh.name = source.name;
    ++epoch_;
    for (const PrimitiveSource& primitive : source.primitives) addPrimitive(primitive, keep_runs, out);
    out.mesh.positions.shrink_to_fit();
    out.mesh.indices.shrink_to_fit();
    for (const glm::vec3& position : out.mesh.positions) out.mesh.bounds.grow(glm::dvec3(position));
    return out;
}

void MeshBuilder::addPrimitive(const PrimitiveSource& source, bool keep_runs, BuiltMesh& out) {
    if (source.stream) unpackDraco(document_, *source.stream);
    Positions& positions = positions_[source.positions];
    if (!positions.decoded) {
        positions.xyz = decodeFloats(document_, source.positions, 3, "position");
        document_.budget.charge(positions.xyz.size() / 3, 2 * sizeof(uint32_t), source.place);
        positions.epoch.assign(positions.xyz.size() / 3, 0);
        positions.id.resize(positions.epoch.size());
        positions.decoded = true;
    }
    const std::vector<uint32_t> corners =
        triangleCorners(document_, source, static_cast<uint32_t>(positions.epoch.size()));
    document_.budget.charge(corners.size(), sizeof(uint32_t) + sizeof(glm::vec3), source.place);

    Mesh& mesh = out.mesh;
    constexpr size_t kMost = 0xffffffff;
    if (corners.size() > kMost - mesh.indices.size()) fail(source.place, "the mesh has more than {} corners", kMost);
    if (keep_runs) {
        ++epoch_;
        out.runs.push_back({&source, static_cast<uint32_t>(mesh.positions.size()), {}});
    }
    if (!corners.empty())
        mesh.primitives.push_back(
            {static_cast<uint32_t>(mesh.triangles()), static_cast<uint32_t>(corners.size() / 3), source.material});
    for (const uint32_t corner : corners) {
        if (positions.epoch[corner] != epoch_) {
            positions.epoch[corner] = epoch_;
            positions.id[corner] = static_cast<uint32_t>(mesh.positions.size());
            const float* xyz = &positions.xyz[size_t(corner) * 3];
            mesh.positions.emplace_back(xyz[0], xyz[1], xyz[2]);
            if (keep_runs) out.runs.back().source.push_back(corner);
        }
        mesh.indices.push_back(positions.id[corner]);
    }
    if (--positions.uses == 0) positions_.erase(source.positions);
}

}  // namespace sightline::tools::gltf
