// Writes a scene that came from anywhere as glTF 2.0.
// SPDX-License-Identifier: MIT
#include "sightline/tools/export/gltf_scene.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <utility>

#include <fmt/core.h>

#include "sightline/geom/convex_region.h"
#include "sightline/tools/export/glb.h"
#include "sightline/tools/import/gltf/gltf_nodes.h"

namespace sightline::tools {
namespace {

constexpr uint32_t kUnwritten = ~0u;

Glb::Json matrixOf(const glm::dmat4& transform) {
    Glb::Json out = Glb::Json::array();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) out.push_back(transform[column][row]);
    return out;
}

Glb::Json pointOf(const glm::dvec3& point) { return {point.x, point.y, point.z}; }

class SceneWriter {
public:
    explicit SceneWriter(const Scene& scene) : scene_(scene) {}

    Result<WrittenGltf> write(const std::string& name) {
        for (const Material& material : scene_.materials) addMaterial(material);
        addNodes();
        for (const SceneCamera& camera : scene_.cameras) addCamera(camera);
        for (const SceneCell& cell : scene_.cells) addCell(cell);
        for (const ScenePortal& portal : scene_.portals) addPortal(portal);
        glb_.json["scenes"] = Json::array({Json{{"nodes", roots_}}});
        glb_.json["scene"] = 0;
        if (!extensions_.empty()) glb_.json["extensionsUsed"] = extensions_;
        Result<std::string> bytes = glb_.bytes(name);
        if (!bytes) return bytes.error();
        if (shapeless_ > 0) notes_.push_back(fmt::format("cells without a shape are left out: {}", shapeless_));
        if (deforming_ > 0)
            notes_.push_back(fmt::format("meshes that deform stand as they are at rest: {}", deforming_));
        return WrittenGltf{std::move(*bytes), std::move(notes_)};
    }

private:
    using Json = Glb::Json;

    void addMaterial(const Material& material) {
        const glm::vec4& c = material.base_color;
        Json out = {{"pbrMetallicRoughness",
                     {{"baseColorFactor", {c.x, c.y, c.z, c.w}}, {"metallicFactor", 0}, {"roughnessFactor", 1}}}};
        if (!material.name.empty()) out["name"] = material.name;
        if (material.alpha_mode == AlphaMode::kBlend) out["alphaMode"] = "BLEND";
        if (material.alpha_mode == AlphaMode::kMask) out["alphaMode"] = "MASK";
        if (material.alpha_mode == AlphaMode::kMask) out["alphaCutoff"] = material.alpha_cutoff;
        if (material.double_sided) out["doubleSided"] = true;
        if (material.transmissive) {
            out["extensions"]["KHR_materials_transmission"] = {{"transmissionFactor", 1}};
            extensions_.insert("KHR_materials_transmission");
        }
        glb_.add("materials", std::move(out));
    }

    uint32_t addPositions(std::span<const glm::vec3> positions) {
        glm::vec3 least(0), most(0);
        if (!positions.empty()) least = most = positions.front();
        for (const glm::vec3& p : positions) least = glm::min(least, p), most = glm::max(most, p);
        const uint32_t view = glb_.addView(
            {reinterpret_cast<const unsigned char*>(positions.data()), positions.size_bytes()}, Glb::Target::kVertices);
        return glb_.add("accessors", {{"bufferView", view},
                                      {"componentType", 5126},
                                      {"count", positions.size()},
                                      {"type", "VEC3"},
                                      {"min", {least.x, least.y, least.z}},
                                      {"max", {most.x, most.y, most.z}}});
    }

    uint32_t addMesh(const Mesh& mesh) {
        deforming_ += mesh.deforms;
        const uint32_t positions = addPositions(mesh.positions);
        Json primitives = Json::array();
        for (const Primitive& primitive : mesh.primitives) {
            if (primitive.triangle_count == 0) continue;
            const std::span<const uint32_t> indices(mesh.indices.data() + 3 * size_t{primitive.first_triangle},
                                                    3 * size_t{primitive.triangle_count});
            primitives.push_back({{"attributes", {{"POSITION", positions}}},
                                  {"indices", glb_.addIndices(indices)},
                                  {"material", primitive.material}});
        }
        Json out = {{"primitives", std::move(primitives)}};
        if (!mesh.name.empty()) out["name"] = mesh.name;
        return glb_.add("meshes", std::move(out));
    }

    /// The node below which an object's own hangs: not one that bears its name already.
    uint32_t groupOf(const SceneObject& object) const {
        if (object.node == SceneNode::kNone || scene_.nodes[object.node].name != object.name) return object.node;
        return scene_.nodes[object.node].parent;
    }

    /// The nodes that have objects below them, then a node for each object.
    void addNodes() {
        std::vector<bool> needed(scene_.nodes.size());
        for (const SceneObject& object : scene_.objects)
            for (uint32_t i = groupOf(object); i != SceneNode::kNone && !needed[i]; i = scene_.nodes[i].parent)
                needed[i] = true;
        std::vector<uint32_t> node_at(scene_.nodes.size(), kUnwritten), meshes(scene_.meshes.size(), kUnwritten);
        for (uint32_t i = 0; i < needed.size(); ++i)
            if (needed[i]) node_at[i] = first_object_++;
        std::vector<std::vector<uint32_t>> children(first_object_);
        const auto hang = [&](uint32_t node, uint32_t parent) {
            if (parent == SceneNode::kNone) roots_.push_back(node);
            else children[node_at[parent]].push_back(node);
        };
        for (uint32_t i = 0; i < needed.size(); ++i)
            if (needed[i]) hang(node_at[i], scene_.nodes[i].parent);
        for (uint32_t i = 0; i < scene_.objects.size(); ++i) hang(first_object_ + i, groupOf(scene_.objects[i]));
        for (uint32_t i = 0; i < needed.size(); ++i) {
            if (!needed[i]) continue;
            Json node = {{"children", children[node_at[i]]}};
            if (const std::string& name = scene_.nodes[i].name; !name.empty()) node["name"] = unmarkedName(name);
            glb_.add("nodes", std::move(node));
        }
        for (const SceneObject& object : scene_.objects) {
            if (meshes[object.mesh] == kUnwritten) meshes[object.mesh] = addMesh(scene_.meshes[object.mesh]);
            Json node = {{"mesh", meshes[object.mesh]}};
            if (!object.name.empty()) node["name"] = unmarkedName(object.name);
            if (object.transform != glm::dmat4(1.0)) node["matrix"] = matrixOf(object.transform);
            glb_.add("nodes", std::move(node));
        }
    }

    void addCamera(const SceneCamera& camera) {
        constexpr double kFar = 1e9;  // parallel cameras of glTF have a far plane
        Json out;
        if (camera.fov_y > 0) {
            Json lens = {{"yfov", camera.fov_y}, {"znear", camera.z_near}};
            if (camera.z_far) lens["zfar"] = *camera.z_far;
            out = {{"type", "perspective"}, {"perspective", std::move(lens)}};
        } else {
            const double half = camera.orthographic_height / 2;
            out = {{"type", "orthographic"},
                   {"orthographic",
                    {{"xmag", half}, {"ymag", half}, {"znear", camera.z_near}, {"zfar", camera.z_far.value_or(kFar)}}}};
        }
        Json node = {{"camera", glb_.add("cameras", std::move(out))}, {"matrix", matrixOf(camera.transform)}};
        if (!camera.name.empty()) node["name"] = unmarkedName(camera.name);
        roots_.push_back(glb_.add("nodes", std::move(node)));
    }

    /// A node whose mesh is the shape of a mark, about its own centre.
    void addMark(Json mark, const std::vector<std::vector<glm::dvec3>>& outlines, const glm::dvec3& centre) {
        std::vector<glm::vec3> positions;
        std::vector<uint32_t> indices;
        for (const std::vector<glm::dvec3>& outline : outlines) {
            const auto first = static_cast<uint32_t>(positions.size());
            for (const glm::dvec3& corner : outline) positions.emplace_back(corner - centre);
            for (uint32_t i = 2; i < outline.size(); ++i)
                indices.insert(indices.end(), {first, first + i - 1, first + i});
        }
        const Json primitive = {{"attributes", {{"POSITION", addPositions(positions)}}},
                                {"indices", glb_.addIndices(indices)}};
        const uint32_t mesh = glb_.add("meshes", {{"primitives", Json::array({primitive})}});
        glm::dmat4 place(1.0);
        place[3] = glm::dvec4(centre, 1);
        roots_.push_back(glb_.add(
            "nodes", {{"mesh", mesh}, {"matrix", matrixOf(place)}, {"extras", {{"sightline", std::move(mark)}}}}));
    }

    void addBoxMark(Json mark, const Box3d& box) {
        mark["box"] = {pointOf(box.min), pointOf(box.max)};
        roots_.push_back(glb_.add("nodes", {{"extras", {{"sightline", std::move(mark)}}}}));
    }

    void addCell(const SceneCell& cell) {
        Json mark = {{"cell", cell.name}};
        const std::vector<glm::dvec4> sides = planesOfBox(cell.bounds);
        const bool is_box =
            cell.planes.size() == sides.size() && std::all_of(sides.begin(), sides.end(), [&](const glm::dvec4& side) {
                return std::find(cell.planes.begin(), cell.planes.end(), side) != cell.planes.end();
            });
        if (is_box) return addBoxMark(std::move(mark), cell.bounds);
        const ConvexRegion region = convexRegion(cell.planes);
        if (cell.planes.empty() || region.kind != ConvexRegion::Kind::kSolid) {
            ++shapeless_;
            return;
        }
        std::vector<std::vector<glm::dvec3>> outlines;
        for (const RegionFace& face : region.faces) outlines.push_back(face.outline);
        addMark(std::move(mark), outlines, region.bounds.center());
    }

    void addPortal(const ScenePortal& portal) {
        Json mark = {{"portal", portal.name}};
        std::array<std::string, 2> cells;
        for (int side = 0; side < 2; ++side)
            cells[side] = portal.cells[side] != ScenePortal::kNone ? scene_.cells[portal.cells[side]].name
                                                                   : portal.cell_names[side];
        if (!cells[0].empty() && !cells[1].empty()) mark["cells"] = cells;
        if (portal.door != ScenePortal::kNone) mark["door"] = first_object_ + portal.door;
        else if (!portal.door_name.empty()) mark["door"] = portal.door_name;
        if (portal.slide != glm::dvec3(0.0)) mark["slide"] = pointOf(portal.slide);
        Box3d box;
        for (const glm::dvec3& corner : portal.polygon) box.grow(corner);
        // A rectangle along the axes stays exact as a box.
        int flat = 0, ends = 0;
        for (int axis = 0; axis < 3; ++axis) flat += box.min[axis] == box.max[axis];
        for (const glm::dvec3& corner : portal.polygon)
            ends += glm::all(glm::lessThanEqual(glm::min(corner - box.min, box.max - corner), glm::dvec3(0.0)));
        if (portal.polygon.size() == 4 && flat == 1 && ends == 4) addBoxMark(std::move(mark), box);
        else if (portal.polygon.size() >= 3) addMark(std::move(mark), {portal.polygon}, box.center());
    }

    const Scene& scene_;
    Glb glb_;
    std::vector<uint32_t> roots_;
    uint32_t first_object_ = 0;  // its node
    std::set<std::string> extensions_;
    std::vector<std::string> notes_;
    size_t shapeless_ = 0, deforming_ = 0;
};

}  // namespace

std::string unmarkedName(const std::string& name) {
    return gltf::readMark(Glb::Json::object(), name, 0, "") ? "object " + name : name;
}

Result<WrittenGltf> sceneGltf(const Scene& scene, const std::string& name) { return SceneWriter(scene).write(name); }

}  // namespace sightline::tools
