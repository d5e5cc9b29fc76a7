// The node forest: transforms composed in double, parents before children, without recursion.
// SPDX-License-Identifier: MIT
#include "sightline/tools/import/gltf/gltf_nodes.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>
#include <utility>

#include "sightline/math/stretch.h"
#include "sightline/tools/import/gltf/gltf_features.h"

namespace sightline::tools::gltf {
namespace {

/// The rest of a name behind `cell.` and the like; empty: it is none of these.
std::string_view behind(std::string_view name, std::string_view word) {
    if (!name.starts_with(word) || name.size() < word.size() + 2) return {};
    if (name[word.size()] != '.' && name[word.size()] != ':') return {};
    name.remove_prefix(word.size() + 1);
    return name.find_first_not_of("0123456789") == name.npos ? std::string_view() : name;
}

void readBox(const Json& json, NodeMark& mark, const std::string& place) {
    const Json* ends = find(json, "box");
    if (!ends) return;
    if (!ends->is_array() || ends->size() != 2) fail(place, "box is not two corners");
    double corners[2][3];
    for (size_t i = 0; i < 2; ++i) {
        const Json corner = {{"box", (*ends)[i]}};
        numbers(corner, "box", corners[i], place);
    }
    mark.box.emplace();
    for (const auto& corner : corners) mark.box->grow({corner[0], corner[1], corner[2]});
}

void readPortal(const Json& json, size_t nodes, NodeMark& mark, const std::string& place) {
    if (const Json* cells = find(json, "cells")) {
        if (!cells->is_array() || cells->size() != 2) fail(place, "cells are not two names");
        for (size_t i = 0; i < 2; ++i) {
            if (!(*cells)[i].is_string()) fail(place, "cells are not two names");
            mark.cells[i] = (*cells)[i].get<std::string>();
        }
    }
    if (const Json* door = find(json, "door")) {
        if (door->is_string()) mark.door = door->get<std::string>();
        else mark.door_node = index(json, "door", nodes, place);
    }
    double slide[3] = {0, 0, 0};
    numbers(json, "slide", slide, place);
    mark.slide = {slide[0], slide[1], slide[2]};
}

// Files written in single precision carry last rows that are off by their rounding.
constexpr double kAffineTolerance = 1e-5;

glm::dmat4 readMatrix(const double (&m)[16], const std::string& place) {
    glm::dmat4 out;
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row) out[column][row] = m[4 * column + row];
    for (int column = 0; column < 4; ++column) {
        const double wanted = column == 3 ? 1 : 0;
        if (std::abs(out[column][3] - wanted) > kAffineTolerance)
            fail(place, "matrix is not affine: its last row holds {} at column {}", out[column][3], column);
        out[column][3] = wanted;
    }
    return out;
}

// In the parent's frame, until parents are known.
void readTransform(const Json& json, Node& node, const std::string& place) {
    double matrix[16];
    double translation[3] = {0, 0, 0}, rotation[4] = {0, 0, 0, 1}, scale[3] = {1, 1, 1};
    if (numbers(json, "matrix", matrix, place)) {
        node.world = readMatrix(matrix, place);
        node.scale = largestStretch(node.world);
        return;
    }
    numbers(json, "translation", translation, place);
    numbers(json, "rotation", rotation, place);
    numbers(json, "scale", scale, place);
    node.world = composeTransform(translation, rotation, scale);
    node.scale = std::max({std::abs(scale[0]), std::abs(scale[1]), std::abs(scale[2])});
    if (!finiteMatrix(node.world)) fail(place, "transform is not finite");
}

void readChildren(const Json& json, uint32_t parent, std::vector<SceneNode>& nodes, const std::string& place) {
    const Json& children = table(json, "children", place);
    for (size_t i = 0; i < children.size(); ++i) {
        const uint32_t child = indexAt(children, i, "children", nodes.size(), place);
        if (nodes[child].parent != kNoNode)
            fail(at("nodes", child), "has two parents: nodes[{}] and nodes[{}]", nodes[child].parent, parent);
        nodes[child].parent = parent;
    }
}

void readNode(const Json& json, uint32_t i, const NodeTargets& targets, std::map<std::string, size_t>& unknown,
              NodeTree& tree) {
    const std::string place = at("nodes", i);
    Node& node = tree.nodes[i];
    tree.names[i].name = text(json, "name", place);
    node.mesh = index(json, "mesh", targets.meshes, place);
    node.skin = index(json, "skin", targets.skins, place);
    node.camera = index(json, "camera", targets.cameras, place);
    node.weights = floats(json, "weights", place);
    node.extended = json.contains("extensions");
    if (node.extended) {
        const Effect effect = effectOfExtensions(json, unknown);
        if (effect == Effect::kMoves) node.changes |= SceneObject::kAnimated;
        if (effect == Effect::kUnknown) node.changes |= SceneObject::kUnknown;
        if (const Json* lod = extension(json, "MSFT_lod", place)) {
            const Json& ids = table(*lod, "ids", place);
            for (size_t k = 0; k < ids.size(); ++k)
                node.lods.push_back(indexAt(ids, k, "ids", tree.nodes.size(), place));
        }
    }
    if (std::optional<NodeMark> mark = readMark(json, tree.names[i].name, tree.nodes.size(), place)) {
        mark->node = i;
        node.marked = !mark->box;
        tree.marks.push_back(std::move(*mark));
    }
    readTransform(json, node, place);
    node.translation = glm::dvec3(node.world[3]);
    readChildren(json, i, tree.names, place);
}

// Breadth first from the parentless: what is not reached hangs in a cycle.
std::vector<uint32_t> parentsFirst(const std::vector<SceneNode>& nodes) {
    std::vector<uint32_t> first(nodes.size() + 1, 0), children(nodes.size()), order;
    for (const SceneNode& node : nodes)
        if (node.parent != kNoNode) ++first[node.parent + 1];
    for (size_t i = 1; i < first.size(); ++i) first[i] += first[i - 1];
    std::vector<uint32_t> next(first.begin(), first.end() - 1);
    for (uint32_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].parent != kNoNode) children[next[nodes[i].parent]++] = i;

    order.reserve(nodes.size());
    for (uint32_t i = 0; i < nodes.size(); ++i)
        if (nodes[i].parent == kNoNode) order.push_back(i);
    for (size_t i = 0; i < order.size(); ++i)
        order.insert(order.end(), children.begin() + first[order[i]], children.begin() + first[order[i] + 1]);
    if (order.size() == nodes.size()) return order;

    std::vector<bool> reached(nodes.size(), false);
    for (const uint32_t i : order) reached[i] = true;
    // Up the parents as many steps as there are nodes ends inside the cycle, not on a branch that hangs from it.
    uint32_t inside = static_cast<uint32_t>(std::find(reached.begin(), reached.end(), false) - reached.begin());
    for (size_t step = 0; step < nodes.size(); ++step) inside = nodes[inside].parent;
    fail(at("nodes", inside), "is its own ancestor");
}

// The roots of the scene that is shown: marks them as placed.
void markRoots(const JsonText& json, NodeTree& tree) {
    const JsonTable scenes = json.table("scenes");
    const std::optional<uint32_t> shown = index(json.members({"scene"}), "scene", scenes.size(), "");
    for (size_t i = 0; scenes.empty() && i < tree.nodes.size(); ++i)
        tree.nodes[i].placed = tree.names[i].parent == kNoNode;
    for (size_t i = 0; i < scenes.size(); ++i) {
        if (shown && *shown != i) continue;
        const std::string place = at("scenes", i);
        const Json scene = scenes.object(i, place);
        const Json& roots = table(scene, "nodes", place);
        for (size_t k = 0; k < roots.size(); ++k) {
            const uint32_t node = indexAt(roots, k, "nodes", tree.nodes.size(), place);
            tree.nodes[node].placed = true;
            if (tree.names[node].parent == kNoNode) continue;
            tree.nodes[node].changes |= SceneObject::kUnknown;
            tree.named.push_back(node);
        }
    }
}

// KHR_node_visibility hides a node with everything below it.
bool hiddenByFile(const Json& json, const std::string& place) {
    const Json* visibility = extension(json, "KHR_node_visibility", place);
    return visibility && find(*visibility, "visible") && !flag(*visibility, "visible", place);
}

}  // namespace

std::optional<NodeMark> readMark(const Json& node, const std::string& name, size_t nodes, const std::string& place) {
    NodeMark mark;
    const Json* extras = find(node, "extras");
    const Json* json = extras && extras->is_object() ? find(*extras, "sightline") : nullptr;
    if (json) {
        const std::string inner = place + ".extras.sightline";
        if (!json->is_object()) fail(inner, "is not an object");
        const bool cell = json->contains("cell"), portal = json->contains("portal");
        if (cell == portal) fail(inner, "is neither a cell nor a portal, or both");
        mark.kind = cell ? NodeMark::Kind::kCell : NodeMark::Kind::kPortal;
        mark.name = text(*json, cell ? "cell" : "portal", inner);
        readBox(*json, mark, inner);
        if (portal) readPortal(*json, nodes, mark, inner);
        return mark;
    }
    const std::string_view cell = behind(name, "cell"), portal = behind(name, "portal");
    if (cell.empty() && portal.empty()) return std::nullopt;
    mark.kind = portal.empty() ? NodeMark::Kind::kCell : NodeMark::Kind::kPortal;
    mark.name = portal.empty() ? cell : portal;
    return mark;
}

NodeTree readNodes(const JsonText& json, const NodeTargets& targets, const NodeChanges& changes,
                   std::map<std::string, size_t>& unknown, const std::function<void(size_t)>& told) {
    const JsonTable array = json.table("nodes");
    NodeTree tree;
    tree.nodes.resize(array.size());
    tree.names.resize(array.size());
    for (uint32_t i = 0; i < array.size(); ++i) {
        readNode(array.object(i, at("nodes", i)), i, targets, unknown, tree);
        if (changes.moved[i]) tree.nodes[i].changes |= SceneObject::kAnimated;
        if (i % 1024 == 0) told(i);
    }
    tree.order = parentsFirst(tree.names);
    tree.rank.resize(tree.order.size());
    for (uint32_t i = 0; i < tree.order.size(); ++i) tree.rank[tree.order[i]] = i;
    markRoots(json, tree);
    for (const uint32_t i : tree.order) {
        Node& node = tree.nodes[i];
        if (const uint32_t parent = tree.names[i].parent; parent != kNoNode) {
            node.world = tree.nodes[parent].world * node.world;
            const Node& above = tree.nodes[parent];
            node.drawn = above.drawn || (node.placed && !above.placed);
            node.placed = node.placed || above.placed;
            node.changes |= tree.nodes[parent].changes;
        } else {
            node.drawn = node.placed;
        }
        if (node.drawn && node.extended && !changes.shown[i]) node.drawn = !hiddenByFile(array[i], at("nodes", i));
    }
    // What stands for another node is not drawn beside it.
    for (const Node& node : tree.nodes)
        for (const uint32_t lod : node.lods) tree.nodes[lod].drawn = false;
    return tree;
}

glm::dmat3 rotationMatrix(const double rotation[4]) {
    const double largest =
        std::max({std::abs(rotation[0]), std::abs(rotation[1]), std::abs(rotation[2]), std::abs(rotation[3])});
    if (largest == 0) return glm::dmat3(1.0);
    // Twice, so that neither huge nor tiny components leave the range in between.
    double x = rotation[0] / largest, y = rotation[1] / largest, z = rotation[2] / largest, w = rotation[3] / largest;
    const double length = std::sqrt(x * x + y * y + z * z + w * w);
    x /= length, y /= length, z /= length, w /= length;
    glm::dmat3 m;
    m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)};
    m[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)};
    m[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)};
    return m;
}

glm::dmat4 composeTransform(const double translation[3], const double rotation[4], const double scale[3]) {
    const glm::dmat3 turned = rotationMatrix(rotation);
    glm::dmat4 out(1.0);
    for (int column = 0; column < 3; ++column) out[column] = glm::dvec4(turned[column] * scale[column], 0.0);
    out[3] = {translation[0], translation[1], translation[2], 1.0};
    return out;
}

bool finiteMatrix(const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

}  // namespace sightline::tools::gltf
