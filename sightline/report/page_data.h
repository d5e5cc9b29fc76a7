// What a report's page holds for its script: numbers of every frame, pictures, and the table of objects.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <vector>

#include "sightline/report/chart.h"
#include "sightline/report/cull_run.h"
#include "sightline/report/film.h"
#include "sightline/report/page_table.h"

namespace sightline {

/// The JSON as it stands in a <script> element: nothing in it ends the element. Times and counts are rounded to what is
/// read.
std::string pageData(const CullRun& run, const Film& film, const std::vector<Chart>& charts, const ObjectTable& table);

}  // namespace sightline
