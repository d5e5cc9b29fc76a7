// A compiled map of the Quake family as plain data: tree, faces, models, visibility, entities.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/geom/leaf_tree.h"
#include "sightline/math/box.h"

namespace sightline::tools {

enum class QuakeFormat : uint8_t {
    kQuake,     ///< version 29
    kBsp2,      ///< "BSP2": version 29 with wide numbers
    kPsb2,      ///< "2PSB": the same but for its boxes
    kHalfLife,  ///< version 30
    kQuake2,    ///< "IBSP" 38
    kQuake3,    ///< "IBSP" 46
};

/// What faces look like. Texture, flags and contents tell what may hide, and nothing else is taken of them.
struct QuakeTexture {
    std::string name;            ///< empty: the file does not hold it
    uint32_t surface_flags = 0;  ///< the file's own; of Quake and Half-Life texinfo's
    uint32_t contents = 0;       ///< Quake 3: of the shader
};

struct QuakeFace {
    enum class Kind : uint8_t {
        kPolygon,  ///< flat; without indices an outline, counter-clockwise as seen from its front, and drawn as the fan
                   ///< around its first point; else (Quake 3) these triangles
        kTriangles,  ///< Quake 3: a mesh
        kPatch,      ///< Quake 3: control points of biquadratic patches, row by row
        kNothing,    ///< fewer than three points, or a flare: not drawn
    };
    static constexpr uint32_t kNone = ~0u;

    Kind kind = Kind::kNothing;
    uint32_t texture = 0;                        ///< index into QuakeMapFile::textures
    uint32_t model = kNone;                      ///< 0: the world; else of an entity, which may move; kNone: of none
    uint32_t first_point = 0, point_count = 0;   ///< in QuakeMapFile::points
    uint32_t first_index = 0, index_count = 0;   ///< in QuakeMapFile::indices, which count from the first point
    uint32_t patch_width = 0, patch_height = 0;  ///< odd; points = width * height
};

struct QuakeModel {
    uint32_t first_face = 0, face_count = 0;
    Box3d bounds;  ///< as the file says
};

/// A run of QuakeMapFile::leaf_faces.
struct QuakeLeafFaces {
    uint32_t first = 0, count = 0;
};

/// A `.bsp`, turned from z up to y up: (x, y, z) became (x, z, -y); units stay. All indices are in range, all numbers
/// finite, and the tree of the world is one: at most kDeepest nodes lie above a leaf, and no open leaf hangs in it
/// twice.
///
/// A cluster is what has a row of visibility: in Quake and Half-Life the world's leaf i + 1, without the solid leaf 0.
struct QuakeMapFile {
    static constexpr uint32_t kNoCluster = ~0u;
    static constexpr uint32_t kDeepest = 4096;

    QuakeFormat format = QuakeFormat::kQuake;
    LeafTree tree;  ///< of the world, model 0; `contents` are of all leaves of the file
    uint32_t clusters = 0;
    std::vector<uint32_t> cluster_of_leaf;  ///< kNoCluster: solid, or not of the world

    std::vector<QuakeFace> faces;
    std::vector<glm::vec3> points;
    std::vector<uint32_t> indices;
    std::vector<QuakeTexture> textures;
    std::vector<QuakeModel> models;
    std::vector<QuakeLeafFaces> faces_of_leaf;
    std::vector<uint32_t> leaf_faces;  ///< faces; of the world and of entities that stood there

    std::string entities;                   ///< their text
    std::vector<unsigned char> visibility;  ///< the lump; sightline/tools/import/quake/quake_visibility.h reads it
    std::vector<int32_t> row_offsets;       ///< Quake, Half-Life: where in it a cluster's row begins; < 0: nowhere
};

}  // namespace sightline::tools
