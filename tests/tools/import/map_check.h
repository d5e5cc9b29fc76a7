// What must hold for whatever the readers of the Quake family hand out.
// SPDX-License-Identifier: MIT
#pragma once

#include <cmath>
#include <span>
#include <string>

#include "gltf_check.h"
#include "sightline/tools/import/quake/map_materials_files.h"
#include "sightline/tools/import/quake/map_source.h"
#include "sightline/tools/import/quake/prt.h"
#include "sightline/tools/import/quake/quake_map.h"
#include "sightline/tools/import/quake/quake_scene.h"
#include "sightline/tools/import/quake/quake_visibility.h"
#include "sightline/tools/import/quake/shader_script.h"
#include "tests/support/line_fault.h"

namespace sightline::test {
using namespace tools;

inline std::span<const unsigned char> bytesOf(const std::string& text) {
    return {reinterpret_cast<const unsigned char*>(text.data()), text.size()};
}

/// Empty, or what is wrong with the graph.
inline std::string graphFault(const CellGraph& graph) {
    for (const CellPortal& portal : graph.portals) {
        for (const uint32_t cell : portal.cells)
            if (cell >= graph.cells) return "a portal's cell is out of range";
        if (portal.cells[0] == portal.cells[1]) return "a portal leads into its own cell";
        if (portal.count < 3 || uint64_t(portal.first) + portal.count > graph.points.size())
            return "an outline is out of range";
        for (const glm::dvec3& point : graph.outline(portal))
            if (!(std::abs(glm::dot(glm::dvec3(portal.plane), point) + portal.plane.w) <= portal.thickness))
                return "a portal is thicker than it says";
    }
    for (const uint32_t cell : graph.cell_of_leaf)
        if (cell != CellGraph::kNoCell && cell >= graph.cells) return "a leaf's cell is out of range";
    return "";
}

/// Empty, or what is wrong with the answer to these bytes.
inline std::string prtFault(const std::string& bytes) {
    const Result<CellGraph> graph = parsePrt(bytesOf(bytes), "fuzz.prt");
    return graph.ok() ? graphFault(*graph) : lineFault(graph.error(), "fuzz.prt");
}

inline std::string faceFault(const QuakeMapFile& map, const QuakeFace& face) {
    if (face.texture >= map.textures.size()) return "a face's texture is out of range";
    if (face.model != QuakeFace::kNone && face.model >= map.models.size()) return "a face's model is out of range";
    if (uint64_t(face.first_point) + face.point_count > map.points.size()) return "a face's points are out of range";
    if (uint64_t(face.first_index) + face.index_count > map.indices.size()) return "a face's indices are out of range";
    for (uint32_t i = 0; i < face.index_count; ++i)
        if (map.indices[face.first_index + i] >= face.point_count) return "an index of a face is out of range";
    if (face.kind != QuakeFace::Kind::kNothing && face.point_count < 3) return "a face is drawn of two points";
    if (face.kind == QuakeFace::Kind::kPatch && face.patch_width * face.patch_height != face.point_count)
        return "a patch is no rectangle";
    return "";
}

/// Empty, or why the tree is none: parents first, each node once, within the promised depth.
inline std::string treeFault(const LeafTree& tree) {
    std::vector<uint32_t> depth(tree.nodes.size(), 0);
    for (size_t i = 0; i < tree.nodes.size(); ++i) {
        if (i > 0 && depth[i] == 0) return "a node comes before its parent, or has none";
        if (depth[i] >= QuakeMapFile::kDeepest) return "the tree is too deep";
        const LeafTreeNode& node = tree.nodes[i];
        if (!(std::abs(glm::length(glm::dvec3(node.plane)) - 1) < 1e-3)) return "a plane has no unit normal";
        for (const uint32_t child : node.child) {
            if (child >= LeafTreeNode::kLeaf) {
                if (child - LeafTreeNode::kLeaf >= tree.contents.size()) return "a leaf is out of range";
                continue;
            }
            if (child <= i || child >= tree.nodes.size() || depth[child] != 0) return "a node has two parents";
            depth[child] = depth[i] + 1;
        }
    }
    return tree.bounds.finite() ? "" : "the tree's bounds are not finite";
}

/// Empty, or what is wrong with a map.
inline std::string mapFault(const QuakeMapFile& map) {
    for (const QuakeFace& face : map.faces)
        if (const std::string fault = faceFault(map, face); !fault.empty()) return fault;
    for (const glm::vec3& point : map.points)
        for (int axis = 0; axis < 3; ++axis)
            if (!std::isfinite(point[axis])) return "a point is not finite";
    const size_t leaves = map.tree.contents.size();
    if (map.cluster_of_leaf.size() != leaves || map.faces_of_leaf.size() != leaves) return "leaves are missing";
    for (const uint32_t cluster : map.cluster_of_leaf)
        if (cluster != QuakeMapFile::kNoCluster && cluster >= map.clusters) return "a cluster is out of range";
    for (const QuakeLeafFaces& faces : map.faces_of_leaf)
        if (uint64_t(faces.first) + faces.count > map.leaf_faces.size()) return "a leaf's faces are out of range";
    for (const uint32_t face : map.leaf_faces)
        if (face >= map.faces.size()) return "a leaf's face is out of range";
    return treeFault(map.tree);
}

/// Empty, or what is wrong with the answer to these bytes.
inline std::string bspFault(const std::string& bytes) {
    const Result<QuakeMapFile> map = parseQuakeBsp(bytesOf(bytes), "fuzz.bsp");
    if (!map.ok()) return lineFault(map.error(), "fuzz.bsp");
    if (const std::string fault = mapFault(*map); !fault.empty()) return fault;
    const Result<Scene> scene = quakeScene(*map, "fuzz.bsp");
    if (const std::string fault = scene.ok() ? sceneFault(*scene) : lineFault(scene.error(), "fuzz.bsp");
        !fault.empty())
        return fault;
    const Result<QuakeVisibility> seen = readQuakeVisibility(*map, "fuzz.bsp");
    if (!seen.ok()) return lineFault(seen.error(), "fuzz.bsp");
    const Result<std::vector<unsigned char>> out = replaceQuakeVisibility(bytesOf(bytes), "fuzz.bsp", seen->seen);
    if (!out.ok()) return lineFault(out.error(), "fuzz.bsp");
    const Result<QuakeMapFile> again = parseQuakeBsp(*out, "fuzz.bsp");
    if (!again.ok()) return "what was written is not read: " + again.error().message;
    const Result<QuakeVisibility> same = readQuakeVisibility(*again, "fuzz.bsp");
    return same.ok() && same->seen == seen->seen ? "" : "what was written says something else";
}

/// Empty, or what is wrong with the answer to these bytes, the source of a map.
inline std::string sourceFault(const std::string& bytes) {
    const Result<QuakeMap> map = parseQuakeMap(bytesOf(bytes), "fuzz.map");
    if (!map.ok()) return lineFault(map.error(), "fuzz.map");
    uint64_t pairs = 0, brushes = 0, sides = 0;
    for (const QuakeMapEntity& entity : map->entities) {
        if (entity.first_pair != pairs || entity.first_brush != brushes) return "an entity's things are out of order";
        pairs += entity.pair_count;
        brushes += entity.brush_count;
        (void)map->valueOf(entity, "origin");
    }
    if (pairs != map->pairs.size() || brushes != map->brushes.size()) return "an entity's things are out of range";
    for (const QuakeMapBrush& brush : map->brushes) {
        if (brush.first_side != sides) return "a brush's sides are out of order";
        sides += brush.side_count;
    }
    if (sides != map->sides.size()) return "a brush's sides are out of range";
    for (const QuakeMapSide& side : map->sides) {
        if (side.texture >= map->textures.size()) return "a side's texture is out of range";
        for (const glm::dvec3& point : side.points)
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(point[axis]) <= 1e9)) return "a point is not finite, or too far";
    }
    for (const QuakeMapPair& pair : map->pairs)
        if (const auto vector = quakeVector(pair.value); vector && !(std::abs(vector->x) <= 1e9))
            return "a vector is not finite, or too far";
    return "";
}

/// Empty, or what is wrong with the answer to these bytes, a shader script.
inline std::string shaderFault(const std::string& bytes) {
    MapMaterials materials;
    const Status read = parseShaderScript(bytesOf(bytes), "fuzz.shader", materials);
    for (const auto& [name, role] : materials.shaders) {
        if (role > BrushRole::kNothing) return "a role is out of range";
        if (nameOfTexture(name) != name && !name.starts_with("textures/")) return "a name is not as maps have it";
    }
    return read.ok() ? "" : lineFault(read.error(), "fuzz.shader");
}

/// Empty, or what is wrong with the answer to these bytes, a .wal.
inline std::string walFault(const std::string& bytes) {
    const Result<MapFlags> flags = parseWal(bytesOf(bytes), "fuzz.wal");
    return flags.ok() ? bytes.size() < 100 ? "it has no header" : "" : lineFault(flags.error(), "fuzz.wal");
}

/// Empty, or what is wrong with how an archive of these bytes is listed and unpacked.
inline std::string archiveFault(const std::string& bytes) {
    const Result<std::vector<ArchiveEntry>> entries = listArchive(bytesOf(bytes), "fuzz.pk3");
    if (!entries.ok()) return lineFault(entries.error(), "fuzz.pk3");
    for (const ArchiveEntry& entry : *entries) {
        if (entry.zipped && entry.name.ends_with('/')) return "a folder is listed";
        const Result<std::vector<unsigned char>> out = unpackEntry(bytesOf(bytes), "fuzz.pk3", entry);
        const std::string fault = out.ok() ? out->size() == entry.size ? "" : "an entry has another size"
                                           : lineFault(out.error(), "fuzz.pk3");
        if (!fault.empty()) return fault;
    }
    return "";
}

}  // namespace sightline::test
