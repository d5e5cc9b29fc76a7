// Marked cells while they are checked: the state that the steps of cellsOfScene() work on.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <glm/glm.hpp>

#include "sightline/bake/marked/cell_report.h"
#include "sightline/bake/marked/opaque_walls.h"
#include "sightline/geom/convex_region.h"

namespace sightline::bake {
using namespace tools;

/// A face of a cell, and the parts of it that portals cover.
struct CheckedFace {
    uint32_t plane = 0;  ///< of CheckedCell::planes
    FlatFrame frame;     ///< its normal points into the cell
    FlatPiece outline;
    std::vector<FlatPiece> gates;
};

/// What of the settings holds for a cell: by its own place, whatever lies far off.  [world units]
struct CellTolerance {
    double slit = 0, bend = 0;

    /// A point this close to a face may be on either side.
    double thick() const { return std::max(slit, bend); }
    void grow(const CellTolerance& other) {
        slit = std::max(slit, other.slit);
        bend = std::max(bend, other.bend);
    }
};

struct CheckedCell {
    std::string name;
    CellTolerance tolerance;
    std::vector<glm::dvec4> planes;  ///< empty: it is no cell
    Box3d bounds;
    std::vector<CheckedFace> faces;

    bool solid() const { return !planes.empty(); }
};

/// A portal of the answer.
struct FoundPortal {
    uint32_t a = 0, b = 0;            ///< cells; kOutside: what is in no cell
    std::vector<glm::dvec3> outline;  ///< counter-clockwise as seen from a
    uint32_t marked = ScenePortal::kNone;
    uint32_t door = ScenePortal::kNone;  ///< of Scene::objects
};

class CheckedCells {
public:
    static constexpr uint32_t kOutside = CellGraph::kNoCell;

    CheckedCells(const Scene& scene, const SceneCellSettings& settings);

    /// Cells of the scene, as they are marked.
    void takeCells();
    void findOverlaps();
    /// Moves faces to the walls that are meant.
    void moveFaces();
    /// Lays portals into the faces of their cells, with cells for the thickness of walls.
    void placePortals();
    /// Takes portals as they are marked, for SceneCellSettings::trusted.
    void trustPortals();
    /// Makes portals of the parts of faces that are neither wall nor portal.
    void findHoles();
    SceneCells finish();

private:
    struct Lying {
        glm::dvec3 normal;  ///< from the second cell into the first
        glm::dvec3 middle;
        std::vector<glm::dvec3> outline;
        int face[2];  ///< of its cells
    };

    /// @param bounds  of a cell; not finite: it has no place
    CellTolerance toleranceIn(const Box3d& bounds) const;
    /// The wider one of two cells; kOutside, and what is no cell, has none.
    CellTolerance toleranceOf(uint32_t a, uint32_t b) const;
    void layFaces(CheckedCell& cell) const;
    /// Lets a cell's faces, of these planes alone, follow the walls; kept only if it stays a cell.
    void moveFaces(CheckedCell& cell, size_t planes, double reach);
    bool lies(uint32_t portal, Lying& lying);
    int faceNear(const CheckedCell& cell, const Lying& lying, double side) const;
    uint32_t doorOf(uint32_t portal, const Lying& lying);
    void join(uint32_t portal, const Lying& lying, uint32_t a, int face_a, uint32_t b, int face_b, uint32_t door);
    /// Lays the part of a piece that leads into b into a face of a; empty if there is none.
    FlatPiece addGate(uint32_t a, int face, uint32_t b, const FlatPiece& piece);
    /// A cell of what lies behind the portal's outline between two planes.
    uint32_t addPassage(uint32_t portal, const Lying& lying, const glm::dvec4& plane_a, const glm::dvec4& plane_b);
    bool placePortal(uint32_t portal, const Lying& lying);
    void findHoles(uint32_t cell, CheckedFace& face, const std::vector<WallTriangle>& triangles);
    void addHole(uint32_t cell, const CheckedFace& face, const FlatHole& hole);
    bool addHolePortal(uint32_t a, uint32_t b, const CheckedFace& face, const FlatPiece& piece);
    bool isKnown(uint32_t a, uint32_t b, const std::vector<glm::dvec3>& outline) const;
    void report(CellFinding finding);

    const Scene& scene_;
    const SceneCellSettings& settings_;
    OpaqueWalls walls_;
    CellTolerance widest_;  ///< of all cells
    std::vector<CheckedCell> cells_;
    std::vector<FoundPortal> portals_;
    std::map<std::pair<uint32_t, uint32_t>, std::vector<uint32_t>> holes_between_;  ///< of portals_
    std::set<uint32_t> used_;                                                       ///< objects that are walls
    SceneCellReport report_;
};

/// The part of an outline that lies in a cell, or no farther out of it than `room`.
std::vector<glm::dvec3> clippedTo(const CheckedCell& cell, std::vector<glm::dvec3> outline, double room);

/// A piece that holds all points that are within a distance of another, with as few corners.
FlatPiece widened(const FlatPiece& piece, double by);

/// The polygon's area as a vector towards the side from which it runs counter-clockwise.
glm::dvec3 areaVector(const std::vector<glm::dvec3>& outline);

}  // namespace sightline::bake
