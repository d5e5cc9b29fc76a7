// Adds the cells and portals that marked nodes stand for to a scene.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_cells.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <utility>

#include "sightline/tools/scene/marked_cells.h"

namespace sightline::tools::gltf {
namespace {

constexpr double kFarthest = 1e100;  // as objects

/// A mesh as the nodes that it marks need it.
struct Shape {
    std::vector<glm::dvec3> points;
    std::vector<uint32_t> corners;
};

class Shapes {
public:
    Shapes(Document& document, const std::vector<MeshSource>& meshes)
        : document_(document), builder_(document), meshes_(meshes) {}

    Shape placed(uint32_t mesh, const glm::dmat4& world) {
        const auto [known, fresh] = built_.try_emplace(mesh);
        if (fresh) {
            builder_.expect(meshes_[mesh]);
            known->second = builder_.build(meshes_[mesh], false).mesh;
            builder_.release(meshes_[mesh]);
        }
        const Mesh& source = known->second;
        document_.budget.charge(source.positions.size() + source.indices.size(), 16, at("meshes", mesh));
        Shape shape;
        for (const glm::vec3& point : source.positions)
            shape.points.emplace_back(world * glm::dvec4(glm::dvec3(point), 1));
        shape.corners = source.indices;
        return shape;
    }

private:
    Document& document_;
    MeshBuilder builder_;
    const std::vector<MeshSource>& meshes_;
    std::unordered_map<uint32_t, Mesh> built_;
};

/// The largest face of a box: of a flat one, the box.
Shape faceOfBox(const Box3d& box, const glm::dmat4& world) {
    const glm::dvec3 size = box.size();
    const int flat = size.x <= size.y ? (size.x <= size.z ? 0 : 2) : (size.y <= size.z ? 1 : 2);
    const int u = (flat + 1) % 3, v = (flat + 2) % 3;
    Shape shape;
    for (const auto& [right, up] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        glm::dvec3 corner = box.center();
        corner[u] = right ? box.max[u] : box.min[u];
        corner[v] = up ? box.max[v] : box.min[v];
        shape.points.emplace_back(world * glm::dvec4(corner, 1));
    }
    return shape;
}

bool usable(const Shape& shape) {
    return std::all_of(shape.points.begin(), shape.points.end(), [](const glm::dvec3& point) {
        return std::abs(point.x) <= kFarthest && std::abs(point.y) <= kFarthest && std::abs(point.z) <= kFarthest;
    });
}

uint32_t objectOf(const Scene& scene, uint32_t node) {
    const auto found = std::lower_bound(scene.objects.begin(), scene.objects.end(), node,
                                        [](const SceneObject& object, uint32_t key) { return object.key < key; });
    const bool there = found != scene.objects.end() && found->key == node;
    return there ? static_cast<uint32_t>(found - scene.objects.begin()) : ScenePortal::kNone;
}

void addCell(const NodeMark& mark, const glm::dmat4& world, const Shape& shape, Scene& scene) {
    if (mark.box) scene.cells.push_back(cellOfBox(mark.name, *mark.box, world));
    else scene.cells.push_back(cellOfShape(mark.name, shape.points, shape.corners));
}

void addPortal(const NodeMark& mark, const glm::dmat4& world, const Shape& shape, Scene& scene) {
    ScenePortal portal;
    portal.name = mark.name;
    portal.cells[0] = portal.cells[1] = ScenePortal::kNone;
    portal.polygon = outlineOfShape(shape.points, shape.corners);
    for (int side = 0; side < 2; ++side) portal.cell_names[side] = mark.cells[side];
    portal.door_name = mark.door;
    if (mark.door_node) portal.door = objectOf(scene, *mark.door_node);
    portal.slide = glm::dmat3(world) * mark.slide;
    scene.portals.push_back(std::move(portal));
}

}  // namespace

void addMarked(Document& document, const NodeTree& tree, const std::vector<MeshSource>& meshes, Scene& scene) {
    Shapes shapes(document, meshes);
    for (const NodeMark& mark : tree.marks) {
        const Node& node = tree.nodes[mark.node];
        if (!node.placed) continue;
        const std::string place = at("nodes", mark.node);
        document.budget.charge(1, sizeof(SceneCell) + sizeof(ScenePortal) + 2 * mark.name.size(), place);
        if (!finiteMatrix(node.world)) fail(place, "its world transform is not finite");
        Shape shape;
        if (mark.box) shape = faceOfBox(*mark.box, node.world);
        else if (node.mesh) shape = shapes.placed(*node.mesh, node.world);
        if (!usable(shape)) fail(place, "its bounds in the world are too large");
        if (mark.kind == NodeMark::Kind::kCell) addCell(mark, node.world, shape, scene);
        else addPortal(mark, node.world, shape, scene);
        // Not for the memory: what many faces and many pairs take in time is to be in proportion to the file as well.
        if (mark.kind == NodeMark::Kind::kCell) {
            const uint64_t planes = scene.cells.back().planes.size();
            document.budget.charge(planes * planes, 16, place);
        }
    }
    document.budget.charge(scene.portals.size(), 8 * scene.cells.size(), "");
    resolvePortals(scene);
}

}  // namespace sightline::tools::gltf
