// What a bake of a map's visibility came to, as JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/glm.hpp>

namespace sightline::tools {

/// Schema `sightline.vis/1`. Pairs are ordered, and each leaf or cluster sees itself.
struct VisSummary {
    std::string map;        ///< as the user named it
    std::string cells_are;  ///< where the clusters come from
    uint64_t leafs = 0, clusters = 0, portals = 0;
    uint64_t visible_leaf_pairs = 0;                     ///< as the lump counts them
    uint64_t witnessed_pairs = 0, unresolved_pairs = 0;  ///< of these
    uint64_t visible_cluster_pairs = 0, witnessed_cluster_pairs = 0;
    uint64_t pvs_bytes = 0;       ///< of the packed visibility file
    uint64_t resident_bytes = 0;  ///< of the rows when they are opened
    uint64_t lump_bytes = 0;      ///< of the run-length lump
    uint64_t steps = 0;           ///< portals that were clipped
    uint64_t over_budget = 0;     ///< portals and directions that ended by the budget
    bool stopped = false;         ///< by a limit in seconds: another run may end elsewhere
    double farthest = 0;          ///< sight ends so far from the eye; 0: nowhere  [world units]
    double cpu_seconds = 0, wall_seconds = 0;
    uint32_t threads = 1;

    struct Leak {
        std::string from;  ///< the class of what stands at its beginning
        std::vector<glm::dvec3> path;
    };
    std::vector<Leak> leaks;  ///< ways out of a map that is not sealed; one is told

    uint64_t unknown_brushes = 0;               ///< of a .map: they hide nothing, because their textures are not known
    std::vector<std::string> unknown_textures;  ///< the most frequent first

    /// The lump that the map came with beside the new one, in ordered pairs of its clusters.
    struct Before {
        uint64_t visible_pairs = 0, removed = 0, added = 0;
    };
    std::optional<Before> before;  ///< none: it has no lump

    struct Objects {
        uint64_t objects = 0, visible_pairs = 0, pairs_by_cells = 0;  ///< cells and objects; what lies in visible cells
        double cpu_seconds = 0;
    };
    std::optional<Objects> objects;

    struct Verification {
        uint64_t segments = 0, false_negatives = 0, doubtful = 0;
        struct Example {
            uint64_t from_leaf = 0, to_leaf = 0;
            glm::dvec3 from{0.0}, to{0.0};
        };
        std::vector<Example> examples;
        /// Segments through the brushes of a .map, as its text has them.
        struct Brushes {
            uint64_t segments = 0, false_negatives = 0;
            uint64_t solid_leaves = 0;      ///< of the tree, that stop sight where no brush does
            std::vector<Example> examples;  ///< of a solid leaf both leaves are the same
            uint64_t wrong() const { return false_negatives + solid_leaves; }
        };
        std::optional<Brushes> brushes;
    };
    std::optional<Verification> verification;
};

std::string visJson(const VisSummary& summary);

}  // namespace sightline::tools
