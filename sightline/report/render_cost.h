// What hidden-surface methods cost, beside one another: bars of time and a table of counters.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>
#include <string_view>

#include "sightline/report/render_run.h"

namespace sightline {

/// Why heat maps and the timed runs' counters disagree; empty if they do not.
std::string_view countingNote(const RenderRun& run);

/// Times on a logarithmic scale, preparation behind what a frame took, as HTML.
std::string costBars(const RenderRun& run);

/// Times, agreement and counters, a column a method, as HTML. What all methods count alike is said in a sentence.
std::string costTable(const RenderRun& run);

}  // namespace sightline
