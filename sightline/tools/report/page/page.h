// The page of every report: one static file around the JSON of a run.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

namespace sightline::tools {

/// The whole page: report.html with its style, its scripts, Chart.js and the data in it. It needs no network.
/// @param data  JSON: an object whose `page` is "cull", "compare", "render", "vis" or "bake"; docs/report.md tells the rest
std::string pageWith(std::string_view data);

}  // namespace sightline::tools
