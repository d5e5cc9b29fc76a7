// Hidden-surface removal: every classical method, one signature, one image.
// SPDX-License-Identifier: MIT
#include "sightline/studies/hidden/render.h"

#include <chrono>

#include "sightline/studies/hidden/bsp/bsp_render.h"
#include "sightline/studies/hidden/methods/newell.h"
#include "sightline/studies/hidden/methods/painter.h"
#include "sightline/studies/hidden/methods/warnock.h"
#include "sightline/studies/hidden/rays/raycast.h"
#include "sightline/studies/hidden/zbuffer/zbuffer_method.h"

namespace sightline::studies {
namespace {

using Draw = void (*)(const HiddenInput&, HiddenImage&);

/// In the order of HiddenMethod.
constexpr Draw kMethods[kHiddenMethods] = {
    drawPainter, drawNewell, drawBspBackToFront, drawBspFrontToBack, drawWarnock, drawZBuffer, drawRaycast,
};

}  // namespace

HiddenImage render(const DrawList& list, const View& view, const RenderSettings& settings) {
    const auto start = std::chrono::steady_clock::now();
    HiddenImage image;
    image.width = view.width;
    image.height = view.height;
    const size_t samples = size_t{view.width} * view.height;
    image.surface.assign(samples, HiddenImage::kNone);
    if (settings.want_counts)
        for (std::vector<uint16_t>* counts : {&image.generated, &image.tested, &image.passed, &image.shaded})
            counts->assign(samples, 0);
    if (isUsable(view)) kMethods[static_cast<int>(settings.method)]({list, view, settings}, image);
    const auto spent = std::chrono::steady_clock::now() - start;
    image.counters.nanoseconds =
        static_cast<uint64_t>(std::chrono::duration_cast<std::chrono::nanoseconds>(spent).count()) -
        image.counters.prepare_nanoseconds;
    return image;
}

}  // namespace sightline::studies
