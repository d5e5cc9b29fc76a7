// What `bake` tells of a bake: figures for people, and as JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "apps/cli/bake_source.h"
#include "sightline/bake/cell_visibility.h"

namespace sightline::cli {

struct BakeSummary {
    std::string scene;                                ///< as the user named it
    uint64_t visible_pairs = 0, witnessed_pairs = 0;  ///< of rows, ordered, each sees itself
    struct ObjectRows {
        uint64_t visible_pairs = 0, pairs_by_cells = 0;  ///< of rows and objects; what lies in visible cells
    };
    std::optional<ObjectRows> object_rows;
    uint64_t bytes = 0, resident_bytes = 0, in_place_bytes = 0;
    double cells_seconds = 0, rows_seconds = 0, objects_seconds = 0, seconds = 0;
    uint32_t threads = 1;
};

void printBakeSummary(std::FILE* out, const BakeSource& source, const CellVisibility& visibility,
                      const ObjectCells& objects, const BakeSummary& summary);

/// Schema `sightline.bake/1`.
std::string bakeJson(const BakeSource& source, const CellVisibility& visibility, const ObjectCells& objects,
                     const BakeSummary& summary);

}  // namespace sightline::cli
