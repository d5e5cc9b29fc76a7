// The page of a cull along a path: what was culled, by what, at which cost, and the proof.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>
#include <string>

#include "sightline/tools/report/pictures/film.h"
#include "sightline/tools/report/run/cull_run.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// The whole page, with its pictures.
std::string reportPage(const Scene& scene, const CullRun& run, const PageSettings& settings = {});

/// The page of a run that was read from its file: without its scene, and with the pictures that lie beside the file.
/// @param names  of all keys that VerificationRow::kept_unseen of the run's frames stands for by their places here
std::string runPage(const CullRun& run, const std::vector<KeyName>& names, const Film& film);

}  // namespace sightline::tools
