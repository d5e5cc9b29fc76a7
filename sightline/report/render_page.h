// The page of `render --report`: every method's image, what it cost, and where it is wrong.
// SPDX-License-Identifier: MIT
#pragma once

#include <string>

#include "sightline/report/render_list.h"
#include "sightline/report/render_pictures.h"
#include "sightline/report/render_run.h"

namespace sightline {

/// The whole page. It needs no network: pictures and style lie in it.
/// @param run  with counts
std::string renderPage(const RenderList& scene, const View& view, const RenderRun& run,
                       const PictureSettings& settings);

}  // namespace sightline
