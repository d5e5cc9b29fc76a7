// The solids that procedural scenes are built from: boxes, prisms, walls with recesses, turned shapes.
// SPDX-License-Identifier: MIT
#pragma once

#include <array>
#include <map>
#include <string>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/tools/scene/scene.h"

namespace sightline::tools::city {

/// Collects triangles by material. Vertices at equal positions are one vertex, so a closed solid has every
/// edge once in each direction; solids that must stay apart must not share an edge.
class MeshBuilder {
public:
    /// Counter-clockwise is front. Positions are rounded to 1/1024 m, which float holds exactly.
    void triangle(uint32_t material, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c);
    void quad(uint32_t material, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c, const glm::dvec3& d);

    /// The mesh: one primitive per material, in the order of the materials' numbers.
    Mesh finish(std::string name) const;

private:
    uint32_t vertex(const glm::dvec3& position);

    std::vector<glm::vec3> positions_;
    std::map<std::array<float, 3>, uint32_t> numbers_;
    std::map<uint32_t, std::vector<uint32_t>> indices_;  ///< by material
};

/// A closed box of 12 triangles.
void addBox(MeshBuilder& mesh, uint32_t material, const glm::dvec3& min, const glm::dvec3& max);

/// Right-handed axes of an extrusion: an outline lies in (u, v), counter-clockwise, and is carried along w.
struct Frame {
    glm::dvec3 origin, u, v, w;
};

inline constexpr Frame kUpright{{0, 0, 0}, {0, 0, 1}, {1, 0, 0}, {0, 1, 0}};   ///< outlines (z, x), carried up
inline constexpr Frame kAcross{{0, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};   ///< profiles (z, y), carried to -x
inline constexpr Frame kSideways{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};  ///< profiles (x, y), carried to +z

/// The axes of kSideways turned about the vertical by a number of fifths, 0 to 4: profiles (outward, up).
Frame fifthFrame(int fifth);

/// A closed prism. @param low, high  along w, low < high
void addPrism(MeshBuilder& mesh, uint32_t material, const Frame& frame, const std::vector<glm::dvec2>& outline,
              double low, double high);

/// One ring of a turned solid.
struct Ring {
    double radius, y;
};

/// A closed solid turned about the vertical through `center`: rings from below to above; a radius of 0 at
/// either end is a tip, otherwise the end is flat.
/// @param sides  3, 4, 6, 8, 12 or 16
void addTurned(MeshBuilder& mesh, uint32_t material, const glm::dvec3& center, int sides,
               const std::vector<Ring>& rings);

/// The corners of a regular polygon of 3, 4, 6, 8, 12 or 16 sides and radius 1, counter-clockwise. A square's sides
/// lie along the axes.
std::vector<glm::dvec2> regularPolygon(int sides);

/// How one wall of a body is broken up: by bays as tall as the body, so that every face is one large rectangle.
struct Wall {
    int bays = 0;         ///< 0: plain
    double pier = 0;      ///< width of the plain strips between and beside the bays  [metres]
    double depth = 0;     ///< of the bays; negative stands out                       [metres, != 0]
    bool glazed = false;  ///< one pane closes each bay half-way
};

struct BodyMaterials {
    uint32_t wall, bay, roof, glass;
};

/// A closed upright body over an outline, with bays in its walls. Bays of two walls that meet in a corner keep
/// clear of each other if each pier is wider than the depth.
/// @param outline  (x, z), counter-clockwise as seen from above
/// @param walls    wall i stands between corners i and i + 1  [size: outline]
void addBody(MeshBuilder& mesh, const BodyMaterials& materials, const std::vector<glm::dvec2>& outline, double foot,
             double eaves, const std::vector<Wall>& walls);

/// Triangles that cover a simple polygon without cutting its edges; no triangle is degenerate, and
/// vertices on a straight line are used like any other.
/// @param outline  counter-clockwise
std::vector<std::array<uint32_t, 3>> triangulate(const std::vector<glm::dvec2>& outline);

}  // namespace sightline::tools::city
