// What `bake` and `vis` tell of a bake: figures for people, and as JSON.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>

#include "apps/cli/verbs/bake_source.h"
#include "sightline/bake/bake.h"
#include "sightline/base/bit_matrix.h"
#include "sightline/tools/report/run/vis_json.h"

namespace sightline::cli {
using namespace bake;
using namespace tools;

/// The figures of rows, as if each cell were a leaf: without names, bytes and times.
VisSummary rowFigures(const CellGraph& rows, const CellVisibility& visibility);

/// The figures of rows of objects.
VisSummary::Objects objectFigures(const BoxVisibility& objects);

/// What `vis` says.
void printVisSummary(std::FILE* out, const VisSummary& summary);

/// What rays from view cells see of their rows.
struct RowsByRays {
    uint32_t rays = 0;  ///< from each cell
    BitMatrix seen;     ///< seenOfRows()
    double median = 0;  ///< over cells that see something: objects of the row for each that a ray has seen
};

/// @param rows  the same rows as those of `seen`
RowsByRays rowsByRays(uint32_t rays, BitMatrix seen, const BitMatrix& rows);

/// What `bake` found besides the rows.
struct BakeSummary {
    VisSummary rows;  ///< Objects: of rows and objects; pvs_bytes: of the file
    uint64_t in_place_bytes = 0;
    double cells_seconds = 0, rows_seconds = 0, objects_seconds = 0;
    std::optional<RowsByRays> by_rays;
};

BakeSummary bakeSummary(const BakeSource& source, const Baked& baked, VisibilityForm form);

/// What `bake` says.
/// @param source  its cells are in `baked`
void printBakeSummary(std::FILE* out, const BakeSource& source, const Baked& baked, const BakeSummary& summary);

/// Schema `sightline.bake/1`.
std::string bakeJson(const BakeSource& source, const Baked& baked, const BakeSummary& summary);

}  // namespace sightline::cli
