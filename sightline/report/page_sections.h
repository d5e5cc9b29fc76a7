// The sections of a report's page, each a piece of HTML.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "sightline/report/chart.h"
#include "sightline/report/cull_run.h"
#include "sightline/report/film.h"
#include "sightline/report/page_table.h"

namespace sightline {

/// Sums and means over the frames of a run.
struct RunMeans {
    double visible = 0, triangles = 0, median_query = 0;
    StageRow stages[kStageCount];  ///< sums
};
RunMeans meansOf(const CullRun& run);

/// Middle value; of an even number, the mean of the two in the middle. 0 of none.

/// A card with a heading; empty if the body is.
std::string card(const std::string& id, const std::string& heading, const std::string& body);

/// Whether it was verified, and what came of it.
std::string verdictBox(const CullRun& run);
/// A line for a run that was interrupted; else empty.
std::string interruptedBox(const CullRun& run);
std::string statTiles(const CullRun& run, const RunMeans& means);

/// The player: play, step and scrub; the picture with its switch, the plan and the section if there are any.
std::string filmSection(const CullRun& run, const Film& film);
std::string depthSection(const Film& film);
std::string stageSection(const CullRun& run, const RunMeans& means);
std::string tableSection(const ObjectTable& table);
/// @param pictured  which frames have pictures, escaped; may be empty
std::string howSection(const CullRun& run, const std::string& pictured);

/// The charts of a run: the stages' times, objects, triangles, and over-estimate.
std::vector<Chart> runCharts(const CullRun& run);
std::string chartSection(const CullRun& run, const std::vector<Chart>& charts);

/// The slowest frame and the one with the largest over-estimate, against the medians.
/// @param label  what an object of VerificationRow::kept_unseen is called
std::string explainedSection(const CullRun& run, const std::function<std::string(uint32_t)>& label);

/// Who hides most, what is never kept, what could be merged: for a run with credits; empty pieces are left out.
std::string insightSection(const CullRun& run, const Scene& scene);

}  // namespace sightline
