// A scene as plain data: what an importer fills and what a world, a renderer or a witness reads.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/math/box.h"

namespace sightline::tools {

enum class AlphaMode : uint8_t { kOpaque, kMask, kBlend };

struct Material {
    std::string name;
    glm::vec4 base_color{1.0f};
    AlphaMode alpha_mode = AlphaMode::kOpaque;
    float alpha_cutoff = 0.5f;
    bool double_sided = false;
    bool transmissive = false;  ///< KHR_materials_transmission and its kin

    /// Only opaque, non-transmissive surfaces hide what is behind them.
    bool hides() const { return alpha_mode == AlphaMode::kOpaque && !transmissive; }
};

/// A run of triangles of one material.
struct Primitive {
    uint32_t first_triangle = 0;
    uint32_t triangle_count = 0;
    uint32_t material = 0;  ///< index into Scene::materials
};

/// A coarser level of detail of a mesh, on the same positions.
struct MeshLod {
    static constexpr double kUnknown = -1;

    double error = kUnknown;  ///< LodLevel::error
    uint32_t vertices = 0;    ///< that its indices name
    std::vector<uint32_t> indices;
    std::vector<Primitive> primitives;  ///< as Mesh::primitives
};

/// Triangles in object space; counter-clockwise is front. Every position is finite.
struct Mesh {
    std::string name;
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;      ///< [size: 3 * triangles]
    std::vector<Primitive> primitives;  ///< covers the triangles in order, without gaps
    std::vector<MeshLod> lods;          ///< finest first; empty: this is the only level
    Box3d bounds;                       ///< of the positions and, where the mesh deforms, of every pose
    bool deforms = false;               ///< skinned or morphed: is bounded by `bounds`, and hides nothing

    size_t triangles() const { return indices.size() / 3; }
};

/// A name in the tree that a file's objects hang in. Objects carry their whole transform themselves.
struct SceneNode {
    static constexpr uint32_t kNone = ~0u;

    std::string name;         ///< may be empty
    uint32_t parent = kNone;  ///< index into Scene::nodes
};

/// One drawn instance of a mesh.
struct SceneObject {
    /// Why the file may draw it otherwise than it stands here.
    enum Change : uint8_t {
        kAnimated = 1,  ///< an animation or something that it points at moves it, or shows and hides it
        kUnknown = 2,   ///< the file says something of it that is not known
        kLevels = 4,    ///< from afar the file draws something else: Scene::levels
    };

    uint64_t key = 0;           ///< glTF: the node's index; GPU instances of one node share it
    uint32_t mesh = 0;          ///< index into Scene::meshes
    glm::dmat4 transform{1.0};  ///< object to world, affine; a negative determinant flips the winding
    std::string name;
    uint32_t node = SceneNode::kNone;  ///< index into Scene::nodes
    uint8_t changes = 0;               ///< bits of Change
};

/// What a file names as a coarser level of detail of an object.
struct SceneLevel {
    uint32_t object = 0;        ///< index into Scene::objects
    uint32_t mesh = 0;          ///< index into Scene::meshes
    glm::dmat4 transform{1.0};  ///< of the mesh to the object's own space
};

/// A room that a file tells of (IFC: a space). It is not drawn and hides nothing.
struct SceneRoom {
    uint32_t node = SceneNode::kNone;  ///< whose path is its name; index into Scene::nodes
    Box3d bounds;                      ///< in the world; empty: the file gives it no shape
};

/// A convex region that was declared to be a cell: by hand in the file, or by the generator that made the world.
struct SceneCell {
    std::string name;
    std::vector<glm::dvec4> planes;  ///< unit normal and distance, pointing inward: inside iff n.p + d >= 0
    Box3d bounds;
    /// How far the shape that it was made of reaches beyond its planes: more than rounding if that is not convex;
    /// infinite if it is no solid at all, and then there are no planes.  [world units]
    double overhang = 0;
};

/// A hole between two cells through which one is seen from the other.
struct ScenePortal {
    static constexpr uint32_t kNone = ~0u;

    std::string name;
    uint32_t cells[2] = {0, 0};       ///< indices into Scene::cells; kNone: not known
    std::vector<glm::dvec3> polygon;  ///< planar, convex; counter-clockwise as seen from cells[0]
    uint32_t door = kNone;            ///< index into Scene::objects of what shuts it; kNone: nothing does
    glm::dvec3 slide{0.0};            ///< which way it shrinks when the door shuts part of it; zero: not known
    std::string cell_names[2];        ///< as its maker named them; empty: those between which it lies
    std::string door_name;            ///< of a node or an object; empty: none was named
};

/// A file that a scene was read from.
struct SceneFile {
    std::string name;        ///< as the user named it
    uint64_t first_key = 0;  ///< what was added to the keys of its objects
};

/// A camera that came with the scene.
struct SceneCamera {
    std::string name;
    glm::dmat4 transform{1.0};       ///< camera to world; looks along its -z, y up
    double fov_y = 0;                ///< [radians]; 0: orthographic
    double orthographic_height = 0;  ///< full height [world units]; 0: perspective
    double z_near = 0.1;
    std::optional<double> z_far;  ///< none: infinite
};

struct Scene {
    std::string name;                 ///< the file's name or the procedural scene's specification
    std::vector<Material> materials;  ///< never empty once imported: index 0 is glTF's default if needed
    std::vector<Mesh> meshes;
    std::vector<SceneObject> objects;
    std::vector<SceneLevel> levels;  ///< of one object finest first, one after the other; may be empty
    std::vector<SceneCamera> cameras;
    std::vector<SceneNode> nodes;      ///< parents need not come first; no cycles
    std::vector<SceneCell> cells;      ///< may be empty
    std::vector<ScenePortal> portals;  ///< between these cells
    std::vector<SceneRoom> rooms;      ///< may be empty
    std::vector<SceneFile> files;      ///< empty: procedural
    double walk_speed = 0;             ///< how fast its game walks [world units a second]; 0: nothing says so
};

constexpr size_t kLongestPath = 4096;  // [bytes]: in a deep tree the paths of all would not fit into any memory

/// Names of the nodes above an object and its own, from the root: "Level 1/Kitchen/Door". Nodes without a name are
/// left out, and so is a node that only repeats the object's name. Of a path longer than kLongestPath the end is left,
/// behind ".../".
std::string objectPath(const Scene& scene, const SceneObject& object);

/// The same of a room.
std::string roomPath(const Scene& scene, const SceneRoom& room);

/// Triangles that would be drawn: each object's mesh counted once per object.
uint64_t drawnTriangles(const Scene& scene);

/// Objects whose bounds reach through half of the scene, by the diagonal; not those that deform.
struct WideObjects {
    uint64_t objects = 0;
    uint64_t triangles = 0;  ///< of theirs
};
WideObjects wideObjects(const Scene& scene);

/// The box around all objects' bounds, in world space. Empty if there are no objects.
Box3d worldBounds(const Scene& scene);

}  // namespace sightline::tools
