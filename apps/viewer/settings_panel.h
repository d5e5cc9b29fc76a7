// All settings of the query, each with what it means: made from the table that names them.
// SPDX-License-Identifier: MIT
#pragma once

#include "apps/viewer/panel_places.h"
#include "sightline/geom/query_settings.h"

namespace sightline::viewer {

/// What is typed stays within the setting's limits. Stages have a panel of their own; a viewer has one thread, always
/// measures, and fades nothing.
/// @param begun  what a button returns to
void drawSettings(QuerySettings& settings, const QuerySettings& begun, PanelPlaces& places);

}  // namespace sightline::viewer
