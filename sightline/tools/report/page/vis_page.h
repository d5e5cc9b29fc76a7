// A page with pictures of a map's visibility: its portals over the plan, the matrix, what cells see, a sight line.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/base/bit_matrix.h"
#include "sightline/base/result.h"
#include "sightline/cells/cells.h"
#include "sightline/tools/report/run/vis_json.h"

namespace sightline::tools {

/// Writes index.html, its pictures and vis.json into a directory that is there. Errors (kOutput): of the files.
/// @param visible, witnessed  [cells x cells]
Status writeVisPage(const CellGraph& graph, const BitMatrix& visible, const BitMatrix& witnessed,
                    const VisSummary& summary, const std::string& directory);

}  // namespace sightline::tools
