// What a node says of itself: that it is a cell or a portal.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <glm/glm.hpp>

#include "sightline/math/box.h"
#include "sightline/tools/import/gltf/gltf_json.h"

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

}  // namespace sightline::tools::gltf
