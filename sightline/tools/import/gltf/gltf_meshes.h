// Builds meshes: triangle lists, strips and fans over shared vertices.
// SPDX-License-Identifier: MIT
#pragma once

#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "sightline/tools/import/gltf/gltf_document.h"
#include "sightline/tools/import/gltf/gltf_text.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools::gltf {

struct Materials {
    std::vector<Material> list;  ///< never empty
    uint32_t first = 0;          ///< where glTF's material 0 is; 1 if the default material stands before it
    size_t count = 0;            ///< glTF's own
    std::map<uint32_t, std::vector<uint32_t>> levels;       ///< MSFT_lod: what stands for a material from afar
    std::map<std::vector<uint32_t>, uint32_t> of_variants;  ///< made for sets of glTF's own; at the end of `list`
};

/// The default material comes first if a primitive names none.
Materials readMaterials(Document& document);

/// A primitive that draws triangles; its numbers are accessors, of a Draco stream or of the file.
struct PrimitiveSource {
    std::string place;
    uint32_t number = 0;  ///< in its mesh
    uint32_t mode = 4;
    std::optional<uint32_t> indices;
    uint32_t positions = 0;
    uint32_t material = 0;                                  ///< in Scene::materials
    std::optional<uint32_t> stream;                         ///< in Document::streams: where accessors get their data
    std::vector<std::pair<uint32_t, uint32_t>> influences;  ///< joints and weights, set by set
    std::vector<std::optional<uint32_t>> targets;           ///< displacements of the morph targets
};

/// Corners of the triangles that a primitive draws, lists, strips and fans alike.
/// @param vertices  that it has; a Fault if a corner is none of them
std::vector<uint32_t> triangleCorners(Document& document, const PrimitiveSource& source, uint32_t vertices);

struct MeshSource {
    std::string name;
    std::vector<PrimitiveSource> primitives;  ///< points, lines and what has no positions are left out
    std::vector<float> weights;               ///< of the morph targets; missing ones are 0
    size_t targets = 0;
    bool morphs = false;     ///< some target displaces positions
    bool skinnable = false;  ///< has joints and weights
};

/// Reads all meshes of the JSON, without their data. A primitive that may be drawn with one of several materials
/// (KHR_materials_variants, MSFT_lod of materials) gets one that hides no more, and is seen from no fewer sides, than each
/// of them; one that carries an extension that is not known gets one that does not hide.
std::vector<MeshSource> readMeshes(Document& document, Materials& materials);

/// Where the vertices of a primitive came from.
struct VertexRun {
    const PrimitiveSource* primitive = nullptr;
    uint32_t first = 0;            ///< in Mesh::positions
    std::vector<uint32_t> source;  ///< index in the primitive's accessors, vertex by vertex
};

struct BuiltMesh {
    Mesh mesh;
    std::vector<VertexRun> runs;  ///< only if asked for
};

/// Builds meshes one after another; keeps the decoded positions that later ones will share.
class MeshBuilder {
public:
    explicit MeshBuilder(Document& document) : document_(document) {}

    /// Announces a build, so that positions live until their last use.
    void expect(const MeshSource& source);

    /// Only vertices that a triangle uses are taken. With `keep_runs`, primitives share no vertices and the
    /// runs tell where they came from. Without triangles the mesh is empty.
    BuiltMesh build(const MeshSource& source, bool keep_runs);

    /// After each build, once nothing asks for the vertices' other attributes: lets go of what Draco streams unpacked.
    void release(const MeshSource& source);

private:
    struct Positions {
        size_t uses = 0;
        bool decoded = false;
        std::vector<float> xyz;
        std::vector<uint32_t> epoch, id;  ///< a vertex has its place in the mesh of that epoch
    };

    void addPrimitive(const PrimitiveSource& source, bool keep_runs, BuiltMesh& out);

    Document& document_;
    std::unordered_map<uint32_t, Positions> positions_;
    uint32_t epoch_ = 0;
};

}  // namespace sightline::tools::gltf
