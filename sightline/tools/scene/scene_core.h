// Where nearly all of a scene is: what lies far off, or around all of it, sets no scale.
// SPDX-License-Identifier: MIT
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sightline/math/box.h"
#include "sightline/tools/scene/scene.h"

namespace sightline::tools {

/// A stray triangle 1,000 km away, a sky dome or a sheet of water to the horizon makes a scene a million times as large as
/// what it shows. Distances that a tool chooses by a scene's size are chosen by this part of it.
struct SceneCore {
    Box3d bounds;                 ///< of objects that are finite; of all these where nothing is left aside
    std::vector<uint32_t> aside;  ///< objects that reach beyond, rising  [Scene::objects]

    bool isWhole() const { return aside.empty(); }
    double diagonal() const;  ///< of the bounds; 0 if they are empty
};

/// Parts are objects, and triangles of objects that reach far. They are sorted by how far they reach from a middle. Where
/// one reaches 16 times as far as the one before it, what follows is left aside if it is at most a quarter of the objects or
/// of the triangles; where one reaches 64 times as far, also if each part that follows is around all that is kept.
/// Middles that are tried are the median of the objects, that of the triangles, and each object of a few; the smallest core
/// counts. O(n log n) of the objects, and of the triangles of those that reach far.
SceneCore coreOf(const Scene& scene);

/// Three of some objects by their paths, or keys: "'sky', object 7, 'stray', ...".
/// @param objects  [Scene::objects]
std::string namesOf(const Scene& scene, std::span<const uint32_t> objects);

/// "2 of 24 objects reach far beyond all others ('sky', 'stray')"; empty if there are none.
/// @param aside  SceneCore::aside
std::string asideText(const Scene& scene, std::span<const uint32_t> aside);

}  // namespace sightline::tools
