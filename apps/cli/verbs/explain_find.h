// Which object of a scene a word or a pixel means.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "sightline/base/result.h"
#include "sightline/geom/view.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::cli {
using namespace tools;

/// The objects that share the key that a word names: the key itself; else the path or the name of an object, exactly;
/// else a part of just one path, in any case of letters. Errors (kUsage): there is none; there are several, of which
/// the first ten are named.
Result<std::vector<uint32_t>> findObjects(const Scene& scene, const std::string& word);

/// What a pixel shows, by the reference renderer.
struct Layer {
    uint32_t object = 0;  ///< index into Scene::objects
    double depth = 0;     ///< along the direction of view  [world units]
};

/// The surfaces at the middle of a pixel, front to back, each object once; at most so many.
/// @param x,y  whole pixels from the left and the top, inside the viewport
std::vector<Layer> layersAt(const Scene& scene, const View& view, uint32_t x, uint32_t y, size_t most);

/// "object 4711 'Floor 3/Desk'", or "object 4711"; the path as a terminal may show it, of a very long one the end.
std::string titleOf(const Scene& scene, uint32_t object);
/// "'Floor 3/Desk'", or "object 4711".
std::string callOf(const Scene& scene, uint32_t object);

}  // namespace sightline::cli
