// Turns drawn nodes into a scene: one mesh per shape, one object per node or GPU instance, cameras.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_objects.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>
#include <utility>
#include <vector>

#include "sightline/tools/import/gltf/gltf_accessor.h"
#include "sightline/tools/import/gltf/gltf_cells.h"
#include "sightline/tools/import/gltf/gltf_deform.h"
#include "sightline/tools/import/gltf/gltf_nodes.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::gltf {
namespace {

// Reads cameras and places them where drawn nodes hold them.

/// A camera without its place.
using CameraSource = SceneCamera;

constexpr double kPi = 3.14159265358979323846;

void readFar(const Json& lens, CameraSource& camera, const std::string& place) {
    const std::optional<double> z_far = number(lens, "zfar", place);
    if (z_far && !(*z_far > camera.z_near)) fail(place, "zfar {} is not beyond znear {}", *z_far, camera.z_near);
    camera.z_far = z_far;
}

void readPerspective(const Json& lens, CameraSource& camera, const std::string& place) {
    camera.fov_y = number(lens, "yfov", place).value_or(0);
    if (!(camera.fov_y > 0 && camera.fov_y < kPi)) fail(place, "yfov {} is not between 0 and pi", camera.fov_y);
    camera.z_near = number(lens, "znear", place).value_or(0);
    if (!(camera.z_near > 0)) fail(place, "znear {} is not above 0", camera.z_near);
    readFar(lens, camera, place);
}

void readOrthographic(const Json& lens, CameraSource& camera, const std::string& place) {
    camera.orthographic_height = 2 * std::abs(number(lens, "ymag", place).value_or(0));
    if (!(camera.orthographic_height > 0 && std::isfinite(camera.orthographic_height)))
        fail(place, "ymag is not above 0");
    camera.z_near = number(lens, "znear", place).value_or(0);
    readFar(lens, camera, place);
}

CameraSource readCamera(const Json& json, const std::string& place) {
    CameraSource camera;
    camera.name = text(json, "name", place);
    const std::string type = text(json, "type", place);
    if (type != "perspective" && type != "orthographic") fail(place, "type '{}' is not known", printable(type));
    const Json* lens = findObject(json, type.c_str(), place);
    if (!lens) fail(place, "{} is missing", type);
    if (type == "perspective") readPerspective(*lens, camera, place + ".perspective");
    else readOrthographic(*lens, camera, place + ".orthographic");
    return camera;
}

// A scale of zero, as some files hide a node with, leaves a camera without a direction.
bool looksSomewhere(const glm::dmat4& world) {
    const double up = glm::length(glm::dvec3(world[1])), back = glm::length(glm::dvec3(world[2]));
    if (!(up > 0 && back > 0 && std::isfinite(up) && std::isfinite(back))) return false;
    return glm::length(glm::cross(glm::dvec3(world[1]) / up, glm::dvec3(world[2]) / back)) > 1e-9;
}

std::vector<CameraSource> readCameras(const JsonText& json) {
    const JsonTable array = json.table("cameras");
    std::vector<CameraSource> out;
    for (size_t i = 0; i < array.size(); ++i) {
        const std::string place = at("cameras", i);
        out.push_back(readCamera(array.object(i, place), place));
    }
    return out;
}

/// One camera for each drawn node that holds one, by node; a node that is flattened to nothing holds none.
std::vector<SceneCamera> placeCameras(const NodeTree& tree, const std::vector<CameraSource>& cameras) {
    std::vector<SceneCamera> out;
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        const Node& node = tree.nodes[i];
        if (!node.drawn || !node.camera) continue;
        if (!finiteMatrix(node.world)) fail(at("nodes", i), "its world transform is not finite");
        if (!looksSomewhere(node.world)) continue;
        out.push_back(cameras[*node.camera]);
        out.back().transform = node.world;
        if (!tree.names[i].name.empty()) out.back().name = tree.names[i].name;
    }
    return out;
}

constexpr double kFarthestObject = 1e100;  // squares and volumes of what is nearer stay finite
constexpr uint64_t kMostObjects = 50'000'000;

/// A mesh as one or more nodes draw it: the same mesh unskinned, under a skin or with other morph weights is another
/// shape.
struct ShapeUse {
    uint32_t mesh = 0;
    std::optional<uint32_t> skin;
    std::vector<float> weights;
    std::vector<uint32_t> nodes;

    bool deforms(const MeshSource& source) const { return skin || source.morphs; }
};

struct Parts {
    std::vector<MeshSource> meshes;
    std::vector<Skin> skins;
    NodeTree tree;
    std::vector<ShapeUse> shapes;
    std::map<uint32_t, size_t> shape_of_level;  ///< by node that stands for others from afar
};

/// Whether a node's levels of detail can be kept: meshes that do not deform, and nothing below that would be lost.
bool keepsLevels(const Parts& parts, const std::vector<uint8_t>& has_children, uint32_t node) {
    const Node& of = parts.tree.nodes[node];
    if (of.lods.empty() || !of.drawn || !of.mesh || of.marked || has_children[node]) return false;
    const auto plain = [&](uint32_t i) {
        const Node& level = parts.tree.nodes[i];
        if (!level.mesh || level.marked || has_children[i] || level.skin) return false;
        const MeshSource& source = parts.meshes[*level.mesh];
        return !source.primitives.empty() && !source.morphs;
    };
    return plain(node) && std::all_of(of.lods.begin(), of.lods.end(), plain);
}

void gatherShapes(Parts& parts) {
    std::vector<ShapeUse>& shapes = parts.shapes;
    std::map<std::tuple<uint32_t, uint32_t, std::vector<float>>, size_t> known;
    std::vector<uint8_t> has_children(parts.tree.nodes.size(), 0);
    for (const SceneNode& node : parts.tree.names)
        if (node.parent != kNoNode) has_children[node.parent] = 1;
    for (uint32_t i = 0; i < parts.tree.nodes.size(); ++i) {
        const Node& node = parts.tree.nodes[i];
        if (!node.drawn || !node.mesh || node.marked) continue;
        const MeshSource& source = parts.meshes[*node.mesh];
        if (source.primitives.empty()) continue;
        ShapeUse shape{*node.mesh, source.skinnable ? node.skin : std::nullopt, {}, {}};
        if (source.morphs) shape.weights = node.weights.empty() ? source.weights : node.weights;
        const auto [place, fresh] =
            known.try_emplace({shape.mesh, shape.skin.value_or(kNoNode), shape.weights}, shapes.size());
        if (fresh) shapes.push_back(std::move(shape));
        shapes[place->second].nodes.push_back(i);
    }
    for (uint32_t i = 0; i < parts.tree.nodes.size(); ++i) {
        if (!keepsLevels(parts, has_children, i)) {
            parts.tree.nodes[i].lods.clear();
            continue;
        }
        for (const uint32_t level : parts.tree.nodes[i].lods) {
            const uint32_t mesh = *parts.tree.nodes[level].mesh;
            const auto [place, fresh] = known.try_emplace({mesh, kNoNode, {}}, shapes.size());
            if (fresh) shapes.push_back({mesh, std::nullopt, {}, {}});
            parts.shape_of_level[level] = place->second;
        }
    }
}

// What each morph weight of a mesh may be: 0 to 1, its defaults, and what animations make of it.
std::vector<Range> weightRanges(const Parts& parts, const std::vector<Motion>& motions, const ShapeUse& shape) {
    std::vector<Range> ranges(parts.meshes[shape.mesh].targets, Range{0, 1});
    for (size_t t = 0; t < ranges.size() && t < shape.weights.size(); ++t) ranges[t].grow(shape.weights[t]);
    for (const uint32_t node : shape.nodes)
        for (size_t t = 0; t < ranges.size() && t < motions[node].weights.size(); ++t) {
            ranges[t].grow(motions[node].weights[t].low);
            ranges[t].grow(motions[node].weights[t].high);
        }
    return ranges;
}

std::vector<glm::dmat4> readInstances(Document& document, const Json& json, const std::string& place) {
    const Json* attributes = findObject(json, "attributes", place);
    if (!attributes || attributes->empty()) fail(place, "GPU instances without attributes");
    std::optional<uint64_t> count;
    for (const auto& [name, value] : attributes->items()) {
        const uint32_t accessor = requiredIndex(*attributes, name.c_str(), document.accessors.size(), place);
        const uint64_t elements = document.accessors[accessor].count;
        if (count && *count != elements) fail(place, "GPU instance attributes of {} and {} elements", *count, elements);
        count = elements;
    }
    const auto read = [&](const char* name, uint32_t components) {
        const auto accessor = index(*attributes, name, document.accessors.size(), place);
        return accessor ? decodeFloats(document, *accessor, components, name) : std::vector<float>{};
    };
    const std::vector<float> translations = read("TRANSLATION", 3), rotations = read("ROTATION", 4),
                             scales = read("SCALE", 3);
    if (*count > kMostObjects) fail(place, "{} GPU instances are more than {}", *count, kMostObjects);
    document.budget.charge(*count, sizeof(glm::dmat4), place);
    std::vector<glm::dmat4> out(*count);
    for (size_t i = 0; i < out.size(); ++i) {
        double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
        for (size_t c = 0; c < 3 && !translations.empty(); ++c) translation[c] = translations[i * 3 + c];
        for (size_t c = 0; c < 4 && !rotations.empty(); ++c) rotation[c] = rotations[i * 4 + c];
        for (size_t c = 0; c < 3 && !scales.empty(); ++c) scale[c] = scales[i * 3 + c];
        out[i] = composeTransform(translation, rotation, scale);
    }
    return out;
}

void addObject(Document& document, Scene& scene, uint32_t node, uint32_t mesh, const glm::dmat4& transform,
               const std::string& name) {
    const std::string place = at("nodes", node);
    document.budget.charge(1, sizeof(SceneObject) + name.size(), place);
    if (scene.objects.size() >= kMostObjects) fail(place, "the scene draws more than {} objects", kMostObjects);
    if (!finiteMatrix(transform)) fail(place, "its world transform is not finite");
    const Box3d box = transformBox(scene.meshes[mesh].bounds, transform);
    for (int axis = 0; axis < 3; ++axis)
        if (!(box.min[axis] >= -kFarthestObject && box.max[axis] <= kFarthestObject))
            fail(place, "its bounds in the world are too large");
    scene.objects.push_back({node, mesh, transform, name, node});
}

/// A shape once it is built: a mesh of the scene, or none if it has no triangles.
struct Built {
    std::optional<uint32_t> mesh;
    std::optional<glm::dmat4> transform;  ///< replaces the nodes' own where joints place the mesh
};

// The objects of one node.
void addNode(Document& document, const Parts& parts, uint32_t index, const Built& built, Scene& scene) {
    const Node& node = parts.tree.nodes[index];
    const std::string& own = parts.tree.names[index].name;
    const std::string& name = own.empty() ? scene.meshes[*built.mesh].name : own;
    if (node.extended) {
        const std::string place = at("nodes", index);
        const Json json = document.json.table("nodes")[index];
        if (const Json* instancing = extension(json, "EXT_mesh_gpu_instancing", place)) {
            if (built.transform) fail(place, "a skinned mesh has no GPU instances");
            for (const glm::dmat4& instance : readInstances(document, *instancing, place))
                addObject(document, scene, index, *built.mesh, node.world * instance, name);
            return;
        }
    }
    addObject(document, scene, index, *built.mesh, built.transform.value_or(node.world), name);
}

Built buildShape(Document& document, const Parts& parts, const std::vector<Motion>& motions, const ShapeUse& shape,
                 MeshBuilder& builder, Scene& scene) {
    const MeshSource& source = parts.meshes[shape.mesh];
    const std::string place = at("meshes", shape.mesh);
    document.budget.charge(1, sizeof(Mesh) + source.name.size(), place);
    BuiltMesh built = builder.build(source, shape.deforms(source));
    Built out;
    if (shape.deforms(source) && !built.mesh.indices.empty()) {
        document.budget.charge(source.targets, sizeof(Range), place);
        const MorphReach reach = morphReach(document, built, shape.weights, weightRanges(parts, motions, shape));
        if (shape.skin) {
            const glm::dvec3 anchor =
                applySkin(document, parts.tree, motions, parts.skins[*shape.skin], reach, place, built);
            out.transform = glm::dmat4(1.0);
            (*out.transform)[3] = glm::dvec4(anchor, 1.0);
        } else {
            applyMorph(reach, built.mesh);
        }
    }
    builder.release(source);
    if (built.mesh.indices.empty()) return out;
    out.mesh = static_cast<uint32_t>(scene.meshes.size());
    scene.meshes.push_back(std::move(built.mesh));
    return out;
}

std::vector<Built> buildShapes(Document& document, const Parts& parts, Scene& scene) {
    MeshBuilder builder(document);
    bool deforms = false;
    for (const ShapeUse& shape : parts.shapes) {
        builder.expect(parts.meshes[shape.mesh]);
        deforms |= shape.deforms(parts.meshes[shape.mesh]);
    }
    std::vector<Motion> motions;
    if (deforms) {
        std::vector<size_t> targets;
        for (const MeshSource& mesh : parts.meshes) targets.push_back(mesh.targets);
        motions = readMotions(document, parts.tree, targets);
    }
    std::vector<Built> built;
    for (const ShapeUse& shape : parts.shapes) {
        built.push_back(buildShape(document, parts, motions, shape, builder, scene));
        document.progress.reach(Progress::kParsed, Progress::kBuilt,
                                double(built.size()) / double(parts.shapes.size()));
    }
    return built;
}

// In the order of the nodes.
void addObjects(Document& document, const Parts& parts, const std::vector<Built>& built, Scene& scene) {
    constexpr uint32_t kNone = ~0u;
    std::vector<uint32_t> shape_of(parts.tree.nodes.size(), kNone);
    size_t objects = 0;
    for (uint32_t s = 0; s < built.size(); ++s) {
        if (!built[s].mesh) continue;
        for (const uint32_t node : parts.shapes[s].nodes) shape_of[node] = s;
        objects += parts.shapes[s].nodes.size();
    }
    scene.objects.reserve(objects);
    for (uint32_t node = 0; node < shape_of.size(); ++node)
        if (shape_of[node] != kNone) addNode(document, parts, node, built[shape_of[node]], scene);
}

/// The levels that the file names for the objects of a node.
void addLevels(Document& document, const Parts& parts, const std::vector<Built>& built, Scene& scene) {
    const NodeTree& tree = parts.tree;
    for (uint32_t object = 0; object < scene.objects.size(); ++object) {
        const uint32_t node = scene.objects[object].node;
        for (const uint32_t level : tree.nodes[node].lods) {
            const Built& shape = built[parts.shape_of_level.at(level)];
            if (!shape.mesh) break;
            // It takes the node's place in the tree, unless it has one of its own.
            glm::dmat4 place = tree.nodes[level].world;
            const uint32_t parent = tree.names[node].parent;
            if (tree.names[level].parent == kNoNode && parent != kNoNode) place = tree.nodes[parent].world * place;
            const glm::dmat4 relative = glm::inverse(tree.nodes[node].world) * place;
            if (!finiteMatrix(relative)) break;
            document.budget.charge(1, sizeof(SceneLevel), at("nodes", node));
            scene.levels.push_back({object, *shape.mesh, relative});
        }
    }
}

}  // namespace

Scene makeScene(Document& document) {
    Scene scene;
    Materials materials = readMaterials(document);
    Parts parts;
    parts.meshes = readMeshes(document, materials);
    const std::vector<CameraSource> cameras = readCameras(document.json);
    const size_t nodes = document.json.table("nodes").size();
    parts.skins = readSkins(document, nodes);
    const NodeTargets targets{parts.meshes.size(), parts.skins.size(), cameras.size()};
    parts.tree = readNodes(document.json, targets, nodeChanges(document, nodes), document.unknown, [&](size_t read) {
        document.progress.reach(Progress::kChecked, Progress::kParsed, double(read) / double(nodes));
    });
    if (const std::vector<uint32_t>& named = parts.tree.named; !named.empty())
        document.notes.push_back(
            fmt::format("the scene names nodes that have a parent ({}, nodes[{}] first): they stand "
                        "where it has them, and hide nothing",
                        named.size(), named.front()));
    gatherShapes(parts);
    scene.materials = std::move(materials.list);
    const std::vector<Built> built = buildShapes(document, parts, scene);
    addObjects(document, parts, built, scene);
    for (SceneObject& object : scene.objects) object.changes = parts.tree.nodes[object.node].changes;
    addLevels(document, parts, built, scene);
    for (const SceneLevel& level : scene.levels) scene.objects[level.object].changes |= SceneObject::kLevels;
    scene.cameras = placeCameras(parts.tree, cameras);
    scene.nodes = std::move(parts.tree.names);
    addMarked(document, parts.tree, parts.meshes, scene);
    if (scene.objects.empty() && scene.cells.empty() && scene.portals.empty())
        fail("", "draws nothing: no triangle in the scene that it shows");
    return scene;
}

}  // namespace sightline::tools::gltf
