// The page of `render --report`: every method's image, what it cost, and where it is wrong.
// SPDX-License-Identifier: MIT
#pragma once

#include <functional>
#include <string>

#include "sightline/tools/report/pictures/render_list.h"
#include "sightline/tools/report/pictures/render_pictures.h"
#include "sightline/tools/report/run/render_run.h"

namespace sightline::tools {

/// Takes a method's picture in full size.
using TakePicture = std::function<void(const MethodResult&, const Image<Rgb>&)>;

/// The whole page. It needs no network: pictures and style lie in it.
/// @param run   with counts
/// @param take  is to save each method's picture beside the page as METHOD.png, which is linked to; null: no links
std::string renderPage(const RenderList& scene, const View& view, const RenderRun& run, const PictureSettings& settings,
                       const TakePicture& take = nullptr);

}  // namespace sightline::tools
