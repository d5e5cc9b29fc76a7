// The node forest: transforms composed in double, parents before children, without recursion.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/import/gltf/gltf_json.h"
#include "sightline/tools/import/gltf/gltf_text.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::gltf {

/// What a node says of itself.
struct NodeMark {
    enum class Kind : uint8_t { kCell, kPortal };
    Kind kind = Kind::kCell;
    uint32_t node = 0;
    std::string name;
    std::optional<Box3d> box;  ///< in the node's frame; without one its mesh is the shape, and is not drawn
    std::string cells[2];      ///< of a portal
    std::string door;
    std::optional<uint32_t> door_node;
    glm::dvec3 slide{0.0};  ///< in the node's frame
};

/// The mark of a node, if it has one: `extras.sightline`, or a name as `cell.NAME`, `cell:NAME`, `portal.NAME`, `portal:NAME`; not
/// one as `cell.001`, which modellers make of copies. A Fault if `extras.sightline` is there and means nothing.
/// @param nodes  how many there are
std::optional<NodeMark> readMark(const Json& node, const std::string& name, size_t nodes, const std::string& place);

constexpr uint32_t kNoNode = SceneNode::kNone;

struct Node {
    std::optional<uint32_t> mesh, skin, camera;
    glm::dmat4 world{1.0};
    glm::dvec3 translation{0.0};  ///< in the parent's frame
    double scale = 1;             ///< the most by which it stretches any vector of its own
    std::vector<float> weights;   ///< of morph targets; empty: the mesh's own
    bool placed = false;          ///< the default scene reaches it
    bool drawn = false;           ///< and nothing hides it
    bool marked = false;          ///< its mesh is the shape of a cell or a portal, and is not drawn
    bool extended = false;        ///< its JSON has extensions
    uint8_t changes = 0;          ///< of it and of what is above it: SceneObject::Change
    std::vector<uint32_t> lods;   ///< MSFT_lod: nodes that stand for it from afar, finest first
};

struct NodeTree {
    std::vector<Node> nodes;
    std::vector<SceneNode> names;  ///< and parents  [size: nodes]
    std::vector<NodeMark> marks;   ///< in the order of nodes
    std::vector<uint32_t> order;   ///< all nodes, parents before children
    std::vector<uint32_t> rank;    ///< where each node stands in `order`
    std::vector<uint32_t> named;   ///< nodes with a parent that the scene names itself
};

/// How many elements the tables that a node refers to have.
struct NodeTargets {
    size_t meshes = 0, skins = 0, cameras = 0;
};

/// What the file as a whole does to its nodes.
struct NodeChanges {
    std::vector<bool> moved;  ///< moved, shown or hidden by an animation, or pointed at  [size: nodes]
    std::vector<bool> shown;  ///< hidden at rest, it may be shown all the same            [size: nodes]
};

/// Reads nodes and scenes. What an animation may show is drawn. A scene may name a node that has a parent, as some writers
/// do: it stands where its parent has it, and hides nothing, for readers differ. A Fault if a node has two parents or is
/// its own ancestor, or if a transform is not finite or not affine.
/// @param unknown  counts extensions that are not known
/// @param told     is called now and then with how many nodes have been read
NodeTree readNodes(const JsonText& json, const NodeTargets& targets, const NodeChanges& changes,
                   std::map<std::string, size_t>& unknown, const std::function<void(size_t)>& told);

/// Rotation (x, y, z, w), of any length: normalised; all zeros is no rotation.
glm::dmat3 rotationMatrix(const double rotation[4]);

/// translate * rotate * scale
glm::dmat4 composeTransform(const double translation[3], const double rotation[4], const double scale[3]);

/// False if any element is NaN or infinite.
bool finiteMatrix(const glm::dmat4& matrix);

}  // namespace sightline::tools::gltf
