// A map as `vis` bakes it: its cells and portals, the cell of each leaf, and the file that rows can be written into.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "apps/cli/verbs/map_rules.h"
#include "sightline/bake/brushes/outside.h"
#include "sightline/bake/objects/box_visibility.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/base/result.h"
#include "sightline/cells/cells.h"
#include "sightline/tools/import/quake/quake_bsp.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;

/// What becomes a cell of a compiled map.
enum class VisCells {
    /// Leaves that a portal file, the file's own clusters, or rows that it shares put together; else open groups.
    kClusters,
    kLeaves,  ///< each leaf: the tightest rows, and the most work
    kGroups,  ///< leaves that are open to one another
};

struct VisMapChoice {
    std::string name;  ///< .prt, .bsp, .map, or in an archive
    std::string bsp;   ///< for a .prt: the map that it belongs to; empty: none was named
    std::string prt;   ///< for a .bsp: the portal file that tells its clusters; empty: none was named
    MapRules rules;    ///< for a .map
    VisCells cells = VisCells::kClusters;
    bool water_is_opaque = false;
    bool needs_bsp = false;    ///< its lump is to be written
    bool keep_leaves = false;  ///< fill VisMap::leaf_graph
};

struct VisMap {
    CellGraph graph;
    uint32_t leaves = 0;                  ///< that can have a row
    std::string cells_are;                ///< where the cells come from, for people
    uint64_t content_hash = 0;            ///< of the file that the cells are of
    std::optional<QuakeMapFile> map;      ///< of a .bsp
    std::optional<LeafTree> tree;         ///< that the portals were made from, and rays judge; of a .prt none
    std::optional<CellGraph> leaf_graph;  ///< of the tree's leaves, each a cell; if they were to be kept
    double tolerance = 0;                 ///< how far portals of the tree may be off [world units]
    bool contents_stop = false;           ///< TreePortalSettings
    std::vector<MapLeak> leaks;           ///< of a .map
    std::string source;                   ///< of a .map: its text
    BrushRoles roles;                     ///< of a .map: its brushes
    double farthest = 0;                  ///< _farplanedist of its worldspawn: sight ends there; 0: none  [map units]
    std::string map_name;                 ///< of its bytes
    std::vector<unsigned char> map_bytes;
};

/// The end of a map's name, or of the archive that it is in, in small letters: ".bsp".
std::string mapKind(const std::string& name);

/// Errors: of the readers, of files that do not belong together (kInput), of what cannot be asked of a file of its
/// kind (kUsage).
Result<VisMap> loadVisMap(const VisMapChoice& choice);

/// The faces of a .bsp as boxes in cells.
CellBoxes facesOf(const VisMap& map);

/// The portal file that tells the clusters of a .bsp: the one that was named, or one beside it; empty: there is none.
std::string portalFileOf(const VisMapChoice& choice);

/// How many ordered pairs of leaves a matrix of cells stands for.
uint64_t leafPairs(const VisMap& map, const BitMatrix& cells);

}  // namespace sightline::cli
