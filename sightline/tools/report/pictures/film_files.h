// The pictures that lie beside a run's file, as a film.
// SPDX-License-Identifier: MIT
#pragma once

#include "sightline/tools/report/pictures/film.h"
#include "sightline/tools/report/run/run_reader.h"

namespace sightline::tools {

/// Frames of `frames/*.png` in the run's directory, spread evenly, as many as the budget lets in, and the overview; none if there
/// are none. Files that are not PNGs, or larger than 64 MiB, are passed over.
/// @param ids     which pictures: "shaded", "culled", "outside", "plan", "section", "heat-all", "heat-kept"
/// @param frames  of the run, ascending: those that may be taken
/// @param budget  of all pictures [bytes]
Film filmBeside(const RunFile& file, const std::vector<std::string>& ids, const std::vector<size_t>& frames,
                size_t budget);

}  // namespace sightline::tools
